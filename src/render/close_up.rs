//! Where close-ups look: mid-length, then the first break, then the place where most wires broke. It follows from the
//! ruptures that were told so far, moves over some frames and never jumps.

use super::body::Body;
use super::camera::Camera;
use crate::base::units::mm;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::fracture::{Fracture, LENGTH, MAIN, densest};
use crate::scene::spec::CameraSpec;
use glam::Vec3;
use std::f64::consts::PI;

/// How many times more wires must have broken elsewhere, or on the other side, before the eye goes there (-).
const LEAD: f64 = 1.25;
/// Shift of a fracture's middle, over the body's radius, that the eye does not follow (-).
const STILL: f32 = 0.5;
/// Frames that a move takes.
const FRAMES: u32 = 10;

/// What a close-up shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    /// The middle of what is loaded: nothing broke so far.
    Middle,
    /// A section that was asked for.
    Chosen,
    /// The first break.
    FirstBreak,
    /// The place where most wires broke.
    MainFracture,
}

/// A section and the side of it that is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    subject: Subject,
    /// z before loading (m).
    z: f32,
    /// Turn of the eye about the axis (rad): 0 in front, π behind.
    turn: f64,
}

/// Where close-ups look in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Focus {
    /// z before loading of the section in the middle of the view (m).
    pub z: f32,
    /// Turn of the eye about the axis, where a close-up shows one side alone (rad): 0 in front, π behind.
    pub turn: f64,
    place: Place,
    /// Nothing broke there so far, and it is known that it will.
    to_come: bool,
}

impl Focus {
    /// What is shown, in words, such as `main fracture, 60 mm`: z before loading.
    pub fn words(&self) -> String {
        let what = match self.place.subject {
            Subject::Middle => "mid-length",
            Subject::Chosen => "section",
            Subject::FirstBreak => "first break",
            Subject::MainFracture => "main fracture",
        };
        let place = format!("{what}, {:.0} mm", mm(self.place.z.into()));
        match (self.to_come, self.z == self.place.z && self.turn == self.place.turn) {
            (true, _) => format!("{place}, still whole"),
            (false, true) => place,
            (false, false) => format!("on the way to {place}"),
        }
    }

    /// Which side the eye sees, in a word.
    pub fn side(&self) -> &'static str {
        if self.turn < 0.5 * PI { "front" } else { "back" }
    }
}

/// The eye, from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct CloseUp {
    /// All ruptures of a run that is over: the eye then looks at its main fracture from the first frame.
    known: Option<Vec<Rupture>>,
    target: Option<Place>,
    /// Where the move to the target began: z (m) and turn (rad).
    from: [f64; 2],
    frames: u32,
}

impl CloseUp {
    /// One that knows what is going to break.
    pub fn knowing(ruptures: Vec<Rupture>) -> Self {
        Self { known: Some(ruptures), ..Self::default() }
    }

    /// Goes on by a frame; `ruptures` are all so far.
    pub fn follow(&mut self, info: &RunInfo, body: &Body, look: &CameraSpec, ruptures: &[Rupture]) {
        let seen = self.known.as_deref().unwrap_or(ruptures);
        let wanted = Sight { info, body, look, breaks: breaks(info, body, look, seen) }.wanted(self.target);
        match self.target {
            // Nothing was shown before.
            None => self.frames = FRAMES,
            Some(target) if (target.z, target.turn) != (wanted.z, wanted.turn) => {
                self.from = self.at();
                self.frames = 1;
            }
            Some(_) => self.frames = (self.frames + 1).min(FRAMES),
        }
        self.target = Some(wanted);
    }

    /// z before loading (m) and turn (rad) of the eye now.
    fn at(&self) -> [f64; 2] {
        let Some(target) = self.target else { return [0.0; 2] };
        let to = [f64::from(target.z), target.turn];
        if self.frames >= FRAMES {
            return to;
        }
        let t = f64::from(self.frames) / f64::from(FRAMES);
        let share = t * t * (3.0 - 2.0 * t);
        [0, 1].map(|k| self.from[k] + share * (to[k] - self.from[k]))
    }

    /// Where close-ups look now; the middle of the body before the first frame. `ruptures` are all so far.
    pub fn focus(&self, info: &RunInfo, body: &Body, ruptures: &[Rupture]) -> Focus {
        let place = self.target.unwrap_or_else(|| middle(info, body));
        let [z, turn] = if self.target.is_some() { self.at() } else { [place.z.into(), place.turn] };
        let there = |r: &Rupture| (r.rest_z as f32 - place.z).abs() <= 0.5 * LENGTH * body.radius;
        let breaks = matches!(place.subject, Subject::FirstBreak | Subject::MainFracture);
        Focus { z: z as f32, turn, place, to_come: breaks && !ruptures.iter().any(there) }
    }
}

