//! A file has at most [`LIMIT`] lines without its tests, or says why.

use super::{Finding, source};

/// Lines of a source file, its tests not counted.
const LIMIT: usize = 600;

/// How a longer file begins the comment that says why, within its first [`HEADER`] lines.
const REASON: &str = "// Length: ";

const HEADER: usize = 60;

/// The file's finding, if it is too long without a reason of at least three words.
pub fn check(file: &str, text: &str) -> Option<Finding> {
    let lines = source::test_lines(text)
        .iter()
        .filter(|in_test| !**in_test)
        .count();
    let excused = text
        .lines()
        .take(HEADER)
        .filter_map(|line| line.strip_prefix(REASON))
        .any(|reason| reason.split_whitespace().count() >= 3);
    (lines > LIMIT && !excused).then(|| {
        Finding::new(
            file,
            0,
            format!("{lines} lines without tests: split it, or begin a comment with `{REASON}…`"),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_files_need_a_reason() {
        let long = "fn f() {}\n".repeat(LIMIT + 1);
        assert!(check("a.rs", &long).is_some());
        assert!(check("a.rs", &"fn f() {}\n".repeat(LIMIT)).is_none());
        assert!(check("a.rs", &format!("// Length: \n{long}")).is_some());
        let reason = "// Length: one table of cases\n";
        assert!(check("a.rs", &format!("{reason}{long}")).is_none());
        assert!(check("a.rs", &format!("{long}{reason}")).is_some());
    }

    #[test]
    fn tests_do_not_count() {
        let tests = format!(
            "#[cfg(test)]\nmod tests {{\n{}}}\n",
            "fn t() {}\n".repeat(LIMIT + 1)
        );
        assert!(check("a.rs", &tests).is_none());
    }
}
