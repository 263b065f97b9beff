//! Where energy comes from and goes to: the discrete balance of a step, by cause.
//!
//! What a step loses, but for the control of the curl, is the energy before it, plus the work done in it, minus the energy
//! that the corrector leaves: measured, so that the entries close. It is shared among faces and boundary by the power of
//! their jumps:
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
//! and at a boundary the work v*.t* minus (v* - v).(t* - t) + a.s. Springs of faces ([`crate::riemann::creep`]) store
//! k R (a + dt/2 da/dt) . (R da/dt) of that in a step, which D is without: what they forget is lost. A Runge-Kutta stage counts with dt b_i; ADER has
//! one flux and one source a step, from averages over its time nodes.
//!
//! In the limit of small steps D is what is lost, to rounding. It is not what ADER loses in a step of usual size: its
//! predictor does not see the neighbours during a step, and what the faces correct at its end counts with the state that is
//! corrected, not with the averages. On a smooth wave D is twice of what is lost at S1 and a hundredth of it at S2 and S3; at
//! a shock 1.5 times at S2. So D gives shares alone, and [`Balance::jumps`] shows it. docs/method.md has more.

use super::{Scheme, Work};
use crate::lane::{F8, Lanes, load_array};
use crate::riemann::tangent;
use crate::state::UNKNOWNS;
use crate::sum::exact_sum;
use crate::tensor::{DEFORMATION, dot, times};

/// The balance of energy since the start of a run, in J per metre of thickness.
///
/// E(t) = E(0) + works - dissipations, where E holds what laws have dissipated ([`super::Totals::accounted`]): P is
/// the derivative of both together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Kinetic and strain energy E(0) at the start, with what laws had dissipated.
    pub start: f64,
    /// The same now.
    pub energy: f64,
    /// int t*.v* over boundary and time: what walls, tractions and prescribed velocities give to the body.
    pub boundary_work: f64,
    /// int rho0 b.v over body and time.
    pub source_work: f64,
    /// The same over faces that act on each other: what contact, friction and cohesive edges give to the body. Of either sign where
    /// overlaps are pushed back: the push counts here with v*, and the rest of its power in the dissipation at the boundary.
    pub contact_work: f64,
    /// The share that faces between cells have in the loss of the steps.
    pub flux_dissipation: f64,
    /// The share of the boundary.
    pub boundary_dissipation: f64,
    /// Loss by the control of the curl: the energy before minus that after.
    pub curl_dissipation: f64,
    /// Loss by corrections ([`super::Correction`]) and the rescue ([`super::Rescue`]): the energy before them minus that after; of either sign.
    pub correction_dissipation: f64,
    /// Loss by regrids: the energy on the old grid minus that on the new one; of either sign for the strain energy.
    pub regrid_dissipation: f64,
    /// D and the loss at the boundary, see above: what jumps alone would take if time were integrated exactly.
    pub jumps: f64,
}

impl Balance {
    /// Before the first step, at energy E(0).
    pub fn starting_at(energy: f64) -> Self {
        Self { start: energy, energy, ..Self::default() }
    }

    /// Goes on from another grid, with the energy that it has there.
    pub fn regrid(&mut self, before: f64, after: f64) {
        self.regrid_dissipation += before - after;
        self.energy += after - before;
    }

    /// What came from outside and from between the faces of the body.
    pub fn work(&self) -> f64 {
        self.boundary_work + self.source_work + self.contact_work
    }

    /// All that was lost by a known cause.
    pub fn dissipation(&self) -> f64 {
        let by_step = self.flux_dissipation + self.boundary_dissipation + self.curl_dissipation;
        by_step + self.regrid_dissipation + self.correction_dissipation
    }

    /// What no entry explains of the `energy` (with what laws have dissipated) that is there now: rounding, unless an entry is missing.
    pub fn remainder(&self, energy: f64) -> f64 {
        energy - self.start - self.work() + self.dissipation()
    }
}

/// The balance of one block over one step, a lane a cell, J/m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct BlockBalance {
    /// The power of jumps between cells; of an inner face each side has half.
    pub flux: F8,
    /// The power of what the boundary condition differs from the trace of the body.
    pub boundary: F8,
    /// The energy, with what laws have dissipated, after the corrector.
    pub corrected: F8,
    /// And that of the new state, after the control of the curl and corrections.
    pub energy: F8,
}

/// What a face point adds, seen from '-'.
pub(super) struct FacePower<'a> {
    /// The trace of '-', with s = P T as its last two numbers.
    pub minus: &'a [F8],
    /// That of '+', with the normal of '-'; where there is no cell, again '-'.
    pub plus: &'a [F8],
    /// Flux*.
    pub flux: &'a [F8; UNKNOWNS],
    /// What the spring of the face stores in the step, W/m^2.
    pub stored: &'a F8,
}

