//! The states of a repair, and the bodies that the figures show.

use crate::Error;
use pellicle::glam::DVec2;
use pellicle::mesh::{TriangleId, cuboid};
use pellicle::prelude::*;
use pellicle::transformesh::{Observer, Options, Piece, Report, Rule, Segment, repair_with};
use std::collections::HashMap;

/// All that an observer sees.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Where triangles meet.
    pub segments: Vec<Segment>,
    /// The constrained triangulation of each cut triangle.
    pub cut: HashMap<TriangleId, Vec<Piece>>,
    /// A piece by which each component was entered.
    pub seeds: Vec<Piece>,
    /// The result, in the order of its growth.
    pub grown: Vec<Piece>,
}

impl Observer for Seen {
    fn is_watching(&self) -> bool {
        true
    }
    fn segments(&mut self, segments: &[Segment]) {
        self.segments.extend(segments);
    }
    fn cut(&mut self, triangle: TriangleId, pieces: &[Piece]) {
        self.cut.insert(triangle, pieces.to_vec());
    }
    fn seed(&mut self, piece: &Piece) {
        self.seeds.push(*piece);
    }
    fn grown(&mut self, piece: &Piece) {
        self.grown.push(*piece);
    }
}

impl Seen {
    /// Whether only a part of the piece's triangle was taken: a *partially valid* one.
    pub fn is_partial(&self, piece: &Piece) -> bool {
        self.cut.contains_key(&piece.triangle)
    }

    /// The triangles of a mesh, the cut ones in pieces: none crosses another.
    pub fn pieces(&self, soup: &TriangleSoup) -> Vec<(TriangleId, [DVec3; 3])> {
        let mut pieces = Vec::new();
        for (t, triangle) in soup.triangles.iter().enumerate() {
            let id = TriangleId::new(t);
            match self.cut.get(&id) {
                Some(cut) => pieces.extend(cut.iter().map(|piece| (id, piece.corners))),
                None => pieces.push((id, triangle.map(|v| soup.positions[v.index()]))),
            }
        }
        pieces
    }
}

/// A repair under the paper's rule or another, watched.
pub fn repaired(soup: &TriangleSoup, rule: Rule) -> Result<(TriMesh, Report, Seen), Error> {
    let mut seen = Seen::default();
    let options = Options {
        rule,
        ..Options::default()
    };
    let (mesh, report) = repair_with(soup.into(), &options, &(), &mut seen)?;
    Ok((mesh, report, seen))
}

/// Whether a mesh is what a repair promises: closed, without defect, and free of self-intersections.
pub fn is_clean(mesh: &TriMesh) -> Result<bool, Error> {
    Ok(mesh.is_closed()
        && mesh.validate().is_empty()
        && mesh::count_self_intersections(mesh.into(), &())? == 0)
}

/// Moved copies of a body in one soup.
pub fn copies(body: &TriangleSoup, shifts: &[DVec3]) -> TriangleSoup {
    let mut soup = TriangleSoup::default();
    for &shift in shifts {
        let moved = body.positions.iter().map(|&p| p + shift).collect();
        append(
            &mut soup,
            &TriangleSoup {
                positions: moved,
                triangles: body.triangles.clone(),
            },
        );
    }
    soup
}

/// Puts a soup behind another.
pub fn append(soup: &mut TriangleSoup, other: &TriangleSoup) {
    let first = soup.positions.len();
    soup.positions.extend(&other.positions);
    let triangles = other.triangles.iter();
    soup.triangles
        .extend(triangles.map(|t| t.map(|v| VertexId::new(v.index() + first))));
}

/// The same triangles over one vertex a place.
pub fn welded(soup: &TriangleSoup) -> TriangleSoup {
    let mut welded = TriangleSoup::default();
    let mut at: HashMap<[u64; 3], VertexId> = HashMap::new();
    let of: Vec<VertexId> = (soup.positions.iter())
        .map(|&p| {
            // 0 and −0 are one place.
            *at.entry((p + 0.0).to_array().map(f64::to_bits))
                .or_insert_with(|| {
                    welded.positions.push(p);
                    VertexId::new(welded.positions.len() - 1)
                })
        })
        .collect();
    welded.triangles = soup
        .triangles
        .iter()
        .map(|t| t.map(|v| of[v.index()]))
        .collect();
    welded
}

