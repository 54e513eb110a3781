//! Self-union by manifold-rust's robust path: manifold_rust_union MESH RESULT, both OFF.
//!
//! Prints the seconds of CPU and of wall time of import and union alone, and the KiB that the process held before. The
//! seconds of CPU are those of wall time: the crate runs on one thread.

use manifold_rust::manifold::Manifold;
use manifold_rust::types::{MeshGL64, WindingRule};
use std::fmt::Write as _;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, mesh, result] = &arguments[..] else {
        return Err("MESH RESULT".into());
    };
    let mesh = read(&std::fs::read_to_string(mesh)?)?;
    let held = resident();
    let start = Instant::now();
    let united = Manifold::from_mesh_gl64_robust(&mesh).rebuild_solid(WindingRule::Positive);
    let seconds = start.elapsed().as_secs_f64();
    let status = format!("{:?}", united.status());
    if status != "NoError" {
        return Err(status.into());
    }
    std::fs::write(result, write(&united.get_mesh_gl64(0))?)?;
    println!("{seconds:.4} {seconds:.4} {held}");
    Ok(())
}

fn read(text: &str) -> Result<MeshGL64, Box<dyn std::error::Error>> {
    let mut words = text.split_whitespace().skip(1);
    let mut word = || words.next().ok_or("the file is too short");
    let (vertices, triangles): (usize, usize) = (word()?.parse()?, word()?.parse()?);
    word()?;
    let mut mesh = MeshGL64 {
        num_prop: 3,
        ..MeshGL64::default()
    };
    for _ in 0..3 * vertices {
        mesh.vert_properties.push(word()?.parse()?);
    }
    for _ in 0..triangles {
        word()?;
        for _ in 0..3 {
            mesh.tri_verts.push(word()?.parse()?);
        }
    }
    Ok(mesh)
}

/// As OFF; vertices that differ by properties alone are named as one.
fn write(mesh: &MeshGL64) -> Result<String, std::fmt::Error> {
    let stride = mesh.num_prop as usize;
    let vertices = mesh.vert_properties.len() / stride;
    let mut name: Vec<usize> = (0..vertices).collect();
    for (from, to) in mesh.merge_from_vert.iter().zip(&mesh.merge_to_vert) {
        name[*from as usize] = *to as usize;
    }
    let mut text = format!("OFF\n{vertices} {} 0\n", mesh.tri_verts.len() / 3);
    for p in mesh.vert_properties.chunks_exact(stride) {
        writeln!(text, "{} {} {}", p[0], p[1], p[2])?;
    }
    for t in mesh.tri_verts.chunks_exact(3) {
        let [a, b, c] = [t[0], t[1], t[2]].map(|v| name[v as usize]);
        writeln!(text, "3 {a} {b} {c}")?;
    }
    Ok(text)
}

/// The most KiB that the process has held.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let words = line.and_then(|line| line.split_whitespace().next());
    words.and_then(|word| word.parse().ok()).unwrap_or(0)
}
