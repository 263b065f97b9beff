//! The numbers of a face point as a trace.

use super::across::Other;
use super::volume::width;
use crate::lane::{F8, Lane, Lanes};
use crate::riemann::{Looks, Riemann, Trace, hold};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// Runs `$body` with `$numbers` bound to the constant numbers of a trace, see [`width`].
macro_rules! with_width {
    ($looks:expr, $metered:expr, $numbers:ident => $body:expr) => {
        match ($looks, $metered) {
            (Looks::Nothing, false) => with_width!(@ Nothing, false, $numbers, $body),
            (Looks::Nothing, true) => with_width!(@ Nothing, true, $numbers, $body),
            (Looks::Shear, false) => with_width!(@ Shear, false, $numbers, $body),
            (Looks::Shear, true) => with_width!(@ Shear, true, $numbers, $body),
            (Looks::Displacement, false) => with_width!(@ Displacement, false, $numbers, $body),
            (Looks::Displacement, true) => with_width!(@ Displacement, true, $numbers, $body),
        }
    };
    (@ $looks:ident, $metered:literal, $numbers:ident, $body:expr) => {{
        const $numbers: usize = width(Looks::$looks, $metered);
        $body
    }};
}

/// A trace of some lanes from its numbers.
#[inline(always)]
pub(super) fn trace_of<L: Lanes, R: Riemann, const W: usize>(x: &[L; W]) -> Trace<L> {
    let shear = if R::LOOKS == Looks::Shear { x[9] } else { L::zero() };
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], shear] }
}

/// The other side's trace with this side's normal: its traction is P N^+ with N^+ = -N, and so is s = P T, which stands
/// behind c.
#[inline(always)]
pub(super) fn turned<L: Lanes, R: Riemann, const W: usize>(mut x: [L; W]) -> [L; W] {
    x[6] = -x[6];
    x[7] = -x[7];
    if W == width(R::LOOKS, true) {
        x[W - 2] = -x[W - 2];
        x[W - 1] = -x[W - 1];
    }
    x
}

/// How fast a face turns, [`Medium::turn`], from v at its first and last point, by [`super::block::Block::turning`].
#[inline(always)]
pub(super) fn turn<L: Lanes, O: Other, const W: usize>(own: &[[F8; W]], other: &O, turning: f64) -> L {
    let Some(last) = own.len().checked_sub(1).filter(|last| *last > 0) else { return L::zero() };
    let (first, beyond, beyond_last) = (&own[0], other.load::<L, W>(0), other.load::<L, W>(last));
    let mut square = L::zero();
    for k in DEFORMATION..UNKNOWNS {
        let change = (L::load(&own[last][k]) - L::load(&first[k])) + (beyond_last[k] - beyond[k]);
        square = change.mul_add(change, square);
    }
    square.sqrt() * L::splat(turning)
}

/// What is lifted of the held jump of displacement, [`hold`], from the numbers of both sides of one law.
#[inline(always)]
pub(super) fn held<L: Lane>(own: &[L], there: &[L], density: f64) -> [L; 2] {
    hold(gap(own, there), [own[8] * own[8], there[8] * there[8]], density)
}

/// The jump of displacement, from the numbers of both sides.
#[inline(always)]
pub(super) fn gap<L: Lane>(own: &[L], there: &[L]) -> [L; 2] {
    [there[9] - own[9], there[10] - own[10]]
}

pub(super) use with_width;
