//! What a figure is, and what making it takes and gives.

use crate::{Error, Number, Sheet};
use pellicle::geometry::{Cancelled, Progress};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A figure of a paper, and the function that makes ours.
#[derive(Clone, Copy)]
pub struct Figure {
    /// The stem of its files: lower case, words joined by hyphens, the paper first.
    pub name: &'static str,
    /// Where it stands.
    pub paper: Paper,
    /// Which one it is there: "figure 1", or a slide's headline.
    pub number: &'static str,
    /// What ours is called.
    pub title: &'static str,
    /// What the paper shows, in a sentence.
    pub shows: &'static str,
    /// Makes it, from the library's public calls.
    pub make: fn(&Run<'_>) -> Result<Made, Error>,
}

/// The papers whose figures are reproduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Paper {
    /// "Robustness", slides of a course by Monique Teillaud.
    Robustness,
    /// Chapter 4 of Dey 2006.
    Cocone,
    /// Zaharescu et al. 2007.
    TransforMesh,
    /// Daniel 2015.
    Evolution,
}

impl Paper {
    /// All of them, in the order of the page.
    pub const ALL: [Self; 4] = [
        Self::Robustness,
        Self::Cocone,
        Self::TransforMesh,
        Self::Evolution,
    ];

    /// Author and title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Robustness => "Teillaud: Robustness (slides of a course)",
            Self::Cocone => "Dey 2006, chapter 4: surface reconstruction by Cocone",
            Self::TransforMesh => "Zaharescu et al. 2007: TransforMesh",
            Self::Evolution => {
                "Daniel 2015: reconstruction of 3D objects by direct surface evolution"
            }
        }
    }
}

/// How much work a figure may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Smaller or fewer cases, some seconds a figure: checked at every change.
    Quick,
    /// What the page shows.
    Full,
}

impl Effort {
    /// One of two values.
    pub fn pick<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// The circumstances under which a figure is made.
pub struct Run<'a> {
    /// How much work it may be.
    pub effort: Effort,
    /// Who watches, and may stop it: for the `…_with` calls of the libraries.
    pub progress: &'a dyn Progress,
}

impl Run<'_> {
    /// Reports progress of the figure's own work; `Err` when it is to stop.
    pub fn step(&self, stage: &'static str, done: u64, total: u64) -> Result<(), Cancelled> {
        Cancelled::check(self.progress.step(stage, done, total))
    }

    /// The path of a file of the workspace's `fixtures/`.
    pub fn fixture(&self, name: &str) -> PathBuf {
        PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures")).join(name)
    }
}

/// A figure, made.
pub struct Made {
    /// The picture.
    pub sheet: Sheet,
    /// The numbers beside it, each with a name of its own.
    pub numbers: Vec<Number>,
    /// How it compares with the paper's. Computed, where numbers can tell.
    pub verdict: Verdict,
    /// Why, in a sentence or a few.
    pub because: String,
}

/// Ours beside the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It shows the same.
    Agrees,
    /// It shows the same, and what the paper leaves wrong or open is right.
    Better,
    /// It shows something else.
    Different,
}

impl Verdict {
    /// The word on the page.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Better => "better",
            Self::Different => "different",
        }
    }
}
