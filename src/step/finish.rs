//! `finish`: with the neighbours' traces, flux (3), lift (14), and after the last stage the update (13) and LCF.

use super::balance::{self, FacePower, Sums};
use super::phase::Clock;
use super::sums::Terms;
use super::volume::{Metric, row, width, with_nodes};
use super::{Phase, Scheme, Scratch, Stage, Survey, curl};
use crate::boundary::FacePoint;
use crate::lane::{F8, LANES, Lanes, Work, gather_array, load_array, store_array};
use crate::material::Law;
use crate::mesh::map;
use crate::operators::blocks::Across;
use crate::operators::{Line, Neighbour, Side};
use crate::riemann::{Riemann, Trace, interface};
use crate::state::State;
use crate::{with_flux, with_law};

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

impl Block<'_> {
    /// All of it.
    pub fn run(mut self) {
        let (kernel, operators) = (self.scheme.kernel, &self.scheme.operators);
        let mut clock = Clock::now();
        kernel.run(Fluxes(&mut self));
        let lift = &self.scratch.nodes.lift;
        let inverse_mass = Metric::of(&operators.geometry, self.block, operators.nodes()).inverse_mass;
        let line = &operators.line;
        with_nodes!(line.m, M => kernel.run(Lift::<'_, M> { line, inverse_mass, lift, rate: self.rate }));
        self.scratch.phases.book(Phase::Flux, &mut clock);
        if self.stage.number + 1 < self.scheme.stages() {
            return;
        }
        kernel.run(Update(&mut self));
        self.scratch.phases.book(Phase::Corrector, &mut clock);
        if self.scheme.curl_rate.is_some() {
            kernel.run(Project(&mut self));
        }
        self.scratch.phases.book(Phase::CurlFree, &mut clock);
    }
}

/// The fluxes of a block.
struct Fluxes<'a, 'b>(&'a mut Block<'b>);

impl Work for Fluxes<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        with_flux!(self.0.scheme.flux, riemann => self.0.fluxes_of::<L, _>(riemann))
    }
}

/// The update (13) of a block.
struct Update<'a, 'b>(&'a mut Block<'b>);

impl Work for Update<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.update::<L>();
    }
}

/// LCF of a block.
struct Project<'a, 'b>(&'a mut Block<'b>);

impl Work for Project<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.project::<L>();
    }
}

/// A trace of eight lanes from its numbers.
#[inline(always)]
fn trace_of<L: Lanes, R: Riemann, const W: usize>(x: &[L; W]) -> Trace<L> {
    let shear = if R::SHEAR { x[9] } else { L::zero() };
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], shear] }
}

/// The other side's trace with this side's normal: its traction is P N^+ with N^+ = -N, and so is s = P T, which stands
/// behind c.
#[inline(always)]
fn turned<L: Lanes, const W: usize>(mut x: [L; W]) -> [L; W] {
    x[6] = -x[6];
    x[7] = -x[7];
    if W >= width(false, true) {
        x[W - 2] = -x[W - 2];
        x[W - 1] = -x[W - 1];
    }
    x
}

/// Traces that lie apart, lane by lane, in the order of the points of this side.
#[inline(always)]
fn collect<L: Lanes, const W: usize>(traces: &[F8], across: &[Across; LANES], out: &mut [[F8; W]]) {
    let (m, stride) = (out.len(), (W * LANES) as isize);
    let (mut at, mut step) = ([0; LANES], [stride; LANES]);
    for lane in 0..LANES {
        let there = &across[lane];
        let first = if there.flip { m - 1 } else { 0 };
        at[lane] = (there.face * m + first) * W * LANES + there.lane;
        step[lane] = if there.flip { -stride } else { stride };
    }
    for out in out {
        store_array(gather_array::<L, W>(traces, &at), out);
        for lane in 0..LANES {
            at[lane] = at[lane].wrapping_add_signed(step[lane]);
        }
    }
}

