//! The repair, from the first pair of intersecting triangles to a manifold in doubles.

use crate::arrangement::{Arrangement, Facet};
use crate::grow::grow;
use crate::observer::{Observer, Piece};
use crate::outside::{fates_of_open, reached, select};
use crate::points::Points;
use crate::segments::segments;
use crate::stitch::{Fate, stitch};
use crate::surface::Surface;
use crate::triangulation::Triangulation;
use crate::weld::Weld;
use crate::winding::{OpenEdges, Windings};
use crate::{Error, Options, Report, Rule};
use pellicle_geometry::{Progress, VertexId, first_not_finite};
use pellicle_mesh::{
    EdgeTable, MeshError, MeshView, OrientationPolicy, SplitOptions, SplitReport, TriMesh,
    TriangleId, TriangleSoup, components, self_intersections, signed_volume,
};

/// Makes the manifold that bounds the outside of a mesh that may cross itself.
///
/// 1. Pairs of triangles that intersect, exactly ([`self_intersections`]).
/// 2. Each cut along the others, by a constrained triangulation on implicit points: nothing is decided on rounded
///    coordinates.
/// 3. The winding number on both sides of each facet: one exact ray a connected part, the rest by the order of the facets
///    around edges. This decides what the paper's growing region does: at a crossing it goes on to the facet that keeps
///    what is outside outside, for any number of sheets.
/// 4. Facets between inside and outside, as the [`Rule`] has it, are kept, and glued along the inside.
/// 5. New vertices are rounded to doubles; where that makes new intersections, once more from the start.
///
/// The result is closed, oriented, edge- and vertex-manifold, and has no self-intersections. A vertex of the input that is
/// still there has not moved. A valid mesh comes back bit for bit, so that repairing twice changes nothing. Neither the
/// order of the triangles (up to the order of the result's) nor the number of threads matters.
///
/// O(n log n) and what the intersections need: O(k log k) points, with k the points in which segments meet.
///
/// ```
/// use pellicle_mesh::icosphere;
/// use pellicle_transformesh::{Options, repair};
/// let sphere = icosphere(3)?;
/// let (same, report) = repair(&sphere, &Options::default())?;
/// assert!(report.unchanged && same == sphere);
///
/// let mut inside_out = sphere;
/// inside_out.reverse_orientation();
/// let (nothing, _) = repair(&inside_out, &Options::default())?;
/// assert!(nothing.triangles().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repair<'a>(
    mesh: impl Into<MeshView<'a>>,
    options: &Options,
) -> Result<(TriMesh, Report), Error> {
    repair_with(mesh.into(), options, &(), &mut ())
}

/// [`repair`], watched: `progress` is told of the stages and may stop it, `observer` sees their results.
pub fn repair_with(
    mesh: MeshView,
    options: &Options,
    progress: &dyn Progress,
    observer: &mut dyn Observer,
) -> Result<(TriMesh, Report), Error> {
    check(mesh)?;
    let mut work = Work {
        options,
        progress,
        observer,
        keep_borders: false,
        repeats: false,
    };
    let open = match work.repair(mesh) {
        Err(open @ Error::Open { .. }) => open,
        result => return result,
    };
    // Perhaps only the orientations disagree.
    let soup = TriangleSoup {
        positions: mesh.positions.to_vec(),
        triangles: mesh.triangles.to_vec(),
    };
    let (oriented, split) = TriMesh::from_soup_splitting(soup, &SplitOptions::default())?;
    if !split.reversed.is_empty() {
        match work.repair((&oriented).into()) {
            Err(Error::Open { .. }) => {}
            result => return result.map(|done| reoriented(done, &split)),
        }
    }
    if options.rule != Rule::Outside {
        return Err(open);
    }
    work.keep_borders = true;
    let (mesh, report) = work.repair((&oriented).into())?;
    Ok(reoriented((mesh, report), &split))
}

