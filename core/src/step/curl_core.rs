//! Pi of eight cells that differ, by [`Curl`]: F <- F - theta W^-1 J K^T Z K J^T F.

use super::volume::{row, square};
use crate::lane::{F8, Lanes};
use crate::operators::curl_core::{Curl, functionals, numbers};
use crate::operators::curved::CurvedBlock;
use crate::operators::{BlockMetric, Cofactors, Line, NodeMetric, determinant};

/// Memory of the projection.
pub struct Arrays<'a> {
    /// W F, [row i][direction][node]; or what of F goes into the products of [`crate::operators::curl_free::Halves`] and [`Cells`].
    pub weighted: &'a mut [F8],
    /// C^T W F, [row i][column]; or what comes out of those products.
    pub coefficients: &'a mut [F8],
}

/// A block.
#[derive(Clone, Copy)]
pub struct Cells<'a> {
    /// The 1D tables.
    pub line: &'a Line,
    /// Its metric terms.
    pub metric: BlockMetric<'a>,
    /// K.
    pub curl: &'a Curl,
    /// Z, packed.
    pub core: &'a [F8],
}

/// Numbers at the nodes.
type Nodes<L, const M: usize> = [[L; M]; M];

/// dX/dxi_1 and dX/dxi_2 at the nodes.
#[derive(Clone, Copy)]
struct Tangents<'a, L, const M: usize> {
    /// Of straight cells: the first by the nodes of xi2, the second by those of xi1.
    straight: [[[L; 2]; M]; 2],
    curved: Option<CurvedBlock<'a>>,
}

impl<'a, L: Lanes, const M: usize> Tangents<'a, L, M> {
    #[inline(always)]
    fn new(line: &Line, metric: BlockMetric<'a>) -> Self {
        // J dxi_1/dX is dX/dxi_2 turned by a quarter, J dxi_2/dX so is -dX/dxi_1.
        let [one, two] = metric.straight.cofactors::<L, M>(line);
        let mut straight = [[[L::zero(); 2]; M]; 2];
        for k in 0..M {
            straight[0][k] = [two[k][1], -two[k][0]];
            straight[1][k] = [-one[k][1], one[k][0]];
        }
        Self { straight, curved: metric.curved }
    }

    /// Those at node (i, j).
    #[inline(always)]
    fn at(&self, i: usize, j: usize) -> [[L; 2]; 2] {
        match self.curved {
            None => [self.straight[0][j], self.straight[1][i]],
            Some(curved) => {
                let (one, two): ([L; 2], [L; 2]) = (curved.one(i, j), curved.two(i, j));
                [[two[1], -two[0]], [-one[1], one[0]]]
            }
        }
    }
}

impl Cells<'_> {
    /// Relaxes both rows of F in `u` by the share `theta` of each lane.
    #[inline(always)]
    pub fn project<L: Lanes, const M: usize>(&self, theta: L, arrays: Arrays, u: &mut [F8]) {
        let n = M * M;
        let tangents = Tangents::<L, M>::new(self.line, self.metric);
        let (moments, slopes) = (square::<M>(&self.curl.moments), square::<M>(&self.curl.slopes));
        let values = &mut arrays.weighted.as_chunks_mut::<2>().0[..functionals(M)];
        let results = &mut arrays.coefficients.as_chunks_mut::<2>().0[..functionals(M)];
        for (i, f) in u.chunks_exact(2 * n).enumerate().take(2) {
            let g = parent::<L, M>(&tangents, f);
            apply::<L, M>(&moments, &slopes, &g, i, values);
        }
        symmetric::<L>(&self.core[..numbers(M)], values, results);
        let factors = self.factors::<L, M>(theta, &tangents);
        for (i, f) in u.chunks_exact_mut(2 * n).enumerate().take(2) {
            let h = transposed::<L, M>(&moments, &slopes, results, i);
            let (one, two) = f.split_at_mut(n);
            for i in 0..M {
                for j in 0..M {
                    let (a, [x1, x2]) = (i * M + j, tangents.at(i, j));
                    let fields = [&mut one[a], &mut two[a]];
                    for (axis, field) in fields.into_iter().enumerate() {
                        let sum = x1[axis].mul_add(h[0][i][j], x2[axis] * h[1][i][j]);
                        factors[i][j].mul_add(sum, L::load(field)).store(field);
                    }
                }
            }
        }
    }

    /// -theta / (w_a J_a).
    #[inline(always)]
    fn factors<L: Lanes, const M: usize>(&self, theta: L, tangents: &Tangents<L, M>) -> Nodes<L, M> {
        let weights = row::<M>(&self.line.basis.weights);
        let mut out = [[L::zero(); M]; M];
        for i in 0..M {
            for j in 0..M {
                let [x1, x2] = tangents.at(i, j);
                let mass = L::splat(-weights[i] * weights[j]) * determinant(x1, x2);
                out[i][j] = theta / mass;
            }
        }
        out
    }
}

