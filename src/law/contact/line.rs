//! Contact of smooth wires along a stretch of their length: force per length, integrated over the part that overlaps.
//!
//! Two round wires near their closest points have the gap g(s) = g₀ + κ s²/2 along one of them, κ = sin²θ/(r₁ + r₂) for
//! straight wires that cross at θ, κ = 0 where they run side by side. With a force per length f = k δ(s), the whole
//! patch gives F = (4/3) k √(2/κ) δ₀^(3/2); that is Hertz's ellipse, (4/3) E* √R_e δ₀^(3/2) F₂^(−3/2), when
//!
//! k(τ) = ½ E* √(sin τ) F₂^(−3/2), sin²τ = 4 R* κ, R* = r₁r₂/(r₁ + r₂)
//!
//! (Johnson, *Contact Mechanics*, 1985, equations 4.18, 4.25 and 4.26, where cos τ = (B − A)/(B + A); R_e = ½ (AB)^(−½)).
//! A stretch of wire integrates over its own part of the patch only, so the result does not depend on how many stretches
//! share the patch: the contact of a point and of a line are one law.
//!
//! *Convention for lines.* The approach of two parallel cylinders grows with the logarithm of the length that is looked
//! at, δ = f/(πE*) (2 ln(4r/b) − 1) for centres of wires of radius r and a half-width b (Johnson, section 5.6). Hertz's k
//! falls with the logarithm of the patch's length; below τ = 2° it passes to the line's k = 0.3 E*, which is the value at
//! b/r = 0.013 (0.26 E* at 0.005, 0.33 E* at 0.02).
//!
//! *Limiting pressure.* Thornton's law (see [`super::thornton`]) for the whole patch, F' = πp_yR_e beyond
//! δ_y = (πp_y/2E*)²R_e for a circle, is the integral of the force per length
//!
//! f = k δ for δ ≤ δ_y, f = (2k/π) [δ asin √(δ_y/δ) + √(δ_y(δ − δ_y))] beyond, δ_y = π² p_y² R*/(8 k²)
//!
//! (Abel's inversion; the limit is p_y times the width √(2R*δ), whatever the angle). Each place keeps the dent
//! δ_p = δ_m − f_m/k that its greatest overlap δ_m has left, and unloads along f = k (δ − δ_p). Wires side by side keep it
//! cell by cell ([`respond_cells`]), wires that cross for the deepest place of their patch ([`respond`]).

use crate::base::lanes::{Mask, Real};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// Stiffness per length of a line contact over E* (-); see the convention above.
pub const LINE: f64 = 0.3;
/// sin τ below which two wires are parallel, and above which Hertz's ellipse holds (-): 1° and 2°.
const PARALLEL: [f64; 2] = [0.017_452_406, 0.034_899_497];

/// k/E* over sin τ; tabulated once, because it takes elliptic integrals.
#[derive(Debug, Clone)]
pub struct LineStiffness {
    /// At sin τ = i/(len − 1) (-).
    table: Vec<f64>,
}

impl Default for LineStiffness {
    fn default() -> Self {
        const INTERVALS: usize = 1024;
        let at = |i: usize| hertz_stiffness((i as f64 / INTERVALS as f64).max(1e-3));
        Self { table: (0..=INTERVALS).map(at).collect() }
    }
}

impl LineStiffness {
    /// k/E* (-) for reduced radius R* (m) where the gap has the curvature κ (1/m).
    #[inline(always)]
    pub fn at(&self, reduced_radius: f64, curvature: f64) -> f64 {
        let sine = (4.0 * reduced_radius * curvature).clamp(0.0, 1.0).sqrt();
        if sine <= PARALLEL[0] {
            return LINE;
        }
        let place = sine * (self.table.len() - 1) as f64;
        let i = (place as usize).min(self.table.len() - 2);
        let hertz = self.table[i] + (self.table[i + 1] - self.table[i]) * (place - i as f64);
        let t = ((sine - PARALLEL[0]) / (PARALLEL[1] - PARALLEL[0])).min(1.0);
        LINE + (hertz - LINE) * t * t * (3.0 - 2.0 * t)
    }
}

