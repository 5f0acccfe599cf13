//! Strand theory: stiffness and strength of a strand from its geometry, ends not turning, no friction.
//!
//! Source: Hruska, Wire and Wire Products 26 (1951) 766; Costello, *Theory of Wire Rope*, 2nd ed. 1997, chapter 2
//! (equilibrium of a helical wire: Love, *A Treatise on the Mathematical Theory of Elasticity*, 4th ed. 1927, chapter
//! XVIII) and chapter 3 (the straight strand).
//!
//! | what | where |
//! | --- | --- |
//! | wire strain, cos²β + (ΔR/R) sin²β | geometry of the unrolled wire, linearised ([`contracting_responses`]) |
//! | change of curvature and torsion, [`Wire::Inextensible`] | linearised κ = sin²β/R, τ = sin β cos β/R, as the textbook |
//! | the same per length before loading, [`Wire::Extensible`] | a rod that stretches: strains per reference arc (Antman, *Nonlinear Problems of Elasticity*, 2nd ed. 2005, chapter VIII) |
//! | moments G′ = EI Δκ, H = GJ Δτ, shear N′ = Hκ − G′τ | Love's equilibrium of a helix without couples along it |
//! | F = n (T cos β + N′ sin β), M = n (H cos β + G′ sin β + T R sin β − N′ R cos β) | sum of the wires' sections over the strand's |

use crate::base::bisect::bisect;
use crate::reference::helix::lay_angle;
use std::f64::consts::FRAC_PI_4;

/// One layer of equal wires, as strand theory sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Number of wires n.
    pub wires: usize,
    /// Wire diameter d (m).
    pub diameter: f64,
    /// Lay radius R (m); 0 for a core wire.
    pub radius: f64,
    /// Pitch h (m); infinite when straight.
    pub pitch: f64,
    /// Lay direction s (-): +1 right, −1 left. It turns the torque only.
    pub lay: f64,
}

/// Whether a wire's twist and curvature are counted per length as stretched or per length before loading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wire {
    /// Changes of the curve's own curvature and torsion, as textbooks on wire rope have it: a wire that is stretched and
    /// turns as before has none.
    Inextensible,
    /// A rod's strains are per length before loading: stretching a wire of curvature κ and torsion τ by x at the same
    /// curve adds κ x and τ x. This is what a wire does, and bonds do.
    Extensible,
}

/// What a strand carries per unit of its strain, ends held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Axial force over strain (N).
    pub force: f64,
    /// Torque about the axis over strain, positive where right lay would untwist (N m).
    pub torque: f64,
}

impl Layer {
    /// Lay angle β (rad).
    pub fn lay_angle(&self) -> f64 {
        lay_angle(self.radius, self.pitch)
    }

    /// What the layer's wires carry per unit of strand strain when each responds by `response`. `young` is E (Pa),
    /// `poisson` ν (-).
    pub fn wrench(&self, response: Response, young: f64, poisson: f64, wire: Wire) -> Wrench {
        let stiffness = young * self.area();
        let tension = stiffness * response.strain;
        if self.radius == 0.0 {
            return Wrench { force: tension, torque: 0.0 };
        }
        let (sin, cos) = self.lay_angle().sin_cos();
        let curvature = sin * sin / self.radius;
        let torsion = sin * cos / self.radius;
        // Ends not turning: tan β goes as R/(1 + ε).
        let turn = -sin * cos * (1.0 - response.radius);
        let per_length = match wire {
            Wire::Inextensible => 0.0,
            Wire::Extensible => response.strain,
        };
        let curvature_change = 2.0 * torsion * turn + curvature * (per_length - response.radius);
        let torsion_change = (cos * cos - sin * sin) * turn / self.radius + torsion * (per_length - response.radius);
        // I/A = d²/16, and G J = E I/(1 + ν) for a round section.
        let bending = stiffness * self.diameter.powi(2) / 16.0;
        let moment = bending * curvature_change;
        let twist = bending / (1.0 + poisson) * torsion_change;
        let shear = twist * curvature - moment * torsion;
        Wrench {
            force: tension * cos + shear * sin,
            torque: self.lay * (twist * cos + moment * sin + self.radius * (tension * sin - shear * cos)),
        }
    }

    /// Section of all its wires (m²).
    fn area(&self) -> f64 {
        FRAC_PI_4 * self.weight()
    }

