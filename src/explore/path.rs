//! The path of a camera: key views, each with its state of the run, and the views between them.

use super::record::{Record, follow_offset};
use super::view::View;
use crate::base::error::{Error, Result};
use crate::base::units::{mm, shortest};
use crate::engine::view::Snapshot;

/// Pictures of a film in a second.
const RATE: f64 = 30.0;
/// How long the last picture stays (ms).
const END: u32 = 1500;
/// Key views of a path.
const VIEWS: std::ops::RangeInclusive<usize> = 2..=64;
/// Time from one to the next (s), and longest time of all of them.
const SECONDS: std::ops::RangeInclusive<f64> = 0.1..=60.0;
const LONGEST: f64 = 180.0;

/// Key views and the time from each to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The views that the camera comes by, in their order.
    pub views: Vec<View>,
    /// From each to the next (s).
    pub seconds: f64,
}

impl Path {
    /// Checks that a run has what the views name, and that the path is one that a film can be made of.
    ///
    /// # Errors
    /// [`Error::Input`] that says what is wrong and what would be right.
    pub fn check(&self, record: &Record) -> Result<()> {
        let (count, of) = (self.views.len(), self.views.len().saturating_sub(1) as f64 * self.seconds);
        if !VIEWS.contains(&count) {
            return Err(Error::input(
                format!("a film of {count} views cannot be made"),
                format!("its camera goes from view to view: give {} to {} of them", VIEWS.start(), VIEWS.end()),
            ));
        }
        if !SECONDS.contains(&self.seconds) || of > LONGEST {
            let [low, high] = [*SECONDS.start(), *SECONDS.end()].map(shortest);
            return Err(Error::input(
                format!("a film cannot take {} s from view to view, with {count} views", shortest(self.seconds)),
                format!("give a time from {low} to {high} s, so that all of it takes {} s at most", shortest(LONGEST)),
            ));
        }
        self.views.iter().try_for_each(|view| view.check(record.info(), record.states()))
    }

    /// Pictures from one key view to the next.
    fn steps(&self) -> usize {
        ((self.seconds * RATE).round() as usize).max(1)
    }

    /// How many pictures the film has: the first and the last are key views.
    pub fn pictures(&self) -> usize {
        self.views.len().saturating_sub(1) * self.steps() + 1
    }

    /// How long a picture is shown (ms).
    pub fn shown(&self, number: usize) -> u32 {
        let begin = |number: usize| (1000.0 * number as f64 / RATE).round() as u32;
        if number + 1 == self.pictures() { END } else { begin(number + 1) - begin(number) }
    }

    /// The view of a picture: key views as they are, and between two what can move as far as it has come. What cannot (colours,
    /// what is hidden, the ground) is that of the earlier one.
    pub fn view(&self, record: &Record, number: usize) -> View {
        let (leg, step) = (number / self.steps(), number % self.steps());
        match self.views.get(leg + 1) {
            Some(after) if step > 0 => between(record, &self.views[leg], after, step as f64 / self.steps() as f64),
            _ => self.views[leg].clone(),
        }
    }
}

/// What lies at `share` of the way (-) from one view to the next. The run goes on evenly; the camera sets off and arrives
/// gently.
fn between(record: &Record, from: &View, to: &View, share: f64) -> View {
    let gentle = share * share * (3.0 - 2.0 * share);
    let mix = |a: f64, b: f64| a + (b - a) * gentle;
    let state = from.state + (to.state - from.state) * share;
    let snapshot = record.snapshot(state);
    // Two that ride on the same section ride on it all the way; otherwise each end is where it would be now.
    let rides = from.follow == to.follow;
    let centre = |view: &View| {
        let [x, y, z] = view.centre;
        let offset = if rides { 0.0 } else { mm(f64::from(follow_offset(record.info(), &snapshot, view))) };
        [x, y, z + offset]
    };
    let (a, b) = (centre(from), centre(to));
    let cut = (from.cut.is_some() || to.cut.is_some()).then(|| {
        let top = top(&snapshot);
        mix(from.cut.unwrap_or(top), to.cut.unwrap_or(top))
    });
    let range = match (from.range, to.range) {
        (Some([low, high]), Some([to_low, to_high])) if from.colour == to.colour => {
            Some([mix(low, to_low), mix(high, to_high)])
        }
        _ => from.range,
    };
    View {
        state,
        azimuth: from.azimuth + turn(from.azimuth, to.azimuth) * gentle,
        elevation: from.elevation + turn(from.elevation, to.elevation) * gentle,
        centre: [0, 1, 2].map(|k| mix(a[k], b[k])),
        // The same share of the picture in the same time, however near the eye is.
        height: (from.height.ln() + (to.height.ln() - from.height.ln()) * gentle).exp(),
        perspective: mix(from.perspective, to.perspective),
        follow: from.follow.filter(|_| rides),
        range,
        explode: mix(from.explode, to.explode),
        cut,
        ..from.clone()
    }
}

