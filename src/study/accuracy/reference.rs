//! What runs are compared with: the closed form, or where the runs themselves go as they are refined.
//!
//! Refinement goes along one knob at a time from the scene as it stands. The limits add up: reference = base + Σ(limit
//! along a knob − base). That leaves out what two refinements do together, a product of two small corrections; the
//! uncertainty is the root of the sum of squares of those along each knob. Histories are extrapolated strain by strain
//! with the weights of strength. The order of breaks cannot be extrapolated; it is that of the finest run along the last
//! knob.

use super::errors::Truth;
use super::knobs::Role;
use super::richardson::{Limit, limit};
use crate::study::cases::measured::{Curve, Measured};
use serde::Serialize;

/// Runs along one knob, the scene as it stands among them.
pub struct Series<'a> {
    /// The knob.
    pub knob: &'static str,
    /// What its differences mean: only those that refine or have an exact value take part.
    pub role: Role,
    /// Value and run.
    pub levels: Vec<(f64, &'a Measured)>,
}

/// What refinement along one knob says about one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Along {
    /// The knob.
    pub knob: &'static str,
    /// Runs that were used.
    pub levels: usize,
    /// Observed order of convergence of strength and of elongation [-].
    pub order: [Option<f64>; 2],
    /// Limit less the scene as it stands, over the latter: of strength and of elongation [%].
    pub correction_percent: [f64; 2],
    /// How sure that is [%].
    pub uncertainty_percent: [f64; 2],
}

/// A reference made by refinement.
pub struct Refined {
    /// The reference.
    pub truth: Truth,
    /// Uncertainty of strength and elongation over the reference [%].
    pub uncertainty_percent: [f64; 2],
    /// What each knob adds.
    pub along: Vec<Along>,
}

/// One knob's limits and the runs that histories are extrapolated from.
struct Leg<'a> {
    along: Along,
    corrections: [f64; 2],
    uncertainties: [f64; 2],
    /// Limit of a history: fine + weight (fine − next).
    fine: &'a Measured,
    next: &'a Measured,
    weight: f64,
}

/// The reference that follows from `base` and its refinements.
pub fn refine(base: &Measured, series: &[Series]) -> Refined {
    let legs: Vec<Leg> = series.iter().filter_map(|series| leg(base, series)).collect();
    let sum = |k: usize| legs.iter().map(|leg| leg.corrections[k]).sum::<f64>();
    let spread = |k: usize| legs.iter().map(|leg| leg.uncertainties[k].powi(2)).sum::<f64>().sqrt();
    let value = [base.strength_mpa + sum(0), base.elongation_percent + sum(1)];
    let uncertainty_percent = [0, 1].map(|k| 100.0 * spread(k) / value[k]);
    let finest = legs.last().map_or(base, |leg| leg.fine);
    let truth = Truth {
        strength_mpa: value[0],
        elongation_percent: value[1],
        curve: curve(base, &legs),
        breaks: finest.breaks.clone(),
    };
    Refined { truth, uncertainty_percent, along: legs.into_iter().map(|leg| leg.along).collect() }
}

/// What one knob adds; `None` when it takes no part or has too few runs.
fn leg<'a>(base: &'a Measured, series: &Series<'a>) -> Option<Leg<'a>> {
    let (limits, fine, next) = match series.role {
        Role::Refines => {
            let mut levels = series.levels.clone();
            levels.sort_by(|a, b| a.0.total_cmp(&b.0));
            let along = |value: fn(&Measured) -> f64| {
                limit(&levels.iter().map(|(h, run)| [*h, value(run)]).collect::<Vec<_>>())
            };
            let limits = [along(|run| run.strength_mpa)?, along(|run| run.elongation_percent)?];
            (limits, levels[0].1, levels[1].1)
        }
        Role::Exact(exact) => {
            let (_, run) = series.levels.iter().find(|(value, _)| *value == exact)?;
            if std::ptr::eq(*run, base) {
                return None;
            }
            let known = |value: f64| Limit { value, uncertainty: 0.0, order: None, weight: 0.0 };
            ([known(run.strength_mpa), known(run.elongation_percent)], *run, *run)
        }
        Role::Neutral | Role::Model => return None,
    };
    let own = [base.strength_mpa, base.elongation_percent];
    let corrections = [0, 1].map(|k| limits[k].value - own[k]);
    let uncertainties = limits.map(|limit| limit.uncertainty);
    let along = Along {
        knob: series.knob,
        levels: series.levels.len(),
        order: limits.map(|limit| limit.order),
        correction_percent: [0, 1].map(|k| 100.0 * corrections[k] / own[k]),
        uncertainty_percent: [0, 1].map(|k| 100.0 * uncertainties[k] / own[k]),
    };
    Some(Leg { along, corrections, uncertainties, fine, next, weight: limits[0].weight })
}

