//! The guide: what one does with a tetrahedralisation, and what it costs. Text and examples only.
//!
//! n is the number of points. "In a volume" means points spread like uniform ones, where a vertex has about 15.5
//! neighbours and 27 tetrahedra; samples of surfaces have vertices with many more, and so dearer steps.
//!
//! | to do | call | expected time |
//! |---|---|---|
//! | [tetrahedralise](#tetrahedralise) | [`tetrahedralize`] | O(n log n) |
//! | [find where a point lies](#find-where-a-point-lies) | [`locate`](Tetrahedralization::locate) | O(1) from a near vertex, else O(n^(1/4)) |
//! | [find the nearest vertex](#find-the-nearest-vertex) | [`nearest_vertex`](Tetrahedralization::nearest_vertex) | as `locate` |
//! | [turn around a vertex](#turn-around-a-vertex) | [`around_vertex`](Tetrahedralization::around_vertex) | O(its tetrahedra) |
//! | [turn around an edge](#turn-around-an-edge) | [`around_edge`](Tetrahedralization::around_edge) | O(1) a step |
//! | [go through the Voronoi cells](#go-through-the-voronoi-cells) | [`voronoi_cells`](Tetrahedralization::voronoi_cells) | O(d log d) a cell of d facets |
//! | [insert points](#insert-and-remove-points) | [`insert`](DynamicTetrahedralization::insert) | `locate`, then O(tetrahedra that change) |
//! | [remove points](#insert-and-remove-points) | [`remove`](DynamicTetrahedralization::remove) | O(d log d) for d neighbours |
//! | [keep the result](#keep-the-result) | [`to_tetrahedralization`](DynamicTetrahedralization::to_tetrahedralization) | O(n) |
//!
//! All of it is exact: no answer depends on rounding, except where a coordinate is computed (circumcentres).
//! Nothing panics on any points: coordinates that are not finite are an [`Error`] or `None`.
//!
//! # Tetrahedralise
//!
//! A [`Tetrahedralization`] borrows its points. Corners and twins are two flat arrays; a vertex id is an index
//! into the points, a facet id names a tetrahedron and one of its corners.
//!
//! ```
//! use pellicle_delaunay::{FacetId, Options, TetId, tetrahedralize};
//! use pellicle_geometry::DVec3;
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.2)];
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! assert_eq!(tetrahedralization.finite_count(), 4);
//!
//! let facet = FacetId::of(TetId(0), 2); // opposite corner 2
//! let other_side = tetrahedralization.twin(facet);
//! assert_eq!(tetrahedralization.twin(other_side), facet);
//! // The hull: one infinite tetrahedron a facet.
//! assert_eq!(tetrahedralization.tets().len() - tetrahedralization.finite_count(), 4);
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Find where a point lies
//!
//! The answer is the cell of lowest dimension that holds the point: [`Location`]. A vertex that is near makes it
//! fast, such as a corner of the last answer.
//!
//! ```
//! use pellicle_delaunay::{Location, Options, tetrahedralize};
//! use pellicle_geometry::DVec3;
//!
//! # let points: Vec<DVec3> = (0..125)
//! #     .map(|i| DVec3::new((i % 5) as f64, (i / 5 % 5) as f64, (i / 25) as f64))
//! #     .collect();
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! let mut hint = None;
//! for step in 0..100 {
//!     let point = DVec3::new(0.031, 0.017, 0.023) * f64::from(step);
//!     if let Some(Location::Tetrahedron(tet)) = tetrahedralization.locate(point, hint) {
//!         hint = Some(tetrahedralization.tet(tet)[0]);
//!     }
//! }
//! assert!(hint.is_some());
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Find the nearest vertex
//!
//! Of several at the same distance, the one with the lexicographically lowest point. (Many queries to points that
//! never change: a k-d tree is faster.)
//!
//! ```
//! use pellicle_delaunay::{Options, tetrahedralize};
//! use pellicle_geometry::{DVec3, VertexId};
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! let outside = DVec3::new(9.0, 8.0, 7.0);
//! assert_eq!(tetrahedralization.nearest_vertex(outside, None), Some(VertexId(4)));
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Turn around a vertex
//!
//! [`around_vertex`](Tetrahedralization::around_vertex) gives its tetrahedra, infinite ones included,
//! [`neighbors`](Tetrahedralization::neighbors) the vertices across its edges.
//!
//! ```
//! use pellicle_delaunay::{Options, tetrahedralize};
//! use pellicle_geometry::{DVec3, VertexId};
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.2)];
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! let inside = VertexId(4);
//! assert_eq!(tetrahedralization.neighbors(inside).len(), 4);
//! let is_inside = tetrahedralization
//!     .around_vertex(inside)
//!     .all(|tet| tetrahedralization.is_finite(tet));
//! assert!(is_inside); // no infinite tetrahedron: not on the hull
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Turn around an edge
//!
//! An edge is named by a tetrahedron and two of its corners; [`tet_at_edge`](Tetrahedralization::tet_at_edge)
//! finds one. The circulator gives each tetrahedron with the facet that leads to the next.
//!
//! ```
//! use pellicle_delaunay::{Options, tetrahedralize};
//! use pellicle_geometry::{DVec3, VertexId};
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.2)];
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! let (from, to) = (VertexId(0), VertexId(4));
//! let tet = tetrahedralization.tet_at_edge(from, to).unwrap();
//! let around = tetrahedralization.around_edge(tet, from, to).unwrap();
//! for (tet, way_out) in around {
//!     assert!(tetrahedralization.tet(tet).contains(&to));
//!     assert_eq!(way_out.tet(), tet);
//! }
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Go through the Voronoi cells
//!
//! A [`VoronoiCell`] has a facet a Delaunay neighbour, a polygon of [`VoronoiVertex`]es; those of a vertex on the
//! hull reach to infinity.
//!
//! ```
//! use pellicle_delaunay::{Options, VoronoiVertex, tetrahedralize};
//! use pellicle_geometry::DVec3;
//!
//! # let points: Vec<DVec3> = (0..27)
//! #     .map(|i| DVec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64))
//! #     .collect();
//! // 27 points, 3 × 3 × 3: the cell in the middle is the cube from ½ to 1½.
//! let tetrahedralization = tetrahedralize(&points, &Options::default())?;
//! let mut bounded = tetrahedralization.voronoi_cells().filter(|cell| cell.is_bounded());
//! let cell = bounded.next().unwrap();
//! assert_eq!(points[cell.vertex.index()], DVec3::ONE);
//! for vertex in cell.facets.iter().flat_map(|facet| &facet.vertices) {
//!     let VoronoiVertex::Finite(corner) = vertex else { panic!("the cell is bounded") };
//!     assert_eq!((*corner - DVec3::ONE).abs(), DVec3::splat(0.5));
//! }
//! assert!(bounded.next().is_none());
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Insert and remove points
//!
//! A [`DynamicTetrahedralization`] owns its points. They may come in any order and leave in any other, far outside
//! of the hull or on top of each other: the tetrahedra are always those that [`tetrahedralize`] would make of the
//! points that are there. All queries above work on it, too.
//!
//! ```
//! use pellicle_delaunay::{DynamicTetrahedralization, Error};
//! use pellicle_geometry::DVec3;
//!
//! let mut tetrahedralization = DynamicTetrahedralization::new();
//! let first = tetrahedralization.insert(DVec3::ZERO)?;
//! tetrahedralization.insert(DVec3::X)?;
//! tetrahedralization.insert(DVec3::Y)?;
//! assert_eq!(tetrahedralization.dimension(), Some(2)); // no tetrahedra yet
//! tetrahedralization.insert(DVec3::Z)?;
//! let far = tetrahedralization.insert(DVec3::splat(1e300))?;
//! assert_eq!(tetrahedralization.dimension(), Some(3));
//!
//! // Vertices keep their ids until they are removed.
//! assert_eq!(tetrahedralization.remove(first)?, DVec3::ZERO);
//! assert_eq!(tetrahedralization.point(far), Some(DVec3::splat(1e300)));
//! assert_eq!(tetrahedralization.remove(first), Err(Error::NotAVertex { vertex: first }));
//! # Ok::<(), Error>(())
//! ```
//!
//! Among a million points in a volume an insertion or a removal takes about 20 µs, and to find the place from afar as
//! much again: pass a near vertex to
//! [`insert_near`](DynamicTetrahedralization::insert_near). Here each point of a path is inserted from the one
//! before, and those closer than ½ to a vertex are left out:
//!
//! ```
//! use pellicle_delaunay::DynamicTetrahedralization;
//! use pellicle_geometry::DVec3;
//!
//! # let points: Vec<DVec3> = (0..125)
//! #     .map(|i| DVec3::new((i % 5) as f64, (i / 5 % 5) as f64, (i / 25) as f64))
//! #     .collect();
//! let mut tetrahedralization = DynamicTetrahedralization::of_points(&points)?;
//! let mut last = None;
//! for step in 0..100 {
//!     let point = DVec3::new(0.031, 0.017, 0.023) * f64::from(step);
//!     let nearest = tetrahedralization.nearest_vertex(point, last);
//!     let distance = nearest
//!         .and_then(|vertex| tetrahedralization.point(vertex))
//!         .map_or(f64::INFINITY, |nearest| nearest.distance(point));
//!     last = match nearest {
//!         Some(near) if distance > 0.5 => Some(tetrahedralization.insert_near(point, near)?),
//!         near => near,
//!     };
//! }
//! assert!(tetrahedralization.vertex_count() > points.len());
//! assert!(tetrahedralization.validate().is_empty());
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! To move a vertex, remove it and insert it at its new place, near one of its old neighbours; the id is the same
//! then, since the last one that became free is taken first.
//!
//! ```
//! # use pellicle_delaunay::DynamicTetrahedralization;
//! # use pellicle_geometry::DVec3;
//! # let points: Vec<DVec3> = (0..125)
//! #     .map(|i| DVec3::new((i % 5) as f64, (i / 5 % 5) as f64, (i / 25) as f64))
//! #     .collect();
//! let mut tetrahedralization = DynamicTetrahedralization::of_points(&points)?;
//! let vertex = tetrahedralization.nearest_vertex(DVec3::splat(2.0), None).unwrap();
//! let near = tetrahedralization.neighbors(vertex)[0];
//! let point = tetrahedralization.remove(vertex)?;
//! let moved = tetrahedralization.insert_near(point + DVec3::new(0.1, 0.2, 0.0), near)?;
//! assert_eq!(moved, vertex);
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! # Keep the result
//!
//! What works on a [`Tetrahedralization`], reconstruction for example, takes one made of the present state. Its
//! vertices have no gaps: the k-th vertex becomes vertex k.
//!
//! ```
//! use pellicle_delaunay::DynamicTetrahedralization;
//! use pellicle_geometry::{DVec3, VertexId};
//!
//! let points = [DVec3::NEG_ONE, DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let mut dynamic = DynamicTetrahedralization::of_points(&points)?;
//! dynamic.remove(VertexId(0))?;
//!
//! let mut present = Vec::new();
//! let tetrahedralization = dynamic.to_tetrahedralization(&mut present)?;
//! assert_eq!(tetrahedralization.points(), &points[1..]);
//! let old_id = dynamic.vertices().nth(2).unwrap();
//! assert_eq!(old_id, VertexId(3)); // vertex 2 of `tetrahedralization`
//! // And back again.
//! let dynamic = DynamicTetrahedralization::from(&tetrahedralization);
//! assert_eq!(dynamic.vertex_count(), 4);
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```

#[cfg(doc)]
use crate::*;
