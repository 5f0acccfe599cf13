//! What a study gathers of each run.

use crate::study::column::Column;
use crate::study::tensile::TensileResult;
use std::sync::LazyLock;

/// Strain beyond the drop at which the residual stress is read, and half the window it is averaged over, because elastic
/// waves run then (-).
const AFTER_DROP: f64 = 0.01;
const HALF_WINDOW: f64 = 0.001;

/// Unit of what a run either is or is not.
const OF_RUNS: &str = "% of runs";

/// A number that every run has, or lacks for a reason, such as the place of a break when nothing broke.
pub type Quantity = Column<'static, TensileResult>;

/// Whether a quantity is 100 or 0 for each run, so that its mean is how often something happens.
pub fn is_frequency(quantity: &Quantity) -> bool {
    quantity.unit == OF_RUNS
}

/// What a quantity cannot leave, whatever an interval of its mean says: shares of wires are from 0 to 100 %.
pub fn limits(quantity: &Quantity) -> Option<[f64; 2]> {
    ["outer-broken", "below-broken"].contains(&&*quantity.name).then_some([0.0, 100.0])
}

/// All quantities.
pub static ALL: LazyLock<[Quantity; 9]> = LazyLock::new(|| {
    let alone = |run: &TensileResult| Some(share(outer_broken(run)? == 100.0 && below_broken(run)? < 100.0));
    let first_outer = |run: &TensileResult| Some(share(first_layer(run)? == run.layers.len() - 1));
    let off = |run: &TensileResult| Some(off_middle(run, run.breaks.first()?.rest_z_mm)?.abs());
    [
        Column::new("strength", "strength", "MPa", 2, |run: &TensileResult| run.strength_mpa),
        Column::new("elongation", "elongation", "%", 2, |run: &TensileResult| run.elongation_percent),
        Column::new("drop", "elongation at a 20 % drop", "%", 2, |run: &TensileResult| run.drop_percent),
        Column::new("first-outer", "first break in the outer layer", OF_RUNS, 0, first_outer),
        Column::new("outer-broken", "outer wires broken", "%", 0, outer_broken),
        Column::new("below-broken", "wires below them broken", "%", 0, below_broken),
        Column::new("outer-alone", "all outer wires broken, some below whole", OF_RUNS, 0, alone),
        Column::new("first-off-middle", "first break from mid-length", "mm", 1, off),
        Column::new("residual", "stress left 1 % of strain beyond the drop", "MPa", 1, residual_stress),
    ]
});

/// The quantity of this name.
pub fn find(name: &str) -> Option<&'static Quantity> {
    ALL.iter().find(|quantity| quantity.name == name)
}

/// Of runs: all or none of one.
fn share(holds: bool) -> f64 {
    if holds { 100.0 } else { 0.0 }
}

/// Layer in which the first wire broke, from the inside, from 0.
pub fn first_layer(run: &TensileResult) -> Option<usize> {
    let first = run.breaks.first()?;
    run.layers.iter().position(|layer| *layer == first.layer)
}

/// Distance of a place from mid-gauge, before loading (mm).
pub fn off_middle(run: &TensileResult, rest_z_mm: f64) -> Option<f64> {
    let [lower, upper] = run.gauge_mm?;
    Some(rest_z_mm - 0.5 * (lower + upper))
}

/// Wires of the layers in `range` that broke (%).
fn broken(run: &TensileResult, range: std::ops::Range<usize>) -> Option<f64> {
    let wires: usize = run.layer_wires.get(range.clone())?.iter().sum();
    let names = &run.layers[range];
    let broken = run.breaks.iter().filter(|one| names.contains(&one.layer)).count();
    (wires > 0).then(|| 100.0 * broken as f64 / wires as f64)
}

/// Wires of the outermost layer that broke (%).
pub fn outer_broken(run: &TensileResult) -> Option<f64> {
    let layers = run.layers.len();
    broken(run, layers.checked_sub(1)?..layers)
}

/// Wires of all layers below the outermost that broke (%).
pub fn below_broken(run: &TensileResult) -> Option<f64> {
    broken(run, 0..run.layers.len().checked_sub(1)?)
}

/// Mean nominal stress (MPa) around [`AFTER_DROP`] beyond the drop; `None` without a drop, or when the run ended before.
fn residual_stress(run: &TensileResult) -> Option<f64> {
    let curve = &run.curve;
    let middle = 0.01 * run.drop_percent? + AFTER_DROP;
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
    use crate::study::tensile::Curve;

    fn snapped(broken: &[(&str, f64)]) -> TensileResult {
        let one = |(k, (layer, rest_z_mm)): (usize, &(&str, f64))| Break {
            order: k + 1,
            wire: k + 1,
            layer: layer.to_string(),
            material: None,
            z_mm: *rest_z_mm,
            rest_z_mm: *rest_z_mm,
            strain_percent: 20.0,
            stress_mpa: 300.0,
            cause: "plastic strain".into(),
        };
        TensileResult {
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
            ..TensileResult::default()
        }
    }

    fn of(name: &str, run: &TensileResult) -> Option<f64> {
        find(name).unwrap().number(run)
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
