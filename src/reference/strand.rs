//! Strand theory: stiffness and strength of a strand from its geometry, ends not turning, no friction.
//!
//! Source: Hruska, Wire and Wire Products 26 (1951) 766; Costello, *Theory of Wire Rope*, 2nd ed. 1997, chapter 3.

use crate::reference::helix::lay_angle;

/// One layer of equal wires, as strand theory sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Number of wires n.
    pub wires: usize,
    /// Wire diameter d [m].
    pub diameter: f64,
    /// Lay radius R [m]; 0 for a core wire.
    pub radius: f64,
    /// Pitch h [m]; infinite when straight.
    pub pitch: f64,
}

impl Layer {
    /// Lay angle β [rad].
    pub fn lay_angle(&self) -> f64 {
        lay_angle(self.radius, self.pitch)
    }

    /// What a wire's shear force adds to its share of the strand's force, over E A and per unit of strand strain [-],
    /// when the lay radius changes by `radius` ΔR/R [-]: sin β N′/(E A) with N′ = H κ − G′ τ, G′ = E I Δκ,
    /// H = G J Δτ (Costello 1997, chapter 3).
    fn bending_share(&self, radius: f64, poisson: f64) -> f64 {
        if self.radius == 0.0 {
            return 0.0;
        }
        let (sin, cos) = self.lay_angle().sin_cos();
        let curvature = sin * sin / self.radius;
        let torsion = sin * cos / self.radius;
        // Ends not turning: tan β goes as R/(1 + ε).
        let turn = -sin * cos * (1.0 - radius);
        let curvature_change = 2.0 * torsion * turn - curvature * radius;
        let torsion_change = (cos * cos - sin * sin) * turn / self.radius - torsion * radius;
        // I/A = d²/16, and G J = E I/(1 + ν) for a round section.
        let gyration = self.diameter.powi(2) / 16.0;
        let shear = torsion_change / (1.0 + poisson) * curvature - curvature_change * torsion;
        sin * gyration * shear
    }

    /// Share in the strand's section, n d² up to a common factor.
    fn weight(&self) -> f64 {
        self.wires as f64 * self.diameter.powi(2)
    }
}

/// Exact axial strain of a helical wire, √((1 + ε)² cos²β + (R′/R)² sin²β) − 1 [-], when the strand is stretched by
/// `strain` ε [-] without turning and the lay radius becomes R′ = `contraction` R ([-], 1 when the radius stays).
/// `lay_angle` is β [rad].
pub fn wire_strain(strain: f64, lay_angle: f64, contraction: f64) -> f64 {
    let along = (1.0 + strain) * lay_angle.cos();
    let around = contraction * lay_angle.sin();
    along.hypot(around) - 1.0
}

/// E_strand/E when the lay radii stay: Σ n A cos³β/Σ n A [-] (Hruska 1951).
pub fn stiffness_factor(layers: &[Layer]) -> f64 {
    mean_over_section(layers, |_, layer| layer.lay_angle().cos().powi(3))
}

/// E_strand/E when wires thin by Poisson's ratio `poisson` ν [-] and each layer, listed from the inside out, rests on
/// the one below; the wires' own bending and torsion are counted [-] (Costello 1997, chapter 3).
pub fn stiffness_factor_contracting(layers: &[Layer], poisson: f64) -> f64 {
    let responses = contracting_responses(layers, poisson);
    mean_over_section(layers, |i, layer| {
        let response = responses[i];
        response.strain * layer.lay_angle().cos() + layer.bending_share(response.radius, poisson)
    })
}

/// What a layer's wires do per unit of strand strain, ends not turning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Axial strain of a wire [-].
    pub strain: f64,
    /// Relative change of the lay radius, ΔR/R [-]; 0 for a core wire.
    pub radius: f64,
}

