//! Characteristic variables of the equations linearised along one direction.

use crate::state::UNKNOWNS;
use crate::step::Law;
use crate::tensor::dot;

/// Waves along N at a state F: with B = N . dP/dF . N, its unit eigenvectors r_k and impedances z_k = sqrt(rho0 B_k), T across N,
///
/// ```text
/// w_k^+- = r_k . p +- z_k r_k . (F N)        r_k . (F T) stays
/// ```
///
/// Variables are (w_1^+, w_1^-, w_2^+, w_2^-, r_1 . F T, r_2 . F T): the same whatever frame x is seen in, but for signs, which a limiter
/// does not see.
#[derive(Debug, Clone, Copy)]
pub struct Waves {
    n: [f64; 2],
    r: [[f64; 2]; 2],
    z: [f64; 2],
}

impl Waves {
    /// Of a law at F along the unit vector N. Where the law is not hyperbolic, with the impedance of its shear modulus.
    pub fn new(law: &Law, f: [f64; 4], n: [f64; 2]) -> Self {
        let [b11, b12, b22] = law.acoustic(f, n);
        // The eigenvector of the larger eigenvalue by the half angle; any where both are equal.
        let angle = 0.5 * (2.0 * b12).atan2(b11 - b22);
        let (sin, cos) = angle.sin_cos();
        let (mean, radius) = (0.5 * (b11 + b22), (0.5 * (b11 - b22)).hypot(b12));
        let least = law.density() * law.shear_modulus();
        let z = [mean + radius, mean - radius].map(|b| {
            let square = law.density() * b;
            if square > 0.0 && square.is_finite() { square.sqrt() } else { least.sqrt() }
        });
        Self { n, r: [[cos, sin], [-sin, cos]], z }
    }

    /// Where F is not limited: with z = 0 all variables but those of F T are momenta.
    pub fn of_momentum(self) -> Self {
        Self { z: [0.0; 2], ..self }
    }

    /// Characteristic variables of (F, p).
    pub fn of(&self, u: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let [n1, n2] = self.n;
        let normal = [u[0] * n1 + u[1] * n2, u[2] * n1 + u[3] * n2];
        let tangential = [u[1] * n1 - u[0] * n2, u[3] * n1 - u[2] * n2];
        let [p, strain, stays] = [[u[4], u[5]], normal, tangential].map(|x| self.r.map(|r| dot(r, x)));
        let [a, b] = [0, 1].map(|k| [p[k] + self.z[k] * strain[k], p[k] - self.z[k] * strain[k]]);
        [a[0], a[1], b[0], b[1], stays[0], stays[1]]
    }

    /// (F, p) of characteristic variables; of those with z = 0, F without meaning.
    pub fn back(&self, w: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let [n1, n2] = self.n;
        let difference = |k: usize| if self.z[k] > 0.0 { 0.5 * (w[2 * k] - w[2 * k + 1]) / self.z[k] } else { 0.0 };
        let sum = |a: f64, b: f64| [0, 1].map(|i| a * self.r[0][i] + b * self.r[1][i]);
        let p = sum(0.5 * (w[0] + w[1]), 0.5 * (w[2] + w[3]));
        let (normal, tangential) = (sum(difference(0), difference(1)), sum(w[4], w[5]));
        let row = |i: usize| [normal[i] * n1 - tangential[i] * n2, normal[i] * n2 + tangential[i] * n1];
        let (one, two) = (row(0), row(1));
        [one[0], one[1], two[0], two[1], p[0], p[1]]
    }
}
