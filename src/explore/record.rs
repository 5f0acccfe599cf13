//! A run as the page is told of it: all its snapshots in memory, its numbers in the units of people.

use super::pick::Picked;
use super::view::View;
use crate::base::error::{Error, Result};
use crate::base::finding::Notice;
use crate::base::units::{mm, mpa, ms, percent};
use crate::base::worst::renew;
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::tables::{cause, layer_name};
use crate::observe::trajectory::{Record as Entry, Trajectory};
use crate::observe::wording::{layer_words, wire_number};
use crate::page::{self, Abscissa, Source};
use crate::render::body::Body;
use crate::render::colour::ColourScale;
use crate::render::data::current_z;
use crate::run::identity;
use crate::scene::spec::ColourBy;
use glam::Vec3;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// Memory for snapshots (bytes). A longer run is shown by every other of them, or fewer.
const MEMORY: usize = 2 << 30;
/// Memory of a snapshot for each particle (bytes).
const PARTICLE_BYTES: usize = 45;
/// Points of a curve that are sent to a page at most.
const MOST_POINTS: usize = 3000;
/// Colours of a scale that are sent to a page.
const STOPS: usize = 32;

/// A run that can be looked at, over or still going.
pub struct Record {
    info: Arc<RunInfo>,
    /// Every row of the curve.
    samples: Vec<Sample>,
    /// Every rupture, in order.
    ruptures: Vec<Rupture>,
    /// Every so many of the run's snapshots, and its last one.
    snapshots: Vec<Arc<Snapshot>>,
    every: usize,
    /// Snapshots that the run has had, and all that it has told.
    seen: usize,
    extent: usize,
    /// What broke first, as markup, of a run that is over.
    headline: Option<String>,
    /// Bonds scatter.
    one_draw: bool,
    /// What the run found, of one that is going.
    notices: Vec<Notice>,
    warnings: Vec<String>,
    notes: Vec<String>,
}

/// What a run that is going tells.
pub enum Told {
    /// A row of the curve.
    Row(Sample),
    /// A state.
    State(Arc<Snapshot>),
    /// A bond broke.
    Rupture(Rupture),
    /// Something that the user must know was found.
    Notice(Notice),
}

impl Record {
    /// Reads the run in a folder.
    ///
    /// # Errors
    /// Those of [`Source::read`], and [`Error::Input`] when it holds no snapshot.
    pub fn read(run: &Path) -> Result<Self> {
        // What was changed, or belongs to another run, is not shown as this one.
        identity::check(run, false)?;
        let source = Source::read(run)?;
        let every = source.snapshots.div_ceil(most(&source.info)).max(1);
        let trajectory = Trajectory::open(&page::trajectory_in(run)?)?;
        let last = source.snapshots.saturating_sub(1);
        // Where the file is cut off, the source has said so.
        let all = trajectory.map_while(|entry| entry.ok()).filter_map(|entry| match entry {
            Entry::Snapshot(snapshot) => Some(snapshot),
            _ => None,
        });
        let kept = all.enumerate().filter(|(number, _)| number.is_multiple_of(every) || *number == last);
        let snapshots: Vec<_> = kept.map(|(_, snapshot)| Arc::new(snapshot)).collect();
        if snapshots.is_empty() {
            return Err(Error::input(
                format!("{} holds no snapshot", run.display()),
                "the run was stopped before its first one; run it again",
            ));
        }
        Ok(Self {
            headline: Some(page::headline(&source).into_string()),
            one_draw: source.summary.one_draw.is_some(),
            info: source.info,
            samples: source.samples,
            ruptures: source.ruptures,
            seen: source.snapshots,
            extent: 0,
            snapshots,
            every,
            notices: Vec::new(),
            warnings: source.summary.warnings,
            notes: source.notes,
        })
    }

