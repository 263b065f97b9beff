//! Internal variables: where they lie in a state, how a step ends for them, and their order by cell.
//!
//! They stand at the points where the law is evaluated between steps, the material points of a block or (ADER-DGFEM,
//! RK-DGFEM) its nodes, and are never projected. The predictor and every stage integrate the law from their values h_n at
//! the start of the step, without storing what comes out; the step ends with h_(n+1) = law(F_p^(n+1), h_n).

use super::Law;
use super::Scheme;
use crate::cloud::Cloud;
use crate::lane::{F8, LANES, Lanes};
use crate::material::{Material, Numbers, count, virgin};
use crate::operators::{Operators, Share};
use crate::state::State;
use std::ops::Range;

/// Where the internal variables of each block lie in [`State::internal`], `[point][variable]`. Nothing where no law has
/// any.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Histories {
    /// By block (length: blocks + 1).
    first: Vec<usize>,
    /// int chi_p dX over the cell for the points of each block with memory, m^2, see [`Histories::weights`].
    weights: Vec<F8>,
    /// Where the points of each block begin in `weights`.
    first_point: Vec<usize>,
}

impl Histories {
    /// Those of the blocks of `operators` under these laws.
    pub fn new(operators: &Operators, laws: &[Law]) -> Self {
        if laws.iter().all(|law| !law.has_memory()) {
            return Self::default();
        }
        let mut out = Self { first: vec![0], weights: vec![], first_point: vec![0] };
        for (block, &material) in operators.blocks.material.iter().enumerate() {
            let variables = laws[material].history_len();
            out.first.push(out.first[block] + variables * operators.block_points(block));
            if variables > 0 {
                out.weights.extend(weights_of_block(operators, block));
            }
            out.first_point.push(out.weights.len());
        }
        out
    }

    /// Whether no law has memory.
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Numbers of a state.
    pub fn len(&self) -> usize {
        self.first.last().copied().unwrap_or(0)
    }

    /// Where those of a block lie; nowhere for an elastic one.
    #[inline]
    pub fn range(&self, block: usize) -> Range<usize> {
        between(&self.first, block)
    }

    /// Those of a block in a state, none for an elastic one.
    #[inline]
    pub fn of<'a>(&self, state: &'a State, block: usize) -> &'a [F8] {
        let Range { start, end } = self.range(block);
        // An elastic block among others lies before the first number, too.
        if start == end { &[] } else { &state.internal[start - state.part.internal..end - state.part.internal] }
    }

    /// Where those from a block on begin, also behind the last block.
    pub(super) fn start(&self, block: usize) -> usize {
        self.first.get(block).copied().unwrap_or(0)
    }

    /// w_p = int chi_p dX over the cell, m^2, for the points of a block; none for an elastic one. The integral over a cell of
    /// what is known at the points alone, since f = sum_p chi_p f_p is what the grid sees of it: exact for the full Q_N. They
    /// are of either sign where the points lie far from the nodes.
    #[inline]
    pub(super) fn weights(&self, block: usize) -> &[F8] {
        &self.weights[between(&self.first_point, block)]
    }
}

/// What belongs to a block, where the beginnings of all blocks and the end of the last are known; nothing where the list is
/// empty.
#[inline]
pub(super) fn between(first: &[usize], block: usize) -> Range<usize> {
    match first.get(block..block + 2) {
        Some(&[from, to]) => from..to,
        _ => 0..0,
    }
}

/// The point of `points` that is nearest to `xi`, in parent coordinates; the first of those that are equally near.
pub fn nearest(points: impl Iterator<Item = [f64; 2]>, xi: [f64; 2]) -> usize {
    let distance = |p: [f64; 2]| (p[0] - xi[0]).powi(2) + (p[1] - xi[1]).powi(2);
    let closer = |best: (usize, f64), (index, p): (usize, [f64; 2])| {
        let d = distance(p);
        if d < best.1 { (index, d) } else { best }
    };
    points.enumerate().fold((0, f64::INFINITY), closer).0
}

/// The [`Histories::weights`] of a block: the masses, where its points are the nodes.
fn weights_of_block(operators: &Operators, block: usize) -> Vec<F8> {
    let mut masses = vec![F8::ZERO; operators.nodes()];
    for lane in 0..LANES {
        let of_lane = operators.geometry.masses(&operators.line, block, lane);
        masses.iter_mut().zip(of_lane).for_each(|(out, mass)| out.0[lane] = mass);
    }
    match operators.points.as_ref().map(|points| (&points.pool, points.pool.share[block])) {
        None => masses,
        Some((pool, Share::Shared(k))) => pool.shared[k].integrals(&masses),
        Some((pool, Share::Own(k))) => pool.own[k].integrals(&masses),
    }
}

