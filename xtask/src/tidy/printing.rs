//! Libraries never print: they emit `tracing` events.

use super::{Finding, source};

const FORBIDDEN: [&str; 7] = [
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
    "dbg!",
    "io::stdout",
    "io::stderr",
];

/// Everything in a library's source that prints, its tests excepted.
pub fn check(file: &str, text: &str) -> Vec<Finding> {
    let code = source::code_only(text);
    let in_tests = source::test_lines(text);
    let mut findings = Vec::new();
    for (index, line) in code.lines().enumerate() {
        if in_tests[index] {
            continue;
        }
        for name in FORBIDDEN.iter().filter(|name| calls(line, name)) {
            findings.push(Finding::new(
                file,
                index + 1,
                format!("a library may not use `{name}`; emit a tracing event"),
            ));
        }
    }
    findings
}

/// Whether `name` stands in the line as a word of its own.
fn calls(line: &str, name: &str) -> bool {
    line.match_indices(name).any(|(at, _)| {
        !line[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_')
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printing_is_found_and_only_where_it_is() {
        let text = "/// println!(\"doc\")\nfn f() {\n    println!(\"{}\", \"eprintln!\");\n    my_print!();\n}\n#[cfg(test)]\nmod tests { fn t() { dbg!(1); } }\nfn g() { dbg!(2); std::io::stderr(); }\n";
        let found: Vec<(usize, bool)> = check("a.rs", text)
            .iter()
            .map(|finding| (finding.line, finding.message.contains("println!")))
            .collect();
        assert_eq!(found, [(3, true), (8, false), (8, false)]);
    }
}
