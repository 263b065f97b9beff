//! The traces of the displacement of two cells at their face, fitted so that they do not jump where the displacement is smooth.

use super::Line;
use crate::mesh::map::{self, CellMap, on_face};
use crate::quadrature::legendre;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, RowDVector};

/// How much of a jump is let by for what the traces leave out, over the largest jump that a part of size 1 of it makes. Orders of the manufactured
/// problem on trapezoids (16 to 32 cells) with .1, .01, .001, .0003: S2 2.62, 2.83, 2.83, 2.83, S3 2.95, 3.12, 3.63, 3.79.
const SLACK: f64 = 3e-4;
/// The largest norm of what the traces of a point leave out, over that of the trace along a line, N + 1. With 2 at N = 1 the faces between
/// cells of lengths 1 : 6 in both directions were stiffer than the step.
const MOST: f64 = 0.5;
/// Conditions below this share of the largest say nothing: rounding.
const RANK: f64 = 1e-11;

/// A cell at a face: its map, the face, and whether the points of the face are counted from its end.
pub(super) type AtFace<'a> = (&'a CellMap, usize, bool);

/// What all fits of a degree share.
pub(super) struct Fit<'a> {
    line: &'a Line,
    /// The functionals a_ij of what traces may leave out, each by node.
    modes: Vec<Vec<f64>>,
    /// The powers (p, q) of the polynomials that must not jump, from low to high degree.
    powers: Vec<[usize; 2]>,
    /// So many of them have a degree of N or less.
    exact: usize,
}

impl<'a> Fit<'a> {
    /// Of the degree of `line`, at least 1.
    pub fn new(line: &'a Line) -> Self {
        let (m, degree) = (line.m, line.m - 1);
        let along = |i: usize, k: usize| line.basis.weights[k] * normal(i, line.basis.nodes[k]);
        let mode = |i: usize, j: usize| (0..m * m).map(|a| along(i, a / m) * along(j, a % m)).collect();
        let lowest = (degree - 1).max(1);
        let pairs = (0..m).flat_map(|i| (0..m).map(move |j| [i, j]));
        let modes = pairs.filter(|[i, j]| i + j >= lowest).map(|[i, j]| mode(i, j)).collect();
        let powers: Vec<_> = (1..=degree + 1).flat_map(|sum| (0..=sum).map(move |p| [p, sum - p])).collect();
        let exact = powers.iter().filter(|[p, q]| p + q <= degree).count();
        Self { line, modes, powers, exact }
    }

    /// The factors of the nodes of the own cell in the traces at the points of a face, `[point][node]`: u_k = T_k u - sum_ij c_ij a_ij(u), with the
    /// trace T_k of degree N and the coefficients a_ij of the orthonormal Legendre polynomials on the cell, i + j >= max(N - 1, 1).
    ///
    /// The c_ij of both cells together are those which
    ///
    /// - leave no jump of polynomials in X of degree up to N, exactly;
    /// - minimise |jump|^2 / [`SLACK`]^2 + |c - c0|^2 over the polynomials of degree N + 1 (Legendre's, in coordinates in which both cells have the size
    ///   1), sampled at the nodes as a smooth function is; c0 is what [`Line::held`] leaves out.
    ///
    /// Both cells find the same c, to rounding. Where |c| is more than [`MOST`] (N + 1), all of it counts less.
    pub fn traces(&self, own: AtFace, other: AtFace) -> Vec<f64> {
        let (m, count) = (self.line.m, self.modes.len());
        let values = self.polynomials(own, other);
        let conditions = Conditions::new(
            DMatrix::from_fn(values.len(), 2 * count, |row, k| {
                let [own, other] = &values[row];
                if k < count { product(own, &self.modes[k]) } else { -product(other, &self.modes[k - count]) }
            }),
            self.exact,
        );
        let mut out = Vec::with_capacity(m * m * m);
        for point in 0..m {
            let ends = [self.plain(own, point), self.plain(other, point)];
            let usual = DVector::from_vec([self.left_out(own, point), self.left_out(other, point)].concat());
            let jump = |[one, two]: &[Vec<f64>; 2]| product(one, &ends[0]) - product(two, &ends[1]);
            let jumps = DVector::from_iterator(values.len(), values.iter().map(jump));
            let c = conditions.nearest(usual, &jumps);
            let weight = (MOST * m as f64 / c.norm()).min(1.0);
            let mut factors = ends[0].clone();
            for (c, mode) in c.iter().zip(&self.modes) {
                factors.iter_mut().zip(mode).for_each(|(factor, mode)| *factor -= weight * c * mode);
            }
            out.extend(factors);
        }
        out
    }

    /// Those between equal cells, and where the displacement is not smooth: at a boundary and between two laws.
    pub fn of_equal(&self, (_, face, _): AtFace) -> Vec<f64> {
        let all = (0..self.line.m).map(|point| self.line.spread(&self.line.held[face % 2], face, point));
        all.flatten().collect()
    }

