//! Reading Rust just well enough: which characters are code, which are comment, and which lines are tests.

/// What a character of Rust source belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Code,
    Comment,
    Text,
}

/// The source with comments and the insides of string and character literals blanked; lines keep their place.
pub fn code_only(source: &str) -> String {
    keep(source, Class::Code)
}

/// The source with everything but comments blanked; lines keep their place.
pub fn comments_only(source: &str) -> String {
    keep(source, Class::Comment)
}

/// For each line, from the first, whether it stands in a `#[cfg(test)]` item.
pub fn test_lines(source: &str) -> Vec<bool> {
    let code = code_only(source);
    let mut inside = vec![false; source.lines().count()];
    let mut from = 0;
    while let Some(found) = code[from..].find("#[cfg(test)]") {
        let start = from + found;
        let end = item_end(&code, start);
        let first = code[..start].matches('\n').count();
        let last = code[..end].matches('\n').count();
        for line in inside.iter_mut().take(last + 1).skip(first) {
            *line = true;
        }
        from = end;
    }
    inside
}

/// Where the item at `start` ends: at its matching brace, or at a semicolon before any brace.
fn item_end(code: &str, start: usize) -> usize {
    let mut depth = 0_usize;
    for (offset, character) in code[start..].char_indices() {
        match character {
            '{' => depth += 1,
            '}' if depth <= 1 => return start + offset + 1,
            '}' => depth -= 1,
            ';' if depth == 0 => return start + offset + 1,
            _ => {}
        }
    }
    code.len()
}

fn keep(source: &str, wanted: Class) -> String {
    let characters: Vec<char> = source.chars().collect();
    let classes = classify(&characters);
    characters
        .iter()
        .zip(classes)
        .map(|(&character, class)| match character {
            '\n' => '\n',
            _ if class == wanted => character,
            _ => ' ',
        })
        .collect()
}

fn classify(source: &[char]) -> Vec<Class> {
    let mut classes = vec![Class::Code; source.len()];
    let mut at = 0;
    while at < source.len() {
        let (class, end) = token(source, at);
        for slot in &mut classes[at..end] {
            *slot = class;
        }
        at = end;
    }
    classes
}

/// The class of what starts at `at`, and where it ends.
fn token(source: &[char], at: usize) -> (Class, usize) {
    let next = source.get(at + 1).copied();
    match source[at] {
        '/' if next == Some('/') => (Class::Comment, line_end(source, at)),
        '/' if next == Some('*') => (Class::Comment, block_comment_end(source, at)),
        '"' => (Class::Text, string_end(source, at + 1)),
        'r' | 'b' | 'c' if !follows_word(source, at) => match raw_string(source, at) {
            Some(end) => (Class::Text, end),
            None => (Class::Code, at + 1),
        },
        '\'' => match character_end(source, at) {
            Some(end) => (Class::Text, end),
            None => (Class::Code, at + 1),
        },
        _ => (Class::Code, at + 1),
    }
}

fn follows_word(source: &[char], at: usize) -> bool {
    at > 0 && (source[at - 1].is_alphanumeric() || source[at - 1] == '_')
}

fn line_end(source: &[char], at: usize) -> usize {
    source[at..]
        .iter()
        .position(|&c| c == '\n')
        .map_or(source.len(), |offset| at + offset)
}

fn block_comment_end(source: &[char], at: usize) -> usize {
    let mut depth = 0_usize;
    let mut i = at;
    while i + 1 < source.len() {
        match (source[i], source[i + 1]) {
            ('/', '*') => {
                depth += 1;
                i += 2;
            }
            ('*', '/') => {
                depth -= 1;
                i += 2;
                if depth == 0 {
                    return i;
                }
            }
            _ => i += 1,
        }
    }
    source.len()
}

fn string_end(source: &[char], mut at: usize) -> usize {
    while at < source.len() {
        match source[at] {
            '\\' => at += 2,
            '"' => return at + 1,
            _ => at += 1,
        }
    }
    source.len()
}

/// `r"…"`, `r#"…"#` and their `b` and `c` forms; `None` if no raw string starts here.
fn raw_string(source: &[char], at: usize) -> Option<usize> {
    let mut i = at;
    if matches!(source[i], 'b' | 'c') {
        i += 1;
    }
    if source.get(i) != Some(&'r') {
        return None;
    }
    let hashes = source[i + 1..].iter().take_while(|&&c| c == '#').count();
    i += 1 + hashes;
    if source.get(i) != Some(&'"') {
        return None;
    }
    i += 1;
    while i < source.len() {
        let closes = source[i] == '"'
            && source.len() > i + hashes
            && source[i + 1..=i + hashes].iter().all(|&c| c == '#');
        if closes {
            return Some(i + 1 + hashes);
        }
        i += 1;
    }
    Some(source.len())
}

/// `'x'` or `'\n'`; `None` for a lifetime.
fn character_end(source: &[char], at: usize) -> Option<usize> {
    if source.get(at + 1) == Some(&'\\') {
        let close = source.get(at + 3..)?.iter().position(|&c| c == '\'')?;
        return Some(at + 4 + close);
    }
    (source.get(at + 2) == Some(&'\'')).then_some(at + 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_text_are_blanked() {
        let source = "let a = \"// no\"; // yes\nlet b = 'x'; /* in /* two */ out */ c";
        let code = code_only(source);
        assert!(!code.contains("no") && !code.contains("yes") && !code.contains("out"));
        assert!(code.contains("let b") && code.ends_with(" c"));
        assert_eq!(code.lines().count(), source.lines().count());
        assert!(comments_only(source).contains("// yes"));
        assert!(!comments_only(source).contains("no"));
    }

    #[test]
    fn raw_strings_escapes_and_lifetimes() {
        let source = r###"f::<'a>(r#"a " b"#, "q\"q", '\'', b"z", '\u{1F600}') + end"###;
        let code = code_only(source);
        assert!(
            code.contains("f::<'a>(") && code.ends_with("+ end"),
            "{code}"
        );
        for hidden in ["a \" b", "q", "z", "1F600"] {
            assert!(!code.contains(hidden), "{hidden} in {code}");
        }
    }

    #[test]
    fn test_items_are_found() {
        let source = "fn a() {}\n#[cfg(test)]\nmod tests {\n fn b() { \"}\"; }\n}\nfn c() {}\n#[cfg(test)]\nmod t;\nfn d() {}\n";
        assert_eq!(
            test_lines(source),
            [false, true, true, true, true, false, true, true, false]
        );
    }
}
