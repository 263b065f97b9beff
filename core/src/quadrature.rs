//! Gauss-Legendre quadrature on [0, 1], exact for polynomials of degree 2n - 1.

/// Nodes (ascending) and weights of the `n`-point Gauss-Legendre rule on [0, 1].
///
/// Newton's method on P_n from Tricomi's start values; only half of the nodes is computed and mirrored, so
/// that `x[i] + x[n - 1 - i] = 1` and `w[i] = w[n - 1 - i]` hold as well as f64 can. `n = 0` gives an empty rule.
pub fn gauss_legendre(n: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut nodes, mut weights) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n.div_ceil(2) {
        let (x, slope) = root(n, i);
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        nodes[i] = 0.5 * (1.0 - x);
        nodes[n - 1 - i] = 0.5 * (1.0 + x);
        weights[i] = weight;
        weights[n - 1 - i] = weight;
    }
    (nodes, weights)
}

/// The i-th root of P_n from the right, and P_n' there.
fn root(n: usize, i: usize) -> (f64, f64) {
    let middle = 2 * i + 1 == n;
    let nf = n as f64;
    let angle = std::f64::consts::PI * (4 * i + 3) as f64 / (4.0 * nf + 2.0);
    let mut x = if middle { 0.0 } else { angle.cos() * (1.0 - (nf - 1.0) / (8.0 * nf * nf * nf)) };
    // Newton is quadratic from Tricomi's value (error O(n^-4)); 3 steps are enough, 10 are a ceiling.
    for _ in 0..10 {
        let (p, slope) = of_degree(n, x);
        let step = p / slope;
        if middle || step.abs() < 1e-16 {
            break;
        }
        x -= step;
    }
    (x, of_degree(n, x).1)
}

/// P_k and P_k' at x in [-1, 1] for k = 0, 1, .., without end, by the three-term recurrences.
pub fn legendre(x: f64) -> impl Iterator<Item = (f64, f64)> {
    let (mut before, mut now) = ((0.0, 0.0), (1.0, 0.0));
    (0_u32..).map(move |k| {
        let (found, k) = (now, f64::from(k));
        let next = ((2.0 * k + 1.0) * x * now.0 - k * before.0) / (k + 1.0);
        (before, now) = (now, (next, before.1 + (2.0 * k + 1.0) * now.0));
        found
    })
}

/// P_n and P_n' at x.
fn of_degree(n: usize, x: f64) -> (f64, f64) {
    // The list has no end.
    legendre(x).nth(n).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn n_points_integrate_monomials_up_to_degree_2n_minus_1() {
        for n in 1..=20 {
            let (x, w) = gauss_legendre(n);
            for degree in 0..2 * n {
                let sum: f64 = x.iter().zip(&w).map(|(x, w)| w * x.powi(degree as i32)).sum();
                // Weights and powers each carry a few ulp of numbers below 1.
                assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 2e-15, "n {n}, degree {degree}: {sum}");
            }
        }
    }

    #[test]
    fn degree_2n_is_not_exact() {
        let (x, w) = gauss_legendre(3);
        let sum: f64 = x.iter().zip(&w).map(|(x, w)| w * x.powi(6)).sum();
        // The defect of the rule is (n!)^4 / ((2n + 1) ((2n)!)^3) times the 6th derivative: 1 / 2800.
        assert!((1.0 / 7.0 - sum - 1.0 / 2800.0).abs() < 1e-15);
    }

    #[test]
    fn closed_forms_hold_for_one_two_and_three_points() {
        assert_eq!(gauss_legendre(0), (vec![], vec![]));
        assert_eq!(gauss_legendre(1), (vec![0.5], vec![1.0]));
        let (x, w) = gauss_legendre(2);
        assert!((x[1] - 0.5 * (1.0 + 1.0 / 3f64.sqrt())).abs() < 1e-15 && (w[0] - 0.5).abs() < 1e-15);
        let (x, w) = gauss_legendre(3);
        assert!((x[0] - 0.5 * (1.0 - 0.6f64.sqrt())).abs() < 1e-15 && x[1] == 0.5);
        assert!((w[0] - 5.0 / 18.0).abs() < 1e-15 && (w[1] - 4.0 / 9.0).abs() < 1e-15);
    }

    #[test]
    fn nodes_ascend_inside_the_interval_and_are_symmetric() {
        for n in 1..=40 {
            let (x, w) = gauss_legendre(n);
            assert!(x.windows(2).all(|p| p[0] < p[1]) && x[0] > 0.0 && x[n - 1] < 1.0, "n {n}");
            for i in 0..n {
                assert!((x[i] + x[n - 1 - i] - 1.0).abs() <= f64::EPSILON && w[i] == w[n - 1 - i], "n {n}, i {i}");
            }
        }
    }
}