/// With the report's ids as they were before the mesh was oriented.
fn reoriented((mesh, mut report): (TriMesh, Report), split: &SplitReport) -> (TriMesh, Report) {
    report.reoriented = split.reversed.len();
    report.singular_vertices += split.split_vertices.len();
    report.unchanged &= split.is_unchanged();
    for source in &mut report.sources {
        *source = split.triangle_origin[source.index()];
    }
    (mesh, report)
}

/// Whether vertices exist and are finite.
pub(crate) fn check(mesh: MeshView) -> Result<(), Error> {
    if let Some(vertex) = first_not_finite(mesh.positions) {
        return Err(Error::NotFinite {
            vertex,
            position: mesh.positions[vertex.index()],
        });
    }
    let vertices = mesh.positions.len();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex) = triangle.iter().find(|v| v.index() >= vertices) {
            return Err(Error::NoSuchVertex {
                triangle: TriangleId::new(t),
                vertex,
                vertices,
            });
        }
    }
    Ok(())
}

/// What all rounds share.
struct Work<'a> {
    options: &'a Options,
    progress: &'a dyn Progress,
    observer: &'a mut dyn Observer,
    /// Whether the mesh may be open, and what is seen from outside is asked for.
    keep_borders: bool,
    /// Whether this is not the first round, which alone is shown.
    repeats: bool,
}

