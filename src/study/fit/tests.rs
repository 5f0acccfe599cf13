use super::*;
use crate::reference::published::{CALIBRATED_ON, ExponentialFit, Published, find};

fn on_curve(parameters: [f64; 3], xs: &[f64]) -> Vec<[f64; 2]> {
    xs.iter().map(|x| [*x, Model::Exponential.value(&parameters, *x)]).collect()
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * k as f64 / (count - 1) as f64).collect()
}

fn squares(points: &[[f64; 2]], value: impl Fn(f64) -> f64) -> f64 {
    points.iter().map(|[x, y]| (y - value(*x)).powi(2)).sum()
}

fn paper() -> &'static Published {
    find(CALIBRATED_ON).unwrap()
}

fn printed(key: &str) -> &'static ExponentialFit {
    paper().fit_over(key, "mm", "elongation").unwrap()
}

/// The paper's simulations over pitch, at wires of 0.39 mm.
fn over_pitch() -> Vec<[f64; 2]> {
    let wanted = paper().simulation.iter().filter(|s| s.wire_diameter_mm == 0.39);
    wanted.map(|s| [s.pitch_mm, s.fracture_elongation_percent]).collect()
}

/// The same over wire diameter, at a pitch of 39 mm.
fn over_diameter() -> Vec<[f64; 2]> {
    let wanted = paper().simulation.iter().filter(|s| s.pitch_mm == 39.0);
    wanted.map(|s| [s.wire_diameter_mm, s.fracture_elongation_percent]).collect()
}

#[test]
fn points_of_a_known_curve_come_back() {
    for (parameters, from, to) in [
        ([62.8958, -0.09, 25.0662], 39.0, 54.0),
        ([0.002, 18.8726, 23.761], 0.25, 0.39),
        ([-5.0, -0.2, 300.0], 39.0, 54.0),
        ([-1e-3, 12.0, 260.0], 0.25, 0.39),
        ([2.0, 0.5, -7.0], -3.0, 4.0),
        ([100.0, 0.003, 1.0], 39.0, 54.0),
    ] {
        let found = fit(Model::Exponential, &on_curve(parameters, &even(from, to, 7))).unwrap();
        for (value, right) in found.parameters.iter().zip(parameters) {
            assert!((value - right).abs() < 1e-7 * right.abs(), "{:?} instead of {parameters:?}", found.parameters);
        }
        assert!(found.rms < 1e-10 * parameters[2].abs().max(1.0));
    }
}

/// Four of the paper's seven points are printed. The best curve through four cannot miss them by more than the printed
/// one does; and at them the two cannot be further apart than both residuals together.
#[test]
fn the_papers_points_over_pitch_land_on_its_curve() {
    let (points, printed) = (over_pitch(), printed("strand.pitch"));
    assert_eq!(points.len(), 4);
    let found = fit(Model::Exponential, &points).unwrap();
    let [ours, theirs] = [squares(&points, |x| found.value(x)), squares(&points, |x| printed.value(x))];
    assert!(ours <= theirs, "{ours} {theirs}");
    let most = ours.sqrt() + theirs.sqrt();
    for x in even(39.0, 54.0, 16) {
        let apart = (found.value(x) - printed.value(x)).abs();
        assert!(apart <= most, "{x}: {apart} {most}");
    }
    // Rounding aside, the parameters are within their own intervals of the printed ones.
    let interval = found.interval_95.as_ref().unwrap();
    for ((value, half), right) in found.parameters.iter().zip(interval).zip([printed.a, printed.b, printed.c]) {
        assert!((value - right).abs() <= *half, "{value} ± {half}: {right}");
    }
}

/// Three points and three parameters: the curve runs through them, and nothing is left to judge it by.
#[test]
fn three_points_are_met_exactly_and_have_no_errors() {
    let found = fit(Model::Exponential, &over_diameter()).unwrap();
    assert!(found.rms < 1e-9 && found.errors.is_none(), "{found:?}");
    let compared = compare(&over_diameter());
    assert_eq!(compared.model(Model::Exponential).cross_validation, Err(FitError::TooFew { have: 2, need: 3 }));
    // The printed curve was fitted to four points more: its rate is of the same size and sign.
    let printed = printed("strand.wire_diameter");
    assert!(found.parameters[1] > 0.0 && (found.parameters[1] / printed.b - 1.0).abs() < 0.5, "{found:?}");
}

