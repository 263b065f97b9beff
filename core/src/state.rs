//! The unknowns, and nothing else: what a checkpoint holds.

use crate::lane::F8;
use crate::operators::Blocks;
use crate::tensor::{AXES, DEFORMATION};

/// Components of U = (F11, F12, F21, F22, p1, p2).
pub const UNKNOWNS: usize = DEFORMATION + AXES;

/// What the body has received through a boundary group since its run began, per metre of thickness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Received {
    /// int t* dS dt, N s/m.
    pub impulse: [f64; AXES],
    /// int t*.v* dS dt, J/m.
    pub work: f64,
}

/// Which blocks of the body a state has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Part {
    /// Whether it is a part: the blocks of one of several ranks, which follow each other.
    pub is_part: bool,
    /// Its first block.
    pub block: usize,
    /// The place of the first of its internal variables among those of the whole body.
    pub internal: usize,
}

/// The grid unknowns at the Gauss nodes, the master copy between steps.
///
/// Layout: `[block][component][node]`, node a = i M + j with i along xi1. Components are the six of U and, where an
/// output asks for it or the flux holds its jumps ([`crate::riemann::hold`]), the displacement u1, u2 (m): du/dt = v.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Time t, s.
    pub time: f64,
    /// Number of steps done.
    pub step: usize,
    /// 6, or 8 with displacement.
    pub components: usize,
    /// The blocks of [`State::u`], [`State::internal`] and [`State::creep`]; the rest is of the whole body always.
    pub part: Part,
    /// The numbers.
    pub u: Vec<F8>,
    /// Internal variables of blocks whose law has some, `[block][point][variable]` at the points where the law is evaluated
    /// between steps ([`crate::step::Histories`]); empty where no law has any.
    pub internal: Vec<F8>,
    /// The memory of boundary conditions ([`crate::boundary::Boundary::memory`]); empty where none has any.
    pub boundary: Vec<f64>,
    /// The displacement that a grid of this run began with, `[block][component][node]`, whose jumps are not held: they are those of
    /// the projection. Empty on the first grid.
    pub unheld: Vec<F8>,
    /// The creep of face points ([`crate::riemann::creep`]), `[block][face][point][2]`, m; empty where no springs are asked for.
    pub creep: Vec<F8>,
    /// By boundary group of the mesh, then by contact pair ([`crate::step::Scheme::receivers`]); empty where nobody asks for it ([`crate::step::Motion::with_forces`]).
    pub received: Vec<Received>,
}

/// A component of a body at rest.
fn rest(component: usize) -> f64 {
    if component == 0 || component == 3 { 1.0 } else { 0.0 }
}

impl State {
    /// At rest: F = 1, p = 0.
    pub fn at_rest(blocks: &Blocks, nodes: usize, components: usize) -> Self {
        let block = (0..components * nodes).map(|k| F8::splat(rest(k / nodes)));
        let u = (0..blocks.len()).flat_map(|_| block.clone());
        let mut all = Vec::with_capacity(blocks.len() * components * nodes);
        all.extend(u);
        Self { components, u: all, ..Self::default() }
    }

    /// From numbers per cell, `[cell][component][node]`; padding lanes rest at F = 1, p = 0.
    pub fn pack(blocks: &Blocks, nodes: usize, components: usize, cells: &[f64]) -> Self {
        Self {
            time: 0.0,
            step: 0,
            components,
            part: Part::default(),
            u: blocks.pack(cells, components * nodes, |k| rest(k / nodes)),
            internal: vec![],
            boundary: vec![],
            unheld: vec![],
            creep: vec![],
            received: vec![],
        }
    }

    /// With the jumps of the displacement that are held on another grid: those that come from now on, or, where all its cells are
    /// copies in the same order, those of `before`.
    pub fn holding(mut self, before: &State, same: &[Option<usize>], nodes: usize) -> Self {
        if same.iter().enumerate().all(|(cell, same)| *same == Some(cell)) {
            self.unheld.clone_from(&before.unheld);
            return self;
        }
        self.holding_from_now(nodes)
    }

    /// With jumps of the displacement held from now on.
    pub fn holding_from_now(mut self, nodes: usize) -> Self {
        if self.has_displacement() {
            let cells = self.u.chunks_exact(self.components * nodes);
            self.unheld = cells.flat_map(|cell| &cell[UNKNOWNS * nodes..]).copied().collect();
        }
        self
    }

    /// The unknowns of a block with so many nodes a cell, `[component][node]`.
    #[inline]
    pub fn of_block(&self, block: usize, nodes: usize) -> &[F8] {
        let (stride, at) = (self.components * nodes, block - self.part.block);
        &self.u[stride * at..stride * (at + 1)]
    }

    /// Numbers per cell, `[cell][component][node]`.
    pub fn unpack(&self, blocks: &Blocks, nodes: usize) -> Vec<f64> {
        blocks.unpack(&self.u, self.components * nodes)
    }

    /// Whether the displacement is integrated.
    pub fn has_displacement(&self) -> bool {
        self.components > UNKNOWNS
    }
}
