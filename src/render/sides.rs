//! The sides from which close-ups are seen.

use super::canvas::Rect;
use super::close_up::Focus;
use super::panel::GAP;

/// Side of a close-up.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// Its name.
    pub name: &'static str,
    /// Turn about the strand's axis (rad).
    pub turn: f64,
}

/// The side of the eye.
const FRONT: Side = Side { name: "front", turn: 0.0 };
/// The other one.
const BACK: Side = Side { name: "back", turn: std::f64::consts::PI };

/// Front and back of a close-up where both have room, else the one that is looked at.
pub fn sides(panel: Rect, unit: f32, focus: &Focus) -> Vec<(Rect, Side)> {
    let gap = GAP * unit;
    if panel.h >= 420.0 * unit && panel.w < 2.2 * panel.h {
        let h = (0.5 * (panel.h - gap)).floor();
        let low = Rect { h, y: panel.bottom() - h, ..panel };
        vec![(Rect { h, ..panel }, FRONT), (low, BACK)]
    } else if panel.w >= 800.0 * unit {
        let w = (0.5 * (panel.w - gap)).floor();
        let right = Rect { w, x: panel.right() - w, ..panel };
        vec![(Rect { w, ..panel }, FRONT), (right, BACK)]
    } else {
        vec![(panel, Side { name: focus.side(), turn: focus.turn })]
    }
}
