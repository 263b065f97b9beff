//! Constitutive laws: first Piola-Kirchhoff stress from the deformation gradient, at a point.
//!
//! A new law is one file with a type that implements [`Material`], and its entry in the registry of scenes.

mod history;
mod j2;
mod linear;
mod neo_hookean;
mod point;
mod st_venant_kirchhoff;

pub(crate) use history::is_declared_whole;
pub use history::{Numbers, Past, Rank, Variable, count, virgin};
pub use j2::J2;
pub use linear::LinearElastic;
pub use neo_hookean::NeoHookean;
pub use point::{PointLaw, Response};
pub use st_venant_kirchhoff::StVenantKirchhoff;

use crate::lane::Lane;
use crate::tensor;

/// A hyperelastic (or, with a history, inelastic) law in plane strain.
///
/// A law with a history is integrated from its values at t_n to F at t_n + dt ([`Past`]). Those at F, which
/// [`Material::stress`] gives, do as well for what else is asked at F.
///
/// Written once for all lanes. J <= 0 gives garbage, not an error: the step tests min J.
///
/// `Copy`: kernels work on a copy of their own, so that the compiler knows its constants to stay as they are.
pub trait Material: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// The history of a point, variable by variable. An elastic law has none, stores none, writes none.
    const HISTORY: &'static [Variable] = &[];

    /// The numbers of [`Material::HISTORY`] behind each other: `[L; 0]` for an elastic law.
    type History<L: Lane>: Numbers<L>;

    /// Whether the law is objective, P(R F) = R P(F): stress then stiffens or softens what turns. Not so for a law of the small
    /// strain.
    const OBJECTIVE: bool = true;

    /// rho0, in kg/m^3.
    fn density(&self) -> f64;

    /// mu = rho0 c_s^2 at F = 1, in Pa.
    fn shear_modulus(&self) -> f64;

    /// P = dW/dF, [P11, P12, P21, P22] in Pa; the history goes from its values at t_n to those at F.
    fn stress<L: Lane>(&self, f: [L; 4], past: &mut Past<Self::History<L>>) -> [L; 4];

    /// P33 = dW/dF33 at F33 = 1, in Pa.
    fn stress33<L: Lane>(&self, f: [L; 4], past: &Past<Self::History<L>>) -> L;

    /// Stored energy W, in J/m^3.
    fn energy<L: Lane>(&self, f: [L; 4], past: &Past<Self::History<L>>) -> L;

    /// Energy that was dissipated since the material was virgin, in J/m^3. Where it does not depend on the rate, P is the
    /// derivative of stored and dissipated energy together, at fixed history of t_n.
    #[inline(always)]
    fn dissipated<L: Lane>(&self, _: [L; 4], _: &Past<Self::History<L>>) -> L {
        L::zero()
    }

    /// The history of a point where F is `from`, for a place where F is `to` and the elastic strain is to be the same but for its
    /// volume. (A history belongs to its point: with F of another place it would make elastic strain of the difference.)
    /// Nothing to do for laws without one.
    #[inline(always)]
    fn move_history<L: Lane>(&self, _from: [L; 4], _to: [L; 4], _history: &mut Self::History<L>) {}

    /// Acoustic tensor B_ij = N_a (dP_ia/dF_jb) N_b, [B11, B12, B22] in Pa, elastic. Faces have no history: a law
    /// with memory takes that of virgin material that went to F in one step.
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
    /// (isotropic laws); negative where hyperbolicity is lost. With a history elastic, and at least as large.
    #[inline(always)]
    fn largest_squares<L: Lane>(&self, f: [L; 4], _: &Self::History<L>) -> [L; 2] {
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

#[cfg(test)]
mod suite;
