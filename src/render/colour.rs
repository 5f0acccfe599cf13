//! From quantities to colours: perceptually uniform maps for numbers, a categorical palette for layers and wires.

use super::style::{Rgb, SIGNAL};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::colouring::{range, shown};
use crate::scene::spec::ColourBy;
use std::sync::LazyLock;

/// Categorical palette: Okabe & Ito (2008) without vermilion, which is too near the colour of ruptures, and with
/// three more hues that stay apart for readers with colour-vision deficiency.
const PALETTE: [Rgb; 9] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [190, 150, 220],
    [170, 200, 90],
    [140, 140, 150],
    [120, 90, 180],
];

/// Where in its map a range starts (-). The very darkest colours would vanish before a dark ground.
pub const DARKEST: f64 = 0.1;

/// Colours of a map: so many that the next one differs by a step of the 8 bits at most.
const STEPS: usize = 1024;
type Table = [Rgb; STEPS];
static VIRIDIS: LazyLock<Table> = LazyLock::new(|| table(colorous::VIRIDIS));
static CIVIDIS: LazyLock<Table> = LazyLock::new(|| table(colorous::CIVIDIS));

fn table(map: colorous::Gradient) -> Table {
    std::array::from_fn(|k| {
        let c = map.eval_continuous(DARKEST + (1.0 - DARKEST) * k as f64 / (STEPS - 1) as f64);
        [c.r, c.g, c.b]
    })
}

/// For what lies on either side of a mean: both ends are dark enough to be seen on white, and none is near the colour of ruptures.
static DIVERGING: LazyLock<Table> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let c = colorous::PURPLE_ORANGE.eval_continuous(0.9 - 0.8 * k as f64 / (STEPS - 1) as f64);
        [c.r, c.g, c.b]
    })
});

/// Linear light of every sRGB byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let v = byte as f32 / 255.0;
        if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
});

/// A quantity, its fixed range and its colours.
pub struct ColourScale {
    by: ColourBy,
    /// In SI.
    range: [f64; 2],
    map: Option<&'static Table>,
}

impl ColourScale {
    /// The scale of `by` over the range that [`RunInfo`] fixes for the whole sequence.
    pub fn new(info: &RunInfo, by: ColourBy) -> Self {
        let map = match by {
            ColourBy::Stress | ColourBy::Utilisation => &*VIRIDIS,
            ColourBy::Deviation => &*DIVERGING,
            _ => &*CIVIDIS,
        };
        let range = range(info, by);
        Self { by, range: range.unwrap_or([0.0, 1.0]), map: range.map(|_| map) }
    }

    /// The same over a range of one's own, in the unit of the title; categories have none.
    pub fn with_shown_range(self, range: [f64; 2]) -> Self {
        Self { range: range.map(|value| value / shown(self.by, 1.0)), ..self }
    }

    /// What the scale shows.
    pub fn by(&self) -> ColourBy {
        self.by
    }

    /// Title with unit, for the colour bar.
    pub fn title(&self) -> &'static str {
        match self.by {
            ColourBy::Stress => "true axial stress (MPa)",
            ColourBy::Deviation => "true axial stress less its mean (MPa)",
            ColourBy::PlasticStrain => "equivalent plastic strain (%)",
            ColourBy::Utilisation => "utilisation to rupture (%)",
            ColourBy::ContactPressure => "contact pressure (MPa)",
            ColourBy::Velocity => "speed (m/s)",
            ColourBy::Layer => "layer",
            ColourBy::Wire => "wire",
            ColourBy::Material => "material",
        }
    }

    /// Ends of the range, in the unit of the title; `None` for categories.
    pub fn shown_range(&self) -> Option<[f64; 2]> {
        self.map.map(|_| self.range.map(|value| shown(self.by, value)))
    }

    /// Whether values below and above the range occur, drawn in the colours of its ends: wires that spring back are
    /// pressed, single contacts exceed what a smooth wire would feel, and snapped ends whip faster than any grip.
    pub fn open_ends(&self) -> [bool; 2] {
        match self.by {
            ColourBy::Stress => [self.range[0] >= 0.0, false],
            ColourBy::ContactPressure | ColourBy::Velocity => [false, true],
            ColourBy::Deviation => [true, true],
            ColourBy::PlasticStrain | ColourBy::Utilisation => [false, false],
            ColourBy::Layer | ColourBy::Wire | ColourBy::Material => [false, false],
        }
    }

    /// Colour at `fraction` of the range (-), clamped to 0–1; grey for categories.
    pub fn at(&self, fraction: f64) -> Rgb {
        let Some(map) = self.map else {
            return [128; 3];
        };
        map[(fraction.clamp(0.0, 1.0) * (STEPS - 1) as f64).round() as usize]
    }

    fn of_value(&self, value: f32) -> Rgb {
        let [low, high] = self.range;
        self.at((f64::from(value) - low) / (high - low).max(f64::MIN_POSITIVE))
    }

    /// Colour of layer or wire number `index`.
    pub fn category(index: usize) -> Rgb {
        PALETTE[index % PALETTE.len()]
    }

    /// One colour per particle.
    pub fn particles(&self, info: &RunInfo, snapshot: &Snapshot) -> Vec<Rgb> {
        let mut colours = vec![[150, 156, 166]; snapshot.position.len()];
        let mean = if self.by == ColourBy::Deviation { snapshot.mean_stress() } else { 0.0 };
        for (number, wire) in info.wires.iter().enumerate() {
            for (k, colour) in colours[wire.particles()].iter_mut().enumerate() {
                let i = wire.first + k;
                *colour = match self.by {
                    ColourBy::Stress => self.of_value(beside(snapshot, &snapshot.bond_stress, wire.first, i)),
                    ColourBy::Deviation => match held(snapshot, wire.first, i) {
                        true => self.of_value(beside(snapshot, &snapshot.bond_stress, wire.first, i) - mean),
                        false => *colour,
                    },
                    ColourBy::PlasticStrain => self.of_value(beside(snapshot, &snapshot.plastic_strain, wire.first, i)),
                    ColourBy::Utilisation => self.of_value(beside(snapshot, &snapshot.utilisation, wire.first, i)),
                    ColourBy::ContactPressure => self.of_value(snapshot.contact_pressure[i]),
                    ColourBy::Velocity => self.of_value(snapshot.speed[i]),
                    ColourBy::Layer => Self::category(wire.layer),
                    ColourBy::Wire => Self::category(number),
                    ColourBy::Material => Self::category(wire.material),
                };
            }
        }
        for (k, colour) in colours.iter_mut().skip(info.wire_particles).enumerate() {
            let i = info.wire_particles + k;
            match self.by {
                ColourBy::Velocity => *colour = self.of_value(snapshot.speed[i]),
                ColourBy::ContactPressure => *colour = self.of_value(snapshot.contact_pressure[i]),
                ColourBy::Material => *colour = Self::category(info.sphere_material[k]),
                ColourBy::Wire | ColourBy::Layer => *colour = Self::category(info.wires.len() + k),
                // Spheres carry no axial stress: told apart when there is nothing else, grey beside wires.
                ColourBy::Stress | ColourBy::Deviation | ColourBy::PlasticStrain | ColourBy::Utilisation => {
                    if info.wires.is_empty() {
                        *colour = Self::category(k);
                    }
                }
            }
        }
        colours
    }
}

