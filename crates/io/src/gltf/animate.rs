//! Meshes shown one after the other: one node a frame, whose scale is animated in steps.
//!
//! ```text
//!   frame   0 │ 1   0                     A scale of zero on all axes hides a node (Khronos 2021, "Transformations");
//!   frame 1   │ 0   1   0                 each frame keeps to three keys of the times, which all frames share:
//!   frame   2 │     0   1   1             hidden, shown, hidden. Before its first key and after its last, a track
//!             └─────────────── time       keeps what it has there, so that hidden stays hidden.
//!               t₀  t₁  t₂  t₃
//! ```

use super::encode::{
    Description, FLOAT, Output, asset, put_header, put_mesh, put_vector, total, translate, usable,
};
use crate::sink::Sink;
use crate::write::{Rounded, check};
use crate::{Error, Format, Note, WriteOptions, WriteReport};
use glam::Vec3;
use pellicle_geometry::{Aabb, Cancelled, DVec3};
use pellicle_mesh::MeshView;
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};
use std::path::Path;

/// How long each frame of an animation is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimationOptions {
    /// Seconds a frame, positive; default 0.1.
    pub frame_seconds: f64,
}

impl Default for AnimationOptions {
    fn default() -> Self {
        Self { frame_seconds: 0.1 }
    }
}

/// One picture of an animation.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The mesh; its connectivity is its own.
    pub mesh: MeshView<'a>,
    /// One normal a vertex, or none.
    pub normals: Option<&'a [DVec3]>,
}

/// Writes meshes that are shown one after the other, as an animated GLB. Linear time; memory is that of one frame.
///
/// See [`AnimationWriter`] for what the file holds.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_io::{AnimationOptions, Frame, WriteOptions, write_animation};
/// use pellicle_mesh::MeshView;
///
/// let folder = tempfile::tempdir()?;
/// let triangles = [[0, 1, 2].map(VertexId)];
/// let growing = [1.0, 2.0, 3.0].map(|size| [DVec3::ZERO, size * DVec3::X, size * DVec3::Y]);
/// let frames = growing.iter().map(|positions| Frame {
///     mesh: MeshView { positions, triangles: &triangles },
///     normals: None,
/// });
/// let path = folder.path().join("growing.glb");
/// write_animation(&path, frames, &AnimationOptions::default(), &WriteOptions::default())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_animation<'a>(
    path: impl AsRef<Path>,
    frames: impl IntoIterator<Item = Frame<'a>>,
    animation: &AnimationOptions,
    options: &WriteOptions,
) -> Result<WriteReport, Error> {
    let mut writer = AnimationWriter::create(path.as_ref(), animation, options)?;
    for frame in frames {
        writer.push(frame)?;
    }
    writer.finish()
}

/// An animated GLB that takes its frames one by one, and holds none of them.
///
/// Frame `k` is shown from `k` to `k + 1` times the frame's seconds; at rest, where nothing plays, the last one is.
/// Every reader of glTF 2.0 that plays animations shows it: one node a frame, with a scale of one in its time and of
/// zero at any other. All frames have one translation, which the first one sets.
///
/// The bytes of the frames wait in a nameless file beside the future one, since its beginning describes all of them.
/// Dropped before [`AnimationWriter::finish`], it leaves nothing.
pub struct AnimationWriter<'a> {
    sink: Sink<'a>,
    path: &'a Path,
    options: WriteOptions<'a>,
    frame_seconds: f64,
    scratch: Scratch<'a>,
    description: Description,
    /// For each frame, its mesh; none where it has no triangle.
    frames: Vec<Option<usize>>,
    shift: Option<DVec3>,
    error: f64,
    notes: Vec<Note>,
}

impl<'a> AnimationWriter<'a> {
    /// Starts a file; `options.format` and `options.encoding` do not matter.
    pub fn create(
        path: &'a (impl AsRef<Path> + ?Sized),
        animation: &AnimationOptions,
        options: &WriteOptions<'a>,
    ) -> Result<Self, Error> {
        let path = path.as_ref();
        // Times are single precision in the file.
        let seconds = animation.frame_seconds as f32;
        if !(seconds.is_normal() && seconds > 0.0) {
            return Err(Error::FrameSeconds {
                path: path.to_owned(),
                seconds: animation.frame_seconds,
            });
        }
        let sink = Sink::create(path, options.overwrite, options.progress, 0)?;
        let file = sink.scratch()?;
        Ok(Self {
            sink,
            path,
            options: *options,
            frame_seconds: animation.frame_seconds,
            scratch: Scratch {
                out: BufWriter::with_capacity(1 << 18, file),
                path,
            },
            description: Description::default(),
            frames: Vec::new(),
            shift: None,
            error: 0.0,
            notes: Vec::new(),
        })
    }

    /// How many frames there are.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no frame yet.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Adds a frame behind the others. Linear time. After an error the file cannot be finished.
    pub fn push(&mut self, frame: Frame) -> Result<(), Error> {
        let Frame { mesh, normals } = frame;
        check(self.path, mesh, normals)?;
        if mesh.triangles.is_empty() {
            self.frames.push(None);
            return Ok(());
        }
        let shift = *self.shift.get_or_insert_with(|| {
            Rounded::far_shift(Aabb::of_points(mesh.positions)).unwrap_or(DVec3::ZERO)
        });
        let rounded = Rounded { shift };
        let error = rounded.error(mesh.positions).ok_or_else(|| Error::Range {
            path: self.path.to_owned(),
            format: Format::Glb,
        })?;
        self.error = self.error.max(error);
        let normals = usable(normals, &mut self.notes);
        let mesh_index = self.description.mesh(&rounded, mesh, normals.is_some());
        total(self.path, self.description.length)?;
        put_mesh(&mut self.scratch, &rounded, mesh, normals)?;
        self.frames.push(Some(mesh_index));
        let done = self.frames.len() as u64;
        Cancelled::check(self.options.progress.step("animate", done, done))?;
        Ok(())
    }

