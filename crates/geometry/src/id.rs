//! Ids: `u32` newtypes without arithmetic.

/// Defines a `u32` id type.
///
/// The largest value is a sentinel, `NONE`, which stands for a missing id in storage; interfaces use
/// `Option`.
///
/// ```
/// pellicle_geometry::define_id! {
///     /// A house on a street.
///     pub struct HouseId;
/// }
/// assert_eq!(HouseId::new(7).index(), 7);
/// assert_eq!(HouseId::NONE.some(), None);
/// ```
#[macro_export]
macro_rules! define_id {
    ($(#[$attribute:meta])* $visibility:vis struct $name:ident;) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        $visibility struct $name(pub u32);

        impl $name {
            /// The sentinel for a missing id.
            pub const NONE: Self = Self(u32::MAX);

            /// The id with this index; an index must be below `u32::MAX`.
            #[inline]
            pub fn new(index: usize) -> Self {
                debug_assert!(index < u32::MAX as usize, "id out of range");
                Self(index as u32)
            }

            /// The id as an index into a slice.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }

            /// `None` for the sentinel.
            #[inline]
            pub fn some(self) -> Option<Self> {
                (self != Self::NONE).then_some(self)
            }
        }

        impl ::std::fmt::Debug for $name {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                if *self == Self::NONE {
                    write!(f, concat!(stringify!($name), "(none)"))
                } else {
                    write!(f, concat!(stringify!($name), "({})"), self.0)
                }
            }
        }
    };
}

define_id! {
    /// A point of a cloud, or a vertex of a mesh or tetrahedralisation: an index into its positions.
    pub struct VertexId;
}
