//! Work on a block that is written once for all laws, or for all fluxes.

use crate::lane::{Lanes, Work};
use crate::material::Material;
use crate::riemann::Riemann;

/// A piece of work on a block that is written once for all laws and lanes. Implementations mark `run` `#[inline(always)]`.
pub(super) trait LawWork {
    /// What it returns.
    type Out;
    /// Does the work. The law is a copy: what the work stores cannot change it, so that its constants stay in registers.
    fn run<L: Lanes, M: Material>(self, law: M) -> Self::Out;
}

/// The same for all fluxes.
pub(super) trait FluxWork {
    /// Does the work.
    fn run<L: Lanes, R: Riemann>(self, riemann: &R);
}

/// A piece of work with its law.
pub(super) struct WithLaw<M, W>(pub M, pub W);

impl<M: Material, W: LawWork> Work for WithLaw<M, W> {
    type Out = W::Out;
    #[inline(always)]
    fn run<L: Lanes>(self) -> W::Out {
        self.1.run::<L, M>(self.0)
    }
}

/// A piece of work with its flux.
pub(super) struct WithFlux<R, W>(pub R, pub W);

impl<R: Riemann, W: FluxWork> Work for WithFlux<R, W> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.1.run::<L, R>(&self.0);
    }
}
