//! The table of views.

use super::cross_section::CrossSection;
use super::curve::Curve;
use super::cutaway::Cutaway;
use super::everything::Everything;
use super::exploded::Exploded;
use super::midsection::Midsection;
use super::overview::Overview;
use super::panel::Panel;
use super::unrolled::Unrolled;
use crate::engine::view::RunInfo;
use crate::scene::spec::View;

/// A view and its place in a frame.
pub struct Entry {
    /// The view.
    pub view: View,
    /// Which of [`super::layout::ROWS`] it lies in.
    pub row: usize,
    /// Whether the processor draws all of it.
    pub flat: bool,
    /// Its share of the row's width (-), beside those of the others there.
    pub width: f32,
    /// Whether a frame shows it when no views are chosen, of a body between grips.
    pub usual: Usual,
    /// What draws it.
    pub panel: &'static dyn Panel,
}

/// Whether the usual frame of a run has a view.
type Usual = fn(&RunInfo) -> bool;
const FLAT: bool = true;
const SOLID: bool = false;

const fn entry(view: View, row: usize, width: f32, flat: bool, usual: Usual, panel: &'static dyn Panel) -> Entry {
    Entry { view, row, flat, width, usual, panel }
}

/// Every view, from left to right in its row. Left out of the usual ones is what would show nothing: layers of which
/// there is one, the cut of a single wire, the map of one that is not pulled.
pub static PANELS: [Entry; View::ALL.len()] = [
    entry(View::Overview, 0, 1.0, SOLID, |_| true, &Overview),
    entry(View::Midsection, 1, 1.0, SOLID, |_| true, &Midsection),
    entry(View::Cutaway, 1, 0.8, SOLID, |_| false, &Cutaway),
    entry(View::Exploded, 1, 0.72, SOLID, |info| info.layers.len() > 1, &Exploded),
    entry(View::CrossSection, 1, 0.4, FLAT, |info| info.wires.len() > 1, &CrossSection),
    entry(View::Scene, 1, 1.0, SOLID, |_| false, &Everything),
    entry(View::Unrolled, 2, 0.6, FLAT, |info| info.is_pulled() || info.wires.len() > 1, &Unrolled),
    entry(View::Curve, 2, 0.4, FLAT, |_| true, &Curve),
];

/// The views of a frame for which none are chosen: of a body between grips, or of free bodies.
pub fn usual(info: &RunInfo) -> Vec<View> {
    match info.gauge {
        Some(_) => PANELS.iter().filter(|entry| (entry.usual)(info)).map(|entry| entry.view).collect(),
        None => vec![View::Scene, View::Curve],
    }
}
