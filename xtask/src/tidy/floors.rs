//! The floors of `docs/ARCHITECTURE.md` against `cargo metadata`: every arrow goes to a lower floor.

use super::Finding;
use serde_json::Value;

const TABLE: &str = "docs/ARCHITECTURE.md";

/// A package of the workspace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Package {
    /// Its name.
    pub name: String,
    /// Its folder, relative to the workspace.
    pub folder: String,
    /// The workspace's packages that its library or program uses; those of its tests are free.
    pub uses: Vec<String>,
}

/// A row of the table.
#[derive(Debug)]
struct Row {
    line: usize,
    /// `None` for a crate outside the house, which may use nothing.
    floor: Option<u32>,
    name: String,
    may_use: Vec<String>,
}

/// The packages in the answer of `cargo metadata --no-deps`.
pub fn packages(metadata: &str) -> Result<Vec<Package>, String> {
    let metadata: Value =
        serde_json::from_str(metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let root = metadata["workspace_root"].as_str().unwrap_or_default();
    let list = metadata["packages"]
        .as_array()
        .ok_or("cargo metadata: no packages")?;
    let names: Vec<&str> = list.iter().filter_map(|p| p["name"].as_str()).collect();
    let package = |value: &Value| {
        let manifest = value["manifest_path"].as_str().unwrap_or_default();
        let folder = manifest
            .strip_prefix(root)
            .unwrap_or(manifest)
            .trim_end_matches("Cargo.toml")
            .trim_matches(['/', '\\']);
        let uses = value["dependencies"]
            .as_array()
            .map_or(&[][..], Vec::as_slice);
        Package {
            name: value["name"].as_str().unwrap_or_default().to_owned(),
            folder: folder.replace('\\', "/"),
            uses: uses
                .iter()
                .filter(|dependency| dependency["kind"].as_str() != Some("dev"))
                .filter_map(|dependency| dependency["name"].as_str())
                .filter(|name| names.contains(name))
                .map(str::to_owned)
                .collect(),
        }
    };
    Ok(list.iter().map(package).collect())
}

/// Everything in which the table and the packages disagree, and every arrow of the table that goes up.
pub fn check(architecture: &str, packages: &[Package]) -> Vec<Finding> {
    let rows = rows(architecture);
    let mut findings = Vec::new();
    if rows.is_empty() {
        findings.push(Finding::new(TABLE, 0, "no table of floors"));
    }
    for row in &rows {
        findings.extend(check_row(row, &rows, packages));
    }
    for package in packages {
        let Some(row) = rows.iter().find(|row| row.name == package.name) else {
            let message = format!("{} has no floor", package.name);
            findings.push(Finding::new(TABLE, 0, message));
            continue;
        };
        for used in package
            .uses
            .iter()
            .filter(|used| !row.may_use.contains(used))
        {
            findings.push(Finding::new(
                &format!("{}/Cargo.toml", package.folder),
                0,
                format!("{} may not use {used} ({TABLE}:{})", package.name, row.line),
            ));
        }
    }
    findings
}

fn check_row(row: &Row, rows: &[Row], packages: &[Package]) -> Vec<Finding> {
    let mut findings = Vec::new();
    if !packages.iter().any(|package| package.name == row.name) {
        let message = format!("no such crate: {}", row.name);
        findings.push(Finding::new(TABLE, row.line, message));
    }
    for used in &row.may_use {
        let below = rows
            .iter()
            .find(|other| other.name == *used)
            .and_then(|other| other.floor);
        match (below, row.floor) {
            (Some(below), Some(floor)) if below < floor => {}
            _ => findings.push(Finding::new(
                TABLE,
                row.line,
                format!("{used} does not lie on a floor below {}", row.name),
            )),
        }
    }
    findings
}

/// The rows `| floor | crate | one line | may use |`.
fn rows(architecture: &str) -> Vec<Row> {
    architecture
        .lines()
        .enumerate()
        .skip_while(|(_, line)| !line.starts_with("| floor | crate |"))
        .skip(2)
        .take_while(|(_, line)| line.starts_with('|'))
        .filter_map(|(index, line)| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let [floor, name, _, may_use] = cells.as_slice() else {
                return None;
            };
            Some(Row {
                line: index + 1,
                floor: floor.parse().ok(),
                name: name.trim_matches('`').to_owned(),
                may_use: may_use
                    .split(',')
                    .map(str::trim)
                    .filter(|used| !used.is_empty() && *used != "–")
                    .map(full_name)
                    .collect(),
            })
        })
        .collect()
}

