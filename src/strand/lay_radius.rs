//! Lay radii: the least radius at which a layer's wires overlap neither each other nor the layers below, and the check
//! of radii that a scene gives.

use crate::base::lay::{distance, least_radius_of_layer};
use crate::scene::spec::LayerSpec;
use crate::strand::helix::Helix;
use std::f64::consts::TAU;

/// Overlap over the wire diameter above which a geometry is refused (-). Below it, the first steps push the wires
/// apart; above it they would shoot apart.
pub const GREATEST_OVERLAP: f64 = 0.1;

/// What a layer's wires run into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clash {
    /// Each other.
    Own,
    /// The wires of this layer below.
    Below(usize),
}

/// A layer whose lay radius cannot be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayRadiusError {
    /// The layer, from 0.
    pub layer: usize,
    /// The radius that the scene gives (m); `None` for `auto`.
    pub given: Option<f64>,
    /// The least radius that works whatever the phases (m); `None` when the layer's wires overlap at every radius
    /// (the pitch is not greater than the sum of the diameters).
    pub least: Option<f64>,
    /// What the wires run into.
    pub clash: Clash,
}

/// Lay radius of every layer (m): the given one, or for `auto` the least without overlap.
///
/// # Errors
/// When wires of a layer overlap each other or a layer below by more than [`GREATEST_OVERLAP`] of a diameter.
pub fn resolve(layers: &[LayerSpec]) -> Result<Vec<f64>, LayRadiusError> {
    let mut radii: Vec<f64> = Vec::with_capacity(layers.len());
    for (k, layer) in layers.iter().enumerate() {
        let least = least_radius(layers, &radii, k);
        let error = |clash| LayRadiusError { layer: k, given: layer.lay_radius, least, clash };
        let radius = match layer.lay_radius {
            None => least.ok_or(error(Clash::Own))?,
            Some(given) => match clash(layers, &radii, k, given) {
                Some(found) => return Err(error(found)),
                None => given,
            },
        };
        radii.push(radius);
    }
    Ok(radii)
}

/// Least radius (m) of layer `k` above layers whose radii (m) are known: its own wires just do not overlap, and
/// R ≥ R_below + (d_below + d)/2. `None` when its wires overlap at every radius.
fn least_radius(layers: &[LayerSpec], below: &[f64], k: usize) -> Option<f64> {
    let layer = &layers[k];
    let own = least_radius_of_layer(layer.wires, layer.wire_diameter, layer.pitch)?;
    let above = below.iter().zip(layers).map(|(radius, under)| {
        // Two wires that cross touch where their radii differ by the half-sum of the diameters.
        radius + 0.5 * (under.wire_diameter + layer.wire_diameter)
    });
    Some(above.fold(own, f64::max))
}

/// What layer `k` runs into at radius `given` (m), if anything.
fn clash(layers: &[LayerSpec], below: &[f64], k: usize, given: f64) -> Option<Clash> {
    let layer = &layers[k];
    if layer.wires > 1 {
        let own = distance(given, given, TAU / layer.wires as f64, TAU / layer.pitch);
        if layer.wire_diameter - own > GREATEST_OVERLAP * layer.wire_diameter {
            return Some(Clash::Own);
        }
    }
    (0..below.len())
        .find(|&b| {
            let under = &layers[b];
            let touching = 0.5 * (layer.wire_diameter + under.wire_diameter);
            let thinner = layer.wire_diameter.min(under.wire_diameter);
            let gap = distance_of_layers((layer, given), (under, below[b]));
            touching - gap > GREATEST_OVERLAP * thinner
        })
        .map(Clash::Below)
}