    /// Brings the file to its name.
    pub fn finish(mut self) -> Result<WriteReport, Error> {
        let shift = self.shift.unwrap_or_default();
        let animation = self.animation()?;
        let mut root = json!({ "name": "frames" });
        translate(&mut root, shift);
        let mut nodes = vec![root];
        for (frame, mesh) in self.frames.iter().enumerate() {
            let mut node = json!({ "name": format!("frame {frame}") });
            if let Some(mesh) = mesh {
                node["mesh"] = json!(mesh);
            }
            if frame + 1 < self.frames.len() {
                node["scale"] = json!([0, 0, 0]);
            }
            nodes.push(node);
        }
        let binary = self.description.length;
        let document = match self.frames.len() {
            0 => json!({ "asset": asset() }),
            frames => {
                nodes[0]["children"] = json!((1..=frames).collect::<Vec<_>>());
                self.description.document(nodes, animation)
            }
        };
        put_header(&mut self.sink, self.path, &document, binary)?;
        self.scratch.copy(&mut self.sink, binary)?;
        let bytes = self.sink.finish()?;
        if shift != DVec3::ZERO {
            self.notes.push(Note::Shifted {
                shift,
                restored_by_file: true,
            });
        }
        if self.error > 0.0 {
            self.notes.push(Note::Rounded { error: self.error });
        }
        Ok(WriteReport {
            format: Format::Glb,
            bytes,
            notes: self.notes,
        })
    }

    /// The animation, of which there is none without frames, and the numbers of its keys behind those of the meshes.
    fn animation(&mut self) -> Result<Vec<Value>, Error> {
        let frames = self.frames.len();
        if frames == 0 {
            return Ok(Vec::new());
        }
        let times: Vec<f32> = (0..=frames)
            .map(|key| (key as f64 * self.frame_seconds) as f32)
            .collect();
        if !times.is_sorted_by(|a, b| a < b) || !times[frames].is_finite() {
            return Err(Error::FrameSeconds {
                path: self.path.to_owned(),
                seconds: self.frame_seconds,
            });
        }
        let inputs = self.description.view(4 * times.len() as u64, None);
        for time in &times {
            self.scratch.put(&time.to_le_bytes())?;
        }
        // Hidden, shown, hidden; hidden, shown, shown. The first frame lacks the first key.
        let scales = [0.0, 1.0, 0.0, 0.0, 1.0, 1.0];
        let outputs = self.description.view(12 * scales.len() as u64, None);
        for scale in scales {
            put_vector(&mut self.scratch, Vec3::splat(scale))?;
        }
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        for frame in 0..frames {
            let first = frame.saturating_sub(1);
            let keys = &times[first..frame + 2];
            let input = self.description.accessor(json!({
                "bufferView": inputs, "byteOffset": 4 * first, "componentType": FLOAT,
                "type": "SCALAR", "count": keys.len(),
                "min": [keys[0]], "max": [keys[keys.len() - 1]],
            }));
            let from = 3 * usize::from(frame + 1 == frames) + usize::from(frame == 0);
            let output = self.description.accessor(json!({
                "bufferView": outputs, "byteOffset": 12 * from, "componentType": FLOAT,
                "type": "VEC3", "count": keys.len(),
            }));
            samplers.push(json!({ "input": input, "interpolation": "STEP", "output": output }));
            let target = json!({ "node": frame + 1, "path": "scale" });
            channels.push(json!({ "sampler": frame, "target": target }));
        }
        Ok(vec![
            json!({ "name": "frames", "samplers": samplers, "channels": channels }),
        ])
    }
}

/// Bytes that wait for what comes before them.
struct Scratch<'a> {
    out: BufWriter<File>,
    path: &'a Path,
}

impl Scratch<'_> {
    fn failed(&self, reason: io::Error) -> Error {
        Error::Io {
            path: self.path.to_owned(),
            action: "written",
            reason,
        }
    }

    /// Appends everything, which is `length` bytes.
    fn copy(mut self, sink: &mut Sink, length: u64) -> Result<(), Error> {
        self.out.flush().map_err(|e| self.failed(e))?;
        self.out.rewind().map_err(|e| self.failed(e))?;
        let mut block = vec![0; 1 << 20];
        let mut left = length;
        sink.expect(length.div_ceil(block.len() as u64));
        while left > 0 {
            let size = left.min(block.len() as u64) as usize;
            let read = self.out.get_mut().read_exact(&mut block[..size]);
            read.map_err(|e| self.failed(e))?;
            sink.put(&block[..size])?;
            sink.item()?;
            left -= size as u64;
        }
        Ok(())
    }
}

impl Output for Scratch<'_> {
    fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.out.write_all(bytes).map_err(|e| self.failed(e))
    }

    fn item(&mut self) -> Result<(), Error> {
        Ok(())
    }
}
