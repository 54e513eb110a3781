//! Words and numbers of text, and back.

use pellicle_geometry::DVec3;
use std::io::Write;

/// The words of a line, apart by white space.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|w| !w.is_empty())
}

/// The line without what follows `mark`.
pub(crate) fn before(line: &[u8], mark: u8) -> &[u8] {
    line.iter()
        .position(|&b| b == mark)
        .map_or(line, |at| &line[..at])
}

/// A number, correctly rounded; "nan" and "inf" are numbers here.
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// An integer without sign.
pub(crate) fn count(word: &[u8]) -> Option<u64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word as it may stand in a message: printable and not long.
pub(crate) fn shown(word: &[u8]) -> String {
    let kept = &word[..word.len().min(40)];
    let dots = if word.len() > kept.len() { "…" } else { "" };
    format!("\"{}{dots}\"", kept.escape_ascii())
}

/// Appends a number with the fewest digits that read back to the same bits.
pub(crate) fn put_number(out: &mut Vec<u8>, value: f64) {
    // Debug is the shortest form that reads back, and takes to exponents where Display writes 300 zeros.
    write!(out, "{value:?}").expect("memory takes any text");
    if out.ends_with(b".0") {
        out.truncate(out.len() - 2);
    }
}

/// Appends three numbers apart by `separator`.
pub(crate) fn put_triple(out: &mut Vec<u8>, v: DVec3, separator: u8) {
    put_number(out, v.x);
    out.push(separator);
    put_number(out, v.y);
    out.push(separator);
    put_number(out, v.z);
}
