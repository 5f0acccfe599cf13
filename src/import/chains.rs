//! Pieces joined end to end.

use super::fault::{Unread, Why};
use super::shape::Piece;
use super::wire::{Measured, Wire};
use glam::DVec3;
use std::collections::HashMap;

/// Difference of diameters, over the greater, up to which pieces belong to one wire (-).
const SAME_DIAMETER: f64 = 0.01;

/// Cosine of the sharpest corner of a wire (-): lines that meet and go back side by side are two wires.
const SHARPEST: f64 = -0.2;

/// Ends that meet, and are too many to say which goes on where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fork {
    /// Where (m).
    pub place: DVec3,
    /// How many end there.
    pub ends: usize,
}

/// Wires of a file.
#[derive(Debug, Clone, Default)]
pub struct Chains {
    /// The wires, in the order of their first pieces.
    pub wires: Vec<Wire>,
    /// Pieces that are none.
    pub unread: Vec<Unread>,
    /// Where pieces were not joined.
    pub forks: Vec<Fork>,
    /// Distance up to which ends are joined (m).
    pub reach: f64,
}

/// Joins pieces whose ends are at most `reach` (m) apart; where that is not given, a hundredth of the least diameter, or a
/// millionth of the extent where no piece has one.
pub fn join(pieces: Vec<Piece>, reach: Option<f64>) -> Chains {
    let mut chains = Chains::default();
    let mut measured: Vec<Measured> = Vec::new();
    for piece in pieces {
        match piece.marks() {
            Ok(marks) => measured.push(Measured { piece, marks }),
            Err(unread) => chains.unread.push(unread),
        }
    }
    chains.reach = reach.unwrap_or_else(|| usual_reach(&measured));
    let measured = chains.without_repeated(measured);
    chains.walk(measured);
    chains.merge_lines_of_tubes();
    chains
}

fn usual_reach(all: &[Measured]) -> f64 {
    let least = all.iter().filter_map(|part| part.piece.diameter).fold(f64::INFINITY, f64::min);
    if least.is_finite() {
        return 0.01 * least;
    }
    let points = all.iter().flat_map(|part| part.marks.iter().map(|mark| mark.point));
    let (low, high) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    if all.is_empty() { 0.0 } else { 1e-6 * low.distance(high) }
}

/// Points by cells, so that those near a point are found among few.
struct Grid {
    cell: f64,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl Grid {
    fn new(points: &[DVec3], reach: f64) -> Self {
        let cell = reach.max(1e-12) * 2.0;
        let mut grid = Self { cell, cells: HashMap::new() };
        for (i, point) in points.iter().enumerate() {
            grid.cells.entry(grid.at(*point)).or_default().push(i);
        }
        grid
    }

    fn at(&self, point: DVec3) -> [i64; 3] {
        (point / self.cell).to_array().map(|x| x.floor() as i64)
    }

    /// Points that may be within the reach.
    fn near(&self, point: DVec3) -> impl Iterator<Item = usize> + '_ {
        let at = self.at(point);
        let steps = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        steps.flat_map(move |step: [i64; 3]| {
            let cell = [0, 1, 2].map(|axis| at[axis].saturating_add(step[axis]));
            self.cells.get(&cell).into_iter().flatten().copied()
        })
    }
}

