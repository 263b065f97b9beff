//! The nodal basis at many points, without allocation.

use crate::basis::Lagrange;

/// Components of a node, padded so that they fill registers: U and the displacement.
pub(super) type Values = [f64; 8];

/// l_k of M nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nodal<const M: usize> {
    nodes: [f64; M],
    /// 1 / prod_(j != k) (x_k - x_j).
    scale: [f64; M],
}

impl<const M: usize> Nodal<M> {
    /// The weights of a basis with M nodes.
    pub fn new(basis: &Lagrange) -> Self {
        let nodes: [f64; M] = std::array::from_fn(|k| basis.nodes[k]);
        let others = |k: usize| (0..M).filter(move |&j| j != k);
        let scale = std::array::from_fn(|k| 1.0 / others(k).map(|j| nodes[k] - nodes[j]).product::<f64>());
        Self { nodes, scale }
    }

    /// l_k(x) for each k.
    #[inline(always)]
    pub fn at(&self, x: f64) -> [f64; M] {
        let mut out = self.scale;
        let mut below = 1.0;
        for (out, node) in out.iter_mut().zip(self.nodes) {
            *out *= below;
            below *= x - node;
        }
        let mut above = 1.0;
        for (out, node) in out.iter_mut().zip(self.nodes).rev() {
            *out *= above;
            above *= x - node;
        }
        out
    }
}

/// The unknowns of a cell, `[component][node]`, as `[node i][node j][component]`, read by `order[i M + j]`.
pub(super) fn gather<const M: usize>(u: &[f64], order: impl Fn(usize) -> usize) -> [[Values; M]; M] {
    let n = M * M;
    let mut out = [[[0.0; 8]; M]; M];
    for (k, component) in u.chunks_exact(n).enumerate() {
        for a in 0..n {
            out[a / M][a % M][k] = component[order(a)];
        }
    }
    out
}

/// The inverse of [`gather`].
pub(super) fn scatter<const M: usize>(values: &[[Values; M]; M], order: impl Fn(usize) -> usize, u: &mut [f64]) {
    let n = M * M;
    for (k, component) in u.chunks_exact_mut(n).enumerate() {
        for a in 0..n {
            component[order(a)] = values[a / M][a % M][k];
        }
    }
}

/// sum_ij x_i y_j U_ij.
#[inline(always)]
pub(super) fn combine<const M: usize>(values: &[[Values; M]; M], x: &[f64; M], y: &[f64; M]) -> Values {
    let mut sum = [0.0; 8];
    for i in 0..M {
        let mut row = [0.0; 8];
        for j in 0..M {
            for k in 0..8 {
                row[k] += y[j] * values[i][j][k];
            }
        }
        for k in 0..8 {
            sum[k] += x[i] * row[k];
        }
    }
    sum
}

/// U_ij += x_i y_j value.
#[inline(always)]
pub(super) fn spread<const M: usize>(value: &Values, x: &[f64; M], y: &[f64; M], sums: &mut [[Values; M]; M]) {
    for i in 0..M {
        let row = value.map(|v| x[i] * v);
        for j in 0..M {
            for k in 0..8 {
                sums[i][j][k] += y[j] * row[k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_basis() {
        let basis = Lagrange::new(3);
        let nodal = Nodal::<4>::new(&basis);
        for x in [0.0, 0.3, 0.71, 1.0] {
            for (a, b) in nodal.at(x).into_iter().zip(basis.values(x)) {
                // Products of three factors in another order.
                assert!((a - b).abs() < 1e-14, "{a} {b}");
            }
        }
    }

    #[test]
    fn gather_and_scatter_are_inverse_in_any_order() {
        let u: Vec<f64> = (0..54).map(f64::from).collect();
        let order = |a: usize| (a * 5) % 9;
        let mut back = vec![0.0; 54];
        scatter::<3>(&gather::<3>(&u, order), order, &mut back);
        assert_eq!(back, u);
    }
}
