//! Lanes: the arithmetic of 8 neighbouring cells at once, one lane a cell.
//!
//! Fields are stored as plain [`F8`]; kernels are generic over a [`Lanes`] type that loads and stores
//! them, and laws over a [`Lane`], of which `f64` is the single-lane case (boundaries, probes, tests).
//! [`Kernel::run`] picks the widest type that the processor has and enters a function compiled for it, so
//! that one portable binary runs everywhere. All `unsafe` of the program is in this module.
//!
//! Pitfall: every generic function on the hot path needs `#[inline(always)]`, and closures cannot have it (so no
//! `array::map` there either): one that is not inlined is compiled without the processor's features, 4-6 times
//! slower, silently. `tests/inlining.rs` looks for such calls in the binary.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
pub mod counted;
mod dual;
pub mod functions;
mod portable;
mod single;
mod twin;

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;
pub use dual::Dual;
pub use portable::Portable;
pub use twin::{Twin, apart, twins};

use std::mem::ManuallyDrop;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::atomic::{AtomicU8, Ordering};

/// Number of cells in a block, one a lane.
pub const LANES: usize = 8;

/// Storage of one number for each of 8 cells.
#[repr(C, align(64))]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct F8(pub [f64; LANES]);

impl F8 {
    /// Zero in every lane.
    pub const ZERO: F8 = F8([0.0; LANES]);

    /// The same number in every lane.
    pub const fn splat(x: f64) -> F8 {
        F8([x; LANES])
    }
}

/// A slice of [`F8`] seen as plain numbers, lane fastest.
pub fn as_f64(values: &[F8]) -> &[f64] {
    // SAFETY: F8 is repr(C) around [f64; 8] and has no padding (its size, 64, is its alignment).
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), values.len() * LANES) }
}

/// Arithmetic on one number in each of some lanes.
pub trait Lane:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// self * b + c, fused where the hardware does it in one instruction.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Square root; NaN for negative lanes.
    fn sqrt(self) -> Self;
    /// Lane-wise minimum; where self is NaN the result is `other`, where `other` is NaN so is the result.
    fn min(self, other: Self) -> Self;
    /// Lane-wise maximum; NaN as in [`Lane::min`].
    fn max(self, other: Self) -> Self;
    /// First guess of x^(-1/3) for normal x > 0 by arithmetic on the bits, relative error below 6 %.
    fn inverse_cube_root_guess(self) -> Self;
    /// (m, k) with self = 2^k m, m in [sqrt(1/2), sqrt(2)), for normal numbers above 0; by arithmetic on the bits.
    fn split(self) -> (Self, Self);
    /// 2^k of a whole number k, -1022..=1023.
    fn power_of_two(self) -> Self;
    /// The nearest whole number, |self| < 2^51.
    #[inline(always)]
    fn nearest(self) -> Self {
        // A number below 2^51 that is added to 1.5 2^52 is rounded to a whole one.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        (self + Self::splat(ROUND)) - Self::splat(ROUND)
    }
    /// `yes` in the lanes where self > 0, else (also where it is NaN) `no`.
    fn where_positive(self, yes: Self, no: Self) -> Self;

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// x^(-1/3) for x in 1e-6..1e6 to 4e-16 relative, without a division; garbage for x <= 0.
    ///
    /// Two steps y += y e (1/3 + e (2/9 + e 14/81)), e = 1 - x y^3, of fourth order.
    #[inline(always)]
    fn inverse_cube_root(self) -> Self {
        let mut y = self.inverse_cube_root_guess();
        for _ in 0..2 {
            // (x y) and y^2 side by side: a shorter chain than x y y y.
            let e = (-(self * y)).mul_add(y * y, Self::splat(1.0));
            let series = e.mul_add(Self::splat(14.0 / 81.0), Self::splat(2.0 / 9.0));
            y = (y * e).mul_add(e.mul_add(series, Self::splat(1.0 / 3.0)), y);
        }
        y
    }
}

