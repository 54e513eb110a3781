#![no_main]

use pellicle_fuzz::{Format, read};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Xyz, Format::Pts, Format::Pwn, Format::Csv] {
        read(format, bytes);
    }
});
