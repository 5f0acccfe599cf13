//! Calibration of a pulled scene on one tensile test: strength and elongation, as means over seeds of the scatter.
//!
//! Two numbers are fitted to two: a factor on the hardening part of the Voce law (Q and H together; σ₀ stays what
//! annealed copper has) and the plastic strain at rupture p_f. Everything else stays as the scene has it. The search is
//! Newton's with the slopes of a uniformly pulled wire that breaks where the strand did: the elongation is e^p − 1, the
//! nominal strength σ_y(p)e^(−p), and p goes with p_f. Along the last step the slopes are what it found (Broyden 1965).
//!
//! One draw of the scatter is one strand, so a setting is judged by the mean over seeds. The seeds are the same at every
//! setting (common random numbers): the same bonds stay the weak ones, and the means change smoothly with the setting.
//! The first settings are tried with a few of the seeds, whose means lack only an offset that hardly depends on the
//! setting; then all seeds are run where those arrived, and decide. Runs are kept
//! ([`CaseStore`]), so that the same calibration goes on where it was interrupted.

use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use crate::run::folder::CALIBRATION;
use crate::scene::Scene;
use crate::scene::spec::{BondLawSpec, HardeningSpec, NormalSpec, RuptureCriterion, Spec};
use crate::study::runner::{CaseRunner, CaseStore, all_outputs};
use crate::study::statistics::Statistics;
use crate::study::tensile::{TensileCase, TensileOutcome, TensileResult, count_kept};
use glam::{DMat2, DVec2};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Seeds of a scene with scatter where the user says nothing: its mean is then known to 0.84 of its standard deviation
/// (95 %), and a calibration takes about 24 runs.
pub const SEEDS: u64 = 8;
/// The first settings are tried with one in so many seeds, and with [`FEWEST`] at least.
const COARSER: usize = 4;
/// See [`COARSER`].
const FEWEST: usize = 2;
/// Settings tried with those.
const COARSE: usize = 3;
/// Settings that a calibration may try before it gives up.
const MOST_SETTINGS: usize = 10;

/// What the test found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Target {
    /// Tensile strength (MPa).
    pub strength: f64,
    /// Fracture elongation (%).
    pub elongation: f64,
    /// Allowed relative error of either (-).
    pub tolerance: f64,
}

/// The scene that is calibrated, and how its runs are made.
pub struct Calibration<'a> {
    /// The scene to start from.
    pub scene: &'a Scene,
    /// Seeds that means are taken over; at least one.
    pub seeds: &'a [u64],
    /// Where runs are kept.
    pub store: &'a CaseStore,
    /// Runs them.
    pub runner: &'a CaseRunner<'a>,
}

/// The seeds of a scene where the user names none: the first [`SEEDS`], or its own where its bonds do not scatter.
pub fn default_seeds(scene: &Scene) -> Vec<u64> {
    if scene.plan.scatter { (1..=SEEDS).collect() } else { vec![scene.spec.seed] }
}

/// The two numbers that are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Setting {
    /// Q of the Voce law (MPa).
    pub saturation: f64,
    /// H of the Voce law (MPa).
    pub linear: f64,
    /// Plastic strain at rupture p_f (%).
    pub rupture_strain: f64,
}

impl Setting {
    /// The `--set` options that give a scene this setting.
    pub fn overrides(&self) -> [String; 3] {
        [
            format!("bond.hardening.saturation={} MPa", self.saturation),
            format!("bond.hardening.linear={} MPa", self.linear),
            format!("bond.rupture.strain={} %", self.rupture_strain),
        ]
    }

    /// Gives a scene this setting; a limiting contact pressure that follows the hardening law goes along.
    fn apply(&self, spec: &mut Spec) {
        let BondLawSpec::ElastoPlastic(law) = &mut spec.bond.law else { return };
        if let HardeningSpec::Voce { saturation, linear, .. } = law {
            [*saturation, *linear] = [1e6 * self.saturation, 1e6 * self.linear];
        }
        if let Some(contact) = &mut spec.contact
            && let Some(hardness) = contact.hardness
        {
            contact.normal = NormalSpec::Thornton { limiting_pressure: hardness.limiting_pressure(law) };
        }
        if let Some(RuptureCriterion::PlasticStrain { strain }) = spec.bond.rupture.as_mut().map(|r| &mut r.criterion) {
            *strain = 0.01 * self.rupture_strain;
        }
    }
}

/// One setting of a calibration, tried with one or more seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Iteration {
    /// What was set.
    pub setting: Setting,
    /// Tensile strength (MPa), over seeds.
    pub strength: Statistics,
    /// Fracture elongation (%), over seeds.
    pub elongation: Statistics,
    /// Relative errors of the means of strength and elongation (-).
    pub error: [f64; 2],
    /// Runs that were there from before, and of those the ones of another build of the same physics.
    pub kept: usize,
    /// See `kept`.
    pub other_build: usize,
}

