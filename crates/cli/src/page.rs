//! A page that shows meshes and points by itself: its parts stand in `assets/view`.
//!
//! ```text
//!   description   JSON: names, counts, and which block holds what
//!   blocks        base64 of zlib of words of four bytes, little endian, all first bytes ahead of all second ones, …
//!                 positions  three singles a vertex, around the middle of everything, the farthest at a distance of 1
//!                 corners    three indices a triangle, each as the difference from the last, its sign in the last bit
//!                 normals    three bytes a point, 127 being 1; plain bytes
//!   library       three.js and fflate
//!   viewer        reads the description, draws
//! ```

use crate::failure::Failure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec_zlib;
use pellicle::geometry::{Aabb, DVec3, PointCloud, VertexId};
use pellicle::glam::Vec3;
use pellicle::mesh::TriangleSoup;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const PAGE: &str = include_str!("../assets/view/page.html");
const STYLE: &str = include_str!("../assets/view/style.css");
const VIEWER: &str = include_str!("../assets/view/viewer.js");
const LIBRARY: &str = include_str!("../assets/view/three.min.js");

/// Of ten levels of compression: more takes much longer and wins little.
const LEVEL: u8 = 6;

/// What a page shows.
pub struct Page<'a> {
    /// Above it.
    pub title: String,
    /// All at once or one by one.
    pub shown: Shown,
    /// Which axis points up.
    pub up: Up,
    /// How long a step is shown.
    pub seconds: f64,
    /// At least one.
    pub items: &'a [Item],
}

/// How several items are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shown {
    /// All at once.
    Layers,
    /// One after the other.
    Steps,
}

/// The axis that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Up {
    /// y.
    Y,
    /// z.
    Z,
}

/// What a file holds.
pub struct Item {
    file: PathBuf,
    soup: TriangleSoup,
    /// Of points, one each; or none.
    normals: Vec<DVec3>,
}

/// What the viewer reads first.
#[derive(Serialize)]
struct Description<'a> {
    title: &'a str,
    shown: Shown,
    up: Up,
    seconds: f64,
    /// Of the box around everything.
    center: [f64; 3],
    /// The farthest vertex's distance from there; 1 where everything is in one place.
    radius: f64,
    /// Lengths of the box's sides.
    extent: [f64; 3],
    items: Vec<Described>,
}

#[derive(Serialize)]
struct Described {
    name: String,
    vertices: usize,
    triangles: usize,
    /// Ids of blocks.
    positions: String,
    corners: Option<String>,
    normals: Option<String>,
}

/// The data, each block once.
#[derive(Default)]
struct Blocks {
    html: String,
    /// Their numbers, by what they hold.
    ids: BTreeMap<Vec<u8>, usize>,
}

/// From coordinates to the unit ball.
struct Frame {
    center: DVec3,
    radius: f64,
    extent: DVec3,
}

/// A file's name without its folder.
pub fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

impl Item {
    /// The mesh of a file.
    pub fn mesh(file: &Path, soup: TriangleSoup) -> Self {
        Self {
            file: file.to_owned(),
            soup,
            normals: Vec::new(),
        }
    }

    /// The points of a file.
    pub fn points(file: &Path, cloud: PointCloud) -> Self {
        Self {
            file: file.to_owned(),
            normals: cloud.normals().unwrap_or_default().to_vec(),
            soup: TriangleSoup {
                positions: cloud.positions().to_vec(),
                triangles: Vec::new(),
            },
        }
    }

    /// Vertices or points.
    pub fn positions(&self) -> &[DVec3] {
        &self.soup.positions
    }

    /// None of points.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.soup.triangles
    }
}

