//! The commands of the guide's chapters work, and its pictures are what comes of them.
#![cfg(unix)]

mod common;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use common::{pellicle, root, stdout};
use std::path::{Path, PathBuf};
use tempfile::tempdir;

/// What a browser draws; `browser.rs` looks at its like.
const OF_A_BROWSER: &str = "view.png";

struct Chapter {
    name: String,
    commands: Vec<String>,
    /// Name and bytes.
    pictures: Vec<(String, Vec<u8>)>,
}

impl Chapter {
    fn all() -> Vec<Self> {
        let folder = root().join("crates/pellicle/src/guide");
        let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
            .collect();
        files.sort();
        files.iter().map(|file| Self::read(&folder, file)).collect()
    }

    fn read(folder: &Path, file: &Path) -> Self {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(file).unwrap();
        let commands = text
            .lines()
            .filter_map(|line| line.strip_prefix("//! pellicle "));
        let shown = text.matches(".png]").count();
        let kept = folder.join(format!("pictures/{name}.md"));
        let kept = match shown {
            0 => String::new(),
            _ => std::fs::read_to_string(kept).unwrap(),
        };
        let picture = |line: &str| {
            let (picture, data) = line
                .strip_prefix('[')?
                .split_once("]: data:image/png;base64,")?;
            assert!(
                text.contains(&format!("][{picture}]")),
                "{name}: {picture} is not shown"
            );
            Some((picture.to_owned(), STANDARD.decode(data).unwrap()))
        };
        let pictures: Vec<_> = kept.lines().filter_map(picture).collect();
        assert_eq!(
            pictures.len(),
            shown,
            "{name}: cargo xtask picture --guide makes the pictures"
        );
        Self {
            commands: commands.map(str::to_owned).collect(),
            pictures,
            name,
        }
    }
}

#[test]
fn the_commands_make_the_pictures() {
    for chapter in Chapter::all() {
        let folder = tempdir().unwrap();
        let fixtures = root().join("fixtures").canonicalize().unwrap();
        std::os::unix::fs::symlink(fixtures, folder.path().join("fixtures")).unwrap();
        for command in &chapter.commands {
            pellicle(folder.path())
                .args(command.split_whitespace())
                .assert()
                .success();
        }
        for (picture, shown) in &chapter.pictures {
            if picture == OF_A_BROWSER {
                continue;
            }
            let made = image::open(folder.path().join(picture))
                .unwrap()
                .into_rgba8();
            let shown = image::load_from_memory(shown).unwrap().into_rgba8();
            assert!(
                shown == made,
                "{}: {picture} is not what its commands make: cargo xtask picture --guide makes it anew",
                chapter.name
            );
        }
    }
}

#[test]
fn every_verb_has_its_place() {
    let folder = tempdir().unwrap();
    let help = stdout(&pellicle(folder.path()).arg("help").assert().success());
    let verbs: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .map_while(|line| line.strip_prefix("  ")?.split_whitespace().next())
        .filter(|verb| *verb != "help")
        .collect();
    assert!(
        verbs.contains(&"reconstruct") && verbs.contains(&"view"),
        "{help}"
    );
    let chapters = Chapter::all();
    let commands: Vec<&String> = chapters.iter().flat_map(|c| &c.commands).collect();
    for verb in verbs {
        let shown = commands
            .iter()
            .any(|command| command.split_whitespace().next() == Some(verb));
        assert!(shown, "no chapter shows `pellicle {verb}`");
    }
}