/// ½ √(sin τ) F₂^(−3/2) (-).
fn hertz_stiffness(sine: f64) -> f64 {
    // F₂ = (2/π) √(b/a) K/F₁ and F₁³ = 4/(πe²) (b/a)^(3/2) √{[(a/b)²E − K][K − E]}.
    let parts = |slim: f64| {
        let [k, e] = complete_elliptic(slim);
        (k, e / (slim * slim) - k, k - e)
    };
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let ratio = (1.0 + cosine) / (1.0 - cosine);
    if ratio <= 1.0 + 1e-9 {
        return 0.5;
    }
    let (mut low, mut high) = (1e-9f64, 1.0 - 1e-9);
    for _ in 0..100 {
        let slim = (low * high).sqrt();
        let (_, above, below) = parts(slim);
        if above / below > ratio { low = slim } else { high = slim }
    }
    let slim = (low * high).sqrt();
    let (k, above, below) = parts(slim);
    let f1 = (4.0 / (PI * (1.0 - slim * slim)) * slim.powf(1.5) * (above * below).sqrt()).cbrt();
    0.5 * sine.sqrt() * (FRAC_2_PI * slim.sqrt() * k / f1).powf(-1.5)
}

/// Complete elliptic integrals K and E of modulus √(1 − slim²) by the arithmetic-geometric mean (DLMF 19.8).
fn complete_elliptic(slim: f64) -> [f64; 2] {
    let (mut a, mut b) = (1.0, slim);
    let mut sum = 0.5 * (1.0 - slim * slim);
    let mut power = 1.0;
    for _ in 0..40 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
        if c < 1e-17 {
            break;
        }
    }
    let k = FRAC_PI_2 / a;
    [k, k * (1.0 - sum)]
}

/// How a stretch of one wire lies against the other: overlap δ(x) = δ₀ + m x − κ x²/2 around its deepest place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Reduced radius R* of the two circular sections (m).
    pub reduced_radius: f64,
    /// Stiffness per length k (Pa).
    pub stiffness: f64,
    /// Overlap at the deepest place δ₀ (m).
    pub overlap: f64,
    /// Slope m of the overlap there (-); not 0 at an end only.
    pub slope: f64,
    /// Curvature κ of the gap (1/m).
    pub curvature: f64,
    /// Where the stretch begins and ends, from the deepest place (m).
    pub ends: [f64; 2],
}

/// What a law answers for a stretch.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LineResponse {
    /// Repulsive force, never negative (N).
    pub force: f64,
    /// Elastic stiffness: k times the length that pushes (N/m).
    pub stiffness: f64,
    /// Where the force acts, from the deepest place (m).
    pub centre: f64,
    /// Area over which it acts (m²), in the geometric sense of Thornton's law: Σ √(2R*δ) ds.
    pub area: f64,
    /// Elastic energy (J).
    pub energy: f64,
    /// Plastic work since the last call (J).
    pub plastic_work: f64,
}

/// Nodes and weights of the Gauss-Legendre rule with four points on [−1, 1].
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// The last two coefficients of the force per length beyond yield, 2√x − 1/(3√x) − x^(−3/2)/20 − c x^(−5/2) − d x^(−9/2):
/// the first three are those of its series, these two make force and slope continuous at yield. Within 0.8 % of the
/// closed form everywhere.
const BEYOND: [f64; 2] = [-0.061_356_565_352_632_15, 0.107_226_905_224_402_29];

/// Force per length over k δ_y at overlap x δ_y on the limit (-).
#[inline(always)]
fn limit<R: Real>(x: R) -> R {
    let one = x.splat(1.0);
    let inverse_root = x.simd_max(one).inverse_sqrt();
    let (root, y) = (x * inverse_root, inverse_root * inverse_root);
    let [c, d] = BEYOND;
    let series = y * y.mul_add(y.mul_add((y * y).mul_add(y.splat(d), y.splat(c)), y.splat(0.05)), y.splat(1.0 / 3.0));
    R::select(x.simd_gt(one), root * FRAC_2_PI * (y.splat(2.0) - series), x)
}