impl Work<'_> {
    fn repair(&mut self, mesh: MeshView) -> Result<(TriMesh, Report), Error> {
        self.repeats = false;
        let mut report = Report {
            volume: [signed_volume(mesh); 2],
            ..Report::default()
        };
        // 1 to 4. Cut, decide, glue.
        let Some(first) = self.round(mesh, &mut report)? else {
            return self.unchanged(mesh, report);
        };
        // 5. Until rounding breaks nothing.
        let surface = self.settle(first, &mut report)?;
        report.sources = surface.sources;
        report.new_vertices = surface.is_new.iter().filter(|&&new| new).count();
        report.rounded = surface
            .is_rounded
            .iter()
            .filter(|&&rounded| rounded)
            .count();
        let mut result = match TriMesh::try_from(surface.soup) {
            // At a border sheets may share both ends of an edge.
            Err(MeshError::NotManifold { soup, .. }) if self.keep_borders => {
                let split = SplitOptions {
                    orientation: OrientationPolicy::Keep,
                };
                TriMesh::from_soup_splitting(soup, &split)?.0
            }
            result => result?,
        };
        if self.options.rule == Rule::Outside && !self.keep_borders {
            result = drop_enclosed(result, &mut report)?.0;
        }
        self.describe(mesh, &result, &mut report);
        Ok((result, report))
    }

    /// Steps 1 to 4, once; `None` if every triangle stays as it is.
    fn round(&mut self, mesh: MeshView, report: &mut Report) -> Result<Option<Surface>, Error> {
        let mut weld = Weld::new(mesh);
        report.degenerate = weld.degenerate;
        // 1. Where triangles meet.
        let pairs = self_intersections(weld.view(), &Watch(self.progress))?;
        report.pairs = pairs.len();
        let of_input =
            |&(a, b): &(TriangleId, TriangleId)| (weld.sources[a.index()], weld.sources[b.index()]);
        let is_watching = self.observer.is_watching() && !self.repeats;
        if is_watching {
            let pairs: Vec<_> = pairs.iter().map(of_input).collect();
            self.observer.pairs(&pairs);
        }
        // 2. Cut along that.
        let mut points = Points::new(&mut weld);
        if is_watching {
            let segments = segments(&weld, &pairs, &mut points, self.progress)?;
            self.observer.segments(&segments);
        }
        let (observer, sources) = (&mut *self.observer, &weld.sources);
        let arrangement = Arrangement::new(
            &weld,
            &pairs,
            &mut points,
            self.progress,
            |triangle, cut, points| {
                if is_watching {
                    let triangle = sources[triangle as usize];
                    observer.cut(triangle, &pieces_of(triangle, cut, points));
                }
            },
        );
        let arrangement = arrangement?;
        report.cut = arrangement.cut;
        let positions = points.rounded_all();
        let table = EdgeTable::new(MeshView {
            positions: &positions,
            triangles: &arrangement.pieces,
        });
        // 3. The fate of each facet: by the winding numbers on both of its sides.
        let fates = match self.keep_borders {
            true => fates_of_open(&arrangement, &table, &weld, &mut points),
            false => {
                let windings =
                    Windings::new(&arrangement, &table, &weld, &mut points, self.progress)?
                        .map_err(|open| open_at(open, &points))?;
                report.seeds = windings.parts;
                let facets = arrangement.facets.iter().zip(&windings.in_front);
                facets
                    .map(|(f, &w)| fate(self.options.rule, f, w))
                    .collect()
            }
        };
        let is_clean = pairs.is_empty() && weld.degenerate == 0;
        if is_clean && fates.iter().all(|&fate| fate == Fate::Kept) {
            return Ok(None);
        }
        // 4. What is kept, glued.
        let stitched = stitch(&arrangement, &fates, &table, &weld, &mut points);
        report.singular_vertices = stitched.singular_vertices;
        report.singular_edges += stitched.singular_edges;
        Ok(Some(Surface::new(stitched, &weld, &points)))
    }

    /// Repairs what rounding broke, until it broke nothing, or it gets no better: then the best is returned.
    fn settle(&mut self, mut surface: Surface, report: &mut Report) -> Result<Surface, Error> {
        /// More intersections than this many times the fewest so far: it does not converge.
        const WORSE: usize = 8;
        let mut best: Option<(usize, Surface)> = None;
        self.repeats = true;
        loop {
            // 1. Without slivers, where that helps.
            let mut broken = surface.broken();
            tracing::debug!(repeat = report.repeats, ?broken);
            if broken.count() > 0 && report.repeats < self.options.rounds {
                report.repeats += 1;
                let cleaned = surface.clone().without_slivers(report.repeats)?;
                let left = cleaned.broken();
                if left.pairs <= broken.pairs {
                    (surface, broken) = (cleaned, left);
                }
            }
            report.remaining = broken.count();
            if broken.count() == 0 {
                // Rounding may turn a thin component inside out without any intersection.
                if report.repeats == 0 && !surface.has_thin_components()
                    || report.repeats >= self.options.rounds
                {
                    return Ok(surface);
                }
                report.repeats += u32::from(report.repeats == 0);
                let mut again = Report::default();
                let Some(next) = self.round((&surface.soup).into(), &mut again)? else {
                    return Ok(surface);
                };
                surface = next.after(&surface);
                report.repeats += 1;
                continue;
            }
            // 2. Is it any better?
            let hopeless = match &best {
                Some((fewest, _)) => broken.count() > WORSE * fewest,
                None => false,
            };
            if best
                .as_ref()
                .is_none_or(|(fewest, _)| broken.count() < *fewest)
            {
                best = Some((broken.count(), surface.clone()));
            }
            if let (Some((fewest, surface)), true) =
                (&best, hopeless || report.repeats >= self.options.rounds)
            {
                report.remaining = *fewest;
                return Ok(surface.clone());
            }
            // 3. From the start, with places gathered that rounding cannot keep apart.
            surface.gather(report.repeats);
            let mut again = Report::default();
            let Some(next) = self.round((&surface.soup).into(), &mut again)? else {
                report.remaining = 0;
                return Ok(surface);
            };
            report.singular_edges += again.singular_edges;
            report.singular_vertices = again.singular_vertices;
            surface = next.after(&surface);
        }
    }

    /// The input as it came.
    fn unchanged(
        &mut self,
        mesh: MeshView,
        mut report: Report,
    ) -> Result<(TriMesh, Report), Error> {
        let soup = TriangleSoup {
            positions: mesh.positions.to_vec(),
            triangles: mesh.triangles.to_vec(),
        };
        let split = SplitOptions {
            orientation: OrientationPolicy::Keep,
        };
        // A soup without intersections may still share vertices that it should not.
        let (mut result, split) = TriMesh::from_soup_splitting(soup, &split)?;
        report.unchanged = split.is_unchanged();
        report.singular_vertices = split.split_vertices.len();
        report.sources = split.triangle_origin;
        if self.options.rule == Rule::Outside && !self.keep_borders {
            let all;
            (result, all) = drop_enclosed(result, &mut report)?;
            report.unchanged &= all;
        }
        self.describe(mesh, &result, &mut report);
        Ok((result, report))
    }

    /// What the report says of the result.
    fn describe(&mut self, input: MeshView, result: &TriMesh, report: &mut Report) {
        let (components, genus) = topology(result.into());
        report.components = [topology(input).0, components];
        report.genus = [None, genus];
        if report.unchanged {
            report.genus[0] = genus;
        } else if let Ok(input) = TriMesh::try_from(TriangleSoup {
            positions: input.positions.to_vec(),
            triangles: input.triangles.to_vec(),
        }) {
            report.genus[0] = topology((&input).into()).1;
        }
        report.volume[1] = signed_volume(result.into());
        if self.observer.is_watching() {
            grow(input, result, &report.sources, self.observer);
        }
    }
}

