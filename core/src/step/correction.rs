//! Corrections: what changes the new state after the pass over all blocks, as limiters and dampings do.
//!
//! A correction sees the whole new state, as it is before the correction has changed any block; what it makes of a block does
//! not depend on the order of the blocks or on the number of threads. The blocks that it changed are surveyed anew. A scheme
//! without corrections does no sweep and holds no memory for them.

mod act;
mod anew;

pub use act::Counts;
pub(super) use act::{Blocks, Memory};

use super::Scheme;
use crate::lane::F8;
use crate::state::State;

/// Changes some blocks of a new state.
pub trait Correction: Send + Sync {
    /// The name, as printed.
    fn name(&self) -> &str;

    /// Whether it acts after each stage of Runge-Kutta, too: on U = U^n + dt sum_j a_ij k_j before the rates of the stage are found
    /// from it. (The stages then wait for each other on all blocks, which is slower. What is changed in a stage does not enter
    /// the sums of later stages, only their rates.)
    fn after_stages(&self) -> bool {
        false
    }

    /// Whether the internal variables of changed cells are found anew from those before the step, h_(n+1) = law(F, h_n, dt), with
    /// the F that the correction leaves. For corrections that change F.
    fn renews_internal(&self) -> bool {
        false
    }

    /// How many numbers it notes of each block, see [`Notes`].
    fn numbers(&self, _scheme: &Scheme) -> usize {
        0
    }

    /// Looks at the whole state before any block is changed, and notes what [`Correction::applies`] and [`Correction::correct`] will
    /// read in [`Made::notes`]. Nothing by default.
    fn look(&self, _made: &Made, _notes: &mut Notes) {}

    /// Whether it has to change a block.
    fn applies(&self, made: &Made, block: usize) -> bool;

    /// Changes a block to which it applies. What the law has made of the internal variables stays unless it is changed here, or
    /// [`Correction::renews_internal`].
    fn correct(&self, made: &Made, block: &mut Corrected);
}

/// What a correction notes of the whole state. The memory is made once; the numbers are those of the time before.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Notes {
    /// A bit for each lane of each block, as `1 << lane`: `[block]`.
    pub marked: Vec<u8>,
    /// Numbers of each block: `[block][number]`, see [`Correction::numbers`].
    pub numbers: Vec<F8>,
}

/// A state that a step, or a stage of it, has made of all blocks.
#[derive(Clone, Copy)]
pub struct Made<'a> {
    /// The scheme, with mesh, neighbours, laws.
    pub scheme: &'a Scheme,
    /// The state before the step.
    pub before: &'a State,
    /// The state before this correction.
    pub state: &'a State,
    /// What the correction has noted of that state; empty while it looks.
    pub notes: &'a Notes,
    /// Step, s.
    pub dt: f64,
    /// The stage of Runge-Kutta that begins with the state; none at the end of the step.
    pub stage: Option<usize>,
}

impl<'a> Made<'a> {
    /// The unknowns of a block, `[component][node]`.
    pub fn unknowns(&self, block: usize) -> &'a [F8] {
        self.state.of_block(block, self.scheme.operators.nodes())
    }

    /// The internal variables of a block, `[point][variable]`.
    pub fn internal(&self, block: usize) -> &'a [F8] {
        self.scheme.histories.of(self.state, block)
    }
}

/// A block that a correction changes: the numbers of [`Made`] to begin with.
pub struct Corrected<'a> {
    /// Its number.
    pub number: usize,
    /// Its unknowns, `[component][node]`.
    pub u: &'a mut [F8],
    /// Its internal variables, `[point][variable]`.
    pub internal: &'a mut [F8],
    /// The lanes that the correction has changed, as `1 << lane`: all, unless it says otherwise. For what counts them.
    pub changed: u8,
}

#[cfg(test)]
mod tests;
