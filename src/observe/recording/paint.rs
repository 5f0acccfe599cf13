//! Colours of particles: a perceptually uniform map over a range that is fixed for the whole run.

use crate::engine::view::{BondState, RunInfo, Snapshot, WireInfo};
use crate::observe::colouring::{range, shown};
use crate::scene::spec::ColourBy;
use colorous::{CIVIDIS, Gradient, PLASMA, PURPLE_ORANGE, TABLEAU10, VIRIDIS};
use rerun::{Color, Points2D, Radius};
use std::collections::HashMap;

/// Particles at a broken bond (0xRRGGBBAA): none of the maps comes near this red.
pub(super) const BROKEN: u32 = 0xFF2A4DFF;
/// Marks of ruptures and their labels.
pub(super) const MARK: u32 = 0xFFFFFFFF;
/// The first break: apart from the maps, from red and from white.
pub(super) const FIRST: u32 = 0xFF9A1FFF;
/// Draw order of marks: over points, which the viewer draws at 30.
pub(super) const OVER: f32 = 40.0;
/// Grips and other things that carry no value.
pub(super) const NEUTRAL: u32 = 0x9AA3AEFF;

/// Where in its map a range starts (-). The darkest colours look black on a shaded wire.
const DARKEST: f64 = 0.2;
/// Share of the range up to which a place counts as unloaded, and is grey (-): what still trembles in a wire that broke.
const UNLOADED: f64 = 0.02;

/// Colours particles by one quantity.
pub(super) struct Palette {
    by: ColourBy,
    /// In SI; `None` where colours only tell things apart.
    range: Option<[f64; 2]>,
    table: Vec<u32>,
    /// The bond that broke first.
    first: Option<usize>,
    /// Mean stress of the snapshots to come, by step (Pa), where colours are told from it.
    means: HashMap<u64, f32>,
}

/// A colour bar: colours (0xRRGGBBAA) from low to high, and what stands at its ends.
pub(super) struct Scale {
    pub colours: Vec<u32>,
    pub ends: [String; 2],
}

impl Palette {
    /// The palette of a run.
    pub fn new(by: ColourBy, info: &RunInfo) -> Self {
        let gradient = match by {
            ColourBy::Deviation => {
                // From low to high as frames have it.
                let either_side =
                    (0..256).map(|i| rgba(PURPLE_ORANGE.eval_continuous(0.9 - 0.8 * f64::from(i) / 255.0)));
                let (table, means) = (either_side.collect(), HashMap::new());
                return Self { by, range: range(info, by), table, first: None, means };
            }
            ColourBy::PlasticStrain => PLASMA,
            ColourBy::ContactPressure | ColourBy::Velocity => CIVIDIS,
            _ => VIRIDIS,
        };
        Self { by, range: range(info, by), table: table(gradient), first: None, means: HashMap::new() }
    }

    /// Takes note of a snapshot that is to be coloured.
    pub fn expect(&mut self, snapshot: &Snapshot) {
        if self.by == ColourBy::Deviation {
            self.means.insert(snapshot.sample.step, snapshot.mean_stress());
        }
    }

    /// Gives the ends of the bond that broke first a colour of their own.
    pub fn set_first(&mut self, bond: usize) {
        self.first = Some(bond);
    }

    /// Quantity that colours.
    pub fn by(&self) -> ColourBy {
        self.by
    }

    /// Colour (0xRRGGBBAA) of a wire's particle `k`, counted along the wire.
    pub fn particle(&self, snapshot: &Snapshot, wire: &WireInfo, number: usize, k: usize) -> u32 {
        let slot = slot(wire, k);
        if at_broken_bond(snapshot, wire, k) {
            let i = wire.first + k;
            return if self.first.is_some_and(|first| first == i || first + 1 == i) { FIRST } else { BROKEN };
        }
        match self.by {
            ColourBy::Stress => self.value(snapshot.bond_stress[slot]),
            ColourBy::Deviation => {
                let mean = self.means.get(&snapshot.sample.step).copied().unwrap_or_default();
                self.value(snapshot.bond_stress[slot] - mean)
            }
            ColourBy::PlasticStrain => self.value(snapshot.plastic_strain[slot]),
            ColourBy::Utilisation => self.value(snapshot.utilisation[slot]),
            ColourBy::ContactPressure => self.value(snapshot.contact_pressure[wire.first + k]),
            ColourBy::Velocity => self.value(snapshot.speed[wire.first + k]),
            ColourBy::Layer => distinct(wire.layer),
            ColourBy::Wire => distinct(number),
            ColourBy::Material => distinct(wire.material),
        }
    }