/// The shorter way from one angle to another (°).
fn turn(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

/// Where nothing is cut off any more (mm).
fn top(snapshot: &Snapshot) -> f64 {
    let ends = snapshot.position.iter().zip(&snapshot.radius).map(|(p, r)| p[2] + r);
    mm(f64::from(ends.fold(f32::MIN, f32::max)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::{RunInfo, Sample};
    use crate::explore::record::Told;
    use std::sync::Arc;

    /// Two particles whose upper one goes from z = 10 mm to 12 mm in four states.
    fn record() -> Record {
        let info = RunInfo {
            particles: 2,
            radius: vec![1e-3; 2],
            rest_position: vec![[0.0; 3], [0.0, 0.0, 10e-3]],
            ..RunInfo::default()
        };
        let mut record = Record::begin(Arc::new(info), false);
        for step in 0..=3u8 {
            let position = vec![[0.0; 3], [0.0, 0.0, 10e-3 + 2e-3 * f32::from(step) / 3.0]];
            let sample = Sample { step: step.into(), ..Sample::default() };
            let snapshot = Snapshot { sample, position, radius: vec![1e-3; 2], ..Snapshot::default() };
            record.hear(Told::State(Arc::new(snapshot)));
        }
        record
    }

    #[test]
    fn key_views_are_met_and_what_lies_between_is_between() {
        let record = record();
        let from = View { azimuth: 170.0, height: 8.0, ..View::default() };
        let to = View { state: 3.0, azimuth: -170.0, height: 2.0, explode: 1.0, cut: Some(5.0), ..View::default() };
        let path = Path { views: vec![from.clone(), to.clone(), from.clone()], seconds: 1.0 };
        assert_eq!(path.pictures(), 61);
        path.check(&record).unwrap();
        for (number, key) in [(0, &from), (30, &to), (60, &from)] {
            assert_eq!(path.view(&record, number), *key);
        }
        let middle = path.view(&record, 15);
        assert!((middle.state - 1.5).abs() < 1e-12 && (middle.explode - 0.5).abs() < 1e-12);
        assert!((middle.azimuth - 180.0).abs() < 1e-9, "the shorter way, over 180°: {}", middle.azimuth);
        assert!((middle.height - 4.0).abs() < 1e-12);
        // From the top, at z = 12 mm in the middle of the way (11 mm and a radius).
        assert!((middle.cut.unwrap() - 8.5).abs() < 1e-5, "{:?}", middle.cut);
        let turns: Vec<f64> = (0..=30).map(|k| path.view(&record, k).azimuth.rem_euclid(360.0)).collect();
        assert!(turns.is_sorted(), "{turns:?}");
        for number in 0..path.pictures() {
            path.view(&record, number).check(record.info(), record.states()).unwrap();
        }
    }

    #[test]
    fn a_camera_that_leaves_the_section_it_rides_on_does_not_jump() {
        let record = record();
        let on = View { follow: Some(10.0), ..View::default() };
        let off = View { state: 3.0, centre: [0.0, 0.0, 6.0], ..View::default() };
        let path = Path { views: vec![on, off], seconds: 2.0 };
        let at = |number: usize| {
            let view = path.view(&record, number);
            view.centre[2] + mm(f64::from(follow_offset(record.info(), &record.snapshot(view.state), &view)))
        };
        let places: Vec<f64> = (0..path.pictures()).map(at).collect();
        let widest = places.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!((places[0] - 10.0).abs() < 1e-5 && (places[60] - 6.0).abs() < 1e-5, "{places:?}");
        assert!(widest < 0.2, "a step of {widest} mm: {places:?}");
    }

    #[test]
    fn every_picture_is_shown_and_the_last_one_longer() {
        let path = Path { views: vec![View::default(); 3], seconds: 0.5 };
        let all: Vec<u32> = (0..path.pictures()).map(|number| path.shown(number)).collect();
        assert_eq!(all.iter().sum::<u32>(), 1000 + END);
        assert!(all[..all.len() - 1].iter().all(|shown| (33..=34).contains(shown)), "{all:?}");
    }

    #[test]
    fn what_is_no_film_is_refused() {
        let record = record();
        let path = |count: usize, seconds: f64| Path { views: vec![View::default(); count], seconds };
        for (path, word) in [
            (path(1, 2.0), "2 to 64"),
            (path(65, 0.1), "2 to 64"),
            (path(2, 0.0), "0.1 to 60 s"),
            (path(2, f64::NAN), "0.1 to 60 s"),
            (path(20, 20.0), "180 s"),
        ] {
            let Error::Input { help: Some(help), .. } = path.check(&record).unwrap_err() else { panic!("{word}") };
            assert!(help.contains(word), "{help}");
        }
        let beyond = Path { views: vec![View::default(), View { state: 9.0, ..View::default() }], seconds: 1.0 };
        assert!(beyond.check(&record).is_err());
    }
}
