//! Constitutive laws: first Piola-Kirchhoff stress from the deformation gradient, at a point.
//!
//! A new law is one file with a type that implements [`Material`] and one line in [`Law`].

mod j2;
mod linear;
mod neo_hookean;

pub use j2::J2;
pub use linear::LinearElastic;
pub use neo_hookean::NeoHookean;

use crate::lane::Lane;
use crate::tensor;

/// The most internal variables that a law of the registry has.
pub const MOST_INTERNAL: usize = 5;

/// Internal variables of a point; a law has the first of them, none or up to [`MOST_INTERNAL`].
pub type Internal<L> = [L; MOST_INTERNAL];

/// A hyperelastic (or, with internal variables, inelastic) law in plane strain.
///
/// A law with internal variables is integrated from their values at t_n to F. Those at F, which [`Material::stress`] gives,
/// do as well for what else is asked at F.
///
/// Written once for all lanes. J <= 0 gives garbage, not an error: the step tests min J.
///
/// `Copy`: kernels work on a copy of their own, so that the compiler knows its constants to stay as they are.
pub trait Material: Copy {
    /// Names of the internal variables of a point; an elastic law has none, stores none, writes none.
    const INTERNAL: &'static [&'static str];

    /// Their values in virgin material.
    const VIRGIN: &'static [f64] = &[];

    /// Whether stress stiffens or softens what turns: P(R F) = R P(F). Not so for a law of the small strain.
    const GEOMETRIC: bool = true;

    /// rho0, in kg/m^3.
    fn density(&self) -> f64;

    /// mu = rho0 c_s^2 at F = 1, in Pa.
    fn shear_modulus(&self) -> f64;

    /// P = dW/dF, [P11, P12, P21, P22] in Pa; `internal` goes from its values at t_n to those at F.
    fn stress<L: Lane>(&self, f: [L; 4], internal: &mut [L]) -> [L; 4];

    /// P33 = dW/dF33 at F33 = 1, in Pa.
    fn stress33<L: Lane>(&self, f: [L; 4], internal: &[L]) -> L;

    /// Stored energy W, in J/m^3.
    fn energy<L: Lane>(&self, f: [L; 4], internal: &[L]) -> L;

    /// Energy that was dissipated since the material was virgin, in J/m^3. P is the derivative of stored and dissipated
    /// energy together, at fixed internal variables of t_n.
    #[inline(always)]
    fn dissipated<L: Lane>(&self, _: [L; 4], _: &[L]) -> L {
        L::zero()
    }

    /// The history of a point where F is `from`, for a place where F is `to` and the elastic strain is to be the same but for its
    /// volume. (A history belongs to its point: with F of another place it would make elastic strain of the difference.)
    /// Nothing to do for laws without one.
    #[inline(always)]
    fn move_history<L: Lane>(&self, _from: [L; 4], _to: [L; 4], _internal: &mut [L]) {}

    /// Acoustic tensor B_ij = N_a (dP_ia/dF_jb) N_b, [B11, B12, B22] in Pa, elastic. Faces have no internal variables: a law
    /// with memory takes those of virgin material that went to F in one step.
    fn acoustic<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 3];

    /// Eigenvalues (larger, smaller) of B(N), rho0 c_p^2 and rho0 c_s^2, in Pa.
    #[inline(always)]
    fn moduli<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 2] {
        let [b11, b12, b22] = self.acoustic(f, n);
        tensor::eigenvalues(b11, b12, b22)
    }

    /// Current speeds (c_p, c_s) = sqrt(eig B(N) / rho0) in m/s; NaN where hyperbolicity is lost.
    #[inline(always)]
    fn speeds<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 2] {
        let inverse = L::splat(1.0 / self.density());
        let [larger, smaller] = self.moduli(f, n);
        [(larger * inverse).sqrt(), (smaller * inverse).sqrt()]
    }

    /// c_p alone, for fluxes that need no c_s; the bits of [`Material::speeds`].
    #[inline(always)]
    fn pressure_speed<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> L {
        (self.moduli(f, n)[0] * L::splat(1.0 / self.density())).sqrt()
    }

    /// (c_p^2, c_s^2) in m^2/s^2 along the smallest principal stretch, where c_p is the largest of all directions
    /// (isotropic laws); negative where hyperbolicity is lost. With internal variables elastic, and at least as large.
    #[inline(always)]
    fn largest_squares<L: Lane>(&self, f: [L; 4], _: &[L]) -> [L; 2] {
        let [c11, c12, c22] = tensor::right_cauchy_green(f);
        let [b11, b12, b22] = self.acoustic(f, tensor::smaller_eigenvector(c11, c12, c22));
        let inverse = L::splat(1.0 / self.density());
        let [larger, smaller] = tensor::eigenvalues(b11, b12, b22);
        [larger * inverse, smaller * inverse]
    }
}