/// Plastic work per length over k δ_y² done on the way to x along the limit (-): ∫ f dδ − f²/(2k).
#[inline(always)]
fn plastic_work(x: f64) -> f64 {
    if x <= 1.0 {
        return 0.0;
    }
    let [c, d] = BEYOND;
    let integral = |x: f64| {
        let (root, y) = (x.sqrt(), 1.0 / x);
        FRAC_2_PI * root * (4.0 / 3.0 * x - 2.0 / 3.0 + y * (0.1 + y * (2.0 / 3.0 * c + y * y * (2.0 / 7.0) * d)))
    };
    let force = limit(x);
    0.5 + integral(x) - integral(1.0) - 0.5 * force * force
}

/// The overlap over δ_y at which the limit is `force` k δ_y (-), a little below it: from f ≈ (2/π)(2√x − 1/(3√x)).
#[inline(always)]
fn limit_reached(force: f64) -> f64 {
    if force <= 1.0 {
        return force;
    }
    let (slope, fall) = (2.0 * FRAC_2_PI, FRAC_2_PI / 3.0);
    let root = (force + (force * force + 4.0 * slope * fall).sqrt()) / (2.0 * slope);
    (root * root).max(1.0)
}

/// Response of a stretch whose deepest place has been as deep as `greatest` (m) (updated) under a limiting pressure
/// `pressure` (Pa), infinite for elastic wires.
#[inline(always)]
pub fn respond(stretch: &Stretch, pressure: f64, greatest: &mut f64) -> LineResponse {
    let Stretch { reduced_radius, stiffness: k, overlap, slope, curvature, ends } = *stretch;
    let ratio = PI * pressure / k;
    let yield_overlap = 0.125 * ratio * ratio * reduced_radius;
    let before = *greatest;
    let elastic = yield_overlap.is_infinite();
    if !elastic {
        *greatest = before.max(overlap);
    }
    // What the stretch has come back from its deepest.
    let back = if elastic { 0.0 } else { *greatest - overlap };
    let inverse = if elastic { 0.0 } else { 1.0 / yield_overlap };
    // Places that lie in their dent do not push.
    let dent = (limit_reached(back * inverse) * yield_overlap.min(f64::MAX) - back).max(0.0);
    let above = overlap - dent;
    if above <= 0.0 {
        return LineResponse::default();
    }
    let [from, to] = edges(above, slope, curvature);
    let (from, to) = (from.max(ends[0]), to.min(ends[1]));
    let half = 0.5 * (to - from);
    if half <= 0.0 {
        return LineResponse::default();
    }
    let middle = 0.5 * (from + to);
    let loads = overlap > before;
    let mut sum = LineResponse { stiffness: 2.0 * half * k, ..LineResponse::default() };
    for [node, weight] in GAUSS {
        let x = middle + half * node;
        let weight = half * weight;
        let depth = (overlap + x * (slope - 0.5 * curvature * x)).max(0.0);
        let force = if elastic {
            k * depth
        } else {
            let deepest = (depth + back) * inverse;
            if loads {
                let earlier = deepest - (overlap - before.max(0.0)) * inverse;
                let unit = k * yield_overlap * yield_overlap;
                sum.plastic_work += weight * unit * (plastic_work(deepest) - plastic_work(earlier));
            }
            k * (limit(deepest) * yield_overlap - back).max(0.0)
        };
        sum.force += weight * force;
        sum.centre += weight * force * x;
        sum.energy += weight * 0.5 * force * force / k;
        sum.area += weight * (2.0 * reduced_radius * depth).sqrt();
    }
    sum.centre = if sum.force > 0.0 { sum.centre / sum.force } else { 0.0 };
    sum
}