/// Response of each layer, from the inside out, to unit strand strain, when wires thin by Poisson's ratio `poisson` ν
/// and each layer rests on the one below.
///
/// Wire strain x = cos²β + (ΔR/R) sin²β, with ΔR = ΔR_below − ν (x_below d_below + x d)/2; the bore of a strand without a
/// core wire keeps its radius (Costello 1997, linearised, for hollow and cored strands alike).
pub fn contracting_responses(layers: &[Layer], poisson: f64) -> Vec<Response> {
    // Inward motion of the surface that the next layer rests on, per unit of strand strain [m].
    let mut inward = 0.0;
    layers
        .iter()
        .map(|layer| {
            let thinning = poisson * layer.diameter / 2.0;
            if layer.radius == 0.0 {
                // A core wire's centre does not move; its surface does by half its thinning.
                inward = thinning;
                return Response { strain: 1.0, radius: 0.0 };
            }
            let (sin, cos) = layer.lay_angle().sin_cos();
            // x = cos²β − (inward + thinning x)/R sin²β, solved for x.
            let turn = sin * sin / layer.radius;
            let strain = (cos * cos - inward * turn) / (1.0 + thinning * turn);
            let radius = -(inward + thinning * strain) / layer.radius;
            inward += 2.0 * thinning * strain;
            Response { strain, radius }
        })
        .collect()
}

/// Nominal strength of the strand over that of its wires when all of them reach it together: Σ n A cos β/Σ n A [-].
pub fn strength_factor(layers: &[Layer]) -> f64 {
    mean_over_section(layers, |_, layer| layer.lay_angle().cos())
}