/// Cauchy stress [s11, s12, s22, s33] = (P F^T / J, P33 / J), in Pa.
#[inline(always)]
pub fn cauchy<L: Lane>(f: [L; 4], p: [L; 4], p33: L) -> [L; 4] {
    let inverse = L::splat(1.0) / tensor::det(f);
    let s = tensor::times_transposed(p, f);
    [s[0] * inverse, s[1] * inverse, s[3] * inverse, p33 * inverse]
}

/// The registry of laws: chosen per block of cells by one `match`.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// Compressible neo-Hookean, (4)-(9).
    NeoHookean(NeoHookean),
    /// Linear elastic, small strain.
    Linear(LinearElastic),
    /// J2 plasticity with linear isotropic hardening.
    J2(J2),
}

/// Runs `$body` with `$law` bound to the concrete law: one `match` a block, never per point.
#[macro_export]
macro_rules! with_law {
    ($choice:expr, $law:ident => $body:expr) => {
        match $choice {
            $crate::material::Law::NeoHookean($law) => $body,
            $crate::material::Law::Linear($law) => $body,
            $crate::material::Law::J2($law) => $body,
        }
    };
}

impl Law {
    /// rho0, in kg/m^3.
    pub fn density(&self) -> f64 {
        with_law!(self, law => law.density())
    }

    /// mu, in Pa, see [`Material::shear_modulus`].
    pub fn shear_modulus(&self) -> f64 {
        with_law!(self, law => law.shear_modulus())
    }

    /// What the law says at one point, integrated from `internal` to F.
    pub fn response(&self, f: [f64; 4], internal: &Internal<f64>) -> Response {
        with_law!(self, law => respond(law, f, internal))
    }

    /// Stress at one point of virgin material, see [`Material::stress`].
    pub fn stress(&self, f: [f64; 4]) -> [f64; 4] {
        self.response(f, &self.virgin()).piola
    }

    /// Out-of-plane stress at one point of virgin material, see [`Material::stress33`].
    pub fn stress33(&self, f: [f64; 4]) -> f64 {
        self.response(f, &self.virgin()).piola33
    }

    /// Stored energy at one point of virgin material, see [`Material::energy`].
    pub fn energy(&self, f: [f64; 4]) -> f64 {
        self.response(f, &self.virgin()).energy
    }

    /// Speeds at one point, see [`Material::speeds`].
    pub fn speeds(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 2] {
        with_law!(self, law => law.speeds(f, n))
    }

    /// c_p at one point, see [`Material::pressure_speed`].
    pub fn pressure_speed(&self, f: [f64; 4], n: [f64; 2]) -> f64 {
        with_law!(self, law => law.pressure_speed(f, n))
    }

    /// (c_p, c_s) along the smallest principal stretch, see [`Material::largest_squares`]; NaN where hyperbolicity is lost.
    pub fn largest_speeds(&self, f: [f64; 4], internal: &Internal<f64>) -> [f64; 2] {
        with_law!(self, law => law.largest_squares(f, internal)).map(f64::sqrt)
    }

    /// The history of a point for another place, see [`Material::move_history`].
    pub fn move_history(&self, from: [f64; 4], to: [f64; 4], internal: &mut [f64]) {
        with_law!(self, law => law.move_history(from, to, internal));
    }