    /// Colour (0xRRGGBBAA) of free sphere `i`: it has neither bonds nor a layer.
    pub fn sphere(&self, snapshot: &Snapshot, i: usize) -> u32 {
        match self.by {
            ColourBy::Velocity => self.value(snapshot.speed[i]),
            ColourBy::ContactPressure => self.value(snapshot.contact_pressure[i]),
            _ => NEUTRAL,
        }
    }

    /// What a colour bar shows; `None` where colours only tell things apart.
    pub fn scale(&self) -> Option<Scale> {
        let [low, high] = self.range?.map(|value| shown(self.by, value));
        let ends = match self.by {
            ColourBy::Stress => [format!("true axial stress: {low:.0} MPa"), format!("{high:.0} MPa")],
            ColourBy::Deviation => [format!("true axial stress less its mean: {low:.0} MPa"), format!("{high:.0} MPa")],
            ColourBy::PlasticStrain => [format!("plastic strain: {low:.0} %"), format!("{high:.0} %")],
            ColourBy::Utilisation => ["utilisation to rupture: 0 %".to_owned(), "100 %".to_owned()],
            ColourBy::ContactPressure => [format!("contact pressure: {low:.0} MPa"), format!("{high:.0} MPa")],
            ColourBy::Velocity => [format!("speed: {low:.1} m/s"), format!("{high:.1} m/s")],
            ColourBy::Layer | ColourBy::Wire | ColourBy::Material => return None,
        };
        Some(Scale { colours: self.table.iter().step_by(4).copied().collect(), ends })
    }

    fn value(&self, value: f32) -> u32 {
        let [low, high] = self.range.unwrap_or([0.0, 1.0]);
        let t = if high > low { (f64::from(value) - low) / (high - low) } else { 0.0 };
        self.table[(t.clamp(0.0, 1.0) * 255.0).round() as usize]
    }
}

/// The bond slot whose values a wire's particle `k` shows: the bond after it, and before it at the wire's end.
pub(super) fn slot(wire: &WireInfo, k: usize) -> usize {
    wire.first + k.min(wire.len.saturating_sub(2))
}

/// Whether a bond of a wire's particle `k` is broken.
pub(super) fn at_broken_bond(snapshot: &Snapshot, wire: &WireInfo, k: usize) -> bool {
    let broken = |slot: usize| snapshot.bond_state[slot] == BondState::Broken;
    let i = wire.first + k;
    (k > 0 && broken(i - 1)) || (k + 1 < wire.len && broken(i))
}

/// One of eight colours (0xRRGGBBAA) that are easily told apart, and from [`BROKEN`] and [`FIRST`].
pub(super) fn distinct(i: usize) -> u32 {
    /// Tableau's ten without orange and red.
    const APART: [usize; 8] = [0, 3, 6, 4, 5, 7, 8, 9];
    rgba(TABLEAU10[APART[i % APART.len()]])
}

/// Texts without visible points.
pub(super) fn labels(all: impl IntoIterator<Item = ([f32; 2], String)>, colour: u32) -> Points2D {
    let (places, words): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    Points2D::new(places)
        .with_labels(words)
        .with_show_labels(true)
        .with_colors([Color::from_u32(colour)])
        .with_radii([Radius::new_ui_points(0.1)])
}

/// Colours (0xRRGGBBAA) from the low to the high end of a range: grey, then the map.
fn table(gradient: Gradient) -> Vec<u32> {
    let colour = |t: f64| {
        if t <= UNLOADED { NEUTRAL } else { rgba(gradient.eval_continuous(DARKEST + (1.0 - DARKEST) * t)) }
    };
    (0..256).map(|i| colour(f64::from(i) / 255.0)).collect()
}

fn rgba(colour: colorous::Color) -> u32 {
    u32::from_be_bytes([colour.r, colour.g, colour.b, 0xFF])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of sRGB (IEC 61966-2-1).
    fn luminance(colour: u32) -> f64 {
        let linear = |byte: u8| {
            let v = f64::from(byte) / 255.0;
            if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        };
        let [r, g, b, _] = colour.to_be_bytes().map(linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn unloaded_is_grey_and_no_value_is_near_black() {
        for gradient in [VIRIDIS, PLASMA, CIVIDIS] {
            let table = table(gradient);
            assert_eq!(table[..6], [NEUTRAL; 6]);
            assert!(table[6..].iter().all(|c| *c != NEUTRAL && luminance(*c) > 0.04), "{table:08X?}");
        }
    }
}