fn middle(info: &RunInfo, body: &Body) -> Place {
    let [low, high] = info.gauge.unwrap_or([body.low.z.into(), body.high.z.into()]);
    Place { subject: Subject::Middle, z: (0.5 * (low + high)) as f32, turn: 0.0 }
}

/// A break as the eye sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Break {
    /// z before loading (m).
    z: f32,
    wire: usize,
    /// On the far side, judged before loading: it never changes.
    behind: bool,
}

/// Breaks in their order.
fn breaks(info: &RunInfo, body: &Body, look: &CameraSpec, ruptures: &[Rupture]) -> Vec<Break> {
    let to_eye = Camera::orientation(look.azimuth, look.elevation);
    let behind = |bond: usize| {
        let across = Vec3::from(info.rest_position[bond]) - body.axis;
        (to_eye * across.with_z(0.0)).z < 0.0
    };
    ruptures.iter().map(|r| Break { z: r.rest_z as f32, wire: r.wire, behind: behind(r.bond) }).collect()
}

/// What there is to look at.
struct Sight<'a> {
    info: &'a RunInfo,
    body: &'a Body,
    look: &'a CameraSpec,
    breaks: Vec<Break>,
}

impl Sight<'_> {
    /// Where to look, from where the eye looks or goes to now.
    fn wanted(&self, now: Option<Place>) -> Place {
        let side = |z: f32| self.side(z, now);
        if let Some(z) = self.look.focus_z.map(|z| z as f32) {
            return Place { subject: Subject::Chosen, z, turn: side(z) };
        }
        let Some(first) = self.breaks.first() else { return middle(self.info, self.body) };
        let on_breaks = |p: &Place| matches!(p.subject, Subject::FirstBreak | Subject::MainFracture);
        let held = now.filter(on_breaks).map_or(first.z, |place| place.z);
        let length = LENGTH * self.body.radius;
        let mut fracture = densest(self.breaks.iter().map(|b| (b.z, b.wire)), length);
        let apart = (fracture.z - held).abs();
        let here = self.wires_within(held - 0.5 * length, held + 0.5 * length);
        if apart > length && fracture.wires as f64 <= LEAD * here as f64 {
            fracture = Fracture { wires: here, z: held };
        } else if apart < STILL * self.body.radius {
            fracture.z = held;
        }
        let has_first = (first.z - fracture.z).abs() <= length;
        if has_first && fracture.wires < MAIN {
            return Place { subject: Subject::FirstBreak, z: first.z, turn: side(first.z) };
        }
        Place { subject: Subject::MainFracture, z: fracture.z, turn: side(fracture.z) }
    }

    fn wires_within(&self, low: f32, high: f32) -> usize {
        let there = self.breaks.iter().filter(|b| (low..=high).contains(&b.z));
        there.map(|b| b.wire).collect::<std::collections::HashSet<_>>().len()
    }

    /// The side on which most bonds broke about `z` (m), as a turn (rad).
    fn side(&self, z: f32, now: Option<Place>) -> f64 {
        let near = |b: &&Break| (b.z - z).abs() <= LENGTH * self.body.radius;
        let there: Vec<&Break> = self.breaks.iter().filter(near).collect();
        let behind = there.iter().filter(|b| b.behind).count();
        let before = there.len() - behind;
        let ahead = |a: usize, b: usize| a as f64 > LEAD * b as f64;
        // On a draw the eye stays where it is; where it sees none yet, the first one decides.
        let stays = match (now.filter(|now| near(&&Break { z: now.z, wire: 0, behind: false })), there.first()) {
            (Some(now), _) if now.subject != Subject::Middle => now.turn > 0.0,
            (_, first) => first.is_some_and(|first| first.behind),
        };
        let is_behind = if stays { !ahead(before, behind) } else { ahead(behind, before) };
        if is_behind { PI } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bundle with a radius of a millimetre, 100 mm long, all of whose bonds lie in front.
    fn bundle() -> (RunInfo, Body) {
        let info =
            RunInfo { rest_position: vec![[-1e-3, 0.0, 0.0]; 64], gauge: Some([0.0, 0.1]), ..RunInfo::default() };
        let body = Body {
            low: Vec3::new(-1e-3, -1e-3, 0.0),
            high: Vec3::new(1e-3, 1e-3, 0.1),
            axis: Vec3::ZERO,
            radius: 1e-3,
            depth: Vec::new(),
            layer_radius: Vec::new(),
        };
        (info, body)
    }

    fn ruptures(places: &[f64]) -> Vec<Rupture> {
        let one = |(wire, mm): (usize, &f64)| Rupture { wire, bond: wire, rest_z: mm * 1e-3, ..Rupture::default() };
        places.iter().enumerate().map(one).collect()
    }

    /// z (mm) and words after each frame of a run in which one more of `places` (mm) has broken every `pause` frames.
    fn watched(places: &[f64], pause: usize) -> Vec<(f32, String)> {
        let (info, body) = bundle();
        let all = ruptures(places);
        let mut close_up = CloseUp::default();
        let frame = |k: usize| {
            let so_far = &all[..(k / pause).min(all.len())];
            close_up.follow(&info, &body, &CameraSpec::default(), so_far);
            let focus = close_up.focus(&info, &body, so_far);
            (1e3 * focus.z, focus.words())
        };
        (0..pause * (places.len() + 1)).map(frame).collect()
    }

    /// Where the wires of the main scene broke (mm).
    const KA4: [f64; 12] = [39.29, 59.81, 40.83, 60.58, 59.81, 58.85, 59.62, 60.19, 59.81, 59.42, 58.85, 62.14];

    #[test]
    fn the_eye_goes_to_the_first_break_and_on_to_where_most_wires_break() {
        let seen = watched(&KA4, 12);
        assert_eq!(seen[11], (50.0, "mid-length, 50 mm".into()));
        assert_eq!(seen[12].1, "on the way to first break, 39 mm");
        assert_eq!(seen[47], (39.29, "first break, 39 mm".into()), "two wires each: it stays");
        let last = seen.last().unwrap();
        assert!((last.0 - 60.0).abs() < 1.0 && last.1 == "main fracture, 60 mm", "{last:?}");
    }

    #[test]
    fn the_eye_never_jumps() {
        let seen = watched(&KA4, 3);
        let fastest = seen.windows(2).map(|pair| (pair[1].0 - pair[0].0).abs()).fold(0.0, f32::max);
        assert!(fastest < 20.0 * 1.6 / FRAMES as f32, "{fastest} mm in a frame");
    }

    #[test]
    fn the_eye_does_not_go_back_and_forth() {
        // Two places in turn: neither ever gets a lead.
        let places: Vec<f64> = (0..20).map(|k| if k % 2 == 0 { 20.0 } else { 80.0 }).collect();
        let seen = watched(&places, 15);
        assert!(seen[30..].iter().all(|(z, _)| (z - 20.0).abs() < 1.0), "{seen:?}");
    }

    #[test]
    fn of_a_run_that_is_over_the_main_fracture_is_seen_from_the_first_frame() {
        let (info, body) = bundle();
        let mut close_up = CloseUp::knowing(ruptures(&KA4));
        close_up.follow(&info, &body, &CameraSpec::default(), &[]);
        let before = close_up.focus(&info, &body, &[]);
        assert_eq!(before.words(), "main fracture, 60 mm, still whole");
        close_up.follow(&info, &body, &CameraSpec::default(), &ruptures(&KA4));
        let after = close_up.focus(&info, &body, &ruptures(&KA4));
        assert_eq!((after.z, after.words()), (before.z, "main fracture, 60 mm".into()));
    }

    #[test]
    fn a_section_that_was_chosen_is_kept() {
        let (info, body) = bundle();
        let look = CameraSpec { focus_z: Some(0.07), ..CameraSpec::default() };
        let mut close_up = CloseUp::default();
        close_up.follow(&info, &body, &look, &[]);
        close_up.follow(&info, &body, &look, &ruptures(&KA4));
        let focus = close_up.focus(&info, &body, &ruptures(&KA4));
        assert_eq!((focus.z, focus.words()), (0.07, "section, 70 mm".into()));
    }

    #[test]
    fn the_eye_turns_to_the_side_where_most_broke() {
        let (mut info, body) = bundle();
        let all = ruptures(&[50.0, 50.2, 50.4, 50.6]);
        for bond in 1..4 {
            info.rest_position[bond][0] = 1e-3;
        }
        let mut close_up = CloseUp::default();
        let mut turns = Vec::new();
        for broken in [0, 1, 2, 3] {
            for _ in 0..=FRAMES {
                close_up.follow(&info, &body, &CameraSpec::default(), &all[..broken]);
            }
            turns.push(close_up.focus(&info, &body, &all[..broken]).side());
        }
        assert_eq!(turns, ["front", "front", "front", "back"]);
    }
}
