//! The main fracture: the place where most wires broke. Recording and frames look there.

use std::collections::HashMap;

/// Length before loading that one fracture takes up at most, over the body's radius (-): what a close-up shows.
pub const LENGTH: f32 = 4.0;
/// Wires that make a fracture more than the first break.
pub const MAIN: usize = 3;

/// Breaks near one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fracture {
    /// Wires that broke there.
    pub wires: usize,
    /// Middle of the breaks, z before loading, in the unit in which they were given.
    pub z: f32,
}

/// The `length` within which most wires broke; of several, the one with the lowest z. `breaks` are z before loading and
/// wire of each, `length` is in the unit of z.
pub fn densest(breaks: impl Iterator<Item = (f32, usize)>, length: f32) -> Fracture {
    let mut sorted: Vec<(f32, usize)> = breaks.collect();
    sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut best = Fracture { wires: 0, z: 0.0 };
    // How often each wire broke between `low` and `high`.
    let mut count: HashMap<usize, usize> = HashMap::new();
    let mut low = 0;
    for &(high, wire) in &sorted {
        *count.entry(wire).or_default() += 1;
        while high - sorted[low].0 > length {
            let wire = sorted[low].1;
            let left = count.get_mut(&wire).map_or(0, |n| {
                *n -= 1;
                *n
            });
            if left == 0 {
                count.remove(&wire);
            }
            low += 1;
        }
        if count.len() > best.wires {
            best = Fracture { wires: count.len(), z: 0.5 * (sorted[low].0 + high) };
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wires_count_and_not_breaks() {
        // One wire breaks four times at 10 mm, three wires once each about 50 mm, of which two are 4 mm apart.
        let breaks = [(10.0, 0), (10.1, 0), (10.2, 0), (10.3, 0), (52.0, 1), (48.0, 2), (50.0, 3), (90.0, 1)];
        assert_eq!(densest(breaks.into_iter(), 4.0), Fracture { wires: 3, z: 50.0 });
        assert_eq!(densest(breaks.into_iter(), 3.0), Fracture { wires: 2, z: 49.0 });
        assert_eq!(densest(std::iter::empty(), 4.0).wires, 0);
    }
}
