//! A lane type that counts: the real kernels run on it, and what they compute with is the number of flops of a cell.
//!
//! Counts are kept per thread, by slot: [`mark`] books what was counted since the last mark. Kernels know nothing of it;
//! the phase clock of the step marks, so that flops per phase come out beside seconds per phase. A thread that does not
//! count pays one test of a thread-local flag a mark.
//!
//! One operation on eight lanes counts once: flops are those of one cell where each lane holds a cell. Only the first
//! lane is computed, and written to all: what kernels do depends on no number, and a third copy of them compiles quickly.

use super::{F8, LANES, Lane, Lanes};
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Arithmetic operations on one number (one lane).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Additions and subtractions.
    pub additions: u64,
    /// Multiplications.
    pub multiplications: u64,
    /// Fused a b + c.
    pub fused: u64,
    /// Divisions.
    pub divisions: u64,
    /// Square roots.
    pub roots: u64,
}

impl Counts {
    /// None.
    pub const ZERO: Counts = Counts { additions: 0, multiplications: 0, fused: 0, divisions: 0, roots: 0 };

    /// Floating-point operations: a fused one is two, every other is one. Signs, minima and the bits of the guess of a
    /// cube root are none.
    pub fn flops(&self) -> u64 {
        self.additions + self.multiplications + 2 * self.fused + self.divisions + self.roots
    }

    /// The sum of both.
    pub fn plus(&self, other: &Counts) -> Counts {
        Counts {
            additions: self.additions + other.additions,
            multiplications: self.multiplications + other.multiplications,
            fused: self.fused + other.fused,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
        }
    }
}

/// Slots of [`mark`].
pub const SLOTS: usize = 16;

thread_local! {
    static COUNTING: Cell<bool> = const { Cell::new(false) };
    static NOW: Cell<Counts> = const { Cell::new(Counts::ZERO) };
    static BOOKED: Cell<[Counts; SLOTS]> = const { Cell::new([Counts::ZERO; SLOTS]) };
}

/// Books what this thread counted since the last mark on a slot; nothing where it does not count.
#[inline]
pub fn mark(slot: usize) {
    if COUNTING.get() {
        book(slot);
    }
}

#[cold]
fn book(slot: usize) {
    let (now, mut booked) = (NOW.take(), BOOKED.get());
    booked[slot % SLOTS] = booked[slot % SLOTS].plus(&now);
    BOOKED.set(booked);
}

/// Runs `body` and returns what it did on [`Counted`] lanes in this thread, by slot; what was not marked stands in the
/// last one.
pub fn count(body: impl FnOnce()) -> [Counts; SLOTS] {
    NOW.set(Counts::ZERO);
    BOOKED.set([Counts::ZERO; SLOTS]);
    COUNTING.set(true);
    body();
    book(SLOTS - 1);
    COUNTING.set(false);
    BOOKED.get()
}

/// Eight lanes, of which the first stands for all, counted.
#[derive(Debug, Clone, Copy)]
pub struct Counted(f64);

/// Adds one to a kind of operation. Not inlined, nor are the operations: a copy of all kernels that is made of calls
/// compiles quickly.
#[inline(never)]
fn tally(change: fn(&mut Counts)) {
    let mut now = NOW.get();
    change(&mut now);
    NOW.set(now);
}

macro_rules! counted_operator {
    ($trait:ident, $method:ident, $kind:ident) => {
        impl $trait for Counted {
            type Output = Counted;
            #[inline(never)]
            fn $method(self, other: Counted) -> Counted {
                tally(|now| now.$kind += 1);
                Counted($trait::$method(self.0, other.0))
            }
        }
    };
}
counted_operator!(Add, add, additions);
counted_operator!(Sub, sub, additions);
counted_operator!(Mul, mul, multiplications);
counted_operator!(Div, div, divisions);

impl Neg for Counted {
    type Output = Counted;
    #[inline(never)]
    fn neg(self) -> Counted {
        Counted(-self.0)
    }
}

