//! The time basis of the predictor (16), (17): Gauss-Legendre nodes of [0, 1] and the matrix of (20).

use super::Lagrange;
use nalgebra::DMatrix;

/// Time nodes tau_s, weights w_s, and At = S^-1 diag(w) with S = phi(1) phi(1)^T - int phi_k' phi_l.
///
/// The local predictor (20), divided by the mass matrix in space, is u_s = U^n + dt sum_k At[s, k] r_k.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeBasis {
    /// Time nodes.
    pub tau: Vec<f64>,
    /// Their weights, which sum to 1.
    pub weights: Vec<f64>,
    /// At, row by row.
    pub integration: Vec<f64>,
}

impl TimeBasis {
    /// The basis of degree N_T; N_T = 0 is explicit Euler: no predictor, At = 0.
    pub fn new(degree: usize) -> Self {
        let basis = Lagrange::new(degree);
        let len = basis.len();
        if degree == 0 {
            return Self { tau: vec![0.0], weights: vec![1.0], integration: vec![0.0] };
        }
        let end = basis.values(1.0);
        let slopes = basis.derivative_matrix();
        let s = DMatrix::from_fn(len, len, |k, l| end[k] * end[l] - basis.weights[l] * slopes[l * len + k]);
        let w = DMatrix::from_fn(len, len, |k, l| if k == l { basis.weights[k] } else { 0.0 });
        // S is regular for every degree (its solution of S x = phi(0) is 1): tested below for those in use.
        let at = s.lu().solve(&w).unwrap_or(w);
        let integration = (0..len).flat_map(|s| (0..len).map(|k| at[(s, k)]).collect::<Vec<_>>()).collect();
        Self { tau: basis.nodes, weights: basis.weights, integration }
    }

    /// N_T + 1.
    pub fn len(&self) -> usize {
        self.tau.len()
    }

    /// Never: there is at least one node.
    pub fn is_empty(&self) -> bool {
        self.tau.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_at_sum_to_the_time_nodes_and_its_weighted_mean_integrates() {
        for degree in 1..=6 {
            let time = TimeBasis::new(degree);
            let len = time.len();
            for s in 0..len {
                let sum: f64 = time.integration[s * len..(s + 1) * len].iter().sum();
                // The solve of a 7 x 7 system of condition below 1e3.
                assert!((sum - time.tau[s]).abs() < 1e-13, "{degree} {s}");
                // u' = t^(N_T - 1) is integrated exactly at every node, as by collocation of that degree.
                let power = degree as i32 - 1;
                let u: f64 = (0..len).map(|k| time.integration[s * len + k] * time.tau[k].powi(power)).sum();
                assert!((u - time.tau[s].powi(power + 1) / (power + 1) as f64).abs() < 1e-13);
            }
        }
    }
}