/// Whether a bond holds particle `i` of a wire starting at `first`.
fn held(snapshot: &Snapshot, first: usize, i: usize) -> bool {
    snapshot.bond_state[i].holds() || (i > first && snapshot.bond_state[i - 1].holds())
}

/// Mean over the bonds that hold particle `i` of a wire starting at `first`; 0 when none does.
fn beside(snapshot: &Snapshot, values: &[f32], first: usize, i: usize) -> f32 {
    let holds = |b: usize| snapshot.bond_state[b].holds();
    let before = (i > first && holds(i - 1)).then(|| values[i - 1]);
    let after = holds(i).then(|| values[i]);
    match (before, after) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(v), None) | (None, Some(v)) => v,
        (None, None) => 0.0,
    }
}

/// Part of a wire held in a grip: most of the colour taken out.
pub fn desaturated(colour: Rgb) -> Rgb {
    let [r, g, b] = colour.map(f32::from);
    let grey = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    // Compressed towards mid-grey, so that the held part reads as metal at any stress.
    let metal = 70.0 + 0.35 * grey;
    [r, g, b].map(|v| (metal + 0.12 * (v - grey)).round().clamp(0.0, 255.0) as u8)
}

/// sRGB byte to linear light (IEC 61966-2-1) (-).
pub fn linear(byte: u8) -> f32 {
    LINEAR[usize::from(byte)]
}

/// Linear light to sRGB, neither rounded (-): the inverse of [`linear`].
pub fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// Linear RGB of a colour, with alpha 1.
pub fn linear4(colour: Rgb) -> [f32; 4] {
    [linear(colour[0]), linear(colour[1]), linear(colour[2]), 1.0]
}

/// Linear RGB of the rupture colour.
pub fn signal4() -> [f32; 4] {
    linear4(SIGNAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: Rgb, b: Rgb) -> f64 {
        (0..3).map(|k| (f64::from(a[k]) - f64::from(b[k])).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn no_map_comes_near_the_rupture_colour() {
        for map in [colorous::VIRIDIS, colorous::CIVIDIS] {
            for k in 0..=100 {
                let c = map.eval_continuous(f64::from(k) / 100.0);
                assert!(distance([c.r, c.g, c.b], SIGNAL) > 120.0, "{k}");
            }
        }
        for c in PALETTE {
            assert!(distance(c, SIGNAL) > 100.0, "{c:?}");
        }
    }

    #[test]
    fn neighbours_in_a_table_differ_by_a_step_at_most() {
        for table in [&*VIRIDIS, &*CIVIDIS] {
            for pair in table.windows(2) {
                assert!((0..3).all(|k| pair[0][k].abs_diff(pair[1][k]) <= 1), "{pair:?}");
            }
        }
    }

    #[test]
    fn linear_light_has_the_standard_mid_grey() {
        assert_eq!(linear(0), 0.0);
        assert!((linear(255) - 1.0).abs() < 1e-6);
        assert!((linear(188) - 0.5029).abs() < 1e-3, "{}", linear(188));
        for byte in 0..=255 {
            assert!((255.0 * encoded(linear(byte)) - f32::from(byte)).abs() < 1e-2, "{byte}");
        }
    }
}
