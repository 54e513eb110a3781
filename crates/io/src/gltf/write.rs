//! One mesh in one node, in one binary file. Vertices are single precision; the translation of the node is a
//! number of JSON and brings them back to their place.

use super::encode::{Description, asset, put_header, put_mesh, translate, usable};
use crate::sink::Sink;
use crate::write::Rounded;
use crate::{Error, Format, Note};
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
    let normals = usable(normals, notes);
    // The format has no empty accessor, and no place for vertices without a primitive.
    if mesh.triangles.is_empty() {
        return put_header(sink, path, &json!({ "asset": asset() }), 0);
    }
    let mut description = Description::default();
    let mut node = json!({ "mesh": description.mesh(&rounded, mesh, normals.is_some()) });
    translate(&mut node, rounded.shift);
    let binary = description.length;
    let document = description.document(vec![node], Vec::new());
    put_header(sink, path, &document, binary)?;
    put_mesh(sink, &rounded, mesh, normals)
}