/// A [`Lane`] of 8 cells, with its storage.
pub trait Lanes: Lane {
    /// Reads 8 lanes.
    fn load(from: &F8) -> Self;
    /// Writes 8 lanes.
    fn store(self, to: &mut F8);
    /// From one number for each lane.
    fn from_lanes(numbers: [f64; LANES]) -> Self;
    /// Whether [`Lanes::pick`] is faster than [`load_lanes`].
    const PICKS: bool = false;
    /// These lanes, but those in `lanes` (a bit for each) from lane `from[l]` of `number`.
    #[inline(always)]
    fn pick(self, number: &F8, from: &[u8; LANES], lanes: u8) -> Self {
        let mut all = F8::ZERO;
        self.store(&mut all);
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            all.0[lane] = number.0[usize::from(from[lane]) % LANES];
        }
        Self::load(&all)
    }
    /// K numbers of cells in rows that begin in other lanes: lane l of number k is lane l + r of `first[at + k]` for
    /// l < 8 - r, then lane l + r - 8 of `second[at + k]`; r in 1..8.
    ///
    /// # Panics
    /// Where `at` is the first number of the runs, or the numbers do not end before the last one of both. (Both may be read a
    /// little beyond what is wanted.)
    #[inline(always)]
    fn load_joined<const K: usize>(first: &[F8], second: &[F8], at: usize, r: usize) -> [Self; K] {
        assert_within::<K>(first, second, at, r);
        let mut out = [Self::zero(); K];
        for (k, out) in out.iter_mut().enumerate() {
            let mut lanes = [0.0; LANES];
            for (lane, number) in lanes.iter_mut().enumerate() {
                let l = lane + r;
                *number = if l < LANES { first[at + k].0[l] } else { second[at + k].0[l - LANES] };
            }
            *out = Self::from_lanes(lanes);
        }
        out
    }
}

/// What [`Lanes::load_joined`] asks for.
#[inline(always)]
fn assert_within<const K: usize>(first: &[F8], second: &[F8], at: usize, r: usize) {
    let behind = first.len().min(second.len()).saturating_sub(at);
    assert!(at >= 1 && K < behind && (1..LANES).contains(&r), "runs to join lie beyond the numbers");
}

/// K numbers that lie behind each other. (`array::from_fn` and `array::map` take closures, which are not inlined.)
#[inline(always)]
pub fn load_array<L: Lanes, const K: usize>(from: &[F8]) -> [L; K] {
    let mut out = [L::zero(); K];
    for (out, from) in out.iter_mut().zip(from) {
        *out = L::load(from);
    }
    out
}

/// K numbers, for each lane from a place of its own: number k of lane l is number `first[l] + LANES k` of [`as_f64`] of
/// `from[l]`.
///
/// # Panics
/// Where a lane would read beyond the end.
#[inline(always)]
pub fn load_lanes<L: Lanes, const K: usize>(from: &[&[F8]; LANES], first: &[usize; LANES]) -> [L; K] {
    let mut at = [std::ptr::null(); LANES];
    let mut within = true;
    for lane in 0..LANES {
        let numbers = as_f64(from[lane]);
        within &= first[lane] < numbers.len().saturating_sub((K - 1) * LANES);
        at[lane] = numbers.as_ptr().wrapping_add(first[lane]);
    }
    assert!(within, "a lane beyond the end");
    let mut out = [L::zero(); K];
    for (k, out) in out.iter_mut().enumerate() {
        let mut lanes = [0.0; LANES];
        for lane in 0..LANES {
            // SAFETY: the last number of each lane was seen to be there, and k < K.
            lanes[lane] = unsafe { *at[lane].add(k * LANES) };
        }
        *out = L::from_lanes(lanes);
    }
    out
}

/// Asks for numbers that will be wanted soon, for the second cache; changes nothing. Hardware fetches ahead within a page
/// of 4 KiB only, which is about one block of one field.
#[inline(always)]
pub fn prefetch<T>(values: &[T]) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..size_of_val(values)).step_by(64) {
        let at = values.as_ptr().cast::<i8>().wrapping_add(line);
        // SAFETY: a hint, which no address makes fail; every x86_64 processor has it.
        unsafe { std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T1 }>(at) };
    }
}

/// A clock for the shortest of phases, in units of its own (the processor's time stamp; nanoseconds where there is none).
#[inline(always)]
pub fn ticks() -> u64 {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: reads a register; every x86_64 processor has it.
    return unsafe { std::arch::x86_64::_rdtsc() };
    #[cfg(not(target_arch = "x86_64"))]
    {
        static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
        START.get_or_init(std::time::Instant::now).elapsed().as_nanos() as u64
    }
}

/// Writes K numbers behind each other.
#[inline(always)]
pub fn store_array<L: Lanes, const K: usize>(values: [L; K], to: &mut [F8]) {
    for (value, to) in values.into_iter().zip(to) {
        value.store(to);
    }
}

/// An entry of an operator matrix: one number for all cells of a block (`f64`: the cells are congruent) or
/// one for each (`F8`).
pub trait Coefficient: Copy + Send + Sync {
    /// Whether each cell has a number of its own.
    const OWN: bool;
    /// The entry in each lane.
    fn lanes<L: Lanes>(&self) -> L;
}

impl Coefficient for f64 {
    const OWN: bool = false;
    #[inline(always)]
    fn lanes<L: Lanes>(&self) -> L {
        L::splat(*self)
    }
}

