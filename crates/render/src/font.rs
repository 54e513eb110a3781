//! Letters and digits as strokes: no file of a font is needed, and any size is sharp.

use crate::Image;
use crate::shade::{Color, linear, pixel};

/// A letter is at most so many units wide, a capital so many high, and strokes so many thick.
const CAPITAL: f64 = 6.0;
const THICKNESS: f64 = 0.85;

/// Free units between letters, and the width of a space.
const GAP: f64 = 2.0;
const SPACE: f64 = 3.0;

/// The strokes of a letter: pairs of digits x y, strokes apart by a space. x from 0 to 4, the base line at y = 2, small
/// letters up to 6, capitals and digits up to 8, and tails down to 0.
fn strokes(letter: char) -> &'static str {
    match letter.to_ascii_lowercase() {
        '0' => "120307183847433212",
        '1' => "172822 1232",
        '2' => "07183847460242",
        '3' => "07183847463525 354443321203",
        '4' => "380444 3832",
        '5' => "480805354443321203",
        '6' => "4738180703123243443505",
        '7' => "084812",
        '8' => "15060718384746351504031232434435",
        '9' => "0312324347381807061545",
        'a' => "4642 4536160503123243",
        'b' => "0802 0516364543321203",
        'c' => "4536160503123243",
        'd' => "4842 4536160503123243",
        'e' => "04444536160503123243",
        'f' => "48382722 1646",
        'g' => "4641301001 4536160503123243",
        'h' => "0802 0516364542",
        'i' => "2622 2828",
        'j' => "26211000 2828",
        'k' => "0802 4604 2542",
        'l' => "2822",
        'm' => "0602 05162522 25364542",
        'n' => "0602 0516364542",
        'o' => "160503123243453616",
        'p' => "0600 0516364543321203",
        'q' => "4640 4536160503123243",
        'r' => "0602 042646",
        's' => "4616051434433202",
        't' => "28233242 1646",
        'u' => "0603123243 4642",
        'v' => "062246",
        'w' => "0612253246",
        'x' => "0642 4602",
        'y' => "0622 4610",
        'z' => "06460242",
        '-' => "0535",
        '+' => "0545 2327",
        '.' => "2222",
        ',' => "2221",
        ':' => "2222 2525",
        '=' => "0444 0646",
        '_' => "0141",
        '/' => "0248",
        '(' => "38272332",
        ')' => "18272312",
        ' ' => "",
        _ => "0208484202",
    }
}

/// A text as segments, in units, from x = 0 with the base line at y = 0 and y *up*; and its width.
fn lay_out(text: &str) -> (Vec<[(f64, f64); 2]>, f64) {
    let mut segments = Vec::new();
    let mut pen = 0.0;
    for letter in text.chars() {
        let number = |digit: u8| f64::from(digit - b'0');
        let lines: Vec<Vec<(f64, f64)>> = strokes(letter)
            .split_ascii_whitespace()
            .map(|stroke| {
                let pairs = stroke.as_bytes().chunks_exact(2);
                pairs
                    .map(|pair| (number(pair[0]), number(pair[1])))
                    .collect()
            })
            .collect();
        let x = || lines.iter().flatten().map(|&(x, _)| x);
        let (Some(left), Some(right)) = (x().reduce(f64::min), x().reduce(f64::max)) else {
            pen += SPACE;
            continue;
        };
        let place = |(x, y): (f64, f64)| (pen + x - left, y - 2.0);
        for line in &lines {
            segments.extend(line.windows(2).map(|pair| [place(pair[0]), place(pair[1])]));
        }
        pen += right - left + GAP;
    }
    (segments, (pen - GAP).max(0.0))
}

/// The width of a text whose capitals are `size` pixels high.
pub fn width(text: &str, size: f64) -> f64 {
    lay_out(text).1 * size / CAPITAL
}

/// Writes a text whose capitals are `size` pixels high from (`x`, `y`): left, on the base line, y down.
pub fn write(image: &mut Image, text: &str, (x, y): (f64, f64), size: f64, color: Color) {
    let unit = size / CAPITAL;
    let (segments, width) = lay_out(text);
    let half = (0.5 * THICKNESS * unit).max(0.5);
    let segments: Vec<_> = segments
        .iter()
        .map(|line| line.map(|(u, v)| (x + u * unit, y - v * unit)))
        .collect();
    // From the capitals' top to the tails' end.
    let rows = range(
        y - size - 2.0 * half,
        y + 2.0 * unit + 2.0 * half,
        image.height,
    );
    for row in rows {
        for column in range(x - 2.0 * half, x + width * unit + 2.0 * half, image.width) {
            let center = (column as f64 + 0.5, row as f64 + 0.5);
            let distances = segments.iter().map(|&line| distance(center, line));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            let share = (half - nearest + 0.5).clamp(0.0, 1.0);
            if share > 0.0 {
                let at = row * image.width as usize + column;
                image.pixels[at] = over(image.pixels[at], color, share);
            }
        }
    }
}

