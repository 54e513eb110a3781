//! The page of `view` in a browser without a window: what it draws, says, and does when it is used.
//!
//! Ignored where there is no Chromium; `.ci/install-chromium` installs it. `PELLICLE_CHROMIUM` names another program.
//! `PELLICLE_SCREENSHOTS` names a folder that keeps the pictures.

mod common;

use common::{fixture, pellicle};
use image::RgbaImage;
use libtest_mimic::{Arguments, Failed, Trial};
use pellicle::io::{ReadOptions, read_mesh};
use pellicle::mesh::TriangleSoup;
use pellicle::render::{Options, View, render_mesh};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use tempfile::{TempDir, tempdir};

const WIDTH: u32 = 700;
const HEIGHT: u32 = 500;
const BACKGROUND: [u8; 3] = [244, 245, 247];

fn main() -> ExitCode {
    let chromium = chromium();
    if chromium.is_none() {
        eprintln!(
            "no Chromium: the tests of the page are ignored; .ci/install-chromium installs it"
        );
    }
    let program = chromium.clone().unwrap_or_default();
    let trial = |name, test: fn(&Browser)| {
        let program = program.clone();
        let run = move || {
            test(&Browser::new(&program));
            Ok::<(), Failed>(())
        };
        Trial::test(name, run).with_ignored_flag(chromium.is_none())
    };
    let trials = vec![
        trial(
            "the_page_draws_what_render_draws",
            the_page_draws_what_render_draws,
        ),
        trial("what_is_switched_off_is_gone", what_is_switched_off_is_gone),
        trial("steps_are_shown_and_played", steps_are_shown_and_played),
        trial(
            "keys_wheel_and_pointer_turn_the_shape",
            keys_wheel_and_pointer_turn_the_shape,
        ),
        trial(
            "layers_have_boxes_and_points_show",
            layers_have_boxes_and_points_show,
        ),
        trial("a_wicked_name_is_only_a_name", a_wicked_name_is_only_a_name),
        trial(
            "nothing_is_asked_of_the_network",
            nothing_is_asked_of_the_network,
        ),
    ];
    let mut arguments = Arguments::from_args();
    // One browser at a time takes the machine already.
    arguments.test_threads = Some(1);
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// The program, if there is one.
fn chromium() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("PELLICLE_CHROMIUM") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = [
        "chromium",
        "chromium-browser",
        "google-chrome",
        "google-chrome-stable",
    ];
    let programs =
        std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name)));
    programs.into_iter().find(|program| program.is_file())
}

/// A browser, and a folder for pages and pictures.
struct Browser {
    program: PathBuf,
    folder: TempDir,
}