    /// Share in the strand's section, n d² up to a common factor.
    fn weight(&self) -> f64 {
        self.wires as f64 * self.diameter.powi(2)
    }
}

/// Exact axial strain of a helical wire, √((1 + ε)² cos²β + (R′/R)² sin²β) − 1 (-), when the strand is stretched by
/// `strain` ε (-) without turning and the lay radius becomes R′ = `contraction` R ((-), 1 when the radius stays).
/// `lay_angle` is β (rad).
pub fn wire_strain(strain: f64, lay_angle: f64, contraction: f64) -> f64 {
    let along = (1.0 + strain) * lay_angle.cos();
    let around = contraction * lay_angle.sin();
    along.hypot(around) - 1.0
}

/// E_strand/E when the lay radii stay: Σ n A cos³β/Σ n A (-) (Hruska 1951).
pub fn stiffness_factor(layers: &[Layer]) -> f64 {
    mean_over_section(layers, |_, layer| layer.lay_angle().cos().powi(3))
}

/// Force per strain of a strand of several materials when the lay radii stay (N): Σ n A E cos³β (Hruska 1951), `young` being E
/// of each layer (Pa).
pub fn stiffness_sum(layers: &[Layer], young: &[f64]) -> f64 {
    layers.iter().zip(young).map(|(layer, young)| young * layer.area() * layer.lay_angle().cos().powi(3)).sum()
}

/// E_strand/E when wires thin by Poisson's ratio `poisson` ν (-) and each layer, listed from the inside out, rests on
/// the one below; the wires' own bending and torsion are counted as the textbook does (-) (Costello 1997, chapter 3).
pub fn stiffness_factor_contracting(layers: &[Layer], poisson: f64) -> f64 {
    elastic(layers, 1.0, poisson, Wire::Inextensible).force / area(layers)
}

/// Stiffness of an elastic strand of one material whose ends are held: `young` E (Pa), `poisson` ν (-), layers from the
/// inside out, each resting on the one below.
///
/// [`Wire::Extensible`] is what a strand should show; the textbook's formula gives 4 to 5 % less torque.
pub fn elastic(layers: &[Layer], young: f64, poisson: f64, wire: Wire) -> Wrench {
    elastic_of_materials(layers, &vec![[young, poisson]; layers.len()], wire)
}

/// [`elastic`] of layers that are each of a material of their own: [E (Pa), ν (-)].
pub fn elastic_of_materials(layers: &[Layer], materials: &[[f64; 2]], wire: Wire) -> Wrench {
    let poisson: Vec<f64> = materials.iter().map(|[_, poisson]| *poisson).collect();
    let responses = responses_of_materials(layers, &poisson);
    let zero = Wrench { force: 0.0, torque: 0.0 };
    layers.iter().zip(materials).zip(responses).fold(zero, |sum, ((layer, [young, poisson]), response)| {
        let one = layer.wrench(response, *young, *poisson, wire);
        Wrench { force: sum.force + one.force, torque: sum.torque + one.torque }
    })
}

/// Section of all wires (m²).
pub fn area(layers: &[Layer]) -> f64 {
    layers.iter().map(Layer::area).sum()
}

/// Strain of the strand (-), pulled with ends held, at which layers that lie apart have come to rest on each other: until
/// then a loose layer follows the pull by closing in and hardly carries. `gaps` are the radial gaps below each layer (m),
/// from the inside out, 0 where it rests on what is below.
///
/// A wire that carries nothing keeps its length, ε cos²β = −(ΔR/R) sin²β, and a layer moves in by its own gap and all
/// those below it.
pub fn closing_strain(layers: &[Layer], gaps: &[f64]) -> f64 {
    let mut inward = 0.0;
    layers.iter().zip(gaps).fold(0.0, |latest: f64, (layer, gap)| {
        inward += gap;
        let closed = if layer.radius > 0.0 { inward / layer.radius * layer.lay_angle().tan().powi(2) } else { 0.0 };
        latest.max(closed)
    })
}

/// What a layer's wires do per unit of strand strain, ends not turning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Axial strain of a wire (-).
    pub strain: f64,
    /// Relative change of the lay radius, ΔR/R (-); 0 for a core wire.
    pub radius: f64,
}