impl FacePower<'_> {
    /// Adds half of D with `weight` dt b_i w len; lanes at a boundary have no jumps, and add nothing.
    #[inline(always)]
    pub fn jumps<L: Lanes, const W: usize>(&self, weight: &F8, normal: [L; 2], dissipation: &mut F8) {
        let (m, p) = (load_array::<L, W>(self.minus), load_array::<L, W>(self.plus));
        let x = load_array::<L, UNKNOWNS>(self.flux);
        let g = [x[0], x[1], x[2], x[3]];
        let (v, a) = (times(g, normal), times(g, tangent(normal)));
        let half = L::splat(0.5);
        let mut power = -L::load(self.stored);
        for i in 0..2 {
            let star_v = -v[i] - half * (m[DEFORMATION + i] + p[DEFORMATION + i]);
            let star_t = -x[DEFORMATION + i] - half * (m[UNKNOWNS + i] + p[UNKNOWNS + i]);
            power = star_v.mul_add(p[UNKNOWNS + i] - m[UNKNOWNS + i], power);
            power = star_t.mul_add(p[DEFORMATION + i] - m[DEFORMATION + i], power);
            power = power - a[i] * (p[W - 2 + i] - m[W - 2 + i]);
        }
        add(half * L::load(weight), power, dissipation);
    }
}

/// t*.v*, W/m^2: what a boundary condition with this flux gives to the body.
#[inline]
pub(super) fn boundary_power(flux: &[f64; UNKNOWNS], normal: [f64; 2]) -> f64 {
    // v* = -G N and t* = -g.
    dot(times([flux[0], flux[1], flux[2], flux[3]], normal), [flux[4], flux[5]])
}

/// (v* - v).(t* - t) + a.s, W/m^2, in a lane with the trace `own`, s = P T being its last two numbers.
pub(super) fn boundary_loss(own: &[F8], flux: &[f64; UNKNOWNS], normal: [f64; 2], lane: usize) -> f64 {
    let of = |k: usize| [own[k].0[lane], own[k + 1].0[lane]];
    let g = [flux[0], flux[1], flux[2], flux[3]];
    let (v, t, s, back) = (of(DEFORMATION), of(UNKNOWNS), of(own.len() - 2), times(g, normal));
    let jump = |i: usize| (-back[i] - v[i]) * (-flux[DEFORMATION + i] - t[i]);
    jump(0) + jump(1) + dot(times(g, tangent(normal)), s)
}

/// sum += weight x.
#[inline(always)]
pub(super) fn add<L: Lanes>(weight: L, x: L, sum: &mut F8) {
    weight.mul_add(x, L::load(sum)).store(sum);
}

impl Work {
    /// With the memory that the balance of energy needs; the steps then meter it.
    pub fn with_balance(mut self, scheme: &Scheme) -> Self {
        self.tiles.widen(scheme);
        self.balance = Some(vec![BlockBalance::default(); scheme.operators.blocks.len()]);
        self
    }

    /// Whether the steps meter the balance.
    pub fn has_balance(&self) -> bool {
        self.balance.is_some()
    }

    /// Adds the last step to `balance`, the blocks by an exact sum. Nothing where the balance is off.
    pub fn settle(&self, scheme: &Scheme, balance: &mut Balance) {
        let Some(blocks) = &self.balance else { return };
        let sum = |of: fn(&BlockBalance) -> &F8| {
            let cells = blocks.iter().map(of).zip(&scheme.operators.blocks.count);
            exact_sum(cells.map(|(lanes, &count)| lanes.0[..count].iter().sum()))
        };
        let (flux, boundary) = (sum(|block| &block.flux), sum(|block| &block.boundary));
        let (corrected, energy) = (sum(|block| &block.corrected), sum(|block| &block.energy));
        let [by_boundary, by_sources, between] = self.external_work(scheme);
        balance.contact_work += between;
        balance.boundary_work += by_boundary;
        balance.source_work += by_sources;
        balance.jumps += flux + boundary;
        let [before, after] = self.corrections.as_ref().map_or([0.0; 2], |memory| memory.loss);
        balance.correction_dissipation += before + after + self.turning_loss;
        balance.curl_dissipation += corrected - (energy + after);
        let lost = balance.energy - before + (by_boundary + by_sources + between) - corrected;
        let all = flux.abs() + boundary.abs();
        let at_boundary = if all > 0.0 { lost * (boundary.abs() / all) } else { 0.0 };
        balance.boundary_dissipation += at_boundary;
        balance.flux_dissipation += lost - at_boundary;
        balance.energy = energy - self.turning_loss;
    }
}

#[cfg(test)]
mod tests;
