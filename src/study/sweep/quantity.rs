//! What a study gathers of each run.

use crate::study::cases::measured::Measured;

/// Strain beyond the drop at which the residual stress is read, and half the window it is averaged over, because elastic
/// waves run then (-).
const AFTER_DROP: f64 = 0.01;
const HALF_WINDOW: f64 = 0.001;

/// Unit of what a run either is or is not.
const OF_RUNS: &str = "% of runs";

/// A number that every run has, or lacks for a reason.
#[derive(Debug)]
pub struct Quantity {
    /// Its name in a study file and in tables.
    pub name: &'static str,
    /// As people read it.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Decimals in tables.
    pub decimals: usize,
    /// Its value; `None` where the run has none, such as the place of a break when nothing broke.
    pub of: fn(&Measured) -> Option<f64>,
}

impl Quantity {
    /// Whether it is 100 or 0 for each run, so that its mean is how often something happens.
    pub fn is_frequency(&self) -> bool {
        self.unit == OF_RUNS
    }

    /// Label and unit, for the axis of a plot or the head of a column.
    pub fn label_and_unit(&self) -> String {
        format!("{} [{}]", self.label, self.unit)
    }
}

/// All quantities.
pub static ALL: [Quantity; 9] = [
    Quantity {
        name: "strength",
        label: "strength",
        unit: "MPa",
        decimals: 2,
        of: |measured| Some(measured.strength_mpa),
    },
    Quantity {
        name: "elongation",
        label: "elongation",
        unit: "%",
        decimals: 2,
        of: |measured| Some(measured.elongation_percent),
    },
    Quantity {
        name: "drop",
        label: "elongation at a 20 % drop",
        unit: "%",
        decimals: 2,
        of: |measured| measured.drop_percent,
    },
    Quantity {
        name: "first-outer",
        label: "first break in the outer layer",
        unit: OF_RUNS,
        decimals: 0,
        of: |measured| Some(share(first_layer(measured)? == measured.layers.len() - 1)),
    },
    Quantity { name: "outer-broken", label: "outer wires broken", unit: "%", decimals: 0, of: outer_broken },
    Quantity { name: "below-broken", label: "wires below them broken", unit: "%", decimals: 0, of: below_broken },
    Quantity {
        name: "outer-alone",
        label: "all outer wires broken, some below whole",
        unit: OF_RUNS,
        decimals: 0,
        of: |measured| Some(share(outer_broken(measured)? == 100.0 && below_broken(measured)? < 100.0)),
    },
    Quantity {
        name: "first-off-middle",
        label: "first break from mid-length",
        unit: "mm",
        decimals: 1,
        of: |measured| Some(off_middle(measured, measured.breaks.first()?.rest_z_mm)?.abs()),
    },
    Quantity {
        name: "residual",
        label: "stress left 1 % of strain beyond the drop",
        unit: "MPa",
        decimals: 1,
        of: residual_stress,
    },
];

/// The quantity of this name.
pub fn find(name: &str) -> Option<&'static Quantity> {
    ALL.iter().find(|quantity| quantity.name == name)
}

/// Of runs: all or none of one.
fn share(holds: bool) -> f64 {
    if holds { 100.0 } else { 0.0 }
}

/// Layer in which the first wire broke, from the inside, from 0.
pub fn first_layer(measured: &Measured) -> Option<usize> {
    let first = measured.breaks.first()?;
    measured.layers.iter().position(|layer| *layer == first.layer)
}

/// Distance of a place from mid-gauge, before loading (mm).
pub fn off_middle(measured: &Measured, rest_z_mm: f64) -> Option<f64> {
    let [lower, upper] = measured.gauge_mm?;
    Some(rest_z_mm - 0.5 * (lower + upper))
}