/// The base's histories with the corrections of all legs, up to the least fracture strain among the runs.
fn curve(base: &Measured, legs: &[Leg]) -> Curve {
    let runs = legs.iter().flat_map(|leg| [leg.fine, leg.next]).chain([base]);
    let end = runs.map(|run| (0.01 * run.elongation_percent).min(run.curve.end())).fold(f64::INFINITY, f64::min);
    let strain: Vec<f64> = base.curve.strain.iter().copied().filter(|e| *e <= end).collect();
    let refined = |of: &dyn Fn(&Curve) -> Option<Vec<f64>>| -> Option<Vec<f64>> {
        let own = of(&base.curve)?;
        let histories: Vec<[Vec<f64>; 2]> =
            legs.iter().map(|leg| Some([of(&leg.fine.curve)?, of(&leg.next.curve)?])).collect::<Option<_>>()?;
        let at = |e: &f64| {
            let here = base.curve.at(&own, *e);
            let corrections = legs.iter().zip(&histories).map(|(leg, [fine, next])| {
                let (fine, next) = (leg.fine.curve.at(fine, *e), leg.next.curve.at(next, *e));
                fine - here + leg.weight * (fine - next)
            });
            here + corrections.sum::<f64>()
        };
        Some(strain.iter().map(at).collect())
    };
    let layer = |k: usize| refined(&|curve: &Curve| curve.layer_stress_mpa.get(k).cloned());
    Curve {
        stress_mpa: refined(&|curve| Some(curve.stress_mpa.clone())).unwrap_or_default(),
        plastic_work_j: refined(&|curve| Some(curve.plastic_work_j.clone())).unwrap_or_default(),
        layer_stress_mpa: (0..base.layers.len()).map_while(layer).collect(),
        strain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run whose every stress is `stress` times its strain.
    fn run(stress: f64) -> Measured {
        let strain: Vec<f64> = (0..=10).map(|i| 0.01 * f64::from(i)).collect();
        let history: Vec<f64> = strain.iter().map(|e| stress * e).collect();
        let curve = Curve {
            stress_mpa: history.clone(),
            plastic_work_j: history.clone(),
            layer_stress_mpa: vec![history],
            strain,
        };
        Measured {
            strength_mpa: 0.1 * stress,
            elongation_percent: 10.0,
            layers: vec!["one".into()],
            curve,
            ..Measured::default()
        }
    }

    /// Errors of order two in one knob and of order one in another: both are taken out, of every history too.
    #[test]
    fn corrections_of_two_knobs_add_up() {
        let at = |a: f64, b: f64| run(1000.0 + 80.0 * a * a + 50.0 * b);
        let base = at(1.0, 1.0);
        let [a2, a4, b2, b4] = [at(0.5, 1.0), at(0.25, 1.0), at(1.0, 0.5), at(1.0, 0.25)];
        let refines = |knob, levels| Series { knob, role: Role::Refines, levels };
        let series = [
            refines("a", vec![(1.0, &base), (0.5, &a2), (0.25, &a4)]),
            refines("b", vec![(0.25, &b4), (1.0, &base), (0.5, &b2)]),
        ];
        let refined = refine(&base, &series);
        assert!((refined.truth.strength_mpa - 100.0).abs() < 1e-9, "{}", refined.truth.strength_mpa);
        assert!(
            refined
                .truth
                .curve
                .stress_mpa
                .iter()
                .zip(&refined.truth.curve.strain)
                .all(|(s, e)| (s - 1000.0 * e).abs() < 1e-9)
        );
        assert!(refined.truth.curve.layer_stress_mpa[0].last().is_some_and(|s| (s - 100.0).abs() < 1e-9));
        let orders: Vec<f64> = refined.along.iter().map(|along| along.order[0].unwrap()).collect();
        assert!((orders[0] - 2.0).abs() < 1e-6 && (orders[1] - 1.0).abs() < 1e-6, "{orders:?}");
        assert!(refined.uncertainty_percent[0] > 0.0 && refined.uncertainty_percent[1] == 0.0);
    }

    #[test]
    fn an_exact_value_is_taken_as_it_is() {
        let (base, exact) = (run(1100.0), run(1000.0));
        let series = [Series { knob: "mass", role: Role::Exact(1.0), levels: vec![(4.0, &base), (1.0, &exact)] }];
        let refined = refine(&base, &series);
        assert_eq!(refined.truth.strength_mpa, exact.strength_mpa);
        let own = [Series { knob: "mass", role: Role::Exact(4.0), levels: vec![(4.0, &base), (1.0, &exact)] }];
        assert_eq!(refine(&base, &own).truth.strength_mpa, base.strength_mpa);
    }

    #[test]
    fn without_refinement_the_base_is_its_own_reference() {
        let base = run(1000.0);
        let refined = refine(&base, &[]);
        assert_eq!(refined.truth.curve, base.curve);
        assert_eq!(refined.uncertainty_percent, [0.0; 2]);
    }
}
