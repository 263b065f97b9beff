//! The local predictor (15)-(21): a space-time collocation at the points of each cell, blind to its neighbours.
//!
//! A sweep goes node by node in time: [`Predictor::sample`] forms u and from it Q = (P, v) at all points, once through
//! the law; [`rates::Rates`] forms r = (Grad v, Div P) from Q. States at time nodes are never stored: they are sums of
//! rates. So a block holds U^n, Q of one node, and the rates of two sweeps.

mod rates;
pub mod transfer;
mod turn;

use super::history::recall;
use super::sweeps::Sweep;
use super::{Method, Sweeps};
use crate::lane::{self, Coefficient, F8, Kernel, Lane, Lanes, Twin, load_array, store_array};
use crate::material::{Material, Past, count, virgin};
use crate::operators::PointMatrices;
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, DEFORMATION};
use rates::Rates;
use transfer::{ToNodes, ToPoints};
use turn::{Plain, Turn, Turned};

/// Arrays of one block at its points; [point][field] each, those of time nodes with the node outermost.
#[derive(Default)]
pub struct Arrays {
    /// U_p^n.
    pub start: Vec<F8>,
    /// p of U_p^n and what sources and springs add until a time node, [p][6], the rows of F being left; empty without any.
    shifted: Vec<F8>,
    /// r_k,p of the sweep before and of this one, [k][p][6].
    pub rates: [Vec<F8>; 2],
    /// Q of one time node as [`Rates`] wants it, [p][6].
    q: Vec<F8>,
    /// Sources b at points and time nodes, [k][p][2]; empty without sources.
    pub source: Vec<F8>,
    /// dp/dt by the springs of the faces ([`super::held_rate`]) at the nodes, [2][a]; empty without springs.
    pub held_at_nodes: Vec<F8>,
    /// The same at the points, [p][2].
    pub held: Vec<F8>,
    /// Time averages of F and v, [p][6].
    pub mean: Vec<F8>,
    /// Time averages of P, [p][4].
    pub mean_stress: Vec<F8>,
    /// Between the two factors of a transfer.
    pub between: Vec<F8>,
    /// Q at the nodes, [a][6].
    fitted: Vec<F8>,
    /// Ticks spent on sources between sweeps.
    pub ticks: u64,
}

/// What adds to the momentum in a step beside the stress.
#[derive(Debug, Clone, Copy)]
pub struct Added {
    /// Sources.
    pub sources: bool,
    /// Springs of the faces.
    pub springs: bool,
}

impl Arrays {
    /// For at most `points` points a cell and m nodes a direction.
    pub fn new(points: usize, m: usize, method: &Method, added: Added) -> Self {
        let Method::Ader { time, sweeps } = method else { return Self::default() };
        let zeros = |fields: usize| vec![F8::ZERO; fields * points];
        let zeros_if = |wanted: bool, fields: usize| if wanted { zeros(fields) } else { vec![] };
        Self {
            start: zeros(UNKNOWNS),
            shifted: zeros_if(added.sources || added.springs, UNKNOWNS),
            rates: [zeros(UNKNOWNS * sweeps.widest()), zeros(UNKNOWNS * sweeps.widest())],
            q: zeros(UNKNOWNS),
            source: zeros_if(added.sources, AXES * time.len()),
            held_at_nodes: if added.springs { vec![F8::ZERO; AXES * m * m] } else { vec![] },
            held: zeros_if(added.springs, AXES),
            mean: zeros(UNKNOWNS),
            mean_stress: zeros(DEFORMATION),
            between: vec![F8::ZERO; transfer::factors(m, points, UNKNOWNS)],
            fitted: vec![F8::ZERO; UNKNOWNS * m * m],
            ticks: 0,
        }
    }
}

/// What the predictor of a block needs beside its arrays.
pub struct Predictor<'a, M, C> {
    /// The law.
    pub law: &'a M,
    /// Matrices of its points.
    pub matrices: &'a PointMatrices<C>,
    /// dxi_b/dX_a, see [`crate::operators::Points::metric_of`].
    pub metric: &'a [F8],
    /// Weights of the time nodes.
    pub weights: &'a [f64],
    /// The schedule.
    pub sweeps: &'a Sweeps,
    /// Step, s.
    pub dt: f64,
    /// Internal variables at t_n, [p][variable]; empty for a law without.
    pub internal: &'a [F8],
    /// Evaluates the sources anew before a sweep; none where they do not depend on the velocity.
    pub renew: Option<Renew<'a>>,
    /// The instruction set.
    pub kernel: Kernel,
}

