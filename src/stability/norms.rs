//! Growth of the largest number of a perturbation of F and p over some steps, in the units 1 of F and rho0 c_p of p. (Jumps of the
//! displacement that such a perturbation makes act on F and p later, and are not among the numbers that are looked at.)

use super::operator::Rate;
use crate::error::Result;
use faer::traits::ComplexField;
use faer::{Mat, c64};
use rayon::prelude::*;
use std::f64::consts::PI;

/// |S^k| for k = 1, 10 and 100 steps, the norm that belongs to the largest number: the largest sum of a row. Of a patch
/// the norm of `count` x `count` units that close upon themselves. None where there is no step.
pub fn norms(rate: &Rate, count: usize) -> Result<Option<[f64; 3]>> {
    let Some(dt) = rate.courant else { return Ok(None) };
    let own = rate.roots().len();
    let scaled = |i: usize, j: usize| rate.roots()[j] / rate.roots()[i];
    if !rate.periodic {
        let matrix = rate.matrix()?;
        let size = matrix.nrows();
        let step = Mat::from_fn(size, size, |i, j| dt * matrix[(i, j)] + if i == j { 1.0 } else { 0.0 });
        let row = |power: &Mat<f64>| {
            let sum = |i: usize| (0..own).map(|j| (power[(i, j)] * scaled(i, j)).abs()).sum::<f64>();
            (0..own).map(sum).fold(0.0, f64::max)
        };
        return Ok(Some(powers(&step).each_ref().map(row)));
    }
    let angle = |k: usize| 2.0 * PI * k as f64 / count as f64;
    // Powers of the symbols; the other half is the conjugate.
    let half: Vec<[usize; 2]> = (0..=count / 2).flat_map(|y| (0..count).map(move |x| [x, y])).collect();
    let symbols: Vec<[Mat<c64>; 3]> = half
        .par_iter()
        .map(|at| {
            let symbol = rate.symbol(at.map(angle))?;
            let size = symbol.nrows();
            let one = |i, j| if i == j { 1.0 } else { 0.0 };
            Ok(powers(&Mat::from_fn(size, size, |i, j| symbol[(i, j)] * dt + one(i, j))))
        })
        .collect::<Result<_>>()?;
    // Back to units: the block of an offset is the mean of the symbols with their phases.
    let offsets: Vec<[usize; 2]> = (0..count * count).map(|k| [k % count, k / count]).collect();
    let sums = offsets.par_iter().map(|offset| {
        let mut rows = [vec![0.0; own], vec![0.0; own], vec![0.0; own]];
        for (power, rows) in rows.iter_mut().enumerate() {
            let mut block = Mat::<f64>::zeros(own, own);
            for (at, symbols) in half.iter().zip(&symbols) {
                let alone = at[1] == 0 || 2 * at[1] == count;
                let weight = if alone { 1.0 } else { 2.0 } / (count * count) as f64;
                let phase = angle((at[0] * offset[0] + at[1] * offset[1]) % count);
                let (cos, sin) = (weight * phase.cos(), weight * phase.sin());
                for j in 0..own {
                    let from = symbols[power].col(j).iter();
                    block.col_mut(j).iter_mut().zip(from).for_each(|(out, s)| *out += cos * s.re - sin * s.im);
                }
            }
            for (i, row) in rows.iter_mut().enumerate() {
                *row = (0..own).map(|j| (block[(i, j)] * scaled(i, j)).abs()).sum();
            }
        }
        rows
    });
    // In order: the same bits for any number of threads.
    let mut all = [vec![0.0; own], vec![0.0; own], vec![0.0; own]];
    for sum in sums.collect::<Vec<_>>() {
        all.iter_mut().flatten().zip(sum.iter().flatten()).for_each(|(a, b)| *a += b);
    }
    Ok(Some(all.each_ref().map(|rows| rows.iter().copied().fold(0.0, f64::max))))
}

/// S, S^10 and S^100.
fn powers<N: ComplexField>(step: &Mat<N>) -> [Mat<N>; 3] {
    let square = |m: &Mat<N>| m * m;
    let tenth = |m: &Mat<N>| {
        let two = square(m);
        square(&square(&two)) * two
    };
    let ten = tenth(step);
    let hundred = tenth(&ten);
    [step.clone(), ten, hundred]
}