/// g_k = F_a dX_a/dxi_k of a row of F.
#[inline(always)]
fn parent<L: Lanes, const M: usize>(tangents: &Tangents<L, M>, f: &[F8]) -> [Nodes<L, M>; 2] {
    let (one, two) = f.split_at(M * M);
    let mut g = [[[L::zero(); M]; M]; 2];
    for i in 0..M {
        for j in 0..M {
            let (one, two) = (L::load(&one[i * M + j]), L::load(&two[i * M + j]));
            for (g, x) in g.iter_mut().zip(tangents.at(i, j)) {
                g[i][j] = one.mul_add(x[0], two * x[1]);
            }
        }
    }
    g
}

/// sum_k row_k values_k.
#[inline(always)]
fn sum<L: Lanes, const M: usize>(row: &[f64; M], values: [L; M], count: usize) -> L {
    let mut out = L::splat(row[0]) * values[0];
    for k in 1..count {
        out = L::splat(row[k]).mul_add(values[k], out);
    }
    out
}

/// Column j of a matrix.
#[inline(always)]
fn column<T: Copy, const M: usize>(matrix: &[[T; M]; M], j: usize) -> [T; M] {
    let mut out = matrix[0];
    for (out, row) in out.iter_mut().zip(matrix) {
        *out = row[j];
    }
    out
}

/// K g into number `i` of each value.
#[inline(always)]
fn apply<L: Lanes, const M: usize>(
    moments: &[[f64; M]; M],
    slopes: &[[f64; M]; M],
    g: &[Nodes<L, M>; 2],
    i: usize,
    values: &mut [[F8; 2]],
) {
    let degree = M - 1;
    // Moments of g_1 along xi1, of g_2 along xi2.
    let (mut one, mut two) = ([[L::zero(); M]; M], [[L::zero(); M]; M]);
    for k in 0..M {
        for j in 0..M {
            one[k][j] = sum(&moments[k], column(&g[0], j), M);
            two[j][k] = sum(&moments[k], g[1][j], M);
        }
    }
    for a in 0..degree {
        for c in 0..degree {
            let curl = sum(&slopes[c], one[a], M) - sum(&slopes[a], column(&two, c), M);
            curl.store(&mut values[a * degree + c][i]);
        }
    }
    let (first, second) = values[degree * degree..].split_at_mut(M);
    for j in 0..M {
        one[degree][j].store(&mut first[j][i]);
        two[j][degree].store(&mut second[j][i]);
    }
}