impl Browser {
    fn new(program: &Path) -> Self {
        Self {
            program: program.to_owned(),
            folder: tempdir().unwrap(),
        }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a page.
    fn view(&self, arguments: &[&str]) {
        pellicle(self.folder.path())
            .args(["view", "-o", "page.html", "--force", "--quiet"])
            .args(arguments)
            .assert()
            .success();
    }

    /// Opens the page, and returns what the browser writes to standard output. Nothing may be said on the console.
    fn open(&self, hash: &str, further: &[String]) -> String {
        let url = format!("file://{}#{hash}", self.at("page.html").display());
        let output = Command::new(&self.program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--no-first-run",
                "--hide-scrollbars",
            ])
            .args([
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
            ])
            .args([
                "--disable-background-networking",
                "--disable-component-update",
            ])
            .args([
                "--host-resolver-rules=MAP * ~NOTFOUND",
                "--force-device-scale-factor=1",
            ])
            .args(["--enable-logging=stderr", "--virtual-time-budget=8000"])
            .arg(format!("--window-size={WIDTH},{HEIGHT}"))
            .arg(format!("--user-data-dir={}", self.at("profile").display()))
            .args(further)
            .arg(url)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let console: Vec<&str> = said
            .lines()
            .filter(|line| line.contains("CONSOLE"))
            .collect();
        assert!(console.is_empty(), "{console:#?}");
        assert!(output.status.success(), "{said}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// What the page's elements say when it is drawn.
    fn dom(&self, hash: &str) -> String {
        let dom = self.open(hash, &["--dump-dom".to_owned()]);
        assert!(
            dom.contains("data-state=\"drawn\""),
            "{}",
            &dom[..dom.len().min(300)]
        );
        dom
    }

    /// What the page looks like.
    fn shot(&self, name: &str, hash: &str) -> RgbaImage {
        let path = self.at(&format!("{name}.png"));
        self.open(hash, &[format!("--screenshot={}", path.display())]);
        if let Some(folder) = std::env::var_os("PELLICLE_SCREENSHOTS") {
            std::fs::copy(&path, Path::new(&folder).join(format!("{name}.png"))).unwrap();
        }
        image::open(&path).unwrap().into_rgba8()
    }

    /// Adds a script at the end of the page, run when the page is drawn.
    fn script(&self, script: &str) {
        let path = self.at("page.html");
        let html = std::fs::read_to_string(&path).unwrap();
        let script = format!("<script>setTimeout(() => {{ {script} }}, 500);</script>\n</body>");
        std::fs::write(path, html.replace("</body>", &script)).unwrap();
    }
}

fn is_covered(pixel: &image::Rgba<u8>) -> bool {
    (0..3).any(|i| pixel[i].abs_diff(BACKGROUND[i]) > 6)
}

fn covered(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|pixel| is_covered(pixel)).count()
}

/// The part that is covered, as 160 × 160 colours; none where nothing is.
fn normalized(picture: &RgbaImage) -> Vec<Option<[u8; 3]>> {
    let at = picture
        .enumerate_pixels()
        .filter(|(.., pixel)| is_covered(pixel));
    let (mut least, mut greatest) = ([u32::MAX; 2], [0; 2]);
    for (x, y, _) in at {
        least = [least[0].min(x), least[1].min(y)];
        greatest = [greatest[0].max(x), greatest[1].max(y)];
    }
    assert!(greatest[0] > least[0] + 50 && greatest[1] > least[1] + 50);
    let cells = (0..160 * 160).map(|cell| [cell % 160, cell / 160]);
    cells
        .map(|cell| {
            let place = |axis: usize| {
                let size = greatest[axis] - least[axis] + 1;
                least[axis] + (2 * cell[axis] + 1) * size / 320
            };
            let pixel = picture.get_pixel(place(0), place(1));
            is_covered(pixel).then(|| [pixel[0], pixel[1], pixel[2]])
        })
        .collect()
}

/// What `pellicle render` draws, but for the darkness of creases, which the page does without.
fn rendered(soup: &TriangleSoup, view: View) -> RgbaImage {
    let options = Options {
        width: WIDTH,
        height: HEIGHT,
        views: vec![view],
        occlusion: 0.0,
        ..Options::default()
    };
    let image = render_mesh(soup.into(), &options).unwrap();
    RgbaImage::from_raw(WIDTH, HEIGHT, image.pixels.as_flattened().to_vec()).unwrap()
}

fn the_page_draws_what_render_draws(browser: &Browser) {
    let elephant = fixture("elephant.off");
    browser.view(&[&elephant]);
    let elephant = read_mesh(&elephant, &ReadOptions::default()).unwrap().soup;
    for (view, side) in [
        ("front", View::Front),
        ("right", View::Right),
        ("top", View::Top),
        ("three-quarter", View::ThreeQuarter),
    ] {
        let shot = browser.shot(view, &format!("view={view}&panel=off"));
        assert_eq!(shot.dimensions(), (WIDTH, HEIGHT));
        let drawn = rendered(&elephant, side);
        let (page, render) = (normalized(&shot), normalized(&drawn));
        let (mut either, mut both, mut difference) = (0, 0, 0);
        for (a, b) in page.iter().zip(&render) {
            either += usize::from(a.is_some() || b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                both += 1;
                difference += (0..3)
                    .map(|i| usize::from(a[i].abs_diff(b[i])))
                    .sum::<usize>();
            }
        }
        // A cell at the outline may fall to either side, and at an edge to either triangle.
        let (overlap, mean) = (
            both as f64 / either as f64,
            difference as f64 / (3 * both) as f64,
        );
        assert!(overlap > 0.97, "{view}: {overlap}");
        assert!(mean < 5.0, "{view}: {mean}");
    }
    // Another view is another picture: the comparison can fail.
    let front = normalized(&browser.shot("front-again", "view=front&panel=off"));
    let right = normalized(&browser.shot("right-again", "view=right&panel=off"));
    let differ = front
        .iter()
        .zip(&right)
        .filter(|(a, b)| a.is_some() != b.is_some());
    assert!(differ.count() > 2000);
}

fn what_is_switched_off_is_gone(browser: &Browser) {
    browser.view(&[&fixture("elephant.off")]);
    let shot = |name: &str, hash: &str| covered(&browser.shot(name, &format!("panel=off&{hash}")));
    let surface = shot("surface", "surface=on");
    let both = shot("both", "wireframe=on");
    let wireframe = shot("wireframe", "surface=off&wireframe=on");
    let points = shot("points", "surface=off&points=on");
    assert_eq!(shot("nothing", "surface=off"), 0);
    assert!(surface > 20_000 && both >= surface, "{surface} {both}");
    assert!(wireframe > 2000 && points > 2000, "{wireframe} {points}");
    assert!(points < surface, "{points} {surface}");
    let dark = |picture: RgbaImage| picture.pixels().filter(|p| p[0] < 90 && p[2] < 100).count();
    let lines = dark(browser.shot("lines", "panel=off&wireframe=on"));
    assert!(
        lines > dark(browser.shot("plain", "panel=off")) + 1000,
        "{lines}"
    );
}

fn steps_are_shown_and_played(browser: &Browser) {
    std::fs::create_dir(browser.at("frames")).unwrap();
    let shapes = [
        "analytic/cube.off",
        "analytic/torus.off",
        "elephant.off",
        "analytic/cube.off",
    ];
    for (i, shape) in shapes.iter().enumerate() {
        std::fs::copy(
            fixture(shape),
            browser.at(&format!("frames/step-{i:06}.off")),
        )
        .unwrap();
    }
    browser.view(&["frames", "--seconds", "3"]);
    let dom = browser.dom("");
    assert!(dom.contains("1 of 4: step-000000.off"));
    assert!(
        dom.contains("8 vertices\n12 triangles"),
        "counts of the first step"
    );
    assert!(dom.contains("aria-pressed=\"false\""));
    let dom = browser.dom("step=3");
    assert!(dom.contains("3 of 4: step-000002.off"));
    assert!(
        dom.contains("2,775 vertices\n5,558 triangles"),
        "counts of the third step"
    );
    // Eight seconds of the page's clock.
    let dom = browser.dom("play=on");
    assert!(dom.contains("aria-pressed=\"true\"") && dom.contains(">Pause<"));
    assert!(
        dom.contains("2 of 4: ") || dom.contains("3 of 4: "),
        "it has not moved"
    );
    let first = browser.shot("first-step", "panel=off&view=front");
    let last = browser.shot("last-step", "panel=off&view=front&step=4");
    let other = browser.shot("second-step", "panel=off&view=front&step=2");
    assert!(first == last && first != other && covered(&other) > 2000);
}

fn keys_wheel_and_pointer_turn_the_shape(browser: &Browser) {
    let key = "const key = (key) => document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));";
    let canvas = "const canvas = document.getElementById('canvas'); canvas.setPointerCapture = () => {}; \
                  canvas.releasePointerCapture = () => {};";
    let pointer = "const point = (type, x, y, target = canvas) => target.dispatchEvent(new PointerEvent(type, { pointerId: 1, \
                   pointerType: 'mouse', button: 0, buttons: 1, clientX: x, clientY: y, bubbles: true, cancelable: true }));";
    let shot = |name: &str, script: &str| {
        browser.view(&[&fixture("elephant.off")]);
        browser.script(script);
        browser.shot(name, "panel=off&view=front")
    };
    let still = shot("still", "");
    let turned = shot(
        "turned",
        &format!("{key} for (let i = 0; i < 5; i++) key('ArrowLeft');"),
    );
    let back = shot(
        "back",
        &format!("{key} key('ArrowLeft'); key('r'); key('1');"),
    );
    let near = shot("near", &format!("{key} key('+'); key('+');"));
    let wheel = "canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: -300, bubbles: true, cancelable: true, clientX: 350, clientY: 250 }));";
    let wheel = shot("wheel", &format!("{canvas} {wheel}"));
    let dragged = format!(
        "{canvas} {pointer} point('pointerdown', 350, 250); point('pointermove', 450, 250, document); \
         point('pointermove', 450, 250); point('pointerup', 450, 250, document); point('pointerup', 450, 250);"
    );
    let dragged = shot("dragged", &dragged);
    let bare = shot("bare", &format!("{key} key('s');"));
    let differ =
        |a: &RgbaImage, b: &RgbaImage| a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    assert!(
        differ(&still, &turned) > 3000,
        "{}",
        differ(&still, &turned)
    );
    assert_eq!(differ(&still, &back), 0);
    assert!(covered(&near) > covered(&still) * 5 / 4);
    assert!(covered(&wheel) > covered(&still) * 11 / 10);
    assert!(
        differ(&still, &dragged) > 3000,
        "{}",
        differ(&still, &dragged)
    );
    assert_eq!(covered(&bare), 0);
}

fn layers_have_boxes_and_points_show(browser: &Browser) {
    browser.view(&[&fixture("kitten.xyz"), &fixture("half.xyz")]);
    let dom = browser.dom("");
    assert_eq!(dom.matches("class=\"chip\"").count(), 2);
    assert!(dom.contains("kitten.xyz") && dom.contains("half.xyz"));
    let whole = browser.shot("layers", "panel=off");
    assert!(covered(&whole) > 10_000);
    browser.script("for (const box of document.querySelectorAll('#layers input')) box.click();");
    assert_eq!(covered(&browser.shot("no-layers", "panel=off")), 0);
}

fn a_wicked_name_is_only_a_name(browser: &Browser) {
    let name = "<img src=x onerror=alert(1)>&amp;'\"<script>1<!--.off";
    std::fs::copy(fixture("analytic/cube.off"), browser.at(name)).unwrap();
    browser.view(&[name]);
    let dom = browser.dom("");
    let shown = "&lt;img src=x onerror=alert(1)&gt;&amp;amp;'\"&lt;script&gt;1&lt;!--.off";
    assert!(dom.contains(&format!("<h1 id=\"title\">{shown}</h1>")));
    assert!(dom.contains(&format!("<title>{shown}</title>")));
    assert!(!dom.contains("<img"));
}

/// The addresses that a page asked for, by the browser's log.
fn asked(browser: &Browser) -> Vec<String> {
    let log = browser.at("net.json");
    browser.open(
        "",
        &[
            "--dump-dom".to_owned(),
            format!("--log-net-log={}", log.display()),
        ],
    );
    let text = std::fs::read_to_string(log).unwrap();
    // The browser's own errands have no page behind them.
    let lines = text
        .lines()
        .filter(|line| line.contains("\"initiator\":\""));
    let lines = lines.filter(|line| !line.contains("\"initiator\":\"not an origin\""));
    let address = |line: &str| {
        let (_, after) = line.split_once("\"url\":\"")?;
        Some(after.split('"').next()?.to_owned())
    };
    let remote = |url: &String| !url.starts_with("file:") && !url.starts_with("data:");
    lines.filter_map(address).filter(remote).collect()
}

fn nothing_is_asked_of_the_network(browser: &Browser) {
    browser.view(&[&fixture("analytic/cube.off")]);
    assert_eq!(asked(browser), Vec::<String>::new());
    // The log would show it: a page that asks, without the policy that forbids it.
    let page = browser.at("page.html");
    let html = std::fs::read_to_string(&page).unwrap();
    let html = html.replace(
        "default-src 'none';",
        "default-src * 'unsafe-inline' data:;",
    );
    std::fs::write(&page, html).unwrap();
    browser.script("fetch('http://example.invalid/asked', { mode: 'no-cors' }).catch(() => {});");
    let log = browser.at("net.json");
    let url = format!("file://{}", page.display());
    let _ = Command::new(&browser.program)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--no-first-run",
            "--dump-dom",
        ])
        .args([
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ])
        .args([
            "--host-resolver-rules=MAP * ~NOTFOUND",
            "--virtual-time-budget=4000",
        ])
        .arg(format!("--log-net-log={}", log.display()))
        .arg(format!(
            "--user-data-dir={}",
            browser.at("profile").display()
        ))
        .arg(url)
        .output()
        .unwrap();
    let text = std::fs::read_to_string(log).unwrap();
    let line = text
        .lines()
        .find(|line| line.contains("example.invalid/asked"));
    assert!(
        line.is_some_and(|line| !line.contains("not an origin")),
        "{line:?}"
    );
}
