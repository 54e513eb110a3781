//! What was called, and what came out wrong.

use crate::inputs::{Case, FAMILIES, Family};
use pellicle_predicates::Sign;
use std::{collections::BTreeMap, fmt::Write};

/// Of one predicate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub calls: u64,
    /// Calls whose determinant is zero.
    pub ties: u64,
    pub wrong: u64,
}

#[derive(Default)]
pub struct Tally {
    predicates: BTreeMap<&'static str, Counts>,
    families: [u64; FAMILIES.len()],
    now: Option<(Family, Case)>,
    /// The first wrong calls, in words.
    failures: Vec<String>,
}

/// No more failures than these are told.
const MOST_FAILURES: usize = 20;

impl Tally {
    /// The case to which the next calls belong.
    pub fn begin(&mut self, family: Family, case: Case) {
        self.families[family as usize] += 1;
        self.now = Some((family, case));
    }

    /// A call: what it answered, what is true, and whether the determinant itself is zero.
    pub fn call(&mut self, predicate: &'static str, answer: Sign, truth: Sign, plain: Sign) {
        let counts = self.predicates.entry(predicate).or_default();
        counts.calls += 1;
        counts.ties += u64::from(plain == Sign::Zero);
        if answer != truth {
            counts.wrong += 1;
            if self.failures.len() < MOST_FAILURES {
                let case = self.now;
                self.failures.push(format!(
                    "{predicate}: {answer:?}, truly {truth:?}: {case:?}"
                ));
            }
        }
    }

    pub fn predicates(&self) -> impl Iterator<Item = (&'static str, Counts)> {
        self.predicates
            .iter()
            .map(|(&name, &counts)| (name, counts))
    }

    pub fn wrong_calls(&self) -> u64 {
        self.predicates().map(|(_, counts)| counts.wrong).sum()
    }

    pub fn summary(&self, cases: u64, seed: u64) -> String {
        let mut text = format!("{cases} cases from seed {seed}\n\n");
        text += "| predicate | calls | ties | wrong |\n|---|---|---|---|\n";
        let mut all = Counts::default();
        for (name, counts) in self.predicates() {
            all.calls += counts.calls;
            all.ties += counts.ties;
            all.wrong += counts.wrong;
            let _ = writeln!(
                text,
                "| `{name}` | {} | {} | {} |",
                counts.calls, counts.ties, counts.wrong
            );
        }
        let _ = writeln!(
            text,
            "| all | {} | {} | {} |",
            all.calls, all.ties, all.wrong
        );
        text += "\n| family | cases |\n|---|---|\n";
        for (family, count) in FAMILIES.iter().zip(self.families) {
            let _ = writeln!(text, "| {family:?} | {count} |");
        }
        text += &stages();
        for failure in &self.failures {
            let _ = writeln!(text, "{failure}");
        }
        text
    }
}

/// Which stage decided how many calls.
#[cfg(feature = "statistics")]
fn stages() -> String {
    use pellicle_predicates::statistics::{Predicate, Stage, snapshot};
    let counts = snapshot();
    let mut text = "\n| decided by".to_owned();
    for stage in Stage::ALL {
        let _ = write!(text, " | {stage:?}");
    }
    text += " |\n|---|---|---|---|---|---|---|---|\n";
    for predicate in Predicate::ALL {
        let _ = write!(text, "| {predicate:?}");
        for stage in Stage::ALL {
            let _ = write!(text, " | {}", counts.of(predicate, stage));
        }
        text += " |\n";
    }
    text
}

/// Without the counters nothing is known of it.
#[cfg(not(feature = "statistics"))]
fn stages() -> String {
    String::new()
}
