//! A problem on another grid, and how fields are weighted on the way.

use super::Body;
use crate::regrid::Transfer;
use crate::regrid::points::Placed;
use crate::state::State;
use crate::step::Scheme;

/// A problem on another grid.
pub struct Moved {
    /// Mesh and points.
    pub body: Body,
    /// The scheme.
    pub scheme: Scheme,
    /// The state.
    pub state: State,
    /// How the fields came over.
    pub transfer: Transfer,
    /// What became of the points.
    pub placed: Placed,
}

/// The weights of the standard error: |F|^2 + |v|^2 / c_p^2 with the speed of the unstrained material.
pub(super) fn scale(scheme: &Scheme) -> Vec<[f64; 8]> {
    let of = |law: &crate::step::Law| {
        let [c_p, _] = law.largest_speeds([1.0, 0.0, 0.0, 1.0], &law.virgin());
        let p = (law.density() * c_p).powi(-2);
        [1.0, 1.0, 1.0, 1.0, p, p, 0.0, 0.0]
    };
    scheme.laws.iter().map(of).collect()
}