    /// T_k: the factors of the nodes in the trace at a point of a face.
    fn plain(&self, (_, face, flip): AtFace, point: usize) -> Vec<f64> {
        self.line.spread(&self.line.ends[face % 2], face, if flip { self.line.m - 1 - point } else { point })
    }

    /// c0: what the traces of equal cells leave out, the part of the highest coefficient on the line through the point.
    fn left_out(&self, side: AtFace, point: usize) -> Vec<f64> {
        let (_, face, flip) = side;
        let at = if flip { self.line.m - 1 - point } else { point };
        let held = self.line.spread(&self.line.held[face % 2], face, at);
        let difference: Vec<f64> = self.plain(side, point).iter().zip(held).map(|(plain, held)| plain - held).collect();
        // sum_a d_a u_a is the mean over the cell of u times the polynomial with the values d_a / w_a at the nodes; c_ij are the coefficients of it.
        let m = self.line.m;
        let weight = |a: usize| self.line.basis.weights[a / m] * self.line.basis.weights[a % m];
        let of = |mode: &Vec<f64>| mode.iter().zip(&difference).enumerate().map(|(a, (x, y))| x * y / weight(a)).sum();
        self.modes.iter().map(of).collect()
    }

    /// The polynomials at the nodes of both cells, `[polynomial][side][node]`. The places are counted from the middle of the face on either side, which are
    /// one place or (at a seam of a periodic mesh) count as one.
    fn polynomials(&self, own: AtFace, other: AtFace) -> Vec<[Vec<f64>; 2]> {
        let middles = [own, other].map(|(cell, face, _)| map::position(cell, on_face(face, 0.5)));
        let place = |side: usize, xi: [f64; 2]| {
            let x = map::position([own, other][side].0, xi);
            [x[0] - middles[side][0], x[1] - middles[side][1]]
        };
        let centres = [place(0, [0.5, 0.5]), place(1, [0.5, 0.5])];
        // The axes: twice from centre to centre, and half of the face.
        let across = [0, 1].map(|i| 2.0 * (centres[1][i] - centres[0][i]));
        let along = place(0, on_face(own.1, 1.0));
        let inverse = map::inverse(&[[across[0], along[0]], [across[1], along[1]]]);
        let at = |side: usize, a: usize| {
            let x = place(side, self.line.basis.node_2d(a));
            let [p, q] = [0, 1].map(|k| inverse[k][0] * x[0] + inverse[k][1] * x[1]);
            [p, q].map(|x| legendre(x).take(self.line.m + 1).map(|(value, _)| value).collect::<Vec<f64>>())
        };
        let nodes = self.line.m * self.line.m;
        let all = [0, 1].map(|side| (0..nodes).map(|a| at(side, a)).collect::<Vec<_>>());
        let of = |[p, q]: &[usize; 2]| [0, 1].map(|side: usize| all[side].iter().map(|[x, y]| x[*p] * y[*q]).collect());
        self.powers.iter().map(of).collect()
    }
}

/// What polynomials ask of the parts c that traces leave out: (jump of the parts) c = jump of the plain traces.
struct Conditions {
    /// By polynomial and part; the first hold exactly.
    all: DMatrix<f64>,
    /// Those of them that say something new, and an orthonormal basis Q of their rows: rows^T = Q R.
    chosen: Vec<usize>,
    basis: DMatrix<f64>,
    triangle: DMatrix<f64>,
    /// The rows that hold nearly, less their part in the basis, and F F^T + slack of these.
    free: DMatrix<f64>,
    squares: Option<Cholesky<f64, Dyn>>,
}

impl Conditions {
    /// The first `exact` of all hold exactly.
    fn new(all: DMatrix<f64>, exact: usize) -> Self {
        // With pivots: on parallelograms some conditions say nothing, and others the same.
        let factored = all.rows(0, exact).transpose().col_piv_qr();
        let (q, r) = (factored.q(), factored.r());
        let mut order = RowDVector::from_fn(exact, |_, row| row);
        factored.p().permute_columns(&mut order);
        let size = |k: usize| r[(k, k)].abs();
        let rank = (0..exact).take_while(|k| size(*k) > RANK * size(0)).count();
        let basis = q.columns(0, rank).into_owned();
        let nearly = all.rows(exact, all.nrows() - exact);
        let free = nearly - (nearly * &basis) * basis.transpose();
        let mut squares = &free * free.transpose();
        let largest = nearly.row_iter().map(|row| row.norm_squared()).fold(0.0, f64::max);
        (0..squares.nrows()).for_each(|k| squares[(k, k)] += SLACK * SLACK * largest);
        let (chosen, triangle) =
            (order.iter().take(rank).copied().collect(), r.view((0, 0), (rank, rank)).into_owned());
        Self { all, chosen, basis, triangle, free, squares: squares.cholesky() }
    }

