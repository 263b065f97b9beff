//! What the machine can do at the moment: fused multiplications in registers, and triad from memory.

use crate::error::{Error, Result};
use crate::lane::{F8, Kernel, LANES, Lanes, Work};
use cpu_time::ThreadTime;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Duration;

/// Rates of all threads together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peaks {
    /// Flops per second of fused multiplications (2 flops each).
    pub fma: f64,
    /// Bytes per second of a = b + s c: 24 a number, as STREAM counts (what is read because it is written is not counted).
    pub triad: f64,
}

/// Independent sums: 4 cycles of latency times 2 units need 8 registers under way. With two registers a sum (AVX2) 6 sums
/// make 12 of 16; with one (AVX-512) 12 make 12 of 32. Both are tried, the faster one counts.
const SUMS: [usize; 2] = [6, 12];
/// Fused multiplications of each sum in one run: some 5 ms.
const LENGTH: usize = 2_000_000;
/// Numbers of each array over all threads: 3 x 128 MiB, beyond any cache.
const NUMBERS: usize = 1 << 24;
/// Runs of which the fastest counts: a peak is what is left when others are quiet.
const RUNS: usize = 9;

struct Fma<const SUMS: usize>;
impl<const SUMS: usize> Work for Fma<SUMS> {
    type Out = F8;
    #[inline(always)]
    fn run<L: Lanes>(self) -> F8 {
        // Towards b / (1 - a), which stays finite.
        let (a, b) = (L::splat(black_box(0.999_999)), L::splat(black_box(1e-6)));
        let mut sums = [L::splat(black_box(0.5)); SUMS];
        for _ in 0..LENGTH {
            for sum in &mut sums {
                *sum = sum.mul_add(a, b);
            }
        }
        let mut total = L::zero();
        for sum in sums {
            total = total + sum;
        }
        let mut out = F8::ZERO;
        total.store(&mut out);
        out
    }
}

struct Triad<'a> {
    a: &'a mut [F8],
    b: &'a [F8],
    c: &'a [F8],
}
impl Work for Triad<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let s = L::splat(3.0);
        for (a, (b, c)) in self.a.iter_mut().zip(self.b.iter().zip(self.c)) {
            s.mul_add(L::load(c), L::load(b)).store(a);
        }
    }
}

/// The fastest of some runs, in CPU seconds of a thread (the mean of all threads): what others take of the machine in
/// between is not the time of the run.
fn fastest(mut run: impl FnMut() -> Duration) -> f64 {
    (0..RUNS).map(|_| run()).min().unwrap_or_default().as_secs_f64() / rayon::current_num_threads() as f64
}

/// CPU time of this thread in `body`.
fn clocked(body: impl FnOnce()) -> Duration {
    let clock = ThreadTime::now();
    body();
    clock.elapsed()
}

/// Measures both on so many threads: about a second.
///
/// # Errors
/// Threads that cannot be started.
pub fn peaks(kernel: Kernel, threads: usize) -> Result<Peaks> {
    Ok(pool(threads)?.install(|| Peaks { fma: fma(kernel), triad: triad(kernel) }))
}

/// Threads of their own.
pub(super) fn pool(threads: usize) -> Result<ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|why| Error::input(format!("cannot start {threads} threads: {why}"), "give a smaller --threads"))
}

fn fma(kernel: Kernel) -> f64 {
    fma_of::<{ SUMS[0] }>(kernel).max(fma_of::<{ SUMS[1] }>(kernel))
}

fn fma_of<const SUMS: usize>(kernel: Kernel) -> f64 {
    let one = || {
        clocked(|| {
            black_box(kernel.run(Fma::<SUMS>));
        })
    };
    let seconds = fastest(|| rayon::broadcast(|_| one()).into_iter().sum());
    (2 * SUMS * LANES * LENGTH * rayon::current_num_threads()) as f64 / seconds
}

fn triad(kernel: Kernel) -> f64 {
    let blocks = NUMBERS / LANES;
    let (b, c) = (vec![F8::splat(1.0); blocks], vec![F8::splat(2.0); blocks]);
    let mut a = vec![F8::ZERO; blocks];
    let chunk = blocks.div_ceil(rayon::current_num_threads());
    let seconds = fastest(|| {
        let parts = a.par_chunks_mut(chunk).zip(b.par_chunks(chunk).zip(c.par_chunks(chunk)));
        let all = parts.map(|(a, (b, c))| clocked(|| kernel.run(Triad { a, b, c }))).sum();
        black_box(&mut a);
        all
    });
    (24 * NUMBERS) as f64 / seconds
}
