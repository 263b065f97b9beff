//! Where energy comes from and goes to: the discrete balance of a step, by cause.
//!
//! With E = sum_a m_a (|p_a|^2 / (2 rho0) + W(F_a)), rates v_a . dp_a/dt + P(F_a) : dF_a/dt, and the corrector of
//! `volume` and `finish` (rows of F in strong form, rows of p in weak form), the volume terms cancel to rounding and
//! each side of a face point of weight w len leaves, with Flux* = (G, g) and all quantities interpolated,
//!
//! ```text
//! dE/dt = - w len [ (G + v^- (x) N) : P^- + g . v^- ] + sources
//! ```
//!
//! With v* = -G N, t* = -g, a = G T and s = P T this is, for the two sides of an inner face together, minus
//!
//! ```text
//! D = (v* - mean v).[t] + (t* - mean t).[v] - a.[s],      [.] = (.)^+ - (.)^-
//! ```
//!
//! which is zero without jumps and not negative for a dissipative flux (acoustic: half [t] Z^-1 [t] + half [v] Z [v]),
//! and at a boundary the work v*.t* minus (v* - v).(t* - t) + a.s. A Runge-Kutta stage counts with dt b_i; ADER has
//! one flux and one source a step, from averages over its time nodes.
//!
//! What is left of the change of energy is the remainder: time integration alone, since the interpolated P is taken,
//! not P of the interpolated F. For ADER it holds that the predictor does not see the neighbours: the jumps of its
//! averages are larger than those of the solution half-way through the step, and at a shock `flux_dissipation` is too
//! large by up to the remainder (measured on the paper's impact, S2: .4 to .6 of it; RK4: .01).

use super::history::recall;
use super::{Scheme, Work};
use crate::lane::{F8, Lanes, load_array};
use crate::material::Material;
use crate::riemann::tangent;
use crate::tensor::{dot, times};

/// The balance of energy since the start of a run, in J per metre of thickness.
///
/// E(t) = E(0) + works - dissipations + remainder, where E holds what plastic flow has dissipated
/// ([`super::Totals::accounted`]): P is the derivative of both together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Kinetic and strain energy E(0) at the start, with what plastic flow had dissipated.
    pub start: f64,
    /// int t*.v* over boundary and time: what walls, tractions and prescribed velocities give to the body.
    pub boundary_work: f64,
    /// int rho0 b.v over body and time.
    pub source_work: f64,
    /// Loss by jumps between cells.
    pub flux_dissipation: f64,
    /// Loss by what the boundary condition differs from the trace of the body.
    pub boundary_dissipation: f64,
    /// Loss by the curl-free projection: the energy before minus that after. P : (F - Pi F) is of either sign: where
    /// there are few jumps the projection may give energy to a body under stress.
    pub curl_dissipation: f64,
    /// Loss by regrids: the energy on the old grid minus that on the new one; of either sign for the strain energy.
    pub regrid_dissipation: f64,
}

impl Balance {
    /// Before the first step, at energy E(0).
    pub fn starting_at(energy: f64) -> Self {
        Self { start: energy, ..Self::default() }
    }

    /// What came from outside.
    pub fn work(&self) -> f64 {
        self.boundary_work + self.source_work
    }

    /// All that was lost by a known cause.
    pub fn dissipation(&self) -> f64 {
        self.flux_dissipation + self.boundary_dissipation + self.curl_dissipation + self.regrid_dissipation
    }

    /// What no cause explains of the `energy` (with plastic dissipation) that is there now: the error of time integration.
    pub fn remainder(&self, energy: f64) -> f64 {
        energy - self.start - self.work() + self.dissipation()
    }
}

/// The balance of one block over one step, a lane a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sums {
    /// As in [`Balance`].
    pub boundary_work: F8,
    /// As in [`Balance`].
    pub source_work: F8,
    /// As in [`Balance`]; of an inner face each side has half.
    pub flux_dissipation: F8,
    /// As in [`Balance`].
    pub boundary_dissipation: F8,
    /// As in [`Balance`].
    pub curl_dissipation: F8,
}

/// What a face point adds, seen from '-'.
pub(super) struct FacePower<'a> {
    /// The trace of '-', with s = P T as its last two numbers.
    pub minus: &'a [F8],
    /// That of '+', with the normal of '-'; where there is no cell, again '-'.
    pub plus: &'a [F8],
    /// Flux*.
    pub flux: &'a [F8; 6],
}

