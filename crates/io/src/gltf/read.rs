//! From the scene to triangles.

use super::accessor::{Component, View};
use super::buffers;
use super::document::{Document, Node, Primitive};
use crate::contents::{Contents, Keep, push};
use crate::source::Source;
use crate::{Error, Location, Note};
use glam::{DMat3, DMat4, DQuat};
use pellicle_geometry::DVec3;
use std::collections::HashMap;
use std::path::Path;

/// A scene may place a mesh many times. Up to so many vertices and corners a byte of the file are believed.
const MOST_PER_BYTE: u64 = 8;

pub(crate) fn read(
    source: &mut Source,
    base: Option<&Path>,
    keep: Keep,
) -> Result<Contents, Error> {
    let (json, binary) = split(source)?;
    let document: Document = serde_json::from_slice(&json).map_err(|e| {
        source.malformed(
            Location::Line(e.line() as u64),
            format!("the JSON of glTF is broken: {e}"),
        )
    })?;
    drop(json);
    if !document.asset.version.starts_with("2.") {
        return Err(source.malformed(
            Location::File,
            format!(
                "is glTF of version {:?}; 2.0 is supported",
                document.asset.version
            ),
        ));
    }
    check_extensions(source, &document)?;
    let scene = Scene {
        source,
        buffers: buffers::load(source, &document, binary, base)?,
        document: &document,
    };
    scene.read(keep)
}

/// The JSON, and the binary chunk if there is one.
///
/// ```text
/// "glTF" version length   then chunks: length type bytes, each number a u32
/// ```
fn split(source: &mut Source) -> Result<(Vec<u8>, Option<Vec<u8>>), Error> {
    if !source.peek()?.starts_with(b"glTF") {
        let length = source.length();
        return Ok((source.read_to_vec(length, "its end")?, None));
    }
    let mut head = [0; 12];
    source.read_exact(&mut head, "the end of its header")?;
    let word = |raw: &[u8]| u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]);
    if word(&head[4..]) != 2 {
        return Err(source.at_byte(format!(
            "GLB of version {}; 2 is supported",
            word(&head[4..])
        )));
    }
    let stated = u64::from(word(&head[8..]));
    if stated > source.length() {
        return Err(source.malformed(
            Location::Byte(8),
            format!(
                "{stated} bytes are stated, and the file has {}; it is truncated: copy or export it again",
                source.length()
            ),
        ));
    }
    let (mut json, mut binary) = (None, None);
    while source.offset() + 8 <= stated {
        let mut head = [0; 8];
        source.read_exact(&mut head, "the end of a chunk")?;
        let length = u64::from(word(&head));
        match &head[4..] {
            b"JSON" if json.is_none() => {
                json = Some(source.read_to_vec(length, "the end of its JSON")?)
            }
            b"BIN\0" if binary.is_none() => {
                binary = Some(source.read_to_vec(length, "the end of its binary chunk")?);
            }
            _ => source.skip(length, "the end of a chunk")?,
        }
    }
    let json = json.ok_or_else(|| source.at_byte("the file has no chunk of JSON"))?;
    Ok((json, binary))
}

/// An extension that is required and changes where vertices are cannot be passed over.
fn check_extensions(source: &Source, document: &Document) -> Result<(), Error> {
    let harmless = |name: &str| {
        [
            "KHR_materials_",
            "KHR_texture_",
            "KHR_lights_",
            "EXT_texture_",
        ]
        .iter()
        .any(|prefix| name.starts_with(prefix))
            || name == "KHR_mesh_quantization"
    };
    match document
        .extensions_required
        .iter()
        .find(|name| !harmless(name))
    {
        None => Ok(()),
        Some(name) => Err(source.malformed(
            Location::File,
            format!("requires the extension {name:?}, which is not supported; export it without"),
        )),
    }
}

struct Scene<'s, 'a, 'd> {
    source: &'s Source<'a>,
    document: &'d Document,
    buffers: Vec<Vec<u8>>,
}

/// What placing the nodes adds up to.
struct Placed {
    contents: Contents,
    /// Whether every primitive so far had normals.
    normals: bool,
    transformed: u64,
    hidden: u64,
    lines: u64,
    without_positions: u64,
    corners: u64,
}