/// What evaluates the sources anew before a sweep.
pub type Renew<'a> = &'a dyn Fn(&Sweep, &mut Arrays);

/// U_p from which a time node begins: F of the first, p of the second, [p][6] both.
type Base<'a> = [&'a [F8]; 2];

/// dt times a row of a sweep's matrix; at most 7 time nodes.
type Row = [f64; 8];

impl<M: Material, C: Coefficient> Predictor<'_, M, C> {
    /// From `start` to the time averages `mean`, `mean_stress`.
    #[inline(always)]
    pub fn run<L: Lanes>(&self, arrays: &mut Arrays) {
        let (np, times) = (self.matrices.points(), self.weights.len());
        // One metric for all points turns P to the axes of the cell before it is differentiated: fewer products.
        let constant = (self.metric.len() == DEFORMATION).then(|| load_array::<L, DEFORMATION>(self.metric));
        let mut row = Row::default();
        for sweep in &self.sweeps.inner {
            self.renew(sweep, arrays);
            for s in 0..sweep.to {
                self.shift::<L>(arrays, &sweep.sources[s * times..(s + 1) * times]);
                let Arrays { start, shifted, rates: [before, _], q, .. } = arrays;
                let (start, momenta) = (&start[..UNKNOWNS * np], if shifted.is_empty() { &*start } else { &*shifted });
                let base = [start, &momenta[..UNKNOWNS * np]];
                self.row(&sweep.rates[s * sweep.from..(s + 1) * sweep.from], &mut row);
                let (rows, dt) = (&row[..sweep.from], sweep.tau[s] * self.dt);
                match constant {
                    Some(metric) => self.sample::<L>(base, before, rows, dt, Turned(metric), q),
                    None => self.sample::<L>(base, before, rows, dt, Plain, q),
                }
                if self.matrices.is_overdetermined() {
                    self.fit(arrays);
                }
                let Arrays { rates: [_, now], q, .. } = arrays;
                let (q, out) = (&q[..UNKNOWNS * np], &mut now[UNKNOWNS * np * s..UNKNOWNS * np * (s + 1)]);
                self.kernel.run(Rates { matrices: self.matrices, metric: self.metric, q, out });
            }
            let [before, now] = &mut arrays.rates;
            std::mem::swap(before, now);
        }
        self.renew(&self.sweeps.last, arrays);
        // Degree 1 by itself: all loops are unrolled.
        let last = &self.sweeps.last;
        match (np, last.from, last.to) {
            (4, 1, 2) => self.average::<L>(arrays, 4, [1, 2]),
            (np, from, to) => self.average::<L>(arrays, np, [from, to]),
        }
    }

    /// Sources with the velocity of the sweep before.
    #[inline(always)]
    fn renew(&self, sweep: &Sweep, arrays: &mut Arrays) {
        if let Some(renew) = self.renew.filter(|_| sweep.from > 0) {
            renew(sweep, arrays);
        }
    }

    /// Q <- G2P P2G Q.
    #[inline(always)]
    fn fit(&self, arrays: &mut Arrays) {
        let Arrays { q, between, fitted, .. } = arrays;
        let q = &mut q[..UNKNOWNS * self.matrices.points()];
        self.kernel.run(ToNodes::<C, UNKNOWNS> { matrices: self.matrices, points: q, between, nodes: fitted });
        self.kernel.run(ToPoints::<C, UNKNOWNS> { matrices: self.matrices, nodes: fitted, between, points: q });
    }

    /// dt times the entries of a row, into the first numbers of `out`. By loops of constant length: one of any length is
    /// compiled to masked stores, which the processor is slow to read back.
    #[inline(always)]
    fn row(&self, entries: &[f64], out: &mut Row) {
        match entries.len() {
            0 => {}
            1 => scaled::<1>(self.dt, entries, out),
            2 => scaled::<2>(self.dt, entries, out),
            3 => scaled::<3>(self.dt, entries, out),
            4 => scaled::<4>(self.dt, entries, out),
            5 => scaled::<5>(self.dt, entries, out),
            6 => scaled::<6>(self.dt, entries, out),
            _ => scaled::<7>(self.dt, entries, out),
        }
    }

    /// p^n + dt sum_k B[k] (rho0 b_k + dp/dt of the springs), where there are sources or springs. They add to p alone: rows of F are left.
    #[inline(always)]
    fn shift<L: Lanes>(&self, arrays: &mut Arrays, row: &[f64]) {
        if arrays.shifted.is_empty() {
            return;
        }
        let np = self.matrices.points();
        let mut sum = 0.0;
        for entry in row {
            sum += entry;
        }
        let factor = L::splat(self.dt * sum);
        let (start, shifted) = (arrays.start.as_chunks::<UNKNOWNS>().0, arrays.shifted.as_chunks_mut::<UNKNOWNS>().0);
        for p in 0..np {
            for k in DEFORMATION..UNKNOWNS {
                let mut u = L::load(&start[p][k]);
                if !arrays.held.is_empty() {
                    u = factor.mul_add(L::load(&arrays.held[AXES * p + k - DEFORMATION]), u);
                }
                u.store(&mut shifted[p][k]);
            }
        }
        if arrays.source.is_empty() {
            return;
        }
        for (k, entry) in row.iter().enumerate() {
            let factor = L::splat(self.dt * self.law.density() * entry);
            for p in 0..np {
                for i in 0..2 {
                    let (b, u) =
                        (&arrays.source[2 * (k * np + p) + i], &mut arrays.shifted[UNKNOWNS * p + DEFORMATION + i]);
                    factor.mul_add(L::load(b), L::load(u)).store(u);
                }
            }
        }
    }

    /// u = U^n + dt sum_k W[k] r_k at one time node, `dt` after t_n, and Q of it, from `base`: F^n of the first, p of the second. F and the
    /// law first, then v: together they would need more registers than there are.
    #[inline(always)]
    fn sample<L: Lanes>(&self, base: Base, before: &[F8], row: &[f64], dt: f64, turn: impl Turn<L>, q: &mut [F8]) {
        // Four points of the first sweep, as at degree 1, by themselves: all loops are unrolled.
        match (base[0].len(), row) {
            (24, []) => self.sample_of::<L>([&base[0][..24], &base[1][..24]], before, &[], dt, turn, q),
            _ => self.sample_of::<L>(base, before, row, dt, turn, q),
        }
    }

    /// [`Predictor::sample`] for lengths that may be constants.
    #[inline(always)]
    fn sample_of<L: Lanes>(&self, base: Base, before: &[F8], row: &[f64], dt: f64, turn: impl Turn<L>, q: &mut [F8]) {
        let [base, momenta] = [base[0].as_chunks::<UNKNOWNS>().0, base[1].as_chunks::<UNKNOWNS>().0];
        let (momenta, before) = (&momenta[..base.len()], before.as_chunks::<UNKNOWNS>().0);
        let q = &mut q.as_chunks_mut::<UNKNOWNS>().0[..base.len()];
        let twins = if count::<M>() == 0 { base.len() / 2 * 2 } else { 0 };
        let (pairs, rest) = q.split_at_mut(twins);
        for (pair, q) in pairs.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let p = 2 * pair;
            let f = lane::twins(
                state::<L, 0, DEFORMATION>(base, before, row, p),
                state::<L, 0, DEFORMATION>(base, before, row, p + 1),
            );
            let [one, two] = lane::apart(self.law.stress(f, &mut Past::now(virgin::<Twin<L>, M>())));
            put::<L>(turn.apply(one), &mut q[0]);
            put::<L>(turn.apply(two), &mut q[1]);
        }
        for (k, q) in rest.iter_mut().enumerate() {
            let f = state::<L, 0, DEFORMATION>(base, before, row, twins + k);
            let mut past = Past { history: recall::<L, M>(self.internal, twins + k), dt };
            put::<L>(turn.apply(self.law.stress(f, &mut past)), q);
        }
        let q = &mut q[..base.len()];
        let inverse_density = L::splat(1.0 / self.law.density());
        for (p, q) in q.iter_mut().enumerate() {
            let momentum = state::<L, DEFORMATION, AXES>(momenta, before, row, p);
            (momentum[0] * inverse_density).store(&mut q[2]);
            (momentum[1] * inverse_density).store(&mut q[3]);
        }
    }

    /// Time averages of F, v and P = P(F) over the time nodes, `to`, from `from` rates. That of u is linear in the rates.
    #[inline(always)]
    fn average<L: Lanes>(&self, arrays: &mut Arrays, np: usize, [from, to]: [usize; 2]) {
        let (sweeps, last) = (self.sweeps, &self.sweeps.last);
        let inverse_density = L::splat(1.0 / self.law.density());
        self.shift::<L>(arrays, &sweeps.mean_sources);
        let Arrays { start, shifted, rates: [before, _], mean, mean_stress, .. } = arrays;
        let base = if shifted.is_empty() { &*start } else { &*shifted };
        let (start, base, before) =
            (start.as_chunks::<UNKNOWNS>().0, base.as_chunks::<UNKNOWNS>().0, before.as_chunks::<UNKNOWNS>().0);
        let (start, base) = (&start[..np], &base[..np]);
        let (mut mean_row, mut rows) = (Row::default(), [Row::default(); 8]);
        self.row(&sweeps.mean_rates, &mut mean_row);
        for (s, row) in rows.iter_mut().enumerate().take(to) {
            self.row(&last.rates[s * from..(s + 1) * from], row);
        }
        for (p, mean) in mean.as_chunks_mut::<UNKNOWNS>().0[..np].iter_mut().enumerate() {
            let mut u = load_array::<L, UNKNOWNS>(&start[p]);
            (u[4], u[5]) = (L::load(&base[p][4]), L::load(&base[p][5]));
            let u = grown::<L, 0, UNKNOWNS>(u, before, &mean_row[..from], (p, np));
            store_array([u[0], u[1], u[2], u[3], u[4] * inverse_density, u[5] * inverse_density], mean);
        }
        // Two points at a time as in `sample`. Sources do not act on F: from U^n itself.
        let mean_stress = &mut mean_stress.as_chunks_mut::<DEFORMATION>().0[..np];
        let (rows, twins) = (&rows[..to], if count::<M>() == 0 { np / 2 * 2 } else { 0 });
        let (pairs, rest) = mean_stress.split_at_mut(twins);
        for (pair, mean_stress) in pairs.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let p = 2 * pair;
            let mut sum = [Twin::<L>::zero(); DEFORMATION];
            for (row, weight) in rows.iter().zip(self.weights) {
                let row = &row[..from];
                let f = lane::twins(
                    state::<L, 0, DEFORMATION>(start, before, row, p),
                    state::<L, 0, DEFORMATION>(start, before, row, p + 1),
                );
                add(*weight, self.law.stress(f, &mut Past::now(virgin::<Twin<L>, M>())), &mut sum);
            }
            let [one, two] = lane::apart(sum);
            store_array(one, &mut mean_stress[0]);
            store_array(two, &mut mean_stress[1]);
        }
        for (k, mean_stress) in rest.iter_mut().enumerate() {
            let (p, mut sum) = (twins + k, [L::zero(); DEFORMATION]);
            for ((row, weight), tau) in rows.iter().zip(self.weights).zip(&last.tau) {
                let f = state::<L, 0, DEFORMATION>(start, before, &row[..from], p);
                let mut past = Past { history: recall::<L, M>(self.internal, p), dt: tau * self.dt };
                add(*weight, self.law.stress(f, &mut past), &mut sum);
            }
            store_array(sum, mean_stress);
        }
    }
}

