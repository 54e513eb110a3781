//! Animations, as the crate `gltf` and our own reader see them.

use pellicle_geometry::{DVec3, Progress, VertexId};
use pellicle_io::{
    AnimationOptions, AnimationWriter, Error, Frame, Note, Overwrite, ReadOptions, WriteOptions,
    WriteReport, read_mesh, write_animation, write_mesh,
};
use pellicle_mesh::{MeshView, TriangleSoup};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

const REPLACE: WriteOptions = WriteOptions {
    format: None,
    overwrite: Overwrite::Replace,
    encoding: pellicle_io::Encoding::Binary,
    progress: &(),
};

/// A fan of `corners` around a middle, of some size and place: exact in single precision where these are.
fn fan(corners: u32, size: f64, place: DVec3) -> TriangleSoup {
    let at = |i: u32| DVec3::new(f64::from(i), f64::from(i * i % 7), f64::from(i % 3));
    TriangleSoup {
        positions: (0..=corners).map(|i| place + size * at(i)).collect(),
        triangles: (1..corners).map(|i| [0, i, i + 1].map(VertexId)).collect(),
    }
}

fn write(path: &Path, soups: &[TriangleSoup], seconds: f64) -> WriteReport {
    let frames = soups.iter().map(|soup| Frame {
        mesh: soup.into(),
        normals: None,
    });
    let animation = AnimationOptions {
        frame_seconds: seconds,
    };
    write_animation(path, frames, &animation, &REPLACE).unwrap()
}

/// A file as `gltf` reads and validates it: for each node with a mesh its positions, corners and, at a time, scale.
struct Played {
    document: gltf::Document,
    binary: Vec<u8>,
    /// By node: times and scales.
    tracks: BTreeMap<usize, (Vec<f32>, Vec<[f32; 3]>)>,
}

impl Played {
    fn open(path: &Path) -> Self {
        let gltf::Gltf { document, blob } = gltf::Gltf::open(path).unwrap();
        let binary = blob.unwrap_or_default();
        let mut tracks = BTreeMap::new();
        for animation in document.animations() {
            for channel in animation.channels() {
                let sampler = channel.sampler();
                assert_eq!(
                    sampler.interpolation(),
                    gltf::animation::Interpolation::Step
                );
                let reader = channel.reader(|_| Some(&binary));
                let times: Vec<f32> = reader.read_inputs().unwrap().collect();
                let Some(gltf::animation::util::ReadOutputs::Scales(scales)) =
                    reader.read_outputs()
                else {
                    panic!("an animation of something but a scale");
                };
                let scales: Vec<[f32; 3]> = scales.collect();
                // What the format wants of times.
                assert_eq!(times.len(), scales.len());
                assert!(times[0] >= 0.0 && times.is_sorted_by(|a, b| a < b));
                let stated = |value: Option<gltf::json::Value>| {
                    value.unwrap().as_array().unwrap()[0].as_f64().unwrap() as f32
                };
                assert_eq!(stated(sampler.input().min()), times[0]);
                assert_eq!(stated(sampler.input().max()), *times.last().unwrap());
                let node = channel.target().node().index();
                assert!(tracks.insert(node, (times, scales)).is_none());
            }
        }
        Self {
            document,
            binary,
            tracks,
        }
    }

    /// The frames' nodes: the children of the only root.
    fn frames(&self) -> Vec<gltf::Node<'_>> {
        let scene = self.document.default_scene().unwrap();
        let roots: Vec<_> = scene.nodes().collect();
        assert_eq!(roots.len(), 1);
        roots[0].children().collect()
    }

    fn shift(&self) -> DVec3 {
        let scene = self.document.default_scene().unwrap();
        let root = scene.nodes().next().unwrap();
        DVec3::from_array(root.transform().decomposed().0.map(f64::from))
    }

    /// The frames that are seen at a time, by their place.
    fn seen(&self, time: f32) -> Vec<usize> {
        let shown = |(_, node): &(usize, gltf::Node)| {
            let (times, scales) = &self.tracks[&node.index()];
            let key = times.partition_point(|&key| key <= time);
            match scales[key.saturating_sub(1)] {
                [1.0, 1.0, 1.0] => true,
                [0.0, 0.0, 0.0] => false,
                other => panic!("{other:?}"),
            }
        };
        let frames = self.frames().into_iter().enumerate();
        frames.filter(shown).map(|(frame, _)| frame).collect()
    }

    fn mesh(&self, node: &gltf::Node) -> TriangleSoup {
        let mesh = node.mesh().unwrap();
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&self.binary));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let (least, greatest) = positions.iter().fold(
            ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]),
            |(least, greatest), p| {
                (
                    std::array::from_fn(|i| least[i].min(p[i])),
                    std::array::from_fn(|i| greatest[i].max(p[i])),
                )
            },
        );
        let bounds = primitive.bounding_box();
        assert_eq!((bounds.min, bounds.max), (least, greatest));
        let indices = primitive.indices().unwrap();
        assert_eq!(indices.data_type(), gltf::accessor::DataType::U32);
        let corners: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        TriangleSoup {
            positions: positions
                .iter()
                .map(|p| DVec3::from_array(p.map(f64::from)) + self.shift())
                .collect(),
            triangles: corners
                .chunks(3)
                .map(|t| [t[0], t[1], t[2]].map(VertexId))
                .collect(),
        }
    }
}

