//! What runs are compared with: the closed form, or where the runs themselves go as they are refined.
//!
//! Refinement goes along one parameter at a time from the scene as it stands. The limits add up: reference = base + Σ(limit
//! along a parameter − base). That leaves out what two refinements do together, a product of two small corrections; the
//! uncertainty is the root of the sum of squares of those along each parameter. Where bonds scatter and there are several
//! seeds, it is the means over seeds that are refined. Histories are extrapolated strain by strain
//! with the weights of strength. The order of breaks cannot be extrapolated; it is that of the finest run along the last
//! parameter.

use super::errors::Truth;
use super::parameters::Role;
use super::richardson::{Limit, limit};
use crate::study::tensile::{Curve, TensileResult};
use serde::Serialize;
use std::collections::BTreeSet;

/// Runs along one parameter, the scene as it stands among them.
#[derive(Clone)]
pub struct Series<'a> {
    /// The parameter.
    pub parameter: &'static str,
    /// What its differences mean: only those that refine or have an exact value take part.
    pub role: Role,
    /// Value and run.
    pub levels: Vec<(f64, &'a TensileResult)>,
}

/// What refinement along one parameter says about one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Along {
    /// The parameter.
    pub parameter: &'static str,
    /// Runs that were used.
    pub levels: usize,
    /// Observed order of convergence of strength and of elongation (-).
    pub order: [Option<f64>; 2],
    /// Limit less the scene as it stands, over the latter: of strength and of elongation (%).
    pub correction_percent: [f64; 2],
    /// How sure that is (%).
    pub uncertainty_percent: [f64; 2],
}

/// A reference made by refinement.
pub struct Refined {
    /// The reference.
    pub truth: Truth,
    /// Uncertainty of strength and elongation over the reference (%).
    pub uncertainty_percent: [f64; 2],
    /// What each parameter adds.
    pub along: Vec<Along>,
}

/// One parameter's limits and the runs that histories are extrapolated from.
struct Leg<'a> {
    along: Along,
    corrections: [f64; 2],
    uncertainties: [f64; 2],
    /// Limit of a history: fine + weight (fine − next).
    fine: &'a TensileResult,
    next: &'a TensileResult,
    weight: f64,
}

/// How the means over seeds converge along one parameter. Where bonds scatter, a finer run of one seed may break another bond
/// first, and the three levels of that seed alone show any order or none; their means over seeds do not.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    parameter: &'static str,
    /// Limits of the means of strength (MPa) and elongation (%).
    limits: [Limit; 2],
    /// The two finest values.
    values: [f64; 2],
    /// Mean of each less the mean of the scene as it stands: strength (MPa), elongation (%).
    corrections: [f64; 2],
    levels: usize,
}

/// Runs of one seed: the scene as it stands, and along every parameter.
pub type OfSeed<'a> = (&'a TensileResult, Vec<Series<'a>>);

