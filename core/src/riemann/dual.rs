//! Lax-Friedrichs in the variables dual to (F, p), velocity and traction, with what holds it under compression.

use super::{Looks, Medium, Riemann, Trace};
use crate::lane::Lane;
use crate::tensor;

/// v* = mean v + theta/(2 z_p) `[t]`, t* = mean t + z_p/2 `[v]`, z_p = rho0 c_p with the larger current speed,
/// theta = min(1, max([`Medium::share`], 2.3 - 2 J)) with J of the mean F; and two jumps of F itself, c_p/4 of its rotation and c_d/2
/// of its deviator:
///
/// ```text
/// Flux*_F += -c_p/4 r e - c_d/2 ([F] - r e - q (g : [F]) g),    r = q (e : [F]),  q = 1/|F|^2,
///     e = E F,  E = [[0, -1], [1, 0]],  g = cof F,  F the mean of both sides (|e| = |g| = |F|, e : g = 0)
/// c_d = max(s/(4 rho0 c_s), w),  s = max(0, -(mean t).(F N)),  rho0 c_s of the law at F = 1,  w = |dv/ds| l, see [`Medium::turn`]
/// ```
///
/// Velocity and traction are the derivatives of the energy: their part dissipates theta/(2 z_p) `[t]`^2 + z_p/2 `[v]`^2, never less
/// than 0, whatever the law and its history. (Rusanov's c_p/2 `[F] : [P]` has either sign where two sides have yielded
/// differently.) e is the rate of F in a rotation, P F^T is symmetric, and P : e = 0: the second part damps the rotation of
/// neighbours against each other without work. Under compression rotations and then deviators have negative energy, and the
/// jump of traction drives them; the third part is 0 without compression across a face that keeps its direction. Strain that is no
/// gradient and has a continuous traction does not turn with a body that spins (its rate is not the gradient of a velocity), and
/// takes energy from the spin or gives it: in such a body its jump is damped faster than the body turns.
///
/// theta < 1: what the jump of traction moves is a displacement of the face that no cell has, so that a body under load
/// creeps and is too soft (the jumps at a re-entrant corner never vanish). The one-step scheme needs some of it; see
/// `docs/method.md` for the limits, the growth rates and what each weight costs in accuracy.
#[derive(Debug, Clone, Copy)]
pub struct Dual;

/// Weights of the jumps of rotation and deviator.
const ROTATION: f64 = 0.25;
const DEVIATOR: f64 = 0.125;

/// Weight of the jump of the deviator by how fast the face turns. A steel square that spins at 100 turns a second (S3, 4 x 4 cells) loses 2.5 % in
/// ten turns with .15, and 1.6e-4 with .3 to 1, as with Rusanov's flux.
const TURN: f64 = 0.5;

/// theta under compression is at least [`COMPRESSED`] - [`STEEPNESS`] J: what it has at J >= .8 by [`Medium::share`], 1 at J <= .65. With .7
/// everywhere the limit of the step of N = 2 falls with J, at diag(s, s) of a law of nu = .3 to .94, .87, .79, .61 of that at rest
/// (s = .8, .75, .7, .6), where .9 of it is used: noise at s = .7 grew 6.7e3 times in 2000 steps. With this it decays to .15, and
/// down to s = .7 the limit is that at rest.
const COMPRESSED: f64 = 2.3;
const STEEPNESS: f64 = 2.0;

/// Twice the star state of two sides: halves of sums and means are left to the last factor, and a factor of 2 rounds nothing.
struct Twice<L> {
    /// theta/z_p, the factor of `[t]` in 2 (v* - mean v).
    admittance: L,
    /// 2 t*.
    t: [L; 2],
    /// v^+ - v^-.
    jump: [L; 2],
    /// Twice what is added to the rows of F.
    add: [L; 4],
}

