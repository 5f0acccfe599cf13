//! Stretches beside other wires, far from any end, as many at once as a register holds.

use super::beside::{Act, Answer, Beside, ROUNDS};
use super::meeting::Meets;
use super::record::{Contact, Touch};
use crate::base::lanes::{BLOCK, Lanes, Mask, Real};
use crate::base::triple::Triple;
use crate::engine::contact::pair::{Dissipated, History, Laws};
use crate::engine::state::State;
use crate::law::contact::NormalLaw;
use crate::law::contact::line::CELLS;
use crate::law::tangential::TangentialLaw;
use pulp::{Simd, WithSimd};

/// Rows of a batch: where each field begins.
const NEAR: usize = 0;
const NEAR_VELOCITY: usize = NEAR + 15;
const FAR: usize = NEAR_VELOCITY + 15;
const FAR_VELOCITY: usize = FAR + 12;
const SPIN: usize = FAR_VELOCITY + 12;
const RADIUS: usize = SPIN + 9;
const PLACE: usize = RADIUS + 3;
const LENGTH: usize = PLACE + 1;
const PER_LENGTH: usize = LENGTH + 1;
const REACH: usize = PER_LENGTH + 1;
const VISCOSITY: usize = REACH + 1;
const REDUCED: usize = VISCOSITY + 1;
const DENTS: usize = REDUCED + 1;
const HISTORY: usize = DENTS + CELLS;
/// Numbers of the longest history.
const NUMBERS: usize = 24;
const ROWS: usize = HISTORY + NUMBERS;

/// Contacts to be taken at once, field by field in `ROWS` rows.
pub struct Queue<const ROWS: usize> {
    /// By their place in the chunk.
    contacts: [usize; BLOCK],
    count: usize,
    rows: [[f64; BLOCK]; ROWS],
}

impl<const ROWS: usize> Default for Queue<ROWS> {
    fn default() -> Self {
        // Where there is no contact, lanes are computed all the same.
        Self { contacts: [0; BLOCK], count: 0, rows: [[1.0; BLOCK]; ROWS] }
    }
}

impl<const ROWS: usize> Queue<ROWS> {
    /// Whether no more can be taken in.
    pub fn full(&self) -> bool {
        self.count == BLOCK
    }

    /// Forgets them.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// The contacts, by their place in the chunk.
    pub fn contacts(&self) -> &[usize] {
        &self.contacts[..self.count]
    }

    /// Lane of the next contact, which is the chunk's `k`-th.
    #[inline(always)]
    fn next(&mut self, k: usize) -> usize {
        // The count is below BLOCK always; said so that no bound is checked again and again.
        let lane = self.count % BLOCK;
        self.contacts[lane] = k;
        self.count += 1;
        lane
    }

    /// `COUNT` vectors from `at` on, axis by axis, to the rows from `first` on.
    #[inline(always)]
    fn put<const COUNT: usize>(&mut self, lane: usize, first: usize, from: [&[f64]; 3], at: usize) {
        for (axis, stream) in from.into_iter().enumerate() {
            for (k, value) in stream[at..at + COUNT].iter().enumerate() {
                self.rows[first + axis * COUNT + k][lane] = *value;
            }
        }
    }

    /// Points of the stretch and the other bond, from `streams` of positions or velocities.
    #[inline(always)]
    fn put_points(&mut self, lane: usize, [near, far]: [usize; 2], streams: [&[f64]; 3], [i, j]: [usize; 2]) {
        self.put::<5>(lane, near, streams, i - 2);
        self.put::<4>(lane, far, streams, j - 1);
    }

    /// The three radii, from row `first` on.
    #[inline(always)]
    fn put_radii(&mut self, lane: usize, first: usize, radius: &[f64], [i, j]: [usize; 2]) {
        self.rows[first][lane] = radius[i];
        self.rows[first + 1][lane] = radius[j];
        self.rows[first + 2][lane] = radius[j + 1];
    }
}

/// Contacts that touch.
pub type Batch = Queue<ROWS>;
/// Contacts that were apart, to be looked at.
pub type Gaps = Queue<GAP_ROWS>;

/// Rows of [`Gaps`].
const GAP_NEAR: usize = 0;
const GAP_FAR: usize = GAP_NEAR + 15;
const GAP_RADIUS: usize = GAP_FAR + 12;
const GAP_PLACE: usize = GAP_RADIUS + 3;
const GAP_OFFSET: usize = GAP_PLACE + 1;
const GAP_ROWS: usize = GAP_OFFSET + 1;

