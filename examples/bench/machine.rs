//! What the machine can do: bandwidth of memory and throughput of arithmetic, measured on as many threads as the engine
//! gets.

use crate::counted::Operations;
use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::hint::black_box;
use std::time::{Duration, Instant};
use strandsnap::base::lanes::{BLOCK, Lanes, Real};

/// Memory of the far triad (bytes): more than caches hold.
const FAR: usize = 768 << 20;
/// A rate is the best of as many goes as this time has room for.
const TIME: Duration = Duration::from_millis(200);
/// Independent chains, enough to hide the latency of any operation.
const CHAINS: usize = 8;
/// Operations per chain and go.
const ROUNDS: usize = 200_000;

/// Rates of all threads together.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Machine {
    /// Bandwidth of a triad over memory far beyond the caches (bytes/s).
    pub far: f64,
    /// The same over as much memory as the engine works on (bytes/s).
    pub near: f64,
    /// Additions, multiplications, or both in one, in the widest registers (1/s).
    pub simple: f64,
    /// Divisions (1/s).
    pub divisions: f64,
    /// Square roots (1/s).
    pub roots: f64,
}

impl Machine {
    /// Measures; `working_set` in bytes.
    pub fn measure(threads: usize, working_set: usize) -> Self {
        Self {
            far: triad(threads, FAR),
            near: triad(threads, working_set),
            simple: arithmetic(threads, Kind::MultiplyAdd),
            divisions: arithmetic(threads, Kind::Divide),
            roots: arithmetic(threads, Kind::Root),
        }
    }

    /// Least time for moving `bytes` that stay in reach of the working set (s).
    pub fn moving(&self, bytes: usize) -> f64 {
        bytes as f64 / self.near
    }

    /// Least time for arithmetic (s): divisions and roots share a unit, which works beside the others.
    pub fn computing(&self, work: Operations) -> f64 {
        (work.simple / self.simple).max(work.divisions / self.divisions + work.roots / self.roots)
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "machine: triad {:.1} GB/s on the engine's memory, {:.1} GB/s far beyond; {:.1} G add or multiply/s, {:.2} G \
             div/s, {:.2} G sqrt/s",
            self.near * 1e-9,
            self.far * 1e-9,
            self.simple * 1e-9,
            self.divisions * 1e-9,
            self.roots * 1e-9
        )
    }
}

/// Bytes per second of a = b + s c on three arrays of `bytes` together.
fn triad(threads: usize, bytes: usize) -> f64 {
    let each = (bytes / (3 * size_of::<f64>() * threads)).max(64);
    // A go takes long against starting the threads.
    let passes = ((32 << 20) / (3 * size_of::<f64>() * each)).max(1);
    let mut arrays: Vec<[Vec<f64>; 3]> = (0..threads).map(|_| [0.0, 1.0, 2.0].map(|v| vec![v; each])).collect();
    let best = best(|| {
        std::thread::scope(|scope| {
            for [a, b, c] in &mut arrays {
                scope.spawn(move || {
                    for _ in 0..passes {
                        a.iter_mut().zip(&*b).zip(&*c).for_each(|((a, b), c)| *a = *b + 0.5 * *c);
                        black_box(&mut *a);
                    }
                });
            }
        });
    });
    (threads * each * 3 * size_of::<f64>() * passes) as f64 / best
}

#[derive(Clone, Copy)]
enum Kind {
    MultiplyAdd,
    Divide,
    Root,
}

/// Operations per second of a kind.
fn arithmetic(threads: usize, kind: Kind) -> f64 {
    let arch = Arch::new();
    let lanes = arch.dispatch(Chains { kind, rounds: 0 }).0;
    let best = best(|| {
        std::thread::scope(|scope| {
            (0..threads).for_each(|_| {
                scope.spawn(|| black_box(arch.dispatch(Chains { kind, rounds: ROUNDS })));
            });
        });
    });
    (threads * CHAINS * ROUNDS * lanes) as f64 / best
}

/// Best time of some goes (s). By the wall: the clock of the processor comes in steps on some machines. Goes are so short
/// that programs beside this one leave some of them alone.
pub fn best(mut go: impl FnMut()) -> f64 {
    go();
    let (begin, mut best) = (Instant::now(), f64::INFINITY);
    while begin.elapsed() < TIME || best == f64::INFINITY {
        let clock = Instant::now();
        go();
        best = best.min(clock.elapsed().as_secs_f64());
    }
    best
}

/// Independent chains of one operation.
#[derive(Clone, Copy)]
struct Chains {
    kind: Kind,
    rounds: usize,
}

impl WithSimd for Chains {
    /// Numbers per register, and a sum that nobody needs.
    type Output = (usize, f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let start: [f64; CHAINS] = std::array::from_fn(|k| black_box(1.0 + k as f64));
        // No closures from here on: they would not be compiled for the registers that `simd` stands for.
        let mut chains = [Lanes::<S>::splat(simd, start[0]); CHAINS];
        for (chain, start) in chains.iter_mut().zip(start) {
            *chain = Lanes::<S>::splat(simd, start);
        }
        let factor = Lanes::<S>::splat(simd, black_box(0.999));
        let summand = Lanes::<S>::splat(simd, black_box(0.001));
        match self.kind {
            Kind::MultiplyAdd => {
                for _ in 0..self.rounds {
                    for c in &mut chains {
                        *c = c.mul_add(factor, summand);
                    }
                }
            }
            Kind::Divide => {
                for _ in 0..self.rounds {
                    for c in &mut chains {
                        *c = factor / *c;
                    }
                }
            }
            Kind::Root => {
                for _ in 0..self.rounds {
                    for c in &mut chains {
                        *c = c.sqrt();
                    }
                }
            }
        }
        let mut numbers = [0.0; BLOCK];
        let mut sum = 0.0;
        for chain in chains {
            // All of them, or the compiler would leave out what nobody asks for.
            chain.store(&mut numbers, 0);
            sum += numbers.iter().sum::<f64>();
        }
        (Lanes::<S>::LEN, sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_is_faster_near_than_nothing_and_divides_slower_than_it_adds() {
        let machine = Machine { far: 1.0, ..Machine::measure(1, 1 << 20) };
        assert!(machine.near > 1e8 && machine.simple > 1e8, "{machine:?}");
        assert!(machine.divisions < machine.simple && machine.roots < machine.simple, "{machine:?}");
    }

    #[test]
    fn the_slower_unit_sets_the_limit() {
        let machine = Machine { far: 1.0, near: 10.0, simple: 100.0, divisions: 5.0, roots: 4.0 };
        assert_eq!(machine.moving(20), 2.0);
        assert_eq!(machine.computing(Operations { simple: 300.0, divisions: 5.0, roots: 4.0 }), 3.0);
        assert_eq!(machine.computing(Operations { simple: 100.0, divisions: 10.0, roots: 4.0 }), 3.0);
    }
}
