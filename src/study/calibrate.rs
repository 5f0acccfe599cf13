//! Calibration of a pulled scene on one tensile test: strength and elongation.
//!
//! Two numbers are fitted to two: a factor on the hardening part of the Voce law (Q and H together; σ₀ stays what
//! annealed copper has) and the plastic strain at rupture p_f. Everything else stays as the scene has it. The search is
//! Broyden's (1965), started from what a uniformly pulled wire says: the elongation is e^(p_f) − 1, and the nominal
//! strength σ_y(p_f)e^(−p_f).

use crate::base::error::{Error, Result};
use crate::run::{RunSummary, summarise};
use crate::scene::spec::{BondLawSpec, HardeningSpec, RuptureCriterion};
use crate::scene::{self, Scene};
use glam::{DMat2, DVec2};
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs that a calibration may take before it gives up.
const MOST_RUNS: usize = 10;

/// What the test found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Tensile strength [MPa].
    pub strength: f64,
    /// Fracture elongation [%].
    pub elongation: f64,
    /// Allowed relative error of either [-].
    pub tolerance: f64,
}

/// The two numbers that are fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Q of the Voce law [MPa].
    pub saturation: f64,
    /// H of the Voce law [MPa].
    pub linear: f64,
    /// Plastic strain at rupture p_f [%].
    pub rupture_strain: f64,
}

impl Setting {
    /// The `--set` options that give a scene this setting.
    pub fn overrides(&self) -> Vec<String> {
        vec![
            format!("bond.hardening.saturation={} MPa", self.saturation),
            format!("bond.hardening.linear={} MPa", self.linear),
            format!("bond.rupture.strain={} %", self.rupture_strain),
        ]
    }
}

/// One run of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// What was set.
    pub setting: Setting,
    /// Tensile strength [MPa].
    pub strength: f64,
    /// Fracture elongation [%].
    pub elongation: f64,
    /// Relative errors of strength and elongation [-].
    pub error: [f64; 2],
    /// The whole result.
    pub summary: RunSummary,
}

/// The Voce law and rupture strain that a scene starts from.
struct Start {
    yield_stress: f64,
    saturation: f64,
    rate: f64,
    linear: f64,
    rupture_strain: f64,
}

impl Start {
    fn of(scene: &Scene) -> Result<Self> {
        let wrong = |key: &str, what: &str| {
            scene.source.error(key, what, "calibration fits a Voce law and a plastic strain at rupture, see ka4")
        };
        let BondLawSpec::ElastoPlastic(HardeningSpec::Voce { yield_stress, saturation, rate, linear }) =
            &scene.spec.bond.law
        else {
            return Err(wrong("bond.hardening", "the hardening of this scene is not of the form \"voce\""));
        };
        let Some(RuptureCriterion::PlasticStrain { strain }) = scene.spec.bond.rupture.as_ref().map(|r| &r.criterion)
        else {
            return Err(wrong("bond.rupture", "the rupture criterion of this scene is not \"plastic-strain\""));
        };
        Ok(Self {
            yield_stress: *yield_stress,
            saturation: *saturation,
            rate: *rate,
            linear: *linear,
            rupture_strain: *strain,
        })
    }

    /// Setting for a factor on the hardening and a rupture strain [-], to four figures.
    fn setting(&self, x: DVec2) -> Setting {
        let round = |value: f64, places: i32| (value * 10f64.powi(places)).round() / 10f64.powi(places);
        Setting {
            saturation: round(self.saturation * x.x * 1e-6, 1),
            linear: round(self.linear * x.x * 1e-6, 1),
            rupture_strain: round(x.y * 100.0, 3),
        }
    }

    /// d(strength [MPa], elongation [%]) / d(factor, rupture strain) of one uniformly pulled wire.
    fn slopes(&self, p: f64) -> DMat2 {
        let decay = (-self.rate * p).exp();
        let hardening = self.saturation * (1.0 - decay) + self.linear * p;
        let slope = self.saturation * self.rate * decay + self.linear;
        let shrink = (-p).exp() * 1e-6;
        DMat2::from_cols(
            DVec2::new(hardening * shrink, 0.0),
            DVec2::new((slope - self.yield_stress - hardening) * shrink, 100.0 * p.exp()),
        )
    }
}

/// Fits the scene to the target; `tell` hears of every run. Returns the trial that met it.
///
/// # Errors
/// A scene of another kind, a run that fails, an interruption, a target out of reach, or no success within ten runs.
pub fn calibrate(
    name: &str,
    overrides: &[String],
    target: &Target,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(usize, &Trial),
) -> Result<Trial> {
    let start = Start::of(&scene::load(name, overrides)?)?;
    let mut x = DVec2::new(1.0, start.rupture_strain);
    let mut slopes = start.slopes(start.rupture_strain);
    let mut last: Option<(DVec2, DVec2)> = None;
    for run in 1..=MOST_RUNS {
        let trial = try_setting(name, overrides, start.setting(x), target, stop)?;
        tell(run, &trial);
        if trial.error.iter().all(|e| e.abs() <= target.tolerance) {
            return Ok(trial);
        }
        let miss = DVec2::new(trial.strength - target.strength, trial.elongation - target.elongation);
        if let Some((x_last, miss_last)) = last {
            slopes = broyden(slopes, x - x_last, miss - miss_last);
        }
        last = Some((x, miss));
        x = next(x, slopes, miss)?;
    }
    Err(Error::input(
        format!("no setting within {} % after {MOST_RUNS} runs", 100.0 * target.tolerance),
        "scatter between runs may be larger than that; allow more with --tolerance",
    ))
}