/// Wires of the layers in `range` that broke (%).
fn broken(measured: &Measured, range: std::ops::Range<usize>) -> Option<f64> {
    let wires: usize = measured.layer_wires.get(range.clone())?.iter().sum();
    let names = &measured.layers[range];
    let broken = measured.breaks.iter().filter(|one| names.contains(&one.layer)).count();
    (wires > 0).then(|| 100.0 * broken as f64 / wires as f64)
}

fn outer_broken(measured: &Measured) -> Option<f64> {
    let layers = measured.layers.len();
    broken(measured, layers.checked_sub(1)?..layers)
}

fn below_broken(measured: &Measured) -> Option<f64> {
    broken(measured, 0..measured.layers.len().checked_sub(1)?)
}

/// Mean nominal stress (MPa) around [`AFTER_DROP`] beyond the drop; `None` without a drop, or when the run ended before.
fn residual_stress(measured: &Measured) -> Option<f64> {
    let curve = &measured.curve;
    let middle = 0.01 * measured.drop_percent? + AFTER_DROP;
    if curve.end() < middle + HALF_WINDOW {
        return None;
    }
    const SAMPLES: usize = 21;
    let strain = |k: usize| middle + HALF_WINDOW * (2.0 * k as f64 / (SAMPLES - 1) as f64 - 1.0);
    let sum: f64 = (0..SAMPLES).map(|k| curve.at(&curve.stress_mpa, strain(k))).sum();
    Some(sum / SAMPLES as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::summary::Break;
    use crate::study::cases::measured::Curve;

    fn snapped(broken: &[(&str, f64)]) -> Measured {
        let one = |(k, (layer, rest_z_mm)): (usize, &(&str, f64))| Break {
            order: k + 1,
            wire: k + 1,
            layer: layer.to_string(),
            z_mm: *rest_z_mm,
            rest_z_mm: *rest_z_mm,
            strain_percent: 20.0,
            stress_mpa: 300.0,
            cause: "plastic strain".into(),
        };
        Measured {
            strength_mpa: 300.0,
            elongation_percent: 20.0,
            drop_percent: Some(20.005),
            layers: vec!["inner".into(), "outer".into()],
            layer_wires: vec![2, 4],
            gauge_mm: Some([10.0, 110.0]),
            breaks: broken.iter().enumerate().map(one).collect(),
            curve: Curve {
                strain: vec![0.0, 0.2, 0.2001, 0.22],
                stress_mpa: vec![0.0, 300.0, 100.0, 80.0],
                ..Curve::default()
            },
            ..Measured::default()
        }
    }

    fn of(name: &str, measured: &Measured) -> Option<f64> {
        (find(name).unwrap().of)(measured)
    }

    #[test]
    fn what_broke_is_told_by_layer() {
        let run = snapped(&[("outer", 50.0), ("outer", 60.0), ("inner", 61.0), ("outer", 62.0), ("outer", 62.0)]);
        assert_eq!(of("first-outer", &run), Some(100.0));
        assert_eq!(of("outer-broken", &run), Some(100.0));
        assert_eq!(of("below-broken", &run), Some(50.0));
        assert_eq!(of("outer-alone", &run), Some(100.0));
        assert_eq!(of("first-off-middle", &run), Some(10.0));
    }

    #[test]
    fn what_did_not_break_has_no_place() {
        let run = snapped(&[]);
        assert_eq!(of("first-outer", &run), None);
        assert_eq!(of("first-off-middle", &run), None);
        assert_eq!((of("outer-broken", &run), of("outer-alone", &run)), (Some(0.0), Some(0.0)));
    }

    #[test]
    fn stress_after_the_drop_is_read_where_the_curve_has_it() {
        let mut run = snapped(&[("outer", 50.0)]);
        let expected = 80.0 + 20.0 * 0.00995 / 0.0199;
        assert!((of("residual", &run).unwrap() - expected).abs() < 1e-9);
        run.drop_percent = Some(21.5);
        assert_eq!(of("residual", &run), None);
    }
}
