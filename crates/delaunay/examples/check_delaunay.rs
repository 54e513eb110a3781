//! Tetrahedralises a seeded input, or a file, and has the result looked at by an exact checker that shares no code with the
//! library: `check_delaunay torus 1000000`, or `check_delaunay file POINTS`.
//!
//! Says what was looked at; fails if anything is wrong, and names the first defects.

mod common;

#[path = "../tests/checker/mod.rs"]
mod checker;

use checker::Claim;
use common::{Arguments, Outcome};
use pellicle_delaunay::{Options, tetrahedralize};
use std::time::Instant;

fn main() -> Outcome {
    let points = Arguments::of_process().points()?;
    let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    let coordinates: Vec<[f64; 3]> = points.iter().map(|p| p.to_array()).collect();
    let tets: Vec<[u32; 4]> = tetrahedralization
        .tets()
        .iter()
        .map(|tet| tet.map(|v| v.0))
        .collect();
    let twins: Vec<[u32; 4]> = tetrahedralization
        .twins()
        .iter()
        .map(|twins| twins.map(|f| f.0))
        .collect();
    let start = Instant::now();
    let claim = Claim {
        points: &coordinates,
        tets: &tets,
        twins: &twins,
        finite: tetrahedralization.finite_count(),
    };
    match claim.check() {
        Ok(looked) => {
            println!(
                "checked in {:.1} s: {looked:?}",
                start.elapsed().as_secs_f64()
            );
            Ok(())
        }
        Err(defects) => {
            let some = &defects[..defects.len().min(5)];
            Err(format!("{} defects, among them {some:?}", defects.len()).into())
        }
    }
}
