//! Quantities that colour wires, for recording and frames: their ranges, fixed over a run, and how they are told.

use crate::base::units::{mpa, percent};
use crate::engine::view::RunInfo;
use crate::scene::spec::ColourBy;

/// Deviation of stress that takes the whole scale, over the greatest stress of the run (-).
const DEVIATION: f64 = 0.1;

/// The range of a quantity over a run, in SI; `None` for what only tells things apart.
pub fn range(info: &RunInfo, by: ColourBy) -> Option<[f64; 2]> {
    match by {
        ColourBy::Stress => Some(info.stress_range),
        ColourBy::Deviation => {
            let most = DEVIATION * info.stress_range[1].abs().max(info.stress_range[0].abs());
            Some([-most, most])
        }
        ColourBy::PlasticStrain => Some(info.plastic_strain_range),
        ColourBy::Utilisation => Some([0.0, 1.0]),
        ColourBy::ContactPressure => Some(info.contact_pressure_range),
        ColourBy::Velocity => Some(info.speed_range),
        ColourBy::Layer | ColourBy::Wire | ColourBy::Material => None,
    }
}

/// A value in the unit that people are shown.
pub fn shown(by: ColourBy, value: f64) -> f64 {
    match by {
        ColourBy::Stress | ColourBy::Deviation | ColourBy::ContactPressure => mpa(value),
        ColourBy::PlasticStrain | ColourBy::Utilisation => percent(value),
        ColourBy::Velocity | ColourBy::Layer | ColourBy::Wire | ColourBy::Material => value,
    }
}
