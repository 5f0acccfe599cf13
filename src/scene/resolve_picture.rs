//! `[[output.picture]]`.

use super::at::{At, Range, can_name_a_folder};
use super::look::{Moment, SUPERSAMPLING};
use super::picture::{MOST_EXPLODED, PictureSpec, SIDES, WIDEST, When};
use super::raw::{RawPicture, Scalar};
use super::spec::OutputSpec;
use crate::base::error::Result;
use crate::base::units::{Dimension, shortest};

/// Turn of the eye (°) where none is given: one from which a strand shows its length and its layers.
const USUAL_TURN: [f64; 2] = [-28.0, 22.0];

/// How many times finer than its pixels a picture is drawn.
pub(super) fn supersampling(at: &At, raw: Option<i64>, usual: u32) -> Result<u32> {
    let Some(times) = raw else { return Ok(usual) };
    u32::try_from(times).ok().filter(|times| SUPERSAMPLING.contains(times)).ok_or_else(|| {
        let (least, most) = (SUPERSAMPLING.start(), SUPERSAMPLING.end());
        at.error(format!("`supersampling` is {times}, but must be from {least} to {most}"), "2 makes outlines smooth")
    })
}

/// What pictures take from the rest of the scene.
pub(super) struct Context<'a> {
    /// Names of the layers.
    pub layers: Vec<&'a str>,
    /// How many wires there are.
    pub wires: usize,
    /// Grips pull, so that there is a strain.
    pub pulled: bool,
    /// How frames look, which pictures look like as far as they do not say.
    pub output: &'a OutputSpec,
}

/// Resolves the pictures of a scene.
pub(super) fn pictures(at: &At, raw: &[RawPicture], context: &Context) -> Result<Vec<PictureSpec>> {
    let mut all: Vec<PictureSpec> = Vec::with_capacity(raw.len());
    for (index, raw) in raw.iter().enumerate() {
        let here = at.element(index);
        let made = picture(&here, raw, context)?;
        // File systems may take capitals for small letters.
        if all.iter().any(|before| before.name.eq_ignore_ascii_case(&made.name)) {
            let what = format!("two pictures are named {:?}", made.name);
            return Err(here.key("name").error(what, "give each picture its own name, in small letters too"));
        }
        all.push(made);
    }
    Ok(all)
}

fn picture(at: &At, raw: &RawPicture, context: &Context) -> Result<PictureSpec> {
    let length = |name: &str, raw: &Option<Scalar>| at.optional(name, raw, Dimension::Length, Range::Any);
    let turn = |name: &str, raw: &Option<Scalar>, usual: f64| -> Result<f64> {
        Ok(at.optional(name, raw, Dimension::Angle, Range::Any)?.unwrap_or(usual.to_radians()))
    };
    // What was read from text may be off by a bit.
    let within = |name: &str, raw: &Option<Scalar>, value: f64, most: (f64, &str)| -> Result<f64> {
        match raw {
            Some(raw) if !(0.0..=most.0 * (1.0 + 1e-12)).contains(&value) => {
                Err(at.key(name).error(format!("`{name}` is {raw}, but must be from 0 to {}", most.1), ""))
            }
            _ => Ok(value.min(most.0)),
        }
    };
    let (perspective, explode) =
        (turn("perspective", &raw.perspective, 0.0)?, at.ratio_or("explode", &raw.explode, 0.0, Range::Any)?);
    let (widest, furthest) = (format!("{WIDEST} deg"), shortest(MOST_EXPLODED));
    let centre = raw.centre.as_ref().map(|raw| at.key("centre").vector(raw, Dimension::Length)).transpose()?;
    Ok(PictureSpec {
        name: name(at, raw)?,
        when: when(at, raw, context)?,
        size: size(at, raw, context)?,
        azimuth: turn("azimuth", &raw.azimuth, USUAL_TURN[0])?,
        elevation: turn("elevation", &raw.elevation, USUAL_TURN[1])?,
        centre,
        height: at.optional("height", &raw.height, Dimension::Length, Range::Positive)?,
        perspective: within("perspective", &raw.perspective, perspective, (WIDEST.to_radians(), &widest))?,
        follow: length("follow", &raw.follow)?,
        colour: raw.colour.unwrap_or(context.output.colour),
        range: raw.range.map(|range| self::range(at, range)).transpose()?,
        hidden_layers: layers(&at.key("hidden_layers"), &raw.hidden_layers, context)?,
        ghost_layers: layers(&at.key("ghost_layers"), &raw.ghost_layers, context)?,
        hidden_wires: hidden_wires(&at.key("hidden_wires"), raw.hidden_wires.as_deref().unwrap_or_default(), context)?,
        selected: raw.selected.map(|number| wire(&at.key("selected"), number, context)).transpose()?,
        explode: within("explode", &raw.explode, explode, (MOST_EXPLODED, &furthest))?,
        cut: length("cut", &raw.cut)?,
        theme: raw.theme.unwrap_or(context.output.theme),
        supersampling: supersampling(&at.key("supersampling"), raw.supersampling, context.output.supersampling)?,
    })
}