/// The first K numbers of `out`: a factor times those of `entries`.
#[inline(always)]
fn scaled<const K: usize>(factor: f64, entries: &[f64], out: &mut Row) {
    if let Some(entries) = entries.first_chunk::<K>() {
        for k in 0..K {
            out[k] = factor * entries[k];
        }
    }
}

/// sum += weight x.
#[inline(always)]
fn add<L: Lane>(weight: f64, x: [L; 4], sum: &mut [L; 4]) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum = L::splat(weight).mul_add(x, *sum);
    }
}

/// Fields FIRST to FIRST + K of base + sum_k row[k] r_k at point p.
#[inline(always)]
fn state<L: Lanes, const FIRST: usize, const K: usize>(
    base: &[[F8; UNKNOWNS]],
    before: &[[F8; UNKNOWNS]],
    row: &[f64],
    p: usize,
) -> [L; K] {
    grown::<L, FIRST, K>(load_array(&base[p][FIRST..]), before, row, (p, base.len()))
}

/// u + sum_k row[k] r_k at a point of `count`, fields as in [`state`].
#[inline(always)]
fn grown<L: Lanes, const FIRST: usize, const K: usize>(
    mut u: [L; K],
    before: &[[F8; UNKNOWNS]],
    row: &[f64],
    (p, count): (usize, usize),
) -> [L; K] {
    for (k, factor) in row.iter().enumerate() {
        let (factor, rate) = (L::splat(*factor), &before[k * count + p]);
        for i in 0..K {
            u[i] = factor.mul_add(L::load(&rate[FIRST + i]), u[i]);
        }
    }
    u
}

/// Puts what is differentiated of P where [`Rates`] wants it.
#[inline(always)]
fn put<L: Lanes>(stress: [L; 4], q: &mut [F8; UNKNOWNS]) {
    stress[0].store(&mut q[0]);
    stress[1].store(&mut q[1]);
    stress[2].store(&mut q[4]);
    stress[3].store(&mut q[5]);
}
