//! The rules of the house that neither rustc nor clippy knows. Each check is a function of text that returns
//! *all* its findings, so that a test can make it fail.

mod citations;
mod files;
pub mod fixtures;
mod floors;
mod lengths;
mod links;
mod manifests;
mod paths;
mod printing;
mod source;

use crate::{Outcome, cargo_metadata, read};
use files::Kind;
use std::fmt;
use std::path::Path;

/// A broken rule, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The file, relative to the workspace.
    file: String,
    /// The line, from 1; 0 for the file as a whole.
    line: usize,
    /// What is wrong.
    message: String,
}

impl Finding {
    fn new(file: &str, line: usize, message: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line,
            message: message.into(),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file, self.message),
            line => write!(f, "{}:{line}: {}", self.file, self.message),
        }
    }
}

/// Runs every check and prints every finding.
pub fn run(root: &Path) -> Outcome {
    let findings = all_findings(root)?;
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => Ok(()),
        count => Err(format!("tidy: {count} finding(s)")),
    }
}

fn all_findings(root: &Path) -> Result<Vec<Finding>, String> {
    let packages = floors::packages(&cargo_metadata(root)?)?;
    let mut findings = floors::check(&read(&root.join("docs/ARCHITECTURE.md"))?, &packages);
    findings.extend(files::check_top_level(&files::top_level(root)?));
    findings.extend(fixtures::check(
        &read(&root.join("fixtures/README.md"))?,
        &files::fixtures(root)?,
    ));
    findings.extend(manifests::check(root, &packages));

    let keys = citations::keys(&read(&root.join("docs/BIBLIOGRAPHY.md"))?);
    for file in files::texts(root)? {
        findings.extend(paths::check(&file.name, &file.text));
        match file.kind {
            Kind::Source { library } => {
                findings.extend(citations::check_source(&file.name, &file.text, &keys));
                findings.extend(lengths::check(&file.name, &file.text));
                if library {
                    findings.extend(printing::check(&file.name, &file.text));
                }
            }
            Kind::TestSource => {
                findings.extend(citations::check_source(&file.name, &file.text, &keys));
            }
            Kind::Prose => {
                findings.extend(citations::check_prose(&file.name, &file.text, &keys));
                let exists = |path: &str| root.join(path).exists();
                findings.extend(links::check(&file.name, &file.text, exists));
            }
            Kind::Other => {}
        }
    }
    Ok(findings)
}