fn name(at: &At, raw: &RawPicture) -> Result<String> {
    let name = raw.name.as_ref().ok_or_else(|| at.missing("name", "\"midsection\""))?;
    if can_name_a_folder(name) {
        return Ok(name.clone());
    }
    let what = format!("{name:?} cannot be the name of a file");
    Err(at.key("name").error(what, "use at most 120 letters, digits, `-`, `_` and `.`"))
}

fn when(at: &At, raw: &RawPicture, context: &Context) -> Result<When> {
    let strain = at.optional("strain", &raw.strain, Dimension::Ratio, Range::NotNegative)?;
    let time = at.optional("time", &raw.time, Dimension::Time, Range::NotNegative)?;
    if strain.is_some() && !context.pulled {
        return Err(at.key("strain").refused("has no meaning where no grip pulls"));
    }
    let why = "is a second moment of one picture";
    if strain.is_some() {
        at.refuse("time", &raw.time, why)?;
    }
    if strain.is_some() || time.is_some() {
        at.refuse("at", &raw.at, why)?;
    }
    Ok(match (strain, time) {
        (Some(strain), _) => When::Strain(strain),
        (None, Some(time)) => When::Time(time),
        (None, None) => When::At(raw.at.unwrap_or(Moment::End)),
    })
}

fn size(at: &At, raw: &RawPicture, context: &Context) -> Result<[u32; 2]> {
    let Some(size) = raw.size else { return Ok(context.output.frame_size) };
    let mut sides = [0; 2];
    for (index, pixels) in size.into_iter().enumerate() {
        let fits = u32::try_from(pixels).ok().filter(|side| SIDES.contains(side));
        let Some(side) = fits else {
            let what =
                format!("`size` holds {pixels}, but a side must have {} to {} pixels", SIDES.start(), SIDES.end());
            return Err(at.key("size").element(index).error(what, "for example [1280, 720]"));
        };
        sides[index] = side;
    }
    Ok(sides)
}

fn range(at: &At, [low, high]: [f64; 2]) -> Result<[f64; 2]> {
    if low.is_finite() && high.is_finite() && low < high {
        return Ok([low, high]);
    }
    let what =
        format!("`range` is {} to {}, but must be two numbers, the lower one first", shortest(low), shortest(high));
    Err(at.key("range").error(what, "for example [0, 300]"))
}

fn layers(at: &At, raw: &Option<Vec<String>>, context: &Context) -> Result<Vec<String>> {
    let names = raw.as_deref().unwrap_or_default();
    for (index, name) in names.iter().enumerate() {
        if !context.layers.contains(&name.as_str()) {
            let known: Vec<String> = context.layers.iter().map(|name| format!("{name:?}")).collect();
            let help = if known.is_empty() {
                "the scene has no layers".into()
            } else {
                format!("there are {}", known.join(", "))
            };
            return Err(at.element(index).error(format!("there is no layer {name:?}"), help));
        }
        if names[..index].contains(name) {
            return Err(at.element(index).error(format!("`{}` names {name:?} twice", at.name()), "once is enough"));
        }
    }
    Ok(names.to_vec())
}

fn hidden_wires(at: &At, raw: &[i64], context: &Context) -> Result<Vec<usize>> {
    let mut all = Vec::with_capacity(raw.len());
    for (index, number) in raw.iter().enumerate() {
        let wire = wire(&at.element(index), *number, context)?;
        if all.contains(&wire) {
            return Err(at
                .element(index)
                .error(format!("`{}` names wire {number} twice", at.name()), "once is enough"));
        }
        all.push(wire);
    }
    Ok(all)
}

/// The index of a wire that is written by its number.
fn wire(at: &At, number: i64, context: &Context) -> Result<usize> {
    let index = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
    index.filter(|index| *index < context.wires).ok_or_else(|| {
        let help = match context.wires {
            0 => "the scene has no wires".into(),
            wires => format!("wires have the numbers 1 to {wires}"),
        };
        at.error(format!("there is no wire {number}"), help)
    })
}