    /// A run that begins; `one_draw` where its bonds scatter.
    pub fn begin(info: Arc<RunInfo>, one_draw: bool) -> Self {
        Self {
            info,
            samples: Vec::new(),
            ruptures: Vec::new(),
            snapshots: Vec::new(),
            every: 1,
            seen: 0,
            extent: 0,
            headline: None,
            one_draw,
            notices: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Takes up what the run tells.
    pub fn hear(&mut self, told: Told) {
        self.extent += 1;
        match told {
            Told::Row(sample) => self.samples.push(sample),
            Told::Rupture(rupture) => self.ruptures.push(rupture),
            Told::Notice(notice) => renew(&mut self.notices, &notice),
            Told::State(snapshot) => self.add(snapshot, most(&self.info)),
        }
    }

    /// The newest state is always there; where there are too many, every other of those before it goes.
    fn add(&mut self, snapshot: Arc<Snapshot>, most: usize) {
        let passing = self.seen > 0 && !(self.seen - 1).is_multiple_of(self.every);
        if passing {
            self.snapshots.pop();
        }
        self.snapshots.push(snapshot);
        self.seen += 1;
        if self.snapshots.len() > most {
            self.every *= 2;
            let last = self.snapshots.len() - 1;
            let mut number = 0..;
            self.snapshots.retain(|_| number.next().is_some_and(|k: usize| k.is_multiple_of(2) || k == last));
        }
    }

    /// How much the run has told: more whenever it has told more.
    pub fn extent(&self) -> usize {
        self.extent
    }

    /// Steps of the snapshots around a state: which ones they are, where earlier ones have made room.
    pub fn steps(&self, state: f64) -> [u64; 2] {
        let last = self.states() - 1;
        let before = (state as usize).min(last);
        [before, (before + 1).min(last)].map(|number| self.snapshots[number].sample.step)
    }

    /// What a picture shows, in a line: `26.55 % strain, 307.6 MPa, 1 of 34 wires broken: wire 14 (middle layer) first`.
    pub fn caption(&self, state: f64) -> String {
        let (snapshot, abscissa) = (self.snapshot(state), Abscissa::of_run(&self.info));
        let sample = &snapshot.sample;
        let mut words = abscissa.moment(abscissa.value(sample));
        if self.info.is_pulled() {
            words += &format!(", {:.1} MPa nominal stress", mpa(sample.stress));
        }
        let wires = self.info.wires.len();
        if wires > 0 && !self.ruptures.is_empty() {
            words += &format!(", {} of {wires} wires broken", sample.wires_broken);
        }
        match self.ruptures.first().filter(|first| sample.step >= first.step && wires > 1) {
            Some(first) => {
                words + &format!(": wire {} ({}) first", wire_number(first.wire), layer_words(&self.info, first.layer))
            }
            None => words,
        }
    }

    /// What does not change during the run.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// How many snapshots there are; at least one.
    pub fn states(&self) -> usize {
        self.snapshots.len()
    }

    /// What is wrong with the run's folder, in sentences.
    pub fn notes(&self) -> Vec<String> {
        let (shown, of) = (self.states(), self.seen);
        let left_out =
            (shown < of).then(|| format!("{shown} of {of} snapshots are shown: all of them do not fit into memory."));
        self.notes.iter().cloned().chain(left_out).collect()
    }

    /// The snapshot of a state, or what lies between two.
    pub fn snapshot(&self, state: f64) -> Arc<Snapshot> {
        let before = (state as usize).min(self.states() - 1);
        match self.snapshots.get(before + 1) {
            Some(after) if state.fract() > 0.0 => Arc::new(between(&self.snapshots[before], after, state.fract())),
            _ => self.snapshots[before].clone(),
        }
    }

    /// Strain (%) or, in a run that is not pulled, time (ms) at a state.
    pub fn moment_of(&self, state: f64) -> f64 {
        let abscissa = Abscissa::of_run(&self.info);
        let at = |number: usize| abscissa.value(&self.snapshots[number.min(self.states() - 1)].sample);
        let before = state as usize;
        at(before) + (at(before + 1) - at(before)) * state.fract()
    }

    /// The first state at which strain (%) or time (ms) is that of `moment`; the first or the last one where it never is.
    pub fn state_at(&self, moment: f64) -> f64 {
        let abscissa = Abscissa::of_run(&self.info);
        self.first_state(moment, |sample| abscissa.value(sample)).unwrap_or((self.states() - 1) as f64)
    }

    /// The first state at which a number of the rows is `value` or more; `None` where it never is.
    pub fn first_state(&self, value: f64, of: impl Fn(&Sample) -> f64) -> Option<f64> {
        let at = |number: usize| of(&self.snapshots[number].sample);
        match (0..self.states()).find(|number| at(*number) >= value)? {
            0 => Some(0.0),
            after => {
                let [low, high] = [at(after - 1), at(after)];
                Some((after - 1) as f64 + (value - low) / (high - low))
            }
        }
    }

    /// The greatest that a number of the rows is at any state.
    pub fn greatest(&self, of: impl Fn(&Sample) -> f64) -> f64 {
        self.snapshots.iter().map(|snapshot| of(&snapshot.sample)).fold(f64::MIN, f64::max)
    }

    /// The first state at which rupture `index` has happened.
    pub fn break_state(&self, index: usize) -> Option<f64> {
        let step = self.ruptures.get(index)?.step;
        self.snapshots.iter().position(|snapshot| snapshot.sample.step >= step).map(|state| state as f64)
    }

    /// Every rupture so far, in order.
    pub fn ruptures(&self) -> &[Rupture] {
        &self.ruptures
    }

    /// Ends of the run's own colour scale; `None` where colours are no numbers.
    pub fn range(&self, by: ColourBy) -> Option<[f64; 2]> {
        ColourScale::new(self.info(), by).shown_range()
    }

    /// Name of the scene.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// What broke first, where and when, as markup.
    pub fn headline(&self) -> String {
        match (&self.headline, self.ruptures.first()) {
            (Some(headline), _) => headline.clone(),
            (None, Some(first)) => page::first_rupture(&self.info, first, self.one_draw).into_string(),
            (None, None) if self.info.wires.is_empty() => String::new(),
            (None, None) => "No wire has broken yet.".into(),
        }
    }

    /// Everything that does not depend on what is looked at.
    pub fn facts(&self) -> Value {
        let info = self.info();
        let abscissa = Abscissa::of_run(&self.info);
        let body = Body::of(info);
        let samples = thinned(&self.samples);
        let warnings = self.notices.iter().map(Notice::to_string);
        let wires = info.wires.iter().enumerate().map(|(number, wire)| {
            let first = self.ruptures.iter().find(|r| r.wire == number);
            json!({
                "number": wire_number(number), "layer": wire.layer, "first": wire.first, "len": wire.len,
                "diameter": mm(wire.diameter), "order": first.map(|r| r.order),
            })
        });
        json!({
            "headline": self.headline(), "extent": self.extent(), "every": self.every,
            "name": info.name, "about": info.about, "pulled": info.is_pulled(), "abscissa": abscissa.title(),
            "layers": (0..info.layers.len()).map(|l| layer_name(info, l)).collect::<Vec<_>>(),
            "wires": wires.collect::<Vec<_>>(), "wire_particles": info.wire_particles, "particles": info.particles,
            "curve": {
                "x": samples.iter().map(|s| short(abscissa.value(s))).collect::<Vec<_>>(),
                "y": samples.iter().map(|s| short(mpa(s.stress))).collect::<Vec<_>>(),
            },
            "states": self.snapshots.iter().map(|s| json!({
                "x": abscissa.value(&s.sample), "stress": mpa(s.sample.stress), "time_ms": ms(s.sample.time),
                "strain": percent(s.sample.strain), "wires_broken": s.sample.wires_broken,
            })).collect::<Vec<_>>(),
            "ruptures": self.ruptures.iter().map(|r| self.rupture(r, abscissa)).collect::<Vec<_>>(),
            "colours": ColourBy::ALL.map(|by| scale(info, by)),
            "body": {
                "low": shown(body.low.to_array()), "high": shown(body.high.to_array()),
                "axis": shown([body.axis.x, body.axis.y, 0.0])[..2], "radius": mm(f64::from(body.radius)),
                "gauge": info.gauge.map(|ends| ends.map(mm)),
            },
            "warnings": self.notes().into_iter().chain(self.warnings.iter().cloned()).chain(warnings).collect::<Vec<_>>(),
        })
    }

    fn rupture(&self, r: &Rupture, abscissa: Abscissa) -> Value {
        let state = self.snapshots.iter().position(|s| s.sample.step >= r.step).unwrap_or(self.states() - 1);
        json!({
            "order": r.order, "wire": r.wire, "layer": r.layer, "bond": r.bond, "bond_in_wire": r.bond_in_wire,
            "x": abscissa.at(r), "when": abscissa.moment(abscissa.at(r)), "rest_z": mm(r.rest_z), "z": mm(r.position[2]),
            "stress": mpa(r.stress), "body_stress": mpa(r.body_stress), "cause": cause(r.cause), "state": state,
            "first_of_wire": r.first_of_wire, "place": r.position.map(mm),
        })
    }

    /// What changes with the state: its numbers, the places of what is broken, and how far the body reaches.
    pub fn state(&self, view: &View) -> Value {
        let snapshot = self.snapshot(view.state);
        let info = self.info();
        let sample = &snapshot.sample;
        let abscissa = Abscissa::of_run(&self.info);
        let broken = self.ruptures.iter().filter(|r| snapshot.bond_state[r.bond] == BondState::Broken);
        let breaks = broken.map(|r| {
            let [a, b] = [r.bond, r.bond + 1].map(|i| snapshot.position[i]);
            let at = shown([0, 1, 2].map(|k| 0.5 * (a[k] + b[k])));
            json!({ "order": r.order, "at": at })
        });
        let whole = |layer: usize| {
            let wires = info.wires.iter().enumerate().filter(|(_, w)| w.layer == layer);
            let (mut whole, mut count) = (0, 0);
            for (_, wire) in wires {
                count += 1;
                let bonds = wire.first..wire.first + wire.len.saturating_sub(1);
                whole += usize::from(!snapshot.bond_state[bonds].contains(&BondState::Broken));
            }
            json!({ "whole": whole, "of": count })
        };
        let reach = |k: usize| {
            let all = snapshot.position.iter().map(|p| p[k]);
            [all.clone().fold(f32::MAX, f32::min), all.fold(f32::MIN, f32::max)].map(|end| mm(f64::from(end)))
        };
        json!({
            "state": view.state, "follow_offset": mm(f64::from(follow_offset(info, &snapshot, view))),
            "x": abscissa.value(sample), "when": abscissa.moment(abscissa.value(sample)),
            "stress": mpa(sample.stress), "time_ms": ms(sample.time), "wires_broken": sample.wires_broken,
            "bonds_broken": sample.bonds_broken, "layers": (0..info.layers.len()).map(whole).collect::<Vec<_>>(),
            "breaks": breaks.collect::<Vec<_>>(), "reach": [reach(0), reach(1), reach(2)],
        })
    }

    /// True axial stress of a wire at mid-gauge at the rows of the curve that [`Self::facts`] tells of.
    pub fn history(&self, wire: usize) -> Value {
        let stress = |s: &&Sample| s.wire_stress.get(wire).map(|v| short(mpa(*v)));
        json!({ "wire": wire, "stress": thinned(&self.samples).iter().map(stress).collect::<Vec<_>>() })
    }

    /// A wire along its length at a state.
    pub fn wire(&self, wire: usize, state: f64) -> Option<Value> {
        let of = self.info().wires.get(wire)?;
        let snapshot = self.snapshot(state);
        let bonds = of.first..of.first + of.len.saturating_sub(1);
        let held = |values: &[f32], unit: fn(f64) -> f64| -> Vec<Option<f64>> {
            bonds.clone().map(|b| snapshot.bond_state[b].holds().then(|| short(unit(f64::from(values[b]))))).collect()
        };
        let rest = &self.info().rest_position;
        Some(json!({
            "wire": wire, "state": state,
            "z": bonds.clone().map(|b| short(mm(0.5 * f64::from(rest[b][2] + rest[b + 1][2])))).collect::<Vec<_>>(),
            "stress": held(&snapshot.bond_stress, mpa), "plastic_strain": held(&snapshot.plastic_strain, percent),
            "utilisation": held(&snapshot.utilisation, percent),
        }))
    }

    /// A particle's numbers at a state.
    pub fn particle(&self, picked: Picked, state: f64) -> Value {
        let info = self.info();
        let snapshot = self.snapshot(state);
        let i = picked.particle;
        let wire = picked.wire.map(|w| &info.wires[w]);
        // The bonds on its two sides that hold.
        let bonds: Vec<usize> = wire.map_or(Vec::new(), |wire| {
            let before = i.checked_sub(1).filter(|b| *b >= wire.first);
            before.into_iter().chain(Some(i)).filter(|b| snapshot.bond_state[*b].holds()).collect()
        });
        let mean = |values: &[f32], unit: fn(f64) -> f64| {
            let sum: f64 = bonds.iter().map(|b| f64::from(values[*b])).sum();
            (!bonds.is_empty()).then(|| unit(sum / bonds.len() as f64))
        };
        json!({
            "particle": i, "wire": picked.wire, "number_in_wire": wire.map(|w| i - w.first + 1), "of": wire.map(|w| w.len),
            "layer": wire.map(|w| w.layer), "position": shown(snapshot.position[i]), "rest_z": mm(f64::from(info.rest_position[i][2])),
            "radius": mm(f64::from(snapshot.radius[i])), "speed": snapshot.speed[i],
            "contact_pressure": mpa(f64::from(snapshot.contact_pressure[i])),
            "stress": mean(&snapshot.bond_stress, mpa), "plastic_strain": mean(&snapshot.plastic_strain, percent),
            "utilisation": mean(&snapshot.utilisation, percent), "held_by": bonds.len(),
        })
    }
}

/// Snapshots of a run that are kept at most.
fn most(info: &RunInfo) -> usize {
    (MEMORY / (PARTICLE_BYTES * info.particles.max(1))).max(2)
}

/// The state between two snapshots, at `share` of the way (-): what can move or grow is between them, bonds are those of
/// the earlier one.
fn between(a: &Snapshot, b: &Snapshot, share: f64) -> Snapshot {
    let t = share as f32;
    let mix = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a + (b - a) * t).collect();
    let position = a.position.iter().zip(&b.position);
    let number = |of: fn(&Sample) -> f64| of(&a.sample) + (of(&b.sample) - of(&a.sample)) * share;
    let [strain, time, stress] = [number(|s| s.strain), number(|s| s.time), number(|s| s.stress)];
    Snapshot {
        sample: Sample { strain, time, stress, ..a.sample.clone() },
        position: position.map(|(a, b)| Vec3::from(*a).lerp(Vec3::from(*b), t).to_array()).collect(),
        radius: mix(&a.radius, &b.radius),
        speed: mix(&a.speed, &b.speed),
        bond_state: a.bond_state.clone(),
        bond_stress: mix(&a.bond_stress, &b.bond_stress),
        plastic_strain: mix(&a.plastic_strain, &b.plastic_strain),
        utilisation: mix(&a.utilisation, &b.utilisation),
        contact_pressure: mix(&a.contact_pressure, &b.contact_pressure),
        roll: mix(&a.roll, &b.roll),
        detail: None,
    }
}

/// Where the material section that a view rides on is now (m); 0 where it rides on none.
pub fn follow_offset(info: &RunInfo, snapshot: &Snapshot, view: &View) -> f32 {
    view.follow.map_or(0.0, |z| current_z(info, snapshot, (z / mm(1.0)) as f32))
}

/// Rows of a curve, evenly thinned; the last one and the greatest stress are kept.
fn thinned(samples: &[Sample]) -> Vec<&Sample> {
    let every = samples.len().div_ceil(MOST_POINTS).max(1);
    let peak = samples.iter().enumerate().max_by(|a, b| a.1.stress.total_cmp(&b.1.stress)).map(|(k, _)| k);
    let kept = |k: usize| k.is_multiple_of(every) || k + 1 == samples.len() || Some(k) == peak;
    samples.iter().enumerate().filter(|(k, _)| kept(*k)).map(|(_, s)| s).collect()
}

/// A place in mm.
fn shown(place: [f32; 3]) -> [f64; 3] {
    place.map(|x| mm(f64::from(x)))
}

/// Five digits: what a chart shows.
fn short(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// A colour scale for a legend.
fn scale(info: &RunInfo, by: ColourBy) -> Value {
    let scale = ColourScale::new(info, by);
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    let stops = (0..STOPS).map(|k| hex(scale.at(k as f64 / (STOPS - 1) as f64)));
    let categories = match by {
        ColourBy::Layer => info.layers.len(),
        ColourBy::Material => info.materials.len(),
        ColourBy::Wire => info.wires.len(),
        _ => 0,
    };
    json!({
        "word": by.word(), "about": by.about(), "title": scale.title(), "range": scale.shown_range(),
        "stops": stops.collect::<Vec<_>>(),
        "categories": (0..categories).map(|k| hex(ColourScale::category(k))).collect::<Vec<_>>(),
    })
}
