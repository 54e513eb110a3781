//! `cargo xtask picture`, the guide's part: the commands of its chapters, run, and the pictures that they make.
//!
//! A chapter is a file of `crates/pellicle/src/guide/`. Its pictures are kept as data URIs in `pictures/`, since rustdoc
//! takes no file along: so they show without a network, on a machine and on docs.rs.

use crate::{Outcome, execute, read, target_folder};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::path::{Path, PathBuf};
use std::process::Command;

const CHAPTERS: &str = "crates/pellicle/src/guide";
/// Which browser draws the page of `view`; any will do.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// The one picture that a browser makes, and the page in it.
const PAGE: [&str; 2] = ["view.png", "view.html"];
const PAGE_SHOWN_AT: &str = "#step=6&wireframe=on";

/// Makes the pictures of all chapters anew.
pub fn run(root: &Path) -> Outcome {
    // The library does not compile without them.
    for name in chapters(root)? {
        let file = kept(root, &name);
        if !file.exists() {
            std::fs::write(&file, "").map_err(|error| format!("{}: {error}", file.display()))?;
        }
    }
    execute(root, &[], &["cargo", "build", "--package", "pellicle-cli"])?;
    let target = target_folder(root)?;
    let program = target.join("debug/pellicle");
    for name in chapters(root)? {
        let text = read(&root.join(CHAPTERS).join(format!("{name}.rs")))?;
        let pictures = pictures(&text);
        let folder = target.join("guide").join(&name);
        // Usually there is nothing to remove.
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).map_err(|error| format!("{name}: {error}"))?;
        for command in commands(&text) {
            make(root, &folder, &program, &command)?;
        }
        if pictures.contains(&PAGE[0]) && !photograph(&folder)? {
            eprintln!("no browser: {} stays as it is", PAGE[0]);
            continue;
        }
        let file = kept(root, &name);
        let mut definitions = String::new();
        for picture in pictures {
            let bytes = std::fs::read(folder.join(picture))
                .map_err(|error| format!("{name}: {picture}: {error}"))?;
            let data = STANDARD.encode(bytes);
            definitions.push_str(&format!("[{picture}]: data:image/png;base64,{data}\n"));
        }
        std::fs::write(&file, definitions)
            .map_err(|error| format!("{}: {error}", file.display()))?;
        eprintln!("wrote {}: look at {}", file.display(), folder.display());
    }
    Ok(())
}

/// Whether every picture of every chapter stands in what rustdoc made of it.
pub fn check_documentation(root: &Path) -> Outcome {
    let target = target_folder(root)?;
    for name in chapters(root)? {
        let text = read(&root.join(CHAPTERS).join(format!("{name}.rs")))?;
        let page = target.join(format!("doc/pellicle/guide/{name}/index.html"));
        let shown = read(&page)?
            .matches("<img src=\"data:image/png;base64,")
            .count();
        let wanted = pictures(&text).len();
        if shown != wanted {
            return Err(format!(
                "{}: {shown} of {wanted} pictures are shown",
                page.display()
            ));
        }
    }
    Ok(())
}

/// Where the pictures of a chapter are kept.
fn kept(root: &Path, name: &str) -> PathBuf {
    root.join(CHAPTERS).join(format!("pictures/{name}.md"))
}

/// The names of the chapters that show pictures, sorted.
fn chapters(root: &Path) -> Result<Vec<String>, String> {
    let failed = |error: std::io::Error| format!("{CHAPTERS}: {error}");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(root.join(CHAPTERS)).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name();
        if let Some(chapter) = name.to_string_lossy().strip_suffix(".rs") {
            let text = read(&root.join(CHAPTERS).join(format!("{chapter}.rs")))?;
            if !pictures(&text).is_empty() {
                names.push(chapter.to_owned());
            }
        }
    }
    names.sort();
    Ok(names)
}

/// The program's commands in a chapter, without its name.
fn commands(text: &str) -> Vec<String> {
    text.lines()
        .filter_map(|line| line.strip_prefix("//! pellicle "))
        .map(str::to_owned)
        .collect()
}

/// The pictures that a chapter shows: `![what][name.png]`.
fn pictures(text: &str) -> Vec<&str> {
    text.split("][")
        .skip(1)
        .filter_map(|rest| rest.split_once(']'))
        .map(|(name, _)| name)
        .filter(|name| name.ends_with(".png"))
        .collect()
}

fn make(root: &Path, folder: &Path, program: &Path, command: &str) -> Outcome {
    eprintln!("+ pellicle {command}");
    let fixtures = format!("{}/fixtures/", root.display());
    let words = command
        .split_whitespace()
        .map(|word| word.replace("fixtures/", &fixtures));
    let status = Command::new(program)
        .args(words)
        .current_dir(folder)
        .status()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    match status.success() {
        true => Ok(()),
        false => Err(format!("`pellicle {command}` failed: {status}")),
    }
}

/// A picture of the page in a browser without a window; false if there is no browser.
fn photograph(folder: &Path) -> Result<bool, String> {
    let named = std::env::var("PELLICLE_CHROMIUM").ok();
    let browsers = named.iter().map(String::as_str).chain(BROWSERS);
    for browser in browsers {
        let run = Command::new(browser)
            .args(["--headless=new", "--no-sandbox", "--hide-scrollbars"])
            .args(["--use-gl=angle", "--use-angle=swiftshader"])
            .args([
                "--enable-unsafe-swiftshader",
                "--force-device-scale-factor=1",
            ])
            .args(["--virtual-time-budget=8000", "--window-size=800,480"])
            .arg(format!(
                "--user-data-dir={}",
                folder.join("profile").display()
            ))
            .arg(format!("--screenshot={}", folder.join(PAGE[0]).display()))
            .arg(format!(
                "file://{}{PAGE_SHOWN_AT}",
                folder.join(PAGE[1]).display()
            ))
            .output();
        match run {
            Ok(output) if output.status.success() => return Ok(true),
            Ok(output) => return Err(String::from_utf8_lossy(&output.stderr).into_owned()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
            Err(error) => return Err(format!("{browser}: {error}")),
        }
    }
    Ok(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chapter_names_its_commands_and_pictures() {
        let text = "//! ![a][x.png] ![b][y/z.png] [link][other]\n//! ```sh\n//! pellicle info a.ply\n//! ```\n//! pellicled\n";
        assert_eq!(pictures(text), ["x.png", "y/z.png"]);
        assert_eq!(commands(text), ["info a.ply"]);
    }
}
