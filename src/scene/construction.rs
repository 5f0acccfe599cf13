//! `strand.construction`: the layers of a strand from the wires of each, or from the copper section alone.
//!
//! Full rings lie around one to five wires, each ring one diameter further out than the one below and holding as many
//! wires as the lay leaves room for. They give the strands of the physics page, section 10, from 4 mm² of copper at a pitch
//! of 39 mm: 5 + 11 + 17 + 23 of 0.30 mm and 4 + 10 + 16 + 22 + 29 of 0.25 mm.

use super::at::{At, Range};
use super::raw::{RawConstruction, RawLay, RawStrand};
use super::resolve_materials::Materials;
use super::spec::LayerSpec;
use crate::base::error::Result;
use crate::base::lay::least_radius_of_layer;
use crate::base::units::Dimension;
use std::f64::consts::{FRAC_PI_4, PI};

/// Most wires around the axis: a sixth leaves room for a core, and is the first ring around it.
const MOST_INNERMOST: usize = 5;
/// Most wires of a layer, and of an automatic construction: a strand, not a typing error.
pub(super) const MOST_WIRES: f64 = 5000.0;
/// How much further out than the ring below leaves it a ring may lie, over the wire diameter (-): lay must not turn six
/// around one into five, and wires flatten more than that.
const SLACK: f64 = 0.002;
/// How far full rings may be from the area before the outermost ring is built with fewer wires than it holds (-).
const NEAR: f64 = 0.02;

/// The layers of a strand that gives a construction instead of `[[strand.layer]]`.
pub(super) fn layers(
    at: &At,
    raw: &RawStrand,
    given: &RawConstruction,
    materials: &Materials,
) -> Result<Vec<LayerSpec>> {
    if !raw.layer.is_empty() {
        let what = "the strand has both `construction` and [[strand.layer]]";
        return Err(at.key("construction").error(what, "remove one; --set strand.layer= removes the layers"));
    }
    let diameter = at.required("wire_diameter", &raw.wire_diameter, Dimension::Length, Range::Positive)?;
    let pitch = at.required("pitch", &raw.pitch, Dimension::Length, Range::PositiveOrInfinite)?;
    let wires = match given {
        RawConstruction::Named(name) if name == "auto" => {
            let area = at.required("area", &raw.area, Dimension::Area, Range::Positive)?;
            automatic(at, area, diameter, pitch)?
        }
        RawConstruction::Named(name) => {
            let help = "\"auto\", or the wires of each layer from the inside out, such as [5, 11, 18]";
            return Err(at.key("construction").error(format!("`{name}` is not a construction"), help));
        }
        RawConstruction::Layers(wires) => {
            at.refuse("area", &raw.area, "has no effect beside the wires of each layer")?;
            listed(&at.key("construction"), wires)?
        }
    };
    let material = materials.number(at, raw.material.as_ref())?;
    let layer = |(k, count): (usize, &usize)| LayerSpec {
        material,
        name: name(k, wires.len(), *count),
        wires: *count,
        wire_diameter: diameter,
        lay_radius: (k == 0 && *count == 1).then_some(0.0),
        pitch,
        lay: RawLay::sign(raw.lay),
        phase: 0.0,
    };
    Ok(wires.iter().enumerate().map(layer).collect())
}

fn listed(at: &At, wires: &[i64]) -> Result<Vec<usize>> {
    if wires.is_empty() {
        return Err(at.error("`construction` lists no layer", "for example [5, 11, 18]"));
    }
    wires
        .iter()
        .enumerate()
        .map(|(k, count)| at.element(k).count_within(*count, 1, MOST_WIRES as u64).map(|count| count as usize))
        .collect()
}

/// Core, inner, middle, outer: what people call them; those between are numbered from the inside.
fn name(k: usize, layers: usize, wires: usize) -> String {
    match k {
        0 if wires == 1 => "core".into(),
        _ if k + 1 == layers => "outer".into(),
        0 => "inner".into(),
        _ if layers == 3 => "middle".into(),
        _ => format!("middle {k}"),
    }
}

fn automatic(at: &At, area: f64, diameter: f64, pitch: f64) -> Result<Vec<usize>> {
    let target = area / (FRAC_PI_4 * diameter * diameter);
    if !(0.5..=MOST_WIRES).contains(&target) {
        let what = format!("the area is that of {target:.1} wires of the strand's diameter");
        return Err(at.key("area").error(what, format!("for 1 to {MOST_WIRES} wires; see strand.wire_diameter")));
    }
    rings(target, diameter, pitch).ok_or_else(|| {
        let what = "so many wires do not fit side by side at this pitch";
        at.key("pitch").error(what, "a longer pitch, less area, or thicker wires")
    })
}

