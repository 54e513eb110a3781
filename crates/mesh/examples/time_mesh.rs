//! Times each verb on a torus: `cargo run --release -p pellicle-mesh --example time_mesh -- 1600` for 5 million
//! triangles.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{
    DistanceOptions, MeshError, SplitOptions, TriMesh, TriangleSoup, compare,
    count_self_intersections, summarize, validate,
};
use std::f64::consts::TAU;
use std::time::Instant;

fn torus(n: u32) -> TriangleSoup {
    let mut soup = TriangleSoup::default();
    for i in 0..n {
        for j in 0..n {
            let (u, v) = (
                TAU * f64::from(i) / f64::from(n),
                TAU * f64::from(j) / f64::from(n),
            );
            let r = 1.0 + 0.4 * v.cos();
            soup.positions
                .push(DVec3::new(r * u.cos(), r * u.sin(), 0.4 * v.sin()));
            let at = |i: u32, j: u32| VertexId((i % n) * n + j % n);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup
}

fn timed<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = run();
    println!("{what:<24}{:8.2} s", start.elapsed().as_secs_f64());
    result
}

fn main() -> Result<(), MeshError> {
    let n = std::env::args()
        .nth(1)
        .and_then(|n| n.parse().ok())
        .unwrap_or(500);
    let soup = torus(n);
    println!(
        "{} triangles, {} threads",
        soup.triangles.len(),
        rayon::current_num_threads()
    );
    let mesh = timed("TriMesh::try_from", || TriMesh::try_from(soup.clone()))?;
    timed("from_soup_splitting", || {
        TriMesh::from_soup_splitting(soup, &SplitOptions::default())
    })?;
    let defects = timed("validate", || validate((&mesh).into()));
    let summary = timed("summarize", || summarize((&mesh).into()))?;
    let pairs = timed("self-intersections", || {
        count_self_intersections((&mesh).into(), &())
    })?;
    let options = DistanceOptions::default();
    let other = TriMesh::try_from(torus(n / 2))?;
    let far = timed("compare", || {
        compare((&mesh).into(), (&other).into(), &options, &())
    })?;
    println!(
        "{} defects, genus {:?}, {pairs} self-intersections, Hausdorff {:e}",
        defects.len(),
        summary.genus(),
        far.hausdorff()
    );
    Ok(())
}
