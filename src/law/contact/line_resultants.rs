//! Tests of what [`super::line`] answers besides the force, where integrals over the stretch have a closed form.

use super::hertz::Hertz;
use super::line::{CELLS, CellGap, LineResponse, Stretch, patch_length, respond, respond_cells};
use super::{NormalLaw, NormalResponse};
use std::f64::consts::PI;

const RADIUS: f64 = 0.1e-3;
const STIFFNESS: f64 = 20e9;
const LENGTH: f64 = 0.4e-3;

fn near(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < 1e-12, "{value} is not {expected}");
}

/// The whole of a stretch over [0, L] that overlaps by `overlap` (m) at 0 and by `end` (m) at L, elastic.
fn straight(overlap: f64, end: f64) -> LineResponse {
    let slope = (end - overlap) / LENGTH;
    let stretch =
        Stretch { reduced_radius: RADIUS, stiffness: STIFFNESS, overlap, slope, curvature: 0.0, ends: [0.0, LENGTH] };
    respond(&stretch, f64::INFINITY, &mut 0.0)
}

/// A trapezium of force per length: k(δ₀ + δ₁)L/2 at L(δ₀ + 2δ₁)/(3(δ₀ + δ₁)), with the energy k(δ₀² + δ₀δ₁ + δ₁²)L/6.
#[test]
fn a_straight_gap_pushes_at_the_centre_of_its_trapezium() {
    for (first, last) in [(2e-6, 2e-6), (2e-6, 1e-6), (3e-6, 0.3e-6)] {
        let answer = straight(first, last);
        near(answer.force, STIFFNESS * (first + last) * LENGTH / 2.0);
        near(answer.centre, LENGTH * (first + 2.0 * last) / (3.0 * (first + last)));
        near(answer.energy, STIFFNESS * (first * first + first * last + last * last) * LENGTH / 6.0);
        near(answer.stiffness, STIFFNESS * LENGTH);
        assert_eq!(answer.plastic_work, 0.0);
    }
    // A strip of the width √(2R*δ).
    near(straight(2e-6, 2e-6).area, (2.0 * RADIUS * 2e-6).sqrt() * LENGTH);
}

/// √(2R*δ) over a parabola of overlap is half an ellipse.
#[test]
fn the_area_of_a_crossing_is_that_of_half_an_ellipse() {
    let (overlap, curvature) = (2e-6, 400.0);
    let stretch = Stretch {
        reduced_radius: RADIUS,
        stiffness: STIFFNESS,
        overlap,
        slope: 0.0,
        curvature,
        ends: [-LENGTH, LENGTH],
    };
    let area = respond(&stretch, f64::INFINITY, &mut 0.0).area;
    let exact = 0.5 * PI * (2.0 * RADIUS * overlap).sqrt() * (2.0 * overlap / curvature).sqrt();
    // Four points integrate a semicircle to 1.2 %.
    assert!((area / exact - 1.0).abs() < 0.02, "{area} {exact}");
}

/// Cells from 0.1 to 0.9 bonds under one overlap: midpoints 0.15, 0.25 … 0.85, whose sum is 4 and sum of squares 2.42.
#[test]
fn cells_have_the_moments_of_their_places_and_count_by_their_share() {
    let gap = CellGap {
        reduced_radius: RADIUS,
        stiffness: STIFFNESS,
        overlap: 2e-6,
        rise: 0.0,
        bend: 0.0,
        first: 0.1,
        width: 0.1,
        length: LENGTH / CELLS as f64,
    };
    let per_cell = STIFFNESS * 2e-6 * gap.length;
    let whole = respond_cells(&gap, f64::INFINITY, &[1.0; CELLS], &mut [0.0; CELLS]);
    near(whole.moments[0], 8.0 * per_cell);
    near(whole.moments[1], 4.0 * per_cell);
    near(whole.moments[2], 2.42 * per_cell);
    near(whole.stiffness, STIFFNESS * LENGTH);
    near(whole.energy, 0.5 * whole.moments[0] * 2e-6);
    let mut share = [0.0; CELLS];
    (share[1], share[6]) = (0.5, 0.25);
    let some = respond_cells(&gap, f64::INFINITY, &share, &mut [0.0; CELLS]);
    near(some.moments[0], 0.75 * per_cell);
    near(some.moments[1], (0.5 * 0.25 + 0.25 * 0.75) * per_cell);
    near(some.stiffness, 0.75 * STIFFNESS * gap.length);
    // Rising by 1 µm per bond, δ = 0.5 µm − u µm: the four places up to 0.45 bonds touch.
    let rising = CellGap { overlap: 0.5e-6, rise: 1e-6, ..gap };
    let part = respond_cells(&rising, f64::INFINITY, &[1.0; CELLS], &mut [0.0; CELLS]);
    near(part.stiffness, 4.0 * STIFFNESS * gap.length);
    near(part.moments[0], (0.35 + 0.25 + 0.15 + 0.05) * 1e-6 * STIFFNESS * gap.length);
}

#[test]
fn a_patch_is_as_long_as_its_chord_and_no_longer_than_the_stretch() {
    // δ = κs²/2 at s = √(2δ/κ) to either side: 0.1 mm for 2 µm and 400 /m.
    near(patch_length(2e-6, 400.0, LENGTH), 0.2e-3);
    assert_eq!(patch_length(2e-6, 400.0, 0.15e-3), 0.15e-3);
    assert_eq!(patch_length(2e-6, 0.0, LENGTH), LENGTH);
    assert_eq!(patch_length(2e-6, -400.0, LENGTH), LENGTH);
    assert_eq!(patch_length(-2e-6, 400.0, LENGTH), 0.0);
}

/// The slope grows with the overlap: the greatest so far is the one now.
#[test]
fn the_greatest_stiffness_of_hertz_is_the_present_one() {
    let law = Hertz { effective_modulus: 65e9 };
    let now: NormalResponse = law.response(&mut (), RADIUS, 1e-6);
    near(law.greatest_stiffness(&(), RADIUS, 1e-6), now.stiffness);
    assert_eq!(law.greatest_stiffness(&(), RADIUS, -1e-6), 0.0);
    assert_eq!((law.effective_modulus(), law.limiting_pressure()), (65e9, f64::INFINITY));
}