    /// The parts nearest to c.
    fn nearest(&self, mut c: DVector<f64>, jumps: &DVector<f64>) -> DVector<f64> {
        self.hold(&mut c, jumps);
        let Some(squares) = &self.squares else { return c };
        let (rest, count) = (jumps - &self.all * &c, self.free.nrows());
        c += self.free.tr_mul(&squares.solve(&rest.rows(rest.len() - count, count)));
        // Rounding alone is left.
        self.hold(&mut c, jumps);
        c
    }

    /// The smallest change of c with which the exact conditions hold.
    fn hold(&self, c: &mut DVector<f64>, jumps: &DVector<f64>) {
        let rest = jumps - &self.all * &*c;
        let rest = DVector::from_iterator(self.chosen.len(), self.chosen.iter().map(|row| rest[*row]));
        if let Some(along) = self.triangle.tr_solve_upper_triangular(&rest) {
            *c += &self.basis * along;
        }
    }
}

/// sum_k a_k b_k.
fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The orthonormal Legendre polynomial of degree i on [0, 1].
fn normal(i: usize, x: f64) -> f64 {
    legendre(2.0 * x - 1.0).nth(i).map_or(0.0, |(p, _)| p * ((2 * i + 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two cells left and right of the face from (0, -.5) to (0, .5), whose other corners are moved; the right one begins with another
    /// corner, `turn` steps on.
    fn pair(moved: &[f64], turn: usize) -> [CellMap; 2] {
        let at = |k: usize, x: f64, y: f64| [x + moved[2 * k], y + moved[2 * k + 1]];
        let left = [at(0, -1.0, -0.5), [0.0, -0.5], [0.0, 0.5], at(1, -1.0, 0.5)];
        let right = [[0.0, -0.5], at(2, 1.0, -0.5), at(3, 1.0, 0.5), [0.0, 0.5]];
        let turned = std::array::from_fn(|k| right[(k + turn) % 4]);
        [CellMap { corners: left, bulge: None }, CellMap { corners: turned, bulge: None }]
    }

    /// The face of the right cell at x = 0, and whether its points run downwards, by `turn`.
    fn face_of(turn: usize) -> (usize, bool) {
        [(0, false), (3, false), (1, true), (2, true)][turn]
    }

    /// The jump of X^p Y^q at all points, by the traces that each cell finds for itself.
    fn jumps(line: &Line, [left, right]: &[CellMap; 2], turn: usize, [p, q]: [usize; 2]) -> Vec<f64> {
        let (fit, (face, flip)) = (Fit::new(line), face_of(turn));
        let own = fit.traces((left, 1, false), (right, face, flip));
        // The other cell counts the points of the face from its own end.
        let other = fit.traces((right, face, false), (left, 1, flip));
        let of = |cell: &CellMap, factors: &[f64]| {
            let value = |a: usize| map::position(cell, line.basis.node_2d(a));
            let monomial = |x: [f64; 2]| x[0].powi(p as i32) * x[1].powi(q as i32);
            factors.iter().enumerate().map(|(a, factor)| factor * monomial(value(a))).sum::<f64>()
        };
        let n = line.m * line.m;
        let at = |k: usize| if flip { line.m - 1 - k } else { k };
        (0..line.m).map(|k| of(right, &other[at(k) * n..][..n]) - of(left, &own[k * n..][..n])).collect()
    }

    proptest! {
        #[test]
        fn what_is_held_of_a_polynomial_is_0_up_to_degree_n_and_little_at_degree_n_plus_1(
            degree in 1_usize..=6,
            turn in 0_usize..4,
            moved in prop::collection::vec(-0.25..0.25_f64, 8),
        ) {
            let (line, cells) = (Line::new(degree), pair(&moved, turn));
            for sum in 0..=degree + 1 {
                for p in 0..=sum {
                    let jump = jumps(&line, &cells, turn, [p, sum - p]).into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                    // Rounding up to degree N: 1.3e-12 of 200 pairs. At N + 1 the plain traces jump by .01 to .3; 8e-3 was measured at N = 2 to
                    // 6 (40 000 pairs), and .06 at N = 1, where MOST acts.
                    let bound = if sum <= degree { 1e-10 } else { [0.2, 2e-2][degree.min(2) - 1] };
                    prop_assert!(jump < bound, "N = {degree}, X^{p} Y^{}: {jump:e}", sum - p);
                }
            }
        }
    }

    #[test]
    fn equal_parallelograms_have_the_traces_of_the_line() {
        for degree in 1..=6 {
            let line = Line::new(degree);
            let fit = Fit::new(&line);
            let of = |x: f64| [[x, 0.0], [x + 1.0, 0.1], [x + 1.2, 0.8], [x + 0.2, 0.7]];
            let [left, right] = [of(0.0), of(1.0)].map(|corners| CellMap { corners, bulge: None });
            let found = fit.traces((&left, 1, false), (&right, 0, false));
            let usual = fit.of_equal((&left, 1, false));
            // The right one stands .1 higher, as its lower edge goes on: only the places differ.
            let apart = found.iter().zip(&usual).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-6, "{degree}: {apart:e}");
        }
    }
}
