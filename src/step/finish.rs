//! `finish`: with the neighbours' traces, flux (3), lift (14), and after the last stage the update (13) and LCF.

use super::balance::{self, FacePower, METERED, Sums};
use super::volume::Metric;
use super::{Phase, Scheme, Scratch, Stage, Survey, curl, dense};
use crate::boundary::FacePoint;
use crate::lane::{F8, LANES, Lanes, Work, load_array};
use crate::mesh::map;
use crate::operators::Neighbour;
use crate::riemann::{Riemann, TRACE, Trace, interface};
use crate::state::State;
use crate::{with_flux, with_law};
use std::time::Instant;

/// The work on one block.
pub(super) struct Block<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The stage.
    pub stage: &'a Stage<'a>,
    /// The block.
    pub block: usize,
    /// The state at t_n.
    pub state: &'a State,
    /// Its wave speeds.
    pub survey: &'a Survey,
    /// dU/dt of earlier stages.
    pub before: &'a [Vec<F8>],
    /// dU/dt of this block: volume part in, all out.
    pub rate: &'a mut [F8],
    /// Traces of all blocks.
    pub traces: &'a [F8],
    /// New unknowns of this block (out, after the last stage).
    pub next: &'a mut [F8],
    /// Its balance of energy; none where it is off.
    pub sums: Option<&'a mut Sums>,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
}

impl Work for Block<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mut clock = Instant::now();
        match self.sums.is_some() {
            false => with_flux!(self.scheme.flux, riemann => self.fluxes::<L, _, TRACE>(riemann)),
            true => with_flux!(self.scheme.flux, riemann => self.fluxes::<L, _, METERED>(riemann)),
        }
        self.lift::<L>();
        self.scratch.phases.book(Phase::Flux, &mut clock);
        if self.stage.number + 1 < self.scheme.stages() {
            return;
        }
        self.update::<L>();
        self.scratch.phases.book(Phase::Corrector, &mut clock);
        self.project::<L>();
        self.scratch.phases.book(Phase::CurlFree, &mut clock);
    }
}

/// A trace of eight lanes from its ten numbers.
#[inline(always)]
fn load<L: Lanes>(numbers: &[F8]) -> Trace<L> {
    let x = load_array::<L, TRACE>(numbers);
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], x[9]] }
}

/// The trace of one lane.
fn lane_of(numbers: &[F8], lane: usize) -> Trace<f64> {
    let x: [f64; TRACE] = std::array::from_fn(|k| numbers[k].0[lane]);
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], x[9]] }
}

