//! What one mesh and an animation of many have in common: bytes of the buffer, and the JSON that describes them.

use crate::sink::Sink;
use crate::write::Rounded;
use crate::{Error, Note};
use glam::Vec3;
use pellicle_geometry::DVec3;
use pellicle_mesh::MeshView;
use serde_json::{Value, json};
use std::path::Path;

/// Where the bytes of the buffer go.
pub(super) trait Output {
    /// Takes some bytes.
    fn put(&mut self, bytes: &[u8]) -> Result<(), Error>;
    /// Counts a vertex or a triangle.
    fn item(&mut self) -> Result<(), Error>;
}

impl Output for Sink<'_> {
    fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        Sink::put(self, bytes)
    }

    fn item(&mut self) -> Result<(), Error> {
        Sink::item(self)
    }
}

/// The parts of the document that describe the buffer, in the order in which its bytes are put.
#[derive(Default)]
pub(super) struct Description {
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
    pub(super) meshes: Vec<Value>,
    /// Of the buffer, in bytes; a multiple of four.
    pub(super) length: u64,
}

impl Description {
    /// A view of the next bytes, with or without the GPU's name for their use.
    pub(super) fn view(&mut self, length: u64, target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.length, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.length += length;
        push(&mut self.views, view)
    }

    /// An accessor.
    pub(super) fn accessor(&mut self, accessor: Value) -> usize {
        push(&mut self.accessors, accessor)
    }

    /// A mesh of at least one triangle, as [`put_mesh`] puts it.
    pub(super) fn mesh(&mut self, rounded: &Rounded, mesh: MeshView, normals: bool) -> usize {
        let (vertices, triangles) = (mesh.positions.len() as u64, mesh.triangles.len() as u64);
        let (min, max) = mesh
            .positions
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), &p| {
                (min.min(rounded.local(p)), max.max(rounded.local(p)))
            });
        let view = self.view(12 * vertices, Some(ARRAY));
        let position = self.accessor(json!({
            "bufferView": view, "componentType": FLOAT, "type": "VEC3", "count": vertices,
            "min": min.to_array(), "max": max.to_array(),
        }));
        let mut attributes = json!({ "POSITION": position });
        if normals {
            let view = self.view(12 * vertices, Some(ARRAY));
            attributes["NORMAL"] = json!(self.accessor(json!({
                "bufferView": view, "componentType": FLOAT, "type": "VEC3", "count": vertices,
            })));
        }
        let view = self.view(12 * triangles, Some(ELEMENT_ARRAY));
        let indices = self.accessor(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "type": "SCALAR", "count": 3 * triangles,
        }));
        push(
            &mut self.meshes,
            json!({ "primitives": [{ "attributes": attributes, "indices": indices, "mode": 4 }] }),
        )
    }

    /// The document of a scene; `nodes` has the scene's only root first.
    pub(super) fn document(self, nodes: Vec<Value>, animations: Vec<Value>) -> Value {
        let mut document = json!({
            "asset": asset(),
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": nodes,
        });
        // The format has no empty arrays.
        for (name, values) in [
            ("meshes", self.meshes),
            ("accessors", self.accessors),
            ("bufferViews", self.views),
            ("animations", animations),
        ] {
            if !values.is_empty() {
                document[name] = json!(values);
            }
        }
        if self.length > 0 {
            document["buffers"] = json!([{ "byteLength": self.length }]);
        }
        document
    }
}

const ARRAY: u32 = 34962;
const ELEMENT_ARRAY: u32 = 34963;
const UNSIGNED_INT: u32 = 5125;
pub(super) const FLOAT: u32 = 5126;

/// Which version this is, and whose.
pub(super) fn asset() -> Value {
    json!({ "version": "2.0", "generator": "Pellicle" })
}

/// A node's translation, where it has one.
pub(super) fn translate(node: &mut Value, shift: DVec3) {
    if shift != DVec3::ZERO {
        node["translation"] = json!(shift.to_array());
    }
}

fn push(values: &mut Vec<Value>, value: Value) -> usize {
    values.push(value);
    values.len() - 1
}

/// The normals if the format can hold them; else a note.
pub(super) fn usable<'a>(
    normals: Option<&'a [DVec3]>,
    notes: &mut Vec<Note>,
) -> Option<&'a [DVec3]> {
    normals.filter(|normals| {
        let unit = normals.iter().all(|n| {
            let single = n.as_vec3();
            single.is_finite() && single.length_squared() > 0.0
        });
        let note = Note::NormalsDropped {
            why: "GLB has unit normals only, and one of these has no direction",
        };
        if !unit && !notes.contains(&note) {
            notes.push(note);
        }
        unit
    })
}

/// The bytes of a mesh: positions, normals if any, corners.
pub(super) fn put_mesh(
    output: &mut impl Output,
    rounded: &Rounded,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
) -> Result<(), Error> {
    for &position in mesh.positions {
        put_vector(output, rounded.local(position))?;
        output.item()?;
    }
    for normal in normals.unwrap_or_default() {
        put_vector(output, unit(*normal))?;
    }
    for triangle in mesh.triangles {
        let mut raw = [0; 12];
        for (bytes, corner) in raw.chunks_mut(4).zip(triangle) {
            bytes.copy_from_slice(&corner.0.to_le_bytes());
        }
        output.put(&raw)?;
        output.item()?;
    }
    Ok(())
}

/// Three numbers of single precision.
pub(super) fn put_vector(output: &mut impl Output, v: Vec3) -> Result<(), Error> {
    let mut raw = [0; 12];
    for (bytes, coordinate) in raw.chunks_mut(4).zip(v.to_array()) {
        bytes.copy_from_slice(&coordinate.to_le_bytes());
    }
    output.put(&raw)
}

/// A normal of unit length stays as it is, to the last bit of single precision.
fn unit(normal: DVec3) -> Vec3 {
    let single = normal.as_vec3();
    match (single.length_squared() - 1.0).abs() < 1e-4 {
        true => single,
        false => normal.normalize().as_vec3(),
    }
}

/// Everything of the file before the bytes of its buffer, of which there are `binary`.
pub(super) fn put_header(
    sink: &mut Sink,
    path: &Path,
    document: &Value,
    binary: u64,
) -> Result<(), Error> {
    let mut json = document.to_string().into_bytes();
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let chunks = if binary > 0 { 8 + binary } else { 0 };
    let length = total(path, 12 + 8 + json.len() as u64 + chunks)?;
    sink.put(b"glTF")?;
    sink.put(&2u32.to_le_bytes())?;
    sink.put(&length.to_le_bytes())?;
    sink.put(&(json.len() as u32).to_le_bytes())?;
    sink.put(b"JSON")?;
    sink.put(&json)?;
    if binary > 0 {
        sink.put(&(binary as u32).to_le_bytes())?;
        sink.put(b"BIN\0")?;
    }
    Ok(())
}

/// The length of a file, which the format counts in 32 bits.
pub(super) fn total(path: &Path, length: u64) -> Result<u32, Error> {
    u32::try_from(length).map_err(|_| Error::TooMany {
        path: path.to_owned(),
        count: length,
        what: "bytes of a GLB file",
    })
}
