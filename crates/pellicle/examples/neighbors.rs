//! Questions to points in space: `cargo run --release --example neighbors -- scan.xyz`
//!
//! Which point is nearest, between which four a place lies, how large its Voronoi cell is; then points are added one
//! by one.

use pellicle::delaunay::{DynamicTetrahedralization, Location, VoronoiCell, VoronoiVertex};
use pellicle::prelude::*;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let scan = std::env::args_os().nth(1).ok_or("usage: neighbors SCAN")?;
    let cloud = read_points(scan, &ReadOptions::default())?.cloud;
    for line in ask(cloud.positions())? {
        println!("{line}");
    }
    println!("{} points are enough", thin(cloud.positions(), 0.05)?.len());
    Ok(())
}

/// The answers for the middle of the points' box.
pub fn ask(points: &[DVec3]) -> Result<Vec<String>, Box<dyn Error>> {
    let tetrahedra = tetrahedralize(points, &delaunay::Options::default())?;
    let view = MeshView {
        positions: points,
        triangles: &[],
    };
    let middle = view.bounds().center();
    let nearest = tetrahedra.nearest_vertex(middle, None).ok_or("no points")?;
    let mut said = vec![format!(
        "nearest to {middle}: point {}, {:.6} away",
        nearest.0,
        points[nearest.index()].distance(middle)
    )];
    // The hint is a vertex nearby, and makes the search short.
    said.push(match tetrahedra.locate(middle, Some(nearest)) {
        Some(Location::Tetrahedron(tet)) => {
            let corners = tetrahedra.tet(tet).map(|corner| corner.0);
            format!("it lies between the points {corners:?}")
        }
        Some(Location::Outside(_)) => "it lies outside".to_owned(),
        Some(on_the_border_of_some) => format!("it lies in {on_the_border_of_some:?}"),
        None => return Err("the middle is not finite".into()),
    });
    let bounded = tetrahedra.voronoi_cells().filter(VoronoiCell::is_bounded);
    let largest = bounded
        .map(|cell| (volume(&cell, points), cell.vertex))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((volume, vertex)) = largest {
        said.push(format!(
            "the largest cell is that of point {}: {volume:.6}",
            vertex.0
        ));
    }
    Ok(said)
}

/// The volume of a bounded cell: pyramids from its own point to its facets.
pub fn volume(cell: &VoronoiCell, points: &[DVec3]) -> f64 {
    let apex = points[cell.vertex.index()];
    let corner = |vertex: &VoronoiVertex| match vertex {
        VoronoiVertex::Finite(corner) => *corner - apex,
        _ => DVec3::NAN,
    };
    let pyramid = |corners: Vec<DVec3>| -> f64 {
        (2..corners.len())
            .map(|i| corners[0].dot(corners[i - 1].cross(corners[i])).abs() / 6.0)
            .sum()
    };
    cell.facets
        .iter()
        .map(|facet| pyramid(facet.vertices.iter().map(corner).collect()))
        .sum()
}

/// As many of the points as keep a distance from each other, a share of the diagonal: points are inserted while the
/// tetrahedra stand, and each is asked for its nearest first.
pub fn thin(points: &[DVec3], share: f64) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let view = MeshView {
        positions: points,
        triangles: &[],
    };
    let distance = share * view.bounds().diagonal();
    let mut kept = DynamicTetrahedralization::new();
    for &point in points {
        let nearest = kept.nearest_vertex(point, None);
        let nearest = nearest.and_then(|vertex| kept.point(vertex));
        if nearest.is_none_or(|nearest| nearest.distance(point) >= distance) {
            kept.insert(point)?;
        }
    }
    Ok(kept
        .vertices()
        .filter_map(|vertex| kept.point(vertex))
        .collect())
}
