//! What the finite volumes see of a surface, for whoever wants to look.

use crate::Error;
use crate::finite_volumes::FiniteVolumes;
use crate::rings::Rings;
use glam::DVec3;
use pellicle_mesh::TriMesh;

/// The barycentric co-volumes of a closed surface (Daniel 2015, section 4.3), a value a vertex.
///
/// ```
/// use pellicle_evolution::Covolumes;
/// use pellicle_mesh::icosphere;
///
/// // The unit sphere: H = −2.
/// let covolumes = Covolumes::of(&icosphere(3)?)?;
/// let mean = covolumes.curvatures.iter().sum::<f64>() / covolumes.curvatures.len() as f64;
/// assert!((mean + 2.0).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Covolumes {
    /// μ(V_i), a third of the area of the triangles at the vertex. Their sum is the area of the surface.
    pub areas: Vec<f64>,
    /// N_i, outward and of length one: the mean of the unit normals of the triangles at the vertex, normalised. Zero where they
    /// cancel.
    pub normals: Vec<DVec3>,
    /// h_i, the mean curvature vector by the cotangent scheme (4.15), with the sign of ΔF: inward on a sphere. One over length.
    pub curvature_vectors: Vec<DVec3>,
    /// H_i = h_i · N_i: −2/R on a sphere of radius R, negative where the surface is convex.
    ///
    /// As the edges shorten, the barycentric area does not give the curvature at every vertex: where five triangles of a sphere
    /// meet it tends to −2.29/R. [`pellicle_mesh::mean_curvatures`] has mixed areas.
    pub curvatures: Vec<f64>,
}

impl Covolumes {
    /// Measures a surface. Linear time.
    ///
    /// # Errors
    ///
    /// [`Error::NotClosed`] for a mesh with a border or without triangles.
    pub fn of(mesh: &TriMesh) -> Result<Self, Error> {
        let rings = match Rings::of(mesh) {
            Some(rings) if rings.vertices() > 0 => rings,
            _ => return Err(Error::not_closed(mesh)),
        };
        let mut volumes = FiniteVolumes::default();
        volumes.measure(&rings, mesh.positions());
        let FiniteVolumes {
            areas,
            normals,
            curvature_vectors,
            curvatures,
            ..
        } = volumes;
        Ok(Self {
            areas,
            normals,
            curvature_vectors,
            curvatures,
        })
    }
}
