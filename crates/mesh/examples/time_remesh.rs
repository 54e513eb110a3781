//! Remeshes an OFF file, or a stretched sphere of so many levels, and prints shapes and times:
//! `cargo run --release -p pellicle-mesh --example time_remesh -- fixtures/elephant.off 1.0`.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{
    ImproveOptions, Quality, RemeshOptions, SplitOptions, TargetLength, TriMesh, TriangleSoup,
    compare, count_self_intersections, icosphere, improve, remesh, summarize,
};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let source = arguments.first().map_or("5", String::as_str);
    let factor = arguments.get(1).map_or(Ok(1.0), |f| f.parse())?;
    let iterations = arguments
        .get(2)
        .map_or(Ok(RemeshOptions::default().iterations), |f| f.parse())?;
    let mesh = match source.parse() {
        Ok(levels) => stretched(levels)?,
        Err(_) => TriMesh::from_soup_splitting(read_off(source)?, &SplitOptions::default())?.0,
    };
    let crease_angle = arguments
        .get(3)
        .map_or(Ok(None), |a| a.parse().map(|a: f64| (a > 0.0).then_some(a)))?;
    let options = RemeshOptions {
        crease_angle: crease_angle.map(f64::to_radians),
        target: TargetLength::Relative(factor),
        iterations,
        ..RemeshOptions::default()
    };
    let start = Instant::now();
    let (result, report) = remesh(&mesh, &options, &())?;
    let time = start.elapsed().as_secs_f64();
    println!("{source}: remesh x{factor}");
    if let (Some(before), Some(after)) = (&report.before, &report.after) {
        print("before", before);
        print("after", after);
    }
    println!(
        "{} splits, {} collapses, {} flips, {} moves refused; {time:.2} s",
        report.splits, report.collapses, report.flips, report.refused_moves
    );
    let topology = |mesh: &TriMesh| -> Result<_, Box<dyn Error>> {
        let s = summarize(mesh.into())?;
        Ok((s.components.len(), s.genus(), mesh.border_loops().len()))
    };
    let far = compare((&mesh).into(), (&result).into(), &Default::default(), &())?;
    println!(
        "topology {:?} -> {:?}, self-intersections {} -> {}, Hausdorff {:.2e}, mean {:.2e} of the diagonal",
        topology(&mesh)?,
        topology(&result)?,
        count_self_intersections((&mesh).into(), &())?,
        count_self_intersections((&result).into(), &())?,
        far.hausdorff() / far.diagonal,
        far.backward.mean / far.diagonal
    );
    let start = Instant::now();
    let (_, report) = improve(&mesh, &ImproveOptions::default(), &())?;
    if let Some(after) = &report.after {
        print("improved", after);
    }
    println!("{:.2} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn print(when: &str, q: &Quality) {
    println!(
        "{when:>9}: {:7} triangles, angles {:6.2} to {:6.2}, {:5} below 30, {:5} above 120, area variation {:.3}",
        q.triangles,
        q.min_angle.to_degrees(),
        q.max_angle.to_degrees(),
        q.small_angles,
        q.large_angles,
        q.area_variation
    );
}

fn stretched(levels: u32) -> Result<TriMesh, Box<dyn Error>> {
    let mut mesh = icosphere(levels)?;
    let axes = DVec3::new(1.0, 2.0, 5.0);
    mesh.set_positions(mesh.positions().iter().map(|&p| p * axes).collect())?;
    Ok(mesh)
}

fn read_off(path: &str) -> Result<TriangleSoup, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or(""));
    let mut words = lines.flat_map(str::split_whitespace).skip(1);
    let mut next = || words.next().ok_or("the file ends early");
    let (vertices, faces) = (next()?.parse::<usize>()?, next()?.parse::<usize>()?);
    next()?;
    let mut soup = TriangleSoup::default();
    for _ in 0..vertices {
        soup.positions.push(DVec3::new(
            next()?.parse()?,
            next()?.parse()?,
            next()?.parse()?,
        ));
    }
    for _ in 0..faces {
        let corners = next()?.parse::<usize>()?;
        let corners: Vec<u32> = (0..corners)
            .map(|_| Ok(next()?.parse()?))
            .collect::<Result<_, Box<dyn Error>>>()?;
        soup.triangles.extend(
            corners
                .windows(2)
                .skip(1)
                .map(|pair| [corners[0], pair[0], pair[1]].map(VertexId)),
        );
    }
    Ok(soup)
}