impl FacePower<'_> {
    /// Adds half of D with `weight` dt b_i w len; lanes at a boundary have no jumps, and add nothing.
    #[inline(always)]
    pub fn jumps<L: Lanes, const W: usize>(&self, weight: &F8, normal: [L; 2], dissipation: &mut F8) {
        let (m, p) = (load_array::<L, W>(self.minus), load_array::<L, W>(self.plus));
        let x = load_array::<L, 6>(self.flux);
        let g = [x[0], x[1], x[2], x[3]];
        let (v, a) = (times(g, normal), times(g, tangent(normal)));
        let half = L::splat(0.5);
        let mut power = L::zero();
        for i in 0..2 {
            let star_v = -v[i] - half * (m[4 + i] + p[4 + i]);
            let star_t = -x[4 + i] - half * (m[6 + i] + p[6 + i]);
            power = star_v.mul_add(p[6 + i] - m[6 + i], power);
            power = star_t.mul_add(p[4 + i] - m[4 + i], power);
            power = power - a[i] * (p[W - 2 + i] - m[W - 2 + i]);
        }
        add(half * L::load(weight), power, dissipation);
    }

    /// Adds work and dissipation of a lane that lies at a boundary.
    pub fn boundary(&self, weight: &F8, normal: [f64; 2], lane: usize, sums: &mut Sums) {
        let of = |numbers: &[F8], k: usize| [numbers[k].0[lane], numbers[k + 1].0[lane]];
        let ([g11, g12], [g21, g22]) = (of(self.flux, 0), of(self.flux, 2));
        let g = [g11, g12, g21, g22];
        let (v, t, s) = (of(self.minus, 4), of(self.minus, 6), of(self.minus, self.minus.len() - 2));
        let star_v = times(g, normal).map(|x| -x);
        let star_t = of(self.flux, 4).map(|x| -x);
        let jump = [0, 1].map(|i| (star_v[i] - v[i]) * (star_t[i] - t[i]));
        let weight = weight.0[lane];
        sums.boundary_work.0[lane] += weight * dot(star_v, star_t);
        sums.boundary_dissipation.0[lane] += weight * (jump[0] + jump[1] + dot(times(g, tangent(normal)), s));
    }
}

/// sum += weight x.
#[inline(always)]
pub(super) fn add<L: Lanes>(weight: L, x: L, sum: &mut F8) {
    weight.mul_add(x, L::load(sum)).store(sum);
}

/// sum_a m_a rho0 b_a.v_a, W/m: `mean` is [node][6] with v behind F, `source` [2][node].
#[inline(always)]
pub(super) fn source_power<L: Lanes>(density: f64, mass: &[F8], mean: &[F8], source: &[F8]) -> L {
    let n = mass.len();
    let mut sum = L::zero();
    for (a, mass) in mass.iter().enumerate() {
        let v = load_array::<L, 2>(&mean[6 * a + 4..6 * a + 6]);
        let power = dot([L::load(&source[a]), L::load(&source[n + a])], v);
        sum = L::load(mass).mul_add(power, sum);
    }
    L::splat(density) * sum
}

/// sum_a m_a W(F_a), J/m, of unknowns `u`, [component][node], W with what plastic flow dissipates on the way there from
/// the internal variables `internal`, [node][variable].
#[inline(always)]
pub(super) fn strain_energy<L: Lanes, M: Material>(law: &M, mass: &[F8], u: &[F8], internal: &[F8]) -> L {
    let n = mass.len();
    let mut sum = L::zero();
    for (a, mass) in mass.iter().enumerate() {
        let (f, internal) = (super::dense::gather::<L, 4>(u, n, a), recall::<L, M>(law, internal, a));
        let mut energy = law.energy(f, &internal[..M::INTERNAL.len()]);
        if !M::INTERNAL.is_empty() {
            energy = energy + law.dissipated(f, &internal[..M::INTERNAL.len()]);
        }
        sum = L::load(mass).mul_add(energy, sum);
    }
    sum
}

impl Work {
    /// With the memory that the balance of energy needs; the steps then meter it.
    pub fn with_balance(mut self, scheme: &Scheme) -> Self {
        self.tiles.widen(scheme);
        self.balance = Some(vec![Sums::default(); scheme.operators.blocks.len()]);
        self
    }

    /// Whether the steps meter the balance.
    pub fn has_balance(&self) -> bool {
        self.balance.is_some()
    }

    /// Adds the last step to `balance`, cells in a fixed order. Nothing where the balance is off.
    pub fn settle(&self, scheme: &Scheme, balance: &mut Balance) {
        for (sums, &count) in self.balance.iter().flatten().zip(&scheme.operators.blocks.count) {
            for lane in 0..count {
                balance.boundary_work += sums.boundary_work.0[lane];
                balance.source_work += sums.source_work.0[lane];
                balance.flux_dissipation += sums.flux_dissipation.0[lane];
                balance.boundary_dissipation += sums.boundary_dissipation.0[lane];
                balance.curl_dissipation += sums.curl_dissipation.0[lane];
            }
        }
    }
}

#[cfg(test)]
mod tests;
