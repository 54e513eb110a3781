//! Numbers in a buffer.

use super::document::Accessor;
use pellicle_geometry::DVec3;

/// The type of one component.
#[derive(Clone, Copy)]
pub(super) struct Component {
    kind: u64,
    normalized: bool,
}

impl Component {
    pub fn new(accessor: &Accessor) -> Option<Self> {
        let kind = accessor.component_type;
        matches!(kind, 5120..=5123 | 5125 | 5126).then_some(Self {
            kind,
            normalized: accessor.normalized,
        })
    }

    pub fn size(self) -> u64 {
        match self.kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        }
    }

    /// Normalised integers span -1 to 1, or 0 to 1.
    fn decode(self, b: &[u8]) -> f64 {
        let (value, most) = match self.kind {
            5120 => (f64::from(b[0] as i8), 127.0),
            5121 => (f64::from(b[0]), 255.0),
            5122 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            5123 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            5125 => (
                f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
                4294967295.0,
            ),
            _ => return f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        };
        match self.normalized {
            true => (value / most).max(-1.0),
            false => value,
        }
    }
}

/// The bytes of an accessor, from its first item to the end of its last.
pub(super) struct View<'b> {
    pub bytes: &'b [u8],
    pub stride: usize,
    pub count: u64,
    pub component: Component,
}

impl View<'_> {
    pub fn vector(&self, i: u64) -> DVec3 {
        let item = &self.bytes[i as usize * self.stride..];
        let size = self.component.size() as usize;
        let [x, y, z] = [0, 1, 2].map(|axis| self.component.decode(&item[axis * size..]));
        DVec3::new(x, y, z)
    }

    pub fn index(&self, i: u64) -> u64 {
        let item = &self.bytes[i as usize * self.stride..];
        let unsigned = Component {
            normalized: false,
            ..self.component
        };
        unsigned.decode(item) as u64
    }
}
