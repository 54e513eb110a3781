//! One mesh in one node, in one binary file. Vertices are single precision; the translation of the node is a
//! number of JSON and brings them back to their place.

use crate::sink::Sink;
use crate::write::Rounded;
use crate::{Error, Format, Note};
use glam::Vec3;
use pellicle_geometry::DVec3;
use pellicle_mesh::MeshView;
use serde_json::json;
use std::path::Path;

pub(crate) fn write(
    sink: &mut Sink,
    path: &Path,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
    notes: &mut Vec<Note>,
) -> Result<(), Error> {
    let rounded = Rounded::new(mesh.positions, true, notes).ok_or_else(|| Error::Range {
        path: path.to_owned(),
        format: Format::Glb,
    })?;
    let normals = normals.filter(|normals| {
        let unit = normals.iter().all(|n| {
            let single = n.as_vec3();
            single.is_finite() && single.length_squared() > 0.0
        });
        if !unit {
            notes.push(Note::NormalsDropped {
                why: "GLB has unit normals only, and one of these has no direction",
            });
        }
        unit
    });
    // The format has no empty accessor, and no place for vertices without a primitive.
    let (vertices, triangles) = match mesh.triangles.len() as u64 {
        0 => (0, 0),
        triangles => (mesh.positions.len() as u64, triangles),
    };
    let vectors = 12 * vertices * if normals.is_some() { 2 } else { 1 };
    let binary = vectors + 12 * triangles;
    let mut json = document(&rounded, mesh, normals.is_some()).into_bytes();
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let chunks = if binary > 0 { 8 + binary } else { 0 };
    let length = 12 + 8 + json.len() as u64 + chunks;
    let Ok(length) = u32::try_from(length) else {
        return Err(Error::TooMany {
            path: path.to_owned(),
            count: length,
            what: "bytes of a GLB file",
        });
    };
    sink.put(b"glTF")?;
    sink.put(&2u32.to_le_bytes())?;
    sink.put(&length.to_le_bytes())?;
    sink.put(&(json.len() as u32).to_le_bytes())?;
    sink.put(b"JSON")?;
    sink.put(&json)?;
    if binary == 0 {
        return Ok(());
    }
    sink.put(&(binary as u32).to_le_bytes())?;
    sink.put(b"BIN\0")?;
    for &position in mesh.positions {
        put_vector(sink, rounded.local(position))?;
        sink.item()?;
    }
    for normal in normals.unwrap_or_default() {
        put_vector(sink, unit(*normal))?;
    }
    for triangle in mesh.triangles {
        let mut raw = [0; 12];
        for (bytes, corner) in raw.chunks_mut(4).zip(triangle) {
            bytes.copy_from_slice(&corner.0.to_le_bytes());
        }
        sink.put(&raw)?;
        sink.item()?;
    }
    Ok(())
}

/// A normal of unit length stays as it is, to the last bit of single precision.
fn unit(normal: DVec3) -> Vec3 {
    let single = normal.as_vec3();
    match (single.length_squared() - 1.0).abs() < 1e-4 {
        true => single,
        false => normal.normalize().as_vec3(),
    }
}

fn put_vector(sink: &mut Sink, v: Vec3) -> Result<(), Error> {
    let mut raw = [0; 12];
    for (bytes, coordinate) in raw.chunks_mut(4).zip(v.to_array()) {
        bytes.copy_from_slice(&coordinate.to_le_bytes());
    }
    sink.put(&raw)
}

fn document(rounded: &Rounded, mesh: MeshView, normals: bool) -> String {
    let asset = json!({ "version": "2.0", "generator": "Pellicle" });
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    if triangles == 0 {
        return json!({ "asset": asset }).to_string();
    }
    let (min, max) = mesh
        .positions
        .iter()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), &p| {
            (min.min(rounded.local(p)), max.max(rounded.local(p)))
        });
    let mut views =
        vec![json!({ "buffer": 0, "byteOffset": 0, "byteLength": 12 * vertices, "target": 34962 })];
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": vertices,
        "min": min.to_array(), "max": max.to_array(),
    })];
    let mut attributes = json!({ "POSITION": 0 });
    if normals {
        views.push(json!({ "buffer": 0, "byteOffset": 12 * vertices, "byteLength": 12 * vertices, "target": 34962 }));
        accessors.push(
            json!({ "bufferView": 1, "componentType": 5126, "type": "VEC3", "count": vertices }),
        );
        attributes["NORMAL"] = json!(1);
    }
    let at = 12 * vertices * views.len();
    let last = views.len();
    views.push(
        json!({ "buffer": 0, "byteOffset": at, "byteLength": 12 * triangles, "target": 34963 }),
    );
    accessors.push(json!({ "bufferView": last, "componentType": 5125, "type": "SCALAR", "count": 3 * triangles }));
    let mut node = json!({ "mesh": 0 });
    if rounded.shift != DVec3::ZERO {
        node["translation"] = json!(rounded.shift.to_array());
    }
    json!({
        "asset": asset,
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [node],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": last, "mode": 4 }] }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": at + 12 * triangles }],
    })
    .to_string()
}
