//! `pellicle delaunay`.

use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::progress::Watch;
use crate::{interrupt, output};
use clap::{Args, ValueEnum};
use pellicle::delaunay::{self, FacetId, TetId, Tetrahedralization};
use pellicle::io::{Content, Format, VolumeFormat, write_mesh, write_tetrahedra};
use pellicle::mesh::TriangleSoup;
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle delaunay scan.xyz -o tetrahedra.vtk

An output with the extension vtk or mesh (Medit) holds the tetrahedra over all points of the input, in their order;
one with the extension of a mesh format holds the hull, or every facet.";

/// Write the Delaunay tetrahedra of points, or their hull
///
/// The tetrahedra depend on the set of points alone, however degenerate: cospherical points are told apart by a
/// symbolic perturbation in lexicographic order.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Delaunay {
    /// The points: any point or mesh format
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Which triangles to write to a mesh format
    #[arg(long, value_name = "WHICH", default_value = "hull")]
    facets: Facets,
}

/// Which facets of the tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Facets {
    /// The convex hull, seen from outside
    Hull,
    /// Every facet once
    All,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    points: usize,
    duplicates: usize,
    tetrahedra: usize,
    hull_triangles: usize,
    bytes: u64,
}

impl Delaunay {
    /// Reads points, tetrahedralises them, writes tetrahedra or triangles.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let volume = VolumeFormat::from_path(&self.target.output);
        self.check_target(volume)?;
        let cloud = super::read_points(&self.input, watch)?;
        let tetrahedralization = super::tetrahedralize(&self.input, cloud.positions(), watch)?;
        let hull: Vec<FacetId> = hull(&tetrahedralization).collect();
        let options = self.target.options(watch);
        let bytes = match volume {
            Some(format) => interrupt::while_writing(|| {
                write_tetrahedra(
                    &self.target.output,
                    format,
                    tetrahedralization.points(),
                    tetrahedralization.finite_tets(),
                    &options,
                )
            })?,
            None => {
                let soup = match self.facets {
                    Facets::Hull => soup(&tetrahedralization, hull.iter().copied()),
                    Facets::All => soup(&tetrahedralization, tetrahedralization.facets()),
                };
                let write = || write_mesh(&self.target.output, &soup, None, &options);
                self.target.write(write)?.bytes
            }
        };
        tracing::info!(
            "{} points, {} tetrahedra, {} hull triangles",
            cloud.len(),
            tetrahedralization.finite_count(),
            hull.len()
        );
        let done = Done {
            points: cloud.len(),
            duplicates: tetrahedralization.duplicates().len(),
            tetrahedra: tetrahedralization.finite_count(),
            hull_triangles: hull.len(),
            input: self.input,
            output: self.target.output,
            bytes,
        };
        output::report(global, &done)
    }

    fn check_target(&self, volume: Option<VolumeFormat>) -> Result<(), Failure> {
        let path = &self.target.output;
        if volume.is_some() {
            return self.target.check_place();
        }
        match Format::from_path(path) {
            Ok(format) if format.can_write(Content::Mesh) => self.target.check_place(),
            _ => Err(Failure::OutputFormat {
                path: path.clone(),
                verb: "delaunay",
                known: super::extensions(Content::Mesh, &["vtk", "mesh"]),
            }),
        }
    }
}

/// The facets of the hull, each seen from the infinite tetrahedron beyond it, so counter-clockwise from outside.
fn hull<'a>(tetrahedralization: &'a Tetrahedralization<'_>) -> impl Iterator<Item = FacetId> + 'a {
    (0..tetrahedralization.finite_count())
        .flat_map(|tet| (0..4).map(move |corner| FacetId::of(TetId::new(tet), corner)))
        .map(|facet| tetrahedralization.twin(facet))
        .filter(|&twin| !tetrahedralization.is_finite(twin.tet()))
}

/// The facets as triangles over the points that they use.
fn soup(
    tetrahedralization: &delaunay::Tetrahedralization<'_>,
    facets: impl Iterator<Item = FacetId>,
) -> TriangleSoup {
    let mut soup = TriangleSoup {
        positions: tetrahedralization.points().to_vec(),
        triangles: facets
            .map(|facet| tetrahedralization.facet(facet))
            .collect(),
    };
    soup.compact();
    soup
}
