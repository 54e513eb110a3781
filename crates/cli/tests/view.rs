//! What `view` puts into a page; `browser.rs` looks at it.

mod common;

use common::{fixture, json, names, pellicle, stderr};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

/// The description that the viewer reads.
fn description(page: &Path) -> Value {
    let html = std::fs::read_to_string(page).unwrap();
    let (_, after) = html.split_once("id=\"description\">").unwrap();
    let (text, _) = after.split_once("</script>").unwrap();
    serde_json::from_str(text).unwrap()
}

fn item_names(description: &Value) -> Vec<&str> {
    let items = description["items"].as_array().unwrap();
    items
        .iter()
        .map(|item| item["name"].as_str().unwrap())
        .collect()
}

#[test]
fn several_files_are_layers_and_numbered_ones_steps() {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let cube = fixture("analytic/cube.off");
    std::fs::create_dir(at("frames")).unwrap();
    for name in [
        "frames/step-000010.off",
        "frames/step-000002.off",
        "frames/step-9.off",
    ] {
        std::fs::copy(&cube, at(name)).unwrap();
    }
    std::fs::write(at("frames/table1.json"), "{}").unwrap();
    std::fs::write(at("frames/readme.txt"), "not a step").unwrap();
    let elephant = fixture("elephant.off");
    let view = |arguments: &[&str]| {
        let common = ["-o", "page.html", "--force"];
        let done = json(folder.path(), &[&["view"], arguments, &common].concat());
        (done, description(&at("page.html")))
    };

    let (done, found) = view(&[&cube, &elephant]);
    assert_eq!(
        (&done["shown"], &found["shown"]),
        (&"layers".into(), &"layers".into())
    );
    assert_eq!(item_names(&found), ["cube.off", "elephant.off"]);
    assert_eq!(found["title"], "cube.off, elephant.off");
    let counts = |at: usize| {
        (
            done["items"][at]["vertices"].clone(),
            done["items"][at]["triangles"].clone(),
        )
    };
    assert_eq!(counts(0), (8.into(), 12.into()));
    assert_eq!(counts(1), (2775.into(), 5558.into()));

    // By number, not by letter.
    let steps = ["step-000002.off", "step-9.off", "step-000010.off"];
    let (done, found) = view(&[
        "frames",
        "--seconds",
        "0.25",
        "--up",
        "z",
        "--title",
        "Cubes",
    ]);
    assert_eq!(
        (&done["shown"], item_names(&found)),
        (&"steps".into(), steps.to_vec())
    );
    assert_eq!(found["seconds"], 0.25);
    assert_eq!(
        (&found["up"], &found["title"]),
        (&"z".into(), &"Cubes".into())
    );
    // As they are named: the order of the command line.
    let (_, found) = view(&["frames/step-9.off", "frames/step-000002.off"]);
    assert_eq!(
        (&found["shown"], item_names(&found)),
        (&"steps".into(), vec![steps[1], steps[0]])
    );
    assert_eq!(view(&["frames", "--as", "layers"]).1["shown"], "layers");
    assert_eq!(
        view(&[&cube, &elephant, "--as", "steps"]).1["shown"],
        "steps"
    );
    assert_eq!(view(&[&cube]).1["shown"], "layers");
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("bare")).unwrap();
    std::fs::write(folder.path().join("none.off"), "OFF\n0 0 0\n").unwrap();
    let nan = "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n";
    std::fs::write(folder.path().join("nan.off"), nan).unwrap();
    let before = names(folder.path());
    for (input, expected) in [
        ("bare", "numbered"),
        ("none.off", "none.off"),
        ("nan.off", "line 4"),
        ("missing.off", "missing.off"),
    ] {
        let assert = pellicle(folder.path())
            .args([
                "view",
                &fixture("analytic/cube.off"),
                input,
                "-o",
                "page.html",
            ])
            .assert()
            .code(1);
        let message = stderr(&assert);
        assert!(message.contains(expected), "{input}: {message}");
        assert_eq!(names(folder.path()), before);
    }
}

#[test]
fn the_same_files_make_the_same_page() {
    let folder = tempdir().unwrap();
    for (threads, page) in [("1", "a.html"), ("3", "b.html")] {
        pellicle(folder.path())
            .args([
                "view",
                &fixture("kitten.xyz"),
                "-o",
                page,
                "--threads",
                threads,
            ])
            .assert()
            .success();
    }
    let bytes = |page: &str| std::fs::read(folder.path().join(page)).unwrap();
    assert!(bytes("a.html") == bytes("b.html"));
}