/// Both sides of a face of a block, with W numbers a trace, and its geometry.
struct Face<'a, L, const W: usize> {
    /// The face of the block, 0..4.
    number: usize,
    /// Own traces, by point.
    own: &'a [[F8; W]],
    /// The other side's, by point, with its own normal.
    other: &'a [[F8; W]],
    /// Unit outward normal.
    normal: [L; 2],
    /// Length.
    length: L,
    /// Weights of the points.
    weights: &'a [f64],
}

impl<L: Lanes, const W: usize> Face<'_, L, W> {
    /// Trace of this side and of the other at a point.
    #[inline(always)]
    fn traces<R: Riemann>(&self, point: usize) -> [Trace<L>; 2] {
        let (own, other) = (load_array::<L, W>(&self.own[point]), load_array::<L, W>(&self.other[point]));
        [trace_of::<L, R, W>(&own), trace_of::<L, R, W>(&turned(other))]
    }

    /// w len.
    #[inline(always)]
    fn scale(&self, point: usize) -> L {
        self.length * L::splat(self.weights[point])
    }

    /// len w (Flux* - own flux of the F rows), v that of this side.
    #[inline(always)]
    fn lifted(&self, point: usize, flux: [L; 6], v: [L; 2]) -> [L; 6] {
        let (scale, mut out) = (self.scale(point), flux);
        for k in 0..6 {
            if k < 4 {
                out[k] = v[k / 2].mul_add(self.normal[k % 2], out[k]);
            }
            out[k] = out[k] * scale;
        }
        out
    }
}

/// Whether the flux of a lane is not that of two cells of one law.
#[inline(always)]
fn is_special(neighbour: &Neighbour) -> bool {
    matches!(neighbour, Neighbour::Boundary(_) | Neighbour::Interface(..))
}