impl Scene<'_, '_, '_> {
    fn wrong(&self, reason: String) -> Error {
        self.source.malformed(Location::File, reason)
    }

    fn read(&self, keep: Keep) -> Result<Contents, Error> {
        let mut placed = Placed {
            contents: Contents::new(keep),
            normals: true,
            transformed: 0,
            hidden: 0,
            lines: 0,
            without_positions: 0,
            corners: 0,
        };
        if self.document.nodes.is_empty() {
            for mesh in 0..self.document.meshes.len() {
                self.mesh(mesh, &DMat4::IDENTITY, &mut placed)?;
            }
        } else {
            self.nodes(&mut placed)?;
        }
        let mut contents = placed.contents;
        if !placed.normals {
            contents.normals = Vec::new();
        }
        if placed.transformed > 0 {
            contents.notes.push(Note::Transformed {
                nodes: placed.transformed,
            });
        }
        contents.ignored("hidden nodes", placed.hidden);
        let animations = self.document.animations.len();
        contents.ignored("animations", animations as u64);
        contents.ignored("primitives of lines", placed.lines);
        contents.ignored("primitives without positions", placed.without_positions);
        Ok(contents)
    }

    /// Every node of the scene, each after its parent; a node met twice would make a circle.
    fn nodes(&self, placed: &mut Placed) -> Result<(), Error> {
        let nodes = &self.document.nodes;
        let roots: Vec<usize> = match self.document.scenes.get(self.document.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None => {
                let mut is_child = vec![false; nodes.len()];
                for &child in nodes.iter().flat_map(|node| &node.children) {
                    if let Some(is_child) = is_child.get_mut(child) {
                        *is_child = true;
                    }
                }
                (0..nodes.len()).filter(|&node| !is_child[node]).collect()
            }
        };
        let mut met = vec![false; nodes.len()];
        let mut stack: Vec<(usize, DMat4)> = roots
            .iter()
            .rev()
            .map(|&root| (root, DMat4::IDENTITY))
            .collect();
        while let Some((id, parent)) = stack.pop() {
            let Some(node) = nodes.get(id) else {
                return Err(self.wrong(format!("names node {id} of {}", nodes.len())));
            };
            if std::mem::replace(&mut met[id], true) {
                return Err(self.wrong(format!("node {id} has two parents or is its own")));
            }
            let matrix = local_matrix(node);
            let matrix = parent * matrix;
            match node.mesh {
                None => {}
                // A scale of zero on all axes is how the format hides a node, as in the frames of an animation.
                Some(_) if DMat3::from_mat4(matrix) == DMat3::ZERO => placed.hidden += 1,
                Some(mesh) => {
                    placed.transformed += u64::from(matrix != DMat4::IDENTITY);
                    self.mesh(mesh, &matrix, placed)?;
                }
            }
            stack.extend(node.children.iter().rev().map(|&child| (child, matrix)));
        }
        Ok(())
    }

    fn mesh(&self, mesh: usize, matrix: &DMat4, placed: &mut Placed) -> Result<(), Error> {
        let Some(mesh) = self.document.meshes.get(mesh) else {
            return Err(self.wrong(format!(
                "names mesh {mesh} of {}",
                self.document.meshes.len()
            )));
        };
        // Primitives of a mesh may share their vertices.
        let mut shared: HashMap<[Option<usize>; 2], (u32, u64)> = HashMap::new();
        for primitive in &mesh.primitives {
            match primitive.mode {
                0 | 4..=6 => {}
                1..=3 => {
                    placed.lines += 1;
                    continue;
                }
                mode => return Err(self.wrong(format!("has a primitive of mode {mode}"))),
            }
            let Some(position) = primitive.attributes.position else {
                placed.without_positions += 1;
                continue;
            };
            let key = [Some(position), primitive.attributes.normal];
            let (first, count) = match shared.get(&key) {
                Some(&known) => known,
                None => *shared
                    .entry(key)
                    .insert_entry(self.vertices(key, matrix, placed)?)
                    .get(),
            };
            if primitive.mode != 0 {
                self.triangles(primitive, first, count, matrix, placed)?;
            }
        }
        Ok(())
    }

    /// Adds the vertices of a primitive; returns the id of the first, and how many.
    fn vertices(
        &self,
        [position, normal]: [Option<usize>; 2],
        matrix: &DMat4,
        placed: &mut Placed,
    ) -> Result<(u32, u64), Error> {
        let view = self.accessor(position.unwrap_or(usize::MAX), "VEC3")?;
        let first = placed.contents.positions.len();
        let total = first as u64 + view.count;
        if total >= u64::from(u32::MAX) {
            return Err(self.source.too_many(total, "vertices"));
        }
        self.believe(total, "vertices")?;
        for i in 0..view.count {
            let local = view.vector(i);
            let vertex = placed.contents.positions.len();
            let position = matrix.transform_point3(local);
            self.source.check_finite(position, vertex, Location::File)?;
            push(&mut placed.contents.positions, position);
        }
        match normal {
            Some(normal) if placed.normals => {
                let normals = self.accessor(normal, "VEC3")?;
                if normals.count != view.count {
                    return Err(self.wrong(format!(
                        "has {} normals for {} vertices",
                        normals.count, view.count
                    )));
                }
                let turn = DMat3::from_mat4(*matrix);
                let turn = match turn.determinant() {
                    0.0 => turn,
                    _ if turn == DMat3::IDENTITY => turn,
                    _ => turn.inverse().transpose(),
                };
                for i in 0..normals.count {
                    let normal = normals.vector(i);
                    let turned = match turn == DMat3::IDENTITY {
                        true => normal,
                        false => (turn * normal).normalize_or_zero(),
                    };
                    push(&mut placed.contents.normals, turned);
                }
            }
            _ => placed.normals = false,
        }
        Ok((first as u32, view.count))
    }

    fn triangles(
        &self,
        primitive: &Primitive,
        first: u32,
        count: u64,
        matrix: &DMat4,
        placed: &mut Placed,
    ) -> Result<(), Error> {
        let indices = match primitive.indices {
            None => None,
            Some(accessor) => Some(self.accessor(accessor, "SCALAR")?),
        };
        let length = indices.as_ref().map_or(count, |view| view.count);
        placed.corners += length;
        self.believe(placed.corners, "corners")?;
        let corner = |i: u64| -> Result<u32, Error> {
            let index = match &indices {
                None => i,
                Some(view) => view.index(i),
            };
            if index >= count {
                return Err(self.wrong(format!("names vertex {index} of {count}")));
            }
            Ok(first + index as u32)
        };
        // A reflection turns triangles over.
        let flip = matrix.determinant() < 0.0;
        let mut add = |[a, b, c]: [u64; 3]| -> Result<(), Error> {
            let (a, b, c) = (corner(a)?, corner(b)?, corner(c)?);
            placed
                .contents
                .triangle(if flip { [a, c, b] } else { [a, b, c] });
            Ok(())
        };
        match primitive.mode {
            4 => {
                for t in 0..length / 3 {
                    add([3 * t, 3 * t + 1, 3 * t + 2])?;
                }
            }
            5 => {
                for t in 0..length.saturating_sub(2) {
                    add(if t % 2 == 0 {
                        [t, t + 1, t + 2]
                    } else {
                        [t + 1, t, t + 2]
                    })?;
                }
            }
            _ => {
                for t in 1..length.saturating_sub(1) {
                    add([0, t, t + 1])?;
                }
            }
        }
        Ok(())
    }

    fn believe(&self, total: u64, what: &str) -> Result<(), Error> {
        if total <= self.bytes().saturating_mul(MOST_PER_BYTE) {
            return Ok(());
        }
        Err(self.wrong(format!(
            "places its meshes so often that there are {total} {what}; this is taken for an error"
        )))
    }

    /// The bytes of the file and its buffers.
    fn bytes(&self) -> u64 {
        let buffers: usize = self.buffers.iter().map(Vec::len).sum();
        self.source.length() + buffers as u64
    }

    /// An accessor of this shape, within its buffer.
    fn accessor(&self, id: usize, shape: &str) -> Result<View<'_>, Error> {
        let wrong = |reason: &str| Err(self.wrong(format!("accessor {id} {reason}")));
        let Some(accessor) = self.document.accessors.get(id) else {
            return wrong("does not exist");
        };
        if accessor.sparse.is_some() {
            return wrong("is sparse, which is not supported; export it without");
        }
        if accessor.shape != shape {
            return wrong("has the wrong type for its use");
        }
        let Some(component) = Component::new(accessor) else {
            return wrong("has a component type that is not known");
        };
        if shape == "SCALAR" && !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            return wrong("holds indices that are not unsigned integers");
        }
        let Some(view) = accessor
            .buffer_view
            .and_then(|view| self.document.buffer_views.get(view))
        else {
            return wrong(
                "has no buffer view; a compression that is not supported may hold its data",
            );
        };
        let Some(buffer) = self.buffers.get(view.buffer) else {
            return wrong("lies in a buffer that does not exist");
        };
        let size = component.size() * if shape == "VEC3" { 3 } else { 1 };
        let stride = view.byte_stride.unwrap_or(size);
        if stride == 0 {
            return wrong("has a stride of zero");
        }
        let range = || {
            let view_end = view.byte_offset.checked_add(view.byte_length)?;
            let start = view.byte_offset.checked_add(accessor.byte_offset)?;
            let end = match accessor.count {
                0 => start,
                count => start
                    .checked_add((count - 1).checked_mul(stride)?)?
                    .checked_add(size)?,
            };
            (end <= view_end).then_some(())?;
            buffer.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
        };
        let Some(bytes) = range() else {
            return wrong("reaches beyond its buffer; the file is truncated or damaged");
        };
        Ok(View {
            bytes,
            stride: stride as usize,
            count: accessor.count,
            component,
        })
    }
}

fn local_matrix(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let rotation = match node.rotation {
        None => DQuat::IDENTITY,
        Some(r) => {
            let q = DQuat::from_array(r);
            // Writers round quaternions to single precision.
            if q.length_squared() > 0.0 && q != DQuat::IDENTITY {
                q * (1.0 / q.length())
            } else {
                DQuat::IDENTITY
            }
        }
    };
    DMat4::from_translation(DVec3::from_array(node.translation.unwrap_or_default()))
        * DMat4::from_mat3(
            DMat3::from_quat(rotation)
                * DMat3::from_diagonal(node.scale.map_or(DVec3::ONE, DVec3::from_array)),
        )
}
