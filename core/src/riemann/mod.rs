//! Two-sided interface fluxes (3): Flux*.N of dU/dt + d Flux_a / dX_a = 0 at a point of a face.
//!
//! A new flux is one file with a type that implements [`Riemann`] and its entry in the registry of scenes.

mod acoustic;
pub mod creep;
mod dual;
mod interface;
mod rusanov;

pub use acoustic::{Acoustic, AcousticCurl};
pub use dual::Dual;
pub use interface::{interface, summed_impedance};
pub use rusanov::Rusanov;

use crate::lane::Lane;
use crate::tensor;

/// What a cell shows at a point of its face.
#[derive(Debug, Clone, Copy)]
pub struct Trace<L> {
    /// Deformation gradient.
    pub f: [L; 4],
    /// Velocity, m/s.
    pub v: [L; 2],
    /// Traction t = P N, Pa, with the N of the side from which the face is looked at.
    pub t: [L; 2],
    /// Current speeds c_p, c_s of the acoustic tensor B(N), m/s.
    pub c: [L; 2],
}

/// What both sides of a face are made of, and what is known of the scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Medium<L> {
    /// rho0, kg/m^3.
    pub density: L,
    /// 1/(rho0 c_s) of the law at F = 1, m^2 s/kg.
    pub shear_admittance: L,
    /// theta, the weight of the jump of traction in v* where a flux has one ([`Dual`]).
    pub share: L,
    /// How fast the face turns: the length of the face times the rate at which v changes along it, m/s. 0 where a flux does not
    /// ask for it ([`Looks::Displacement`]).
    pub turn: L,
    /// Whether waves go along the axes of the body as it is: those of a law of the small strain go along those of the initial
    /// configuration, however the body turns.
    pub is_objective: bool,
}

/// theta by degree, measured. The one-step scheme at .9 of its step limit grows below .72, .45, .35 (N = 1, 2, 3). Less of it
/// keeps more of the work done on a body with corners (bracket of 260 cells, S2: work 4.6, 6 and 8 % above finite elements with
/// .5, .75 and 1); odd degrees lose accuracy in smooth flow by it (manufactured problem, N = 3: 1.6e-5, 2.0e-5, 2.9e-5 with 1,
/// .75, .5), even ones do not; a J2 bar at N = 4 makes energy with .5.
const SHARE: [f64; 7] = [1.0, 1.0, 0.7, 1.0, 0.75, 1.0, 0.75];

/// theta at least where a mesh has long cells ([`crate::operators::Geometry::has_long_cells`]). With .7 (N = 2) the step grew on
/// cells of 1 : 50 and more (radius - 1 of 3e-4 at 1 : 50, up to 9.7e-3 at 1 : 600), and a strip of such cells made 11 % of its energy; with .72 it
/// still grew (up to 5.2e-3, at nu = 0 to .49).
const LONG: f64 = 0.75;

impl Medium<f64> {
    /// That of a law with this rho0 (kg/m^3) and mu (Pa) in a scheme of degree N.
    pub fn new(density: f64, shear_modulus: f64, degree: usize) -> Self {
        let share = SHARE[degree.min(SHARE.len() - 1)];
        let shear_admittance = 1.0 / (density * shear_modulus).sqrt();
        Self { density, shear_admittance, share, turn: 0.0, is_objective: true }
    }

    /// That in a mesh with long cells, or without.
    #[must_use]
    pub fn in_long_cells(self, has_long_cells: bool) -> Self {
        Self { share: if has_long_cells { self.share.max(LONG) } else { self.share }, ..self }
    }

    /// That of a law which sees how the body turns, or not.
    #[must_use]
    pub fn objective(self, is_objective: bool) -> Self {
        Self { is_objective, ..self }
    }

    /// In all lanes.
    #[inline(always)]
    pub fn splat<L: Lane>(&self) -> Medium<L> {
        Medium {
            density: L::splat(self.density),
            shear_admittance: L::splat(self.shear_admittance),
            share: L::splat(self.share),
            turn: L::splat(self.turn),
            is_objective: self.is_objective,
        }
    }
}

/// What a flux looks at beside F, v, t and c_p. Traces hold nothing that it does not look at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Looks {
    /// At nothing.
    Nothing,
    /// At c_s; where a flux does not, c_s is given as 0.
    Shear,
    /// At the displacement, whose jump it holds, and at how fast the face turns.
    Displacement,
}

/// An interface flux. The normal N is the unit outward normal of '-' in the initial configuration.
pub trait Riemann: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// What it looks at.
    const LOOKS: Looks;

    /// Flux*.N in the order of U: [F11, F12, F21, F22, p1, p2].
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6];

    /// Y of v* = mean v + Y `[t]`, m^2 s/kg, where the creep of its faces has a spring ([`creep`]): a flux that looks at the displacement.
    #[inline(always)]
    fn admittance<L: Lane>(&self, _minus: &Trace<L>, _plus: &Trace<L>, _medium: &Medium<L>) -> L {
        L::zero()
    }

    /// [`Riemann::lifted`] and twice [`Riemann::admittance`], for a flux that has the second on its way to the first.
    #[inline(always)]
    fn lifted_and_admittance<L: Lane>(
        &self,
        minus: &Trace<L>,
        plus: &Trace<L>,
        n: [L; 2],
        medium: &Medium<L>,
        scale: L,
    ) -> ([L; 6], L) {
        (self.lifted(minus, plus, n, medium, scale), L::splat(2.0) * self.admittance(minus, plus, medium))
    }

    /// scale (Flux*.N - own flux of the F rows), the own flux being -v^- (x) N: what is lifted (14) where the rows of F
    /// stand in strong form. Without a jump it is 0 there, exactly.
    #[inline(always)]
    fn lifted<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>, scale: L) -> [L; 6] {
        let mut out = self.flux(minus, plus, n, medium);
        for i in 0..2 {
            for k in 0..2 {
                out[2 * i + k] = minus.v[i].mul_add(n[k], out[2 * i + k]);
            }
        }
        for out in &mut out {
            *out = *out * scale;
        }
        out
    }
}

