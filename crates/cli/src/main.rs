//! The command line of Pellicle: one file a subcommand, under `commands`.
#![forbid(unsafe_code)]

mod arguments;
mod commands;
mod failure;
mod interrupt;
mod output;
mod page;
mod progress;
mod scalar;
mod snapshots;
mod surface;

use arguments::{Arguments, Global};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome =
        prepare(&arguments.global).and_then(|()| commands::run(arguments.verb, &arguments.global));
    interrupt::finished();
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_interruption() => {
            eprintln!("interrupted");
            ExitCode::from(interrupt::EXIT_CODE)
        }
        Err(failure) => {
            eprintln!("{:?}", miette::Report::new(failure));
            ExitCode::FAILURE
        }
    }
}

/// Logs to standard error, threads, and Ctrl-C.
fn prepare(global: &Global) -> Result<(), Failure> {
    let level = if global.quiet {
        tracing::Level::ERROR
    } else {
        tracing::Level::INFO
    };
    tracing_subscriber::fmt()
        .with_writer(|| progress::Log)
        .with_max_level(level)
        .with_target(false)
        .without_time()
        .init();
    if let Some(threads) = global.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global()
            .map_err(|error| Failure::Threads(error.to_string()))?;
    }
    interrupt::listen()
}
