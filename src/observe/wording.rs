//! How a run is put into words for people: one place, so that log, tables and pictures agree.

use super::materials;
use crate::base::units::{mm, mpa, percent};
use crate::engine::view::{RunInfo, Rupture};
use crate::scene::spec::Spec;
use serde::{Deserialize, Serialize};

/// Number of wire `wire` as people see it (-): counted from 1.
pub fn wire_number(wire: usize) -> usize {
    wire + 1
}

/// What the first break of a run is called: another strand has another.
pub const FIRST_BREAK: &str = "first break in this strand";

/// A layer's name where it stands alone, with its material where there are several: "outer (steel)".
pub fn layer_label(info: &RunInfo, layer: usize) -> String {
    let name = info.layers.get(layer).map_or("", String::as_str);
    match materials::of_layer(info, layer) {
        Some(material) => format!("{name} ({material})").trim_start().to_owned(),
        None => name.to_owned(),
    }
}

/// A layer as people say it: "outer layer"; one without a name by its number. Its material is named where there are
/// several: "outer layer (steel)".
pub fn layer_words(info: &RunInfo, layer: usize) -> String {
    let words = match info.layers[layer].as_str() {
        "" => format!("layer {}", layer + 1),
        name => format!("{name} layer"),
    };
    match materials::of_layer(info, layer) {
        Some(material) => format!("{words} ({material})"),
        None => words,
    }
}

/// The line that tells of a rupture, such as
/// `wire 24, outer layer, snapped at z = 65.7 mm, strain 23.4 %, 294 MPa`: place of the bond when it broke,
/// strain of the body, true axial stress of the bond just before.
pub fn rupture_line(info: &RunInfo, rupture: &Rupture) -> String {
    format!(
        "wire {}, {} layer{}, snapped at z = {:.1} mm, strain {:.1} %, {:.0} MPa",
        wire_number(rupture.wire),
        info.layers[rupture.layer],
        materials::of_wire(info, rupture.wire).map(|material| format!(", {material}")).unwrap_or_default(),
        mm(rupture.position[2]),
        percent(rupture.strain),
        mpa(rupture.stress),
    )
}

/// A run whose bonds scatter is one draw: another seed is another strand, with other weak places.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OneDraw {
    /// Seed of the scatter.
    pub seed: u64,
    /// Weibull modulus of the rupture value from bond to bond (-), the least of all materials.
    pub weibull_modulus: f64,
}

impl OneDraw {
    /// Of a scene; `None` where every bond is as strong as the other, or nothing can break.
    pub fn of(spec: &Spec) -> Option<Self> {
        let weibull_modulus = spec.ruptures().map(|rupture| rupture.weibull_modulus).fold(f64::INFINITY, f64::min);
        weibull_modulus.is_finite().then_some(Self { seed: spec.seed, weibull_modulus })
    }

    /// What may be said of such a run, in a sentence.
    pub fn sentence(&self) -> String {
        format!(
            "One draw of the scatter (seed {}, Weibull modulus {}): which wire breaks first, in which layer and where, and the \
             last per cents of strength and elongation, are those of this strand; ensembles over seeds say what holds for \
             others.",
            self.seed, self.weibull_modulus
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_with_scatter_is_one_draw_and_one_without_is_not() {
        let of = |option: &str| OneDraw::of(&crate::scene::load("ka4", &[option.to_string()]).unwrap().spec);
        let draw = of("seed=7").unwrap();
        assert_eq!(draw, OneDraw { seed: 7, weibull_modulus: 30.0 });
        assert!(draw.sentence().contains("One draw of the scatter (seed 7, Weibull modulus 30)"));
        assert_eq!(of("bond.rupture.weibull_modulus=inf"), None);
        assert_eq!(OneDraw::of(&crate::scene::load("cantilever", &[]).unwrap().spec), None);
    }

    #[test]
    fn a_rupture_reads_well() {
        let info = RunInfo { layers: vec!["inner".into(), "outer".into()], ..RunInfo::default() };
        let rupture = Rupture {
            strain: 0.2341,
            wire: 23,
            layer: 1,
            position: [0.0, 1e-3, 0.06572],
            stress: 294.3e6,
            ..Rupture::default()
        };
        assert_eq!(
            rupture_line(&info, &rupture),
            "wire 24, outer layer, snapped at z = 65.7 mm, strain 23.4 %, 294 MPa"
        );
    }
}