/// Fills a rectangle, whose sides may cut pixels.
pub fn fill(image: &mut Image, [left, right]: [f64; 2], [top, bottom]: [f64; 2], color: Color) {
    for row in range(top, bottom, image.height) {
        let high = (row as f64 + 1.0).min(bottom) - (row as f64).max(top);
        for column in range(left, right, image.width) {
            let wide = (column as f64 + 1.0).min(right) - (column as f64).max(left);
            let at = row * image.width as usize + column;
            image.pixels[at] = over(image.pixels[at], color, (wide * high).clamp(0.0, 1.0));
        }
    }
}

/// The pixels that lie between two places, in part at least.
fn range(from: f64, to: f64, limit: u32) -> std::ops::Range<usize> {
    let limit = limit as usize;
    (from.floor().max(0.0) as usize).min(limit)..(to.ceil().max(0.0) as usize).min(limit)
}

/// A pixel, of which a share is covered by a colour.
fn over(below: [u8; 4], color: Color, share: f64) -> [u8; 4] {
    let opacity = f64::from(below[3]) / 255.0;
    let left = opacity * (1.0 - share);
    let total = share + left;
    if total <= 0.0 {
        return below;
    }
    let mixed = (color * share + linear([below[0], below[1], below[2]]) * left) / total;
    let [red, green, blue, _] = pixel(mixed);
    [red, green, blue, (total * 255.0 + 0.5) as u8]
}

fn distance((x, y): (f64, f64), [a, b]: [(f64, f64); 2]) -> f64 {
    let (ex, ey) = (b.0 - a.0, b.1 - a.1);
    let length = ex * ex + ey * ey;
    let along = match length > 0.0 {
        true => (((x - a.0) * ex + (y - a.1) * ey) / length).clamp(0.0, 1.0),
        false => 0.0,
    };
    let (dx, dy) = (x - a.0 - ex * along, y - a.1 - ey * along);
    (dx * dx + dy * dy).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_is_pairs_of_digits_on_its_grid() {
        for letter in (32_u8..127).map(char::from).chain(['é', '中']) {
            for stroke in strokes(letter).split_ascii_whitespace() {
                assert!(
                    stroke.len() >= 4 && stroke.len().is_multiple_of(2),
                    "{letter}"
                );
                for pair in stroke.as_bytes().chunks_exact(2) {
                    assert!((b'0'..=b'4').contains(&pair[0]), "{letter}");
                    assert!((b'0'..=b'8').contains(&pair[1]), "{letter}");
                }
            }
        }
    }

    #[test]
    fn letters_differ() {
        let all = "0123456789abcdefghijklmnopqrstuvwxyz-+.,:=_/()";
        let mut seen: Vec<&str> = all.chars().map(strokes).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), all.len());
    }

    #[test]
    fn text_stays_within_its_width_and_height() {
        let blank = [255; 4];
        let mut image = Image {
            width: 120,
            height: 40,
            pixels: vec![blank; 120 * 40],
        };
        write(&mut image, "8.gh", (10.0, 30.0), 12.0, Color::ZERO);
        let end = 10.0 + width("8.gh", 12.0);
        let inked = (0..).zip(&image.pixels).filter(|(_, p)| **p != blank);
        let places: Vec<(f64, f64)> = inked
            .map(|(at, _)| (f64::from(at % 120), f64::from(at / 120)))
            .collect();
        assert!(places.len() > 60);
        for (x, y) in places {
            assert!(
                (8.0..end + 1.0).contains(&x) && (16.0..36.0).contains(&y),
                "{x} {y}"
            );
        }
    }

    #[test]
    fn transparent_paper_takes_ink() {
        let mut image = Image {
            width: 2,
            height: 1,
            pixels: vec![[0; 4]; 2],
        };
        fill(&mut image, [0.0, 1.5], [0.0, 1.0], linear([10, 200, 30]));
        assert_eq!(image.pixels, [[10, 200, 30, 255], [10, 200, 30, 128]]);
    }
}
