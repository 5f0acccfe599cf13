//! Where the panels of a frame lie.

use super::canvas::Rect;
use super::panel::GAP;
use super::panels::PANELS;
use crate::scene::spec::View;

/// A frame divided into header and panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Pixels per layout unit: 1 at 1280 × 720.
    pub unit: f32,
    /// Caption and colour bar.
    pub header: Rect,
    /// Panels, on whole pixels.
    pub panels: Vec<(View, Rect)>,
}

/// Height of the header in units.
const HEADER: f32 = 62.0;
/// Rows of a frame, from top to bottom: share of the height (-).
pub const ROWS: [f32; 3] = [0.13, 0.46, 0.41];

/// Lays `views` out on a frame of `size` pixels: each view has its row, rows without a view vanish.
pub fn layout(size: [u32; 2], views: &[View]) -> Layout {
    let [w, h] = size.map(|s| s as f32);
    let unit = (w / 1280.0).min(h / 720.0).max(0.25);
    let gap = GAP * unit;
    let header = Rect::new(0.0, 0.0, w, HEADER * unit);
    let body = Rect::new(gap, header.h, w - 2.0 * gap, h - header.h - gap);
    let of_row = |k: usize| PANELS.iter().filter(|e| e.row == k && views.contains(&e.view)).collect::<Vec<_>>();
    let rows: Vec<_> = (0..ROWS.len()).map(|k| (of_row(k), ROWS[k])).filter(|(row, _)| !row.is_empty()).collect();
    let mut panels = Vec::new();
    let heights = shares(rows.iter().map(|r| r.1), body.h, gap);
    let mut y = body.y;
    for ((row, _), height) in rows.iter().zip(heights) {
        let mut x = body.x;
        for (entry, width) in row.iter().zip(shares(row.iter().map(|e| e.width), body.w, gap)) {
            panels.push((entry.view, Rect::new(x, y, width, height).snapped()));
            x += width + gap;
        }
        y += height + gap;
    }
    Layout { unit, header, panels }
}

/// Divides `length` with gaps between by weights.
fn shares(weights: impl Iterator<Item = f32> + Clone, length: f32, gap: f32) -> Vec<f32> {
    let count = weights.clone().count();
    let free = length - gap * count.saturating_sub(1) as f32;
    let sum: f32 = weights.clone().sum();
    weights.map(|w| free * w / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_stay_inside_the_frame_and_apart() {
        for size in [[1280, 720], [3840, 2160], [640, 480], [500, 900]] {
            let l = layout(size, &View::ALL);
            assert_eq!(l.panels.len(), View::ALL.len());
            for (k, (_, a)) in l.panels.iter().enumerate() {
                assert!(a.x >= 0.0 && a.y >= l.header.bottom() - 1.0, "{a:?}");
                assert!(a.right() <= size[0] as f32 && a.bottom() <= size[1] as f32, "{a:?} in {size:?}");
                let apart = |b: &Rect| a.right() <= b.x || b.right() <= a.x || a.bottom() <= b.y || b.bottom() <= a.y;
                assert!(l.panels[k + 1..].iter().all(|(_, b)| apart(b)));
            }
        }
    }

    #[test]
    fn a_single_view_gets_the_whole_body() {
        let l = layout([1280, 720], &[View::Curve]);
        assert_eq!(l.panels.len(), 1);
        assert!(l.panels[0].1.w > 1260.0 && l.panels[0].1.h > 640.0);
    }
}