impl Gaps {
    /// Takes a contact in; its surroundings must hold on both wires.
    #[inline(always)]
    pub fn take<N: NormalLaw, T: TangentialLaw>(&mut self, k: usize, c: &Contact<N, T>, state: &State) {
        let (lane, pair) = (self.next(k), [c.i as usize, c.place.j as usize]);
        self.put_points(lane, [GAP_NEAR, GAP_FAR], state.x.rows(), pair);
        self.put_radii(lane, GAP_RADIUS, &state.radius, pair);
        self.rows[GAP_PLACE][lane] = c.place.t;
        self.rows[GAP_OFFSET][lane] = c.history.offset;
    }

    /// Finds foot (-) and gap (m) of each, with the instructions of the machine.
    pub fn find(&self) -> impl WithSimd<Output = [[f64; BLOCK]; 2]> {
        Find { gaps: self }
    }
}

struct Find<'a> {
    gaps: &'a Gaps,
}

impl WithSimd for Find<'_> {
    type Output = [[f64; BLOCK]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [[f64; BLOCK]; 2] {
        let mut found = [[0.0; BLOCK]; 2];
        for lane in (0..self.gaps.count).step_by(Lanes::<S>::LEN) {
            let rows = Rows { simd, rows: &self.gaps.rows, lane };
            let zero = rows.row(GAP_PLACE).splat(0.0);
            let nowhere = Triple::zero(zero);
            let beside = Beside {
                near: rows.quartic(GAP_NEAR),
                near_velocity: [nowhere; 3],
                far: rows.arc(GAP_FAR),
                far_velocity: [nowhere; 4],
                spin: [nowhere; 3],
                radius: [rows.row(GAP_RADIUS), rows.row(GAP_RADIUS + 1), rows.row(GAP_RADIUS + 2)],
                t: rows.row(GAP_PLACE),
                moves: zero.splat(1.0),
                first: zero.splat(-0.5),
                width: zero.splat(1.0 / CELLS as f64),
                length: zero,
                per_length: zero,
                reach: zero,
                viscosity: zero,
            };
            let at = beside.expand(ROUNDS);
            let deepest = Beside::deepest(&beside.gap(&at, rows.row(GAP_OFFSET), zero), &[zero.splat(1.0); CELLS]);
            at.t.store(&mut found[0], lane);
            (-deepest).store(&mut found[1], lane);
        }
        found
    }
}

impl Batch {
    /// Takes a contact in; its surroundings must hold on both wires.
    #[inline(always)]
    pub fn take<N: NormalLaw, T: TangentialLaw>(&mut self, k: usize, c: &Contact<N, T>, meets: &Meets<'_, N, T>) {
        const { assert!(History::<N, T>::NUMBERS <= NUMBERS) };
        let (lane, state) = (self.next(k), meets.state);
        let [i, j] = [c.i, c.place.j].map(|p| p as usize);
        self.put_points(lane, [NEAR, FAR], state.x.rows(), [i, j]);
        self.put_points(lane, [NEAR_VELOCITY, FAR_VELOCITY], state.v.rows(), [i, j]);
        self.put_radii(lane, RADIUS, &state.radius, [i, j]);
        if T::ACTIVE {
            self.put::<1>(lane, SPIN, state.w.rows(), i);
            self.put::<2>(lane, SPIN + 3, state.w.rows(), j);
        }
        let rows = &mut self.rows;
        let mut set = |row: usize, value: f64| rows[row][lane] = value;
        set(PLACE, c.place.t);
        set(LENGTH, c.cell_length);
        set(PER_LENGTH, c.per_length);
        set(REACH, c.reach);
        set(VISCOSITY, c.viscosity);
        set(REDUCED, c.history.reduced_radius);
        for (q, dent) in c.dents.into_iter().enumerate() {
            set(DENTS + q, dent);
        }
        c.history.each_number(|n, number| set(HISTORY + n, number));
    }

    /// Takes them through `law`, which is that of all of them, with the instructions of the machine.
    pub fn answer<'a, N: NormalLaw, T: TangentialLaw>(
        &'a self,
        meets: &'a Meets<'a, N, T>,
        law: &'a Laws<N, T>,
        answers: &'a mut Answers,
    ) -> impl WithSimd<Output = ()> {
        Run { batch: self, meets, law, answers }
    }
}

/// Rows of [`Answers`].
const OUT_PLACE: usize = 0;
const OUT_HERE: usize = 1;
const OUT_DEEPEST: usize = 2;
const OUT_TOUCHING: usize = 3;
const OUT_PER_LENGTH: usize = 4;
const OUT_CURVATURE: usize = 5;
const OUT_REACH: usize = 6;
const OUT_ARMS: usize = 7;
const OUT_ENERGY: usize = 9;
const OUT_STIFFNESS: usize = 10;
const OUT_FORCE: usize = 11;
const OUT_MEAN: usize = 12;
const OUT_GIVEN: usize = 13;
const OUT_NEAR: usize = 17;
const OUT_FAR: usize = 26;
const OUT_TWIST: usize = 38;
const OUT_DENTS: usize = 47;
const OUT_HISTORY: usize = OUT_DENTS + CELLS;
const OUT_ROWS: usize = OUT_HISTORY + NUMBERS;

