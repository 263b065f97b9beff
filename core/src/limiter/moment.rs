//! The moment limiter, in characteristic variables.

use super::CellLimiter;
use super::cell::{Beside, Cell};
use super::modes::Modes;
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// Krivodonova, J. Comput. Phys. 226, 2007: along each axis, from the highest mode i = N down to 1,
///
/// ```text
/// w_i <- minmod(w_i, a_i (w_(i-1)^+ - w_(i-1)), a_i (w_(i-1) - w_(i-1)^-)),      a_i = beta / (2 sqrt(4 i^2 - 1))
/// ```
///
/// and stop at the first i that stays. With orthonormal modes beta = 1 allows just the slope that the neighbours have. Each of the
/// N+1 lines of modes across the axis is limited by itself; differences are those of the state before this limiter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentLimiter {
    /// How much steeper than its neighbours a cell may be, 1 to 2. At 1 fronts are 6 cells wide and the order is lost.
    pub beta: f64,
}

impl Default for MomentLimiter {
    fn default() -> Self {
        Self { beta: 2.0 }
    }
}

/// A mode that changes by less than this share of the numbers around it stays.
const ROUNDING: f64 = 1e-12;

impl CellLimiter for MomentLimiter {
    fn name(&self) -> &'static str {
        "moment limiter"
    }

    fn limit(&self, cell: &Cell) -> Option<Modes> {
        let own = cell.modes();
        let along = |axis: usize| {
            let sides = [2 * axis, 2 * axis + 1].map(|face| cell.beside(face, &own));
            let mut out = own.clone();
            let changed = sides.iter().any(Option::is_some) && self.limit_along(axis, cell, (&own, &sides), &mut out);
            changed.then_some(out)
        };
        match (along(0), along(1)) {
            (Some(one), Some(two)) => Some(shorter(cell, one, &two)),
            (one, two) => one.or(two),
        }
    }
}

impl MomentLimiter {
    /// Limits along one axis; whether something has changed.
    fn limit_along(
        &self,
        axis: usize,
        cell: &Cell,
        (own, sides): (&Modes, &[Option<Beside>; 2]),
        out: &mut Modes,
    ) -> bool {
        let mean = own.mode(0);
        let waves = cell.waves(axis, [mean[0], mean[1], mean[2], mean[3]]);
        let mut any = false;
        for across in 0..own.m {
            // Each variable goes down from mode N until one stays.
            let mut goes_on = [true; UNKNOWNS];
            for i in (1..own.m).rev() {
                let (lower, number) = (own.number(axis, i - 1, across), own.number(axis, i, across));
                let factor = self.beta / (2.0 * ((4 * i * i - 1) as f64).sqrt());
                let mut w = waves.of(out.mode(number));
                let below = waves.of(own.mode(lower));
                let differences = [-1.0, 1.0].map(|sign| (sign, &sides[usize::from(sign > 0.0)]));
                let mut limits = [None; 2];
                for (limit, (sign, side)) in limits.iter_mut().zip(differences) {
                    *limit = side.as_ref().map(|side| {
                        let other = waves.of(side.modes.mode(lower));
                        let scale = sign * factor * side.share;
                        std::array::from_fn::<f64, UNKNOWNS, _>(|k| scale * (other[k] - below[k]))
                    });
                }
                let mut changed = false;
                for k in 0..UNKNOWNS {
                    let size = below[k].abs().max(w[k].abs());
                    let new = limits.iter().flatten().fold(w[k], |w, limit| minmod(w, limit[k]));
                    goes_on[k] &= (new - w[k]).abs() > ROUNDING * size;
                    if goes_on[k] {
                        (w[k], changed) = (new, true);
                    }
                }
                if changed {
                    out.set(number, waves.back(w));
                    any = true;
                }
                if goes_on == [false; UNKNOWNS] {
                    break;
                }
            }
        }
        any
    }
}

/// What both axes have limited: of a mode along one axis that axis, of a mixed mode the shorter one, p over rho0 c_p, so that no axis
/// comes first.
fn shorter(cell: &Cell, mut one: Modes, two: &Modes) -> Modes {
    let law = cell.law();
    let scale = 1.0 / (law.density() * law.pressure_speed([1.0, 0.0, 0.0, 1.0], [1.0, 0.0]));
    let square = |u: [f64; UNKNOWNS]| -> f64 {
        u.iter().enumerate().map(|(k, u)| if k < DEFORMATION { u * u } else { (scale * u).powi(2) }).sum()
    };
    for number in 1..one.m * one.m {
        let (i, j, b) = (number / one.m, number % one.m, two.mode(number));
        if i == 0 || (j > 0 && square(b) < square(one.mode(number))) {
            one.set(number, b);
        }
    }
    one
}

/// The smaller of two numbers of one sign, else 0.
fn minmod(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}
