//! A cell in orthonormal Legendre modes of its parent coordinates.

use super::neighbour::Axes;
use crate::basis::Lagrange;
use crate::lane::F8;
use crate::operators::{MOST_NODES, with_nodes};
use crate::quadrature::legendre;
use crate::state::UNKNOWNS;

/// F and p of each mode `[i M + j]`, i along xi1, or of each node: `[place][component]`. The components of a place follow each other,
/// so that one instruction of the processor takes several of them.
pub type Places = [[f64; UNKNOWNS]; MOST_NODES];

/// The modes of F and p of a cell, u(xi) = sum_ij c_ij l_i(xi1) l_j(xi2) with l_i(x) = sqrt(2i+1) P_i(2x-1): c_00 is the mean
/// over the parent cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// M = N + 1.
    pub m: usize,
    /// `[i M + j][component]`.
    pub of: Places,
}

impl Modes {
    /// All components of one mode.
    pub fn mode(&self, number: usize) -> [f64; UNKNOWNS] {
        self.of[number]
    }

    /// Sets all components of one mode.
    pub fn set(&mut self, number: usize, values: [f64; UNKNOWNS]) {
        self.of[number] = values;
    }

    /// The number of the mode of order `along` in the direction of an axis and `across` in the other.
    pub fn number(&self, axis: usize, along: usize, across: usize) -> usize {
        if axis == 0 { along * self.m + across } else { across * self.m + along }
    }

    /// Seen from a cell with other axes, with mode (i, j) times `scale`_1^i `scale`_2^j.
    pub fn seen(&self, axes: Axes, scale: [f64; 2]) -> Self {
        let (m, mut out) = (self.m, self.clone());
        // The sign and the scale of each order along both axes.
        let mut factors = [[1.0; 7]; 2];
        for (axis, factors) in factors.iter_mut().enumerate() {
            let factor = if axes.reversed[axis] { -scale[axis] } else { scale[axis] };
            (1..m).for_each(|i| factors[i] = factor * factors[i - 1]);
        }
        for i in 0..m {
            for j in 0..m {
                let from = if axes.swapped { j * m + i } else { i * m + j };
                let factor = factors[0][i] * factors[1][j];
                out.of[i * m + j] = self.of[from].map(|own| factor * own);
            }
        }
        out
    }
}

/// From nodes to modes and back.
#[derive(Debug, Clone)]
pub struct Legendre {
    m: usize,
    /// w_a l_i(x_a): `[a][i]`.
    forward: Vec<f64>,
    /// l_i(x_a): `[i][a]`.
    back: Vec<f64>,
}

impl Legendre {
    /// Of degree N.
    pub fn new(degree: usize) -> Self {
        let basis = Lagrange::new(degree);
        let m = basis.len();
        let (mut forward, mut back) = (vec![0.0; m * m], vec![0.0; m * m]);
        for (a, x) in basis.nodes.iter().enumerate() {
            for (i, (p, _)) in legendre(2.0 * x - 1.0).take(m).enumerate() {
                let value = ((2 * i + 1) as f64).sqrt() * p;
                (back[i * m + a], forward[a * m + i]) = (value, basis.weights[a] * value);
            }
        }
        Self { m, forward, back }
    }

    /// M = N + 1.
    pub fn m(&self) -> usize {
        self.m
    }

    /// M^2.
    pub fn nodes(&self) -> usize {
        self.m * self.m
    }

    /// Modes from the values at the nodes; the quadrature of the nodes is exact for them.
    pub fn modes(&self, nodes: &Places) -> Places {
        self.twice(nodes, &self.forward)
    }

    /// The values at the nodes.
    pub fn values(&self, modes: &Places) -> Places {
        self.twice(modes, &self.back)
    }

    fn twice(&self, x: &Places, matrix: &[f64]) -> Places {
        with_nodes!(self.m, M => twice::<M>(x, matrix))
    }
}

/// sum_kl x_kl matrix_ki matrix_lj.
fn twice<const M: usize>(x: &Places, matrix: &[f64]) -> Places {
    let (mut half, mut out) = ([[[0.0; UNKNOWNS]; M]; M], [[0.0; UNKNOWNS]; MOST_NODES]);
    let add = |sum: &mut [f64; UNKNOWNS], factor: f64, x: &[f64; UNKNOWNS]| {
        for (sum, x) in sum.iter_mut().zip(x) {
            *sum += factor * x;
        }
    };
    let (rows, matrix) = (&x.as_chunks::<M>().0[..M], &matrix.as_chunks::<M>().0[..M]);
    for (x, factors) in rows.iter().zip(matrix) {
        for (half, factor) in half.iter_mut().zip(factors) {
            (0..M).for_each(|l| add(&mut half[l], *factor, &x[l]));
        }
    }
    for (out, half) in out.as_chunks_mut::<M>().0.iter_mut().zip(&half) {
        for (half, factors) in half.iter().zip(matrix) {
            (0..M).for_each(|j| add(&mut out[j], factors[j], half));
        }
    }
    out
}

/// F and p of a lane at the nodes of its cell, from `[component][node]`.
pub(super) fn of_lane(u: &[F8], n: usize, lane: usize) -> Places {
    let mut out = [[0.0; UNKNOWNS]; MOST_NODES];
    for (k, values) in u.chunks_exact(n).take(UNKNOWNS).enumerate() {
        out.iter_mut().zip(values).for_each(|(out, value)| out[k] = value.0[lane]);
    }
    out
}