/// The internal variables of a point of a block, for a law.
#[inline(always)]
pub fn recall<L: Lanes, M: Material>(block: &[F8], point: usize) -> M::History<L> {
    let mut out = virgin::<L, M>();
    let count = count::<M>();
    for (out, stored) in out.slice_mut().iter_mut().zip(&block[count * point..][..count]) {
        *out = L::load(stored);
    }
    out
}

impl Scheme {
    /// The internal variables of a point of a lane; what virgin material has, where the law has none.
    pub fn internal_at(&self, state: &State, block: usize, lane: usize, point: usize) -> Vec<f64> {
        let law = &self.laws[self.operators.blocks.material[block]];
        let mut out = law.virgin();
        let count = law.history_len();
        let own = self.histories.of(state, block);
        for (out, stored) in out.iter_mut().zip(own.iter().skip(count * point).take(count)) {
            *out = stored.0[lane];
        }
        out
    }

    /// Where internal variables stand: the points of each cell, in the order of the mesh and the cloud.
    pub fn places(&self) -> Cloud {
        let mut out = Cloud { first: vec![0], xi: vec![] };
        for &(block, lane) in &self.operators.blocks.slot {
            out.xi.extend(self.operators.places(block, lane));
            out.first.push(out.xi.len());
        }
        out
    }

    /// All internal variables: for each cell in the order of the mesh and each of its points in the order of the cloud
    /// (ADER-DGFEM, RK-DGFEM: of the nodes) those of the cell's law, none for elastic ones.
    pub fn internal_of(&self, state: &State) -> Vec<f64> {
        let mut numbers = 0;
        self.each_point(|_, _, _, count| numbers += count);
        let mut out = Vec::with_capacity(numbers);
        self.each_point(|block, lane, point, count| {
            out.extend_from_slice(&self.internal_at(state, block, lane, point)[..count]);
        });
        out
    }

    /// The inverse of [`Scheme::internal_of`]; what is missing in `values` is virgin.
    pub fn set_internal(&self, state: &mut State, values: &[f64]) {
        state.internal = vec![F8::ZERO; self.histories.len()];
        for block in 0..if self.histories.is_empty() { 0 } else { self.operators.blocks.len() } {
            let virgin = self.laws[self.operators.blocks.material[block]].virgin();
            let count = self.laws[self.operators.blocks.material[block]].history_len();
            let range = self.histories.first[block]..self.histories.first[block + 1];
            state.internal[range].iter_mut().enumerate().for_each(|(k, out)| *out = F8::splat(virgin[k % count]));
        }
        let mut next = values.iter();
        self.each_point(|block, lane, point, count| {
            let first = self.histories.first[block] + point * count;
            for (out, value) in state.internal[first..first + count].iter_mut().zip(next.by_ref()) {
                out.0[lane] = *value;
            }
        });
        self.pad(state);
    }

    /// The internal variables of virgin material, in the order of [`Scheme::internal_of`].
    pub fn virgin_internal(&self) -> Vec<f64> {
        let mut out = Vec::new();
        self.each_point(|block, _, _, count| {
            out.extend_from_slice(&self.laws[self.operators.blocks.material[block]].virgin()[..count]);
        });
        out
    }

    /// Calls `visit(block, lane, point, variables)` for each point of a cell with memory, cells in the order of the mesh.
    fn each_point(&self, mut visit: impl FnMut(usize, usize, usize, usize)) {
        if self.histories.is_empty() {
            return;
        }
        for &(block, lane) in &self.operators.blocks.slot {
            let count = self.laws[self.operators.blocks.material[block]].history_len();
            let points = match &self.operators.points {
                Some(points) => points.count[block][lane] as usize,
                None => self.operators.nodes(),
            };
            (0..if count > 0 { points } else { 0 }).for_each(|point| visit(block, lane, point, count));
        }
    }

    /// Points that fill up a lane are copies of its first, and so are their internal variables.
    fn pad(&self, state: &mut State) {
        let Some(points) = &self.operators.points else { return };
        for block in 0..self.histories.first.len().saturating_sub(1) {
            let count = self.laws[self.operators.blocks.material[block]].history_len();
            let own = &mut state.internal[self.histories.first[block]..self.histories.first[block + 1]];
            for (lane, &real) in points.count[block].iter().enumerate() {
                (real as usize * count..own.len()).for_each(|at| own[at].0[lane] = own[at % count].0[lane]);
            }
        }
    }
}