/// Strain of the strand [-] at which the most strained of its wires is stretched by `wire` [-], its elongation at fracture,
/// when the strand keeps its volume, so that lay radii go as 1/√(1 + ε), and does not turn.
pub fn elongation(layers: &[Layer], wire: f64) -> f64 {
    let greatest = |strain: f64| {
        let contraction = 1.0 / (1.0 + strain).sqrt();
        layers.iter().map(|layer| wire_strain(strain, layer.lay_angle(), contraction)).fold(f64::MIN, f64::max)
    };
    // No wire is strained more than the strand, and a strand of finite pitch hardly more than twice as much as its wires.
    let (mut low, mut high) = (wire, 2.0 * wire + 1.0);
    while greatest(high) < wire {
        high *= 2.0;
    }
    while high - low > 1e-14 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if greatest(middle) < wire { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn mean_over_section(layers: &[Layer], value: impl Fn(usize, &Layer) -> f64) -> f64 {
    let total: f64 = layers.iter().map(Layer::weight).sum();
    let sum: f64 = layers.iter().enumerate().map(|(i, layer)| layer.weight() * value(i, layer)).sum();
    sum / total
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ka4(pitch: f64) -> Vec<Layer> {
        [(5, 0.385e-3), (11, 0.775e-3), (18, 1.165e-3)]
            .into_iter()
            .map(|(wires, radius)| Layer { wires, diameter: 0.39e-3, radius, pitch })
            .collect()
    }

    /// The values printed in the physics page, section 8.
    #[test]
    fn stiffness_of_ka4_at_four_pitches() {
        for (pitch, plain, contracting) in
            [(39e-3, 0.9649, 0.9587), (44e-3, 0.9722, 0.9672), (49e-3, 0.9775, 0.9734), (54e-3, 0.9814, 0.9780)]
        {
            let layers = ka4(pitch);
            let value = stiffness_factor(&layers);
            assert!((value - plain).abs() < 5.1e-5, "{pitch}: {value}");
            let value = stiffness_factor_contracting(&layers, 0.34);
            assert!((value - contracting).abs() < 5.1e-5, "{pitch}: {value}");
        }
    }

    /// Physics page, section 9: by geometry alone the strand is 0.6 % weaker at 39 mm than at 54 mm.
    #[test]
    fn strength_from_geometry_alone() {
        let ratio = strength_factor(&ka4(39e-3)) / strength_factor(&ka4(54e-3));
        assert!((ratio - 0.9943).abs() < 1e-4, "{ratio}");
    }

    /// For small strains the exact wire strain has the slope that the linear theory uses, and layers stay in touch.
    #[test]
    fn linear_theory_is_the_slope_of_the_exact_strain() {
        let layers = ka4(39e-3);
        let responses = contracting_responses(&layers, 0.34);
        let strain = 1e-7;
        for (layer, response) in layers.iter().zip(&responses) {
            let contraction = 1.0 + response.radius * strain;
            let exact = wire_strain(strain, layer.lay_angle(), contraction) / strain;
            assert!((exact - response.strain).abs() < 1e-6, "{exact}");
        }
        for i in 0..2 {
            let gap = responses[i + 1].radius * layers[i + 1].radius - responses[i].radius * layers[i].radius;
            let thinning = 0.34 * 0.39e-3 * 0.5 * (responses[i].strain + responses[i + 1].strain);
            assert!((gap + thinning).abs() < 1e-12);
        }
        let beta = layers[2].lay_angle();
        let plain = wire_strain(strain, beta, 1.0) / strain;
        assert!((plain - beta.cos().powi(2)).abs() < 1e-6);
    }

    /// The change of curvature and torsion behind the bending share, against the helix itself stretched a little.
    #[test]
    fn bending_share_follows_the_stretched_helix() {
        use crate::reference::helix::{curvature, torsion};
        let layer = ka4(39e-3)[2];
        let (strain, radius, poisson) = (1e-6, -0.3, 0.34);
        let stretched = |f: fn(f64, f64) -> f64| {
            let moved = f(layer.radius * (1.0 + radius * strain), layer.pitch * (1.0 + strain));
            (moved - f(layer.radius, layer.pitch)) / strain
        };
        let right: fn(f64, f64) -> f64 = |r, h| torsion(r, h, 1.0);
        let shear = stretched(right) / (1.0 + poisson) * curvature(layer.radius, layer.pitch)
            - stretched(curvature) * right(layer.radius, layer.pitch);
        let expected = layer.lay_angle().sin() * layer.diameter.powi(2) / 16.0 * shear;
        let share = layer.bending_share(radius, poisson);
        assert!((share / expected - 1.0).abs() < 1e-4, "{share} {expected}");
    }

    /// Physics page, section 9: at the elongation of the experiment inner wires are strained most.
    #[test]
    fn inner_wires_are_strained_most() {
        let layers = ka4(39e-3);
        let strain = |i: usize| wire_strain(0.2694, layers[i].lay_angle(), 1.0);
        assert!(strain(0) > strain(1) && strain(1) > strain(2));
    }

    /// Physics page, section 9: if the inner wires decide, elongation falls by 0.06 points from 39 to 54 mm; if the outer
    /// ones did, by 0.5.
    #[test]
    fn elongation_falls_with_pitch() {
        let at = |pitch: f64, layers: std::ops::Range<usize>, wire: f64| elongation(&ka4(pitch)[layers], wire);
        let wire = |k: usize| wire_strain(0.2694, ka4(39e-3)[k].lay_angle(), 1.0 / 1.2694f64.sqrt());
        for (layers, k, points) in [(0..3, 0, 0.06e-2), (2..3, 2, 0.5e-2)] {
            let [short, long] = [39e-3, 54e-3].map(|pitch| at(pitch, layers.clone(), wire(k)));
            assert!((short - 0.2694).abs() < 1e-12, "{short}");
            assert!((short - long - points).abs() < 0.1 * points, "{}", short - long);
        }
        assert!((at(f64::INFINITY, 0..3, 0.3) - 0.3).abs() < 1e-12);
    }

    /// A core with straight wires around it is as stiff and strong as its wires.
    #[test]
    fn straight_wires_lose_nothing() {
        let layers =
            [(1, 0.0), (6, 1e-3)].map(|(wires, radius)| Layer { wires, diameter: 1e-3, radius, pitch: f64::INFINITY });
        assert_eq!(stiffness_factor(&layers), 1.0);
        assert_eq!(stiffness_factor_contracting(&layers, 0.34), 1.0);
        assert_eq!(strength_factor(&layers), 1.0);
    }
}
