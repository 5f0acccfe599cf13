//! The contacts of one chunk of particles at one step: which are looked at, alone or several at once, and what they add up
//! to.

use super::batch::{Answers, Batch, Gaps};
use super::meeting::{Meets, Sides};
use super::record::{Contact, Mode};
use super::spread::NearSum;
use super::store::Store;
use crate::engine::state::{ChunkSums, Deepest};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;
use pulp::{Arch, Simd, WithSimd};

/// What a chunk works with.
#[derive(Default)]
struct Work {
    gaps: Gaps,
    /// Contacts of the first law.
    batch: Batch,
    /// Contacts of each further one.
    further: Vec<Batch>,
    answers: Answers,
}

impl Work {
    /// Of `laws` laws.
    fn new(laws: usize) -> Self {
        Self { further: (1..laws).map(|_| Batch::default()).collect(), ..Self::default() }
    }

    /// The contacts of the law at `place`.
    #[inline(always)]
    fn batch(&mut self, place: usize) -> &mut Batch {
        match place.checked_sub(1) {
            None => &mut self.batch,
            Some(k) => &mut self.further[k],
        }
    }
}

/// The contacts of one chunk of particles.
pub struct Chunk<'a, N: NormalLaw, T: TangentialLaw> {
    pub meets: Meets<'a, N, T>,
    pub arch: Arch,
    /// The first particle.
    pub first: usize,
    pub store: &'a mut Store<N, T>,
    pub near: &'a mut [NearSum],
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
    /// Computes all; the deepest contact before this step is `deepest`.
    pub fn compute(mut self, deepest: Deepest) {
        let laws = self.meets.laws.len();
        let mut work = Work::new(laws);
        self.store.acting.clear();
        self.store.sum = ChunkSums::beyond(deepest);
        self.near.fill(NearSum::default());
        for k in 0..self.store.len() {
            if self.store.quiet_until[k] > self.meets.state.travel {
                continue;
            }
            let candidate = &self.store.candidates[k];
            if candidate.mode == Mode::Point || candidate.edge {
                self.alone(k);
            } else if self.store.touching(k) {
                self.take(&mut work, k);
            } else {
                work.gaps.take(k, &self.contact(k), self.meets.state);
                if work.gaps.full() {
                    self.part(&mut work);
                }
            }
        }
        self.part(&mut work);
        (0..laws).for_each(|law| self.run(&mut work, law));
    }

    #[inline(always)]
    fn contact(&self, k: usize) -> Contact<N, T> {
        self.store.contact(k, self.meets.chains)
    }

    /// Takes contact `k` back, and adds up what it does, with the energies that it gives off.
    #[inline(always)]
    fn book(&mut self, k: usize, c: &Contact<N, T>, act: &Sides, partial: ChunkSums) {
        self.store.sum.add(&partial);
        self.store.put(k, c);
        if act.near.acts {
            let sum = &mut self.near[c.i as usize - self.first];
            sum.acts = true;
            sum.force.iter_mut().zip(act.near.force).for_each(|(sum, f)| *sum += f);
            sum.moment += act.near.moment;
            self.store.act(act.far);
        }
    }

    /// A contact that is taken by itself.
    #[inline(never)]
    fn alone(&mut self, k: usize) {
        let (mut act, mut deepest) = (Sides::default(), self.store.sum.deepest);
        let mut contact = self.contact(k);
        let alone = Alone { meets: &self.meets, contact: &mut contact, act: &mut act, deepest: &mut deepest };
        let partial = self.arch.dispatch(alone);
        self.book(k, &contact, &act, ChunkSums { deepest, ..partial });
    }

    /// Puts a contact into the batch of its law, which is run when it is full.
    fn take(&mut self, work: &mut Work, k: usize) {
        let contact = self.contact(k);
        let law = self.meets.laws.place(contact.i as usize, contact.place.j as usize);
        work.batch(law).take(k, &contact, &self.meets);
        if work.batch(law).full() {
            self.run(work, law);
        }
    }

    /// Looks whether contacts that were apart still are.
    #[inline(never)]
    fn part(&mut self, work: &mut Work) {
        let found = self.arch.dispatch(work.gaps.find());
        for lane in 0..work.gaps.contacts().len() {
            let (k, [t, gap]) = (work.gaps.contacts()[lane], found.map(|row| row[lane]));
            if !(0.0..=1.0).contains(&t) {
                // On to the next bond.
                self.alone(k);
            } else if gap < 0.0 {
                self.take(work, k);
            } else {
                let mut c = self.contact(k);
                c.place.t = t;
                self.meets.apart(&mut c, gap);
                self.store.put(k, &c);
            }
        }
        work.gaps.clear();
    }

    /// Takes contacts that touch through their law, the one at `law`.
    #[inline(never)]
    fn run(&mut self, work: &mut Work, law: usize) {
        let Work { batch, further, answers, .. } = work;
        let batch = law.checked_sub(1).map_or(batch, |k| &mut further[k]);
        self.arch.dispatch(batch.answer(&self.meets, self.meets.laws.at(law), answers));
        for lane in 0..batch.contacts().len() {
            let k = batch.contacts()[lane];
            if !(0.0..=1.0).contains(&answers.place(lane)) {
                // On to the next bond.
                self.alone(k);
                continue;
            }
            let (mut act, mut deepest) = (Sides::default(), self.store.sum.deepest);
            let mut c = self.contact(k);
            let touch = answers.at(lane, &mut c);
            let partial = self.meets.finish(&mut c, &touch, 0.0, &mut act, &mut deepest);
            self.book(k, &c, &act, ChunkSums { deepest, ..partial });
        }
        batch.clear();
    }
}