/// The unit cube with a corner in the origin.
pub fn cube() -> TriangleSoup {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE).expect("the corners are finite");
    cube.into_soup()
}

/// The height of the tips of a double cone.
pub const TIP: f64 = 1.0;

/// A body whose sections across z are all one closed curve, larger or smaller: each of its edges is joined to two tips on
/// the z-axis. The triangles of edge i are 2i, to the upper tip, and 2i + 1. Counter-clockwise curves bound their inside.
pub fn double_cone(curve: &[DVec2]) -> TriangleSoup {
    let count = curve.len();
    let mut positions: Vec<DVec3> = curve.iter().map(|p| p.extend(0.0)).collect();
    positions.extend([TIP * DVec3::Z, -TIP * DVec3::Z]);
    let triangles = (0..count)
        .flat_map(|i| {
            let next = (i + 1) % count;
            [[i, next, count], [next, i, count + 1]].map(|t| t.map(VertexId::new))
        })
        .collect();
    TriangleSoup {
        positions,
        triangles,
    }
}

/// The segment in which a triangle meets the plane z = `height`, if it crosses it; at its left what the triangle faces away
/// from.
pub fn section(corners: [DVec3; 3], height: f64) -> Option<[DVec2; 2]> {
    let side = corners.map(|c| c.z > height);
    let crossing = |i: usize| {
        let [a, b] = [corners[i], corners[(i + 1) % 3]];
        let share = (height - a.z) / (b.z - a.z);
        (a + share * (b - a)).truncate()
    };
    // In, where the border goes up through the plane, and out, where it goes down.
    let up = (0..3).find(|&i| !side[i] && side[(i + 1) % 3])?;
    let down = (0..3).find(|&i| side[i] && !side[(i + 1) % 3])?;
    Some([crossing(down), crossing(up)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_section_of_a_counter_clockwise_body_runs_counter_clockwise() {
        let square = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(DVec2::from);
        let body = double_cone(&square);
        assert!(pellicle::mesh::signed_volume((&body).into()) > 0.0);
        let mut area = 0.0;
        let mut length = 0.0;
        for t in &body.triangles {
            if let Some([a, b]) = section(t.map(|v| body.positions[v.index()]), 0.5) {
                area += 0.5 * a.perp_dot(b);
                length += a.distance(b);
            }
        }
        // A square of half the size.
        assert!((area - 1.0).abs() < 1e-12 && (length - 4.0).abs() < 1e-12);
    }

    #[test]
    fn pieces_are_the_whole_surface_and_the_result_is_clean() {
        let sphere = icosphere_soup();
        let soup = copies(&sphere, &[DVec3::ZERO, DVec3::new(0.9, 0.3, 0.1)]);
        let (mesh, report, seen) = repaired(&soup, Rule::Union).unwrap();
        assert!(is_clean(&mesh).unwrap());
        assert_eq!(seen.grown.len(), mesh.triangles().len());
        assert_eq!(seen.cut.len(), report.cut);
        let area = |corners: [DVec3; 3]| {
            let [a, b, c] = corners;
            0.5 * (b - a).cross(c - a).length()
        };
        let sum: f64 = seen
            .pieces(&soup)
            .iter()
            .map(|(_, corners)| area(*corners))
            .sum();
        let whole = pellicle::mesh::area((&soup).into());
        assert!((sum / whole - 1.0).abs() < 1e-12);
        assert!(!is_clean(&TriMesh::try_from(soup).unwrap()).unwrap());
    }

    fn icosphere_soup() -> TriangleSoup {
        pellicle::mesh::icosphere(1).unwrap().into_soup()
    }

    #[test]
    fn welding_joins_places() {
        let two = copies(&cube(), &[DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)]);
        let welded = welded(&two);
        assert_eq!((two.positions.len(), welded.positions.len()), (16, 14));
        assert_eq!(welded.triangles.len(), 24);
    }
}