#[test]
fn every_frame_is_seen_alone_and_in_its_time() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let all: Vec<TriangleSoup> = (3..10)
        .map(|n| fan(n, 0.5 * f64::from(n), DVec3::splat(f64::from(n))))
        .collect();
    for count in 1..=all.len() {
        let soups = &all[..count];
        let report = write(&path, soups, 0.25);
        assert_eq!(report.notes, []);
        assert_eq!(report.bytes, std::fs::metadata(&path).unwrap().len());
        let played = Played::open(&path);
        let frames = played.frames();
        assert_eq!(frames.len(), count);
        for (frame, (node, soup)) in frames.iter().zip(soups).enumerate() {
            assert_eq!(played.mesh(node), *soup);
            let start = 0.25 * frame as f32;
            for time in [start, start + 0.1, (start + 0.25).next_down()] {
                assert_eq!(played.seen(time), [frame], "{count} frames, at {time}");
            }
            // At rest the last one is seen, and no other.
            let scale = node.transform().decomposed().2;
            let expected = if frame + 1 == count { 1.0 } else { 0.0 };
            assert_eq!(scale, [expected; 3]);
        }
        // The last frame has its time as well, and stays.
        let end = 0.25 * count as f32;
        let ends = played
            .tracks
            .values()
            .map(|(times, _)| *times.last().unwrap());
        assert_eq!(ends.fold(0.0, f32::max), end);
        assert_eq!(played.seen(end + 100.0), [count - 1]);
    }
}

#[test]
fn our_reader_takes_the_last_frame() {
    let place = tempfile::tempdir().unwrap();
    let (path, alone) = (place.path().join("a.glb"), place.path().join("b.glb"));
    // Not exact in single precision, and far away: as a file with the last frame alone has it.
    let soups: Vec<TriangleSoup> = (3..8)
        .map(|n| fan(n, 0.1, DVec3::new(5e6, -3e5, 0.1 * f64::from(n))))
        .collect();
    let report = write(&path, &soups, 0.1);
    write_mesh(&alone, soups.last().unwrap(), None, &REPLACE).unwrap();
    let read = read_mesh(&path, &ReadOptions::default()).unwrap();
    let last = soups.last().unwrap();
    assert_eq!(read.soup.triangles, last.triangles);
    let Some(Note::Rounded { error }) = report.notes.last() else {
        panic!("{:?}", report.notes);
    };
    assert!(*error > 0.0 && *error < 1e-6, "{error:e}");
    for (p, q) in read.soup.positions.iter().zip(&last.positions) {
        assert!((*p - *q).abs().max_element() <= *error, "{p} {q}");
    }
    let shift = report.shift().unwrap();
    assert!((shift - DVec3::new(5e6, -3e5, 0.3)).length() < 2.0);
    assert_eq!(Played::open(&path).shift(), shift);
    let ignored = |what: &str, count| Note::Ignored {
        what: what.into(),
        count,
    };
    let notes = &read.report.notes;
    assert!(notes.contains(&ignored("hidden nodes", 4)), "{notes:?}");
    assert!(notes.contains(&ignored("animations", 1)), "{notes:?}");
}

#[test]
fn normals_come_along_where_they_have_a_direction() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let soup = fan(4, 1.0, DVec3::ZERO);
    let up = vec![DVec3::Z; 5];
    let none = vec![DVec3::ZERO; 5];
    let frames = [Some(&up), None, Some(&none), Some(&none), Some(&up)].map(|normals| Frame {
        mesh: (&soup).into(),
        normals: normals.map(Vec::as_slice),
    });
    let options = AnimationOptions::default();
    let report = write_animation(&path, frames, &options, &REPLACE).unwrap();
    assert!(matches!(report.notes[..], [Note::NormalsDropped { .. }]));
    let played = Played::open(&path);
    let found: Vec<Option<Vec<[f32; 3]>>> = played
        .frames()
        .iter()
        .map(|node| {
            let mesh = node.mesh().unwrap();
            let primitive = mesh.primitives().next().unwrap();
            let reader = primitive.reader(|_| Some(&played.binary));
            reader.read_normals().map(Iterator::collect)
        })
        .collect();
    let up = Some(vec![[0.0, 0.0, 1.0]; 5]);
    assert_eq!(found, [up.clone(), None, None, None, up]);
}

