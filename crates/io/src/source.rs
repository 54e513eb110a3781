//! A file being read: bytes, lines, places and reservations.

use crate::{Error, Location};
use pellicle_geometry::{Cancelled, DVec3, Progress};
use std::io::{BufRead, Read, Seek};
use std::path::Path;

/// What can be read from: a buffered file, or bytes in memory.
pub(crate) trait Input: BufRead + Seek + Send + Sync {}
impl<T: BufRead + Seek + Send + Sync> Input for T {}

/// Longer lines are refused: no point needs one, and a polygon of a million corners does not either.
const LONGEST_LINE: u64 = 16 << 20;

/// Progress is told, and cancellation asked, each time that many bytes have passed.
const TICK: u64 = 1 << 20;

pub(crate) struct Source<'a> {
    input: &'a mut dyn Input,
    path: &'a Path,
    length: u64,
    offset: u64,
    line: u64,
    terminator: u8,
    next_tick: u64,
    progress: &'a dyn Progress,
}

impl<'a> Source<'a> {
    pub fn new(
        input: &'a mut dyn Input,
        path: &'a Path,
        length: u64,
        progress: &'a dyn Progress,
    ) -> Self {
        Self {
            input,
            path,
            length,
            offset: 0,
            line: 0,
            terminator: b'\n',
            next_tick: TICK,
            progress,
        }
    }

