//! Which particles are joined to which.

use crate::engine::bytes::behind;
use crate::engine::state::State;
use crate::law::contact::line::CELLS;
use crate::strand::assembly::Assembly;
use std::ops::Range;

/// Bonds to either side that must hold for a bond to count as far from an end.
const MARGIN: usize = 4;

/// Which particles are joined to which.
pub struct Chains {
    /// Wire of each particle; `u32::MAX` for free spheres.
    pub wire_of: Vec<u32>,
    /// Per wire, the number of bonds within which it cannot touch itself.
    pub apart: Vec<u32>,
    /// Spacing of each wire (m).
    spacing: Vec<f64>,
    /// Whether each slot had a bond at the start.
    bonded: Vec<bool>,
}

impl Chains {
    /// Of `assembly`; `apart` per wire as [`crate::engine::neighbours::apart`] gives it.
    pub fn new(assembly: &Assembly, apart: Vec<u32>) -> Self {
        let bonded = (0..assembly.len()).map(|slot| assembly.is_bond(slot)).collect();
        let spacing = assembly.wires.iter().map(|w| assembly.rest_length[w.first]).collect();
        Self { wire_of: assembly.wire_of.clone(), apart, spacing, bonded }
    }

    /// Spacing of the wire of particle `p` (m); 0 of a free sphere.
    pub fn spacing(&self, p: usize) -> f64 {
        self.spacing.get(self.wire_of[p] as usize).copied().unwrap_or(0.0)
    }

    /// Length of a cell of the stretch around particle `p`, along the undeformed wire (m).
    #[inline(always)]
    pub fn cell_length(&self, p: usize) -> f64 {
        let [low, high] = self.reach(p);
        (high - low) / CELLS as f64 * self.spacing(p)
    }

    /// Whether two particles belong to one wire.
    pub fn one_wire(&self, a: u32, b: u32) -> bool {
        let wire = self.wire_of[a as usize];
        wire != u32::MAX && wire == self.wire_of[b as usize]
    }

    /// Whether two particles belong to one wire and all bonds between them hold.
    pub fn one_piece(&self, a: u32, b: u32, state: &State) -> bool {
        let (first, last) = (a.min(b) as usize, a.max(b) as usize);
        self.one_wire(a, b) && state.whole[first..last].iter().all(|w| *w)
    }

    /// Whether bond `k` belongs to the surroundings of particle `i` on its own wire, which it never touches. A contact of
    /// a wire with itself would otherwise walk home along the wire.
    pub fn beside(&self, i: usize, k: usize, state: &State) -> bool {
        let apart = self.apart[self.wire_of[i] as usize] as usize;
        let between = if k < i { k + 1..i } else { i..k };
        between.len() < apart && state.whole[between].iter().all(|w| *w)
    }

    /// Memory that it keeps (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.wire_of) + behind(&self.apart) + behind(&self.spacing) + behind(&self.bonded)
    }

    /// Those of some slots whose bond broke.
    pub fn broken<'a>(&'a self, slots: Range<usize>, state: &'a State) -> impl Iterator<Item = usize> + 'a {
        slots.filter(|slot| self.bonded[*slot] && !state.whole[*slot])
    }

    /// Whether a particle has no bond: a free sphere, or what two breaks have left.
    pub fn alone(&self, p: usize, state: &State) -> bool {
        !state.whole[p] && !before(state, p)
    }

    /// Whether particle `i` lies near an end of its piece, or bond `j` near one of its: within a few bonds, so that no
    /// contact reaches the end before the next list. A wire beside itself counts as near.
    pub fn near_end(&self, i: u32, j: u32, state: &State) -> bool {
        let (i, j) = (i as usize, j as usize);
        let holds = |from: usize, to: usize| state.whole.get(from..to).is_some_and(|near| near.iter().all(|w| *w));
        self.one_wire(i as u32, j as u32)
            || i < 2
            || j < MARGIN
            || !holds(i - 2, i + 2)
            || !holds(j - MARGIN, j + MARGIN + 1)
    }

    /// How far the length that particle `p` stands for reaches to either side, in bonds (-): half a bond, also where it
    /// broke, and nothing beyond the ends that the wire has had from the start.
    pub fn reach(&self, p: usize) -> [f64; 2] {
        let half = |bonded: bool| if bonded { 0.5 } else { 0.0 };
        [-half(p > 0 && self.bonded[p - 1]), half(self.bonded[p])]
    }
}

/// Whether the bond before particle `p` holds.
pub fn before(state: &State, p: usize) -> bool {
    p > 0 && state.whole[p - 1]
}
