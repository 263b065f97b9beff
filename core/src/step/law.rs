//! The law of a block: chosen once a block and phase, by one dynamic call behind which all is compiled for that law.

use super::begin::Predict;
use super::block_energy::StoredEnergy;
use super::block_work::WithLaw;
use super::law_cost::LawCost;
use super::rotation::Power;
use super::stage::AtNodes;
use super::survey::Examine;
use super::volume::Speeds;
use crate::lane::{F8, Kernel};
use crate::material::{Material, PointLaw};
use std::sync::Arc;

/// A law, of the crate or from outside: any [`Material`].
///
/// At a point it says what a [`PointLaw`] says.
#[derive(Debug, Clone)]
pub struct Law(Arc<dyn BlockLaw>);

impl Law {
    /// From its type. A law of this crate is compiled already: `Law::from(NeoHookean::new(..))`.
    pub fn new<M: Material>(law: M) -> Self {
        const { assert!(crate::material::is_declared_whole::<M>(), "HISTORY has other numbers than History") };
        Self(Arc::new(law))
    }

    /// For whole blocks.
    #[inline]
    pub(super) fn block(&self) -> &dyn BlockLaw {
        &*self.0
    }
}

impl std::ops::Deref for Law {
    type Target = dyn PointLaw;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

/// All that a step asks of a law, a block at a time.
pub(super) trait BlockLaw: PointLaw {
    /// The predictor, on matrices that several blocks share.
    fn predict_shared(&self, kernel: Kernel, work: Predict<f64>);
    /// The predictor, on matrices of each cell.
    fn predict_own(&self, kernel: Kernel, work: Predict<F8>);
    /// A Runge-Kutta stage at the nodes.
    fn stage(&self, kernel: Kernel, work: AtNodes);
    /// The wave speeds of the traces; whether a J there is not above 0.
    fn speeds_of_traces(&self, kernel: Kernel, work: Speeds) -> bool;
    /// The survey.
    fn examine(&self, kernel: Kernel, work: Examine);
    /// The kinetic, stored and dissipated energy.
    fn stored_energy(&self, kernel: Kernel, work: StoredEnergy) -> [F8; 3];
    /// The power of a change of F.
    fn power(&self, kernel: Kernel, work: Power) -> F8;
    /// What it costs at a point.
    fn cost(&self) -> LawCost;
}

impl<M: Material> BlockLaw for M {
    fn predict_shared(&self, kernel: Kernel, work: Predict<f64>) {
        kernel.run(WithLaw(*self, work));
    }

    fn predict_own(&self, kernel: Kernel, work: Predict<F8>) {
        kernel.run(WithLaw(*self, work));
    }

    fn stage(&self, kernel: Kernel, work: AtNodes) {
        kernel.run(WithLaw(*self, work));
    }

    fn speeds_of_traces(&self, kernel: Kernel, work: Speeds) -> bool {
        kernel.run(WithLaw(*self, work))
    }

    fn examine(&self, kernel: Kernel, work: Examine) {
        kernel.run(WithLaw(*self, work));
    }

    fn stored_energy(&self, kernel: Kernel, work: StoredEnergy) -> [F8; 3] {
        kernel.run(WithLaw(*self, work))
    }

    fn power(&self, kernel: Kernel, work: Power) -> F8 {
        kernel.run(WithLaw(*self, work))
    }

    fn cost(&self) -> LawCost {
        LawCost::of(self)
    }
}