    pub fn path(&self) -> &'a Path {
        self.path
    }

    pub fn progress(&self) -> &'a dyn Progress {
        self.progress
    }

    pub fn length(&self) -> u64 {
        self.length
    }

    pub fn offset(&self) -> u64 {
        self.offset
    }

    pub fn remaining(&self) -> u64 {
        self.length.saturating_sub(self.offset)
    }

    /// The input itself, for a decoder of someone else's.
    pub fn input(&mut self) -> &mut dyn Input {
        self.input
    }

    /// The next bytes without taking them: at least one unless the file is at its end, at most what the
    /// buffer holds.
    pub fn peek(&mut self) -> Result<&[u8], Error> {
        let path = self.path;
        self.input.fill_buf().map_err(|e| read_error(path, e))
    }

    /// The next line without its end; false at the end of the file.
    pub fn next_line(&mut self, line: &mut Vec<u8>) -> Result<bool, Error> {
        line.clear();
        if self.line == 0 {
            self.detect_terminator()?;
        }
        let taken = self
            .input
            .take(LONGEST_LINE)
            .read_until(self.terminator, line)
            .map_err(|e| read_error(self.path, e))? as u64;
        if taken == 0 {
            return Ok(false);
        }
        self.line += 1;
        self.pass(taken)?;
        if line.last() == Some(&self.terminator) {
            line.pop();
            if self.terminator == b'\n' && line.last() == Some(&b'\r') {
                line.pop();
            }
        } else if taken == LONGEST_LINE {
            return Err(self.at_line(
                "this line has more than 16 MiB: this is no text of the kind that its name says",
            ));
        }
        if self.line == 1 && line.starts_with(b"\xef\xbb\xbf") {
            line.drain(..3);
        }
        Ok(true)
    }

    /// Lines end with a line feed, or, where the first ends with a lone carriage return, with that.
    fn detect_terminator(&mut self) -> Result<(), Error> {
        let buffer = self.peek()?;
        if let Some(at) = buffer.iter().position(|&b| b == b'\n' || b == b'\r')
            && buffer[at] == b'\r'
            && buffer.get(at + 1).is_some_and(|&b| b != b'\n')
        {
            self.terminator = b'\r';
        }
        Ok(())
    }

    /// Fills `bytes`; `what` names them if the file ends before.
    pub fn read_exact(&mut self, bytes: &mut [u8], what: &str) -> Result<(), Error> {
        match self.input.read_exact(bytes) {
            Ok(()) => self.pass(bytes.len() as u64),
            Err(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => Err(self.truncated(what)),
            Err(e) => Err(read_error(self.path, e)),
        }
    }

    /// Passes over `count` bytes.
    pub fn skip(&mut self, count: u64, what: &str) -> Result<(), Error> {
        if count > self.remaining() {
            return Err(self.truncated(what));
        }
        let mut left = count;
        while left > 0 {
            let ready = self.peek()?.len() as u64;
            if ready == 0 {
                return Err(self.truncated(what));
            }
            let now = ready.min(left);
            self.input.consume(now as usize);
            self.pass(now)?;
            left -= now;
        }
        Ok(())
    }

    /// All the bytes that are left, `count` at most.
    pub fn read_to_vec(&mut self, count: u64, what: &str) -> Result<Vec<u8>, Error> {
        if count > self.remaining() {
            return Err(self.truncated(what));
        }
        let mut bytes = Vec::new();
        bytes
            .try_reserve_exact(count as usize)
            .map_err(|_| self.too_many(count, "bytes"))?;
        while (bytes.len() as u64) < count {
            let step = (count - bytes.len() as u64).min(TICK);
            let got = self
                .input
                .take(step)
                .read_to_end(&mut bytes)
                .map_err(|e| read_error(self.path, e))?;
            if got == 0 {
                return Err(self.truncated(what));
            }
            self.pass(got as u64)?;
        }
        Ok(bytes)
    }

    /// Counts bytes as read, and asks whether to go on.
    pub fn pass(&mut self, count: u64) -> Result<(), Error> {
        self.offset += count;
        if self.offset >= self.next_tick {
            self.next_tick = self.offset + TICK;
            let flow = self.progress.step("read", self.offset, self.length);
            Cancelled::check(flow)?;
        }
        Ok(())
    }

    /// Reserves for `count` items, but never for more than the rest of the file can hold when each takes
    /// `least_bytes`: a header that lies costs no memory.
    pub fn reserve<T>(
        &self,
        items: &mut Vec<T>,
        count: u64,
        least_bytes: u64,
        what: &'static str,
    ) -> Result<(), Error> {
        if count >= u64::from(u32::MAX) {
            return Err(self.too_many(count, what));
        }
        let count = count.min(self.remaining() / least_bytes.max(1));
        items
            .try_reserve_exact(count as usize)
            .map_err(|_| self.too_many(count, what))
    }

    /// About how many lines are left, from samples across the file; only a capacity depends on it.
    pub fn estimate_lines(&mut self) -> Result<u64, Error> {
        const SAMPLES: u64 = 16;
        const SAMPLE_BYTES: u64 = 16 << 10;
        let start = self.offset;
        let left = self.remaining();
        let terminator = self.terminator;
        let (mut bytes, mut lines) = (0u64, 0u64);
        let mut count = |chunk: &[u8]| {
            bytes += chunk.len() as u64;
            lines += chunk.iter().filter(|&&b| b == terminator).count() as u64;
        };
        if left <= SAMPLES * SAMPLE_BYTES {
            // A small file is in the buffer whole, or is not worth a seek.
            count(self.peek()?);
        } else {
            let mut chunk = vec![0; SAMPLE_BYTES as usize];
            let path = self.path;
            for i in 0..SAMPLES {
                let at = start + i * ((left - SAMPLE_BYTES) / (SAMPLES - 1));
                self.input
                    .seek(std::io::SeekFrom::Start(at))
                    .and_then(|_| self.input.read_exact(&mut chunk))
                    .map_err(|e| read_error(path, e))?;
                count(&chunk);
            }
            self.input
                .seek(std::io::SeekFrom::Start(start))
                .map_err(|e| read_error(path, e))?;
        }
        if bytes == 0 {
            return Ok(0);
        }
        Ok((left as f64 * lines as f64 / bytes as f64 * 1.01) as u64 + 2)
    }

    /// Refuses NaN and infinity.
    pub fn check_finite(
        &self,
        position: DVec3,
        vertex: usize,
        location: Location,
    ) -> Result<(), Error> {
        if position.is_finite() {
            return Ok(());
        }
        Err(Error::NotFinite {
            path: self.path.to_owned(),
            location,
            vertex: vertex as u64,
        })
    }

    pub fn line(&self) -> Location {
        Location::Line(self.line)
    }

    pub fn byte(&self) -> Location {
        Location::Byte(self.offset)
    }

    pub fn at_line(&self, reason: impl Into<String>) -> Error {
        self.malformed(self.line(), reason)
    }

    pub fn at_byte(&self, reason: impl Into<String>) -> Error {
        self.malformed(self.byte(), reason)
    }

    pub fn malformed(&self, location: Location, reason: impl Into<String>) -> Error {
        Error::Malformed {
            path: self.path.to_owned(),
            location,
            reason: reason.into(),
        }
    }

    pub fn truncated(&self, what: &str) -> Error {
        self.at_byte(format!(
            "the file ends before {what}; it is truncated: copy or export it again"
        ))
    }

    pub fn too_many(&self, count: u64, what: &'static str) -> Error {
        Error::TooMany {
            path: self.path.to_owned(),
            count,
            what,
        }
    }
}

pub(crate) fn read_error(path: &Path, source: std::io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        action: "read",
        reason: source,
    }
}
