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

/// Numbers of a face for the kernel.
struct Face<'a, const W: usize> {
    /// Own traces, by point.
    own: &'a [[F8; W]],
    /// Where the other side's are: by point, or lane by lane, then from `gathered`.
    aligned: Option<&'a [[F8; W]]>,
    /// First number of each lane at the first point, and what to add for the next one.
    at: [usize; LANES],
    step: [isize; LANES],
    /// Whether a lane is at a boundary or at another material.
    special: bool,
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

    /// How to read a face.
    #[inline(always)]
    fn face<const W: usize>(&self, face: usize) -> Face<'_, W> {
        let (blocks, m) = (&self.scheme.operators.blocks, self.scheme.operators.line.m);
        let traces = self.traces.as_chunks::<W>().0;
        let plan = blocks.plan[self.block][face];
        let at = (4 * self.block + face) * m;
        let mut out =
            Face { own: &traces[at..at + m], aligned: None, at: [0; LANES], step: [0; LANES], special: plan.special };
        let across = match plan.side {
            Side::Aligned(there) => {
                out.aligned = Some(&traces[there * m..there * m + m]);
                return out;
            }
            Side::Gathered(entry) => blocks.gathered[entry],
        };
        let stride = (W * LANES) as isize;
        for lane in 0..LANES {
            let there = &across[lane];
            let point = if there.flip { m - 1 } else { 0 };
            out.at[lane] = (there.face * m + point) * W * LANES + there.lane;
            out.step[lane] = if there.flip { -stride } else { stride };
        }
        out
    }

    /// Lifted numbers of all faces: len w_k (Flux* - own flux of the F rows), [face][component][point]. Traces have W
    /// numbers.
    #[inline(always)]
    fn fluxes<L: Lanes, R: Riemann, const W: usize>(&mut self, riemann: &R) {
        let operators = &self.scheme.operators;
        let m = operators.line.m;
        let metric = Metric::of(&operators.geometry, self.block, operators.nodes());
        let density = L::splat(self.scheme.laws[operators.blocks.material[self.block]].density());
        // Moved out while the faces are looked at.
        let (mut lift, mut sums) = (std::mem::take(&mut self.scratch.nodes.lift), self.sums.take());
        let metered = sums.is_some();
        for face in 0..4 {
            let normal = load_array::<L, 2>(&metric.normal[2 * face..2 * face + 2]);
            let length = L::load(&metric.length[face]);
            let out = &mut lift[face * 6 * m..(face + 1) * 6 * m];
            let Face { own: numbers, aligned, mut at, step, special } = self.face::<W>(face);
            for (point, &weight) in operators.line.basis.weights[..m].iter().enumerate() {
                let own = load_array::<L, W>(&numbers[point]);
                let other = match aligned {
                    Some(there) => load_array::<L, W>(&there[point]),
                    None => {
                        let numbers = gather_array::<L, W>(self.traces, &at);
                        for lane in 0..LANES {
                            at[lane] = at[lane].wrapping_add_signed(step[lane]);
                        }
                        numbers
                    }
                };
                let mut other = turned(other);
                let minus = trace_of::<L, R, W>(&own);
                let mut flux = riemann.flux(&minus, &trace_of::<L, R, W>(&other), normal, density);
                let scale = length * L::splat(weight);
                if special {
                    if metered {
                        other = self.without_jumps::<L, W>(face, own, other);
                    }
                    flux = self.patched::<L, R, W>(face, point, other, flux);
                }
                if W >= width(false, true) {
                    self.meter::<L, W>((face, point), (other, flux), (scale, normal), &mut sums);
                }
                for k in 0..6 {
                    let mut lifted = flux[k];
                    if k < 4 {
                        lifted = minus.v[k / 2].mul_add(normal[k % 2], lifted);
                    }
                    (lifted * scale).store(&mut out[k * m + point]);
                }
            }
        }
        (self.scratch.nodes.lift, self.sums) = (lift, sums);
    }

    /// The other side's numbers, with the own ones in lanes at a boundary: these have no jumps for the balance.
    #[inline(always)]
    fn without_jumps<L: Lanes, const W: usize>(&self, face: usize, own: [L; W], other: [L; W]) -> [L; W] {
        let (mut here, mut there) = ([F8::ZERO; W], [F8::ZERO; W]);
        store_array(own, &mut here);
        store_array(other, &mut there);
        for (lane, neighbour) in self.scheme.operators.blocks.neighbours[self.block][face].iter().enumerate() {
            if matches!(neighbour, Neighbour::Boundary(_)) {
                (0..W).for_each(|k| there[k].0[lane] = here[k].0[lane]);
            }
        }
        load_array::<L, W>(&there)
    }

    /// The own numbers of a face point.
    #[inline(always)]
    fn own(&self, face: usize, point: usize, w: usize) -> &[F8] {
        let at = ((4 * self.block + face) * self.scheme.operators.line.m + point) * w;
        &self.traces[at..at + w]
    }

    /// The flux with lanes at a boundary or at another material put right.
    #[inline(always)]
    fn patched<L: Lanes, R: Riemann, const W: usize>(
        &self,
        face: usize,
        point: usize,
        other: [L; W],
        flux: [L; 6],
    ) -> [L; 6] {
        let (mut there, mut stored) = ([F8::ZERO; W], [F8::ZERO; 6]);
        store_array(other, &mut there);
        store_array(flux, &mut stored);
        self.special(face, point, [self.own(face, point, W), &there], R::SHEAR, &mut stored);
        load_array::<L, 6>(&stored)
    }

    /// What a face point adds to the balance of the block; `scale` is w len.
    #[inline(always)]
    fn meter<L: Lanes, const W: usize>(
        &self,
        (face, point): (usize, usize),
        (other, flux): ([L; W], [L; 6]),
        (scale, normal): (L, [L; 2]),
        sums: &mut Option<&mut Sums>,
    ) {
        let Some(sums) = sums else { return };
        let (mut weight, mut there, mut stored) = (F8::ZERO, [F8::ZERO; W], [F8::ZERO; 6]);
        (scale * L::splat(self.stage.dt * self.scheme.weight(self.stage.number))).store(&mut weight);
        store_array(other, &mut there);
        store_array(flux, &mut stored);
        let power = FacePower { minus: self.own(face, point, W), plus: &there, flux: &stored };
        power.jumps::<L, W>(&weight, normal, &mut sums.flux_dissipation);
        let operators = &self.scheme.operators;
        for (lane, neighbour) in operators.blocks.neighbours[self.block][face].iter().enumerate() {
            if matches!(neighbour, Neighbour::Boundary(_)) {
                let at = (self.block * 4 + face) * 2;
                let normal = [operators.geometry.normal[at].0[lane], operators.geometry.normal[at + 1].0[lane]];
                power.boundary(&weight, normal, lane, sums);
            }
        }
    }

    /// Lanes at a boundary or at another material: their fluxes, one by one, from the numbers of both sides.
    fn special(&self, face: usize, point: usize, sides: [&[F8]; 2], shear: bool, flux: &mut [F8; 6]) {
        let blocks = &self.scheme.operators.blocks;
        let law = &self.scheme.laws[blocks.material[self.block]];
        for (lane, neighbour) in blocks.neighbours[self.block][face].iter().enumerate() {
            let group = match *neighbour {
                Neighbour::Boundary(group) => Some(group),
                Neighbour::Interface(..) => None,
                Neighbour::Cell(_) | Neighbour::Padding => continue,
            };
            let at = self.face_point(face, point, lane, law.density());
            let trace = |side: usize, law: &Law| {
                let x = |k: usize| sides[side][k].0[lane];
                let f = [x(0), x(1), x(2), x(3)];
                let c = if shear { [x(8), x(9)] } else { law.speeds(f, at.normal) };
                Trace { f, v: [x(4), x(5)], t: [x(6), x(7)], c }
            };
            let result = match (group, *neighbour) {
                (Some(group), _) => self.scheme.boundaries[group].flux(&trace(0, law), &at, self.stage.times),
                (None, Neighbour::Interface(_, material)) => {
                    let other = &self.scheme.laws[material];
                    interface(&trace(0, law), &trace(1, other), at.normal, [law.density(), other.density()])
                }
                _ => continue,
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
