//! LZF, the compression of Lehmann 2000, which PCD uses, decoded as a stream.
//!
//! ```text
//! 000LLLLL  then L + 1 bytes as they are
//! LLLooooo oooooooo            copy L + 2 bytes from o + 1 back
//! 111ooooo LLLLLLLL oooooooo   copy L + 9 bytes from o + 1 back
//! ```

use crate::Error;
use crate::source::Source;

/// The farthest that a copy reaches back.
const REACH: usize = 1 << 13;

/// The most bytes that one compressed byte can become: 264 of three.
pub(super) const LARGEST_RATIO: u64 = 88;

/// What is decompressed, of which the last bytes are kept for copies.
pub(super) struct Decoder {
    window: Vec<u8>,
    /// What of the window was handed out.
    taken: usize,
    /// Compressed bytes that are left.
    input_left: u64,
}

impl Decoder {
    pub fn new(compressed: u64) -> Self {
        Self {
            window: Vec::with_capacity(8 * REACH + 512),
            taken: 0,
            input_left: compressed,
        }
    }

    /// Fills `bytes`.
    pub fn read_exact(&mut self, source: &mut Source, bytes: &mut [u8]) -> Result<(), Error> {
        let mut filled = 0;
        while filled < bytes.len() {
            if self.taken == self.window.len() {
                self.step(source)?;
            }
            let ready = &self.window[self.taken..];
            let now = ready.len().min(bytes.len() - filled);
            bytes[filled..filled + now].copy_from_slice(&ready[..now]);
            self.taken += now;
            filled += now;
        }
        Ok(())
    }

    /// Passes over `count` bytes.
    pub fn skip(&mut self, source: &mut Source, count: u64) -> Result<(), Error> {
        let mut left = count;
        while left > 0 {
            if self.taken == self.window.len() {
                self.step(source)?;
            }
            let now = left.min((self.window.len() - self.taken) as u64);
            self.taken += now as usize;
            left -= now;
        }
        Ok(())
    }

    /// Decodes one run.
    fn step(&mut self, source: &mut Source) -> Result<(), Error> {
        if self.window.len() > 8 * REACH {
            let old = self.window.len() - REACH;
            self.window.drain(..old);
            self.taken -= old;
        }
        let control = usize::from(self.byte(source)?);
        if control < 32 {
            for _ in 0..=control {
                let byte = self.byte(source)?;
                self.window.push(byte);
            }
            return Ok(());
        }
        let mut length = control >> 5;
        if length == 7 {
            length += usize::from(self.byte(source)?);
        }
        let back = ((control & 31) << 8) + usize::from(self.byte(source)?) + 1;
        let Some(start) = self.window.len().checked_sub(back) else {
            return Err(
                source.at_byte("the compressed data refer to before their start; they are damaged")
            );
        };
        // Byte by byte: a copy may overlap what it writes.
        for at in start..start + length + 2 {
            self.window.push(self.window[at]);
        }
        Ok(())
    }

    fn byte(&mut self, source: &mut Source) -> Result<u8, Error> {
        if self.input_left == 0 {
            return Err(source.at_byte(
                "the compressed data end before the last point; the file is damaged or truncated",
            ));
        }
        self.input_left -= 1;
        let mut byte = [0];
        source.read_exact(&mut byte, "the end of the compressed data")?;
        Ok(byte[0])
    }
}