/// Least distance (m) between the centre lines of two layers at their radii (m).
fn distance_of_layers(upper: (&LayerSpec, f64), lower: (&LayerSpec, f64)) -> f64 {
    let helix = |layer: &LayerSpec, radius: f64, i: usize| Helix {
        radius,
        pitch: layer.pitch,
        lay: layer.lay,
        phase: TAU * i as f64 / layer.wires as f64 + layer.phase,
    };
    let rate = helix(upper.0, upper.1, 0).rate();
    let difference = rate - helix(lower.0, lower.1, 0).rate();
    if difference.abs() > 1e-9 * rate.abs() {
        // Laid differently, the wires of the two layers cross each other.
        return (upper.1 - lower.1).abs();
    }
    let mut least = f64::INFINITY;
    for i in 0..upper.0.wires {
        for j in 0..lower.0.wires {
            let phase = helix(upper.0, upper.1, i).phase - helix(lower.0, lower.1, j).phase;
            least = least.min(distance(upper.1, lower.1, phase, rate.abs()));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strand::test_specs::{ka4, layer};
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Costello's condition for wires of a layer that just touch, R = r √(1 + tan²(π/2 − π/n)/cos²β) (*Theory of Wire
    /// Rope*, 2nd ed. 1997, chapter 2; the section of a wire taken as an ellipse), solved for R.
    fn costello_radius(wires: usize, diameter: f64, pitch: f64) -> f64 {
        let tangent = (FRAC_PI_2 - PI / wires as f64).tan();
        (0..100).fold(diameter, |radius, _| {
            let slope = TAU * radius / pitch;
            0.5 * diameter * (1.0 + tangent.powi(2) * (1.0 + slope.powi(2))).sqrt()
        })
    }

    /// What each layer of KA4 needs for itself at a pitch of 39 mm, against Costello's condition; the physics page,
    /// section 2, has 1.142, 0.697 and 0.332 mm, to a micrometre.
    #[test]
    fn layers_of_ka4_alone() {
        for (wires, printed) in [(18, 1.142e-3), (11, 0.697e-3), (5, 0.332e-3)] {
            let radius = least_radius_of_layer(wires, 0.39e-3, 39e-3).unwrap();
            let costello = costello_radius(wires, 0.39e-3, 39e-3);
            assert!((radius - costello).abs() < 5e-8, "{wires}: {radius} {costello}");
            assert!((radius - printed).abs() < 1e-6, "{wires}: {radius}");
        }
    }

    /// Physics page, section 2: `auto` gives 0.332 and 0.722 mm below the given 1.165 mm.
    #[test]
    fn auto_radii_of_ka4() {
        let radii = resolve(&ka4().strand.unwrap().layers).unwrap();
        for (radius, expected) in radii.iter().zip([0.332e-3, 0.722e-3, 1.165e-3]) {
            assert!((radius - expected).abs() < 0.5e-6, "{radii:?}");
        }
    }

    /// A core and six equal wires: straight ones touch at R = d, and a lay makes no room for them.
    #[test]
    fn six_around_one() {
        let straight = least_radius_of_layer(6, 1e-3, f64::INFINITY).unwrap();
        assert!((straight - 1e-3).abs() < 1e-15);
        let laid = least_radius_of_layer(6, 1e-3, 12e-3).unwrap();
        assert!(laid > 1.02e-3, "{laid}");
    }

    #[test]
    fn given_radius_that_is_too_small_names_the_least() {
        let mut layers = ka4().strand.unwrap().layers;
        layers[2].lay_radius = Some(0.9e-3);
        let error = resolve(&layers).unwrap_err();
        assert_eq!((error.layer, error.given), (2, Some(0.9e-3)));
        assert_eq!(error.clash, Clash::Own);
        assert!((error.least.unwrap() - 1.142e-3).abs() < 1e-6);
        layers[2].lay_radius = error.least;
        resolve(&layers).unwrap();
    }

    #[test]
    fn layer_inside_the_one_below_is_refused() {
        let mut layers = ka4().strand.unwrap().layers;
        layers[1].lay_radius = Some(0.9e-3);
        let error = resolve(&layers).unwrap_err();
        assert_eq!(error.clash, Clash::Below(1));
        assert!((error.least.unwrap() - 1.29e-3).abs() < 1e-9);
    }

    /// The evenly spread radii touch exactly (0.775 − 0.385 = 0.39): rounding must not refuse them.
    #[test]
    fn evenly_spread_radii_are_accepted() {
        let mut layers = ka4().strand.unwrap().layers;
        for (layer, radius) in layers.iter_mut().zip([0.385e-3, 0.775e-3, 1.165e-3]) {
            layer.lay_radius = Some(radius);
        }
        assert_eq!(resolve(&layers).unwrap(), [0.385e-3, 0.775e-3, 1.165e-3]);
    }

    /// Wires of one pitch lie in the valleys between those below, closer to the axis than crossing wires could.
    #[test]
    fn parallel_lay_may_nest_where_crossed_lay_may_not() {
        let d = 1e-3;
        let below = layer(6, d, Some(1.1 * d), 40e-3);
        let mut above = layer(6, d, Some(1.85 * d), 40e-3);
        above.phase = TAU / 12.0;
        resolve(&[below.clone(), above.clone()]).unwrap();
        above.lay = -1.0;
        let error = resolve(&[below, above]).unwrap_err();
        assert_eq!(error.clash, Clash::Below(0));
    }

    #[test]
    fn pitch_shorter_than_the_wires_side_by_side_never_fits() {
        let error = resolve(&[layer(18, 0.39e-3, None, 7e-3)]).unwrap_err();
        assert_eq!((error.least, error.given), (None, None));
        assert!(least_radius_of_layer(18, 0.39e-3, 7.1e-3).is_some());
    }

    /// Least distance found by trying many points of the second helix.
    fn scanned_distance(a: Helix, b: Helix) -> f64 {
        let fixed = a.point(0.0);
        let n = 40_000;
        (0..=n)
            .map(|i| {
                let z = b.pitch * 1.5 * (2.0 * i as f64 / n as f64 - 1.0);
                fixed.distance(b.point(z))
            })
            .fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn distance_is_the_least_over_all_points(
            r1 in 0.3..2.0_f64, r2 in 0.3..2.0_f64, phase in 0.1..6.2_f64, pitch in 5.0..80.0_f64,
        ) {
            let helix = |radius, phase| Helix { radius, pitch, lay: 1.0, phase };
            let exact = distance(r1, r2, phase, TAU / pitch);
            let scanned = scanned_distance(helix(r1, 0.0), helix(r2, phase));
            prop_assert!((exact - scanned).abs() < 1e-4, "{exact} {scanned}");
            prop_assert!(exact <= scanned + 1e-12);
        }

        /// Adjacent wires of an auto layer touch: never closer than d, and no slack left.
        #[test]
        fn auto_layers_just_touch(wires in 2_usize..30, turns in 1.3..40.0_f64) {
            let d = 0.39;
            let pitch = turns * wires as f64 * d;
            let radius = least_radius_of_layer(wires, d, pitch).unwrap();
            let helix = |phase| Helix { radius, pitch, lay: -1.0, phase };
            for other in 1..wires {
                let phase = TAU * other as f64 / wires as f64;
                let gap = scanned_distance(helix(0.0), helix(phase));
                prop_assert!(gap >= d * (1.0 - 1e-12), "wire {other}: {gap}");
            }
            let next = scanned_distance(helix(0.0), helix(TAU / wires as f64));
            prop_assert!(next < d * 1.001, "{next}");
        }

        /// Random strands, laid as they come: no two layers closer than their wires allow.
        #[test]
        fn auto_layers_clear_each_other(
            counts in prop::collection::vec(1_usize..20, 1..5), pitch in 30e-3..80e-3_f64,
        ) {
            let layers: Vec<_> = counts
                .iter()
                .enumerate()
                .map(|(k, &n)| LayerSpec {
                    lay: [1.0, -1.0][k % 2],
                    ..layer(n, 0.39e-3, None, pitch)
                })
                .collect();
            let radii = resolve(&layers).unwrap();
            for pair in radii.windows(2) {
                prop_assert!(pair[1] - pair[0] >= 0.39e-3 * (1.0 - 1e-12));
            }
            let given: Vec<_> = layers
                .iter()
                .zip(&radii)
                .map(|(layer, &radius)| LayerSpec { lay_radius: Some(radius), ..layer.clone() })
                .collect();
            prop_assert_eq!(resolve(&given).unwrap(), radii);
        }
    }
}
