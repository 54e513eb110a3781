//! PCD, Point Cloud Data of the Point Cloud Library: a header that names the fields of a point, then the
//! points as text, as records of bytes, or compressed field by field.

mod header;
mod lzf;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