    /// Names of the internal variables.
    pub fn internal(&self) -> &'static [&'static str] {
        fn names<M: Material>(_: &M) -> &'static [&'static str] {
            M::INTERNAL
        }
        with_law!(self, law => names(law))
    }

    /// Whether P(R F) = R P(F) for every rotation R, see [`Material::GEOMETRIC`].
    pub fn is_objective(&self) -> bool {
        fn objective<M: Material>(_: &M) -> bool {
            M::GEOMETRIC
        }
        with_law!(self, law => objective(law))
    }

    /// Internal variables of virgin material.
    pub fn virgin(&self) -> Internal<f64> {
        with_law!(self, law => virgin(law))
    }
}

/// Internal variables of virgin material.
#[inline(always)]
pub fn virgin<L: Lane, M: Material>(_: &M) -> Internal<L> {
    let mut out = [L::zero(); MOST_INTERNAL];
    for (out, value) in out.iter_mut().zip(M::VIRGIN) {
        *out = L::splat(*value);
    }
    out
}

/// What a law says at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// P, [P11, P12, P21, P22] in Pa.
    pub piola: [f64; 4],
    /// P33, Pa.
    pub piola33: f64,
    /// Stored energy, J/m^3.
    pub energy: f64,
    /// Dissipated energy, J/m^3.
    pub dissipated: f64,
    /// Internal variables at F.
    pub internal: Internal<f64>,
}

fn respond<M: Material>(law: &M, f: [f64; 4], from: &Internal<f64>) -> Response {
    let (mut internal, known) = (*from, &from[..M::INTERNAL.len()]);
    let piola = law.stress(f, &mut internal[..M::INTERNAL.len()]);
    let (piola33, energy, dissipated) = (law.stress33(f, known), law.energy(f, known), law.dissipated(f, known));
    Response { piola, piola33, energy, dissipated, internal }
}

#[cfg(test)]
mod suite {
    //! One suite, run over every law: a new law gets all tests by one line.
    use super::*;
    use proptest::prelude::*;

    fn laws() -> Vec<Law> {
        vec![
            Law::NeoHookean(NeoHookean::new(2e11, 0.3, 7800.0)),
            Law::NeoHookean(NeoHookean::new(1.0, 0.45, 1.0)),
            Law::Linear(LinearElastic::new(2e11, 0.3, 7800.0)),
            // Elastic everywhere; tests of its own in `j2`.
            Law::J2(J2::new(2e11, 0.3, 7800.0, 1e30, 0.0)),
            Law::J2(J2::new(1.0, 0.45, 1.0, 1e30, 1.0)),
        ]
    }

    /// F = R(angle) diag(l1, l2) R(other)^T: J > 0, stretches .5 to 1.6.
    fn deformation() -> impl Strategy<Value = [f64; 4]> {
        (0.5..1.6f64, 0.5..1.6f64, 0.0..6.3f64, 0.0..6.3f64).prop_map(|(l1, l2, a, b)| {
            let (r, q) = (rotation(a), rotation(b));
            tensor::times_transposed([r[0] * l1, r[1] * l2, r[2] * l1, r[3] * l2], q)
        })
    }

    fn rotation(angle: f64) -> [f64; 4] {
        [angle.cos(), -angle.sin(), angle.sin(), angle.cos()]
    }

