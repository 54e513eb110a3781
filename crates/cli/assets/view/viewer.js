// The page's own program. `vendor` holds three.js and fflate; the data are in the page, see `page.rs`.
"use strict";
(() => {
  const element = (id) => document.getElementById(id);
  const description = JSON.parse(element("description").textContent);
  const { items, center, radius, up } = description;
  const isSteps = description.shown === "steps";

  // Data: zlib, in base64; words of four bytes, all first bytes ahead of all second ones.
  const bytesOf = (id) => {
    const text = atob(element(id).textContent);
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
    return vendor.unzlibSync(packed);
  };
  const wordsOf = (id) => {
    const planes = bytesOf(id);
    const count = planes.length / 4;
    const bytes = new Uint8Array(planes.length);
    for (let plane = 0; plane < 4; plane++) {
      for (let i = 0; i < count; i++) bytes[4 * i + plane] = planes[plane * count + i];
    }
    return bytes.buffer;
  };
  // Each index is the difference from the one before, its sign in the last bit.
  const indicesOf = (id) => {
    const words = new Uint32Array(wordsOf(id));
    let last = 0;
    for (let i = 0; i < words.length; i++) {
      last = (last + ((words[i] >>> 1) ^ -(words[i] & 1))) >>> 0;
      words[i] = last;
    }
    return words;
  };

  // The light of `pellicle render`: colours are linear here, and their square roots are what is seen.
  const LIGHT = `
    const vec3 KEY = vec3(-0.48, 0.64, 0.6);
    const vec3 FILL = vec3(0.8, 0.0, 0.6);
    vec3 lit(vec3 surface, vec3 normal) {
      vec3 light = mix(vec3(0.15, 0.14, 0.13), vec3(0.33, 0.35, 0.39), 0.5 + 0.5 * normal.y);
      float key = max((dot(normal, KEY) + 0.2) / 1.2, 0.0);
      light += vec3(0.98, 0.95, 0.90) * key * sqrt(key);
      light += vec3(0.20, 0.21, 0.23) * max(dot(normal, FILL), 0.0);
      float gloss = pow(max(dot(normal, normalize(KEY + vec3(0.0, 0.0, 1.0))), 0.0), 32.0);
      return sqrt(clamp(surface * light + vec3(0.06 * gloss), 0.0, 1.0));
    }`;
  const linear = (bytes) => new vendor.Vector3(...bytes.map((byte) => (byte / 255) ** 2));
  const BACK = [178, 96, 148];
  const BALL = [126, 160, 190];
  // The first is what `pellicle render` draws; the others are told apart by all eyes (Okabe and Ito).
  const COLORS = [[214, 208, 196], [86, 180, 233], [230, 159, 0], [0, 158, 115], [204, 121, 167], [240, 228, 66], [213, 94, 0], [0, 114, 178]];

  const surfaceMaterial = (color) => new vendor.ShaderMaterial({
    glslVersion: vendor.GLSL3,
    side: vendor.DoubleSide,
    uniforms: { front: { value: linear(color) }, back: { value: linear(BACK) } },
    vertexShader: `
      out vec3 place;
      void main() {
        place = (modelViewMatrix * vec4(position, 1.0)).xyz;
        gl_Position = projectionMatrix * vec4(place, 1.0);
      }`,
    fragmentShader: `
      uniform vec3 front;
      uniform vec3 back;
      in vec3 place;
      out vec4 shown;
      ${LIGHT}
      void main() {
        vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
        shown = vec4(lit(gl_FrontFacing ? front : back, normal), 1.0);
      }`,
  });
  // Lines and points lie a little nearer than the surface that they are on.
  const ink = { value: new vendor.Vector3() };
  const lineMaterial = () => new vendor.ShaderMaterial({
    glslVersion: vendor.GLSL3,
    transparent: true,
    uniforms: { ink },
    vertexShader: `
      void main() {
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_Position.z -= 0.0006 * gl_Position.w;
      }`,
    fragmentShader: `
      uniform vec3 ink;
      out vec4 shown;
      void main() { shown = vec4(ink, 0.75); }`,
  });
  const pointMaterial = (color, hasNormals, pixels) => new vendor.ShaderMaterial({
    glslVersion: vendor.GLSL3,
    uniforms: {
      front: { value: linear(color) },
      back: { value: linear(BACK) },
      size: { value: pixels },
    },
    defines: hasNormals ? { NORMALS: 1 } : {},
    vertexShader: `
      uniform float size;
      out vec3 turned;
      void main() {
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        #ifdef NORMALS
          turned = normalMatrix * normal;
        #endif
        gl_Position = projectionMatrix * place;
        gl_Position.z -= 0.001 * gl_Position.w;
        gl_PointSize = size;
      }`,
    fragmentShader: `
      uniform vec3 front;
      uniform vec3 back;
      in vec3 turned;
      out vec4 shown;
      ${LIGHT}
      void main() {
        vec2 offset = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
        float square = dot(offset, offset);
        if (square > 1.0) discard;
        vec3 normal = vec3(offset, sqrt(1.0 - square));
        vec3 color = front;
        #ifdef NORMALS
          if (dot(turned, turned) > 0.0) {
            normal = normalize(turned);
            if (normal.z < 0.0) { normal = -normal; color = back; }
          }
        #endif
        shown = vec4(lit(color, normal), 1.0);
      }`,
  });

  // The scene: an object for each item, made when it is first shown; of many steps the oldest are let go.
  const MOST_KEPT = 48;
  const scene = new vendor.Scene();
  const made = new Map();
  // Where there are clouds, points are theirs; else they are the vertices of meshes.
  const hasClouds = items.some((item) => item.triangles === 0);
  const shows = { surface: true, wireframe: false, points: hasClouds };
  const isVisible = items.map((_, index) => !isSteps || index === 0);
  const colorOf = (index) => (isSteps || items.length === 1 ? COLORS[0] : COLORS[index % COLORS.length]);
  const ratio = Math.min(window.devicePixelRatio || 1, 2);

  const make = (index) => {
    const item = items[index];
    const color = colorOf(index);
    const position = new vendor.BufferAttribute(new Float32Array(wordsOf(item.positions)), 3);
    const object = { surface: null, wireframe: null, points: null, disposable: [] };
    const geometryOf = (indices) => {
      const geometry = new vendor.BufferGeometry();
      geometry.setAttribute("position", position);
      if (indices) geometry.setIndex(new vendor.BufferAttribute(indices, 1));
      object.disposable.push(geometry);
      return geometry;
    };
    const add = (shape) => {
      shape.frustumCulled = false;
      object.disposable.push(shape.material);
      scene.add(shape);
      return shape;
    };
    if (item.triangles > 0) {
      const indices = indicesOf(item.corners);
      object.surface = add(new vendor.Mesh(geometryOf(indices), surfaceMaterial(color)));
      object.makeWireframe = () => {
        const edges = new Uint32Array(2 * indices.length);
        for (let i = 0; i < indices.length; i++) {
          edges[2 * i] = indices[i];
          edges[2 * i + 1] = indices[i % 3 === 2 ? i - 2 : i + 1];
        }
        object.wireframe = add(new vendor.LineSegments(geometryOf(edges), lineMaterial()));
      };
    }
    object.makePoints = () => {
      const geometry = geometryOf(null);
      if (item.normals) {
        geometry.setAttribute("normal", new vendor.BufferAttribute(new Int8Array(bytesOf(item.normals).buffer), 3, true));
      }
      const isCloud = item.triangles === 0;
      const ball = isCloud && !item.normals && colorOf(index) === COLORS[0] ? BALL : color;
      const pixels = (isCloud ? 5 : 4) * ratio;
      object.points = add(new vendor.Points(geometry, pointMaterial(ball, Boolean(item.normals), pixels)));
    };
    return object;
  };
  const dispose = (object) => {
    for (const shape of [object.surface, object.wireframe, object.points]) if (shape) scene.remove(shape);
    for (const part of object.disposable) part.dispose();
  };

  const update = () => {
    items.forEach((item, index) => {
      let object = made.get(index);
      if (isVisible[index] && !object) {
        object = make(index);
        made.set(index, object);
        for (const [old, gone] of made) {
          if (made.size <= MOST_KEPT || isVisible[old]) break;
          dispose(gone);
          made.delete(old);
        }
      }
      if (!object) return;
      const hasSurface = item.triangles > 0;
      const wants = {
        surface: isVisible[index] && shows.surface && hasSurface,
        wireframe: isVisible[index] && shows.wireframe && hasSurface,
        points: isVisible[index] && shows.points && !(hasClouds && hasSurface),
      };
      if (wants.wireframe && !object.wireframe) object.makeWireframe();
      if (wants.points && !object.points) object.makePoints();
      for (const kind of ["surface", "wireframe", "points"]) if (object[kind]) object[kind].visible = wants[kind];
    });
    count();
    draw();
  };

  const number = (value) => value.toLocaleString("en");
  const plural = (value, one, many) => `${number(value)} ${value === 1 ? one : many}`;
  const count = () => {
    const shown = items.filter((_, index) => isVisible[index]);
    const sum = (key) => shown.reduce((total, item) => total + item[key], 0);
    const triangles = sum("triangles");
    const lines = triangles > 0
      ? [plural(sum("vertices"), "vertex", "vertices"), plural(triangles, "triangle", "triangles")]
      : [plural(sum("vertices"), "point", "points")];
    if (description.extent) lines.push(`${description.extent.map((length) => Number(length.toPrecision(3))).join(" × ")} units`);
    element("counts").textContent = lines.join("\n");
  };

  // The camera: six radii away, as `pellicle render` has it.
  const DISTANCE = 6;
  const canvas = element("canvas");
  let renderer;
  try {
    renderer = new vendor.WebGLRenderer({ canvas, antialias: true, alpha: true });
  } catch {
    const message = element("message");
    message.textContent = "This browser has no WebGL 2, which the page needs to draw.";
    message.hidden = false;
    document.documentElement.dataset.state = "failed";
    return;
  }
  renderer.setPixelRatio(ratio);
  renderer.setClearColor(0, 0);
  const camera = new vendor.PerspectiveCamera(20, 1, 0.01, 1000);
  camera.up.set(0, up === "z" ? 0 : 1, up === "z" ? 1 : 0);
  const controls = new vendor.OrbitControls(camera, canvas);
  controls.minDistance = 0.05;
  controls.maxDistance = 200;
  controls.zoomSpeed = 1.5;

  const away = up === "z" ? [0, 1, 0] : [0, 0, -1];
  const above = up === "z" ? [0, 0, 1] : [0, 1, 0];
  const VIEWS = {
    "front": [0, -1, 0],
    "back": [0, 1, 0],
    "left": [-1, 0, 0],
    "right": [1, 0, 0],
    "top": [0, 0, 1],
    "bottom": [0, 0, -1],
    "three-quarter": [0.75, -1, 0.6],
  };
  const look = (name) => {
    const [side, depth, height] = VIEWS[name] ?? VIEWS["three-quarter"];
    const direction = new vendor.Vector3(side, 0, 0)
      .addScaledVector(new vendor.Vector3(...away), depth)
      .addScaledVector(new vendor.Vector3(...above), height)
      .normalize();
    // Straight from above, a hair before the middle keeps the front at the lower edge.
    if (side === 0 && depth === 0) direction.addScaledVector(new vendor.Vector3(...away), -1e-5);
    controls.target.set(0, 0, 0);
    camera.position.copy(direction.multiplyScalar(DISTANCE));
    camera.zoom = 1;
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  };

  const resize = () => {
    const [width, height] = [window.innerWidth, window.innerHeight];
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    // The unit ball fits the shorter side.
    const half = 1.12 * Math.max(1, height / width);
    camera.fov = 2 * Math.atan(half / DISTANCE) * 180 / Math.PI;
    camera.updateProjectionMatrix();
    draw();
  };

  const measure = () => {
    const distance = camera.position.distanceTo(controls.target);
    const pixel = 2 * Math.tan(camera.fov * Math.PI / 360) * distance / window.innerHeight * radius;
    const wanted = 130 * pixel;
    if (!(wanted > 0 && Number.isFinite(wanted))) {
      element("scale").hidden = true;
      return;
    }
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((factor) => factor * power).find((length) => length <= wanted) ?? power;
    element("scale-bar").style.width = `${length / pixel}px`;
    element("scale-text").textContent = String(Number(length.toPrecision(3)));
  };

  let isAsked = false;
  const draw = () => {
    if (isAsked) return;
    isAsked = true;
    requestAnimationFrame(() => {
      isAsked = false;
      camera.near = Math.max(0.001, camera.position.length() - 1.8);
      camera.far = camera.position.length() + 1.8;
      camera.updateProjectionMatrix();
      renderer.render(scene, camera);
      measure();
      document.documentElement.dataset.state = "drawn";
    });
  };

  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const tint = () => {
    // Over a surface lines are dark in both schemes; alone they are as the text.
    ink.value.set(...(dark.matches && !shows.surface ? [0.91, 0.91, 0.93] : [0.17, 0.19, 0.22]));
    draw();
  };

  // What is shown.
  for (const kind of ["surface", "wireframe", "points"]) {
    element(kind).addEventListener("change", () => {
      shows[kind] = element(kind).checked;
      tint();
      update();
    });
  }
  const toggle = (kind) => element(kind).click();
  for (const button of document.querySelectorAll("#views button")) {
    button.addEventListener("click", () => look(button.dataset.view));
  }

  // Steps.
  let step = 0;
  let isPlaying = false;
  let timer = 0;
  const go = (to) => {
    isVisible[step] = false;
    step = (to % items.length + items.length) % items.length;
    isVisible[step] = true;
    element("step").value = step;
    element("step").setAttribute("aria-valuetext", items[step].name);
    element("step-name").textContent = `${step + 1} of ${items.length}: ${items[step].name}`;
    update();
  };
  const pause = () => 1000 * description.seconds / Number(element("speed").value);
  const advance = () => {
    timer = setTimeout(advance, pause());
    go(step + 1);
  };
  const play = (wanted) => {
    isPlaying = wanted;
    element("play").textContent = wanted ? "Pause" : "Play";
    element("play").setAttribute("aria-pressed", String(wanted));
    clearTimeout(timer);
    if (wanted) timer = setTimeout(advance, pause());
  };
  element("play").addEventListener("click", () => play(!isPlaying));
  element("step").addEventListener("input", () => { play(false); go(Number(element("step").value)); });
  element("back").addEventListener("click", () => { play(false); go(step - 1); });
  element("forth").addEventListener("click", () => { play(false); go(step + 1); });

  // Layers.
  const layer = (item, index) => {
    const label = document.createElement("label");
    const box = document.createElement("input");
    const chip = document.createElement("span");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => { isVisible[index] = box.checked; update(); });
    chip.className = "chip";
    chip.style.background = `rgb(${colorOf(index).join(" ")})`;
    label.append(box, chip, item.name);
    element("layers").append(label);
  };

  // Keys.
  const turn = (sideways, upwards) => {
    const offset = camera.position.clone().sub(controls.target);
    const axis = new vendor.Vector3(...above);
    const angle = Math.acos(Math.min(1, Math.max(-1, offset.dot(axis) / offset.length())));
    const across = offset.clone().cross(axis).normalize();
    const raise = Math.min(Math.max(upwards, angle - Math.PI + 0.01), angle - 0.01);
    offset.applyAxisAngle(across, raise).applyAxisAngle(axis, sideways);
    camera.position.copy(controls.target).add(offset);
    controls.update();
    draw();
  };
  const approach = (factor) => {
    const offset = camera.position.clone().sub(controls.target);
    const length = Math.min(Math.max(offset.length() * factor, controls.minDistance), controls.maxDistance);
    camera.position.copy(controls.target).add(offset.setLength(length));
    controls.update();
    draw();
  };
  const KEYS = {
    "s": () => toggle("surface"),
    "w": () => toggle("wireframe"),
    "p": () => toggle("points"),
    "r": () => look("three-quarter"),
    "1": () => look("front"),
    "2": () => look("right"),
    "3": () => look("top"),
    "4": () => look("three-quarter"),
    "+": () => approach(0.85),
    "=": () => approach(0.85),
    "-": () => approach(1 / 0.85),
    ",": () => isSteps && element("back").click(),
    ".": () => isSteps && element("forth").click(),
  };
  const TURNS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const isControl = /^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName);
    if (TURNS[event.key] && !isControl) turn(...TURNS[event.key]);
    else if (event.key === " " && isSteps && !isControl) play(!isPlaying);
    else if (KEYS[event.key.toLowerCase()]) KEYS[event.key.toLowerCase()]();
    else return;
    event.preventDefault();
  });

  // Begin, as the address says after its #: view=front&panel=off&wireframe=on&step=3&play=on.
  const asked = new URLSearchParams(location.hash.slice(1));
  for (const kind of Object.keys(shows)) {
    if (asked.has(kind)) shows[kind] = asked.get(kind) !== "off";
    element(kind).checked = shows[kind];
  }
  if (asked.get("panel") === "off") element("panel").hidden = element("scale").hidden = true;
  // On a small screen the shape comes first.
  element("panel").open = window.innerWidth > 560;
  element("title").textContent = description.title;
  element("surface").disabled = element("wireframe").disabled = !items.some((item) => item.triangles > 0);
  if (isSteps) {
    element("steps").hidden = false;
    element("step").max = items.length - 1;
    const wanted = Math.trunc(Number(asked.get("step") ?? 1)) - 1;
    go(Number.isFinite(wanted) ? wanted : 0);
    if (asked.get("play") === "on") play(true);
  } else if (items.length > 1) {
    element("layers").hidden = false;
    items.forEach(layer);
  }
  tint();
  dark.addEventListener("change", tint);
  controls.addEventListener("change", draw);
  window.addEventListener("resize", resize);
  resize();
  look(asked.get("view") ?? "three-quarter");
  update();
})();