/// How the means over `seeds` converge along every parameter that refines. A level counts by how far its runs are from those of
/// the same seeds at the scene as it stands, so that seeds it lacks do not shift it.
pub fn laws(seeds: &[OfSeed]) -> Vec<Law> {
    let Some((_, parameters)) = seeds.first() else { return Vec::new() };
    let mean_base = [0, 1].map(|k| seeds.iter().map(|(base, _)| numbers(base)[k]).sum::<f64>() / seeds.len() as f64);
    let law = |k: usize| {
        let Series { parameter, role: Role::Refines, .. } = &parameters[k] else { return None };
        let mut values: Vec<f64> = seeds.iter().flat_map(|(_, s)| s[k].levels.iter().map(|(h, _)| *h)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let at = |h: f64, quantity: usize| {
            let differences = seeds.iter().filter_map(|(base, series)| {
                let (_, run) = series[k].levels.iter().find(|(value, _)| *value == h)?;
                Some(numbers(run)[quantity] - numbers(base)[quantity])
            });
            let differences: Vec<f64> = differences.collect();
            mean_base[quantity] + differences.iter().sum::<f64>() / differences.len() as f64
        };
        let along = |quantity: usize| limit(&values.iter().map(|h| [*h, at(*h, quantity)]).collect::<Vec<_>>());
        let limits = [along(0)?, along(1)?];
        let corrections = [0, 1].map(|k| limits[k].value - mean_base[k]);
        Some(Law { parameter, limits, values: [values[0], values[1]], corrections, levels: values.len() })
    };
    (0..parameters.len()).filter_map(law).collect()
}

fn numbers(run: &TensileResult) -> [f64; 2] {
    [run.strength_mpa, run.elongation_percent]
}

/// The reference that follows from `base` and its refinements alone.
pub fn refine(base: &TensileResult, series: &[Series]) -> Refined {
    put_together(base, series.iter().filter_map(|series| leg(base, series)).collect())
}

/// The reference of one seed where bonds scatter: its own runs, extrapolated as the means over seeds are. Its mean over
/// seeds is then the limit of the means, and how it differs from seed to seed tells how sure that is.
pub fn refine_as(laws: &[Law], base: &TensileResult, series: &[Series]) -> Refined {
    let legs = series.iter().filter_map(|series| match series.role {
        Role::Refines => laws.iter().find(|law| law.parameter == series.parameter).map(|law| leg_as(law, base, series)),
        _ => leg(base, series),
    });
    put_together(base, legs.collect())
}

fn put_together(base: &TensileResult, legs: Vec<Leg>) -> Refined {
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

/// What a parameter adds to one seed, by how the means over seeds converge; that of the means where the seed lacks one of the
/// two finest runs.
fn leg_as<'a>(law: &Law, base: &'a TensileResult, series: &Series<'a>) -> Leg<'a> {
    let run = |value: f64| series.levels.iter().find(|(h, _)| *h == value).map(|(_, run)| *run);
    let own = numbers(base);
    let (fine, next, corrections) = match law.values.map(run) {
        [Some(fine), Some(next)] => {
            let [a, b] = [numbers(fine), numbers(next)];
            (fine, next, [0, 1].map(|k| a[k] + law.limits[k].weight * (a[k] - b[k]) - own[k]))
        }
        _ => (base, base, law.corrections),
    };
    let uncertainties = law.limits.map(|limit| limit.uncertainty);
    let along = Along {
        parameter: law.parameter,
        levels: law.levels,
        order: law.limits.map(|limit| limit.order),
        correction_percent: [0, 1].map(|k| 100.0 * corrections[k] / own[k]),
        uncertainty_percent: [0, 1].map(|k| 100.0 * uncertainties[k] / own[k]),
    };
    Leg { along, corrections, uncertainties, fine, next, weight: law.limits[0].weight }
}

/// Names of the parameters that were refined along, each once.
pub fn refined_parameters(along: &[(u64, Along)]) -> Vec<&'static str> {
    let mut seen = BTreeSet::new();
    along.iter().map(|(_, along)| along.parameter).filter(|name| seen.insert(*name)).collect()
}

/// What one parameter adds; `None` when it takes no part or has too few runs.
fn leg<'a>(base: &'a TensileResult, series: &Series<'a>) -> Option<Leg<'a>> {
    let (limits, fine, next) = match series.role {
        Role::Refines => {
            let mut levels = series.levels.clone();
            levels.sort_by(|a, b| a.0.total_cmp(&b.0));
            let along = |value: fn(&TensileResult) -> f64| {
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
    let own = numbers(base);
    let corrections = [0, 1].map(|k| limits[k].value - own[k]);
    let uncertainties = limits.map(|limit| limit.uncertainty);
    let along = Along {
        parameter: series.parameter,
        levels: series.levels.len(),
        order: limits.map(|limit| limit.order),
        correction_percent: [0, 1].map(|k| 100.0 * corrections[k] / own[k]),
        uncertainty_percent: [0, 1].map(|k| 100.0 * uncertainties[k] / own[k]),
    };
    Some(Leg { along, corrections, uncertainties, fine, next, weight: limits[0].weight })
}

/// The base's histories with the corrections of all legs, up to the least fracture strain among the runs.
fn curve(base: &TensileResult, legs: &[Leg]) -> Curve {
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
    fn run(stress: f64) -> TensileResult {
        let strain: Vec<f64> = (0..=10).map(|i| 0.01 * f64::from(i)).collect();
        let history: Vec<f64> = strain.iter().map(|e| stress * e).collect();
        let curve = Curve {
            stress_mpa: history.clone(),
            plastic_work_j: history.clone(),
            layer_stress_mpa: vec![history],
            strain,
        };
        TensileResult {
            strength_mpa: 0.1 * stress,
            elongation_percent: 10.0,
            layers: vec!["one".into()],
            curve,
            ..TensileResult::default()
        }
    }

    /// Errors of order two in one parameter and of order one in another: both are taken out, of every history too.
    #[test]
    fn corrections_of_two_parameters_add_up() {
        let at = |a: f64, b: f64| run(1000.0 + 80.0 * a * a + 50.0 * b);
        let base = at(1.0, 1.0);
        let [a2, a4, b2, b4] = [at(0.5, 1.0), at(0.25, 1.0), at(1.0, 0.5), at(1.0, 0.25)];
        let refines = |parameter, levels| Series { parameter, role: Role::Refines, levels };
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
        let series = [Series { parameter: "mass", role: Role::Exact(1.0), levels: vec![(4.0, &base), (1.0, &exact)] }];
        let refined = refine(&base, &series);
        assert_eq!(refined.truth.strength_mpa, exact.strength_mpa);
        let own = [Series { parameter: "mass", role: Role::Exact(4.0), levels: vec![(4.0, &base), (1.0, &exact)] }];
        assert_eq!(refine(&base, &own).truth.strength_mpa, base.strength_mpa);
    }

    /// Two seeds whose own levels show no order: their means do, and the mean of what each is extrapolated to is the
    /// limit of the means.
    #[test]
    fn means_over_seeds_converge_where_single_draws_do_not() {
        let at = |h: f64, draw: f64| run(1000.0 + 40.0 * h + draw);
        let one = [at(1.0, 30.0), at(0.5, -10.0), at(0.25, 20.0)];
        let two = [at(1.0, -30.0), at(0.5, 10.0), at(0.25, -20.0)];
        let of = |runs: &'static [TensileResult; 3]| -> OfSeed<'static> {
            let levels = [1.0, 0.5, 0.25].into_iter().zip(runs).collect();
            (&runs[0], vec![Series { parameter: "speed", role: Role::Refines, levels }])
        };
        let seeds = [of(Box::leak(Box::new(one))), of(Box::leak(Box::new(two)))];
        let alone = refine(seeds[0].0, &seeds[0].1);
        assert_eq!(alone.along[0].order[0], None);
        let laws = laws(&seeds);
        assert!(
            (laws[0].limits[0].order.unwrap() - 1.0).abs() < 1e-6 && (laws[0].limits[0].value - 100.0).abs() < 1e-9
        );
        let truths: Vec<f64> =
            seeds.iter().map(|(base, series)| refine_as(&laws, base, series).truth.strength_mpa).collect();
        assert!((0.5 * (truths[0] + truths[1]) - 100.0).abs() < 1e-9, "{truths:?}");
        assert!((truths[0] - truths[1]).abs() > 1.0, "what one draw says is not hidden");
        // The finest run of the second seed is missing: the means then go by the first seed's step from its own base.
        let mut fewer = seeds[1].1.clone();
        fewer[0].levels.truncate(2);
        let short = refine_as(&laws, seeds[1].0, &fewer);
        let expected = seeds[1].0.strength_mpa + laws[0].corrections[0];
        assert!((short.truth.strength_mpa - expected).abs() < 1e-9);
    }

    #[test]
    fn without_refinement_the_base_is_its_own_reference() {
        let base = run(1000.0);
        let refined = refine(&base, &[]);
        assert_eq!(refined.truth.curve, base.curve);
        assert_eq!(refined.uncertainty_percent, [0.0; 2]);
    }
}