/// `geometry` means `pellicle-geometry`; the facade is called `pellicle` alone.
fn full_name(short: &str) -> String {
    match short {
        "pellicle" => short.to_owned(),
        _ => format!("pellicle-{short}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARCHITECTURE: &str = "\
# A
| floor | crate | one line | may use |
|---|---|---|---|
| 0 | `pellicle-geometry` | x | – |
| 1 | `pellicle-mesh` | x | geometry |
| 2 | `pellicle` | x | geometry, mesh |
| – | `xtask` | x | – |

| 9 | `pellicle-other-table` | x | y |
";

    fn package(name: &str, uses: &[&str]) -> Package {
        Package {
            name: name.to_owned(),
            folder: format!("crates/{name}"),
            uses: uses.iter().map(|&used| used.to_owned()).collect(),
        }
    }

    fn house() -> Vec<Package> {
        vec![
            package("pellicle-geometry", &[]),
            package("pellicle-mesh", &["pellicle-geometry"]),
            package("pellicle", &["pellicle-geometry", "pellicle-mesh"]),
            package("xtask", &[]),
        ]
    }

    #[test]
    fn a_sound_house_passes() {
        assert_eq!(check(ARCHITECTURE, &house()), []);
    }

    #[test]
    fn an_arrow_that_the_table_lacks_is_found() {
        for (index, used) in [(0, "pellicle-mesh"), (3, "pellicle-geometry")] {
            let mut packages = house();
            packages[index].uses.push(used.to_owned());
            assert_eq!(check(ARCHITECTURE, &packages).len(), 1, "{used}");
        }
    }

    #[test]
    fn a_table_with_an_arrow_up_or_level_is_found() {
        let up = ARCHITECTURE.replace(
            "| 0 | `pellicle-geometry` | x | – |",
            "| 0 | `pellicle-geometry` | x | mesh |",
        );
        assert_eq!(check(&up, &house()).len(), 1);
        let level = ARCHITECTURE.replace("| 1 | `pellicle-mesh`", "| 0 | `pellicle-mesh`");
        assert_eq!(check(&level, &house()).len(), 1);
    }

    #[test]
    fn strangers_on_either_side_are_found() {
        let mut packages = house();
        packages.push(package("pellicle-new", &[]));
        assert_eq!(check(ARCHITECTURE, &packages).len(), 1);
        packages.truncate(3);
        assert_eq!(check(ARCHITECTURE, &packages).len(), 1);
        assert_eq!(check("", &house()).len(), 1 + house().len());
    }

    #[test]
    fn metadata_gives_names_folders_and_arrows() {
        let metadata = r#"{"workspace_root": "/w", "packages": [
            {"name": "a", "manifest_path": "/w/crates/a/Cargo.toml", "dependencies": [
                {"name": "b", "kind": null}, {"name": "glam", "kind": null}, {"name": "c", "kind": "dev"}]},
            {"name": "b", "manifest_path": "/w/crates/b/Cargo.toml", "dependencies": []},
            {"name": "c", "manifest_path": "/w/c/Cargo.toml", "dependencies": [{"name": "b", "kind": "build"}]}]}"#;
        let packages = packages(metadata).unwrap();
        assert_eq!(packages[0].uses, ["b"]);
        assert_eq!(packages[0].folder, "crates/a");
        assert_eq!(packages[2].uses, ["b"]);
    }
}
