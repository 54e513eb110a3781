//! glTF 2.0 (Khronos 2021): a scene of nodes with meshes, as JSON beside binary buffers, or both in one file (GLB).
//!
//! Read here and not by the crate `gltf`, which holds the translation of a node in single precision: a mesh far
//! from the origin would lose its place. The tests compare with it. The JSON and the buffers are held in memory
//! while the mesh is made.

mod accessor;
mod animate;
mod buffers;
mod document;
mod encode;
mod read;
mod write;

pub use animate::{AnimationOptions, AnimationWriter, Frame, write_animation};
pub(crate) use read::read;
pub(crate) use write::write;
