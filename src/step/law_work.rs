//! Work on a block that is written once for all laws.

use crate::lane::Lanes;
use crate::material::Material;

/// A piece of work on a block that is written once for all laws and lanes. Implementations mark `run` `#[inline(always)]`.
pub(super) trait LawWork {
    /// What it returns.
    type Out;
    /// Does the work. The law is a copy: what the work stores cannot change it, so that its constants stay in registers.
    fn run<L: Lanes, M: Material>(self, law: M) -> Self::Out;
}
