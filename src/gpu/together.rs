//! Scenes that are stepped together on a device: whoever has a block of steps to do brings it, and it is done with those of the
//! others.
//!
//! Each scene is driven by a thread of its own. The last one to come does the work for all; one that has waited for long does it
//! without those that have not come. What comes of a scene does not depend on who else is there.

use super::adapter::Device;
use super::batch::{Batch, News, Program};
use super::layout::{Shape, room};
use crate::base::error::{Error, Result};
use crate::engine::elsewhere::{Block, Outcome, StepFunctions};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

/// How long to wait for others at least.
const PATIENCE: Duration = Duration::from_millis(20);

/// Everything that is stepped in this process, by device and by what its steps are.
static ALL: Mutex<Vec<Known>> = Mutex::new(Vec::new());

/// The device, the functions and names of their numbers as text, and who is stepped by them.
type Known = (wgpu::Device, Vec<String>, Weak<Together>);

/// Scenes whose steps are the same functions.
pub struct Together {
    /// The functions.
    pub program: Program,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    members: BTreeMap<usize, Member>,
    /// Number of the next member.
    next: usize,
    /// The scenes on the device and whose they are, in order; none where that has to be made anew.
    batch: Option<(Batch, Vec<usize>)>,
    /// How many batches there were: whoever was in an earlier one has to bring everything.
    epoch: u64,
    /// Whether somebody is at work on it.
    running: bool,
    /// What the last block took.
    last: Duration,
}

struct Member {
    shape: Shape,
    /// Pairs for which it needs room.
    room: u32,
    request: Option<Request>,
    response: Option<Result<Response>>,
}

/// A block of steps to be done.
pub struct Request {
    /// The steps.
    pub block: Block,
    /// What the device has not.
    pub news: Option<News>,
    /// The batch in which the rest is.
    pub epoch: u64,
}

/// What came of a request.
pub enum Response {
    /// The block is done, in this batch.
    Done(Block, Outcome, u64),
    /// Everything has to be brought, for the device has been laid out anew.
    Anew(Block),
}

/// What came of requests, by who brought them.
type Answers = Vec<(usize, Result<Response>)>;

impl Together {
    /// Those on `device` whose steps are `functions`, with these names of the numbers of a step; begun where there are none.
    ///
    /// # Errors
    /// [`Error::Missing`] when the driver refuses the functions.
    pub fn of(device: &Device, functions: &StepFunctions, names: &[String]) -> Result<Arc<Self>> {
        let texts = functions.in_order().into_iter().map(|(_, function)| function.wgsl());
        let key: Vec<String> = texts.chain(names.iter().cloned()).collect();
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|(_, _, own)| own.strong_count() > 0);
        let same = all.iter().find(|(on, own, _)| *on == device.device && *own == key);
        if let Some(found) = same.and_then(|(_, _, own)| own.upgrade()) {
            return Ok(found);
        }
        let program = Program::new(device, functions, names)?;
        let own = Arc::new(Self { program, state: Mutex::default(), changed: Condvar::new() });
        all.push((device.device.clone(), key, Arc::downgrade(&own)));
        Ok(own)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A scene of this shape comes in; gives its number.
    ///
    /// # Errors
    /// [`Error::Input`] when it is too large for the device.
    pub fn join(&self, shape: Shape, pairs: usize) -> Result<usize> {
        self.program.fits([(shape.clone(), room(pairs))])?;
        let mut state = self.state();
        let number = state.next;
        state.next += 1;
        state.members.insert(number, Member { shape, room: room(pairs), request: None, response: None });
        state.batch = None;
        Ok(number)
    }

    /// A scene leaves.
    pub fn leave(&self, number: usize) {
        let mut state = self.state();
        state.members.remove(&number);
        state.batch = None;
        self.changed.notify_all();
    }

