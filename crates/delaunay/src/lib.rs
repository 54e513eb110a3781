//! delaunay
