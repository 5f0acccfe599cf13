//! Helpers of a team: threads that wait for a task, and run it beside the one that asks.

use crate::base::error::{Error, Result};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

/// What threads of a team do together; called with the number of the thread, 0 for the one that asks.
type Task<'a> = &'a (dyn Fn(usize) + Sync);

/// How often a thread that waits looks again at once: some 10 to 40 µs, longer than what lies between two loops of a step.
const SPINS: usize = 1000;
/// How often it looks after that before it sleeps, its core given to whoever else wants it in between: some 100 µs.
const YIELDS: usize = 300;

/// Waits a little, between two looks.
fn pause(looks: usize) {
    if looks < SPINS { std::hint::spin_loop() } else { thread::yield_now() }
}

/// Threads that wait for tasks. They end when this is dropped.
pub struct Threads {
    shared: Arc<Shared>,
    handles: Vec<JoinHandle<()>>,
}

struct Shared {
    looked_at: LookedAt,
    /// Whether somebody has asked for something and waits for it.
    taken: AtomicBool,
    /// Whether helper k sleeps, or is about to.
    asleep: Vec<AtomicBool>,
    /// What the first helper that panicked said.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

/// What helpers that wait look at all the time, away from everything that others write.
#[repr(align(128))]
struct LookedAt {
    /// See [`OPEN`], [`END`], [`WANTED`], [`NUMBER`] and [`INSIDE`].
    state: AtomicU64,
    /// The task, while one is open or somebody is inside.
    task: AtomicPtr<Task<'static>>,
}

/// A bit of the state: helpers may come to the task.
const OPEN: u64 = 1 << 63;
/// A bit of the state: helpers are to end.
const END: u64 = 1 << 62;
/// The helpers that are wanted: those with lower numbers.
const WANTED: u64 = 0xffff << 46;
const WANTED_SHIFT: u32 = 46;
/// The number of the task, raised with every one.
const NUMBER: u64 = 0x3fff_ffff << 16;
const ONE_TASK: u64 = 1 << 16;
/// How many helpers are at the task.
const INSIDE: u64 = 0xffff;
/// The greatest number of helpers that the state can count.
const MOST: usize = INSIDE as usize;

impl Threads {
    /// Starts `count` threads, at most [`MOST`].
    ///
    /// # Errors
    /// [`Error::Missing`] when the system refuses one.
    pub fn start(count: usize) -> Result<Self> {
        let count = count.min(MOST);
        let shared = Arc::new(Shared {
            looked_at: LookedAt { state: AtomicU64::new(0), task: AtomicPtr::new(ptr::null_mut()) },
            taken: AtomicBool::new(false),
            asleep: (0..count).map(|_| AtomicBool::new(false)).collect(),
            panic: Mutex::new(None),
        });
        let mut threads = Self { shared, handles: Vec::with_capacity(count) };
        for k in 0..count {
            let shared = Arc::clone(&threads.shared);
            let handle = thread::Builder::new().name(format!("team {}", k + 1)).spawn(move || shared.help(k));
            // Those that are there already end when `threads` goes.
            threads.handles.push(handle.map_err(|e| Error::Missing {
                what: format!("cannot start the threads: {e}"),
                help: Some("ask for fewer with --threads".into()),
            })?);
        }
        Ok(threads)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.handles.len()
    }

