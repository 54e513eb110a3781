//! Every fixture stands in the licence table, and the table names nothing else.

use super::Finding;

const TABLE: &str = "fixtures/README.md";

/// The licences under which a fixture may be committed.
const LICENCES: [&str; 4] = ["CC0-1.0", "MIT", "BSD-3-Clause", "MIT OR Apache-2.0"];

/// The files that the table lists, in its order.
pub fn listed(table: &str) -> Vec<String> {
    rows(table)
        .map(|(_, cells)| cells[1].trim_matches('`').to_owned())
        .collect()
}

fn rows(table: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    table
        .lines()
        .enumerate()
        .filter(|(_, line)| line.starts_with("| `"))
        .map(|(index, line)| (index + 1, line.split('|').map(str::trim).collect()))
}

/// Compares the table with the names of the files under `fixtures/`.
pub fn check(table: &str, files: &[String]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut listed = Vec::new();
    for (line, cells) in rows(table) {
        let name = cells[1].trim_matches('`');
        listed.push(name);
        if !files.iter().any(|file| file == name) {
            findings.push(Finding::new(TABLE, line, format!("no such file: {name}")));
        }
        match cells.get(6) {
            Some(licence) if LICENCES.contains(licence) => {}
            _ => findings.push(Finding::new(
                TABLE,
                line,
                format!("{name}: licence unknown"),
            )),
        }
        if cells.get(7).is_none_or(|source| source.is_empty()) {
            findings.push(Finding::new(TABLE, line, format!("{name}: no source")));
        }
    }
    for file in files {
        if file != "README.md" && !listed.contains(&file.as_str()) {
            findings.push(Finding::new(TABLE, 0, format!("{file} is not listed")));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_and_folder_agree() {
        let row = "| `a.xyz` | 5 | – | scan | – | CC0-1.0 | somewhere |\n";
        let files = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<Vec<_>>();
        assert!(check(row, &files(&["README.md", "a.xyz"])).is_empty());
        assert_eq!(check(row, &files(&["a.xyz", "b.off"])).len(), 1);
        assert_eq!(check(row, &files(&[])).len(), 1);
        assert_eq!(
            check(&row.replace("CC0-1.0", "?"), &files(&["a.xyz"])).len(),
            1
        );
        assert_eq!(
            check(&row.replace("somewhere", ""), &files(&["a.xyz"])).len(),
            1
        );
    }
}
