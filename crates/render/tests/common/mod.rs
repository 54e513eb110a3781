//! What the tests of pictures share.

use pellicle_render::Image;

/// Fowler, Noll and Vo's hash of a picture. If a picture changes on purpose, look at it, then write the new value into the test; if
/// it changes with the machine, something other than + − × ÷ √ has slipped in.
pub fn hash(image: &Image) -> u64 {
    let bytes = image.pixels.iter().flatten();
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    })
}
