//! Lagrange polynomials on the Gauss-Legendre points of [0, 1]: in space Phi_b is their product, in time phi_k.

use crate::quadrature::gauss_legendre;

/// The 1D nodal basis of degree N; its nodes are the quadrature too, so that mass matrices are diagonal.
#[derive(Debug, Clone, PartialEq)]
pub struct Lagrange {
    /// Gauss-Legendre points, ascending.
    pub nodes: Vec<f64>,
    /// Their weights, which sum to 1.
    pub weights: Vec<f64>,
}

impl Lagrange {
    /// The basis of degree N on N + 1 nodes.
    pub fn new(degree: usize) -> Self {
        let (nodes, weights) = gauss_legendre(degree + 1);
        Self { nodes, weights }
    }

    /// N + 1.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Never: a basis has at least one function.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// l_k(x) for each k; exactly 0 or 1 at the nodes.
    pub fn values(&self, x: f64) -> Vec<f64> {
        let factor = |k: usize, j: usize| (x - self.nodes[j]) / (self.nodes[k] - self.nodes[j]);
        (0..self.len()).map(|k| (0..self.len()).filter(|&j| j != k).map(|j| factor(k, j)).product()).collect()
    }

    /// l_k'(x) for each k.
    pub fn derivatives(&self, x: f64) -> Vec<f64> {
        let n = &self.nodes;
        let others = |k: usize| (0..n.len()).filter(move |&j| j != k);
        let without =
            |k: usize, i: usize| -> f64 { others(k).filter(|&j| j != i).map(|j| (x - n[j]) / (n[k] - n[j])).product() };
        (0..n.len()).map(|k| others(k).map(|i| without(k, i) / (n[k] - n[i])).sum()).collect()
    }

    /// `D[i][k]` = l_k'(x_i), row by row.
    pub fn derivative_matrix(&self) -> Vec<f64> {
        self.nodes.iter().flat_map(|&x| self.derivatives(x)).collect()
    }

    /// Phi_a(xi) of the tensor product, a = i M + j with i along xi1.
    pub fn values_2d(&self, xi: [f64; 2]) -> Vec<f64> {
        outer(&self.values(xi[0]), &self.values(xi[1]))
    }

    /// Parent coordinates of node a = i M + j.
    pub fn node_2d(&self, a: usize) -> [f64; 2] {
        [self.nodes[a / self.len()], self.nodes[a % self.len()]]
    }

    /// Weight of node a = i M + j.
    pub fn weight_2d(&self, a: usize) -> f64 {
        self.weights[a / self.len()] * self.weights[a % self.len()]
    }
}

fn outer(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().flat_map(|x| b.iter().map(move |y| x * y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reproduces_polynomials_of_its_degree_and_their_slopes() {
        for degree in 0..=6 {
            let basis = Lagrange::new(degree);
            for power in 0..=degree {
                for x in [0.0_f64, 0.17, 0.5, 1.0] {
                    let sum = |v: Vec<f64>| -> f64 {
                        v.iter().zip(&basis.nodes).map(|(l, n)| l * n.powi(power as i32)).sum()
                    };
                    let slope = if power == 0 { 0.0 } else { power as f64 * f64::powi(x, power as i32 - 1) };
                    // The Lebesgue constant of 7 Gauss points at the ends is about 6, their slopes' about 60.
                    assert!((sum(basis.values(x)) - x.powi(power as i32)).abs() < 2e-14);
                    assert!((sum(basis.derivatives(x)) - slope).abs() < 3e-13, "{degree} {power} {x}");
                }
            }
        }
    }

    #[test]
    fn is_the_identity_at_its_nodes() {
        let basis = Lagrange::new(3);
        for (i, &x) in basis.nodes.iter().enumerate() {
            for (k, value) in basis.values(x).into_iter().enumerate() {
                assert_eq!(value, if i == k { 1.0 } else { 0.0 });
            }
        }
    }
}