impl Page<'_> {
    /// The page's text.
    pub fn to_html(&self) -> Result<String, Failure> {
        let frame = Frame::of(self.items);
        let mut blocks = Blocks::default();
        let items = self.items.iter().map(|item| blocks.describe(item, &frame));
        let description = Description {
            title: &self.title,
            shown: self.shown,
            up: self.up,
            seconds: self.seconds,
            items: items.collect(),
            center: frame.center.to_array(),
            radius: frame.radius,
            extent: frame.extent.to_array(),
        };
        let json = serde_json::to_string(&description)
            .map_err(|error| Failure::StandardOutput(error.into()))?;
        // No text of the user's may end the element that it stands in.
        let json = json.replace('<', "\\u003c");
        Ok(fill(&[
            ("version", env!("CARGO_PKG_VERSION")),
            ("title", &escape(&self.title)),
            ("style", STYLE),
            ("description", &json),
            ("data", &blocks.html),
            ("library", LIBRARY),
            ("viewer", VIEWER),
        ]))
    }
}

impl Blocks {
    fn describe(&mut self, item: &Item, frame: &Frame) -> Described {
        let positions = item.positions().iter();
        let positions = positions.flat_map(|&p| frame.place(p).to_array().map(f32::to_bits));
        let corners = item.triangles().as_flattened();
        let normals = item.normals.iter().flat_map(|&n| signed_bytes(n));
        Described {
            name: name(&item.file),
            vertices: item.positions().len(),
            triangles: item.triangles().len(),
            positions: self.add(planes(positions)),
            corners: (!corners.is_empty()).then(|| self.add(planes(differences(corners)))),
            normals: (!item.normals.is_empty()).then(|| self.add(normals.collect())),
        }
    }

    /// The id of a block with these bytes: steps often have the triangles of the step before.
    fn add(&mut self, bytes: Vec<u8>) -> String {
        let packed = compress_to_vec_zlib(&bytes, LEVEL);
        let next = self.ids.len();
        let id = *self.ids.entry(packed).or_insert_with_key(|packed| {
            let start = format!("<script type=\"application/octet-stream\" id=\"block-{next}\">");
            self.html.push_str(&start);
            STANDARD.encode_string(packed, &mut self.html);
            self.html.push_str("</script>\n");
            next
        });
        format!("block-{id}")
    }
}

impl Frame {
    fn of(items: &[Item]) -> Self {
        let all = || items.iter().flat_map(|item| item.positions()).copied();
        let bounds = all().fold(Aabb::EMPTY, Aabb::with);
        if bounds.is_empty() {
            return Self {
                center: DVec3::ZERO,
                radius: 1.0,
                extent: DVec3::ZERO,
            };
        }
        // Halves and a scale, so that no finite box overflows.
        let center = bounds.center();
        let largest = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
        let scaled = |p: DVec3| (p * 0.5 - center * 0.5) / largest;
        let farthest = all()
            .map(|p| scaled(p).length_squared())
            .fold(0.0, f64::max);
        let radius = farthest.sqrt() * 2.0 * largest;
        Self {
            center,
            radius: match radius > 0.0 && radius.is_finite() {
                true => radius,
                false if largest > 0.0 => f64::MAX,
                false => 1.0,
            },
            extent: (bounds.max - bounds.min).min(DVec3::MAX),
        }
    }

    fn place(&self, p: DVec3) -> Vec3 {
        ((p * 0.5 - self.center * 0.5) / (0.5 * self.radius)).as_vec3()
    }
}

/// A normal at length one, 127 being 1; zero where it has no direction.
fn signed_bytes(normal: DVec3) -> [u8; 3] {
    let unit = (normal / normal.abs().max_element()).normalize_or_zero();
    let byte = |v: f64| (v * 127.0).round() as i8 as u8;
    unit.to_array().map(byte)
}

/// Each index as the difference from the one before, its sign in the last bit.
fn differences(indices: &[VertexId]) -> impl Iterator<Item = u32> {
    let mut last = 0_u32;
    indices.iter().map(move |index| {
        let step = index.0.wrapping_sub(last) as i32;
        last = index.0;
        ((step << 1) ^ (step >> 31)) as u32
    })
}

/// All first bytes, then all second ones, …: alike bytes stand together.
fn planes(words: impl Iterator<Item = u32>) -> Vec<u8> {
    let words: Vec<[u8; 4]> = words.map(u32::to_le_bytes).collect();
    let plane = |i: usize| words.iter().map(move |word| word[i]);
    (0..4).flat_map(plane).collect()
}

