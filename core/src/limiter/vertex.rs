//! The vertex-based limiter.

use super::CellLimiter;
use super::cell::Cell;
use super::modes::Modes;
use crate::state::UNKNOWNS;

/// Kuzmin, J. Comput. Appl. Math. 233, 2010, component by component: the linear part of each derivative may not leave, at a corner of the
/// cell, the range of the means of that derivative over the cells around the corner. Modes of order q = i + j are cut by
/// alpha_q = max over the orders from q to N, so that smooth extrema stay.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct VertexLimiter;

/// A share of the modes that may change without being called a change.
const ROUNDING: f64 = 1e-12;

impl CellLimiter for VertexLimiter {
    fn name(&self) -> &'static str {
        "vertex limiter"
    }

    fn limit(&self, cell: &Cell) -> Option<Modes> {
        let own = cell.modes();
        let top = own.m - 1;
        let mut alpha = [[1.0f64; UNKNOWNS]; MOST_ORDERS];
        for ends in [[0, 0], [0, 1], [1, 0], [1, 1]] {
            narrow(cell, &own, ends, &mut alpha);
        }
        for order in (1..top).rev() {
            let above = alpha[order + 1];
            alpha[order].iter_mut().zip(above).for_each(|(alpha, above)| *alpha = alpha.max(above));
        }
        let (mut out, mut changed) = (own.clone(), false);
        for i in 0..own.m {
            for j in (0..own.m).filter(|j| i + j > 0) {
                let mut mode = own.mode(i * own.m + j);
                for (value, alpha) in mode.iter_mut().zip(alpha[i + j]) {
                    changed |= alpha < 1.0 - ROUNDING && *value != 0.0;
                    *value *= alpha;
                }
                out.set(i * own.m + j, mode);
            }
        }
        changed.then_some(out)
    }
}

/// Orders i + j of modes, 0 to 12.
const MOST_ORDERS: usize = 13;

/// c_i times this is h^i d^i u/dx^i, but for terms of higher order: the product of 2 sqrt(4 k^2 - 1), k = 1..i.
fn derivative(order: usize) -> f64 {
    (1..=order).map(|k| 2.0 * ((4 * k * k - 1) as f64).sqrt()).product()
}

/// Lowers alpha of each order to what the derivatives around a corner allow.
fn narrow(cell: &Cell, own: &Modes, ends: [usize; 2], alpha: &mut [[f64; UNKNOWNS]; MOST_ORDERS]) {
    let m = own.m;
    let (mut low, mut high) = (own.clone(), own.clone());
    cell.around(ends, &mut |modes| {
        for (number, values) in modes.of[..m * m].iter().enumerate() {
            for (k, value) in values.iter().enumerate() {
                low.of[number][k] = low.of[number][k].min(*value);
                high.of[number][k] = high.of[number][k].max(*value);
            }
        }
    });
    for i in 0..m {
        for j in 0..m {
            let number = i * m + j;
            let scale = |i: usize, j: usize| derivative(i) * derivative(j);
            // The highest mode of all has no linear part.
            let Some(alpha) = alpha.get_mut(i + j + 1) else { continue };
            for (k, alpha) in alpha.iter_mut().enumerate() {
                let value = |number: usize| own.of[number][k];
                let slope = |there: bool, number: usize| if there { value(number) } else { 0.0 };
                let slopes = [slope(i + 1 < m, number + m), slope(j + 1 < m, number + 1)];
                let size = (0..m * m).fold(0.0f64, |a, b| a.max(value(b).abs()));
                // A derivative that is rounding says nothing.
                if slopes.iter().all(|slope| slope.abs() <= ROUNDING * size) {
                    continue;
                }
                let one = slopes[0] * scale(i + 1, j) * (ends[0] as f64 - 0.5);
                let rise = one + slopes[1] * scale(i, j + 1) * (ends[1] as f64 - 0.5);
                let far = if rise > 0.0 { high.of[number][k] } else { low.of[number][k] };
                if rise != 0.0 {
                    let room = (far - value(number)) * scale(i, j) / rise;
                    *alpha = alpha.min(room.clamp(0.0, 1.0));
                }
            }
        }
    }
}