/// The next factor on the hardening and rupture strain.
///
/// # Errors
/// When one of them would have to be below zero: what the runs give does not follow them any more.
fn next(x: DVec2, slopes: DMat2, miss: DVec2) -> Result<DVec2> {
    let next = x - slopes.inverse() * miss;
    if next.cmpgt(DVec2::ZERO).all() {
        return Ok(next);
    }
    let what = format!(
        "strength and elongation do not follow hardening and rupture strain any more: the next run would need {:.3} times \
         the hardening and a rupture strain of {:.1} %",
        next.x,
        100.0 * next.y
    );
    let help = "wires that neck before they rupture (Considère: hardening below the stress) do not get longer with the \
                rupture strain; start with more bond.hardening.linear and less bond.hardening.saturation";
    Err(Error::input(what, help))
}

/// Broyden's update: the least change of the slopes that explains the last step.
fn broyden(slopes: DMat2, dx: DVec2, dy: DVec2) -> DMat2 {
    let off = (dy - slopes * dx) / dx.length_squared();
    slopes + DMat2::from_cols(off * dx.x, off * dx.y)
}

fn try_setting(
    name: &str,
    overrides: &[String],
    setting: Setting,
    target: &Target,
    stop: &AtomicBool,
) -> Result<Trial> {
    let all: Vec<String> = overrides.iter().cloned().chain(setting.overrides()).collect();
    let scene = scene::load(name, &all)?;
    let summary = summarise(&scene, Vec::new(), stop)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Error::input("interrupted before the calibration was done", "run it again; runs are not kept"));
    }
    let measured = summary.tensile_strength_mpa.zip(summary.fracture_elongation_percent);
    let Some((strength, elongation)) = measured else {
        return Err(scene.source.error("grip", "a scene without grips has no strength", "calibrate a pulled strand"));
    };
    let error = [strength / target.strength - 1.0, elongation / target.elongation - 1.0];
    Ok(Trial { setting, strength, elongation, error, summary })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broyden_explains_the_last_step_and_nothing_else() {
        let slopes = DMat2::from_cols(DVec2::new(2.0, 0.5), DVec2::new(-1.0, 3.0));
        let (dx, dy) = (DVec2::new(0.1, -0.2), DVec2::new(0.7, 0.3));
        let updated = broyden(slopes, dx, dy);
        assert!((updated * dx - dy).length() < 1e-12);
        let across = DVec2::new(0.2, 0.1);
        assert!((updated * across - slopes * across).length() < 1e-12);
    }

    #[test]
    fn a_target_out_of_reach_is_told() {
        let slopes = DMat2::from_diagonal(DVec2::new(200.0, 100.0));
        let x = DVec2::new(1.0, 0.3);
        assert!((next(x, slopes, DVec2::new(20.0, 10.0)).unwrap() - DVec2::new(0.9, 0.2)).length() < 1e-12);
        // A wire that necked: 20 % more of rupture strain gave nothing, so that the slope has the other sign.
        let flat = DMat2::from_diagonal(DVec2::new(200.0, -1.0));
        let error = next(x, flat, DVec2::new(0.0, -2.0)).unwrap_err().to_string();
        assert!(error.contains("a rupture strain of -170.0 %"), "{error}");
    }

    #[test]
    fn slopes_are_those_of_a_pulled_wire() {
        let start = Start { yield_stress: 100e6, saturation: 180e6, rate: 12.0, linear: 550e6, rupture_strain: 0.25 };
        let wire = |factor: f64, p: f64| {
            let stress = 100e6 + factor * (180e6 * (1.0 - (-12.0 * p).exp()) + 550e6 * p);
            DVec2::new(stress * (-p).exp() * 1e-6, 100.0 * p.exp_m1())
        };
        let h = 1e-6;
        let slopes = start.slopes(0.25);
        let by_factor = (wire(1.0 + h, 0.25) - wire(1.0 - h, 0.25)) / (2.0 * h);
        let by_strain = (wire(1.0, 0.25 + h) - wire(1.0, 0.25 - h)) / (2.0 * h);
        assert!((slopes.x_axis - by_factor).length() < 1e-4);
        assert!((slopes.y_axis - by_strain).length() < 1e-3);
    }

    #[test]
    fn one_wire_is_calibrated_in_a_few_runs() {
        let target = Target { strength: 240.0, elongation: 4.0, tolerance: 0.005 };
        let quick = ["wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]".to_string(), "bond.rupture.strain=3 %".into()];
        let mut runs = 0;
        let trial = calibrate("single-wire", &quick, &target, &AtomicBool::new(false), &mut |_, _| runs += 1).unwrap();
        assert!(trial.error.iter().all(|e| e.abs() <= 0.005), "{trial:?}");
        assert!(runs <= 6, "{runs}");
    }
}