#[test]
fn degenerate_points_get_a_clear_answer() {
    let exponential = |points: &[[f64; 2]]| fit(Model::Exponential, points).unwrap_err();
    let flat: Vec<[f64; 2]> = even(0.0, 1.0, 5).iter().map(|x| [*x, 3.0]).collect();
    assert_eq!(exponential(&flat), FitError::Flat(3.0));
    assert_eq!(fit(Model::Constant, &flat).unwrap().parameters, [3.0]);
    assert_eq!(exponential(&[[1.0, 2.0], [2.0, 3.0]]), FitError::TooFew { have: 2, need: 3 });
    assert_eq!(exponential(&[[1.0, 2.0], [2.0, 3.0], [2.0, 4.0]]), FitError::TooFew { have: 2, need: 3 });
    assert_eq!(exponential(&[]), FitError::TooFew { have: 0, need: 3 });
    let broken = exponential(&[[1.0, 2.0], [2.0, f64::NAN], [3.0, 1.0]]);
    assert!(broken.to_string().starts_with("point 2 is (2, NaN)"), "{broken}");
    assert!(matches!(exponential(&[[f64::INFINITY, 2.0]]), FitError::NotFinite { number: 1, .. }));
    let line: Vec<[f64; 2]> = even(39.0, 54.0, 7).iter().map(|x| [*x, 30.0 - 0.1 * x]).collect();
    assert_eq!(exponential(&line), FitError::Straight);
    let step: Vec<[f64; 2]> = even(0.0, 1.0, 6).iter().map(|x| [*x, if *x > 0.9 { 5.0 } else { 1.0 }]).collect();
    assert_eq!(exponential(&step), FitError::Step);
    let fall: Vec<[f64; 2]> = even(0.0, 1.0, 6).iter().map(|x| [*x, if *x < 0.1 { 5.0 } else { 1.0 }]).collect();
    assert_eq!(exponential(&fall), FitError::Step);
}

#[test]
fn lines_have_the_errors_of_the_textbook() {
    // Slope error s/√Sxx, intercept error s √(1/n + x̄²/Sxx).
    let points = [[1.0, 2.1], [2.0, 3.9], [3.0, 6.2], [4.0, 7.8], [5.0, 10.1]];
    let found = fit(Model::Line, &points).unwrap();
    let s = (found.residuals.iter().map(|r| r * r).sum::<f64>() / 3.0).sqrt();
    let errors = found.errors.unwrap();
    assert!((errors[1] - s / 10f64.sqrt()).abs() < 1e-12, "{errors:?}");
    assert!((errors[0] - s * (0.2 + 9.0 / 10.0f64).sqrt()).abs() < 1e-12, "{errors:?}");
    assert!((found.parameters[1] - 1.99).abs() < 1e-12 && (found.parameters[0] - 0.05).abs() < 1e-12);
}