/// The page with its parts in place; no part is looked through for the names of others.
fn fill(parts: &[(&str, &str)]) -> String {
    let length: usize = parts.iter().map(|(_, part)| part.len()).sum();
    let mut html = String::with_capacity(PAGE.len() + length);
    let mut rest = PAGE;
    while let Some((before, after)) = rest.split_once("{{") {
        let Some((key, after)) = after.split_once("}}") else {
            break;
        };
        html.push_str(before);
        let part = parts.iter().find(|(name, _)| *name == key);
        html.push_str(part.map_or("", |(_, part)| part));
        rest = after;
    }
    html.push_str(rest);
    html
}

/// Text as HTML shows it.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            letter => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;
    use serde_json::Value;

    /// What the viewer does, in Rust.
    fn words(html: &str, id: &str) -> Vec<u32> {
        let bytes = bytes(html, id);
        let count = bytes.len() / 4;
        let word = |i: usize| std::array::from_fn(|plane| bytes[plane * count + i]);
        (0..count).map(|i| u32::from_le_bytes(word(i))).collect()
    }

    fn bytes(html: &str, id: &str) -> Vec<u8> {
        let (_, after) = html.split_once(&format!("id=\"{id}\">")).unwrap();
        let (text, _) = after.split_once("</script>").unwrap();
        decompress_to_vec_zlib(&STANDARD.decode(text).unwrap()).unwrap()
    }

    fn description(html: &str) -> Value {
        let (_, after) = html.split_once("id=\"description\">").unwrap();
        let (text, _) = after.split_once("</script>").unwrap();
        serde_json::from_str(text).unwrap()
    }

    fn page(items: &[Item], title: &str) -> String {
        let page = Page {
            title: title.to_owned(),
            shown: Shown::Steps,
            up: Up::Z,
            seconds: 0.5,
            items,
        };
        page.to_html().unwrap()
    }

    fn indices(words: &[u32]) -> Vec<u32> {
        let mut last = 0_u32;
        let read = words.iter().map(|&word| {
            last = last.wrapping_add((word >> 1) ^ (word & 1).wrapping_neg());
            last
        });
        read.collect()
    }

    fn soup() -> TriangleSoup {
        let mut soup = pellicle::mesh::icosphere(2).unwrap().into_soup();
        for p in &mut soup.positions {
            *p = *p * DVec3::new(3.0, 2.0, 1.0) + DVec3::new(4e6, -5e6, 7.0);
        }
        soup.triangles.reverse();
        soup
    }

    #[test]
    fn data_come_back() {
        let soup = soup();
        let moved = TriangleSoup {
            positions: soup.positions.iter().map(|p| *p + DVec3::X).collect(),
            triangles: soup.triangles.clone(),
        };
        let items = [
            Item::mesh(Path::new("a/one.ply"), soup.clone()),
            Item::mesh(Path::new("a/two.ply"), moved.clone()),
        ];
        let html = page(&items, "both");
        let description = description(&html);
        let center = DVec3::from_array(std::array::from_fn(|i| {
            description["center"][i].as_f64().unwrap()
        }));
        let radius = description["radius"].as_f64().unwrap();
        for (i, soup) in [soup, moved].iter().enumerate() {
            let item = &description["items"][i];
            assert_eq!(item["vertices"], soup.positions.len());
            assert_eq!(item["triangles"], soup.triangles.len());
            let read: Vec<f32> = words(&html, item["positions"].as_str().unwrap())
                .into_iter()
                .map(f32::from_bits)
                .collect();
            assert_eq!(read.len(), 3 * soup.positions.len());
            for (p, read) in soup.positions.iter().zip(read.chunks(3)) {
                let read = DVec3::new(read[0].into(), read[1].into(), read[2].into());
                assert!((read * radius + center - *p).length() < 2e-7 * radius);
                assert!(read.length() <= 1.0 + 1e-6);
            }
            let read = indices(&words(&html, item["corners"].as_str().unwrap()));
            let expected: Vec<u32> = soup.triangles.as_flattened().iter().map(|v| v.0).collect();
            assert_eq!(read, expected);
        }
        // The triangles are the same, and stand in the page once.
        assert_eq!(
            description["items"][0]["corners"],
            description["items"][1]["corners"]
        );
        assert_eq!(html.matches("application/octet-stream").count(), 3);
    }

    #[test]
    fn indices_of_any_size_come_back() {
        let soup = TriangleSoup {
            positions: vec![DVec3::ZERO; 3],
            triangles: vec![
                [0, u32::MAX - 1, 1 << 31].map(VertexId),
                [7, 0, 3].map(VertexId),
            ],
        };
        let words: Vec<u32> = differences(soup.triangles.as_flattened()).collect();
        assert_eq!(indices(&words), [0, u32::MAX - 1, 1 << 31, 7, 0, 3]);
    }

    #[test]
    fn normals_come_back() {
        let normals = vec![DVec3::Z, -2.0 * DVec3::X, DVec3::new(1e300, 1e300, 0.0)];
        let cloud = PointCloud::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y])
            .unwrap()
            .with_normals(normals)
            .unwrap();
        let html = page(&[Item::points(Path::new("p.xyz"), cloud)], "points");
        let description = description(&html);
        assert_eq!(description["items"][0]["corners"], Value::Null);
        let read = bytes(&html, description["items"][0]["normals"].as_str().unwrap());
        let read: Vec<i8> = read.into_iter().map(|byte| byte as i8).collect();
        assert_eq!(read, [0, 0, 127, -127, 0, 0, 90, 90, 0]);
        assert_eq!(signed_bytes(DVec3::ZERO), [0; 3]);
    }

    #[test]
    fn no_name_breaks_the_page() {
        let evil = "</script><script>alert('1')</script>&\"{{library}}";
        let file = Path::new("<title><!--\u{2028}{{data}}.ply");
        let html = page(&[Item::mesh(file, soup())], evil);
        assert!(!html.contains("<script>alert"));
        let plain = page(&[Item::mesh(Path::new("a.ply"), soup())], "a");
        for tag in ["<script", "</script", "<!--", "<title"] {
            assert_eq!(
                html.matches(tag).count(),
                plain.matches(tag).count(),
                "{tag}"
            );
        }
        let description = description(&html);
        assert_eq!(description["title"], evil);
        assert_eq!(
            description["items"][0]["name"],
            "<title><!--\u{2028}{{data}}.ply".to_owned()
        );
    }

    #[test]
    fn every_part_is_in_its_place_and_fits_into_a_script() {
        let html = page(&[Item::mesh(Path::new("a.ply"), soup())], "a");
        for part in [STYLE, VIEWER, LIBRARY] {
            assert_eq!(html.matches(part).count(), 1);
            assert!(!part.contains("</script") && !part.contains("<!--"));
        }
        assert!(!html.contains("{{title}}") && !html.contains("{{viewer}}"));
        // Nothing is fetched: no element names another file.
        let around: String = html.replace(LIBRARY, "").replace(VIEWER, "");
        for reference in [" src=", "@import", "url(", "http://", "https://"] {
            assert!(!around.contains(reference), "{reference}");
        }
        assert!(VIEWER.matches("fetch").count() == 0);
    }

    #[test]
    fn any_finite_coordinates_have_a_place() {
        let lone = |position| TriangleSoup {
            positions: vec![position],
            triangles: Vec::new(),
        };
        for positions in [
            vec![DVec3::splat(1e300)],
            vec![DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX)],
            vec![DVec3::ZERO, DVec3::splat(f64::MIN_POSITIVE)],
            vec![DVec3::ZERO, DVec3::X * 5e-324],
        ] {
            let items: Vec<Item> = positions
                .iter()
                .map(|&p| Item::mesh(Path::new("a.ply"), lone(p)))
                .collect();
            let frame = Frame::of(&items);
            assert!(frame.radius > 0.0 && frame.radius.is_finite() && frame.extent.is_finite());
            for &p in &positions {
                let placed = frame.place(p);
                assert!(
                    placed.is_finite() && placed.length() <= 1.75,
                    "{p}: {placed}"
                );
            }
        }
    }
}