    /// Brings a block, and waits for what comes of it.
    ///
    /// # Errors
    /// [`Error::Missing`] when the device fails; [`Error::Input`] when the scene has grown too large for it.
    pub fn exchange(&self, number: usize, request: Request) -> Result<Response> {
        let begun = Instant::now();
        let mut state = self.state();
        own(&mut state, number).request = Some(request);
        self.changed.notify_all();
        loop {
            if let Some(response) = own(&mut state, number).response.take() {
                return response;
            }
            let patience = PATIENCE.max(2 * state.last);
            let waited = begun.elapsed();
            let mine = own(&mut state, number).request.is_some();
            let all = state.members.values().all(|member| member.request.is_some());
            if mine && !state.running && (all || waited >= patience) {
                state = self.work(state);
                continue;
            }
            // Whoever works tells when it is done.
            let left = if mine { patience.saturating_sub(waited).max(Duration::from_millis(1)) } else { PATIENCE };
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Does what has been brought so far.
    fn work<'s>(&'s self, mut state: MutexGuard<'s, State>) -> MutexGuard<'s, State> {
        state.running = true;
        let begun = Instant::now();
        let mut requests: BTreeMap<usize, Request> = BTreeMap::new();
        for (number, member) in &mut state.members {
            if let Some(request) = member.request.take() {
                // A search may find more than before.
                let pairs = request.news.as_ref().map_or(0, |news| news.pairs.len());
                if pairs as u32 > member.room {
                    member.room = room(pairs);
                }
                requests.insert(*number, request);
            }
        }
        let outgrown = |(batch, order): &(Batch, Vec<usize>)| {
            order.iter().enumerate().any(|(s, number)| state.members[number].room > batch.room(s))
        };
        let kept = match state.batch.as_ref().is_some_and(outgrown) {
            true => None,
            false => state.batch.take(),
        };
        let order: Vec<usize> = state.members.keys().copied().collect();
        let shapes: Vec<_> = state.members.values().map(|member| (member.shape.clone(), member.room)).collect();
        if kept.is_none() {
            state.epoch += 1;
        }
        let epoch = state.epoch;
        drop(state);

        let asked: Vec<usize> = requests.keys().copied().collect();
        let worked = catch_unwind(AssertUnwindSafe(|| self.answer(kept, shapes, order, requests, epoch)));
        // Nobody must wait for the answer of a thread that is no more.
        let panicked =
            |_: &usize| Err(Error::Missing { what: "a thread that drove this adapter panicked".into(), help: None });
        let (batch, responses, panic) = match worked {
            Ok((batch, responses)) => (batch, responses, None),
            Err(panic) => (None, asked.iter().map(|number| (*number, panicked(number))).collect(), Some(panic)),
        };

        let mut state = self.state();
        // Somebody may have come or gone meanwhile.
        let same = batch.as_ref().is_some_and(|(_, order)| state.members.keys().eq(order));
        state.batch = batch.filter(|_| same);
        for (number, response) in responses {
            if let Some(member) = state.members.get_mut(&number) {
                member.response = Some(response);
            }
        }
        (state.running, state.last) = (false, begun.elapsed());
        self.changed.notify_all();
        if let Some(panic) = panic {
            drop(state);
            resume_unwind(panic);
        }
        state
    }

    /// The answers to all requests, and the batch that is then on the device.
    fn answer(
        &self,
        kept: Option<(Batch, Vec<usize>)>,
        shapes: Vec<(Shape, u32)>,
        order: Vec<usize>,
        requests: BTreeMap<usize, Request>,
        epoch: u64,
    ) -> (Option<(Batch, Vec<usize>)>, Answers) {
        let batch = kept.map_or_else(|| self.program.batch(shapes).map(|batch| (batch, order)), Ok);
        match batch {
            Ok((mut batch, order)) => {
                let (requests, mut responses) = separate(requests, epoch);
                match self.run(&mut batch, &order, requests, epoch) {
                    Ok(done) => {
                        responses.extend(done);
                        (Some((batch, order)), responses)
                    }
                    Err((numbers, error)) => {
                        responses.extend(numbers.into_iter().map(|number| (number, Err(again(&error)))));
                        (None, responses)
                    }
                }
            }
            Err(error) => (None, requests.into_keys().map(|number| (number, Err(again(&error)))).collect()),
        }
    }

    /// Runs the blocks that were brought, and none of others; who brought them comes with an error.
    fn run(
        &self,
        batch: &mut Batch,
        order: &[usize],
        mut requests: BTreeMap<usize, Request>,
        epoch: u64,
    ) -> std::result::Result<Answers, (Vec<usize>, Error)> {
        let none = Block::default();
        let mut news: Vec<Option<News>> =
            order.iter().map(|number| requests.get_mut(number).and_then(|request| request.news.take())).collect();
        let blocks: Vec<&Block> =
            order.iter().map(|number| requests.get(number).map_or(&none, |request| &request.block)).collect();
        match self.program.run(batch, &blocks, &mut news) {
            Ok(outcomes) => {
                let done = order.iter().zip(outcomes).filter_map(|(number, outcome)| {
                    let request = requests.remove(number)?;
                    Some((*number, Ok(Response::Done(request.block, outcome, epoch))))
                });
                Ok(done.collect())
            }
            Err(error) => Err((requests.into_keys().collect(), error)),
        }
    }
}

/// Requests that can be done in this batch, and the answers to the others.
fn separate(requests: BTreeMap<usize, Request>, epoch: u64) -> (BTreeMap<usize, Request>, Answers) {
    let (fit, others): (BTreeMap<_, _>, BTreeMap<_, _>) =
        requests.into_iter().partition(|(_, request)| request.news.is_some() || request.epoch == epoch);
    (fit, others.into_iter().map(|(number, request)| (number, Ok(Response::Anew(request.block)))).collect())
}

/// The member of this number, which is there as long as it asks.
fn own<'s>(state: &'s mut MutexGuard<'_, State>, number: usize) -> &'s mut Member {
    state.members.get_mut(&number).expect("a member leaves when it asks for nothing")
}

/// The same error for another scene.
fn again(error: &Error) -> Error {
    match error {
        Error::Missing { what, help } => Error::Missing { what: what.clone(), help: help.clone() },
        other => Error::input(other.to_string(), "use another device"),
    }
}
