//! Citations resolve: "Author Year", "Author and Author Year" and "Author et al. Year", with or without
//! parentheses around the year, must be keys of `docs/BIBLIOGRAPHY.md`.

use super::{Finding, source};
use std::collections::BTreeSet;

/// Capitalised words before a year that are no author.
const NOT_AUTHORS: [&str; 20] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
    "In",
    "Since",
    "Edition",
    "Rust",
    "Copyright",
    "Until",
    "Before",
    "C",
];

/// What may stand before a family name and belongs to it.
const PARTICLES: [&str; 2] = ["van der", "van"];

/// What may stand before a citation.
const OPENING: [char; 5] = ['(', '[', '"', '“', '*'];

/// The keys of the bibliography: lines that begin `- **Key**`.
pub fn keys(bibliography: &str) -> BTreeSet<String> {
    bibliography
        .lines()
        .filter_map(|line| line.strip_prefix("- **")?.split_once("**"))
        .map(|(key, _)| key.to_owned())
        .collect()
}

/// Citations in the comments of Rust source that do not resolve.
pub fn check_source(file: &str, text: &str, keys: &BTreeSet<String>) -> Vec<Finding> {
    check_prose(file, &source::comments_only(text), keys)
}

/// Citations in a text that do not resolve.
pub fn check_prose(file: &str, text: &str, keys: &BTreeSet<String>) -> Vec<Finding> {
    citations(text)
        .into_iter()
        .filter(|(_, key)| !keys.contains(key))
        .map(|(line, key)| {
            Finding::new(
                file,
                line,
                format!("\"{key}\" is not in docs/BIBLIOGRAPHY.md"),
            )
        })
        .collect()
}

/// The citations of a text, each with the line of its year. A citation may run over a line's end; comment
/// marks between its words do not count.
fn citations(text: &str) -> Vec<(usize, String)> {
    let words = text
        .lines()
        .enumerate()
        .flat_map(|(index, line)| line.split_whitespace().map(move |word| (index + 1, word)))
        .filter(|(_, word)| !matches!(*word, "//" | "///" | "//!" | "*" | ">" | "-"));
    let words = with_particles(words);
    (0..words.len())
        .filter_map(|at| {
            let year = year(&words[at].1)?;
            let before: Vec<&str> = words[at.saturating_sub(3)..at]
                .iter()
                .map(|(_, word)| word.as_str())
                .collect();
            Some((words[at].0, format!("{} {year}", authors(&before)?)))
        })
        .collect()
}

/// "van der" and the name that follows as one word: they are part of it.
fn with_particles<'a>(words: impl Iterator<Item = (usize, &'a str)>) -> Vec<(usize, String)> {
    let mut joined: Vec<(usize, String)> = Vec::new();
    for (line, word) in words {
        match joined.last_mut() {
            Some((_, last)) if PARTICLES.contains(&last.trim_start_matches(OPENING)) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => joined.push((line, word.to_owned())),
        }
    }
    joined
}

/// `2003`, `(2003)`, `2003),` and the like.
fn year(word: &str) -> Option<&str> {
    let word = word.strip_prefix('(').unwrap_or(word);
    let digits = word.get(..4)?;
    let rest = &word[4..];
    let plausible = digits.starts_with("19") || digits.starts_with("20");
    let ends = !rest.starts_with(|c: char| c.is_alphanumeric() || "-–/×_'".contains(c));
    // `2000.5` is a number, `2003.` ends a sentence.
    let decimal = rest.starts_with('.') && rest[1..].starts_with(|c: char| c.is_ascii_digit());
    (plausible && digits.bytes().all(|b| b.is_ascii_digit()) && ends && !decimal).then_some(digits)
}

fn authors(before: &[&str]) -> Option<String> {
    match before {
        [.., first, "et", "al."] => Some(format!("{} et al.", author(first)?)),
        [.., first, "and", second] => {
            let second = author(second)?;
            Some(match author(first) {
                Some(first) => format!("{first} and {second}"),
                None => second.to_owned(),
            })
        }
        [.., single] => Some(author(single)?.to_owned()),
        [] => None,
    }
}

/// The word as a family name, without an opening bracket or quotation mark; `None` if it cannot be one.
fn author(word: &str) -> Option<&str> {
    let name = word.trim_start_matches(OPENING);
    let proper = PARTICLES
        .iter()
        .find_map(|particle| name.strip_prefix(particle)?.strip_prefix(' '))
        .unwrap_or(name);
    let starts = proper.chars().next().is_some_and(char::is_uppercase);
    let letters = proper
        .chars()
        .all(|c| c.is_alphabetic() || c == '-' || c == '’');
    let shouted = name.chars().count() > 1 && name.chars().all(|c| c.is_uppercase() || c == '-');
    (starts && letters && !shouted && !NOT_AUTHORS.contains(&name)).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        citations(text).into_iter().map(|(_, key)| key).collect()
    }

    #[test]
    fn every_form_is_read() {
        for (text, key) in [
            ("as in (Shewchuk 1997), the", "Shewchuk 1997"),
            (
                "Devillers and Teillaud 2011: lifted",
                "Devillers and Teillaud 2011",
            ),
            ("Dey and Goswami (2003).", "Dey and Goswami 2003"),
            ("see Amenta et al. 2002; then", "Amenta et al. 2002"),
            ("see Amenta, Choi and Kolluri 2001", "Choi and Kolluri 2001"),
            ("(van der Vorst 1992)", "van der Vorst 1992"),
            ("of\n/// van\n/// der Vorst 1992", "van der Vorst 1992"),
            (
                "Sleijpen and van der Vorst 1995",
                "Sleijpen and van der Vorst 1995",
            ),
            ("O and Müller-Ångström 1999", "O and Müller-Ångström 1999"),
        ] {
            assert_eq!(found(text), [key], "{text}");
        }
    }

    #[test]
    fn numbers_and_dates_are_not() {
        for text in [
            "June 2024",
            "In 1998 it",
            "of 2000 points",
            "Euler 20000",
            "Total 2000.5",
            "edition 2024",
            "ISO 1990",
        ] {
            assert_eq!(found(text), [""; 0], "{text}");
        }
    }

    #[test]
    fn a_citation_runs_over_a_comment_line() {
        let text = "/// (Devillers and\n/// Teillaud 2011)\nlet x = Foo::new(); // Nobody 1999";
        let keys = keys("# B\n- **Devillers and Teillaud 2011** Title.\n");
        let findings = check_source("a.rs", text, &keys);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].line, 3);
        assert!(findings[0].message.contains("Nobody 1999"));
    }

    #[test]
    fn code_is_no_citation() {
        assert!(
            check_source(
                "a.rs",
                "let a = [Foo, 1999]; f(\"Nobody 1999\");",
                &BTreeSet::new()
            )
            .is_empty()
        );
    }
}
