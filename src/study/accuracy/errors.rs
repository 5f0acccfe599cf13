//! How far a run is from the reference.

use crate::observe::summary::Break;
use crate::study::tensile::{Curve, TensileResult};
use serde::Serialize;

/// What a run ought to have given.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Peak nominal stress (MPa).
    pub strength_mpa: f64,
    /// Strain at the peak (%).
    pub elongation_percent: f64,
    /// Histories up to the peak.
    pub curve: Curve,
    /// First rupture of each wire, in order; empty where it is not known.
    pub breaks: Vec<Break>,
}

/// What a run gave less what it ought to have given. Histories are compared up to the smaller of the two fracture
/// strains.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Errors {
    /// Of strength, signed, over the reference (%).
    pub strength_percent: f64,
    /// Of elongation, signed, over the reference (%).
    pub elongation_percent: f64,
    /// Of the curve: √(∫(σ − σ_ref)²dε / ∫σ_ref²dε) (%).
    pub curve_percent: Option<f64>,
    /// Of plastic work at the end of the comparison, signed, over the reference (%).
    pub plastic_work_percent: Option<f64>,
    /// Of the mean stress of each layer, as for the curve (%), inside out.
    pub layers_percent: Vec<Option<f64>>,
    /// Whether the same wire breaks first; `None` where nothing broke.
    pub same_first_wire: Option<bool>,
    /// How far from the reference's the first break lies along the strand before loading (mm).
    pub first_break_off_mm: Option<f64>,
    /// Kendall's τ_b between the orders of first breaks over all wires, those that stayed whole last: 1 the same, 0
    /// unrelated, −1 reversed (-). `None` where there is nothing to order.
    pub order_tau: Option<f64>,
}

impl Errors {
    /// Of `run` against `truth`.
    pub fn new(run: &TensileResult, truth: &Truth) -> Self {
        let (curve, right) = (&run.curve, &truth.curve);
        let end = (0.01 * run.elongation_percent.min(truth.elongation_percent)).min(curve.end()).min(right.end());
        let histories = |mine: &[f64], theirs: &[f64]| relative_l2([curve, right], [mine, theirs], end).map(percent);
        let work = [curve.at(&curve.plastic_work_j, end), right.at(&right.plastic_work_j, end)];
        let firsts = run.breaks.first().zip(truth.breaks.first());
        Self {
            strength_percent: percent(run.strength_mpa / truth.strength_mpa - 1.0),
            elongation_percent: percent(run.elongation_percent / truth.elongation_percent - 1.0),
            curve_percent: histories(&curve.stress_mpa, &right.stress_mpa),
            plastic_work_percent: (work[1] > 0.0).then(|| percent(work[0] / work[1] - 1.0)),
            layers_percent: curve
                .layer_stress_mpa
                .iter()
                .zip(&right.layer_stress_mpa)
                .map(|(mine, theirs)| histories(mine, theirs))
                .collect(),
            same_first_wire: firsts.map(|(mine, theirs)| mine.wire == theirs.wire),
            first_break_off_mm: firsts.map(|(mine, theirs)| mine.rest_z_mm - theirs.rest_z_mm),
            order_tau: kendall(&ranks(&run.breaks, run.wires), &ranks(&truth.breaks, run.wires)),
        }
    }