impl Iteration {
    fn meets(&self, target: &Target) -> bool {
        self.error.iter().all(|e| e.abs() <= target.tolerance)
    }

    /// How far the means are from the target (strength (MPa), elongation (%)).
    fn miss(&self, target: &Target) -> DVec2 {
        DVec2::new(self.strength.mean - target.strength, self.elongation.mean - target.elongation)
    }
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
        if scene.spec.has_several_materials() || scene.spec.material_name.is_some() {
            let what = "this scene names its materials, and calibration fits [bond]";
            return Err(scene.source.error("materials", what, "calibrate each material with a scene of its own wire"));
        }
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

    /// Setting for a factor on the hardening and one on the rupture strain (-), to four figures.
    fn setting(&self, x: DVec2) -> Setting {
        let round = |value: f64, places: i32| (value * 10f64.powi(places)).round() / 10f64.powi(places);
        Setting {
            saturation: round(self.saturation * x.x * 1e-6, 1),
            linear: round(self.linear * x.x * 1e-6, 1),
            rupture_strain: round(self.rupture_strain * x.y * 100.0, 3),
        }
    }

    /// d(strength (MPa), elongation (%)) / d(factor on the hardening, factor on the rupture strain) at factors `x` of a
    /// uniformly pulled wire that breaks at plastic strain `p` (-): where it does go with the rupture strain, and the
    /// weakest bond of a body with scatter does.
    fn slopes(&self, x: DVec2, p: f64) -> DMat2 {
        let decay = (-self.rate * p).exp();
        let hardening = self.saturation * (1.0 - decay) + self.linear * p;
        let stress = self.yield_stress + x.x * hardening;
        let slope = x.x * (self.saturation * self.rate * decay + self.linear);
        let shrink = (-p).exp() * 1e-6;
        let by_factor = p / x.y;
        DMat2::from_cols(
            DVec2::new(hardening * shrink, 0.0),
            DVec2::new((slope - stress) * shrink, 100.0 * p.exp()) * by_factor,
        )
    }
}

/// What a calibration has found.
pub struct Found<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Seeds that means were taken over.
    pub seeds: &'a [u64],
    /// What the test found.
    pub target: &'a Target,
    /// Setting by setting; the last one met the target.
    pub iterations: &'a [Iteration],
    /// The one that met it.
    pub best: &'a Iteration,
}

impl Found<'_> {
    /// Writes `calibration.json` into a folder; `command` is what the user typed. Gives the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, command: &str, folder: &Path) -> Result<PathBuf> {
        let document = serde_json::json!({
            "scene": self.scene,
            "command": command,
            "version": env!("CARGO_PKG_VERSION"),
            "seeds": self.seeds,
            "target": self.target,
            "trials": self.iterations,
            // The options that reproduce the test.
            "set": self.best.setting.overrides(),
        });
        let text = serde_json::to_string_pretty(&document).expect("a calibration holds nothing that JSON lacks");
        let file = folder.join(CALIBRATION);
        write_whole(&file, &(text + "\n"))?;
        Ok(file)
    }
}

/// Fits the means of the scene to the target; `tried` hears of every setting. Returns the iteration over all seeds that met
/// it.
///
/// # Errors
/// A scene of another kind, a run that fails or breaks nothing, an interruption, a target out of reach, or no success
/// within ten settings.
pub fn calibrate(
    calibration: &Calibration,
    target: &Target,
    tried: &mut dyn FnMut(usize, &Iteration),
) -> Result<Iteration> {
    let start = Start::of(calibration.scene)?;
    let all = calibration.seeds.len();
    let few = (all / COARSER).max(FEWEST).min(all);
    let mut x = DVec2::ONE;
    let mut last: Option<(DVec2, DVec2)> = None;
    let mut count = few;
    for number in 1..=MOST_SETTINGS {
        let iteration = calibration.try_setting(start.setting(x), &calibration.seeds[..count], target)?;
        tried(number, &iteration);
        let met = iteration.meets(target);
        if met && count == all {
            return Ok(iteration);
        }
        let miss = iteration.miss(target);
        let wire = start.slopes(x, (0.01 * iteration.elongation.mean).ln_1p());
        let slopes = last.map_or(wire, |(x_last, miss_last)| broyden(wire, x - x_last, miss - miss_last));
        // The other seeds are run where the few arrived, whose runs are kept; where the few miss, one step further.
        let enough = count < all && (met || number == COARSE);
        last = Some((x, miss)).filter(|_| !enough);
        if enough {
            count = all;
        }
        if !met {
            x = next(x, slopes, miss, start.rupture_strain)?;
        }
    }
    Err(Error::input(
        format!("no setting within {} % after {MOST_SETTINGS} settings", 100.0 * target.tolerance),
        "allow more with --tolerance, or start nearer with --set; runs are kept",
    ))
}

