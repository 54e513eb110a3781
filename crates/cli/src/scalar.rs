//! A value of each vertex or point, as asked for on the command line.

use crate::failure::Failure;
use crate::progress::Watch;
use pellicle::io::{self, Data};
use pellicle::mesh::{self, MeshView};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Which value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// The mean of the principal curvatures.
    MeanCurvature,
    /// A third of the area of the triangles at a vertex.
    Area,
    /// A coordinate: 0, 1 or 2.
    Coordinate(usize),
    /// The distance from the nearest point of what a file holds.
    DistanceTo(PathBuf),
    /// A number of the input file, by its name.
    Property(String),
}

/// The values, and what they are called.
pub struct Scalars {
    /// For people.
    pub name: String,
    /// One a vertex or point.
    pub values: Vec<f64>,
}

impl FromStr for Scalar {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "mean-curvature" => Self::MeanCurvature,
            "area" => Self::Area,
            "x" => Self::Coordinate(0),
            "y" => Self::Coordinate(1),
            "z" => Self::Coordinate(2),
            _ => match text.split_once(':') {
                Some(("distance-to", file)) if !file.is_empty() => Self::DistanceTo(file.into()),
                Some(("property", name)) if !name.is_empty() => Self::Property(name.to_owned()),
                _ => {
                    return Err(
                        "one of mean-curvature, area, x, y, z, distance-to:FILE, property:NAME",
                    );
                }
            },
        })
    }
}

impl Scalar {
    /// The values of what was read from `input`; points have no triangles.
    pub fn of(&self, input: &Path, view: MeshView, watch: &Watch) -> Result<Scalars, Failure> {
        let needs_triangles = matches!(self, Self::MeanCurvature | Self::Area);
        if needs_triangles && view.triangles.is_empty() {
            return Err(Failure::File(io::Error::NoTriangles {
                path: input.to_owned(),
                vertices: view.positions.len(),
            }));
        }
        let (name, values) = match self {
            Self::MeanCurvature => ("mean curvature".to_owned(), mesh::mean_curvatures(view)),
            Self::Area => ("area".to_owned(), mesh::vertex_areas(view)),
            Self::Coordinate(axis) => {
                let values = view.positions.iter().map(|p| p[*axis]).collect();
                (["x", "y", "z"][*axis].to_owned(), values)
            }
            Self::DistanceTo(file) => ("distance".to_owned(), distances(view, file, watch)?),
            Self::Property(name) => {
                let options = crate::commands::read_options(watch);
                let values = io::read_vertex_property(input, name, &options)?;
                (name.clone(), values)
            }
        };
        Ok(Scalars { name, values })
    }
}

impl Scalars {
    /// The least and the greatest finite value.
    pub fn ends(&self) -> Option<[f64; 2]> {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        Some([finite().reduce(f64::min)?, finite().reduce(f64::max)?])
    }
}

fn distances(view: MeshView, file: &Path, watch: &Watch) -> Result<Vec<f64>, Failure> {
    let data = crate::commands::read(file, watch)?.data;
    let to = match &data {
        Data::Mesh { soup, .. } => soup.into(),
        Data::Points(cloud) => MeshView {
            positions: cloud.positions(),
            triangles: &[],
        },
    };
    mesh::point_distances(view.positions, to, watch).map_err(crate::commands::mesh_failure(file))
}