/// What came out for a batch.
pub struct Answers {
    rows: [[f64; BLOCK]; OUT_ROWS],
}

impl Default for Answers {
    fn default() -> Self {
        Self { rows: [[0.0; BLOCK]; OUT_ROWS] }
    }
}

struct Run<'a, N: NormalLaw, T: TangentialLaw> {
    batch: &'a Batch,
    meets: &'a Meets<'a, N, T>,
    law: &'a Laws<N, T>,
    answers: &'a mut Answers,
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Run<'_, N, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for lane in (0..self.batch.count).step_by(Lanes::<S>::LEN) {
            self.lanes(simd, lane);
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Run<'_, N, T> {
    #[inline(always)]
    fn lanes<S: Simd>(&mut self, simd: S, lane: usize) {
        let out = &mut self.answers.rows;
        let rows = Rows { simd, rows: &self.batch.rows, lane };
        let mut beside = rows.beside::<T>();
        let at = beside.expand(ROUNDS);
        let mut history = History::<N, T, _>::of(rows.row(REDUCED), |k| rows.row(HISTORY + k));
        let zero = at.t.splat(0.0);
        let all = [zero.splat(1.0); CELLS];
        let deepest = Beside::deepest(&beside.gap(&at, history.offset, history.reduced_radius), &all);
        let mut dents = [zero; CELLS];
        for (q, dent) in dents.iter_mut().enumerate() {
            *dent = rows.row(DENTS + q);
        }
        let touched = history.touching();
        let touches = deepest.simd_gt(zero);
        let curvature = at.distance[2] * beside.near[1].length_squared().inverse();
        let new = touches & !touched;
        if new.any() {
            // The angle at which they came to touch.
            let new = Lanes::select(new, zero.splat(1.0), zero);
            for k in 0..Lanes::<S>::LEN {
                if new.at(k) > 0.0 {
                    let per_length = self.meets.per_length(self.law, history.reduced_radius.at(k), curvature.at(k));
                    beside.per_length.put(k, per_length);
                }
            }
        }
        let answer = beside.respond(self.law, &at, &all, &mut dents, &mut history, self.meets.state.dt);
        let here = Lanes::select(touches | touched, zero.splat(1.0), zero);
        let mut put = |row: usize, value: Lanes<S>| value.store(&mut out[row], lane);
        put(OUT_PLACE, at.t);
        put(OUT_HERE, here);
        put(OUT_DEEPEST, deepest);
        put(OUT_TOUCHING, at.touching);
        put(OUT_PER_LENGTH, beside.per_length);
        put(OUT_CURVATURE, curvature);
        put(OUT_REACH, answer.reach);
        put(OUT_ARMS, answer.arms[0]);
        put(OUT_ARMS + 1, answer.arms[1]);
        put(OUT_ENERGY, answer.energy);
        put(OUT_STIFFNESS, answer.stiffness);
        put(OUT_FORCE, answer.force);
        put(OUT_MEAN, answer.mean);
        put(OUT_GIVEN, answer.given.plastic);
        put(OUT_GIVEN + 1, answer.given.thinning);
        put(OUT_GIVEN + 2, answer.given.friction);
        put(OUT_GIVEN + 3, answer.given.damping);
        let act = &answer.act;
        for (first, vectors) in [(OUT_NEAR, &act.near[..]), (OUT_FAR, &act.far[..]), (OUT_TWIST, &act.twist[..])] {
            for (k, v) in vectors.iter().enumerate() {
                put(first + 3 * k, v.x);
                put(first + 3 * k + 1, v.y);
                put(first + 3 * k + 2, v.z);
            }
        }
        for (q, dent) in dents.into_iter().enumerate() {
            put(OUT_DENTS + q, dent);
        }
        history.each_number(|n, number| put(OUT_HISTORY + n, number));
    }
}

impl Answers {
    /// The foot of one lane (-).
    pub fn place(&self, lane: usize) -> f64 {
        self.rows[OUT_PLACE][lane]
    }

