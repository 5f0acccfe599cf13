//! The contacts of one chunk of particles at one step: which are looked at, alone or several at once, and what they add up
//! to.

use super::batch::{Answers, Batch, Gaps};
use super::meeting::{Meets, Sides};
use super::record::{Contact, Mode};
use super::spread::{FarSum, NearSum};
use crate::engine::state::{ChunkSums, Deepest};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;
use pulp::{Arch, Simd, WithSimd};

/// What a chunk works with, kept for its memory.
#[derive(Default)]
pub struct Work {
    gaps: Gaps,
    batch: Batch,
    answers: Answers,
    /// What contacts do to the other wires' bonds.
    pub acting: Vec<FarSum>,
}

/// The contacts of one chunk of particles.
pub struct Chunk<'a, N: NormalLaw, T: TangentialLaw> {
    pub meets: Meets<'a, N, T>,
    pub arch: Arch,
    /// The first particle.
    pub first: usize,
    pub contacts: &'a mut [Contact<N, T>],
    /// That of each contact, in a row: most are not looked at.
    pub quiet_until: &'a mut [f64],
    pub near: &'a mut [NearSum],
    pub sum: ChunkSums,
    pub work: &'a mut Work,
}

/// One contact by itself, with the instructions of the machine: the laws round as these do, and without them a library
/// function has to ([`Real::mul_add`](crate::base::lanes::Real::mul_add)).
struct Alone<'a, 'b, N: NormalLaw, T: TangentialLaw> {
    meets: &'b Meets<'a, N, T>,
    contact: &'b mut Contact<N, T>,
    act: &'b mut Sides,
    deepest: &'b mut Deepest,
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Alone<'_, '_, N, T> {
    type Output = ChunkSums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> ChunkSums {
        self.meets.contact(self.contact, self.act, self.deepest)
    }
}

impl<N: NormalLaw, T: TangentialLaw> Chunk<'_, N, T> {
    /// The energies of the step.
    pub fn compute(mut self) -> ChunkSums {
        self.work.acting.clear();
        self.near.fill(NearSum::default());
        for k in 0..self.contacts.len() {
            if self.quiet_until[k] > self.meets.state.travel {
                continue;
            }
            let c = &self.contacts[k];
            if c.mode == Mode::Point || c.edge {
                self.alone(k);
            } else if c.history.touching() {
                self.take(k);
            } else {
                self.work.gaps.take(k, c, self.meets.state);
                if self.work.gaps.full() {
                    self.part();
                }
            }
        }
        self.part();
        self.run();
        self.sum
    }

    /// Adds up what contact `k` does, with the energies that it gives off.
    fn book(&mut self, k: usize, act: &Sides, partial: ChunkSums) {
        self.sum.add(&partial);
        let c = &self.contacts[k];
        self.quiet_until[k] = c.quiet_until;
        if act.near.acts {
            let sum = &mut self.near[c.i as usize - self.first];
            sum.acts = true;
            sum.force.iter_mut().zip(act.near.force).for_each(|(sum, f)| *sum += f);
            sum.moment += act.near.moment;
            self.work.acting.push(act.far);
        }
    }

    /// A contact that is taken by itself.
    #[inline(never)]
    fn alone(&mut self, k: usize) {
        let (mut act, mut deepest) = (Sides::default(), self.sum.deepest);
        let contact = &mut self.contacts[k];
        let alone = Alone { meets: &self.meets, contact, act: &mut act, deepest: &mut deepest };
        let partial = self.arch.dispatch(alone);
        self.book(k, &act, ChunkSums { deepest, ..partial });
    }

    /// Puts a contact into the batch, which is run when it is full.
    fn take(&mut self, k: usize) {
        self.work.batch.take(k, &self.contacts[k], &self.meets);
        if self.work.batch.full() {
            self.run();
        }
    }

    /// Looks whether contacts that were apart still are.
    #[inline(never)]
    fn part(&mut self) {
        let found = self.arch.dispatch(self.work.gaps.find());
        for lane in 0..self.work.gaps.contacts().len() {
            let (k, [t, gap]) = (self.work.gaps.contacts()[lane], found.map(|row| row[lane]));
            if !(0.0..=1.0).contains(&t) {
                // On to the next bond.
                self.alone(k);
            } else if gap < 0.0 {
                self.take(k);
            } else {
                let c = &mut self.contacts[k];
                c.place.t = t;
                self.meets.apart(c, gap);
                self.quiet_until[k] = c.quiet_until;
            }
        }
        self.work.gaps.clear();
    }

    /// Takes contacts that touch through the laws.
    #[inline(never)]
    fn run(&mut self) {
        let Work { batch, answers, .. } = &mut *self.work;
        self.arch.dispatch(batch.answer(&self.meets, answers));
        for lane in 0..self.work.batch.contacts().len() {
            let k = self.work.batch.contacts()[lane];
            if !(0.0..=1.0).contains(&self.work.answers.place(lane)) {
                // On to the next bond.
                self.alone(k);
                continue;
            }
            let (mut act, mut deepest) = (Sides::default(), self.sum.deepest);
            let c = &mut self.contacts[k];
            let touch = self.work.answers.at(lane, c);
            let partial = self.meets.finish(c, &touch, 0.0, &mut act, &mut deepest);
            self.book(k, &act, ChunkSums { deepest, ..partial });
        }
        self.work.batch.clear();
    }
}
