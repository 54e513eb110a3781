//! The guide: a chapter a verb, each with a picture, the commands that make it, and the same as a program.
//!
//! | chapter | from | to |
//! |---|---|---|
//! | [`reconstruct`] | points | a mesh through them |
//! | [`evolve`] | points, noisy or with gaps | a closed smooth mesh around them |
//! | [`morph`] | two closed meshes | the first deformed into the second |
//! | [`delaunay`] | points | their Delaunay tetrahedra and Voronoi cells |
//! | [`normals`] | points | an oriented normal at each |
//! | [`smooth`] | a closed mesh | the same, smoother |
//! | [`remesh`] | a mesh | even, well shaped triangles |
//! | [`repair`] | a mesh that crosses itself | the closed manifold that bounds its outside |
//! | [`measure`] | a mesh | topology, area, volume, and everything that is wrong with it |
//! | [`compare`] | two meshes or clouds | the distance between them, each way |
//! | [`convert`] | a file | points or a mesh, and back |
//! | [`render`] | a mesh or points | a picture |
//! | [`view`] | meshes and points | a page for a browser |
//! | [`progress`] | long work | a bar, and an end to it |
//!
//! The commands are those of the program `pellicle`, run where the folder `fixtures` of the repository is; its tests run
//! them and compare the pictures. Every program is compiled and run, too.
//!
//! What holds everywhere: coordinates are `f64`, in the units of the caller; triangles are counter-clockwise seen from
//! outside; ids of points and vertices are indices into the slices that they came from; nothing reorders or changes its
//! input; a failure is an `Err` that names the point, the triangle or the option, and no input makes a call panic.

pub mod compare;
pub mod convert;
pub mod delaunay;
pub mod evolve;
pub mod measure;
pub mod morph;
pub mod normals;
pub mod progress;
pub mod reconstruct;
pub mod remesh;
pub mod render;
pub mod repair;
pub mod smooth;
pub mod view;