impl Block<'_> {
    /// Lifted numbers of all faces: len w_k (Flux* - own flux of the F rows), [face][component][point]. Traces have W
    /// numbers; those of METERED are for the balance.
    #[inline(always)]
    fn fluxes<L: Lanes, R: Riemann, const W: usize>(&mut self, riemann: &R) {
        let operators = &self.scheme.operators;
        let (m, n) = (operators.line.m, operators.nodes());
        let metric = Metric::of(&operators.geometry, self.block, n);
        let density = self.scheme.laws[operators.blocks.material[self.block]].density();
        for face in 0..4 {
            let normal = load_array::<L, 2>(&metric.normal[2 * face..2 * face + 2]);
            let length = L::load(&metric.length[face]);
            for point in 0..m {
                let at = ((4 * self.block + face) * m + point) * W;
                let own = &self.traces[at..at + W];
                let mut other = [F8::ZERO; W];
                self.gather(face, point, own, &mut other);
                let (minus, plus) = (load::<L>(own), load::<L>(&other));
                let flux = riemann.flux(&minus, &plus, normal, L::splat(density));
                let mut stored = [F8::ZERO; 6];
                for k in 0..6 {
                    flux[k].store(&mut stored[k]);
                }
                self.special(face, point, own, &other, &mut stored);
                let scale = length * L::splat(operators.line.basis.weights[point]);
                if W > TRACE {
                    self.meter::<L>(face, &FacePower { minus: own, plus: &other, flux: &stored }, scale, normal);
                }
                for k in 0..6 {
                    let mut lifted = L::load(&stored[k]);
                    if k < 4 {
                        lifted = minus.v[k / 2].mul_add(normal[k % 2], lifted);
                    }
                    (lifted * scale).store(&mut self.scratch.nodes.lift[(face * 6 + k) * m + point]);
                }
            }
        }
    }

    /// What a face point adds to the balance of the block; `scale` is w len.
    #[inline(always)]
    fn meter<L: Lanes>(&mut self, face: usize, power: &FacePower, scale: L, normal: [L; 2]) {
        let Some(sums) = self.sums.as_mut() else { return };
        let mut weight = F8::ZERO;
        (scale * L::splat(self.stage.dt * self.scheme.weight(self.stage.number))).store(&mut weight);
        power.jumps::<L>(&weight, normal, &mut sums.flux_dissipation);
        let operators = &self.scheme.operators;
        for (lane, neighbour) in operators.blocks.neighbours[self.block][face].iter().enumerate() {
            if matches!(neighbour, Neighbour::Boundary(_)) {
                let at = (self.block * 4 + face) * 2;
                let normal = [operators.geometry.normal[at].0[lane], operators.geometry.normal[at + 1].0[lane]];
                power.boundary(&weight, normal, lane, sums);
            }
        }
    }

    /// The traces of the other side, seen with this side's normal. Where there is no cell, the own trace.
    #[inline(always)]
    fn gather<const W: usize>(&self, face: usize, point: usize, own: &[F8], other: &mut [F8; W]) {
        let m = self.scheme.operators.line.m;
        let numbers = crate::lane::as_f64(self.traces);
        for (lane, neighbour) in self.scheme.operators.blocks.neighbours[self.block][face].iter().enumerate() {
            match *neighbour {
                Neighbour::Cell(across) | Neighbour::Interface(across, _) => {
                    let there = if across.flip { m - 1 - point } else { point };
                    let from = &numbers[(across.face * m + there) * W * LANES + across.lane..];
                    for k in 0..W {
                        other[k].0[lane] = from[k * LANES];
                    }
                    // The neighbour's traction is P N^+ with N^+ = -N.
                    other[6].0[lane] = -other[6].0[lane];
                    other[7].0[lane] = -other[7].0[lane];
                    for s in &mut other[TRACE..] {
                        s.0[lane] = -s.0[lane];
                    }
                }
                Neighbour::Boundary(_) | Neighbour::Padding => {
                    (0..W).for_each(|k| other[k].0[lane] = own[k].0[lane]);
                }
            }
        }
    }

    /// Lanes at a boundary or at another material: their fluxes, one by one.
    fn special(&self, face: usize, point: usize, own: &[F8], other: &[F8], flux: &mut [F8; 6]) {
        let blocks = &self.scheme.operators.blocks;
        for (lane, neighbour) in blocks.neighbours[self.block][face].iter().enumerate() {
            let law = &self.scheme.laws[blocks.material[self.block]];
            let result = match *neighbour {
                Neighbour::Boundary(group) => {
                    let at = self.face_point(face, point, lane, law.density());
                    self.scheme.boundaries[group].flux(&lane_of(own, lane), &at, self.stage.times)
                }
                Neighbour::Interface(_, material) => {
                    let at = self.face_point(face, point, lane, law.density());
                    let densities = [law.density(), self.scheme.laws[material].density()];
                    interface(&lane_of(own, lane), &lane_of(other, lane), at.normal, densities)
                }
                Neighbour::Cell(_) | Neighbour::Padding => continue,
            };
            (0..6).for_each(|k| flux[k].0[lane] = result[k]);
        }
    }

    fn face_point(&self, face: usize, point: usize, lane: usize, density: f64) -> FacePoint {
        let geometry = &self.scheme.operators.geometry;
        let along = self.scheme.operators.line.basis.nodes[point];
        let end = (face % 2) as f64;
        let xi = if face < 2 { [end, along] } else { [along, end] };
        let x = map::position(&geometry.corners_of(self.block, lane), xi);
        let normal = [0, 1].map(|k| geometry.normal[(self.block * 4 + face) * 2 + k].0[lane]);
        FacePoint { x, normal, density }
    }

    /// dU_a/dt -= Phi_a(x_fk) lifted_fk / (w_a J_a).
    #[inline(always)]
    fn lift<L: Lanes>(&mut self) {
        let operators = &self.scheme.operators;
        let (line, m, n) = (&operators.line, operators.line.m, operators.nodes());
        let metric = Metric::of(&operators.geometry, self.block, n);
        for k in 0..6 {
            let lift = &self.scratch.nodes.lift[..24 * m];
            let (left, right) = (&lift[k * m..], &lift[(6 + k) * m..]);
            let (bottom, top) = (&lift[(12 + k) * m..], &lift[(18 + k) * m..]);
            for i in 0..m {
                for j in 0..m {
                    let a = i * m + j;
                    let mut sum = L::splat(line.ends[0][i]) * L::load(&left[j]);
                    sum = L::splat(line.ends[1][i]).mul_add(L::load(&right[j]), sum);
                    sum = L::splat(line.ends[0][j]).mul_add(L::load(&bottom[i]), sum);
                    sum = L::splat(line.ends[1][j]).mul_add(L::load(&top[i]), sum);
                    let rate = L::load(&self.rate[k * n + a]);
                    (rate - sum * L::load(&metric.inverse_mass[a])).store(&mut self.rate[k * n + a]);
                }
            }
        }
    }

    /// U^(n+1) = U^n + dt sum_s b_s k_s.
    #[inline(always)]
    fn update<L: Lanes>(&mut self) {
        let stride = self.rate.len();
        let begin = stride * self.block;
        self.next.copy_from_slice(&self.state.u[begin..begin + stride]);
        let dt = self.stage.dt;
        let weight = |stage: usize| self.scheme.weight(stage);
        for (stage, rate) in self.before.iter().enumerate() {
            if weight(stage) != 0.0 {
                dense::add_scaled::<L>(dt * weight(stage), &rate[begin..begin + stride], self.next);
            }
        }
        dense::add_scaled::<L>(dt * weight(self.stage.number), self.rate, self.next);
    }

    /// LCF with theta = 1 - exp(-alpha c dt / h), c the cell's largest current speed.
    #[inline(always)]
    fn project<L: Lanes>(&mut self) {
        let operators = &self.scheme.operators;
        let (Some(rate), Some(curl_free)) = (self.scheme.curl_rate, &operators.curl_free) else { return };
        let (c, h) = (&self.survey.speed[self.block].0, &operators.geometry.h[self.block].0);
        let theta = F8(std::array::from_fn(|lane| -(-rate * c[lane] * self.stage.dt / h[lane]).exp_m1()));
        let mass = Metric::of(&operators.geometry, self.block, operators.nodes()).mass;
        let law = &self.scheme.laws[operators.blocks.material[self.block]];
        let one = L::splat(1.0);
        if let Some(sums) = self.sums.as_mut() {
            let before = with_law!(law, law => balance::strain_energy::<L, _>(law, mass, self.next));
            balance::add(one, before, &mut sums.curl_dissipation);
        }
        let nodes = &mut self.scratch.nodes;
        let arrays = curl::Arrays { weighted: &mut nodes.weighted, coefficients: &mut nodes.coefficients };
        curl::project::<L>(&curl_free.pool, self.block, &theta, mass, arrays, self.next);
        if let Some(sums) = self.sums.as_mut() {
            let after = with_law!(law, law => balance::strain_energy::<L, _>(law, mass, self.next));
            balance::add(-one, after, &mut sums.curl_dissipation);
        }
    }
}