    /// What came out for one lane; the contact remembers what it has to.
    pub fn at<N: NormalLaw, T: TangentialLaw>(&self, lane: usize, c: &mut Contact<N, T>) -> Touch {
        let get = |row: usize| self.rows[row][lane];
        let vector = |first: usize, k: usize| Triple {
            x: get(first + 3 * k),
            y: get(first + 3 * k + 1),
            z: get(first + 3 * k + 2),
        };
        if get(OUT_HERE) == 0.0 {
            return Touch::Apart { t: get(OUT_PLACE), gap: -get(OUT_DEEPEST) };
        }
        c.history = History::of(c.history.reduced_radius, |n| get(OUT_HISTORY + n));
        c.dents = std::array::from_fn(|q| get(OUT_DENTS + q));
        let answer = Answer {
            act: Act {
                near: std::array::from_fn(|k| vector(OUT_NEAR, k)),
                far: std::array::from_fn(|k| vector(OUT_FAR, k)),
                twist: std::array::from_fn(|k| vector(OUT_TWIST, k)),
            },
            given: Dissipated {
                plastic: get(OUT_GIVEN),
                thinning: get(OUT_GIVEN + 1),
                friction: get(OUT_GIVEN + 2),
                damping: get(OUT_GIVEN + 3),
            },
            force: get(OUT_FORCE),
            mean: get(OUT_MEAN),
            stiffness: get(OUT_STIFFNESS),
            energy: get(OUT_ENERGY),
            deepest: get(OUT_DEEPEST),
            reach: get(OUT_REACH),
            arms: [get(OUT_ARMS), get(OUT_ARMS + 1)],
        };
        Touch::Here {
            answer,
            t: get(OUT_PLACE),
            touching: get(OUT_TOUCHING),
            per_length: get(OUT_PER_LENGTH),
            curvature: get(OUT_CURVATURE),
        }
    }
}

/// The lanes of a batch from `lane` on.
#[derive(Clone, Copy)]
struct Rows<'a, S: Simd> {
    simd: S,
    rows: &'a [[f64; BLOCK]],
    lane: usize,
}

impl<S: Simd> Rows<'_, S> {
    #[inline(always)]
    fn row(self, k: usize) -> Lanes<S> {
        Lanes::load(self.simd, &self.rows[k], self.lane)
    }

    /// Vector `k` of `count` whose rows begin at `first`.
    #[inline(always)]
    fn vector(self, first: usize, count: usize, k: usize) -> Triple<Lanes<S>> {
        Triple { x: self.row(first + k), y: self.row(first + count + k), z: self.row(first + 2 * count + k) }
    }

    /// See [`Around::new`](super::curve::Around::new): point and derivatives at the particle.
    #[inline(always)]
    fn quartic(self, first: usize) -> [Triple<Lanes<S>>; 3] {
        let (a, b, c) = (self.vector(first, 5, 0), self.vector(first, 5, 1), self.vector(first, 5, 2));
        let (d, e) = (self.vector(first, 5, 3), self.vector(first, 5, 4));
        let like = a.x;
        let slope = ((d - b) * like.splat(8.0) - (e - a)) * like.splat(1.0 / 12.0);
        let bend = ((b + d) * like.splat(16.0) - (a + e) - c * like.splat(30.0)) * like.splat(1.0 / 12.0);
        [c, slope, bend]
    }

    /// See [`Arc::new`](super::curve::Arc::new).
    #[inline(always)]
    fn arc(self, first: usize) -> [Triple<Lanes<S>>; 4] {
        let (a, b) = (self.vector(first, 4, 0), self.vector(first, 4, 1));
        let (c, d) = (self.vector(first, 4, 2), self.vector(first, 4, 3));
        let (half, three) = (a.x.splat(0.5), a.x.splat(3.0));
        let square = (a - b * half.splat(2.0) + c) * half;
        let blend = (d - a + (b - c) * three) * half;
        [b, (c - a) * half, square, blend]
    }

    #[inline(always)]
    fn beside<T: TangentialLaw>(self) -> Beside<Lanes<S>> {
        let like = self.row(PLACE);
        let mut spin = [Triple::zero(like); 3];
        if T::ACTIVE {
            spin = [self.vector(SPIN, 1, 0), self.vector(SPIN + 3, 2, 0), self.vector(SPIN + 3, 2, 1)];
        }
        Beside {
            near: self.quartic(NEAR),
            near_velocity: self.quartic(NEAR_VELOCITY),
            far: self.arc(FAR),
            far_velocity: self.arc(FAR_VELOCITY),
            spin,
            radius: [self.row(RADIUS), self.row(RADIUS + 1), self.row(RADIUS + 2)],
            t: like,
            moves: like.splat(1.0),
            first: like.splat(-0.5),
            width: like.splat(1.0 / CELLS as f64),
            length: self.row(LENGTH),
            per_length: self.row(PER_LENGTH),
            reach: self.row(REACH),
            viscosity: self.row(VISCOSITY),
        }
    }
}
