//! Places for labels that must not cover one another: as near as possible to what they name, in its order.

use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;

/// Size of the text about a break, and height of its ground, in units.
const TEXT: f32 = 10.5;
const HEIGHT: f32 = 15.0;

/// Places at least `pitch` apart within `[low, high]`, in the order of `wanted` (ascending), with the least sum of
/// squared shifts before the ends are taken into account: `x_i − i·pitch` must not fall, which is isotonic
/// regression, solved by pooling neighbours that violate it (Barlow et al. 1972). All lengths in (px).
pub fn spread(wanted: &[f32], pitch: f32, low: f32, high: f32) -> Vec<f32> {
    // Pools of neighbours: mean of what they want, and how many they are.
    let mut pools: Vec<(f32, usize)> = Vec::new();
    for (i, w) in wanted.iter().enumerate() {
        let mut pool = (w - i as f32 * pitch, 1);
        while let Some(&(mean, count)) = pools.last() {
            if mean <= pool.0 {
                break;
            }
            let all = count + pool.1;
            pool = ((mean * count as f32 + pool.0 * pool.1 as f32) / all as f32, all);
            pools.pop();
        }
        pools.push(pool);
    }
    let highest = (high - wanted.len().saturating_sub(1) as f32 * pitch).max(low);
    let starts = pools.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean.clamp(low, highest), count));
    starts.enumerate().map(|(i, start)| start + i as f32 * pitch).collect()
}

/// A break that is told of, and the place in the picture that it belongs to (px).
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its number in the order in which wires broke, from 1.
    pub number: usize,
    /// What is written, such as `2: wire 30 (outer)`; shorter where there is no room for that.
    pub words: [String; 2],
    /// The place.
    pub at: [f32; 2],
}

/// Words on grounds of their own inside `band`, each joined by a line to its place. Where the band is full they become
/// shorter, at last the number alone; numbers for which there is no room at all are left out, the last ones first.
pub fn breaks(canvas: &mut Canvas, band: Rect, data: &Data, marks: &[Mark]) {
    let u = canvas.unit;
    let pitch_down = HEIGHT * u + 2.0 * u;
    let possible = ((band.h / pitch_down).round() as usize).max(1);
    let choices = |m: &Mark| [m.words[0].clone(), m.words[1].clone(), m.number.to_string()];
    let widest = |canvas: &Canvas, k: usize| {
        let widths = marks.iter().map(|m| canvas.fonts.width(&choices(m)[k], TEXT * u, Weight::Bold));
        widths.fold(0.0, f32::max) + 10.0 * u
    };
    let per_row = |width: f32| ((band.w / (width + 2.0 * u)) as usize).max(1);
    let fits = |canvas: &Canvas, k: &usize| per_row(widest(canvas, *k)) * possible >= marks.len();
    let choice = (0..2).find(|k| fits(canvas, k)).unwrap_or(2);
    let width = widest(canvas, choice);
    let (pitch, per_row) = (width + 2.0 * u, per_row(width));
    let mut marks: Vec<&Mark> = marks.iter().take(per_row * possible).collect();
    marks.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
    let rows = marks.len().div_ceil(per_row).max(1);
    let mut placed: Vec<(&Mark, [f32; 2])> = Vec::new();
    for row in 0..rows {
        // Neighbours go to different rows, so that every row keeps to its places.
        let members: Vec<&Mark> = marks.iter().copied().skip(row).step_by(rows).collect();
        let wanted: Vec<f32> = members.iter().map(|m| m.at[0]).collect();
        let y = band.y + 0.5 * band.h + (row as f32 - 0.5 * (rows as f32 - 1.0)) * pitch_down;
        let places = spread(&wanted, pitch, band.x + 0.5 * width, band.right() - 0.5 * width);
        placed.extend(members.into_iter().zip(places.into_iter().map(|x| [x, y])));
    }
    for (mark, from) in &placed {
        canvas.line(*from, mark.at, 2.6 * u, data.style.page, 0.6);
        canvas.line(*from, mark.at, 1.2 * u, data.style.text, 0.9);
        canvas.disc(mark.at[0], mark.at[1], 2.2 * u, data.style.text, 1.0);
    }
    for (mark, at) in placed {
        pill(canvas, at, data, &choices(mark)[choice], mark.number == 1);
    }
}

/// Words about a break, centred at (x, y) (px): white on the signal colour for the `first`, which people look for.
pub fn pill(canvas: &mut Canvas, [x, y]: [f32; 2], data: &Data, text: &str, first: bool) {
    let u = canvas.unit;
    let width = canvas.fonts.width(text, TEXT * u, Weight::Bold) + 8.0 * u;
    let (ground, ink) = if first { (data.style.signal, [255; 3]) } else { (data.style.page, data.style.text) };
    let ground_at = Rect::new(x - 0.5 * width, y - 0.5 * HEIGHT * u, width, HEIGHT * u);
    let edge = if first { data.style.text } else { data.style.signal };
    canvas.fill_rounded(ground_at.inset(-u, -u, -u, -u), 4.0 * u, edge, 1.0);
    canvas.fill_rounded(ground_at, 3.5 * u, ground, 1.0);
    let kind = Type { size: TEXT * u, weight: Weight::Bold, colour: ink, align: Align::Centre };
    canvas.text(x, y + 0.36 * TEXT * u, kind, text);
}

/// A word on a ground of its own, centred at (x, y).
pub fn word(canvas: &mut Canvas, [x, y]: [f32; 2], data: &Data, text: &str) {
    let u = canvas.unit;
    let kind = Type { size: 11.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Centre };
    let w = canvas.fonts.width(text, kind.size, kind.weight);
    canvas.fill_rounded(word_ground([x, y], w, u), 4.0 * u, data.style.page, 0.8);
    canvas.text(x, y + 4.0 * u, kind, text);
}

fn word_ground([x, y]: [f32; 2], width: f32, u: f32) -> Rect {
    Rect::new(x - 0.5 * width - 5.0 * u, y - 9.0 * u, width + 10.0 * u, 18.0 * u)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_places_when_there_is_room() {
        assert_eq!(spread(&[10.0, 40.0, 90.0], 20.0, 0.0, 100.0), [10.0, 40.0, 90.0]);
        assert!(spread(&[], 20.0, 0.0, 100.0).is_empty());
    }

    #[test]
    fn crowded_labels_spread_evenly_about_their_middle() {
        assert_eq!(spread(&[50.0, 50.0, 50.0], 20.0, 0.0, 100.0), [30.0, 50.0, 70.0]);
        // Pushed inwards at the ends, still apart.
        assert_eq!(spread(&[2.0, 3.0, 95.0], 20.0, 10.0, 100.0), [10.0, 30.0, 95.0]);
        assert_eq!(spread(&[95.0, 98.0], 20.0, 0.0, 90.0), [70.0, 90.0]);
    }

    #[test]
    fn labels_never_come_nearer_than_the_pitch() {
        let wanted: Vec<f32> = (0..40).map(|k| 100.0 + 30.0 * (2.7 * k as f32).sin()).collect();
        let mut sorted = wanted.clone();
        sorted.sort_by(f32::total_cmp);
        let places = spread(&sorted, 7.0, 0.0, 400.0);
        assert!(places.windows(2).all(|p| p[1] - p[0] > 7.0 - 1e-3), "{places:?}");
        assert!(places[0] >= 0.0 && places[39] <= 400.0, "{places:?}");
    }
}
