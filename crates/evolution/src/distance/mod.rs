//! The regularised distance to a point cloud on a grid of voxels.
