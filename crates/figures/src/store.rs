//! Where figures are kept: `NAME.svg`, `NAME.png` and `NAME.json` in one folder.

use crate::{Error, Figure, Made, Number, Verdict, number, raster};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What the JSON beside a picture holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stored {
    /// What the picture shows.
    pub full: Outcome,
    /// What a quick run gives, to be compared with later ones.
    pub quick: Outcome,
}

/// Numbers and verdict of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// How it compares with the paper's.
    pub verdict: Verdict,
    /// Why.
    pub because: String,
    /// The numbers.
    pub numbers: Vec<Number>,
}

impl Outcome {
    /// Without the picture; `Err` if a number cannot be stored.
    pub fn of(made: &Made) -> Result<Self, Error> {
        number::check(&made.numbers)?;
        Ok(Self {
            verdict: made.verdict,
            because: made.because.clone(),
            numbers: made.numbers.clone(),
        })
    }

    /// Every way in which `later` is not what this is; reasons may be worded anew.
    pub fn differences(&self, later: &Self) -> Vec<String> {
        let mut lines = number::differences(&self.numbers, &later.numbers);
        if self.verdict != later.verdict {
            let (new, old) = (later.verdict.word(), self.verdict.word());
            lines.push(format!("the verdict: {new}, was {old}"));
        }
        lines
    }
}

/// The folder of the workspace in which figures are kept.
pub fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/figures"))
}

/// What is stored of a figure; `None` if there is nothing.
pub fn read(folder: &Path, figure: &Figure) -> Result<Option<Stored>, Error> {
    let path = path(folder, figure, "json");
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(reason) => return Err(Error::File { path, reason }),
    };
    match serde_json::from_str(&text) {
        Ok(stored) => Ok(Some(stored)),
        Err(reason) => Err(Error::Stored { path, reason }),
    }
}

/// Writes the picture of `full` as SVG and PNG, and the numbers of both runs as JSON.
pub fn write(folder: &Path, figure: &Figure, full: &Made, quick: &Made) -> Result<(), Error> {
    let stored = Stored {
        full: Outcome::of(full)?,
        quick: Outcome::of(quick)?,
    };
    let svg = full.sheet.svg();
    let png = raster::png(&svg)?;
    let json_path = path(folder, figure, "json");
    let mut json = match serde_json::to_string_pretty(&stored) {
        Ok(json) => json,
        Err(reason) => {
            return Err(Error::Stored {
                path: json_path,
                reason,
            });
        }
    };
    json.push('\n');
    put(folder.to_owned(), |folder| std::fs::create_dir_all(folder))?;
    put(path(folder, figure, "svg"), |path| {
        std::fs::write(path, &svg)
    })?;
    put(path(folder, figure, "png"), |path| {
        std::fs::write(path, &png)
    })?;
    put(json_path, |path| std::fs::write(path, &json))
}

fn path(folder: &Path, figure: &Figure, extension: &str) -> PathBuf {
    folder.join(format!("{}.{extension}", figure.name))
}

fn put(path: PathBuf, how: impl Fn(&Path) -> std::io::Result<()>) -> Result<(), Error> {
    how(&path).map_err(|reason| Error::File { path, reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(verdict: Verdict, value: f64) -> Outcome {
        Outcome {
            verdict,
            because: String::new(),
            numbers: vec![Number::within("a", value, 0.1).unit("m").paper("2")],
        }
    }

    #[test]
    fn another_verdict_is_a_difference() {
        let stored = outcome(Verdict::Agrees, 1.0);
        assert!(
            stored
                .differences(&outcome(Verdict::Agrees, 1.05))
                .is_empty()
        );
        assert_eq!(
            stored.differences(&outcome(Verdict::Different, 1.0)).len(),
            1
        );
        assert_eq!(
            stored.differences(&outcome(Verdict::Different, 2.0)).len(),
            2
        );
    }

    #[test]
    fn what_is_written_is_read_to_the_last_bit() {
        for value in [0.1 + 0.2, 1.0 / 3.0, 5e-324, f64::MAX, -65_536.0] {
            let stored = Stored {
                full: outcome(Verdict::Better, value),
                quick: outcome(Verdict::Agrees, value.next_down()),
            };
            let text = serde_json::to_string(&stored).expect("JSON");
            assert_eq!(
                serde_json::from_str::<Stored>(&text).expect("the same"),
                stored
            );
        }
    }
}