    /// The layer that is furthest off, and by how much (%).
    pub fn worst_layer(&self) -> Option<(usize, f64)> {
        let known = self.layers_percent.iter().enumerate().filter_map(|(layer, error)| Some((layer, (*error)?)));
        known.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn percent(share: f64) -> f64 {
    100.0 * share
}

/// Difference of two histories over the size of the second, both up to strain `end` (-); `None` where there is nothing
/// to compare.
fn relative_l2([mine, theirs]: [&Curve; 2], [my_history, their_history]: [&[f64]; 2], end: f64) -> Option<f64> {
    let mut strains: Vec<f64> = theirs.strain.iter().copied().filter(|e| *e < end).collect();
    strains.push(end);
    let squares = |e: f64| {
        let right = theirs.at(their_history, e);
        [(mine.at(my_history, e) - right).powi(2), right * right]
    };
    let mut sums = [0.0; 2];
    for pair in strains.windows(2) {
        let (a, b) = (squares(pair[0]), squares(pair[1]));
        for k in 0..2 {
            sums[k] += 0.5 * (a[k] + b[k]) * (pair[1] - pair[0]);
        }
    }
    (sums[1] > 0.0).then(|| (sums[0] / sums[1]).sqrt())
}

/// Place of each wire in the order of first breaks; wires that stayed whole share the last.
fn ranks(breaks: &[Break], wires: usize) -> Vec<usize> {
    let mut ranks = vec![usize::MAX; wires];
    for (place, broken) in breaks.iter().enumerate() {
        if let Some(rank) = ranks.get_mut(broken.wire.wrapping_sub(1)) {
            *rank = place;
        }
    }
    ranks
}

/// Kendall's τ_b, which takes ties into account (Kendall, Biometrika 33 (1945) 239).
fn kendall(a: &[usize], b: &[usize]) -> Option<f64> {
    let (mut score, mut untied) = (0.0, [0.0; 2]);
    for i in 0..a.len() {
        for j in 0..i {
            let [x, y] = [a[i].cmp(&a[j]) as i32, b[i].cmp(&b[j]) as i32].map(f64::from);
            score += x * y;
            untied = [untied[0] + x * x, untied[1] + y * y];
        }
    }
    let size = (untied[0] * untied[1]).sqrt();
    (size > 0.0).then(|| score / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(wire: usize) -> Break {
        Break {
            order: 1,
            wire,
            layer: "outer".into(),
            material: None,
            z_mm: 0.0,
            rest_z_mm: 10.0 * wire as f64,
            strain_percent: 0.0,
            stress_mpa: 0.0,
            cause: String::new(),
        }
    }

    /// A straight curve to 100 MPa at 10 %, and one whose every stress is `factor` times that.
    fn pair(factor: f64) -> (TensileResult, Truth) {
        let strain: Vec<f64> = (0..=100).map(|i| i as f64 * 1e-3).collect();
        let curve = |slope: f64| {
            let stress: Vec<f64> = strain.iter().map(|e| slope * e).collect();
            Curve {
                strain: strain.clone(),
                stress_mpa: stress.clone(),
                plastic_work_j: stress.clone(),
                layer_stress_mpa: vec![stress.clone(), stress],
            }
        };
        let run = TensileResult {
            strength_mpa: factor * 100.0,
            elongation_percent: 10.0,
            wires: 4,
            breaks: [2, 1, 3].map(broken).to_vec(),
            curve: curve(factor * 1000.0),
            ..TensileResult::default()
        };
        let truth = Truth {
            strength_mpa: 100.0,
            elongation_percent: 12.5,
            curve: curve(1000.0),
            breaks: [1, 2, 3].map(broken).to_vec(),
        };
        (run, truth)
    }

    #[test]
    fn errors_are_relative_to_the_reference() {
        let (run, truth) = pair(1.02);
        let errors = Errors::new(&run, &truth);
        for found in [
            errors.strength_percent,
            errors.curve_percent.unwrap(),
            errors.plastic_work_percent.unwrap(),
            errors.layers_percent[1].unwrap(),
            errors.worst_layer().unwrap().1,
        ] {
            assert!((found - 2.0).abs() < 1e-9, "{found}");
        }
        assert!((errors.elongation_percent + 20.0).abs() < 1e-9);
        assert_eq!((errors.same_first_wire, errors.first_break_off_mm), (Some(false), Some(10.0)));
        // Six pairs, of which one is the wrong way round.
        assert!((errors.order_tau.unwrap() - 4.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn what_happens_after_the_smaller_fracture_strain_does_not_count() {
        let (mut run, truth) = pair(1.0);
        run.elongation_percent = 5.0;
        for (strain, stress) in run.curve.strain.iter().zip(&mut run.curve.stress_mpa) {
            if *strain > 0.051 {
                *stress = 0.0;
            }
        }
        assert!(Errors::new(&run, &truth).curve_percent.unwrap() < 1e-9);
    }

    #[test]
    fn one_wire_has_no_order() {
        assert_eq!(kendall(&[0], &[0]), None);
        assert_eq!(kendall(&[0, 1, 2], &[2, 1, 0]), Some(-1.0));
        assert_eq!(kendall(&[7, 7], &[0, 1]), None);
    }
}