/// Wires of each ring, from the inside out, for `target` wires (not whole, as the area asks). `None` when they do not fit at
/// any radius.
fn rings(target: f64, diameter: f64, pitch: f64) -> Option<Vec<usize>> {
    let total = |rings: &[usize]| rings.iter().sum::<usize>() as f64;
    let off = |rings: &[usize]| (total(rings) - target).abs();
    let full: Vec<Vec<usize>> = (1..=MOST_INNERMOST).map(|first| full_rings(first, target, diameter, pitch)).collect();
    let prefixes = full.iter().flat_map(|rings| (1..=rings.len()).map(|n| rings[..n].to_vec()));
    let nearest = prefixes.min_by(|a, b| off(a).total_cmp(&off(b)))?;
    if off(&nearest) <= NEAR * target {
        return Some(nearest);
    }
    // The count nearest to the area, with the outermost ring as full as can be.
    let count = (target.round() as usize).max(1);
    let filled = full.iter().filter_map(|rings| cut(rings, count));
    filled.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(rings, _)| rings)
}

/// Full rings around `first` wires, until they hold `target` wires or no more fit at the pitch.
fn full_rings(first: usize, target: f64, diameter: f64, pitch: f64) -> Vec<usize> {
    let Some(mut radius) = least_radius_of_layer(first, diameter, pitch) else { return Vec::new() };
    let mut rings = vec![first];
    while (rings.iter().sum::<usize>() as f64) < target {
        radius += diameter;
        // Parallel wires are the bound; lay takes some of it.
        let parallel = (PI / (0.5 * diameter / (radius + SLACK * diameter)).asin()).floor() as usize;
        let fits = |wires: &usize| {
            least_radius_of_layer(*wires, diameter, pitch).is_some_and(|least| least <= radius + SLACK * diameter)
        };
        let Some(wires) = (1..=parallel).rev().find(fits) else { break };
        // Where the pitch sets the limit, rings further out hold no more than those below.
        if wires <= *rings.last().expect("there is a first ring") {
            break;
        }
        rings.push(wires);
        radius = least_radius_of_layer(wires, diameter, pitch).map_or(radius, |least| least.max(radius));
    }
    rings
}

/// The first `count` wires of full rings, and how full the last of them is (-); `None` where they hold fewer.
fn cut(full: &[usize], count: usize) -> Option<(Vec<usize>, f64)> {
    let mut left = count;
    let mut rings = Vec::new();
    for ring in full {
        rings.push(left.min(*ring));
        if left <= *ring {
            return Some((rings, left as f64 / *ring as f64));
        }
        left -= ring;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_area(area_mm2: f64, diameter_mm: f64) -> Vec<usize> {
        rings(area_mm2 / (FRAC_PI_4 * diameter_mm * diameter_mm), diameter_mm * 1e-3, 39e-3).unwrap()
    }

    /// The strands of the physics page, section 10.
    #[test]
    fn four_square_millimetres_of_thin_wires() {
        assert_eq!(of_area(4.0, 0.30), [5, 11, 17, 23]);
        assert_eq!(of_area(4.0, 0.25), [4, 10, 16, 22, 29]);
    }

    /// The rings of KA4 hold one wire less than KA4 itself, whose outer layer lies further out than it must. Six around one
    /// stay six when they are laid.
    #[test]
    fn rings_of_ka4() {
        assert_eq!(of_area(4.0, 0.39), [5, 11, 17]);
        assert_eq!(of_area(4.0, 0.37), [1, 6, 12, 18]);
    }

    #[test]
    fn known_strands() {
        let thick = |count: f64| rings(count, 1e-3, f64::INFINITY).unwrap();
        assert_eq!(thick(1.0), [1]);
        assert_eq!(thick(3.0), [3]);
        assert_eq!(thick(7.0), [1, 6]);
        assert_eq!(thick(19.0), [1, 6, 12]);
        assert_eq!(thick(37.0), [1, 6, 12, 18]);
    }

    /// Between full rings the outermost gives way: the count is the nearest to the area all the same.
    #[test]
    fn what_full_rings_do_not_meet_the_outermost_does() {
        for hundredths in 20..60 {
            let diameter = f64::from(hundredths) * 0.01;
            let wires: usize = of_area(4.0, diameter).iter().sum();
            let target = 4.0 / (FRAC_PI_4 * diameter * diameter);
            let least = (wires as f64 - target).abs().min((wires as f64 - target.round()).abs());
            assert!(least <= NEAR * target, "{diameter}: {wires} for {target}");
        }
    }

    #[test]
    fn a_pitch_that_is_too_short_is_seen() {
        assert_eq!(rings(34.0, 0.39e-3, 3e-3), None);
    }

    #[test]
    fn layers_are_called_what_people_call_them() {
        let names = |wires: &[usize]| {
            let all = wires.iter().enumerate().map(|(k, count)| name(k, wires.len(), *count));
            all.collect::<Vec<_>>()
        };
        assert_eq!(names(&[5, 11, 18]), ["inner", "middle", "outer"]);
        assert_eq!(names(&[1, 6]), ["core", "outer"]);
        assert_eq!(names(&[4, 10, 16, 22]), ["inner", "middle 1", "middle 2", "outer"]);
        assert_eq!(names(&[3]), ["outer"]);
    }
}
