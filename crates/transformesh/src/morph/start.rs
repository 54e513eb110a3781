//! Before the first step: closed, repaired, placed.

use super::options::Placement;
use super::target::Target;
use crate::{Error, Options, repair, repair_with};
use pellicle_geometry::triangle::power_of_two_near;
use pellicle_geometry::{Aabb, DVec3, Progress};
use pellicle_mesh::{
    EdgeTable, HalfEdgeId, MeshError, MeshView, SignedDistance, TriMesh, TriangleSoup,
};

/// The mesh without self-intersections, and with holes of a single triangle filled; how many there were.
pub(super) fn repaired(
    mesh: MeshView,
    side: &'static str,
    progress: &dyn Progress,
) -> Result<(TriMesh, usize), Error> {
    let mut soup = TriangleSoup {
        positions: mesh.positions.to_vec(),
        triangles: mesh.triangles.to_vec(),
    };
    let filled = fill(&mut soup);
    soup.compact();
    let repaired = repair_with((&soup).into(), &Options::default(), progress, &mut ());
    match repaired {
        Ok((mesh, _)) if mesh.triangles().is_empty() => Err(Error::Empty { side }),
        Ok((mesh, _)) => Ok((mesh, filled)),
        Err(Error::Cancelled(cancelled) | Error::Mesh(MeshError::Cancelled(cancelled))) => {
            Err(cancelled.into())
        }
        Err(reason) => Err(Error::Side {
            side,
            reason: Box::new(reason),
        }),
    }
}

/// Adds the triangle wherever just one is missing: three border edges that run round.
fn fill(soup: &mut TriangleSoup) -> usize {
    let view = MeshView::from(&*soup);
    let fits =
        view.positions.len() < u32::MAX as usize && view.triangles.len() < u32::MAX as usize / 4;
    if !fits {
        return 0;
    }
    let mut after = std::collections::BTreeMap::new();
    for (_, group) in EdgeTable::new(view).edges() {
        if let [only] = group {
            let end = |h: HalfEdgeId| view.triangles[h.triangle().index()][h.corner()];
            let (from, to) = (end(only.half_edge), end(only.half_edge.next()));
            // Backwards, as the missing triangle has it.
            after.insert(to, from);
        }
    }
    let mut missing = Vec::new();
    for (&a, &b) in &after {
        if let Some(&c) = after.get(&b)
            && after.get(&c) == Some(&a)
            && a < b
            && a < c
        {
            missing.push([a, b, c]);
        }
    }
    soup.triangles.extend(&missing);
    missing.len()
}

/// Both meshes divided by a power of two near the target's size, where the squares of lengths might overflow or vanish;
/// `None` for ordinary sizes.
pub(super) fn scaled(
    source: MeshView,
    target: MeshView,
) -> Option<(TriangleSoup, TriangleSoup, f64)> {
    let extent = Aabb::of_points(target.positions).extent().max_element();
    let unit = power_of_two_near(extent);
    let divided = |mesh: MeshView| TriangleSoup {
        positions: mesh.positions.iter().map(|p| *p / unit).collect(),
        triangles: mesh.triangles.to_vec(),
    };
    let ordinary = (1e-60..1e60).contains(&extent);
    (!ordinary).then(|| (divided(source), divided(target), unit))
}

/// A mesh times a power of two.
pub(super) fn times(mesh: &TriMesh, unit: f64) -> Result<TriMesh, Error> {
    let mut mesh = mesh.clone();
    mesh.set_positions(mesh.positions().iter().map(|p| *p * unit).collect())?;
    Ok(mesh)
}

/// The source, repaired and where it is to start; and how many holes were filled.
pub(super) fn placed(
    source: MeshView,
    target: &Target,
    placement: Placement,
    progress: &dyn Progress,
) -> Result<(TriMesh, usize), Error> {
    let (mesh, filled) = repaired(source, "source", progress)?;
    let own = Aabb::of_points(mesh.positions());
    let (center, to) = (own.center(), target.bounds.center());
    let fit = target.bounds.diagonal() / own.diagonal();
    let scale = match placement {
        Placement::Keep => return Ok((mesh, filled)),
        Placement::Fit => fit,
        Placement::Enclose => enclosing(&mesh, center, target)?.unwrap_or(fit),
    };
    let moved = |p: &DVec3| to + (*p - center) * scale;
    let mut soup = mesh.into_soup();
    soup.positions = soup.positions.iter().map(moved).collect();
    // Rounding may make triangles meet.
    let (mesh, _) = repair(&soup, &Options::default())?;
    Ok((mesh, filled))
}

/// By how much the source must be scaled about its middle to hold the target: by its ball, if it holds one.
fn enclosing(mesh: &TriMesh, center: DVec3, target: &Target) -> Result<Option<f64>, Error> {
    let sample = SignedDistance::new(mesh)?.sample(center);
    let radius = 0.5 * target.bounds.diagonal();
    Ok((sample.distance < 0.0).then(|| 1.05 * radius / -sample.distance))
}
