//! Ctrl-C: the work is asked to stop; if it does not at once, the program ends without it.
//!
//! A file that is being written is the one thing that must not be left alone: its temporary name is removed by the
//! writer, which asks for interruptions itself.

use crate::failure::Failure;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::thread;
use std::time::{Duration, Instant};

/// What the shell expects of a program that SIGINT ended.
pub const EXIT_CODE: u8 = 130;

/// How long the work may take to notice.
const PATIENCE: Duration = Duration::from_millis(500);

/// How long a writer may take: it asks often, but a disk can be slow, and a pipe that nobody reads never ends.
const WRITER_PATIENCE: Duration = Duration::from_secs(5);

static REQUESTED: AtomicBool = AtomicBool::new(false);
static WRITING: AtomicBool = AtomicBool::new(false);
static FINISHED: AtomicBool = AtomicBool::new(false);

/// Starts to listen for Ctrl-C, and for the signals of termination.
pub fn listen() -> Result<(), Failure> {
    let handler = || {
        REQUESTED.store(true, SeqCst);
        thread::sleep(PATIENCE);
        let pressed = Instant::now();
        while WRITING.load(SeqCst) && pressed.elapsed() < WRITER_PATIENCE {
            thread::sleep(PATIENCE / 50);
        }
        if !FINISHED.load(SeqCst) {
            eprintln!("interrupted");
            process::exit(i32::from(EXIT_CODE));
        }
    };
    ctrlc::set_handler(handler).map_err(|error| Failure::Signals(error.to_string()))
}

/// Whether Ctrl-C was pressed.
pub fn requested() -> bool {
    REQUESTED.load(SeqCst)
}

/// The work is over, one way or the other: nothing needs to be ended any more.
pub fn finished() {
    FINISHED.store(true, SeqCst);
}

/// Runs what writes a file: it is not cut off, but must ask [`requested`] itself.
pub fn while_writing<T>(write: impl FnOnce() -> T) -> T {
    WRITING.store(true, SeqCst);
    let result = write();
    WRITING.store(false, SeqCst);
    result
}
