//! Points to their Delaunay tetrahedra and Voronoi cells.
//!
//! ![The edges of 820 tetrahedra between 325 points][delaunay.png]
//!
//! ```sh
//! pellicle delaunay fixtures/half.xyz -o tetrahedra.ply --facets all
//! pellicle render tetrahedra.ply -o delaunay.png --style edges --edge-width 0.5 --no-borders --views three-quarter --width 320 --height 260
//! ```
//!
//! The tetrahedra depend on the set of points alone, whatever their order and the number of threads. All signs are exact,
//! and cospherical points are told apart by a symbolic perturbation (Devillers and Teillaud 2011), so grids are ordinary.
//!
//! ```
//! use pellicle::delaunay::Location;
//! use pellicle::prelude::*;
//!
//! // 27 points, 3 × 3 × 3.
//! let points: Vec<DVec3> = (0..27)
//!     .map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)))
//!     .collect();
//! let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
//! assert!(tetrahedra.validate().is_empty());
//!
//! let place = DVec3::new(0.9, 1.2, 1.1);
//! let nearest = tetrahedra.nearest_vertex(place, None).unwrap();
//! assert_eq!(points[nearest.index()], DVec3::ONE);
//! assert!(matches!(tetrahedra.locate(place, Some(nearest)), Some(Location::Tetrahedron(_))));
//!
//! // The one cell that does not reach to infinity is the cube around the middle.
//! let bounded: Vec<_> = tetrahedra.voronoi_cells().filter(|cell| cell.is_bounded()).collect();
//! assert_eq!(bounded.len(), 1);
//! assert_eq!(bounded[0].vertex, nearest);
//! # Ok::<(), delaunay::Error>(())
//! ```
//!
//! Points may also come and go one by one, in
//! [`DynamicTetrahedralization`](crate::delaunay::DynamicTetrahedralization):
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let mut tetrahedra = delaunay::DynamicTetrahedralization::of_points(&[DVec3::X, DVec3::Y, DVec3::Z])?;
//! let origin = tetrahedra.insert(DVec3::ZERO)?;
//! assert_eq!(tetrahedra.nearest_vertex(DVec3::splat(0.1), None), Some(origin));
//! tetrahedra.remove(origin)?;
//! assert_eq!(tetrahedra.finite_tets().count(), 0);
//! # Ok::<(), delaunay::Error>(())
//! ```
//!
//! Circulators, weights and what everything costs: [`delaunay::guide`](crate::delaunay::guide).
//!
#![doc = include_str!("pictures/delaunay.md")]
