//! The control of the curl of F in one block: what [`Relax`] takes of R = F - Pi F = C C^T W F.

use super::curl_core::{Arrays, Cells};
use super::volume::Masses;
use crate::lane::{F8, Lane, Lanes, Work};
use crate::operators::curl_free::{Class, Halves, Relax};
use crate::operators::{CurlFree, Matrix, Share};
use crate::tensor::DEFORMATION;

/// The control of the curl of F.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// What is relaxed.
    pub relax: Relax,
    /// alpha N: theta = 1 - exp(-alpha N c dt / h).
    pub rate: f64,
}

/// What of the speed of the prestress ([`super::Speeds`]) the rotation of R goes with: half of it leaves growth at
/// diag(.7, .7), twice of it nothing less.
pub const ROTATION: f64 = 1.0;

/// What of c_p it goes with at least, where the law is elastic. A rotation inside of a cell that no displacement has costs no energy,
/// nothing restores it, and it grows with time until it meets compression: an unloaded steel frame that spins at 50 turns a second
/// (S2, 20 ms) gained 8 % of its energy and stopped with 0; it keeps .999 of it with .03, .9992 with .1, .3 and 1. In tension waves grow
/// with it (diag(1.3, 1), N = 3: 2e-6 c/h with .03, 6e-5 with .1). Where laws flow, their histories go with such rotations: a
/// frame that yields all over makes ten times its energy with .1.
pub const SLOWEST: f64 = 0.03;

/// What of the speed of the prestress the deviator goes with; with the rotation alone N = 3 grows at diag(.7, .7) by 3e-3 c/h.
pub const DEVIATOR: f64 = 0.5;

/// (-1)^j / (j + 2)!: 1 - exp(-r) = r - r^2 sum_j of these r^j.
const SERIES: [f64; 12] = {
    let (mut out, mut j) = ([0.5; 12], 1);
    while j < 12 {
        out[j] = -out[j - 1] / (j + 2) as f64;
        j += 1;
    }
    out
};

/// 1 - exp(-x) for x >= 0, to 1e-15 relative.
///
/// x = k ln 2 + r, |r| <= ln 2 / 2 (x beyond 40, where it is 1, is cut off): 1 - 2^-k + 2^-k q(r), q(r) = 1 - exp(-r) by its
/// series, whose first term left out is 1e-17 of the first one. The series goes by pairs, pairs of pairs and so on (Estrin's
/// scheme): a term that waits for the one before it would take a third of the projection at low degrees.
#[inline(always)]
pub fn relaxation<L: Lane>(x: L) -> L {
    let x = x.min(L::splat(40.0));
    // -k.
    let minus = (x * L::splat(-std::f64::consts::LOG2_E)).nearest();
    let r = minus.mul_add(L::splat(std::f64::consts::LN_2), x);
    let (r2, mut pairs) = (r * r, [L::zero(); 6]);
    for (j, pair) in pairs.iter_mut().enumerate() {
        *pair = r.mul_add(L::splat(-SERIES[2 * j + 1]), L::splat(-SERIES[2 * j]));
    }
    let [a, b, c, d, e, f] = pairs;
    let (a, c, e, r4) = (r2.mul_add(b, a), r2.mul_add(d, c), r2.mul_add(f, e), r2 * r2);
    let q = r2.mul_add(r4.mul_add(r4.mul_add(e, c), a), r);
    let power = minus.power_of_two();
    power.mul_add(q, L::splat(1.0) - power)
}

/// Relaxes the rows of F in `u` of a block towards gradients by the share `theta` of each lane; finds the mass matrix where it
/// is wanted.
#[inline(always)]
pub fn project<L: Lanes, const M: usize>(
    curl_free: &CurlFree,
    block: usize,
    theta: L,
    masses: Masses<'_, M>,
    arrays: Arrays,
    u: &mut [F8],
) {
    let pool = &curl_free.pool;
    match pool.share[block] {
        Share::Shared(k) => match &pool.shared[k] {
            Class::Halves(halves) => with_halves::<L, M>(halves, theta, arrays, u),
            Class::Whole(c) => with_matrix::<L, M>(c, theta, masses, arrays, u),
        },
        Share::Own(k) => {
            let Masses { line, metric, .. } = masses;
            Cells { line, metric, curl: &curl_free.curl, core: &pool.own[k] }.project::<L, M>(theta, arrays, u);
        }
    }
}