/// Drops what is sealed off; whether there was nothing.
fn drop_enclosed(mesh: TriMesh, report: &mut Report) -> Result<(TriMesh, bool), Error> {
    let (kept, all) = reached(&mesh);
    if all {
        return Ok((mesh, true));
    }
    let (mut soup, chosen) = select((&mesh).into(), &kept);
    soup.compact();
    report.sources = chosen.iter().map(|t| report.sources[t.index()]).collect();
    Ok((TriMesh::try_from(soup)?, false))
}

fn open_at(open: OpenEdges, points: &Points) -> Error {
    Error::Open {
        edges: open.count,
        from: points.rounded(open.first[0]),
        to: points.rounded(open.first[1]),
    }
}

fn fate(rule: Rule, facet: &Facet, in_front: i32) -> Fate {
    let is_inside = |winding: i32| match rule {
        Rule::Union | Rule::Outside => winding >= 1,
        Rule::Nonzero => winding != 0,
    };
    match (
        is_inside(in_front),
        is_inside(in_front + facet.multiplicity),
    ) {
        (false, true) => Fate::Kept,
        (true, false) => Fate::Reversed,
        _ => Fate::Dropped,
    }
}

fn pieces_of(triangle: TriangleId, cut: &Triangulation, points: &Points) -> Vec<Piece> {
    let corner = |&v: &u32| points.rounded(cut.vertices[v as usize]);
    let pieces = cut.triangles.iter().zip(&cut.constraints);
    pieces
        .map(|(corners, constraints)| Piece {
            triangle,
            corners: corners.each_ref().map(corner),
            is_cut: constraints.map(|plane| plane.some().is_some()),
        })
        .collect()
}

/// Components, and the sum of their genus if the mesh is closed.
fn topology(mesh: MeshView) -> (usize, Option<usize>) {
    let distinct = |mut ids: Vec<VertexId>| {
        ids.sort_unstable();
        ids.dedup();
        ids.len()
    };
    let vertices = distinct(mesh.triangles.as_flattened().to_vec());
    let components = distinct(components(mesh));
    let (mut count, mut closed) = (0, true);
    for (_, entries) in EdgeTable::new(mesh).edges() {
        count += 1;
        closed &= entries.len() == 2;
    }
    let euler = vertices as i64 - count + mesh.triangles.len() as i64;
    let genus = components as i64 - euler / 2;
    (components, closed.then_some(genus.max(0) as usize))
}

/// Generic code takes observers by type, this crate's callers by reference.
pub(crate) struct Watch<'a>(pub &'a dyn Progress);

impl Progress for Watch<'_> {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> std::ops::ControlFlow<()> {
        self.0.step(stage, done, total)
    }
}
