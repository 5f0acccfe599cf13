//! Oblique impact of elastic spheres with friction.
//!
//! Source: Maw, Barber & Fawcett, Wear 38 (1976) 101, and J. Lubr. Technol. 103 (1981) 74. Angles are written as there:
//! ψ = κ tan α/μ with tan α the tangential over the normal velocity of the contact (rolling and spin included),
//! κ = 2(1 − ν)/(2 − ν), and χ = κ (1 + 1/k²)/2, k² = I/(m R²).
//!
//! Their contact circle of annuli, each sticking or slipping on its own, is computed here in its one-dimensional image
//! (Lyashenko & Popov, Sci. Rep. 5 (2015) 8479, who show that it gives the curves of Maw, Barber & Fawcett): springs at
//! x with normal load E*(d − x²/R) and tangential stiffness κ E* per length, held to μ times their load. It makes the
//! same approximation, the mean of the tangential compliance over directions, and no other.

/// Spheres of one elastic material with a moment of inertia I = k² m R².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheres {
    /// Poisson's ratio ν (-).
    pub poisson: f64,
    /// k² = I/(m R²) (-); 2/5 for a solid sphere.
    pub gyration: f64,
}

impl Spheres {
    /// κ = 2(1 − ν)/(2 − ν), tangential over normal stiffness of the contact (-).
    pub fn stiffness_ratio(&self) -> f64 {
        2.0 * (1.0 - self.poisson) / (2.0 - self.poisson)
    }

    /// χ = κ (1 + 1/k²)/2 (-).
    pub fn chi(&self) -> f64 {
        0.5 * self.stiffness_ratio() * (1.0 + 1.0 / self.gyration)
    }

    /// ψ₁ from which on the whole contact slides all the time, 4χ − 1 (-).
    pub fn sliding_from(&self) -> f64 {
        4.0 * self.chi() - 1.0
    }

    /// ψ₂ of rigid bodies that slide throughout, ψ₁ − 4χ (-): friction takes μ times the normal impulse.
    pub fn sliding(&self, psi1: f64) -> f64 {
        psi1 - 4.0 * self.chi()
    }

    /// ψ₂ after an impact at ψ₁ = `psi1` ≥ 0 (-), for the elastic contact resolved by `springs` springs over its
    /// greatest radius.
    ///
    /// In units of the greatest overlap d, of the time d/v_n and of the displacement μ d/κ: δ″ = −(5/4) δ^(3/2),
    /// s″ = −(15/8) χ F with F = 2 Σ f Δx, each f following s between −(δ − x²) and δ − x².
    pub fn rebound(&self, psi1: f64, springs: usize) -> f64 {
        let mut contact = Springs::new(springs);
        let dt = 0.1 / springs as f64;
        let (mut depth, mut rate, mut slip_rate) = (0.0f64, 1.0f64, psi1);
        while depth >= 0.0 {
            rate -= dt * 1.25 * depth.powf(1.5);
            slip_rate -= dt * 1.875 * self.chi() * contact.pull();
            depth += dt * rate;
            contact.advance(depth, dt * slip_rate);
        }
        slip_rate
    }

    /// ψ₂ after an impact at ψ₁ = `psi1` ≥ 0 (-) of a contact that is one spring of the no-slip stiffness 8G*a: it sticks
    /// or slides as a whole and, as the normal force falls, keeps a/a_before of its pull (the law `mindlin`, not the
    /// elastic theory). `steps` over the greatest overlap's time.
    ///
    /// In the units of [`Spheres::rebound`], of which this is the sum over the springs: stiffness 2√δ, at most
    /// (4/3) δ^(3/2).
    pub fn rebound_of_one_spring(&self, psi1: f64, steps: usize) -> f64 {
        let dt = 1.0 / steps as f64;
        let (mut depth, mut rate, mut slip_rate, mut pull) = (0.0f64, 1.0f64, psi1, 0.0f64);
        loop {
            rate -= dt * 1.25 * depth.powf(1.5);
            slip_rate -= dt * 1.875 * self.chi() * pull;
            let before = depth;
            depth += dt * rate;
            if depth <= 0.0 {
                return slip_rate;
            }
            if depth < before {
                pull *= (depth / before).sqrt();
            }
            let limit = 4.0 / 3.0 * depth.powf(1.5);
            pull = (pull + 2.0 * depth.sqrt() * dt * slip_rate).clamp(-limit, limit);
        }
    }

