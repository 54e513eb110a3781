//! PLY, the Polygon File Format (Turk 1994): a header that declares elements and their properties, then
//! their values as text or as bytes of either order.

mod header;
mod read;
mod write;

pub(crate) use read::{read, read_property};
pub(crate) use write::write;
