//! The validator itself: with other weights than those it was made for, a triangulation is wrong.

use super::*;

fn tetrahedron_around_the_last() -> [DVec3; 5] {
    [
        DVec3::ZERO,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::splat(0.25),
    ]
}

#[test]
fn the_validator_finds_points_that_are_hidden_wrongly() {
    let points = tetrahedron_around_the_last();
    let regular = |weights| tetrahedralize_weighted(&points, weights, &Options::default()).unwrap();
    let light = [0.0, 0.0, 0.0, 0.0, -1.0];
    let mut hiding = regular(&light);
    assert_eq!(hiding.validate(), []);
    hiding.weights = &[0.0; 5];
    let wrong = Defect::Hidden(VertexId(4));
    assert_eq!(hiding.validate(), [wrong]);
    assert_eq!(
        hiding.validate_globally(),
        [Defect::NotDelaunay(TetId(0), VertexId(4))]
    );
    // A hidden point that is a vertex all the same.
    let mut showing = regular(&[0.0; 5]);
    showing.hidden = vec![VertexId(4)];
    assert!(showing.validate().contains(&wrong));
}

#[test]
fn the_validator_finds_vertices_that_ought_to_be_hidden() {
    let points = tetrahedron_around_the_last();
    let mut showing = tetrahedralize_weighted(&points, &[0.0; 5], &Options::default()).unwrap();
    assert_eq!(showing.validate(), []);
    showing.weights = &[0.0, 0.0, 0.0, 0.0, -1.0];
    assert_eq!(showing.validate().len(), 12);
    // And a point that is in no tetrahedron although nobody says that it is hidden.
    let light = [0.0, 0.0, 0.0, 0.0, -1.0];
    let mut hiding = tetrahedralize_weighted(&points, &light, &Options::default()).unwrap();
    hiding.hidden.clear();
    assert!(hiding.validate().contains(&Defect::Incident(VertexId(4))));
}