impl Block<'_> {
    #[inline(always)]
    fn fluxes_of<L: Lanes, R: Riemann>(&mut self, riemann: &R) {
        match (R::SHEAR, self.sums.is_some()) {
            (false, false) => self.fluxes::<L, R, { width(false, false) }>(riemann),
            (true, false) => self.fluxes::<L, R, { width(true, false) }>(riemann),
            (false, true) => self.fluxes::<L, R, { width(false, true) }>(riemann),
            (true, true) => self.fluxes::<L, R, { width(true, true) }>(riemann),
        }
    }

    /// Lifted numbers of all faces: len w_k (Flux* - own flux of the F rows), [face][component][point].
    #[inline(always)]
    fn fluxes<L: Lanes, R: Riemann, const W: usize>(&mut self, riemann: &R) {
        let operators = &self.scheme.operators;
        let m = operators.line.m;
        let weights = &operators.line.basis.weights[..m];
        let metric = Metric::of(&operators.geometry, self.block, operators.nodes());
        let density = L::splat(self.scheme.laws[operators.blocks.material[self.block]].density());
        let traces = self.traces.as_chunks::<W>().0;
        // Moved out while the faces are looked at.
        let nodes = &mut self.scratch.nodes;
        let (mut lift, mut across) = (std::mem::take(&mut nodes.lift), std::mem::take(&mut nodes.across));
        let mut sums = self.sums.take();
        for number in 0..4 {
            let plan = operators.blocks.plan[self.block][number];
            let other = match plan.side {
                Side::Aligned(there) => &traces[there * m..there * m + m],
                Side::Gathered(entry) => {
                    let out = &mut across.as_chunks_mut::<W>().0[..m];
                    collect::<L, W>(self.traces, &operators.blocks.gathered[entry], out);
                    out
                }
            };
            let at = (4 * self.block + number) * m;
            let normal = load_array::<L, 2>(&metric.normal[2 * number..2 * number + 2]);
            let length = L::load(&metric.length[number]);
            let face = Face { number, own: &traces[at..at + m], other, normal, length, weights };
            let out = &mut lift[number * 6 * m..(number + 1) * 6 * m];
            for point in 0..m {
                let [minus, plus] = face.traces::<R>(point);
                let lifted = face.lifted(point, riemann.flux(&minus, &plus, normal, density), minus.v);
                for k in 0..6 {
                    lifted[k].store(&mut out[k * m + point]);
                }
            }
            if plan.special {
                self.put_right::<L, R, W>(&face, out);
            }
            if let (true, Some(sums)) = (W >= width(false, true), &mut sums) {
                self.meter::<L, R, W>(riemann, &face, density, sums);
            }
        }
        (self.scratch.nodes.lift, self.scratch.nodes.across, self.sums) = (lift, across, sums);
    }

    /// The lifted numbers of lanes at a boundary or at another material, in `out`, [component][point].
    #[inline(always)]
    fn put_right<L: Lanes, R: Riemann, const W: usize>(&self, face: &Face<L, W>, out: &mut [F8]) {
        let neighbours = &self.scheme.operators.blocks.neighbours[self.block][face.number];
        let m = face.weights.len();
        for point in 0..m {
            let mut flux = [F8::ZERO; 6];
            self.special(face.number, point, [&face.own[point], &face.other[point]], R::SHEAR, &mut flux);
            let v = load_array::<L, 2>(&face.own[point][4..6]);
            let mut lifted = [F8::ZERO; 6];
            store_array(face.lifted(point, load_array::<L, 6>(&flux), v), &mut lifted);
            for (lane, _) in neighbours.iter().enumerate().filter(|(_, neighbour)| is_special(neighbour)) {
                (0..6).for_each(|k| out[k * m + point].0[lane] = lifted[k].0[lane]);
            }
        }
    }

    /// What a face adds to the balance of the block. The fluxes are found once more: without the balance they never come
    /// to memory.
    #[inline(always)]
    fn meter<L: Lanes, R: Riemann, const W: usize>(&self, riemann: &R, face: &Face<L, W>, density: L, sums: &mut Sums) {
        let neighbours = &self.scheme.operators.blocks.neighbours[self.block][face.number];
        let factor = self.stage.dt * self.scheme.weight(self.stage.number);
        let mut normal = [F8::ZERO; 2];
        store_array(face.normal, &mut normal);
        for point in 0..face.weights.len() {
            let [minus, plus] = face.traces::<R>(point);
            let (mut flux, mut there, mut weight) = ([F8::ZERO; 6], [F8::ZERO; W], F8::ZERO);
            store_array(riemann.flux(&minus, &plus, face.normal, density), &mut flux);
            store_array(turned(load_array::<L, W>(&face.other[point])), &mut there);
            (face.scale(point) * L::splat(factor)).store(&mut weight);
            let own = &face.own[point];
            self.special(face.number, point, [own, &face.other[point]], R::SHEAR, &mut flux);
            for (lane, neighbour) in neighbours.iter().enumerate() {
                if matches!(neighbour, Neighbour::Boundary(_)) {
                    // Lanes at a boundary see themselves: they have no jumps.
                    (0..W).for_each(|k| there[k].0[lane] = own[k].0[lane]);
                    let power = FacePower { minus: own, plus: own, flux: &flux };
                    power.boundary(&weight, [normal[0].0[lane], normal[1].0[lane]], lane, sums);
                }
            }
            let power = FacePower { minus: own, plus: &there, flux: &flux };
            power.jumps::<L, W>(&weight, face.normal, &mut sums.flux_dissipation);
        }
    }

    /// Lanes at a boundary or at another material: their fluxes, one by one, from the numbers of both sides, each with
    /// its own normal.
    fn special(&self, face: usize, point: usize, sides: [&[F8]; 2], shear: bool, flux: &mut [F8; 6]) {
        let blocks = &self.scheme.operators.blocks;
        let law = &self.scheme.laws[blocks.material[self.block]];
        for (lane, neighbour) in blocks.neighbours[self.block][face].iter().enumerate() {
            if !is_special(neighbour) {
                continue;
            }
            let at = self.face_point(face, point, lane, law.density());
            let trace = |side: usize, law: &Law| {
                let x = |k: usize| sides[side][k].0[lane];
                let f = [x(0), x(1), x(2), x(3)];
                let c = if shear { [x(8), x(9)] } else { law.speeds(f, at.normal) };
                let sign = if side == 0 { 1.0 } else { -1.0 };
                Trace { f, v: [x(4), x(5)], t: [sign * x(6), sign * x(7)], c }
            };
            let result = match *neighbour {
                Neighbour::Boundary(group) => self.scheme.boundaries[group].flux(&trace(0, law), &at, self.stage.times),
                Neighbour::Interface(_, material) => {
                    let other = &self.scheme.laws[material];
                    interface(&trace(0, law), &trace(1, other), at.normal, [law.density(), other.density()])
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

    /// U^(n+1) = U^n + dt sum_s b_s k_s.
    #[inline(always)]
    fn update<L: Lanes>(&mut self) {
        let (stride, dt, last) = (self.rate.len(), self.stage.dt, self.stage.number);
        let begin = stride * self.block;
        let factors = (0..last).map(|stage| dt * self.scheme.weight(stage));
        let terms = Terms::new(factors, self.before, begin, stride).and(dt * self.scheme.weight(last), self.rate);
        terms.add_to::<L>(&self.state.u[begin..begin + stride], self.next);
    }

    /// LCF with theta = 1 - exp(-alpha c dt / h), c the cell's largest current speed.
    #[inline(always)]
    fn project<L: Lanes>(&mut self) {
        let operators = &self.scheme.operators;
        let (Some(rate), Some(curl_free)) = (self.scheme.curl_rate, &operators.curl_free) else { return };
        let (c, h) = (&self.survey.speed[self.block], &operators.geometry.h[self.block]);
        let decay = L::load(c) * L::splat(rate * self.stage.dt) / L::load(h);
        let theta = curl::relaxation(decay);
        let mass = Metric::of(&operators.geometry, self.block, operators.nodes()).mass;
        let law = &self.scheme.laws[operators.blocks.material[self.block]];
        let one = L::splat(1.0);
        if let Some(sums) = self.sums.as_mut() {
            let before = with_law!(law, law => balance::strain_energy::<L, _>(law, mass, self.next));
            balance::add(one, before, &mut sums.curl_dissipation);
        }
        let nodes = &mut self.scratch.nodes;
        let arrays = curl::Arrays { weighted: &mut nodes.weighted, coefficients: &mut nodes.coefficients };
        curl::project::<L>(&curl_free.pool, self.block, theta, mass, arrays, self.next);
        if let Some(sums) = self.sums.as_mut() {
            let after = with_law!(law, law => balance::strain_energy::<L, _>(law, mass, self.next));
            balance::add(-one, after, &mut sums.curl_dissipation);
        }
    }
}

/// dU_a/dt -= Phi_a(x_fk) lifted_fk / (w_a J_a).
struct Lift<'a, const M: usize> {
    line: &'a Line,
    inverse_mass: &'a [F8],
    /// [face][component][point].
    lift: &'a [F8],
    rate: &'a mut [F8],
}

impl<const M: usize> Work for Lift<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = M * M;
        let ends = [row::<M>(&self.line.ends[0]), row::<M>(&self.line.ends[1])];
        let lift = &self.lift.as_chunks::<M>().0[..24];
        let inverse_mass = &self.inverse_mass[..n];
        for (k, rate) in self.rate.chunks_exact_mut(n).enumerate().take(6) {
            let (left, right, bottom, top) = (&lift[k], &lift[6 + k], &lift[12 + k], &lift[18 + k]);
            for i in 0..M {
                for j in 0..M {
                    let a = i * M + j;
                    let mut sum = L::splat(ends[0][i]) * L::load(&left[j]);
                    sum = L::splat(ends[1][i]).mul_add(L::load(&right[j]), sum);
                    sum = L::splat(ends[0][j]).mul_add(L::load(&bottom[i]), sum);
                    sum = L::splat(ends[1][j]).mul_add(L::load(&top[i]), sum);
                    (L::load(&rate[a]) - sum * L::load(&inverse_mass[a])).store(&mut rate[a]);
                }
            }
        }
    }
}
