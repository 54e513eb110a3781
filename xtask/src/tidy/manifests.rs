//! Every crate has a README and inherits the workspace's lints and package data.

use super::Finding;
use super::floors::Package;
use std::path::Path;

/// Checks each package's folder.
pub fn check(root: &Path, packages: &[Package]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in packages {
        let folder = root.join(&package.folder);
        let manifest = format!("{}/Cargo.toml", package.folder);
        let text = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        findings.extend(check_manifest(&manifest, &text));
        let readme = std::fs::read_to_string(folder.join("README.md")).unwrap_or_default();
        findings.extend(check_readme(
            &format!("{}/README.md", package.folder),
            &readme,
        ));
    }
    findings
}

fn check_manifest(file: &str, text: &str) -> Vec<Finding> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let inherits_lints = lines
        .windows(2)
        .any(|pair| pair == ["[lints]", "workspace = true"]);
    let mut findings = Vec::new();
    if !inherits_lints {
        findings.push(Finding::new(
            file,
            0,
            "does not inherit the workspace's lints",
        ));
    }
    for key in ["version", "edition", "rust-version", "license"] {
        if !lines.contains(&format!("{key}.workspace = true").as_str()) {
            findings.push(Finding::new(file, 0, format!("does not inherit `{key}`")));
        }
    }
    findings
}

fn check_readme(file: &str, text: &str) -> Option<Finding> {
    let has_invariants = text.lines().any(|line| line.starts_with("## Invariants"));
    (!has_invariants)
        .then(|| Finding::new(file, 0, "missing, or without a section `## Invariants`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MANIFEST: &str = "[package]\nversion.workspace = true\nedition.workspace = true\nrust-version.workspace = true\nlicense.workspace = true\n\n[lints]\nworkspace = true\n";

    #[test]
    fn manifests_inherit() {
        assert!(check_manifest("Cargo.toml", MANIFEST).is_empty());
        let own_lints = MANIFEST.replace("[lints]\nworkspace = true\n", "[lints.rust]\n");
        assert_eq!(check_manifest("Cargo.toml", &own_lints).len(), 1);
        let own_edition = MANIFEST.replace("edition.workspace = true", "edition = \"2021\"");
        assert_eq!(check_manifest("Cargo.toml", &own_edition).len(), 1);
    }

    #[test]
    fn readmes_list_invariants() {
        assert!(check_readme("README.md", "# a\n## Invariants\n").is_none());
        assert!(check_readme("README.md", "").is_some());
        assert!(check_readme("README.md", "# a\n").is_some());
    }
}
