//! `cargo xtask bench --instructions`: how many instructions the tetrahedralisation takes, which no noise can blur.
//!
//! Small fixed workloads run under callgrind, of Debian's `valgrind`; the counts are compared with those stored in
//! `docs/benchmarks/instructions.json`. They are the same from run to run; another compiler, or a processor with other vector
//! registers, changes them a little.

use crate::Outcome;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const NAME: &str = "instructions.json";

/// Kind, count and work of `count_delaunay`.
const WORKLOADS: [[&str; 3]; 12] = [
    ["uniform", "20000", "tetrahedralize"],
    ["sphere", "20000", "tetrahedralize"],
    ["torus", "10000", "tetrahedralize"],
    ["grid", "19683", "tetrahedralize"],
    ["rounded", "20000", "tetrahedralize"],
    ["weighted", "20000", "tetrahedralize"],
    ["uniform", "5000", "locate"],
    ["uniform", "5000", "insert"],
    ["uniform", "5000", "remove"],
    ["grid", "4913", "locate"],
    ["grid", "4913", "insert"],
    ["grid", "4913", "remove"],
];

/// A count that is higher by more than this part fails.
const TOLERANCE: f64 = 0.02;

/// Counts by workload, in order.
type Counts = Vec<(String, u64)>;

/// Counts, and compares or, with `--accept`, stores.
pub fn run(root: &Path, words: &[&str]) -> Outcome {
    let accept = match words {
        [] => false,
        ["--accept"] => true,
        _ => return Err("bench --instructions knows --accept only".into()),
    };
    let path = root.join("docs/benchmarks").join(NAME);
    let counts = count_all(root)?;
    if accept {
        let text = serde_json::to_string_pretty(&to_json(&counts, &about()))
            .map_err(|error| format!("{NAME}: {error}"))?;
        return super::write_page(root, NAME, &(text + "\n"));
    }
    let stored: Value = serde_json::from_str(&crate::read(&path)?)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let was = stored["about"].as_str().unwrap_or_default();
    if was != about() {
        eprintln!("stored with {was}; here {}", about());
    }
    let (table, more) = compare(&counts, &stored["counts"]);
    eprint!("{table}");
    match more.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "more instructions than stored: {}; --accept stores these",
            more.join(", ")
        )),
    }
}

fn about() -> String {
    let first = |program: &str| {
        let output = Command::new(program).arg("--version").output();
        output.map_or(String::new(), |output| {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        })
    };
    format!("{}, {}", first("rustc"), first("valgrind"))
}

fn count_all(root: &Path) -> Result<Counts, String> {
    let program = super::delaunay_examples(root, &["count_delaunay"])?.join("count_delaunay");
    let target = super::target_folder(root)?;
    let out = format!(
        "--callgrind-out-file={}",
        target.join("callgrind.out").to_string_lossy()
    );
    let program = program.to_string_lossy();
    WORKLOADS
        .iter()
        .map(|[kind, count, work]| {
            let words = [
                "--tool=callgrind",
                "--toggle-collect=*counted*",
                &out,
                &program,
                kind,
                count,
                work,
            ];
            let run = Command::new("valgrind")
                .args(words)
                .output()
                .map_err(|error| format!("valgrind: {error}; is it installed?"))?;
            let said = String::from_utf8_lossy(&run.stderr);
            let counted = collected(&said).filter(|_| run.status.success());
            let counted = counted.ok_or_else(|| format!("{}: {said}", run.status))?;
            eprintln!("{work} {kind} {count}: {counted}");
            Ok((format!("{work} {kind} {count}"), counted))
        })
        .collect()
}

/// The count in what callgrind says; none if nothing was counted.
fn collected(said: &str) -> Option<u64> {
    let line = said.lines().find(|line| line.contains("Collected :"))?;
    let count = line.rsplit(' ').next()?.parse().ok()?;
    (count > 0).then_some(count)
}

fn to_json(counts: &Counts, about: &str) -> Value {
    let counts: Map<String, Value> = counts
        .iter()
        .map(|(name, count)| (name.clone(), json!(count)))
        .collect();
    json!({ "about": about, "counts": counts })
}

/// A table, and the workloads that take more than they should. One that is not stored has nothing to be compared with, and
/// counts as more.
fn compare(counts: &Counts, stored: &Value) -> (String, Vec<String>) {
    let mut table = String::new();
    let mut more = Vec::new();
    for (name, count) in counts {
        let Some(was) = stored[name].as_u64() else {
            let _ = writeln!(table, "{name:32} {count:>12}  not stored");
            more.push(name.clone());
            continue;
        };
        let change = *count as f64 / was as f64 - 1.0;
        let _ = writeln!(table, "{name:32} {count:>12}  {:+.2} %", 100.0 * change);
        if change > TOLERANCE {
            more.push(name.clone());
        }
    }
    (table, more)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_is_read() {
        let said = "==7== Events    : Ir\n==7== Collected : 366370141\n==7==\n";
        assert_eq!(collected(said), Some(366_370_141));
        // A function whose name is not found collects nothing: that is no count.
        assert_eq!(collected("==7== Collected : 0\n"), None);
        assert_eq!(collected(""), None);
    }

    #[test]
    fn more_is_found_and_less_is_not() {
        let stored = to_json(
            &vec![("a".into(), 1000), ("b".into(), 1000), ("c".into(), 1000)],
            "x",
        );
        let counts = vec![
            ("a".into(), 1019),
            ("b".into(), 1021),
            ("c".into(), 500),
            ("d".into(), 1),
        ];
        let (table, more) = compare(&counts, &stored["counts"]);
        assert_eq!(more, ["b", "d"]);
        assert!(table.contains("-50.00 %") && table.contains("not stored"));
    }
}