/// K^T of number `i` of each value.
#[inline(always)]
fn transposed<L: Lanes, const M: usize>(
    moments: &[[f64; M]; M],
    slopes: &[[f64; M]; M],
    values: &[[F8; 2]],
    i: usize,
) -> [Nodes<L, M>; 2] {
    let degree = M - 1;
    let mut curl = [[L::zero(); M]; M];
    for a in 0..degree {
        for c in 0..degree {
            curl[a][c] = L::load(&values[a * degree + c][i]);
        }
    }
    let (mut one, mut two) = ([[L::zero(); M]; M], [[L::zero(); M]; M]);
    for k in 0..degree {
        for j in 0..M {
            one[k][j] = sum(&column(slopes, j), curl[k], degree);
            two[j][k] = -sum(&column(slopes, j), column(&curl, k), degree);
        }
    }
    let (first, second) = values[degree * degree..].split_at(M);
    for j in 0..M {
        one[degree][j] = L::load(&first[j][i]);
        two[j][degree] = L::load(&second[j][i]);
    }
    let mut out = [[[L::zero(); M]; M]; 2];
    let [first, second] = &mut out;
    for (i, (first, second)) in first.iter_mut().zip(second).enumerate() {
        for (j, (first, second)) in first.iter_mut().zip(second).enumerate() {
            *first = sum(&column(moments, i), column(&one, j), M);
            *second = sum(&column(moments, j), two[i], M);
        }
    }
    out
}

/// out = Z x of both rows of F, two rows of Z at a time: each number of Z is read once.
#[inline(always)]
fn symmetric<L: Lanes>(core: &[F8], x: &[[F8; 2]], out: &mut [[F8; 2]]) {
    let mut rest = core;
    for r in (0..x.len()).step_by(2) {
        let count = (x.len() - r).min(2);
        let (numbers, next) = rest.split_at(count * r + count * (count + 1) / 2);
        rest = next;
        if count == 2 { two_rows::<L>(numbers, r, x, out) } else { one_row::<L>(numbers, r, x, out) }
    }
}

/// A pair of numbers.
#[inline(always)]
fn pair<L: Lanes>(x: &[F8; 2]) -> [L; 2] {
    [L::load(&x[0]), L::load(&x[1])]
}

#[inline(always)]
fn two_rows<L: Lanes>(core: &[F8], r: usize, x: &[[F8; 2]], out: &mut [[F8; 2]]) {
    let (left, diagonal) = core.as_chunks::<2>().0.split_at(r);
    let (one, two) = (pair::<L>(&x[r]), pair::<L>(&x[r + 1]));
    let last = L::load(&core[2 * r + 2]);
    let [first, between] = pair::<L>(&diagonal[0]);
    let mut sums = [[L::zero(); 2]; 2];
    for i in 0..2 {
        sums[0][i] = first.mul_add(one[i], between * two[i]);
        sums[1][i] = between.mul_add(one[i], last * two[i]);
    }
    for ((z, x), out) in left.iter().zip(x).zip(out.iter_mut()) {
        let (z, x) = (pair::<L>(z), pair::<L>(x));
        for i in 0..2 {
            sums[0][i] = z[0].mul_add(x[i], sums[0][i]);
            sums[1][i] = z[1].mul_add(x[i], sums[1][i]);
            z[0].mul_add(one[i], z[1].mul_add(two[i], L::load(&out[i]))).store(&mut out[i]);
        }
    }
    for i in 0..2 {
        sums[0][i].store(&mut out[r][i]);
        sums[1][i].store(&mut out[r + 1][i]);
    }
}

#[inline(always)]
fn one_row<L: Lanes>(core: &[F8], r: usize, x: &[[F8; 2]], out: &mut [[F8; 2]]) {
    let one = pair::<L>(&x[r]);
    let last = L::load(&core[r]);
    let mut sums = [last * one[0], last * one[1]];
    for ((z, x), out) in core[..r].iter().zip(x).zip(out.iter_mut()) {
        let (z, x) = (L::load(z), pair::<L>(x));
        for i in 0..2 {
            sums[i] = z.mul_add(x[i], sums[i]);
            z.mul_add(one[i], L::load(&out[i])).store(&mut out[i]);
        }
    }
    for i in 0..2 {
        sums[i].store(&mut out[r][i]);
    }
}