/// Where D + m x − κ x²/2 becomes 0 to either side of x = 0, for D > 0; infinite where it never does.
#[inline(always)]
fn edges(depth: f64, slope: f64, curvature: f64) -> [f64; 2] {
    let square = slope * slope + 2.0 * curvature * depth;
    if square < 0.0 {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let root = square.sqrt();
    let edge = |divisor: f64| if divisor > 0.0 { 2.0 * depth / divisor } else { f64::INFINITY };
    [-edge(root + slope), edge(root - slope)]
}

/// Cells into which a stretch beside another wire is cut. Each is a spring at a fixed place with a dent of its own, so
/// that the force is the gradient of what is stored, whatever way the two wires tilt against each other.
pub const CELLS: usize = 8;

/// How the cells of a stretch lie: overlap δ(u) = δ₀ − a u − ½ b u² at u bonds from where the gap was expanded.
#[derive(Debug, Clone, Copy)]
pub struct CellGap<R> {
    /// Reduced radius R* (m).
    pub reduced_radius: R,
    /// Stiffness per length k (Pa).
    pub stiffness: R,
    /// δ₀ (m).
    pub overlap: R,
    /// a (m).
    pub rise: R,
    /// b (m).
    pub bend: R,
    /// Where the first cell begins, and the length of a cell, in bonds (-).
    pub first: R,
    /// See `first`.
    pub width: R,
    /// Length of a cell along the undeformed wire (m); force is counted per this length.
    pub length: R,
}

impl<R: Real> CellGap<R> {
    /// Where the middle of cell `q` lies, in bonds (-).
    #[inline(always)]
    pub fn place(&self, q: usize) -> R {
        self.width.mul_add(self.width.splat(q as f64 + 0.5), self.first)
    }

    /// Overlap there (m).
    #[inline(always)]
    pub fn depth(&self, u: R) -> R {
        self.overlap - u * (self.bend * 0.5).mul_add(u, self.rise)
    }

    /// Overlap at first yield δ_y (m) under a limiting pressure (Pa).
    #[inline(always)]
    fn yield_overlap(&self, pressure: f64) -> R {
        let ratio = self.stiffness.inverse() * (PI * pressure);
        ratio * ratio * self.reduced_radius * 0.125
    }
}

/// What the cells of a stretch answer.
#[derive(Debug, Clone, Copy)]
pub struct CellResponse<R> {
    /// Moments ∫ f uⁿ ds of the force per length, n = 0, 1, 2 (N); the first is the force.
    pub moments: [R; 3],
    /// Elastic stiffness: k times the length that pushes (N/m).
    pub stiffness: R,
    /// Elastic energy (J).
    pub energy: R,
    /// Plastic work since the last call (J).
    pub plastic_work: R,
}

/// Response of the cells of a stretch that have been as deep as `greatest` (m) (updated); `share` says what part of each
/// counts.
///
/// On the way back from δ_m the force per length is f_m − k (δ_m − δ), so that the dent δ_p = δ_m − f_m/k does not push;
/// when δ_m grows, f dδ_p is lost.
#[inline(always)]
pub fn respond_cells<R: Real>(
    gap: &CellGap<R>,
    pressure: f64,
    share: &[R; CELLS],
    greatest: &mut [R; CELLS],
) -> CellResponse<R> {
    let k = gap.stiffness;
    let zero = k.splat(0.0);
    let mut sum = CellResponse { moments: [zero; 3], stiffness: zero, energy: zero, plastic_work: zero };
    let compliance = k.inverse();
    let elastic = pressure.is_infinite();
    let (mut limit_overlap, mut inverse) = (zero, zero);
    if !elastic {
        limit_overlap = gap.yield_overlap(pressure);
        inverse = limit_overlap.inverse();
    }
    for q in 0..CELLS {
        let u = gap.place(q);
        let depth = gap.depth(u);
        let length = gap.length * share[q];
        let before = greatest[q];
        let after = before.simd_max(depth);
        let mut above = depth.simd_max(zero);
        if !elastic {
            greatest[q] = after;
            let yielded = after.simd_gt(limit_overlap);
            if yielded.any() {
                // Both over k.
                let (first, last) = (limit(before * inverse) * limit_overlap, limit(after * inverse) * limit_overlap);
                let dent = R::select(yielded, (after - before) - (last - first), zero);
                sum.plastic_work = (length * k * (first + last) * 0.5).mul_add(dent, sum.plastic_work);
                above = R::select(yielded, (last - (after - depth)).simd_max(zero), above);
            }
        }
        let force = above * k;
        let push = length * force;
        let along = push * u;
        sum.moments = [sum.moments[0] + push, sum.moments[1] + along, along.mul_add(u, sum.moments[2])];
        sum.energy = (push * force * 0.5).mul_add(compliance, sum.energy);
        sum.stiffness += R::select(force.simd_gt(zero), length * k, zero);
    }
    sum
}

/// Greatest length of a patch of depth `overlap` (m) within a stretch of `length` (m), where the gap has the curvature
/// `curvature` (1/m).
pub fn patch_length(overlap: f64, curvature: f64, length: f64) -> f64 {
    if curvature > 0.0 { length.min(2.0 * (2.0 * overlap.max(0.0) / curvature).sqrt()) } else { length }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::contact::NormalLaw;
    use crate::law::contact::hertz::Hertz;
    use crate::law::contact::thornton::Thornton;
    use proptest::prelude::*;
    use std::sync::LazyLock;

    const MODULUS: f64 = 65e9;
    /// Of two wires of 0.4 mm.
    const RADIUS: f64 = 0.1e-3;

    fn near(value: f64, expected: f64, tolerance: f64) {
        assert!((value / expected - 1.0).abs() <= tolerance, "{value} is not {expected}");
    }

    static TABLE: LazyLock<LineStiffness> = LazyLock::new(LineStiffness::default);

    /// A patch of wires that cross at `angle` (rad), wholly within the stretch.
    fn crossing(angle: f64, overlap: f64) -> Stretch {
        let curvature = angle.sin().powi(2) / (4.0 * RADIUS);
        let stiffness = MODULUS * TABLE.at(RADIUS, curvature);
        Stretch { reduced_radius: RADIUS, stiffness, overlap, slope: 0.0, curvature, ends: [-1.0, 1.0] }
    }

    /// F₂ for a/b = 1, 2.07, 5.54, 21.26 (axes of the ellipses of cylinders that cross at 90, 60, 30, 10 degrees) from
    /// the table of E and K in Abramowitz & Stegun, 17.
    #[test]
    fn stiffness_is_that_of_hertz_ellipses_and_of_the_line() {
        let table = &TABLE;
        for (degrees, f2) in [(90.0f64, 1.0f64), (60.0, 0.98364), (30.0, 0.91509), (10.0, 0.76718), (2.0, 0.54871)] {
            let sine = degrees.to_radians().sin();
            near(table.at(RADIUS, sine * sine / (4.0 * RADIUS)), 0.5 * sine.sqrt() * f2.powf(-1.5), 1e-3);
        }
        for curvature in [-10.0, 0.0, 0.1] {
            assert_eq!(table.at(RADIUS, curvature), LINE);
        }
        // δ = f/(πE*) (2 ln(4r/b) − 1) at b/r = 0.013.
        near(LINE, PI / (2.0 * (4.0f64 / 0.013).ln() - 1.0), 0.01);
    }

    /// Between 1° and 2° the line passes to the ellipse without a jump, half way in the middle.
    #[test]
    fn the_line_passes_smoothly_to_the_ellipse() {
        let at = |sine: f64| TABLE.at(RADIUS, sine / (4.0 * RADIUS) * sine);
        let within = |part: f64| PARALLEL[0] + part * (PARALLEL[1] - PARALLEL[0]);
        near(at(within(1e-9)), LINE, 1e-9);
        for (part, weight) in [(0.25, 0.156_25), (0.5, 0.5), (0.75, 0.843_75), (1.0, 1.0)] {
            let sine = within(part);
            near(at(sine), LINE + weight * (hertz_stiffness(sine) - LINE), 1e-3);
        }
    }

    #[test]
    fn a_round_patch_is_hertz_and_beyond_yield_thornton() {
        let right = std::f64::consts::FRAC_PI_2;
        let hertz = Hertz { effective_modulus: MODULUS };
        // Crossed wires of radius r are a ball of radius r on a plane: twice R*.
        let ball = 2.0 * RADIUS;
        for overlap in [1e-9, 1e-6, 2e-5] {
            let line = respond(&crossing(right, overlap), hertz.limiting_pressure(), &mut 0.0);
            near(line.force, hertz.response(&mut (), ball, overlap).force, 1e-12);
            near(line.stiffness, hertz.response(&mut (), ball, overlap).stiffness, 1e-12);
            near(line.energy, hertz.elastic_energy(&(), ball, overlap), 1e-12);
        }
        let law = Thornton { effective_modulus: MODULUS, limiting_pressure: 1e9 };
        let at = law.yield_overlap(ball);
        for multiple in [0.5, 0.99, 1.5, 3.0, 10.0, 1e3, 1e5] {
            let line = respond(&crossing(right, multiple * at), law.limiting_pressure(), &mut 0.0);
            near(line.force, law.response(&mut Default::default(), ball, multiple * at).force, 1.5e-2);
        }
    }

    #[test]
    fn the_limit_is_that_of_the_closed_form_and_smooth_at_yield() {
        for i in 1..400 {
            let x = 1.0 + 0.02 * f64::from(i * i) / 40.0;
            let exact = FRAC_2_PI * (x * (1.0 / x.sqrt()).asin() + (x - 1.0f64).sqrt());
            near(limit(x), exact, 8e-3);
            // The plastic work is ∫ f dδ − f²/2k.
            let h = 1e-4 * x;
            let slope = (plastic_work(x + h) - plastic_work(x - h)) / (2.0 * h);
            let rate = limit(x) * (1.0 - (limit(x + h) - limit(x - h)) / (2.0 * h));
            assert!((slope - rate).abs() < 1e-5 * limit(x), "at {x}: {slope} {rate}");
            let found = limit_reached(limit(x)) / x;
            assert!((0.94..=1.0 + 1e-12).contains(&found), "at {x}: {found}");
        }
        near(limit(1.0 + 1e-9), 1.0, 1e-8);
    }

    /// A patch cut into pieces carries what the whole one does.
    #[test]
    fn a_patch_may_be_shared_by_stretches() {
        for (angle, pressure) in [(0.05, f64::INFINITY), (0.3, f64::INFINITY), (0.05, 4e8), (1.2, 4e8)] {
            let whole = crossing(angle, 3e-6);
            let force = respond(&whole, pressure, &mut 0.0).force;
            let half = (2.0 * whole.overlap / whole.curvature).sqrt();
            for cut in [-0.9f64, -0.4, 0.0, 0.3] {
                // Each piece with its own deepest place: the vertex, or the cut.
                let at = cut * half;
                let side = |from: f64, to: f64| {
                    let deepest = 0.0f64.clamp(from, to);
                    let overlap = whole.overlap - 0.5 * whole.curvature * deepest * deepest;
                    let slope = -whole.curvature * deepest;
                    respond(
                        &Stretch { overlap, slope, ends: [from - deepest, to - deepest], ..whole },
                        pressure,
                        &mut 0.0,
                    )
                };
                let (left, right) = (side(-1.0, at), side(at, 1.0));
                near(left.force + right.force, force, if pressure.is_finite() { 1e-2 } else { 1e-12 });
            }
        }
    }

    /// Cells of wires side by side, crossing at a small angle.
    fn cells(overlap: f64, greatest: &mut [f64; CELLS]) -> CellResponse<f64> {
        let bend = 0.05f64.sin().powi(2) / (4.0 * RADIUS) * 0.4e-3 * 0.4e-3;
        let gap = CellGap {
            reduced_radius: RADIUS,
            stiffness: MODULUS * LINE,
            overlap,
            rise: 0.0,
            bend,
            first: -0.5,
            width: 1.0 / CELLS as f64,
            length: 0.4e-3 / CELLS as f64,
        };
        respond_cells(&gap, 4e8, &[1.0; CELLS], greatest)
    }

    #[test]
    fn cells_add_up_to_a_patch() {
        let stretch = |overlap: f64| Stretch {
            reduced_radius: RADIUS,
            stiffness: MODULUS * LINE,
            overlap,
            slope: 0.0,
            curvature: 0.05f64.sin().powi(2) / (4.0 * RADIUS),
            ends: [-0.2e-3, 0.2e-3],
        };
        for overlap in [0.3e-6, 1e-6, 4e-6] {
            let whole = respond(&stretch(overlap), 4e8, &mut 0.0).force;
            near(cells(overlap, &mut [0.0; CELLS]).moments[0], whole, 2e-2);
        }
    }

    #[test]
    fn what_cells_lose_is_the_work_done_on_them() {
        let turns = [0.0, 2e-6, 1.5e-6, 3e-6, 0.0, 3e-6, 4e-6, 0.0];
        let (mut dents, mut work, mut plastic, mut before) = ([0.0; CELLS], 0.0, 0.0, 0.0);
        for pair in turns.windows(2) {
            let steps = 2000;
            let step = (pair[1] - pair[0]) / f64::from(steps);
            for i in 1..=steps {
                let answer = cells(pair[0] + f64::from(i) * step, &mut dents);
                work += 0.5 * (before + answer.moments[0]) * step;
                plastic += answer.plastic_work;
                before = answer.moments[0];
                assert!((work - plastic - answer.energy).abs() < 1e-5 * work.max(1e-6), "{work} {plastic} {answer:?}");
            }
        }
        assert_eq!(before, 0.0);
    }

    #[test]
    fn on_the_way_back_a_dent_does_not_push_and_energy_is_the_work() {
        let mut state = 0.0;
        let turns = [0.0, 2e-6, 1.9e-6, 3e-6, 0.0, 3e-6, 4e-6, 0.0];
        let (mut work, mut plastic, mut before) = (0.0, 0.0, 0.0);
        for pair in turns.windows(2) {
            let steps = 20_000;
            let step = (pair[1] - pair[0]) / f64::from(steps);
            for i in 1..=steps {
                let overlap = pair[0] + f64::from(i) * step;
                let answer = respond(&crossing(0.2, overlap), 4e8, &mut state);
                assert!(answer.plastic_work >= 0.0 && answer.force >= 0.0);
                work += 0.5 * (before + answer.force) * step;
                plastic += answer.plastic_work;
                before = answer.force;
            }
        }
        assert_eq!((before, state), (0.0, 4e-6));
        near(plastic, work, 1e-2);
        // On the way back the stiffness is the slope of the force, of the length that still pushes.
        let back = |overlap: f64| respond(&crossing(0.2, overlap), 4e8, &mut state.clone());
        let slope = (back(3.8e-6 + 1e-9).force - back(3.8e-6 - 1e-9).force) / 2e-9;
        near(back(3.8e-6).stiffness, slope, 0.05);
        let dent = respond(&crossing(0.2, 3.4e-6), 4e8, &mut state.clone());
        assert_eq!(dent.force, 0.0, "what has sprung back no longer touches");
    }

    proptest! {
        #[test]
        fn the_force_is_continuous_and_never_pulls(
            overlap in 1e-9..1e-5f64, slope in -0.01..0.01f64, curvature in -5.0..2000.0f64, back in 0.0..1e-6f64,
        ) {
            let ends = [-0.2e-3, 0.2e-3];
            let answer = |overlap: f64| {
                let stiffness = MODULUS * LINE;
                let stretch = Stretch { reduced_radius: RADIUS, stiffness, overlap, slope, curvature, ends };
                respond(&stretch, 5e8, &mut (overlap + back))
            };
            let (here, there) = (answer(overlap), answer(overlap * (1.0 + 1e-7)));
            prop_assert!(here.force >= 0.0 && here.energy >= 0.0 && here.centre.abs() <= 0.2e-3);
            prop_assert!((here.force - there.force).abs() <= 1e-3 * here.force.max(1e-6), "{here:?} {there:?}");
        }
    }
}
