//! The contacts of one chunk of particles as they are kept between steps.
//!
//! Most candidates never touch: of these only the place is kept, and with the first touch comes the rest. What is alike for
//! all contacts of a particle is not kept at all, and shares of cells only where they are not whole.

use super::chains::Chains;
use super::curve::Place;
use super::record::{Contact, Kind, Mode, WHOLE};
use super::spread::FarSum;
use crate::engine::bytes::behind;
use crate::engine::contact::pair::History;
use crate::engine::state::ChunkSums;
use crate::law::contact::NormalLaw;
use crate::law::contact::line::CELLS;
use crate::law::tangential::TangentialLaw;

/// In the place of a place in a list.
const NOTHING: u32 = u32::MAX;

/// What is kept of every candidate; see [`Contact`].
#[derive(Clone, Copy)]
pub struct Candidate {
    t: f64,
    viscosity: f64,
    reduced_radius: f64,
    pub i: u32,
    pub j: u32,
    /// Its place among those that have touched.
    touched: u32,
    pub kind: Kind,
    pub mode: Mode,
    pub joined: bool,
    pub edge: bool,
    end_to_end: bool,
}

/// What is kept of a candidate that has touched, or whose overlap does not count; see [`Contact`].
#[derive(Clone, Copy)]
struct Touched<N: NormalLaw, T: TangentialLaw> {
    history: History<N, T>,
    dents: [f64; CELLS],
    per_length: f64,
    overlap: f64,
    reach: f64,
    length: f64,
    curvature: f64,
    energy: f64,
    u: f64,
    arm: [f64; 2],
    /// Place of the shares in their list.
    shares: u32,
}

impl<N: NormalLaw, T: TangentialLaw> Touched<N, T> {
    fn of(c: &Contact<N, T>) -> Self {
        let Contact { history, dents, per_length, overlap, reach, length, curvature, energy, u, arm, .. } = *c;
        Self { history, dents, per_length, overlap, reach, length, curvature, energy, u, arm, shares: NOTHING }
    }

    /// Whether it is as if it had never touched. A zero of the other sign is something.
    fn is_nothing(&self) -> bool {
        let Self { per_length, overlap, reach, length, curvature, energy, u, arm, .. } = *self;
        let own = [per_length, overlap, reach, length, curvature, energy, u, arm[0], arm[1]];
        let mut bits = own.iter().chain(&self.dents).fold(0, |bits, number| bits | number.to_bits());
        self.history.each_number(|_, number| bits |= number.to_bits());
        bits == 0
    }
}

/// The contacts of one chunk of particles, in the order of these.
pub struct Store<N: NormalLaw, T: TangentialLaw> {
    pub candidates: Vec<Candidate>,
    /// Nothing can touch until [`State::travel`](crate::engine::state::State::travel) has reached this (m); of each, in a
    /// row: most are not looked at.
    pub quiet_until: Vec<f64>,
    touched: Vec<Touched<N, T>>,
    shares: Vec<[f64; CELLS]>,
    /// What contacts do to the other wires' bonds at this step.
    pub acting: Vec<FarSum>,
    /// Energies of the last step.
    pub sum: ChunkSums,
}

