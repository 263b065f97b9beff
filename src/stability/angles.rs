//! The worst Bloch angles of a patch.

use super::operator::Rate;
use super::spectrum;
use crate::error::Result;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Where the search for the worst angles ends: a part of the distance of two angles of the grid.
const END: f64 = 0.1;

/// Growth at some angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// c/h.
    pub growth: f64,
    /// Phase from unit to unit, along x and y.
    pub theta: [f64; 2],
}

/// The angles of a grid of `count` a direction; those left out have the conjugate symbol.
pub fn grid(count: usize) -> Vec<[f64; 2]> {
    let at = |k: usize| 2.0 * PI * k as f64 / count as f64;
    (0..=count / 2).flat_map(|iy| (0..count).map(move |ix| [at(ix), at(iy)])).collect()
}

/// The worst of the grid, and from there by a search that halves its distance.
///
/// # Errors
/// As for [`spectrum::worst`].
pub fn worst(rate: &Rate, count: usize) -> Result<At> {
    let of = |theta: [f64; 2]| growth_at(rate, theta).map(|growth| At { growth, theta });
    if !rate.periodic {
        return of([0.0; 2]);
    }
    let all: Vec<At> = grid(count).into_par_iter().map(of).collect::<Result<_>>()?;
    let more = |best: At, at: &At| if at.growth > best.growth { *at } else { best };
    let mut best = all.iter().fold(all[0], more);
    let spacing = 2.0 * PI / count as f64;
    let mut step = 0.5 * spacing;
    while step > END * spacing {
        let around =
            [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
        let moved = around.map(|by| [best.theta[0] + step * by[0], best.theta[1] + step * by[1]]);
        let found: Vec<At> = moved.into_par_iter().map(of).collect::<Result<_>>()?;
        let better = found.iter().fold(best, more);
        if better.growth <= best.growth {
            step *= 0.5;
        }
        best = better;
    }
    Ok(best)
}

/// The first angles found at which the growth is above a bound: `hint` first, then the grid.
///
/// # Errors
/// As for [`spectrum::worst`].
pub fn above(rate: &Rate, count: usize, bound: f64, hint: Option<[f64; 2]>) -> Result<Option<[f64; 2]>> {
    let of = |theta: [f64; 2]| growth_at(rate, theta).map(|growth| (growth > bound).then_some(theta));
    if let Some(theta) = hint
        && let Some(found) = of(theta)?
    {
        return Ok(Some(found));
    }
    if !rate.periodic {
        return of([0.0; 2]);
    }
    grid(count).into_par_iter().find_map_any(|theta| of(theta).transpose()).transpose()
}

/// Growth of a rate at some Bloch angles, or of a body.
///
/// # Errors
/// As for [`spectrum::worst`].
fn growth_at(rate: &Rate, theta: [f64; 2]) -> Result<f64> {
    match rate.periodic {
        true => spectrum::worst(rate.symbol(theta)?, rate.courant),
        false => spectrum::worst(rate.matrix()?, rate.courant),
    }
}
