//! What remeshing is asked for, and what it reports.

use crate::{MeshError, Quality};

/// How long edges should be.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetLength {
    /// This long, in the units of the positions.
    Absolute(f64),
    /// This many times the mean edge length of the mesh given. For a mesh remeshed again and again an absolute length
    /// is better: the mean drifts.
    Relative(f64),
    /// Short where the surface bends much, long where it bends little.
    Curvature(CurvatureLength),
}

/// Edge lengths from curvature: L = √(6ε/κ − 3ε²) keeps triangles within ε of a surface of curvature κ (Dunyach et
/// al. 2013). Lengths in the units of the positions.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureLength {
    /// ε: how far the middle of a triangle may lie from the surface.
    pub tolerance: f64,
    /// No edge is meant to be shorter.
    pub min: f64,
    /// No edge is meant to be longer.
    pub max: f64,
    /// How much wanted lengths differ at most between two places, as a part of their distance. 0.3 changes size over
    /// a few triangles and keeps angles good; 0 is one length for all.
    pub gradation: f64,
}

impl CurvatureLength {
    /// With a gradation of 0.3.
    pub fn new(tolerance: f64, min: f64, max: f64) -> Self {
        Self {
            tolerance,
            min,
            max,
            gradation: 0.3,
        }
    }

    pub(super) fn divided_by(&self, scale: f64) -> Self {
        Self {
            tolerance: self.tolerance / scale,
            min: self.min / scale,
            max: self.max / scale,
            gradation: self.gradation,
        }
    }
}

/// Where vertices go after they moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Back onto the surface given: the nearest point that faces the same way.
    Surface,
    /// Nowhere: they stay in the tangent plane. For surfaces that move on anyway; costs less, and shifts the surface
    /// by a part of what triangles lie beside it. Vertices of borders and creases are projected onto those nonetheless.
    None,
}

/// How [`remesh`](crate::remesh()) works.
#[derive(Clone, Debug, PartialEq)]
pub struct RemeshOptions {
    /// How long edges should be. Default: the mean edge length of the mesh given.
    pub target: TargetLength,
    /// How often to split, collapse, flip and relax. Default 6, after which little changes; 1 to 3 are enough for a
    /// mesh that was remeshed shortly before.
    pub iterations: u32,
    /// Whether vertices are projected onto the surface given. Default [`Projection::Surface`].
    pub projection: Projection,
    /// Edges across which normals turn by more than this angle, in radians, are creases and stay. Default `None`: no
    /// creases, right for scans and for surfaces that move. 60° finds the edges of machine parts; on rough surfaces it
    /// finds dents as well, and triangles there stay as bad as they are.
    pub crease_angle: Option<f64>,
    /// Vertices of borders and creases at which the curve turns by more than this angle, in radians, are corners and
    /// stay. Default 60°.
    pub corner_angle: f64,
}

impl Default for RemeshOptions {
    fn default() -> Self {
        Self {
            target: TargetLength::Relative(1.0),
            iterations: 6,
            projection: Projection::Surface,
            crease_angle: None,
            corner_angle: 60.0_f64.to_radians(),
        }
    }
}

impl RemeshOptions {
    pub(super) fn check(&self) -> Result<(), MeshError> {
        let positive = "must be positive and finite";
        let length = |option, value: f64| check(option, value, value > 0.0, positive);
        match &self.target {
            TargetLength::Absolute(value) => length("target (absolute)", *value)?,
            TargetLength::Relative(value) => length("target (relative)", *value)?,
            TargetLength::Curvature(wanted) => {
                length("target tolerance", wanted.tolerance)?;
                length("target min", wanted.min)?;
                length("target max", wanted.max)?;
                let ordered = wanted.min <= wanted.max;
                check("target min", wanted.min, ordered, "must not exceed the max")?;
                let gradation = wanted.gradation;
                check(
                    "gradation",
                    gradation,
                    gradation >= 0.0,
                    "must be finite and not negative",
                )?;
            }
        }
        let angle = "must be an angle between 0 and 180 degrees, in radians";
        let good = |value: f64| (0.0..=std::f64::consts::PI).contains(&value);
        if let Some(value) = self.crease_angle {
            check("crease_angle", value, good(value), angle)?;
        }
        check(
            "corner_angle",
            self.corner_angle,
            good(self.corner_angle),
            angle,
        )
    }
}

fn check(
    option: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<(), MeshError> {
    match good && value.is_finite() {
        true => Ok(()),
        false => Err(MeshError::InvalidOption {
            option,
            value,
            expected,
        }),
    }
}

/// How [`improve`](crate::improve) works.
#[derive(Clone, Debug, PartialEq)]
pub struct ImproveOptions {
    /// How often to flip and relax. Default 3.
    pub iterations: u32,
    /// As [`RemeshOptions::projection`]. Default [`Projection::Surface`].
    pub projection: Projection,
    /// As [`RemeshOptions::crease_angle`]. Default `None`.
    pub crease_angle: Option<f64>,
    /// As [`RemeshOptions::corner_angle`]. Default 60°.
    pub corner_angle: f64,
}

impl Default for ImproveOptions {
    fn default() -> Self {
        let RemeshOptions {
            projection,
            crease_angle,
            corner_angle,
            ..
        } = RemeshOptions::default();
        Self {
            iterations: 3,
            projection,
            crease_angle,
            corner_angle,
        }
    }
}

impl ImproveOptions {
    pub(super) fn as_remesh(&self) -> RemeshOptions {
        RemeshOptions {
            target: TargetLength::Relative(1.0),
            iterations: self.iterations,
            projection: self.projection,
            crease_angle: self.crease_angle,
            corner_angle: self.corner_angle,
        }
    }
}

/// What [`remesh`](crate::remesh()) or [`improve`](crate::improve) did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RemeshReport {
    /// Edges that were split.
    pub splits: usize,
    /// Edges that were collapsed.
    pub collapses: usize,
    /// Edges that were flipped.
    pub flips: usize,
    /// Moves of vertices that would have folded the surface and were not made.
    pub refused_moves: usize,
    /// The shapes of the triangles before, angles counted against 30° and 120°; `None` without a triangle.
    pub before: Option<Quality>,
    /// The same after.
    pub after: Option<Quality>,
}

impl RemeshReport {
    pub(super) fn unchanged(quality: Option<Quality>) -> Self {
        Self {
            before: quality.clone(),
            after: quality,
            ..Self::default()
        }
    }
}