impl Lane for Counted {
    #[inline(never)]
    fn splat(x: f64) -> Counted {
        Counted(x)
    }
    #[inline(never)]
    fn mul_add(self, b: Counted, c: Counted) -> Counted {
        tally(|now| now.fused += 1);
        Counted(Lane::mul_add(self.0, b.0, c.0))
    }
    #[inline(never)]
    fn sqrt(self) -> Counted {
        tally(|now| now.roots += 1);
        Counted(self.0.sqrt())
    }
    #[inline(never)]
    fn min(self, other: Counted) -> Counted {
        Counted(Lane::min(self.0, other.0))
    }
    #[inline(never)]
    fn max(self, other: Counted) -> Counted {
        Counted(Lane::max(self.0, other.0))
    }
    #[inline(never)]
    fn inverse_cube_root_guess(self) -> Counted {
        Counted(self.0.inverse_cube_root_guess())
    }
    #[inline(never)]
    fn split(self) -> (Counted, Counted) {
        let (mantissa, power) = self.0.split();
        (Counted(mantissa), Counted(power))
    }
    #[inline(never)]
    fn power_of_two(self) -> Counted {
        Counted(self.0.power_of_two())
    }
    #[inline(never)]
    fn where_positive(self, yes: Counted, no: Counted) -> Counted {
        Counted(self.0.where_positive(yes.0, no.0))
    }
}

impl Lanes for Counted {
    #[inline(never)]
    fn load(from: &F8) -> Counted {
        Counted(from.0[0])
    }
    #[inline(never)]
    fn store(self, to: &mut F8) {
        *to = F8::splat(self.0);
    }
    #[inline(never)]
    fn from_lanes(numbers: [f64; LANES]) -> Counted {
        Counted(numbers[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::{Kernel, Work};

    struct Mixed(F8);
    impl Work for Mixed {
        type Out = ();
        fn run<L: Lanes>(self) {
            let a = L::load(&self.0);
            // 1 multiplication, 2 additions, 1 fused, 1 division, 1 root; signs and extremes are no flops.
            let b = (a * a + a - a).mul_add(a, -a).max(a) / a;
            mark(3);
            b.sqrt().store(&mut F8::ZERO.clone());
        }
    }

    #[test]
    fn each_operation_counts_once_in_the_slot_of_its_mark() {
        let counts = count(|| Kernel::Counting.enter(Mixed(F8::splat(2.0))));
        let expected = Counts { additions: 2, multiplications: 1, fused: 1, divisions: 1, roots: 0 };
        assert_eq!(counts[3], expected);
        assert_eq!(counts[SLOTS - 1], Counts { roots: 1, ..Counts::ZERO });
        assert_eq!((expected.flops(), counts[0].flops()), (6, 0));
    }

    #[test]
    fn nothing_is_booked_by_a_thread_that_does_not_count() {
        let counts = count(|| {});
        Kernel::Counting.enter(Mixed(F8::splat(2.0)));
        mark(3);
        assert_eq!((counts, BOOKED.get()), ([Counts::ZERO; SLOTS], [Counts::ZERO; SLOTS]));
    }

    #[test]
    fn counted_lanes_compute_as_the_first_of_portable_ones() {
        struct Sum(F8, F8);
        impl Work for Sum {
            type Out = F8;
            fn run<L: Lanes>(self) -> F8 {
                let (a, b, mut out) = (L::load(&self.0), L::load(&self.1), F8::ZERO);
                ((a - b) / a.mul_add(b, a.sqrt()) + a.min(b).inverse_cube_root()).store(&mut out);
                out
            }
        }
        let of = |kernel: Kernel| kernel.enter(Sum(F8::splat(1.7), F8([1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 9.0, 8.0])));
        assert_eq!(of(Kernel::Counting), F8::splat(of(Kernel::Portable).0[0]));
    }
}