    /// Runs `task` on the calling thread and on up to `wanted` helpers, and comes back when all that began it have ended
    /// it. Who comes too late takes no part: the task must be whole when only the calling thread runs it. Where the
    /// helpers have a task already (of another thread, or this is part of it), the caller is alone.
    ///
    /// # Panics
    /// When the task does, on any thread.
    pub fn run(&self, wanted: usize, task: Task) {
        let shared = &*self.shared;
        if shared.taken.swap(true, Ordering::Acquire) {
            return task(0);
        }
        let leaving = Leaving(shared);
        let wanted = wanted.min(self.count());
        let closing = Closing(shared);
        // What is stored is a pointer to this reference on the stack; its lifetimes are the caller's business:
        // `closing` does not let this function end, not even by a panic, while anybody may look at it.
        let here: *const Task = &raw const task;
        shared.looked_at.task.store(here.cast::<Task<'static>>().cast_mut(), Ordering::Relaxed);
        let number = shared.looked_at.state.load(Ordering::Relaxed).wrapping_add(ONE_TASK) & NUMBER;
        // In one order with `asleep`: either this is seen by a helper before it sleeps, or it is seen to sleep.
        shared.looked_at.state.store(OPEN | (wanted as u64) << WANTED_SHIFT | number, Ordering::SeqCst);
        for (asleep, handle) in shared.asleep.iter().zip(&self.handles).take(wanted) {
            if asleep.load(Ordering::SeqCst) && asleep.swap(false, Ordering::SeqCst) {
                handle.thread().unpark();
            }
        }
        task(0);
        drop(closing);
        let panic = shared.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        drop(leaving);
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }
}

/// Lets others ask when it is dropped.
struct Leaving<'a>(&'a Shared);

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        self.0.taken.store(false, Ordering::Release);
    }
}

/// Closes the task when it is dropped, and waits for those who are still at it.
struct Closing<'a>(&'a Shared);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        let state = &self.0.looked_at.state;
        state.fetch_and(!OPEN, Ordering::AcqRel);
        let mut looks = 0usize;
        // Acquire: what helpers have written is seen from here on.
        while state.load(Ordering::Acquire) & INSIDE != 0 {
            looks += 1;
            pause(looks);
        }
        if thread::panicking() {
            // The caller's own panic goes on; nobody else's is told.
            *self.0.panic.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.shared.looked_at.state.fetch_or(END, Ordering::SeqCst);
        for handle in self.handles.drain(..) {
            handle.thread().unpark();
            // A helper never panics: what a task says is kept.
            let _ = handle.join();
        }
    }
}

impl Shared {
    /// The life of helper `k`.
    fn help(&self, k: usize) {
        // The first task has number 1; one that was opened before this thread began is for it too.
        let mut done = 0;
        while let Some(state) = self.wait(k, done) {
            if !self.enter(state) {
                continue;
            }
            done = state & NUMBER;
            // SAFETY: `enter` has seen the task open and has made itself count as inside, in one step. The pointer was
            // stored before the task was opened, is not changed while anybody is inside, and `Closing` keeps what it
            // points to alive until nobody is.
            let task = unsafe { *self.looked_at.task.load(Ordering::Relaxed) };
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| task(k + 1))) {
                self.panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(panic);
            }
            // Release: what it has written is seen by whoever sees it gone.
            self.looked_at.state.fetch_sub(1, Ordering::Release);
        }
    }

    /// Comes in to the task that was seen as `seen`; false when that is over, or others came or went meanwhile.
    fn enter(&self, seen: u64) -> bool {
        self.looked_at.state.compare_exchange(seen, seen + 1, Ordering::Acquire, Ordering::Relaxed).is_ok()
    }

    /// The state with an open task that helper `k` is wanted for and that is not number `done`; none at the end.
    fn wait(&self, k: usize, done: u64) -> Option<u64> {
        let wanted =
            |state: u64| state & OPEN != 0 && state & NUMBER != done && ((state & WANTED) >> WANTED_SHIFT) as usize > k;
        loop {
            for looks in 0..SPINS + YIELDS {
                let state = self.looked_at.state.load(Ordering::Acquire);
                if state & END != 0 {
                    return None;
                }
                if wanted(state) {
                    return Some(state);
                }
                pause(looks);
            }
            self.asleep[k].store(true, Ordering::SeqCst);
            // In one order with the opening of a task: see `run`.
            let state = self.looked_at.state.load(Ordering::SeqCst);
            if state & END == 0 && !wanted(state) {
                thread::park();
            }
            self.asleep[k].store(false, Ordering::SeqCst);
        }
    }
}