    /// Tangential impulse over μ times the normal one, (ψ₁ − ψ₂)/(4χ) (-).
    pub fn impulse(&self, psi1: f64, psi2: f64) -> f64 {
        (psi1 - psi2) / (4.0 * self.chi())
    }
}

/// The contact as a row of springs, in the units of [`Spheres::rebound`]; one half, the other is its mirror image.
struct Springs {
    force: Vec<f64>,
}

impl Springs {
    fn new(count: usize) -> Self {
        Self { force: vec![0.0; count] }
    }

    /// Goes to `depth` and slips by `slip`.
    fn advance(&mut self, depth: f64, slip: f64) {
        let width = 1.0 / self.force.len() as f64;
        for (k, force) in self.force.iter_mut().enumerate() {
            let load = (depth - ((k as f64 + 0.5) * width).powi(2)).max(0.0);
            *force = (*force + slip).clamp(-load, load);
        }
    }

    /// Sum of the tangential forces.
    fn pull(&self) -> f64 {
        2.0 * self.force.iter().sum::<f64>() / self.force.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOLID: Spheres = Spheres { poisson: 0.3, gyration: 0.4 };

    /// χ = 1.441 for the steel spheres of the source.
    #[test]
    fn parameters_of_the_source() {
        assert!((SOLID.chi() - 1.4412).abs() < 1e-4);
        assert!((SOLID.stiffness_ratio() - 0.8235).abs() < 1e-4);
    }

    #[test]
    fn it_slides_throughout_from_the_stated_angle_on() {
        for psi1 in [SOLID.sliding_from(), 6.0, 9.0] {
            assert!((SOLID.rebound(psi1, 400) - SOLID.sliding(psi1)).abs() < 2e-3, "{psi1}");
        }
        assert!(SOLID.rebound(SOLID.sliding_from() - 0.5, 400) > SOLID.sliding(SOLID.sliding_from() - 0.5) + 1e-2);
    }

    /// Where sliding throughout begins the contact point rebounds at ψ₂ = −1; it never rebounds faster than it came.
    #[test]
    fn it_never_rebounds_faster_than_it_came() {
        let most = SOLID.rebound(SOLID.sliding_from(), 400);
        assert!((most + 1.0).abs() < 2e-3, "{most}");
        for i in 1..40 {
            let psi1 = 0.2 * i as f64;
            let psi2 = SOLID.rebound(psi1, 200);
            assert!(psi2.abs() < psi1, "{psi1}: {psi2}");
        }
    }

    /// Held at the greatest depth, the row of springs is Cattaneo's and Mindlin's contact: with the full load 4/3 and
    /// the stiffness 2, F = (4/3) [1 − (1 − s)^(3/2)] and sliding from s = 1 on.
    #[test]
    fn under_constant_load_the_springs_are_mindlins_contact() {
        let mut springs = Springs::new(4000);
        for i in 1..=120 {
            springs.advance(1.0, 0.01);
            let exact = 4.0 / 3.0 * (1.0 - (1.0 - 0.01 * i as f64).max(0.0).powf(1.5));
            assert!((springs.pull() - exact).abs() < 1e-5, "{i}");
        }
        springs.advance(1.0, -0.6);
        let unloaded = 4.0 / 3.0 * (1.0 - 2.0 * (1.0 - 0.7f64.powf(1.5)));
        assert!((springs.pull() - unloaded).abs() < 1e-5, "unloading by Masing's rule");
    }

    /// One spring that slides throughout is the sliding contact; it converges.
    #[test]
    fn one_spring_slides_and_converges() {
        for psi1 in [SOLID.sliding_from() + 1.0, 9.0] {
            assert!((SOLID.rebound_of_one_spring(psi1, 4000) - SOLID.sliding(psi1)).abs() < 5e-3, "{psi1}");
        }
        for psi1 in [0.25, 1.0, 3.0] {
            let at = |steps| SOLID.rebound_of_one_spring(psi1, steps);
            assert!((at(4000) - at(16_000)).abs() < 5e-3, "{psi1}");
        }
    }

    #[test]
    fn it_converges() {
        let at = |springs| SOLID.rebound(1.7, springs);
        let fine = at(1600);
        assert!((at(400) - fine).abs() < 1e-3 && (at(200) - fine).abs() < 2.5e-3);
    }
}
