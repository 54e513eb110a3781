//! The bytes: in the file, in a data URI, or in a file beside.

use super::document::Document;
use crate::source::Source;
use crate::{Error, Location};
use std::io::Read as _;
use std::path::Path;

/// The bytes of every buffer.
pub(super) fn load(
    source: &Source,
    document: &Document,
    mut binary: Option<Vec<u8>>,
    base: Option<&Path>,
) -> Result<Vec<Vec<u8>>, Error> {
    let mut buffers = Vec::new();
    for (i, buffer) in document.buffers.iter().enumerate() {
        let wrong =
            |reason: String| source.malformed(Location::File, format!("buffer {i} {reason}"));
        let bytes = match &buffer.uri {
            None => binary
                .take()
                .ok_or_else(|| wrong("has neither a name nor a chunk in this file".into()))?,
            Some(uri) => match uri.strip_prefix("data:") {
                Some(data) => data
                    .split_once(";base64,")
                    .and_then(|(_, text)| base64(text.as_bytes()))
                    .ok_or_else(|| wrong("is a data URI that is not base64".into()))?,
                None => external(source, uri, buffer.byte_length, base).map_err(wrong)?,
            },
        };
        if (bytes.len() as u64) < buffer.byte_length {
            return Err(wrong(format!(
                "has {} bytes, and {} are stated; it is truncated",
                bytes.len(),
                buffer.byte_length
            )));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// A buffer in a file beside this one, or below.
fn external(
    source: &Source,
    uri: &str,
    length: u64,
    base: Option<&Path>,
) -> Result<Vec<u8>, String> {
    let name = percent_decoded(uri).ok_or_else(|| format!("has a broken name {uri:?}"))?;
    let path = Path::new(&name);
    let below = path.components().all(|part| {
        matches!(
            part,
            std::path::Component::Normal(_) | std::path::Component::CurDir
        )
    });
    if !below || name.contains(':') {
        return Err(format!(
            "is at {name:?}; only files in the directory of this one are opened"
        ));
    }
    let Some(base) = base else {
        return Err(format!(
            "is in another file, {name:?}, which is not opened here"
        ));
    };
    let full = base.join(path);
    let mut bytes = Vec::new();
    let file = std::fs::File::open(&full)
        .map_err(|e| format!("cannot be opened as {}: {e}", full.display()))?;
    let regular = file.metadata().is_ok_and(|metadata| metadata.is_file());
    if !regular {
        return Err(format!("is at {}, which is no file", full.display()));
    }
    file.take(length)
        .read_to_end(&mut bytes)
        .map_err(|e| format!("cannot be read from {}: {e}", full.display()))?;
    tracing::debug!(path = %source.path().display(), buffer = %full.display(), "buffer read");
    Ok(bytes)
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digit = |b: u8| char::from(b).to_digit(16);
                (digit(rest.next()?)? * 16 + digit(rest.next()?)?) as u8
            }
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}

fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let text = text.trim_ascii();
    let text = text.strip_suffix(b"=").unwrap_or(text);
    let text = text.strip_suffix(b"=").unwrap_or(text);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    for group in text.chunks(4) {
        let mut bits = 0u32;
        for &letter in group {
            let value = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' | b'-' => 62,
                b'/' | b'_' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        bits <<= 6 * (4 - group.len());
        let [_, a, b, c] = bits.to_be_bytes();
        bytes.extend(&[a, b, c][..group.len() - 1]);
    }
    Some(bytes)
}
