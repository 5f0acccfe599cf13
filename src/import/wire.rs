//! A wire: pieces that follow one another, measured.

use super::shape::{Mark, Piece};
use glam::DVec3;

/// Distance of all points of a wire from the line between its ends over its length up to which it is straight (-).
const STRAIGHT: f64 = 1e-9;

/// A piece with marks along it.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The piece.
    pub piece: Piece,
    /// Marks along it.
    pub marks: Vec<Mark>,
}

/// Pieces that follow one another.
#[derive(Debug, Clone)]
pub struct Wire {
    /// The pieces, in the order of the wire.
    pub pieces: Vec<Measured>,
    /// Its diameter (m), where the file gives it.
    pub diameter: Option<f64>,
}

impl Measured {
    /// Its length (m).
    pub fn length(&self) -> f64 {
        self.marks[self.marks.len() - 1].arc
    }

    /// Where it begins and ends (m).
    pub fn ends(&self) -> [DVec3; 2] {
        [self.marks[0].point, self.marks[self.marks.len() - 1].point]
    }

    /// Unit vector by which it leaves at its end, or at its start.
    pub fn outward(&self, at_end: bool) -> DVec3 {
        let last = self.marks.len() - 1;
        let [tip, before] = if at_end { [last, last - 1] } else { [0, 1] };
        (self.marks[tip].point - self.marks[before].point).normalize_or_zero()
    }

    /// The other way round.
    pub fn reversed(self) -> Self {
        let length = self.length();
        let marks = self.marks.into_iter().rev().map(|mark| Mark { arc: length - mark.arc, ..mark }).collect();
        Self { piece: self.piece.reversed(), marks }
    }

    /// The point of the piece at a length from its start (m).
    pub fn at(&self, arc: f64) -> DVec3 {
        let after = self.marks.partition_point(|mark| mark.arc < arc).clamp(1, self.marks.len() - 1);
        let (a, b) = (&self.marks[after - 1], &self.marks[after]);
        let share = if b.arc > a.arc { ((arc - a.arc) / (b.arc - a.arc)).clamp(0.0, 1.0) } else { 0.0 };
        self.piece.point(a.t + (b.t - a.t) * share)
    }

    /// Greatest curvature of its smooth parts (1/m).
    fn curvature(&self) -> f64 {
        let of = |three: &[Mark]| {
            let (u, v) = (three[1].point - three[0].point, three[2].point - three[1].point);
            let mean = 0.5 * (u.length() + v.length());
            if three[1].is_break || mean == 0.0 { 0.0 } else { u.cross(v).length().atan2(u.dot(v)) / mean }
        };
        self.marks.windows(3).map(of).fold(0.0, f64::max)
    }
}

impl Wire {
    /// Its length (m).
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(Measured::length).sum()
    }

    /// Where it begins and ends (m).
    pub fn ends(&self) -> [DVec3; 2] {
        [self.pieces[0].ends()[0], self.pieces[self.pieces.len() - 1].ends()[1]]
    }

    /// `count` + 1 points at equal distances along it (m).
    pub fn even(&self, count: usize) -> Vec<DVec3> {
        let total = self.length();
        let (mut piece, mut before) = (0, 0.0);
        (0..=count)
            .map(|i| {
                let arc = total * i as f64 / count as f64;
                while piece + 1 < self.pieces.len() && before + self.pieces[piece].length() < arc {
                    before += self.pieces[piece].length();
                    piece += 1;
                }
                self.pieces[piece].at(arc - before)
            })
            .collect()
    }

    /// Whether it is given by points alone.
    pub fn is_polygon(&self) -> bool {
        self.pieces.iter().all(|part| part.piece.shape.is_polygon())
    }

    /// Whether it is straight, and never turns back.
    pub fn is_straight(&self) -> bool {
        let [from, to] = self.ends();
        let Some(along) = (to - from).try_normalize() else { return false };
        let (most, mut reached) = (STRAIGHT * self.length(), 0.0f64);
        self.pieces.iter().flat_map(|part| &part.marks).all(|mark| {
            let way = (mark.point - from).dot(along);
            reached = reached.max(way);
            (mark.point - from).reject_from_normalized(along).length() <= most && way >= reached - most
        })
    }

    /// Points along it (m) whose polygon it leaves by `chord` (m) at most: a curve of curvature κ leaves chords of length h
    /// by κ h²/8. Those of a polygon are its own. `None` where there would be more than `most`.
    pub fn points(&self, chord: f64, most: usize) -> Option<Vec<DVec3>> {
        if self.is_straight() {
            return Some(self.ends().to_vec());
        }
        let curvature = self.pieces.iter().map(Measured::curvature).fold(0.0, f64::max);
        let spacing = match self.is_polygon() {
            true => f64::INFINITY,
            false => (8.0 * chord / curvature).sqrt(),
        };
        let mut points = vec![self.ends()[0]];
        for part in &self.pieces {
            // Corners of a polygon stay; a curve is divided evenly from end to end.
            let stops: Vec<f64> = match part.piece.shape.is_polygon() {
                true => part.marks.iter().map(|mark| mark.arc).collect(),
                false => vec![0.0, part.length()],
            };
            for two in stops.windows(2) {
                let steps = ((two[1] - two[0]) / spacing).ceil().max(1.0);
                if points.len() as f64 + steps > most as f64 {
                    return None;
                }
                points.extend((1..=steps as usize).map(|i| part.at(two[0] + (two[1] - two[0]) * i as f64 / steps)));
            }
        }
        Some(points)
    }
}