/// Both rows of F at four nodes, a row in registers, see [`Halves`].
#[inline(always)]
fn with_small_halves<L: Lanes>(halves: &Halves, theta: L, u: &mut [F8]) {
    let matrices = [halves.even.data.first_chunk(), halves.odd.data.first_chunk()];
    let [Some(even), Some(odd)] = matrices else { return };
    let minus = -theta;
    for f in &mut u.as_chunks_mut::<8>().0[..2] {
        let (mut sums, mut differences) = ([L::zero(); 4], [L::zero(); 4]);
        for k in 0..4 {
            let (one, two) = (L::load(&f[PAIRS[k][0]]), L::load(&f[PAIRS[k][1]]));
            (sums[k], differences[k]) = (one + two, one - two);
        }
        let (sums, differences) = (times(even, sums), times(odd, differences));
        for k in 0..4 {
            let [one, two] = PAIRS[k];
            minus.mul_add(sums[k] + differences[k], L::load(&f[one])).store(&mut f[one]);
            minus.mul_add(sums[k] - differences[k], L::load(&f[two])).store(&mut f[two]);
        }
    }
}

/// Opposite nodes of four, in both directions.
const PAIRS: [[usize; 2]; 4] = [[0, 3], [1, 2], [4, 7], [5, 6]];

/// A product with a 4 x 4 matrix.
#[inline(always)]
fn times<L: Lanes>(matrix: &[f64; 16], x: [L; 4]) -> [L; 4] {
    let mut out = [L::zero(); 4];
    for (out, row) in out.iter_mut().zip(&matrix.as_chunks::<4>().0[..4]) {
        *out = L::splat(row[0]) * x[0];
        for k in 1..4 {
            *out = L::splat(row[k]).mul_add(x[k], *out);
        }
    }
    out
}

/// Nodes a and n - 1 - a by their sum and difference, see [`Halves`]. Numbers of both rows of F stand side by side.
#[inline(always)]
fn with_halves<L: Lanes, const M: usize>(halves: &Halves, theta: L, arrays: Arrays, u: &mut [F8]) {
    if M == 2 {
        return with_small_halves::<L>(halves, theta, u);
    }
    let n = M * M;
    let (evens, odds) = (n.div_ceil(2), n / 2);
    let (even, odd) = arrays.weighted.as_chunks_mut::<2>().0[..2 * n].split_at_mut(2 * evens);
    let fields = &mut u[..DEFORMATION * n];
    for (k, f) in fields.chunks_exact(n).enumerate() {
        let (i, axis) = (k / 2, k % 2);
        for a in 0..odds {
            let (one, two) = (L::load(&f[a]), L::load(&f[n - 1 - a]));
            (one + two).store(&mut even[axis * evens + a][i]);
            (one - two).store(&mut odd[axis * odds + a][i]);
        }
        if evens > odds {
            even[axis * evens + odds][i] = f[odds];
        }
    }
    let (even_out, odd_out) = arrays.coefficients.as_chunks_mut::<2>().0[..2 * n].split_at_mut(2 * evens);
    products::<L>(&halves.even.data[..4 * evens * evens], even, even_out);
    products::<L>(&halves.odd.data[..4 * odds * odds], odd, odd_out);
    let minus = -theta;
    for (k, f) in fields.chunks_exact_mut(n).enumerate() {
        let (i, axis) = (k / 2, k % 2);
        for a in 0..odds {
            let (one, two) = (L::load(&even_out[axis * evens + a][i]), L::load(&odd_out[axis * odds + a][i]));
            minus.mul_add(one + two, L::load(&f[a])).store(&mut f[a]);
            minus.mul_add(one - two, L::load(&f[n - 1 - a])).store(&mut f[n - 1 - a]);
        }
        if evens > odds {
            minus.mul_add(L::load(&even_out[axis * evens + odds][i]), L::load(&f[odds])).store(&mut f[odds]);
        }
    }
}

/// out = matrix input, pairs of numbers each. Rows are two a node: an even number.
#[inline(always)]
fn products<L: Lanes>(matrix: &[f64], input: &[[F8; 2]], out: &mut [[F8; 2]]) {
    let rows = input.len();
    let triples = rows / 3;
    for k in 0..triples {
        product::<L, 3>(&matrix[3 * k * rows..], input, &mut out[3 * k..]);
    }
    let mut r = 3 * triples;
    while r + 1 < rows {
        product::<L, 2>(&matrix[r * rows..], input, &mut out[r..]);
        r += 2;
    }
    if r < rows {
        product::<L, 1>(&matrix[r * rows..], input, &mut out[r..]);
    }
}

