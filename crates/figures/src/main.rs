//! Makes the figures of the papers, or compares them with the stored ones: `cargo xtask figures`.
#![forbid(unsafe_code)]

use clap::Parser;
use pellicle::geometry::Progress;
use pellicle_figures::store::{self, Outcome, Stored};
use pellicle_figures::{Effort, Error, Figure, Made, Run, figures, page};
use std::io::{IsTerminal as _, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Makes the figures of the papers: SVG, PNG and numbers in docs/figures/, and docs/REPRODUCTION.md.
#[derive(Parser)]
struct Arguments {
    /// Write nothing: make each figure with less effort, and compare its numbers with the stored ones.
    #[arg(long)]
    quick: bool,
    /// Only these, by name.
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    only: Vec<String>,
    /// Print the names, and make nothing.
    #[arg(long)]
    list: bool,
    /// Make no figure, but the page anew from what is stored: after a merge.
    #[arg(long)]
    page: bool,
    /// Where the figures are kept, instead of docs/figures/; the page goes into the folder above.
    #[arg(long)]
    folder: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(bad) => {
            eprintln!("{bad} figure(s) are not as they should be");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// How many figures could not be made, or differ from what is stored.
fn run(arguments: &Arguments) -> Result<usize, Error> {
    let chosen = chosen(&arguments.only)?;
    if arguments.list {
        for figure in chosen {
            println!(
                "{:32} {}, {}",
                figure.name,
                figure.paper.title(),
                figure.number
            );
        }
        return Ok(0);
    }
    let folder = arguments.folder.clone().unwrap_or_else(store::folder);
    if arguments.page {
        write_page(&folder)?;
        return Ok(0);
    }
    let start = Instant::now();
    let mut bad = 0;
    for figure in &chosen {
        let outcome = match arguments.quick {
            true => compare(&folder, figure),
            false => write(&folder, figure),
        };
        if let Err(reason) = outcome {
            eprintln!("{}: {reason}", figure.name);
            bad += 1;
        }
    }
    if !arguments.quick {
        write_page(&folder)?;
    }
    let seconds = start.elapsed().as_secs_f64();
    eprintln!("{} figure(s) in {seconds:.1} s", chosen.len());
    Ok(bad)
}

fn chosen(only: &[String]) -> Result<Vec<&'static Figure>, Error> {
    if only.is_empty() {
        return Ok(figures().collect());
    }
    only.iter()
        .map(|name| {
            let found = figures().find(|figure| figure.name == name);
            found.ok_or_else(|| Error::NoSuchFigure { name: name.clone() })
        })
        .collect()
}

/// Makes the quick figure; `Err` has what differs from the stored numbers.
fn compare(folder: &Path, figure: &Figure) -> Result<(), String> {
    let made = make(figure, Effort::Quick).map_err(|error| error.to_string())?;
    let outcome = Outcome::of(&made).map_err(|error| error.to_string())?;
    let stored = store::read(folder, figure).map_err(|error| error.to_string())?;
    let Some(Stored { quick, .. }) = stored else {
        return Err("nothing is stored: run `cargo xtask figures`".into());
    };
    let lines = quick.differences(&outcome);
    if lines.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "differs from what is stored\n  {}",
            lines.join("\n  ")
        ))
    }
}

/// Makes the quick and the full figure, stores both, and tells what is new in the numbers.
fn write(folder: &Path, figure: &Figure) -> Result<(), String> {
    let stored = store::read(folder, figure).map_err(|error| error.to_string())?;
    let quick = make(figure, Effort::Quick).map_err(|error| error.to_string())?;
    let full = make(figure, Effort::Full).map_err(|error| error.to_string())?;
    if let Some(stored) = stored {
        let outcome = Outcome::of(&full).map_err(|error| error.to_string())?;
        for line in stored.full.differences(&outcome) {
            eprintln!("  {line}");
        }
    }
    store::write(folder, figure, &full, &quick).map_err(|error| error.to_string())
}

/// The page of all figures, of those too that were not made now.
fn write_page(folder: &Path) -> Result<(), Error> {
    let stored: Result<Vec<_>, Error> = figures()
        .map(|figure| Ok((figure, store::read(folder, figure)?)))
        .collect();
    let path = folder.with_file_name("REPRODUCTION.md");
    std::fs::write(&path, page::page(&stored?)).map_err(|reason| Error::File { path, reason })
}

fn make(figure: &Figure, effort: Effort) -> Result<Made, Error> {
    let watch = Watch::new(figure.name);
    let start = Instant::now();
    let made = (figure.make)(&Run {
        effort,
        progress: &watch,
    });
    watch.clear();
    let effort = effort.pick("quick", "full");
    let seconds = start.elapsed().as_secs_f64();
    if let Ok(made) = &made {
        let verdict = made.verdict.word();
        eprintln!("{:32} {effort:5} {seconds:6.1} s  {verdict}", figure.name);
    }
    made
}

/// A line on the terminal that tells what is being done; nothing where there is no terminal.
struct Watch {
    name: &'static str,
    shown: Option<Mutex<Instant>>,
}

impl Watch {
    fn new(name: &'static str) -> Self {
        let terminal = std::io::stderr().is_terminal();
        Self {
            name,
            shown: terminal.then(|| Mutex::new(Instant::now())),
        }
    }

    fn clear(&self) {
        if self.shown.is_some() {
            eprint!("\r\x1b[K");
        }
    }
}

impl Progress for Watch {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        if let Some(shown) = &self.shown
            && let Ok(mut shown) = shown.try_lock()
            && shown.elapsed() > Duration::from_millis(100)
        {
            *shown = Instant::now();
            eprint!("\r\x1b[K{}: {stage} {done}/{total}", self.name);
            // What the terminal does not take is not missed.
            let _ = std::io::stderr().flush();
        }
        ControlFlow::Continue(())
    }
}
