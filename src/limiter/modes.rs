//! A cell in orthonormal Legendre modes of its parent coordinates.

use super::neighbour::Axes;
use crate::basis::Lagrange;
use crate::operators::MOST_NODES;
use crate::quadrature::legendre;
use crate::state::UNKNOWNS;

/// Numbers of one component: of modes `[i M + j]`, i along xi1, or of nodes.
pub type Component = [f64; MOST_NODES];

/// The modes of F and p of a cell, u(xi) = sum_ij c_ij l_i(xi1) l_j(xi2) with l_i(x) = sqrt(2i+1) P_i(2x-1): c_00 is the mean
/// over the parent cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// M = N + 1.
    pub m: usize,
    /// `[component][i M + j]`.
    pub of: [Component; UNKNOWNS],
}

impl Modes {
    /// All components of one mode.
    pub fn mode(&self, number: usize) -> [f64; UNKNOWNS] {
        std::array::from_fn(|k| self.of[k][number])
    }

    /// Sets all components of one mode.
    pub fn set(&mut self, number: usize, values: [f64; UNKNOWNS]) {
        self.of.iter_mut().zip(values).for_each(|(component, value)| component[number] = value);
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
        for (out, own) in out.of.iter_mut().zip(&self.of) {
            for i in 0..m {
                for j in 0..m {
                    let from = if axes.swapped { j * m + i } else { i * m + j };
                    out[i * m + j] = factors[0][i] * factors[1][j] * own[from];
                }
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

    /// The modes of a component from its values at the nodes; the quadrature of the nodes is exact for them.
    pub fn modes(&self, nodes: impl Iterator<Item = f64>) -> Component {
        let mut values = [0.0; MOST_NODES];
        values.iter_mut().zip(nodes).for_each(|(out, value)| *out = value);
        self.twice(&values, &self.forward)
    }

    /// The values of a component at the nodes.
    pub fn values(&self, modes: &Component) -> Component {
        self.twice(modes, &self.back)
    }

    /// sum_kl x_kl matrix_ki matrix_lj.
    fn twice(&self, x: &Component, matrix: &[f64]) -> Component {
        let (m, mut half, mut out) = (self.m, [0.0; MOST_NODES], [0.0; MOST_NODES]);
        // Rows at a time, so that the inner loop runs over numbers that follow each other.
        for k in 0..m {
            for i in 0..m {
                let factor = matrix[k * m + i];
                let rows = half[i * m..(i + 1) * m].iter_mut().zip(&x[k * m..(k + 1) * m]);
                rows.for_each(|(half, x)| *half += factor * x);
            }
        }
        for i in 0..m {
            for l in 0..m {
                let factor = half[i * m + l];
                let rows = out[i * m..(i + 1) * m].iter_mut().zip(&matrix[l * m..(l + 1) * m]);
                rows.for_each(|(out, matrix)| *out += factor * matrix);
            }
        }
        out
    }
}