/// A small pseudo-random number of mean 0, of its own so that the test never changes.
fn noise(state: &mut u64) -> f64 {
    let mut uniform = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// Over many noisy copies of a curve, the parameters scatter as much as their errors say.
#[test]
fn exponential_errors_are_the_scatter_of_the_parameters() {
    let (true_parameters, sd) = ([62.8958, -0.09, 25.0662], 0.002);
    let clean = on_curve(true_parameters, &even(39.0, 54.0, 12));
    let mut state = 7;
    let fits: Vec<Fit> = (0..400)
        .map(|_| {
            let noisy: Vec<[f64; 2]> = clean.iter().map(|[x, y]| [*x, y + sd * noise(&mut state)]).collect();
            fit(Model::Exponential, &noisy).unwrap()
        })
        .collect();
    for (k, truth) in true_parameters.iter().enumerate() {
        let scatter = fits.iter().map(|f| (f.parameters[k] - truth).powi(2)).sum::<f64>() / fits.len() as f64;
        let said = fits.iter().map(|f| f.errors.as_ref().unwrap()[k].powi(2)).sum::<f64>() / fits.len() as f64;
        assert!((scatter / said - 1.0).abs() < 0.25, "parameter {k}: {} {}", scatter.sqrt(), said.sqrt());
        let inside =
            fits.iter().filter(|f| (f.parameters[k] - truth).abs() <= f.interval_95.as_ref().unwrap()[k]).count();
        assert!((0.91..0.99).contains(&(inside as f64 / fits.len() as f64)), "{inside}");
    }
}

#[test]
fn cross_validation_of_a_constant_by_hand() {
    // 1 is foretold as 3 by 2 and 4, 2 as 2.5, 4 as 1.5.
    let found = compare(&[[0.0, 1.0], [1.0, 2.0], [2.0, 4.0]]);
    let folds = &found.model(Model::Constant).cross_validation.as_ref().unwrap().folds;
    for (fold, right) in folds.iter().zip([4.0, 0.25, 6.25]) {
        assert!((fold - right).abs() < 1e-12, "{folds:?}");
    }
}

#[test]
fn a_parabola_is_met_by_the_parabola_alone() {
    let points: Vec<[f64; 2]> = even(39.0, 54.0, 7).iter().map(|x| [*x, 30.0 + 0.5 * x - 0.01 * x * x]).collect();
    let found = compare(&points);
    assert_eq!(found.best, Some(Model::Parabola));
    assert!(found.model(Model::Parabola).cross_validation.as_ref().unwrap().mean < 1e-18);
    let parameters = &found.model(Model::Parabola).fit.as_ref().unwrap().parameters;
    for (value, right) in parameters.iter().zip([30.0, 0.5, -0.01]) {
        assert!((value - right).abs() < 1e-8, "{parameters:?}");
    }
}

/// Noise about a constant: what has more parameters follows the noise, and cross-validation shows it.
#[test]
fn overfitting_shows() {
    let ys = [25.1, 24.8, 25.3, 24.9, 25.2, 24.7, 25.0];
    let points: Vec<[f64; 2]> = even(39.0, 54.0, 7).into_iter().zip(ys).map(|(x, y)| [x, y]).collect();
    let found = compare(&points);
    assert_eq!(found.best, Some(Model::Constant));
    let rms = |model| found.model(model).fit.as_ref().map(|fit| fit.rms);
    assert!(rms(Model::Parabola).unwrap() < rms(Model::Constant).unwrap());
}

/// An axis in decades, where most points crowd together at one end: e^{bu} from its middle would overflow, and the best of
/// many b that are no numbers is none.
#[test]
fn axes_of_any_scale_have_their_exponential() {
    let decades = [2.0, 3.0, 5.0, 10.0, 30.0, 100.0, 1000.0];
    for scale in [1e-9, 1.0, 1e6] {
        let xs = decades.map(|x| x * scale);
        for parameters in [[-60.0, -0.28 / scale, 200.95], [3.0, -0.5 / scale, -7.0], [2.0, 0.004 / scale, 1.0]] {
            let found = fit(Model::Exponential, &on_curve(parameters, &xs)).unwrap();
            for (value, right) in found.parameters.iter().zip(parameters) {
                assert!((value - right).abs() < 1e-6 * right.abs(), "{:?} instead of {parameters:?}", found.parameters);
            }
        }
    }
}

/// A curve whose A no number holds is refused with a word, and cross-validation does not take it for the best.
#[test]
fn a_curve_beyond_the_range_of_numbers_is_refused() {
    let far: Vec<[f64; 2]> = even(1e4, 1e4 + 10.0, 7).iter().map(|x| [*x, 5.0 + (-(*x - 1e4)).exp()]).collect();
    assert_eq!(fit(Model::Exponential, &far), Err(FitError::Overflow));
    let found = compare(&far);
    assert!(found.model(Model::Exponential).cross_validation.is_err());
    assert!(found.best.is_some_and(|best| best != Model::Exponential));
    assert!(found.models.iter().flat_map(|one| &one.cross_validation).all(|one| one.mean.is_finite()));
}

/// Strength (MPa) of a wire over the Weibull modulus of its bonds (tests/studies/fit-log-axis). Right values by
/// scipy.optimize.curve_fit 1.x, and by a search in B alone with A and C by linear least squares: 161.62298, −0.28022553,
/// 200.96152, standard errors 16.39133, 0.03896311, 2.61414647, rms 3.53212072.
#[test]
fn a_study_in_decades_has_the_exponential_that_scipy_finds() {
    let points = [
        [2.0, 295.97511369288753],
        [3.0, 267.4738511405922],
        [5.0, 238.5218128211608],
        [10.0, 217.01992752407057],
        [30.0, 203.43232378639271],
        [100.0, 198.9040005458643],
        [1000.0, 197.06269792056983],
    ];
    let found = fit(Model::Exponential, &points).unwrap();
    let near = |value: f64, right: f64| assert!((value / right - 1.0).abs() < 1e-6, "{value} instead of {right}");
    let right = [161.62298097, -0.28022553, 200.96151671];
    found.parameters.iter().zip(right).for_each(|(value, right)| near(*value, right));
    let errors = [16.39133242, 0.03896311, 2.61414647];
    found.errors.as_ref().unwrap().iter().zip(errors).for_each(|(value, right)| near(*value, right));
    near(found.rms, 3.5321207204);
    assert_eq!(compare(&points).best, Some(Model::Exponential));
}
