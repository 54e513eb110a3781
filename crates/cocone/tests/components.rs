//! The components of the report, against the measures of the mesh, which count another way.

mod common;

use common::{METHODS, off, run, summary};

#[test]
fn components_are_those_that_the_mesh_measures() {
    for name in [
        "elephant-with-holes.off",
        "bones.off",
        "knot2.off",
        "analytic/torus.off",
    ] {
        let points = off(name);
        for method in METHODS {
            let reconstruction = run(&points, method);
            let expected: Vec<_> = summary(&reconstruction.mesh)
                .components
                .iter()
                .map(|part| {
                    (
                        part.triangles,
                        part.vertices,
                        part.border_loops,
                        part.genus(),
                    )
                })
                .collect();
            let found: Vec<_> = reconstruction
                .report
                .components
                .iter()
                .map(|part| {
                    (
                        part.triangles,
                        part.vertices,
                        part.borders,
                        Some(part.genus),
                    )
                })
                .collect();
            assert_eq!(found, expected, "{name} {method:?}");
            assert!(!found.is_empty());
        }
    }
}
