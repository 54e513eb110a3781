//! Showing how far the work is, and stopping it.

use crate::arguments::{Global, ProgressWhen};
use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pellicle::geometry::Progress;
use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Watches the work: a bar on standard error if wanted, and Ctrl-C.
pub struct Watch {
    bar: Option<ProgressBar>,
    stage: Mutex<&'static str>,
}

/// The bar that is shown, for what is written beside it.
static SHOWN: OnceLock<ProgressBar> = OnceLock::new();

/// Standard error for lines that are no progress: the bar makes way for them.
pub struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let write = || io::stderr().write(bytes);
        match SHOWN.get() {
            Some(bar) if !bar.is_finished() => bar.suspend(write),
            _ => write(),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}

impl Watch {
    /// The watch that the command line asks for.
    pub fn new(global: &Global) -> Self {
        let wanted = match global.progress {
            ProgressWhen::Auto => !global.quiet && io::stderr().is_terminal(),
            ProgressWhen::Bar => true,
            ProgressWhen::None => false,
        };
        let bar = wanted.then(|| SHOWN.get_or_init(bar).clone());
        Self {
            bar,
            stage: Mutex::new(""),
        }
    }

    /// Shows a line of text instead of a bar, until the next stage.
    pub fn tell(&self, text: impl FnOnce() -> String) {
        if let Some(bar) = &self.bar {
            let mut shown = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
            let is_first = *shown != TEXT;
            if is_first {
                *shown = TEXT;
                bar.set_style(style("{msg} {elapsed}"));
            }
            bar.set_message(text());
            if is_first {
                // At once, however short ago the last drawing was.
                bar.suspend(|| ());
            } else {
                bar.tick();
            }
        }
    }
}

/// In place of a stage: a text is shown.
const TEXT: &str = "text";
/// How a stage is shown.
const BAR: &str = "{msg:>12} [{bar:40}] {percent:>3}% {elapsed}";

fn bar() -> ProgressBar {
    // Drawn on any stream: `--progress bar` into a file shows what it would on a terminal.
    let target = if io::stderr().is_terminal() {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::term_like_with_hz(Box::new(Plain), 2)
    };
    ProgressBar::with_draw_target(None, target).with_style(style(BAR))
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ")
}

/// Standard error where it is no terminal: a line an update.
#[derive(Debug)]
struct Plain;

impl indicatif::TermLike for Plain {
    fn width(&self) -> u16 {
        80
    }
    fn move_cursor_up(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_down(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_right(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_left(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn write_line(&self, line: &str) -> io::Result<()> {
        self.write_str(line)
    }
    fn write_str(&self, text: &str) -> io::Result<()> {
        let text = text.trim_end();
        if !text.is_empty() {
            eprintln!("{text}");
        }
        Ok(())
    }
    fn clear_line(&self) -> io::Result<()> {
        Ok(())
    }
    fn flush(&self) -> io::Result<()> {
        Ok(())
    }
}

impl Progress for Watch {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        if interrupt::requested() {
            return ControlFlow::Break(());
        }
        if let Some(bar) = &self.bar {
            let mut shown = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
            if *shown != stage {
                if *shown == TEXT {
                    bar.set_style(style(BAR));
                }
                *shown = stage;
                bar.set_message(stage);
            }
            bar.update(|state| {
                state.set_len(total);
                state.set_pos(done);
            });
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
