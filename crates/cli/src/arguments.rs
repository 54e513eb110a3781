//! What can be said on the command line.

use crate::commands::{
    compare::Compare, convert::Convert, delaunay::Delaunay, evolve::Evolve, info::Info,
    morph::Morph, normals::Normals, reconstruct::Reconstruct, remesh::Remesh, render::Render,
    repair::Repair, smooth::Smooth, view::View,
};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Turns measured points into clean surfaces.
///
/// The format of a file is known by its extension.
#[derive(Debug, Parser)]
#[command(name = "pellicle", version, after_help = EXIT_CODES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
    /// What every verb understands.
    #[command(flatten)]
    pub global: Global,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.";

/// The verbs; each is described where its arguments are.
#[derive(Debug, Subcommand)]
pub enum Verb {
    Reconstruct(Reconstruct),
    Evolve(Evolve),
    Morph(Morph),
    Delaunay(Delaunay),
    Info(Info),
    Convert(Convert),
    Normals(Normals),
    Smooth(Smooth),
    Remesh(Remesh),
    Repair(Repair),
    Compare(Compare),
    Render(Render),
    View(View),
}

/// What every verb understands; shown after what only one verb does.
#[derive(Debug, Args)]
pub struct Global {
    /// Threads to use; as many as the machine has by default. The result does not depend on it
    #[arg(long, global = true, display_order = 101, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// Say nothing but errors
    #[arg(long, short, global = true, display_order = 102)]
    pub quiet: bool,
    /// Print what was found or done as JSON on standard output
    #[arg(long, global = true, display_order = 103)]
    pub json: bool,
    /// Whether to show how far the work is, on standard error
    #[arg(
        long,
        global = true,
        display_order = 104,
        value_name = "WHEN",
        default_value = "auto"
    )]
    pub progress: ProgressWhen,
}

/// When to show a progress bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressWhen {
    /// If standard error is a terminal
    Auto,
    /// Always
    Bar,
    /// Never
    None,
}

/// Where the result goes.
#[derive(Debug, Args)]
pub struct Target {
    /// The file to write; its extension names the format
    #[arg(long, short, value_name = "OUT")]
    pub output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
    /// How numbers are written where the format leaves a choice
    #[arg(long, value_name = "ENCODING", default_value = "binary")]
    pub encoding: Encoding,
}

/// How numbers are written where the format leaves a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Encoding {
    /// Bytes
    Binary,
    /// Text, with as many digits as read back to the same number
    Text,
}

/// A number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "must be above zero")
}

/// A number that is zero or above.
pub fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |value| value >= 0.0, "must not be negative")
}

/// A finite number that is `good`, or else what it must be.
pub fn number(text: &str, good: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && good(value) => Ok(value),
        Ok(_) => Err(expected.to_owned()),
        Err(error) => Err(error.to_string()),
    }
}
