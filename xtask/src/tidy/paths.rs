//! No path of anybody's machine stands in a file.

use super::Finding;

/// Folders under which only one machine keeps its things. Split, so that this file passes its own check.
const PRIVATE: [(&str, &str); 4] = [
    ("/wo", "rk/"),
    ("/ro", "ot/"),
    ("/ho", "me/"),
    ("/Us", "ers/"),
];

/// The folder of passing files: a name right behind it is somebody's.
const PASSING: (&str, &str) = ("/t", "mp/");

/// Each line with such a path.
pub fn check(file: &str, text: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let private = PRIVATE
            .iter()
            .any(|(head, tail)| has_path(line, &format!("{head}{tail}")));
        if private || has_path(line, &format!("{}{}", PASSING.0, PASSING.1)) {
            findings.push(Finding::new(file, index + 1, "a path of one machine"));
        }
    }
    findings
}

/// Whether an absolute path starts with `folder` and goes on with a name; `docs.rs/work/x` is not one.
fn has_path(line: &str, folder: &str) -> bool {
    line.match_indices(folder).any(|(at, _)| {
        let starts = !line[..at]
            .ends_with(|before: char| before.is_alphanumeric() || "._-}".contains(before));
        let goes_on = line[at + folder.len()..].starts_with(|after: char| after.is_alphanumeric());
        starts && goes_on
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machine_paths_are_found() {
        for (head, tail) in PRIVATE.iter().chain([&PASSING]) {
            let path = format!("let p = \"{head}{tail}someone/x\";");
            assert_eq!(check("a.rs", &path).len(), 1, "{path}");
            let inside = format!("see example.org{head}{tail}someone");
            assert!(check("a.rs", &inside).is_empty(), "{inside}");
        }
        assert!(check("a.rs", "/dev/full and ../fixtures").is_empty());
    }
}
