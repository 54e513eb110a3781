//! What prose points to exists: relative links, and paths in backticks that begin at the workspace.

use super::Finding;

/// The folders at the top that a path in backticks may begin with.
const TOP: [&str; 5] = ["crates/", "docs/", "examples/", "fixtures/", "xtask/"];

/// Each link or path that leads nowhere; `exists` takes a path relative to the workspace.
pub fn check(file: &str, text: &str, exists: impl Fn(&str) -> bool) -> Vec<Finding> {
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut findings = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let links = links(line).map(|link| join(folder, link));
        let paths = quoted(line).map(str::to_owned);
        for path in links.chain(paths).filter(|path| !exists(path)) {
            findings.push(Finding::new(
                file,
                index + 1,
                format!("{path} does not exist"),
            ));
        }
    }
    findings
}

/// The targets of `[text](target)`, those on other sites and within the page excepted.
fn links(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| {
        let target = rest.split_once(')')?.0;
        let path = target.split('#').next().unwrap_or(target);
        (!path.is_empty() && !path.contains("://")).then_some(path)
    })
}

/// The paths in backticks, patterns and commands excepted.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2).filter(|quoted| {
        TOP.iter().any(|top| quoted.starts_with(top)) && !quoted.contains([' ', '*', '…', '<'])
    })
}

/// A path relative to a folder, as one relative to the workspace.
fn join(folder: &str, path: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "." | "" => {}
            ".." => drop(parts.pop()),
            name => parts.push(name),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(file: &str, text: &str) -> Vec<String> {
        let there = ["docs/A.md", "crates/x/src/lib.rs", "crates/"];
        check(file, text, |path| there.contains(&path))
            .into_iter()
            .map(|finding| finding.message)
            .collect()
    }

    #[test]
    fn what_leads_nowhere_is_found() {
        assert_eq!(
            broken(
                "README.md",
                "[a](docs/A.md#x) `crates/x/src/lib.rs` `crates/`"
            ),
            [""; 0]
        );
        assert_eq!(
            broken(
                "docs/B.md",
                "[a](A.md) [b](../docs/A.md) [c](https://d.e/f) [g](#h)"
            ),
            [""; 0]
        );
        assert_eq!(broken("README.md", "[a](A.md)"), ["A.md does not exist"]);
        assert_eq!(
            broken("docs/B.md", "x `crates/y.rs`, `crates/*/z` `b/c`"),
            ["crates/y.rs does not exist"]
        );
    }
}
