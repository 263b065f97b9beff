//! The interface flux of a block: chosen once a block, by one dynamic call behind which all is compiled for that flux.

use super::block_work::WithFlux;
use super::face_balance::FaceBalance;
use super::flux::{Faces, SpecialFaces};
use crate::lane::Kernel;
use crate::riemann::{Looks, Riemann};
use crate::state::UNKNOWNS;
use crate::tensor::AXES;
use std::sync::Arc;

/// The flux (3) of faces between cells of one law, of the crate or from outside: any [`Riemann`].
#[derive(Debug, Clone)]
pub struct Flux(Arc<dyn BlockFlux>);

impl Flux {
    /// From its type. A flux of this crate is compiled already: `Flux::from(Dual)`.
    pub fn new<R: Riemann>(flux: R) -> Self {
        Self(Arc::new(flux))
    }

    /// What it looks at beside F, v, t and c_p.
    #[inline]
    pub fn looks(&self) -> Looks {
        self.0.looks()
    }

    /// Components of the state that it needs: with the displacement where it looks at it.
    pub fn components(&self) -> usize {
        if self.looks() == Looks::Displacement { UNKNOWNS + AXES } else { UNKNOWNS }
    }

    /// For whole blocks.
    #[inline]
    pub(super) fn block(&self) -> &dyn BlockFlux {
        &*self.0
    }
}

/// All that a step asks of a flux, a block at a time.
pub(super) trait BlockFlux: std::fmt::Debug + Send + Sync {
    /// See [`Riemann::LOOKS`].
    fn looks(&self) -> Looks;
    /// The lifted fluxes of the four faces.
    fn faces(&self, kernel: Kernel, work: Faces);
    /// The same of a block with springs or curved cells.
    fn special_faces(&self, kernel: Kernel, work: SpecialFaces);
    /// What a face adds to the balance of energy.
    fn face_balance(&self, kernel: Kernel, work: FaceBalance);
}

impl<R: Riemann> BlockFlux for R {
    fn looks(&self) -> Looks {
        R::LOOKS
    }

    fn faces(&self, kernel: Kernel, work: Faces) {
        kernel.run(WithFlux(*self, work));
    }

    fn special_faces(&self, kernel: Kernel, work: SpecialFaces) {
        kernel.run(WithFlux(*self, work));
    }

    fn face_balance(&self, kernel: Kernel, work: FaceBalance) {
        kernel.run(WithFlux(*self, work));
    }
}