fn are_of_one_wire(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME_DIAMETER * a.max(b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

impl Chains {
    /// Pieces without those that lie on others from end to end.
    fn without_repeated(&mut self, all: Vec<Measured>) -> Vec<Measured> {
        let middles: Vec<DVec3> = all.iter().map(|part| part.at(0.5 * part.length())).collect();
        let grid = Grid::new(&middles, self.reach);
        let reach = self.reach;
        let near = move |p: DVec3, q: DVec3| p.distance(q) <= reach;
        let is_same = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (all[i].ends(), all[j].ends());
            let ends = (near(a, c) && near(b, d)) || (near(a, d) && near(b, c));
            ends && near(middles[i], middles[j]) && are_of_one_wire(all[i].piece.diameter, all[j].piece.diameter)
        };
        let repeats: Vec<bool> =
            (0..all.len()).map(|i| grid.near(middles[i]).any(|j| j < i && is_same(i, j))).collect();
        let mut kept = Vec::new();
        for (part, repeats) in all.into_iter().zip(repeats) {
            match repeats {
                true => self.unread.push(Unread { why: Why::Twice, place: part.piece.source }),
                false => kept.push(part),
            }
        }
        kept
    }

    fn walk(&mut self, all: Vec<Measured>) {
        // End 2 i is the start of piece i, 2 i + 1 its end.
        let ends: Vec<DVec3> = all.iter().flat_map(|part| part.ends()).collect();
        let grid = Grid::new(&ends, self.reach);
        let diameter = |end: usize| all[end / 2].piece.diameter;
        let outward = |end: usize| all[end / 2].outward(end % 2 == 1);
        let meeting = |end: usize| -> Vec<usize> {
            let near =
                grid.near(ends[end]).filter(|other| *other != end && ends[end].distance(ends[*other]) <= self.reach);
            let goes_on = |other: &usize| outward(end).dot(outward(*other)) < -SHARPEST;
            near.filter(|other| are_of_one_wire(diameter(end), diameter(*other)) && goes_on(other)).collect()
        };
        let partners: Vec<Vec<usize>> = (0..ends.len()).map(meeting).collect();
        let partner = |end: usize| match partners[end][..] {
            [other] if partners[other] == [end] => Some(other),
            _ => None,
        };
        for (end, others) in partners.iter().enumerate() {
            // Told once, by the first of those that might go on in several ways.
            if others.len() > 1 && others.iter().all(|other| *other > end || partners[*other].len() < 2) {
                self.forks.push(Fork { place: ends[end], ends: others.len() + 1 });
            }
        }
        let mut taken = vec![false; all.len()];
        let mut chains: Vec<Vec<(usize, bool)>> = Vec::new();
        for start in (0..ends.len()).filter(|end| partner(*end).is_none()) {
            if taken[start / 2] {
                continue;
            }
            let (mut chain, mut end) = (Vec::new(), start);
            loop {
                taken[end / 2] = true;
                chain.push((end / 2, end % 2 == 1));
                match partner(end ^ 1) {
                    Some(next) => end = next,
                    None => break,
                }
            }
            chains.push(chain);
        }
        let mut pieces: Vec<Option<Measured>> = all.into_iter().map(Some).collect();
        for chain in chains {
            let take = |(i, is_reversed): (usize, bool)| {
                let part = pieces[i].take().expect("a piece is in one chain only");
                if is_reversed { part.reversed() } else { part }
            };
            let parts: Vec<Measured> = chain.into_iter().map(take).collect();
            let wire = Wire { diameter: parts[0].piece.diameter, pieces: parts };
            let [from, to] = wire.ends();
            match from.distance(to) <= self.reach {
                true => self.unread.push(Unread { why: Why::Closed, place: wire.pieces[0].piece.source.clone() }),
                false => self.wires.push(wire),
            }
        }
        // What is left has no ends.
        let closed = pieces.into_iter().flatten().map(|part| Unread { why: Why::Closed, place: part.piece.source });
        self.unread.extend(closed);
    }

    /// Leaves out lines that are centre lines of tubes too, as programs write them that keep the path of a sweep.
    fn merge_lines_of_tubes(&mut self) {
        let stations = |wire: &Wire| wire.even(4);
        let tubes: Vec<(Vec<DVec3>, f64)> =
            self.wires.iter().filter_map(|wire| Some((stations(wire), wire.diameter?))).collect();
        let unread = &mut self.unread;
        let middles: Vec<DVec3> = tubes.iter().map(|(points, _)| points[2]).collect();
        let greatest = tubes.iter().map(|(_, diameter)| *diameter).fold(0.0, f64::max);
        // The axis of a tube that a program has approximated is off by some of its radius' per cents.
        let grid = Grid::new(&middles, 0.05 * greatest);
        self.wires.retain(|wire| {
            if wire.diameter.is_some() {
                return true;
            }
            let own = stations(wire);
            let is_axis = |(points, diameter): &(Vec<DVec3>, f64)| {
                let near = |p: &DVec3, q: &DVec3| p.distance(*q) <= 0.05 * diameter;
                own.iter().zip(points).all(|(p, q)| near(p, q)) || own.iter().rev().zip(points).all(|(p, q)| near(p, q))
            };
            let is_known = grid.near(own[2]).any(|k| is_axis(&tubes[k]));
            if is_known {
                unread.push(Unread { why: Why::Twice, place: wire.pieces[0].piece.source.clone() });
            }
            !is_known
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::fault::Place;
    use crate::import::shape::Shape;
    use glam::DAffine3;
    use std::sync::Arc;

    fn line(from: [f64; 3], to: [f64; 3]) -> Piece {
        let (origin, end) = (DVec3::from(from), DVec3::from(to));
        Piece {
            shape: Arc::new(Shape::Line { origin, direction: end - origin }),
            from: 0.0,
            to: 1.0,
            place: DAffine3::IDENTITY,
            diameter: None,
            source: Place { entity: "LINE".into(), number: None, line: 1 },
        }
    }

    #[test]
    fn pieces_are_joined_in_any_order_and_direction() {
        let pieces = vec![
            line([0.0, 0.0, 2.0], [0.0, 0.0, 3.0]),
            line([5.0, 0.0, 0.0], [5.0, 0.0, 3.0]),
            line([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
            line([0.0, 0.0, 0.0], [0.0, 0.0, 1.0 + 1e-7]),
        ];
        let chains = join(pieces, None);
        assert_eq!((chains.wires.len(), chains.forks.len(), chains.unread.len()), (2, 0, 0));
        assert_eq!(chains.wires.iter().map(|wire| wire.pieces.len()).collect::<Vec<_>>(), [3, 1]);
        assert!((chains.wires[0].length() - 3.0).abs() < 1e-6);
        assert!(chains.wires[0].is_polygon());
        let even = chains.wires[0].even(3);
        assert!(even.iter().enumerate().all(|(i, p)| p.distance(even[0].lerp(even[3], i as f64 / 3.0)) < 1e-6));
    }

    #[test]
    fn forks_loops_and_repeated_pieces_are_told() {
        let (a, b, c, d) = ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, 1.0, 0.0]);
        let fork = join(vec![line(a, b), line([0.0, 0.1, -1.0], a), line(a, [0.0, -0.1, -1.0])], None);
        assert_eq!((fork.wires.len(), fork.forks.len(), fork.forks[0].ends), (3, 1, 3));
        let side_by_side = join(vec![line(a, b), line(a, [0.0, 0.1, 1.0])], None);
        assert_eq!((side_by_side.wires.len(), side_by_side.forks.len()), (2, 0));
        let ring = join(vec![line(a, b), line(b, c), line(c, d), line(d, a)], None);
        assert_eq!((ring.wires.len(), ring.unread.len(), &ring.unread[0].why), (0, 4, &Why::Closed));
        let twice = join(vec![line(a, b), line(b, a)], None);
        assert_eq!((twice.wires.len(), &twice.unread[0].why), (1, &Why::Twice));
        let tube = Piece { diameter: Some(0.1), ..line(a, b) };
        let both = join(vec![line(b, a), tube], None);
        assert_eq!((both.wires.len(), both.wires[0].diameter), (1, Some(0.1)));
    }
}