impl<N: NormalLaw, T: TangentialLaw> Default for Store<N, T> {
    fn default() -> Self {
        Self {
            candidates: Vec::new(),
            quiet_until: Vec::new(),
            touched: Vec::new(),
            shares: Vec::new(),
            acting: Vec::new(),
            sum: ChunkSums::default(),
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Store<N, T> {
    /// Without contacts, with room for `count`, of which so many have touched as in `before`.
    pub fn like(before: &Self, count: usize) -> Self {
        Self {
            candidates: Vec::with_capacity(count),
            quiet_until: Vec::with_capacity(count),
            touched: Vec::with_capacity(before.touched.len()),
            ..Self::default()
        }
    }

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.candidates.len()
    }

    /// Whether a contact pushes.
    #[inline(always)]
    pub fn touching(&self, k: usize) -> bool {
        self.touched.get(self.candidates[k].touched as usize).is_some_and(|touched| touched.history.touching())
    }

    /// A contact.
    #[inline(always)]
    pub fn contact(&self, k: usize, chains: &Chains) -> Contact<N, T> {
        let Candidate { t, viscosity, reduced_radius, i, j, touched, kind, mode, joined, edge, end_to_end } =
            self.candidates[k];
        let (quiet_until, cell_length) = (self.quiet_until[k], chains.cell_length(i as usize));
        let untouched = Contact::untouched(i, Place { j, t, joined }, kind, reduced_radius, cell_length);
        let contact = Contact { quiet_until, mode, edge, end_to_end, viscosity, ..untouched };
        let Some(touched) = self.touched.get(touched as usize) else { return contact };
        let Touched { history, dents, per_length, overlap, reach, length, curvature, energy, u, arm, shares } =
            *touched;
        let shares = self.shares.get(shares as usize).copied().unwrap_or(WHOLE);
        Contact { history, dents, shares, per_length, overlap, reach, length, curvature, energy, u, arm, ..contact }
    }

    /// All contacts that push.
    pub fn all_touching<'a>(&'a self, chains: &'a Chains) -> impl Iterator<Item = Contact<N, T>> + 'a {
        (0..self.len()).filter(|k| self.touching(*k)).map(|k| self.contact(k, chains))
    }

    /// Number of contacts that push.
    pub fn active(&self) -> usize {
        self.touched.iter().filter(|touched| touched.history.touching()).count()
    }

    /// Adds a contact.
    pub fn push(&mut self, c: &Contact<N, T>) {
        let Contact { place: Place { j, t, joined }, viscosity, i, kind, mode, edge, end_to_end, .. } = *c;
        let reduced_radius = c.history.reduced_radius;
        let touched = NOTHING;
        self.candidates.push(Candidate {
            t,
            viscosity,
            reduced_radius,
            i,
            j,
            touched,
            kind,
            mode,
            joined,
            edge,
            end_to_end,
        });
        self.quiet_until.push(c.quiet_until);
        self.put(self.len() - 1, c);
    }

    /// Takes a contact back after a step. What is the same from one list of candidates to the next stays as it was.
    #[inline(always)]
    pub fn put(&mut self, k: usize, c: &Contact<N, T>) {
        self.quiet_until[k] = c.quiet_until;
        let candidate = &mut self.candidates[k];
        (candidate.j, candidate.t, candidate.joined) = (c.place.j, c.place.t, c.place.joined);
        candidate.end_to_end = c.end_to_end;
        let mut touched = Touched::of(c);
        match self.touched.get_mut(candidate.touched as usize) {
            Some(before) => {
                touched.shares = before.shares;
                *before = touched;
            }
            None if touched.is_nothing() && c.shares == WHOLE => return,
            None => {
                candidate.touched = self.touched.len() as u32;
                push(&mut self.touched, touched);
            }
        }
        if touched.shares != NOTHING || c.shares != WHOLE {
            self.put_shares(k, c.shares);
        }
    }

    /// Takes the shares of a contact that has touched.
    fn put_shares(&mut self, k: usize, shares: [f64; CELLS]) {
        let Some(touched) = self.touched.get_mut(self.candidates[k].touched as usize) else { return };
        match self.shares.get_mut(touched.shares as usize) {
            Some(before) => *before = shares,
            None => {
                touched.shares = self.shares.len() as u32;
                push(&mut self.shares, shares);
            }
        }
    }

    /// Adds what a contact does to the other wire.
    pub fn act(&mut self, far: FarSum) {
        push(&mut self.acting, far);
    }

    /// Memory that is read and written at each step (bytes).
    pub fn moved(&self) -> usize {
        size_of_val(&self.quiet_until[..])
            + size_of_val(&self.candidates[..])
            + 2 * (size_of_val(&self.touched[..]) + size_of_val(&self.acting[..]))
    }

    /// Memory behind it (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.candidates)
            + behind(&self.quiet_until)
            + behind(&self.touched)
            + behind(&self.shares)
            + behind(&self.acting)
    }
}

/// Adds to a list with little to spare: there is one for every chunk, and all of one are seldom filled.
fn push<A>(list: &mut Vec<A>, item: A) {
    if list.len() == list.capacity() {
        list.reserve_exact(4 + list.len() / 8);
    }
    list.push(item);
}