/// The first K rows. They are worked on together: sums stay in registers and do not wait for each other.
#[inline(always)]
fn product<L: Lanes, const K: usize>(matrix: &[f64], input: &[[F8; 2]], out: &mut [[F8; 2]]) {
    let columns = input.len();
    let mut rows = [&[] as &[f64]; K];
    for (k, row) in rows.iter_mut().enumerate() {
        *row = &matrix[k * columns..][..columns];
    }
    let mut sum = [[L::zero(); 2]; K];
    for (column, pair) in input.iter().enumerate() {
        let (one, two) = (L::load(&pair[0]), L::load(&pair[1]));
        for k in 0..K {
            let entry = L::splat(rows[k][column]);
            sum[k][0] = entry.mul_add(one, sum[k][0]);
            sum[k][1] = entry.mul_add(two, sum[k][1]);
        }
    }
    for (out, sum) in out[..K].iter_mut().zip(&sum) {
        sum[0].store(&mut out[0]);
        sum[1].store(&mut out[1]);
    }
}

#[inline(always)]
fn with_matrix<L: Lanes, const M: usize>(
    matrix: &Matrix<f64>,
    theta: L,
    masses: Masses<'_, M>,
    arrays: Arrays,
    u: &mut [F8],
) {
    let (rows, columns, n) = (matrix.rows, matrix.columns, M * M);
    let mass = masses.run::<L>();
    let Arrays { weighted, coefficients } = arrays;
    for (weighted, u) in weighted.chunks_exact_mut(n).zip(u.chunks_exact(n)).take(DEFORMATION) {
        for a in 0..n {
            (L::load(&mass[a]) * L::load(&u[a])).store(&mut weighted[a]);
        }
    }
    let mut first = 0;
    while first < columns {
        first += match columns - first {
            1 => coefficients_of::<L, 1>(matrix, first, theta, weighted, coefficients),
            2 | 4 => coefficients_of::<L, 2>(matrix, first, theta, weighted, coefficients),
            _ => coefficients_of::<L, 3>(matrix, first, theta, weighted, coefficients),
        };
    }
    let (one, two) = u[..2 * rows].split_at_mut(rows);
    // Rows are two a node: an even number.
    let mut r = 0;
    while r < rows {
        r += match rows - r {
            1 => subtract::<L, 1>(matrix, r, coefficients, [&mut *one, &mut *two]),
            2 | 4 => subtract::<L, 2>(matrix, r, coefficients, [&mut *one, &mut *two]),
            _ => subtract::<L, 3>(matrix, r, coefficients, [&mut *one, &mut *two]),
        };
    }
}

/// theta C^T W F of K columns from `first`; K. Columns (below, rows) are worked on together: the sums of both rows of F stay
/// in registers and do not wait for each other.
#[inline(always)]
fn coefficients_of<L: Lanes, const K: usize>(
    matrix: &Matrix<f64>,
    first: usize,
    theta: L,
    weighted: &[F8],
    coefficients: &mut [F8],
) -> usize {
    let (rows, columns) = (matrix.rows, matrix.columns);
    let (one, two) = (&weighted[..rows], &weighted[rows..2 * rows]);
    let mut sum = [[L::zero(); 2]; K];
    let mut entries = &matrix.data[first..];
    for r in 0..rows {
        let (one, two, row) = (L::load(&one[r]), L::load(&two[r]), &entries[..K]);
        for k in 0..K {
            let entry = L::splat(row[k]);
            sum[k][0] = entry.mul_add(one, sum[k][0]);
            sum[k][1] = entry.mul_add(two, sum[k][1]);
        }
        entries = &entries[columns.min(entries.len())..];
    }
    for k in 0..K {
        (theta * sum[k][0]).store(&mut coefficients[first + k]);
        (theta * sum[k][1]).store(&mut coefficients[columns + first + k]);
    }
    K
}

/// Subtracts K rows of C times the coefficients from both rows of F; K.
#[inline(always)]
fn subtract<L: Lanes, const K: usize>(
    matrix: &Matrix<f64>,
    first: usize,
    coefficients: &[F8],
    u: [&mut [F8]; 2],
) -> usize {
    let columns = matrix.columns;
    let (one, two) = (&coefficients[..columns], &coefficients[columns..2 * columns]);
    let mut rows = [&[] as &[f64]; K];
    for (k, row) in rows.iter_mut().enumerate() {
        *row = &matrix.data[(first + k) * columns..][..columns];
    }
    let mut sum = [[L::zero(); 2]; K];
    for column in 0..columns {
        let (one, two) = (L::load(&one[column]), L::load(&two[column]));
        for k in 0..K {
            let entry = L::splat(rows[k][column]);
            sum[k][0] = entry.mul_add(one, sum[k][0]);
            sum[k][1] = entry.mul_add(two, sum[k][1]);
        }
    }
    for (i, u) in u.into_iter().enumerate() {
        for (u, sum) in u[first..first + K].iter_mut().zip(&sum) {
            (L::load(u) - sum[i]).store(u);
        }
    }
    K
}

#[cfg(test)]
mod tests;
