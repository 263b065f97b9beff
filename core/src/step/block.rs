//! A block in a stage of a step: what all phases ask for.

use super::volume::Masses;
use super::{Law, Scheme, Stage};
use crate::lane::F8;
use crate::operators::{BlockMetric, Points, with_nodes};
use crate::riemann::Medium;
use crate::state::State;

/// A block in a stage.
#[derive(Clone, Copy)]
pub(super) struct Block<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The stage.
    pub stage: &'a Stage<'a>,
    /// The number of the block.
    pub number: usize,
}

impl<'a> Block<'a> {
    /// Its metric terms.
    #[inline]
    pub fn metric(&self) -> BlockMetric<'a> {
        self.scheme.operators.geometry.of(self.number)
    }

    /// The factors of its traces of the displacement, [face][point][node]; none of a block of equal cells.
    #[inline]
    pub fn held_traces(&self) -> Option<&'a [F8]> {
        self.scheme.operators.held_traces.as_ref()?.block(self.number)
    }

    /// The number of its material.
    #[inline]
    pub fn material(&self) -> usize {
        self.scheme.operators.blocks.material[self.number]
    }

    /// Its law.
    #[inline]
    pub fn law(&self) -> &'a Law {
        &self.scheme.laws[self.material()]
    }

    /// What its cells are made of.
    #[inline]
    pub fn medium(&self) -> Medium<f64> {
        self.scheme.media[self.material()]
    }

    /// What [`Medium::turn`] is of the change of v, summed over both sides, from the first to the last point of a face.
    pub fn turning(&self) -> f64 {
        let nodes = &self.scheme.operators.line.basis.nodes;
        0.5 / (nodes[nodes.len() - 1] - nodes[0])
    }

    /// Its lanes that are cells, not padding.
    #[inline]
    pub fn cells(&self) -> usize {
        self.scheme.operators.blocks.count[self.number]
    }

    /// The material points of the body; none where the nodes take their place.
    #[inline]
    pub fn points(&self) -> Option<&'a Points> {
        self.scheme.operators.points.as_ref()
    }

    /// Its unknowns in a state, [component][node].
    #[inline]
    pub fn unknowns<'s>(&self, state: &'s State) -> &'s [F8] {
        state.of_block(self.number, self.scheme.operators.nodes())
    }

    /// Its internal variables in a state.
    #[inline]
    pub fn internal<'s>(&self, state: &'s State) -> &'s [F8] {
        self.scheme.histories.of(state, self.number)
    }

    /// dt b_s: what the rate of the stage counts in the step.
    #[inline]
    pub fn factor(&self) -> f64 {
        self.stage.dt * self.scheme.weight(self.stage.number)
    }

    /// Finds w_a J_a, its mass matrix.
    pub fn find_masses(&self, masses: &mut [F8]) {
        let (line, metric) = (&self.scheme.operators.line, self.metric());
        with_nodes!(line.m, M => { self.scheme.kernel.run(Masses::<'_, M> { line, metric, masses }); });
    }
}