    /// A B = A (B^T)^T.
    fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        tensor::times_transposed(a, [b[0], b[2], b[1], b[3]])
    }

    fn scale(law: &Law) -> f64 {
        let c = law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
        law.density() * c * c
    }

    proptest! {
        #[test]
        fn stress_is_the_derivative_of_the_energy(f in deformation()) {
            for law in laws() {
                let p = law.stress(f);
                for k in 0..4 {
                    let h = 1e-6;
                    let (mut plus, mut minus) = (f, f);
                    plus[k] += h;
                    minus[k] -= h;
                    let difference = (law.energy(plus) - law.energy(minus)) / (2.0 * h);
                    // Central differences: h^2 times third derivatives (some 1e2) plus rounding 1e-16 / h.
                    prop_assert!((difference - p[k]).abs() < 1e-8 * scale(&law), "{k}: {difference:e} {:e}", p[k]);
                }
            }
        }

        #[test]
        fn stress_is_objective(f in deformation(), angle in 0.0..6.3f64) {
            // The small strain is not invariant under rotations: a linear law in F cannot be objective.
            for law in laws().into_iter().filter(|law| !matches!(law, Law::Linear(_))) {
                let r = rotation(angle);
                let (rotated, expected) = (law.stress(product(r, f)), product(r, law.stress(f)));
                for k in 0..4 {
                    // Rounding of a product chain of stretches down to .5: 1e-14 of the modulus.
                    prop_assert!((rotated[k] - expected[k]).abs() < 1e-13 * scale(&law));
                }
                prop_assert!((law.energy(product(r, f)) - law.energy(f)).abs() < 1e-13 * scale(&law));
            }
        }

        #[test]
        fn acoustic_tensor_is_the_derivative_of_the_traction(f in deformation(), angle in 0.0..6.3f64) {
            for law in laws() {
                let n = [angle.cos(), angle.sin()];
                let b = with_law!(&law, m => m.acoustic(f, n));
                let h = 1e-6;
                for j in 0..2 {
                    let traction = |sign: f64| {
                        let mut g = f;
                        g[2 * j] += sign * h * n[0];
                        g[2 * j + 1] += sign * h * n[1];
                        tensor::times(law.stress(g), n)
                    };
                    let (plus, minus) = (traction(1.0), traction(-1.0));
                    for i in 0..2 {
                        // As for the stress: measured 5e-11 by the design's prototype, with h^2 of larger moduli here.
                        prop_assert!(((plus[i] - minus[i]) / (2.0 * h) - b[i + j]).abs() < 1e-7 * scale(&law));
                    }
                }
            }
        }

        #[test]
        fn fastest_speeds_are_those_along_the_smallest_stretch(f in deformation(), angle in 0.0..6.3f64) {
            for law in laws() {
                let [c11, c12, c22] = tensor::right_cauchy_green(f);
                let along = law.speeds(f, tensor::smaller_eigenvector(c11, c12, c22));
                for (closed, along) in law.largest_speeds(f, &law.virgin()).iter().zip(along) {
                    // The eigenvector is exact to 1e-8, which is 1e-16 in c^2; c_s^2 there is a difference of numbers that
                    // are up to 1e3 times larger, at 1e-16 each.
                    prop_assert!((closed / along - 1.0).abs() < 1e-12, "{closed} {along}");
                }
                let n = [angle.cos(), angle.sin()];
                prop_assert_eq!(law.pressure_speed(f, n), law.speeds(f, n)[0]);
            }
        }

        #[test]
        fn moduli_are_the_eigenvalues_of_the_acoustic_tensor(f in deformation(), angle in 0.0..6.3f64) {
            for law in laws() {
                let n = [angle.cos(), angle.sin()];
                let (closed, [b11, b12, b22]) = with_law!(&law, m => (m.moduli(f, n), m.acoustic(f, n)));
                let eigenvalues = tensor::eigenvalues(b11, b12, b22);
                let (size, gap) = (b11 + b22, eigenvalues[0] - eigenvalues[1]);
                // Both in some 30 operations on numbers of the size of the larger one. Half of their difference is the root of a
                // difference of squares, whose rounding it divides: near to each other they are known to the root of rounding.
                let allowed = (1e-14 * size * (1.0 + size / gap.max(f64::MIN_POSITIVE))).min(1e-7 * size);
                for (closed, expected) in closed.iter().zip(eigenvalues) {
                    prop_assert!((closed - expected).abs() < allowed, "{closed} {expected}");
                }
            }
        }

        #[test]
        fn largest_speed_bounds_the_speed_in_every_direction(f in deformation(), angle in 0.0..6.3f64) {
            for law in laws() {
                let largest = law.largest_speeds(f, &law.virgin())[0];
                let c = law.speeds(f, [angle.cos(), angle.sin()])[0];
                prop_assert!(c <= largest * (1.0 + 1e-12), "{c} {largest}");
            }
        }
    }

    #[test]
    fn the_reference_state_is_stress_free() {
        for law in laws() {
            let f = [1.0, 0.0, 0.0, 1.0];
            assert!(law.stress(f).iter().all(|p| *p == 0.0), "{:?}", law.stress(f));
            assert_eq!(law.stress33(f), 0.0);
            assert_eq!(law.energy(f), 0.0);
        }
    }
}