#[test]
fn no_frame_and_frames_without_triangles() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    write(&path, &[], 0.1);
    assert_eq!(gltf::Gltf::open(&path).unwrap().document.nodes().len(), 0);
    let (empty, soup) = (TriangleSoup::default(), fan(3, 1.0, DVec3::ZERO));
    let soups = [empty.clone(), soup.clone(), empty.clone()];
    write(&path, &soups, 0.5);
    let played = Played::open(&path);
    let frames = played.frames();
    assert!(frames[0].mesh().is_none() && frames[2].mesh().is_none());
    assert_eq!(played.mesh(&frames[1]), soup);
    assert_eq!(played.seen(0.75), [1]);
    write(&path, &[empty], 0.5);
    assert_eq!(Played::open(&path).seen(0.0), [0]);
}

#[test]
fn what_is_wrong_is_refused_and_leaves_nothing() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let soup = fan(3, 1.0, DVec3::ZERO);
    for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
        let animation = AnimationOptions {
            frame_seconds: seconds,
        };
        let error = write_animation(&path, [], &animation, &REPLACE).unwrap_err();
        assert!(matches!(error, Error::FrameSeconds { .. }), "{error}");
    }
    // Each time is a number, but not their sum.
    let animation = AnimationOptions {
        frame_seconds: 3e38,
    };
    let frame = Frame {
        mesh: (&soup).into(),
        normals: None,
    };
    let error = write_animation(&path, [frame; 2], &animation, &REPLACE).unwrap_err();
    assert!(matches!(error, Error::FrameSeconds { .. }), "{error}");

    let push = |mesh: MeshView, normals: Option<&[DVec3]>| {
        let options = AnimationOptions::default();
        let mut writer = AnimationWriter::create(&path, &options, &REPLACE).unwrap();
        assert!(writer.is_empty());
        writer.push(frame).unwrap();
        assert_eq!(writer.len(), 1);
        writer.push(Frame { mesh, normals }).unwrap_err()
    };
    let mut wrong = soup.clone();
    wrong.positions[2].y = f64::NAN;
    let error = push((&wrong).into(), None);
    assert!(matches!(error, Error::VertexNotFinite { .. }), "{error}");
    wrong.positions[2].y = 1e300;
    let error = push((&wrong).into(), None);
    assert!(matches!(error, Error::Range { .. }), "{error}");
    let mut wrong = soup.clone();
    wrong.triangles[1][0] = VertexId(4);
    let error = push((&wrong).into(), None);
    assert!(matches!(error, Error::VertexOutOfRange { .. }), "{error}");
    let error = push((&soup).into(), Some(&[DVec3::Z]));
    assert!(matches!(error, Error::NormalCount { .. }), "{error}");
    assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 0);
}

#[test]
fn a_file_that_exists_is_refused_at_the_start() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    std::fs::write(&path, "before").unwrap();
    let error = AnimationWriter::create(&path, &Default::default(), &WriteOptions::default());
    assert!(matches!(error, Err(Error::Exists { .. })));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "before");
}

#[test]
fn a_stop_leaves_nothing() {
    struct StopAt(&'static str);
    impl Progress for StopAt {
        fn step(&self, stage: &'static str, done: u64, _: u64) -> ControlFlow<()> {
            match stage == self.0 && done >= 1 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        }
    }
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let soup = fan(3, 1.0, DVec3::ZERO);
    let frame = Frame {
        mesh: (&soup).into(),
        normals: None,
    };
    for stage in ["animate", "write"] {
        let options = WriteOptions {
            progress: &StopAt(stage),
            ..REPLACE
        };
        let stopped = write_animation(&path, [frame; 3], &Default::default(), &options);
        assert!(matches!(stopped, Err(Error::Cancelled(_))), "{stage}");
        assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any frames in any time: one is seen at a time, in their order, each as it was.
    #[test]
    fn any_frames(sizes in prop::collection::vec(2_u32..40, 1..12), seconds in 1e-3_f64..10.0) {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.glb");
        let soups: Vec<TriangleSoup> = sizes.iter().map(|&n| fan(n, 0.25, DVec3::ZERO)).collect();
        write(&path, &soups, seconds);
        let played = Played::open(&path);
        for (frame, (node, soup)) in played.frames().iter().zip(&soups).enumerate() {
            prop_assert_eq!(&played.mesh(node), soup);
            let middle = ((frame as f64 + 0.5) * seconds) as f32;
            prop_assert_eq!(played.seen(middle), [frame]);
        }
        let read = read_mesh(&path, &ReadOptions::default()).unwrap();
        prop_assert_eq!(&read.soup, soups.last().unwrap());
    }
}
