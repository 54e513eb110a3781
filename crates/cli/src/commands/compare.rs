//! `pellicle compare`.

use crate::arguments::Global;
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use clap::Args;
use pellicle::io::Data;
use pellicle::mesh::{Comparison, DistanceOptions, Distances, MeshView, compare};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle compare reconstructed.ply truth.off --json

Distances run from the vertices of one file, and from points spread evenly over its triangles, to the nearest point of
the other. The greatest is taken over both, mean and RMS over the points on the triangles (or the vertices, where there
are no triangles). Points are chosen the same way each time.";

/// Measure the distance between two meshes or clouds, each way
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Compare {
    /// One mesh or cloud
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The other
    #[arg(value_name = "B")]
    second: PathBuf,
    /// Points to choose on the triangles of each
    #[arg(long, value_name = "N", default_value_t = DistanceOptions::default().samples)]
    samples: usize,
}

#[derive(Serialize)]
struct Compared {
    first: PathBuf,
    second: PathBuf,
    /// Of the smallest box around both.
    diagonal: f64,
    /// The greater of both maxima.
    hausdorff: Share,
    forward: Way,
    backward: Way,
}

/// Distances one way.
#[derive(Serialize)]
struct Way {
    max: Share,
    mean: Share,
    rms: Share,
    /// The point with the greatest distance.
    farthest: [f64; 3],
    /// How many points were asked for the greatest.
    points: usize,
}

/// A length, and the same as a share of the diagonal.
#[derive(Clone, Copy, Serialize)]
struct Share {
    absolute: f64,
    /// None where the diagonal is zero.
    relative: Option<f64>,
}

impl Compare {
    /// Reads both, measures each way, prints.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let first = super::read(&self.first, watch)?.data;
        let second = super::read(&self.second, watch)?.data;
        let options = DistanceOptions {
            samples: self.samples,
            ..DistanceOptions::default()
        };
        let comparison =
            compare(view(&first), view(&second), &options, watch).map_err(|reason| {
                Failure::Compare {
                    first: self.first.clone(),
                    second: self.second.clone(),
                    reason,
                }
            })?;
        let compared = Compared::of(self, &comparison);
        if global.json {
            output::print_json(&compared)
        } else {
            output::print(&compared.table())
        }
    }
}

fn view(data: &Data) -> MeshView<'_> {
    match data {
        Data::Points(cloud) => MeshView {
            positions: cloud.positions(),
            triangles: &[],
        },
        Data::Mesh { soup, .. } => soup.into(),
    }
}

impl Compared {
    fn of(compare: Compare, comparison: &Comparison) -> Self {
        let diagonal = comparison.diagonal;
        let share = |absolute: f64| Share {
            absolute,
            relative: (diagonal > 0.0).then(|| absolute / diagonal),
        };
        let way = |distances: &Distances| Way {
            max: share(distances.max),
            mean: share(distances.mean),
            rms: share(distances.rms),
            farthest: distances.farthest.to_array(),
            points: distances.points,
        };
        Self {
            first: compare.first,
            second: compare.second,
            diagonal,
            hausdorff: share(comparison.hausdorff()),
            forward: way(&comparison.forward),
            backward: way(&comparison.backward),
        }
    }

    fn table(&self) -> String {
        let (first, second) = (self.first.display(), self.second.display());
        let mut text = format!(
            "A {first}\nB {second}\n{:<12}{:>14}{:>14}\n",
            "", "absolute", "of diagonal"
        );
        let mut row = |name: &str, share: Share| {
            let relative = match share.relative {
                Some(relative) => format!("{:.4} %", 100.0 * relative),
                None => "none".to_owned(),
            };
            text.push_str(&format!(
                "{name:<12}{:>14.6e}{relative:>14}\n",
                share.absolute
            ));
        };
        for (name, way) in [("A to B", &self.forward), ("B to A", &self.backward)] {
            row(&format!("{name} max"), way.max);
            row(&format!("{name} mean"), way.mean);
            row(&format!("{name} RMS"), way.rms);
        }
        row("Hausdorff", self.hausdorff);
        row(
            "diagonal",
            Share {
                absolute: self.diagonal,
                relative: None,
            },
        );
        text
    }
}