/// Interior penalty of displacement: t* gets K `[u]`, K = [`HOLD`] / l / (1/(rho0 c_p^2)^- + 1/(rho0 c_p^2)^+) with the length l of the
/// face; here -l K `[u]`, what is lifted.
///
/// The jump of v alone is held by a force that its rate makes, so that under a load that stays cells part for good. This
/// force is that of a spring: with K/2 `[u]`^2 in the energy of the face its power cancels, for every law, since du/dt = v; the
/// energy law of a flux stands as it was. Source: the symmetric interior penalty method (Arnold, SIAM J. Numer. Anal. 19, 1982).
/// Which traces of u are meant: [`crate::operators::Line::held`]. The `moduli` rho0 c_p^2 are those of both sides over `unit`, Pa.
#[inline(always)]
pub fn hold<L: Lane>(gap: [L; 2], moduli: [L; 2], unit: f64) -> [L; 2] {
    let stiffness = L::splat(-HOLD * unit) * (moduli[0] * moduli[1]) / (moduli[0] + moduli[1]);
    [stiffness * gap[0], stiffness * gap[1]]
}

/// Weight of the penalty. Bracket of 260 cells, S2 (finite elements: work 25.87 to 26.34 J/m, kinetic 7.14 to 7.20), without: 27.56,
/// 6.40, jumps of 2.6e-5 m; with 1: 27.00, 6.74, 2.4e-6; with 3: 26.84, 6.82, 1.7e-6; with 10: 26.70, 6.90, 6e-7. It does not narrow
/// the step limit: its frequency, 1.7 (N + 1) c/h, is a tenth of the fastest of the scheme.
pub const HOLD: f64 = 3.0;

/// The flux of a star state: Flux*_F = -v* (x) N, Flux*_p = -t*.
#[inline(always)]
pub fn star<L: Lane>(v: [L; 2], t: [L; 2], n: [L; 2]) -> [L; 6] {
    [-(v[0] * n[0]), -(v[0] * n[1]), -(v[1] * n[0]), -(v[1] * n[1]), -t[0], -t[1]]
}

/// The tangent T = (-N2, N1).
#[inline(always)]
pub fn tangent<L: Lane>(n: [L; 2]) -> [L; 2] {
    [-n[1], n[0]]
}

/// Adds a (x) T to the rows of F.
#[inline(always)]
pub fn add_tangential<L: Lane>(flux: &mut [L; 6], a: [L; 2], n: [L; 2]) {
    let t = tangent(n);
    for i in 0..2 {
        for k in 0..2 {
            flux[2 * i + k] = a[i].mul_add(t[k], flux[2 * i + k]);
        }
    }
}

/// Impedance Z = z_s 1 + (z_p - z_s) n n^T with n the current unit normal; both Z and its inverse act on vectors.
#[derive(Debug, Clone, Copy)]
pub struct Impedance<L> {
    z: [L; 2],
    n: [L; 2],
}

impl<L: Lane> Impedance<L> {
    /// From speeds (c_p, c_s), density and the current unit normal.
    #[inline(always)]
    pub fn new(c: [L; 2], density: L, n: [L; 2]) -> Self {
        Self { z: [density * c[0], density * c[1]], n }
    }

    /// Z a.
    #[inline(always)]
    pub fn times(&self, a: [L; 2]) -> [L; 2] {
        self.act(self.z, a)
    }

    /// Z^-1 a.
    #[inline(always)]
    pub fn solve(&self, a: [L; 2]) -> [L; 2] {
        self.act([L::splat(1.0) / self.z[0], L::splat(1.0) / self.z[1]], a)
    }

    #[inline(always)]
    fn act(&self, z: [L; 2], a: [L; 2]) -> [L; 2] {
        let normal = (z[0] - z[1]) * tensor::dot(self.n, a);
        [z[1].mul_add(a[0], normal * self.n[0]), z[1].mul_add(a[1], normal * self.n[1])]
    }
}

/// The current normal (cof F^- + cof F^+) N, normalised: splitting along N itself is not objective.
#[inline(always)]
pub fn current_normal<L: Lane>(minus: [L; 4], plus: [L; 4], n: [L; 2]) -> [L; 2] {
    let sum = [minus[0] + plus[0], minus[1] + plus[1], minus[2] + plus[2], minus[3] + plus[3]];
    tensor::normalised(tensor::times(tensor::cofactor(sum), n))
}

#[cfg(test)]
mod suite;
