//! Times single steps on a large structure: `time_dynamic uniform 1000000 [steps]`.
//!
//! Tetrahedralises `uniform`, `sphere` (bumpy) or `grid` points from a fixed seed, then prints microseconds of user
//! time a step: insertion with and without a hint, removal, location, nearest vertex. Each kind of step is done at
//! random places, `steps` times (100 000 unless told); what is inserted is removed again.

use pellicle_delaunay::DynamicTetrahedralization;
use pellicle_geometry::{DVec3, VertexId};
use std::{env, error::Error, fs, hint::black_box, sync::OnceLock, time::Instant};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let kind = arguments.first().map_or("uniform", |kind| kind);
    let count = arguments.get(1).map_or(Ok(1_000_000), |n| n.parse())?;
    let steps = arguments.get(2).map_or(Ok(100_000), |n| n.parse())?;
    let mut random = SplitMix(12345 + count as u64);
    let points = random.points(kind, count).ok_or("unknown input")?;

    let start = user_seconds();
    let mut dynamic = DynamicTetrahedralization::of_points(&points)?;
    println!(
        "{kind}, {count} points: {:.2} s at once",
        user_seconds() - start
    );

    // New points beside vertices at random, at about a third of the distance to the next one.
    let anchors: Vec<VertexId> = (0..steps)
        .map(|_| VertexId::new(random.below(count)))
        .filter(|&vertex| dynamic.point(vertex).is_some())
        .collect();
    let beside: Vec<DVec3> = anchors
        .iter()
        .filter_map(|&vertex| {
            let point = dynamic.point(vertex)?;
            let neighbors = dynamic.neighbors(vertex).into_iter();
            let distances = neighbors.filter_map(|next| Some(dynamic.point(next)?.distance(point)));
            Some(point + random.direction() * (0.3 * distances.reduce(f64::min)?))
        })
        .collect();

    report("locate with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            black_box(dynamic.locate(point, Some(anchor)));
        }
    });
    report("locate without", beside.len(), || {
        for &point in &beside {
            black_box(dynamic.locate(point, None));
        }
    });
    report("nearest with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            black_box(dynamic.nearest_vertex(point, Some(anchor)));
        }
    });
    let mut inserted = Vec::with_capacity(beside.len());
    report("insert with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            inserted.push(dynamic.insert_near(point, anchor));
        }
    });
    let remove_all = |inserted: &mut Vec<_>, dynamic: &mut DynamicTetrahedralization| {
        report("remove", inserted.len(), || {
            for vertex in inserted.drain(..).flatten() {
                black_box(dynamic.remove(vertex).ok());
            }
        });
    };
    remove_all(&mut inserted, &mut dynamic);
    report("insert without", beside.len(), || {
        for &point in &beside {
            inserted.push(dynamic.insert(point));
        }
    });
    remove_all(&mut inserted, &mut dynamic);
    println!("{dynamic:?}");
    Ok(())
}

/// Prints what the steps took.
fn report(name: &str, steps: usize, work: impl FnOnce()) {
    let start = user_seconds();
    work();
    let each = (user_seconds() - start) / steps.max(1) as f64;
    println!("{name:>20}: {:6.2} µs", each * 1e6);
}

/// User time of this process where the system tells it, otherwise time on the clock.
fn user_seconds() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    let clock = START.get_or_init(Instant::now).elapsed().as_secs_f64();
    let told = fs::read_to_string("/proc/self/stat").ok();
    // Field 14, counted from 1; the second one ends with the last parenthesis. Ticks of 10 ms.
    let ticks = told.as_deref().and_then(|fields| {
        let after_name = fields.rsplit(')').next()?;
        after_name.split_whitespace().nth(11)?.parse::<f64>().ok()
    });
    ticks.map_or(clock, |ticks| ticks / 100.0)
}

/// The SplitMix64 generator.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0;
            if (1e-6..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    fn points(&mut self, kind: &str, count: usize) -> Option<Vec<DVec3>> {
        let side = (count as f64).cbrt().round() as usize;
        Some(match kind {
            "uniform" => (0..count)
                .map(|_| DVec3::new(self.unit(), self.unit(), self.unit()))
                .collect(),
            "sphere" => (0..count)
                .map(|_| {
                    let d = self.direction();
                    let bump = (5.0 * d.x).sin() * (5.0 * d.y).sin() * (5.0 * d.z).sin();
                    d * (1.0 + 0.1 * bump)
                })
                .collect(),
            "grid" => (0..side.pow(3))
                .map(|i| [i % side, i / side % side, i / side / side].map(|k| k as f64))
                .map(DVec3::from)
                .collect(),
            _ => return None,
        })
    }
}
