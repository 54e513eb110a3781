//! What was measured, kept as JSON, so that inputs can be measured one by one and the page made anew.

use super::runs::Runs;
use crate::Outcome;
use serde_json::{Value, json};
use std::path::Path;

const NAME: &str = "delaunay.json";

/// All inputs, and under which circumstances.
#[derive(Debug, Default, PartialEq)]
pub struct Record {
    /// Lines about the machine, the compilers and the programs, of the last measurement with each.
    pub about: Vec<String>,
    pub inputs: Vec<Compared>,
}

/// All programs on one input.
#[derive(Debug, Default, PartialEq)]
pub struct Compared {
    /// `KIND:COUNT` or `file:PATH`.
    pub input: String,
    pub runs: Vec<Runs>,
    /// Whether ours and CGAL's tetrahedra are the same; none if CGAL did not run.
    pub same_set: Option<bool>,
    /// Whether the result is the same, bit for bit, for several numbers of threads.
    pub identical: Option<bool>,
    /// Whether the exact checker found nothing; none if it did not run.
    pub checked: Option<bool>,
    /// How many processes wanted to run, besides: the load of the machine before.
    pub load: Option<f64>,
}

impl Compared {
    pub fn of(input: &str) -> Self {
        Self {
            input: input.to_owned(),
            load: crate::bench::load(),
            ..Self::default()
        }
    }

    /// The runs of a program with so many threads, if it was measured.
    pub fn runs_of(&self, program: &str, threads: usize) -> Option<&Runs> {
        self.runs
            .iter()
            .find(|runs| runs.program == program && runs.threads == threads && runs.is_measured())
    }

    /// What is wrong with our result, if anything is.
    pub fn defect(&self) -> Option<String> {
        let found = [
            (self.same_set, "the sets of tetrahedra differ"),
            (self.identical, "another result with other threads"),
            (self.checked, "the exact checker finds defects"),
        ];
        let what = found.into_iter().find(|(sound, _)| *sound == Some(false))?;
        Some(format!("{}: {}", self.input, what.1))
    }

    fn to_json(&self) -> Value {
        json!({
            "input": self.input, "same_set": self.same_set, "identical": self.identical,
            "checked": self.checked, "load": self.load,
            "runs": self.runs.iter().map(Runs::to_json).collect::<Vec<_>>(),
        })
    }

    fn of_json(value: &Value) -> Option<Self> {
        let runs = value["runs"].as_array()?.iter().map(Runs::of_json);
        Some(Self {
            input: value["input"].as_str()?.to_owned(),
            runs: runs.collect::<Option<_>>()?,
            same_set: value["same_set"].as_bool(),
            identical: value["identical"].as_bool(),
            checked: value["checked"].as_bool(),
            load: value["load"].as_f64(),
        })
    }
}

impl Record {
    /// Takes in lines about this measurement; what is kept of earlier ones ran with the programs that it says.
    pub fn about_programs(&mut self, lines: Vec<String>) {
        let named =
            |line: &str| -> String { line.chars().take_while(|c| c.is_alphanumeric()).collect() };
        let kept = std::mem::replace(&mut self.about, lines);
        for line in kept {
            if self.about.iter().all(|new| named(new) != named(&line)) {
                self.about.push(line);
            }
        }
    }

    /// Puts an input in the place of its older measurement, or behind the others.
    pub fn put(&mut self, compared: Compared) {
        match self
            .inputs
            .iter_mut()
            .find(|old| old.input == compared.input)
        {
            Some(old) => *old = compared,
            None => self.inputs.push(compared),
        }
    }

    /// The record in a folder; an empty one if there is none yet.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Ok(Self::default());
        }
        let value: Value = serde_json::from_str(&crate::read(&path)?)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        Self::of_json(&value).ok_or_else(|| format!("{}: not a record", path.display()))
    }

    pub fn write(&self, folder: &Path) -> Outcome {
        let path = folder.join(NAME);
        let mut text = serde_json::to_string_pretty(&self.to_json())
            .map_err(|error| format!("{}: {error}", path.display()))?;
        text.push('\n');
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&path, text))
            .map_err(|error| format!("{}: {error}", path.display()))
    }

    fn to_json(&self) -> Value {
        let inputs: Vec<Value> = self.inputs.iter().map(Compared::to_json).collect();
        json!({ "about": self.about, "inputs": inputs })
    }

    fn of_json(value: &Value) -> Option<Self> {
        let words = value["about"].as_array()?.iter();
        let inputs = value["inputs"].as_array()?.iter().map(Compared::of_json);
        Some(Self {
            about: words
                .map(|line| line.as_str().map(str::to_owned))
                .collect::<Option<_>>()?,
            inputs: inputs.collect::<Option<_>>()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_comes_back_as_it_was() {
        let mut record = Record {
            about: vec!["a machine".into()],
            inputs: Vec::new(),
        };
        record.put(Compared {
            input: "uniform:10".into(),
            same_set: Some(true),
            load: Some(0.5),
            runs: vec![Runs::default()],
            ..Compared::default()
        });
        record.put(Compared::of("grid:8"));
        record.put(Compared {
            identical: Some(false),
            ..Compared::of("grid:8")
        });
        assert_eq!(record.inputs.len(), 2);
        assert_eq!(Record::of_json(&record.to_json()), Some(record));
        assert_eq!(Record::of_json(&json!({ "about": [] })), None);
    }

    #[test]
    fn programs_that_do_not_run_again_stay_named() {
        let lines = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect();
        let mut record = Record::default();
        record.about_programs(lines(&["AMD, 2 cores", "CGAL 5.5", "HXT in gmsh: 4.1"]));
        record.about_programs(lines(&["AMD, 4 cores", "CGAL: missing", "TetGen: missing"]));
        assert_eq!(
            record.about,
            [
                "AMD, 4 cores",
                "CGAL: missing",
                "TetGen: missing",
                "HXT in gmsh: 4.1"
            ]
        );
    }

    #[test]
    fn defects_are_told() {
        let mut compared = Compared::of("grid:8");
        assert_eq!(compared.defect(), None);
        compared.checked = Some(true);
        assert_eq!(compared.defect(), None);
        compared.same_set = Some(false);
        assert!(compared.defect().unwrap().starts_with("grid:8: the sets"));
    }
}