impl Coefficient for F8 {
    const OWN: bool = true;
    #[inline(always)]
    fn lanes<L: Lanes>(&self) -> L {
        L::load(self)
    }
}

/// A piece of work that is written once for all lane types. Implementations mark `run` `#[inline(always)]`.
pub trait Work {
    /// What it returns.
    type Out;
    /// Does the work on lanes of type L.
    fn run<L: Lanes>(self) -> Self::Out;
}

/// A piece of work where its caller has it. Handed on by value, it would be copied once more at each entry of a kernel.
struct InPlace<'a, W>(&'a mut ManuallyDrop<W>);

impl<W> InPlace<'_, W> {
    /// The work; once, for `self` is gone then.
    #[inline(always)]
    fn take(self) -> W {
        // SAFETY: made by `Kernel::run` alone, once, of a value that nothing else looks at.
        unsafe { ManuallyDrop::take(self.0) }
    }
}

/// The instruction set that the kernels use. Paths differ in the last digits (fused multiplication); a named
/// path repeats a run bit for bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kernel {
    /// AVX-512F.
    Avx512,
    /// AVX2 with fused multiplication.
    Avx2,
    /// Pairs of numbers: every processor.
    Portable,
    /// One number that stands for all, with its operations counted, see [`counted`]: for measurements, never for speed.
    Counting,
}

/// Kernels that the processor was found to have, a bit each: one test at each entry, of which a step has about ten a block. (The
/// standard library tests each feature.)
static FOUND: AtomicU8 = AtomicU8::new(0);

impl Kernel {
    /// The paths that a user may name, the widest first.
    pub const NAMES: &'static [(&'static str, Kernel)] =
        &[("avx512", Kernel::Avx512), ("avx2", Kernel::Avx2), ("portable", Kernel::Portable)];

    /// The name in options and tables.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, kernel)| *kernel == self).map_or("counting", |(name, _)| name)
    }

    /// Whether this processor has it.
    #[inline]
    pub fn is_available(self) -> bool {
        FOUND.load(Ordering::Relaxed) >> self as u8 & 1 == 1 || self.look()
    }

    /// Asks the processor.
    #[cold]
    fn look(self) -> bool {
        let found = match self {
            #[cfg(all(target_arch = "x86_64", feature = "kernel-avx512"))]
            Kernel::Avx512 => is_x86_feature_detected!("avx512f"),
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            Kernel::Portable => true,
            Kernel::Counting => cfg!(feature = "kernel-counting"),
            #[allow(unreachable_patterns)]
            _ => false,
        };
        FOUND.fetch_or(u8::from(found) << self as u8, Ordering::Relaxed);
        found
    }

    /// The widest that this processor has.
    pub fn widest() -> Kernel {
        let all = Self::NAMES.iter().map(|(_, kernel)| *kernel);
        all.into_iter().find(|kernel| kernel.is_available()).unwrap_or(Kernel::Portable)
    }

    /// Does the work on this path (on the portable one where the processor lacks it).
    #[cfg(not(test))]
    #[inline]
    pub fn run<W: Work>(self, work: W) -> W::Out {
        self.enter(work)
    }

    /// Does the work. The unit tests of other modules take the portable path alone: each path more is a tenth of the time to compile
    /// them. The tests of the whole program take the widest path, those of this module all, and those of `bench` count.
    #[cfg(test)]
    pub fn run<W: Work>(self, work: W) -> W::Out {
        enter_portable(InPlace(&mut ManuallyDrop::new(work)))
    }

    /// Does the work on this path, in unit tests as well.
    #[inline(always)]
    fn enter<W: Work>(self, work: W) -> W::Out {
        let work = InPlace(&mut ManuallyDrop::new(work));
        match self {
            // SAFETY: the processor has the features.
            #[cfg(all(target_arch = "x86_64", feature = "kernel-avx512"))]
            Kernel::Avx512 if self.is_available() => unsafe { avx512::enter_avx512(work) },
            // SAFETY: the processor has the features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2 if self.is_available() => unsafe { avx2::enter_avx2(work) },
            #[cfg(feature = "kernel-counting")]
            Kernel::Counting => enter_counted(work),
            _ => enter_portable(work),
        }
    }
}

// Functions of their own, as `enter_avx2` is: each is compiled once, not once for every caller.

#[inline(never)]
fn enter_portable<W: Work>(work: InPlace<W>) -> W::Out {
    work.take().run::<Portable>()
}

#[cfg(feature = "kernel-counting")]
#[inline(never)]
fn enter_counted<W: Work>(work: InPlace<W>) -> W::Out {
    work.take().run::<counted::Counted>()
}

#[cfg(test)]
mod tests;