/// Response of each layer, from the inside out, to unit strand strain, when wires thin by Poisson's ratio `poisson` ν
/// and each layer rests on the one below.
///
/// Wire strain x = cos²β + (ΔR/R) sin²β, with ΔR = ΔR_below − ν (x_below d_below + x d)/2; the bore of a strand without a
/// core wire keeps its radius (Costello 1997, linearised, for hollow and cored strands alike).
pub fn contracting_responses(layers: &[Layer], poisson: f64) -> Vec<Response> {
    responses_of_materials(layers, &vec![poisson; layers.len()])
}

/// [`contracting_responses`] of layers with a Poisson's ratio each (-).
fn responses_of_materials(layers: &[Layer], poisson: &[f64]) -> Vec<Response> {
    // Inward motion of the surface that the next layer rests on, per unit of strand strain [m].
    let mut inward = 0.0;
    layers
        .iter()
        .zip(poisson)
        .map(|(layer, poisson)| {
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

/// Nominal strength of the strand over that of its wires when all of them reach it together: Σ n A cos β/Σ n A (-).
pub fn strength_factor(layers: &[Layer]) -> f64 {
    mean_over_section(layers, |_, layer| layer.lay_angle().cos())
}

/// Strain of the strand (-) at which the most strained of its wires is stretched by `wire` (-), its elongation at fracture,
/// when the strand keeps its volume, so that lay radii go as 1/√(1 + ε), and does not turn.
pub fn elongation(layers: &[Layer], wire: f64) -> f64 {
    let greatest = |strain: f64| {
        let contraction = 1.0 / (1.0 + strain).sqrt();
        layers.iter().map(|layer| wire_strain(strain, layer.lay_angle(), contraction)).fold(f64::MIN, f64::max)
    };
    // No wire is strained more than the strand, and a strand of finite pitch hardly more than twice as much as its wires.
    let mut high = 2.0 * wire + 1.0;
    while greatest(high) < wire {
        high *= 2.0;
    }
    let [low, high] = bisect(wire, high, 1e-14, |strain| greatest(strain) < wire);
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
            .map(|(wires, radius)| Layer { wires, diameter: 0.39e-3, radius, pitch, lay: 1.0 })
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

    /// Seven wires, a core and six, by diameters and pitch (mm).
    fn seven(core: f64, helical: f64, pitch: f64) -> [Layer; 2] {
        let layer = |wires, diameter: f64, radius: f64, pitch: f64| Layer {
            wires,
            diameter: diameter * 1e-3,
            radius: radius * 1e-3,
            pitch: pitch * 1e-3,
            lay: 1.0,
        };
        [layer(1, core, 0.0, f64::INFINITY), layer(6, helical, 0.5 * (core + helical), pitch)]
    }

    /// Strands of the literature (Utting & Jones 1987, Costello's example, Ghoreishi et al. 2007, Jiang et al. 1999):
    /// force (N) and, where it is known, torque by the textbook and by the extensible rod (N m) at a strain.
    #[test]
    fn strands_with_known_answers() {
        let inch = 25.4;
        type Known = ([Layer; 2], f64, f64, f64, f64, [Option<f64>; 2]);
        let strands: [Known; 6] = [
            (seven(3.94, 3.73, 148.773), 197.9e9, 0.3, 1e-3, 14.80e3, [Some(7.32), None]),
            (seven(3.94, 3.73, 115.341), 197.9e9, 0.3, 1e-3, 14.43e3, [Some(9.14), Some(9.59)]),
            (seven(3.94, 3.73, 90.559), 197.9e9, 0.3, 1e-3, 13.89e3, [Some(11.08), None]),
            (
                seven(0.206 * inch, 0.202 * inch, 9.75 * inch),
                196.5005745e9,
                0.25,
                3e-3,
                83.65e3,
                [Some(45.88), Some(48.27)],
            ),
            (seven(5.35, 5.18, 230.0), 200e9, 0.3, 1e-3, 28.87e3, [Some(17.55), Some(18.42)]),
            (seven(3.94, 3.73, 115.0), 188e9, 0.3, 1e-3, 13.70e3, [None, None]),
        ];
        for (layers, young, poisson, strain, force, torques) in strands {
            for (wire, torque) in [Wire::Inextensible, Wire::Extensible].into_iter().zip(torques) {
                let found = elastic(&layers, young, poisson, wire);
                assert!((found.force * strain / force - 1.0).abs() < 5e-4, "{wire:?}: {}", found.force * strain);
                if let Some(torque) = torque {
                    // As printed, to a hundredth.
                    assert!((found.torque * strain - torque).abs() < 6e-3, "{wire:?}: {}", found.torque * strain);
                }
            }
        }
    }

    /// With its ends free to turn Costello's strand would carry less, and a strand laid the other way turns the other way.
    #[test]
    fn lay_direction_turns_the_torque_alone() {
        let right = seven(5.35, 5.18, 230.0);
        let left = right.map(|layer| Layer { lay: -1.0, ..layer });
        let [a, b] = [right, left].map(|layers| elastic(&layers, 200e9, 0.3, Wire::Extensible));
        assert_eq!((a.force, a.torque), (b.force, -b.torque));
        assert!(a.torque > 0.0);
    }

    /// The whole wrench from energy alone: work is stationary, so force and torque are the derivatives of what the wires
    /// store, 1/2 ∫ (EA x² + EI k² + GJ t²) per length before loading, by strain and by turn of the ends. The lay radius
    /// is a constraint, not a load, so it is kept here.
    #[test]
    fn the_extensible_wrench_is_the_derivative_of_stored_energy() {
        use crate::reference::helix::{curvature, torsion};
        let layer = Layer { wires: 6, diameter: 3.73e-3, radius: 3.835e-3, pitch: 90.559e-3, lay: 1.0 };
        let (young, poisson) = (200e9, 0.3);
        let one = young * FRAC_PI_4 * layer.diameter.powi(2);
        let bend = one * layer.diameter.powi(2) / 16.0;
        let arc = (std::f64::consts::TAU * layer.radius).hypot(layer.pitch);
        // Energy per length of strand when a pitch is stretched by `strain` and its turn grows by `turn` [rad per metre].
        let energy = |strain: f64, turn: f64| {
            let turns = 1.0 + turn * layer.pitch / std::f64::consts::TAU;
            let pitch = layer.pitch * (1.0 + strain) / turns;
            let now = (std::f64::consts::TAU * layer.radius).hypot(pitch) * turns;
            let stretch = now / arc;
            let k = curvature(layer.radius, pitch) * stretch - curvature(layer.radius, layer.pitch);
            let t = torsion(layer.radius, pitch, 1.0) * stretch - torsion(layer.radius, layer.pitch, 1.0);
            let x = stretch - 1.0;
            0.5 * 6.0 * (arc / layer.pitch) * (one * x * x + bend * k * k + bend / (1.0 + poisson) * t * t)
        };
        let (strain, h) = (1e-6, 1e-7);
        let force = (energy(strain + h, 0.0) - energy(strain - h, 0.0)) / (2.0 * h);
        let turn = 1e-5;
        let torque = (energy(strain, turn) - energy(strain, -turn)) / (2.0 * turn);
        let kept = Response { strain: layer.lay_angle().cos().powi(2), radius: 0.0 };
        let found = layer.wrench(kept, young, poisson, Wire::Extensible);
        assert!((found.force * strain / force - 1.0).abs() < 1e-4, "{} {}", found.force * strain, force);
        assert!((found.torque * strain / torque - 1.0).abs() < 1e-4, "{} {}", found.torque * strain, torque);
        let textbook = layer.wrench(kept, young, poisson, Wire::Inextensible);
        assert!(textbook.torque * strain / torque < 0.97, "the textbook's formula is not the derivative");
    }

    /// The outer layer of KA4 lies 0.053 mm above the middle one: 4.5 % of its radius at tan²β = 0.0352.
    #[test]
    fn gaps_of_ka4_close_at_a_sixth_of_a_per_cent() {
        let radii = [0.332e-3, 0.722e-3, 1.165e-3];
        let layers: Vec<Layer> =
            ka4(39e-3).into_iter().zip(radii).map(|(layer, radius)| Layer { radius, ..layer }).collect();
        let strain = closing_strain(&layers, &[0.0, 0.0, 0.053e-3]);
        assert!((strain - 0.053 / 1.165 * 0.187_69f64.powi(2)).abs() < 1e-7, "{strain}");
        assert_eq!(closing_strain(&layers, &[0.0; 3]), 0.0);
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
        let layers = [(1, 0.0), (6, 1e-3)].map(|(wires, radius)| Layer {
            wires,
            diameter: 1e-3,
            radius,
            pitch: f64::INFINITY,
            lay: 1.0,
        });
        assert_eq!(stiffness_factor(&layers), 1.0);
        assert_eq!(stiffness_factor_contracting(&layers, 0.34), 1.0);
        assert_eq!(strength_factor(&layers), 1.0);
    }
}
