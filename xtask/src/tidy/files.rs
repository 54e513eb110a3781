//! What stands in the workspace, and what kind of thing it is.

use super::Finding;
use std::path::Path;

/// A file with text in it.
pub struct TextFile {
    /// Its path relative to the workspace, with `/`.
    pub name: String,
    /// Its content.
    pub text: String,
    /// What it is.
    pub kind: Kind,
}

/// What a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rust that ships; `library` unless it belongs to a program.
    Source {
        /// Whether it belongs to a library.
        library: bool,
    },
    /// Rust under `tests/`, `benches/` or `examples/`, or a `tests.rs`.
    TestSource,
    /// Markdown.
    Prose,
    /// Anything else.
    Other,
}

/// The names that may stand beside the crates; dot-files may too.
const TOP_LEVEL: [&str; 12] = [
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE",
    "README.md",
    "crates",
    "docs",
    "examples",
    "fixtures",
    "target",
    "xtask",
];

/// Crates and files that are programs: they may print.
const PROGRAMS: [&str; 4] = [
    "crates/cli/",
    "crates/figures/src/main.rs",
    "examples/",
    "xtask/",
];

/// What a path is, by where it stands.
pub fn kind(name: &str) -> Kind {
    if name.ends_with(".md") {
        return Kind::Prose;
    }
    if !name.ends_with(".rs") {
        return Kind::Other;
    }
    let beside = ["/tests/", "/benches/", "/examples/", "/fuzz/"];
    if name.ends_with("/tests.rs") || beside.iter().any(|folder| name.contains(folder)) {
        return Kind::TestSource;
    }
    Kind::Source {
        library: !PROGRAMS.iter().any(|program| name.starts_with(program)),
    }
}

/// Every file of UTF-8 text outside `fixtures/`, build folders and `.git`, in order of name.
pub fn texts(root: &Path) -> Result<Vec<TextFile>, String> {
    let mut names = Vec::new();
    walk(root, "", &mut names)?;
    names.retain(|name| {
        !name.ends_with("Cargo.lock") && !name.starts_with("fixtures/") || name.ends_with(".md")
    });
    let mut texts = Vec::new();
    for name in names {
        let bytes = std::fs::read(root.join(&name)).map_err(|error| format!("{name}: {error}"))?;
        if let Ok(text) = String::from_utf8(bytes) {
            let kind = kind(&name);
            texts.push(TextFile { name, text, kind });
        }
    }
    Ok(texts)
}

/// The files under `fixtures/`, relative to it.
pub fn fixtures(root: &Path) -> Result<Vec<String>, String> {
    let mut names = Vec::new();
    walk(&root.join("fixtures"), "", &mut names)?;
    Ok(names)
}

/// The names at the top of the workspace that are not dot-files.
pub fn top_level(root: &Path) -> Result<Vec<String>, String> {
    Ok(entries(root)?
        .into_iter()
        .map(|(name, _)| name)
        .filter(|name| !name.starts_with('.'))
        .collect())
}

/// Anything at the top that does not belong there.
pub fn check_top_level(names: &[String]) -> Vec<Finding> {
    names
        .iter()
        // What the README's first command makes.
        .filter(|name| !TOP_LEVEL.contains(&name.as_str()) && !name.starts_with("kitten."))
        .map(|name| Finding::new(name, 0, "does not belong at the top level"))
        .collect()
}

fn walk(folder: &Path, prefix: &str, names: &mut Vec<String>) -> Result<(), String> {
    for (name, is_folder) in entries(folder)? {
        let path = format!("{prefix}{name}");
        // In a linked work tree `.git` is a file.
        if matches!(name.as_str(), ".git" | "target") {
            continue;
        }
        if !is_folder {
            names.push(path);
        } else {
            walk(&folder.join(&name), &format!("{path}/"), names)?;
        }
    }
    Ok(())
}

/// Names in a folder, sorted, and whether each is a folder.
fn entries(folder: &Path) -> Result<Vec<(String, bool)>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut entries = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let is_folder = entry.file_type().map_err(failed)?.is_dir();
        entries.push((entry.file_name().to_string_lossy().into_owned(), is_folder));
    }
    entries.sort();
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds() {
        let library = Kind::Source { library: true };
        let program = Kind::Source { library: false };
        for (name, expected) in [
            ("crates/mesh/src/lib.rs", library),
            ("crates/cli/src/main.rs", program),
            ("xtask/src/main.rs", program),
            ("examples/downstream/src/main.rs", program),
            ("crates/figures/src/main.rs", program),
            ("crates/figures/src/lib.rs", library),
            ("crates/mesh/src/soup/tests.rs", Kind::TestSource),
            ("crates/mesh/tests/all.rs", Kind::TestSource),
            ("crates/mesh/examples/time.rs", Kind::TestSource),
            ("README.md", Kind::Prose),
            ("Cargo.toml", Kind::Other),
        ] {
            assert_eq!(kind(name), expected, "{name}");
        }
    }

    #[test]
    fn a_stray_at_the_top_is_found() {
        let names = ["crates".to_owned(), "scratch.py".to_owned()];
        let findings = check_top_level(&names);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].file, "scratch.py");
    }
}