impl Dual {
    /// What is added to the rows of F: -c_p/4 r e - c_d/2 D, `c` being c_p.
    #[inline(always)]
    pub fn incompatible<L: Lane>(minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], c: L, medium: &Medium<L>) -> [L; 4] {
        let f = Self::sum(minus, plus, medium);
        let mut add = Self::jumps(minus, plus, f, n, c, L::splat(1.0) / tensor::contract(f, f), medium);
        for add in &mut add {
            *add = L::splat(0.5) * *add;
        }
        add
    }

    /// Twice the mean F; twice 1 for a law of the small strain, whose P does work on rotations about any other F. (A tumbling body of it, S3, nu = .45,
    /// had 144 times its energy after 1700 steps.)
    #[inline(always)]
    fn sum<L: Lane>(minus: &Trace<L>, plus: &Trace<L>, medium: &Medium<L>) -> [L; 4] {
        if !medium.is_objective {
            let (two, none) = (L::splat(2.0), L::zero());
            return [two, none, none, two];
        }
        let (m, p) = (minus.f, plus.f);
        [m[0] + p[0], m[1] + p[1], m[2] + p[2], m[3] + p[3]]
    }

    /// 2 (-c_p/4 r e - c_d/2 D) from `f` = 2 F and `inverse` = 1/|2 F|^2: a common factor falls out of r e and q (g : `[F]`) g.
    #[inline(always)]
    fn jumps<L: Lane>(
        minus: &Trace<L>,
        plus: &Trace<L>,
        f: [L; 4],
        n: [L; 2],
        c: L,
        inverse: L,
        medium: &Medium<L>,
    ) -> [L; 4] {
        let (m, p) = (minus.f, plus.f);
        let j = [p[0] - m[0], p[1] - m[1], p[2] - m[2], p[3] - m[3]];
        let (e, g) = ([-f[2], -f[3], f[0], f[1]], tensor::cofactor(f));
        // Four times (mean t).(F N).
        let pushed = tensor::dot([minus.t[0] + plus.t[0], minus.t[1] + plus.t[1]], tensor::times(f, n));
        let prestress = pushed * (L::splat(0.5 * DEVIATOR) * medium.shear_admittance);
        let deviator = prestress.min(L::splat(-2.0 * TURN) * medium.turn);
        let turn = (inverse * tensor::contract(e, j)) * L::splat(-2.0 * ROTATION).mul_add(c, -deviator);
        let trace = -(inverse * tensor::contract(g, j)) * deviator;
        let mut out = [L::zero(); 4];
        for k in 0..4 {
            out[k] = turn.mul_add(e[k], trace.mul_add(g[k], deviator * j[k]));
        }
        out
    }

    /// theta from `f` = 2 F.
    #[inline(always)]
    fn share<L: Lane>(f: [L; 4], medium: &Medium<L>) -> L {
        let under_compression = L::splat(COMPRESSED) - L::splat(0.25 * STEEPNESS) * tensor::det(f);
        under_compression.max(medium.share).min(L::splat(1.0))
    }

    #[inline(always)]
    fn twice<L: Lane>(minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> Twice<L> {
        let c = minus.c[0].max(plus.c[0]);
        let (z, f) = (medium.density * c, Self::sum(minus, plus, medium));
        // One division for 1/z and 1/|2 F|^2.
        let square = tensor::contract(f, f);
        let inverse = L::splat(1.0) / (z * square);
        let add = Self::jumps(minus, plus, f, n, c, inverse * z, medium);
        let admittance = Self::share(f, medium) * (inverse * square);
        let jump = [plus.v[0] - minus.v[0], plus.v[1] - minus.v[1]];
        let t = [z.mul_add(jump[0], minus.t[0] + plus.t[0]), z.mul_add(jump[1], minus.t[1] + plus.t[1])];
        Twice { admittance, t, jump, add }
    }
}

impl Riemann for Dual {
    const LOOKS: Looks = Looks::Displacement;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6] {
        let (twice, half) = (Self::twice(minus, plus, n, medium), L::splat(0.5));
        let mut flux = [L::zero(); 6];
        for i in 0..2 {
            // Not from v^- on: the sides must agree to the bit.
            let v = twice.admittance.mul_add(plus.t[i] - minus.t[i], minus.v[i] + plus.v[i]);
            flux[2 * i] = half * v.mul_add(-n[0], twice.add[2 * i]);
            flux[2 * i + 1] = half * v.mul_add(-n[1], twice.add[2 * i + 1]);
            flux[4 + i] = -(half * twice.t[i]);
        }
        flux
    }

    #[inline(always)]
    fn admittance<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, medium: &Medium<L>) -> L {
        let c = minus.c[0].max(plus.c[0]);
        L::splat(0.5) * Self::share(Self::sum(minus, plus, medium), medium) / (medium.density * c)
    }

    /// In jumps alone.
    #[inline(always)]
    fn lifted<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>, scale: L) -> [L; 6] {
        self.lifted_and_admittance(minus, plus, n, medium, scale).0
    }

    #[inline(always)]
    fn lifted_and_admittance<L: Lane>(
        &self,
        minus: &Trace<L>,
        plus: &Trace<L>,
        n: [L; 2],
        medium: &Medium<L>,
        scale: L,
    ) -> ([L; 6], L) {
        let (twice, half) = (Self::twice(minus, plus, n, medium), L::splat(0.5) * scale);
        let mut out = [L::zero(); 6];
        for i in 0..2 {
            let v = twice.admittance.mul_add(plus.t[i] - minus.t[i], twice.jump[i]);
            out[2 * i] = half * v.mul_add(-n[0], twice.add[2 * i]);
            out[2 * i + 1] = half * v.mul_add(-n[1], twice.add[2 * i + 1]);
            out[4 + i] = -half * twice.t[i];
        }
        (out, twice.admittance)
    }
}
