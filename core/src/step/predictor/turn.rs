//! P as it is differentiated: in the axes of the cell, or as it is.

use crate::lane::Lanes;

/// From P to what is differentiated along xi1 (first two) and xi2.
pub(super) trait Turn<L>: Copy {
    /// [along xi1 of row 1, of row 2, along xi2 of row 1, of row 2].
    fn apply(self, stress: [L; 4]) -> [L; 4];
}

/// dxi_b/dX_a P_ia, with the same metric [b][a] at all points.
#[derive(Clone, Copy)]
pub(super) struct Turned<L>(pub [L; 4]);

impl<L: Lanes> Turn<L> for Turned<L> {
    #[inline(always)]
    fn apply(self, p: [L; 4]) -> [L; 4] {
        let m = self.0;
        [
            m[0].mul_add(p[0], m[1] * p[1]),
            m[0].mul_add(p[2], m[1] * p[3]),
            m[2].mul_add(p[0], m[3] * p[1]),
            m[2].mul_add(p[2], m[3] * p[3]),
        ]
    }
}

/// P_i1, P_i2.
#[derive(Clone, Copy)]
pub(super) struct Plain;

impl<L: Lanes> Turn<L> for Plain {
    #[inline(always)]
    fn apply(self, p: [L; 4]) -> [L; 4] {
        [p[0], p[2], p[1], p[3]]
    }
}