/// The next factors on the hardening and on the rupture strain, which is `rupture_strain` (-) at 1.
///
/// # Errors
/// When one of them would have to be below zero: what the runs give does not follow them any more.
fn next(x: DVec2, slopes: DMat2, miss: DVec2, rupture_strain: f64) -> Result<DVec2> {
    let next = x - slopes.inverse() * miss;
    if next.cmpgt(DVec2::ZERO).all() {
        return Ok(next);
    }
    let what = format!(
        "strength and elongation do not follow hardening and rupture strain any more: the next run would need {:.3} times \
         the hardening and a rupture strain of {:.1} %",
        next.x,
        100.0 * rupture_strain * next.y
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

impl Calibration<'_> {
    /// Runs a setting with these seeds, or finds its runs.
    fn try_setting(&self, setting: Setting, seeds: &[u64], target: &Target) -> Result<Iteration> {
        let scene = self.scene.clone().changed(|spec| setting.apply(spec));
        let jobs = self.runner.jobs.min(seeds.len());
        let runner = CaseRunner { jobs, ..*self.runner };
        let case = |seed: &u64| {
            let name = format!("p_f = {} %, seed {seed}", setting.rupture_strain);
            TensileCase::new(name, Ok(&scene), *seed, self.store)
        };
        let statuses = runner.run(&seeds.iter().map(case).collect::<Vec<_>>())?;
        let [kept, other_build] = count_kept(&statuses);
        let (mut strengths, mut elongations) = (Vec::new(), Vec::new());
        for (seed, record) in seeds.iter().zip(all_outputs(statuses)?) {
            let result = result(*seed, &record.result)?;
            strengths.push(result.strength_mpa);
            elongations.push(result.elongation_percent);
        }
        let over = |values: &[f64]| Statistics::of(values).expect("there is a seed");
        let (strength, elongation) = (over(&strengths), over(&elongations));
        let error = [strength.mean / target.strength - 1.0, elongation.mean / target.elongation - 1.0];
        Ok(Iteration { setting, strength, elongation, error, kept, other_build })
    }
}

/// What the run of a seed gave.
///
/// # Errors
/// When it gave nothing, or broke nothing: its greatest stress is then where it was stopped.
fn result(seed: u64, outcome: &TensileOutcome) -> Result<&TensileResult> {
    outcome.result().ok_or_else(|| {
        let cause = outcome.cause().unwrap_or_default();
        let help = "`strandsnap run` with this seed shows where it stops";
        Error::input(format!("the run with seed {seed} gives nothing to calibrate on: {cause}"), help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::study::accuracy::closed_form;
    use crate::study::tensile::with_seed;
    use std::sync::atomic::AtomicBool;

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
        let x = DVec2::ONE;
        let near = next(x, slopes, DVec2::new(20.0, 10.0), 0.3).unwrap();
        assert!((near - DVec2::new(0.9, 0.9)).length() < 1e-12);
        // A wire that necked: 20 % more of rupture strain gave nothing, so that the slope has the other sign.
        let flat = DMat2::from_diagonal(DVec2::new(200.0, -0.3));
        let error = next(x, flat, DVec2::new(0.0, -2.0), 0.3).unwrap_err().to_string();
        assert!(error.contains("a rupture strain of -170.0 %"), "{error}");
    }

    #[test]
    fn slopes_are_those_of_a_pulled_wire() {
        let start = Start { yield_stress: 100e6, saturation: 180e6, rate: 12.0, linear: 550e6, rupture_strain: 0.25 };
        // Its weakest bond breaks at nine tenths of the rupture strain.
        let wire = |x: DVec2| {
            let p = 0.9 * 0.25 * x.y;
            let stress = 100e6 + x.x * (180e6 * (1.0 - (-12.0 * p).exp()) + 550e6 * p);
            DVec2::new(stress * (-p).exp() * 1e-6, 100.0 * p.exp_m1())
        };
        let (x, h) = (DVec2::new(1.1, 0.8), 1e-6);
        let slopes = start.slopes(x, 0.9 * 0.25 * x.y);
        let [by_factor, by_strain] = [DVec2::X, DVec2::Y].map(|d| (wire(x + h * d) - wire(x - h * d)) / (2.0 * h));
        assert!((slopes.x_axis - by_factor).length() < 1e-4);
        assert!((slopes.y_axis - by_strain).length() < 1e-3);
    }

    /// A wire of 30 mm whose bonds scatter widely, so that seeds differ by some per cent.
    const WIRE: [&str; 5] = [
        "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
        "grip.length=5 mm",
        // Slowly: what the pull adds to the elongation goes with its speed.
        "grip.speed=1 m/s",
        "bond.rupture.strain=4 %",
        "bond.rupture.weibull_modulus=8",
    ];

    fn wire(more: &[&str]) -> Scene {
        let options: Vec<String> = WIRE.iter().chain(more).map(|option| option.to_string()).collect();
        scene::load("single-wire", &options).unwrap()
    }

    fn fit(folder: &Path, scene: &Scene, stop: bool, seeds: &[u64]) -> (Result<Iteration>, Vec<Iteration>) {
        let stop = AtomicBool::new(stop);
        let store = CaseStore::open(folder, false).unwrap();
        let runner = CaseRunner { jobs: 2, threads: None, budget: None, stop: &stop, tell: &|_| {} };
        let calibration = Calibration { scene, seeds, store: &store, runner: &runner };
        let mut iterations = Vec::new();
        let found = calibrate(&calibration, &TARGET, &mut |_, iteration| iterations.push(iteration.clone()));
        (found, iterations)
    }

    const TARGET: Target = Target { strength: 150.0, elongation: 5.0, tolerance: 0.005 };
    const EIGHT: [u64; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

    /// The mean over the seeds is what is fitted: the closed form of each draw's weakest bond has the same mean.
    #[test]
    fn the_mean_over_seeds_is_fitted_and_the_closed_form_agrees() {
        let folder = tempfile::tempdir().unwrap();
        let (best, iterations) = fit(folder.path(), &wire(&[]), false, &EIGHT);
        let best = best.unwrap();
        assert!(best.error.iter().all(|e| e.abs() <= 0.005), "{best:?}");
        assert_eq!((best.strength.count, iterations[0].strength.count), (8, 2));
        let truths = EIGHT.map(|seed| {
            let scene = with_seed(&wire(&best.setting.overrides().each_ref().map(String::as_str)), seed);
            closed_form::truth(&scene).unwrap().elongation_percent
        });
        let truth = Statistics::of(&truths).unwrap();
        assert!((truth.mean / TARGET.elongation - 1.0).abs() < 0.01, "{truth:?}");
        // One draw says something else: the seeds differ by more than the tolerance.
        let spread = best.elongation.standard_deviation.unwrap();
        assert!((spread / truth.standard_deviation.unwrap() - 1.0).abs() < 0.1, "{spread} {truth:?}");
        assert!(spread > 0.03 * TARGET.elongation);
        let runs: usize = iterations.iter().map(|iteration| iteration.strength.count - iteration.kept).sum();
        assert!(runs <= 3 * EIGHT.len(), "{runs}");
    }

    /// The same calibration goes on with what is kept: the second makes no run and finds the same to the bit.
    #[test]
    fn finished_runs_are_not_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let (first, _) = fit(folder.path(), &wire(&[]), false, &EIGHT[..3]);
        let (second, iterations) = fit(folder.path(), &wire(&[]), false, &EIGHT[..3]);
        assert!(iterations.iter().all(|iteration| iteration.kept == iteration.strength.count), "{iterations:?}");
        let (first, second) = (first.unwrap(), second.unwrap());
        assert_eq!((first.setting, first.strength), (second.setting, second.strength));
        let other = tempfile::tempdir().unwrap();
        assert!(matches!(fit(other.path(), &wire(&[]), true, &EIGHT).0, Err(Error::Interrupted)));
    }

    #[test]
    fn a_run_that_breaks_nothing_says_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let error = fit(folder.path(), &wire(&["stop.strain=2 %"]), false, &[7]).0.unwrap_err().to_string();
        assert!(error.contains("seed 7") && error.contains("no strength"), "{error}");
    }

    /// A setting is what its options would make of the scene, the limiting pressure of contacts included.
    #[test]
    fn a_setting_is_what_its_options_say() {
        let setting = Setting { saturation: 201.3, linear: 614.7, rupture_strain: 27.123 };
        for name in ["ka4", "single-wire"] {
            let mut spec = scene::load(name, &[]).unwrap().spec;
            setting.apply(&mut spec);
            assert_eq!(spec, scene::load(name, &setting.overrides()).unwrap().spec);
        }
    }

    #[test]
    fn several_seeds_where_there_is_scatter_and_one_where_there_is_none() {
        let seeds = |options: &[&str]| {
            let options: Vec<String> = options.iter().map(|option| option.to_string()).collect();
            default_seeds(&scene::load("ka4", &options).unwrap())
        };
        assert_eq!(seeds(&[]), EIGHT);
        assert_eq!(seeds(&["bond.rupture.weibull_modulus=inf", "seed=5"]), [5]);
    }
}
