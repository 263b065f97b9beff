//! F at the points of a block, and what the law makes of its internal variables there.

use super::history::recall;
use super::predictor::{self, transfer::FieldsToPoints};
use super::{Scheme, volume};
use crate::lane::{Coefficient, F8, Lanes, Work};
use crate::material::{Material, Numbers, Past, count};
use crate::operators::{PointMatrices, Share};
use crate::tensor::DEFORMATION;

/// F at `count` points: component k of point p at `point` p + `component` k.
pub(super) struct PointValues<'a> {
    f: &'a [F8],
    /// Number of points.
    pub count: usize,
    point: usize,
    component: usize,
}

impl PointValues<'_> {
    /// F at a point.
    #[inline(always)]
    pub fn at<L: Lanes>(&self, p: usize) -> [L; DEFORMATION] {
        let mut f = [L::zero(); DEFORMATION];
        for (k, f) in f.iter_mut().enumerate() {
            *f = L::load(&self.f[self.point * p + self.component * k]);
        }
        f
    }
}

/// F of the unknowns of a block at its points; at its nodes, where there are none.
#[inline(always)]
pub(super) fn at_points<'a, L: Lanes>(
    scheme: &Scheme,
    u: &'a [F8],
    block: usize,
    nodes: &mut volume::Arrays,
    arrays: &'a mut predictor::Arrays,
) -> PointValues<'a> {
    let n = scheme.operators.nodes();
    let Some(points) = &scheme.operators.points else {
        return PointValues { f: u, count: n, point: 1, component: n };
    };
    let (f, between) = (&mut arrays.start, &mut arrays.between);
    let (fields, nodes) = (&u[..DEFORMATION * n], &mut nodes.stage);
    let count = match points.pool.share[block] {
        Share::Shared(k) => to_points::<L, _>(&points.pool.shared[k], fields, nodes, between, f),
        Share::Own(k) => to_points::<L, _>(&points.pool.own[k], fields, nodes, between, f),
    };
    PointValues { f, count, point: DEFORMATION, component: 1 }
}

/// F at the points; the number of points.
#[inline(always)]
fn to_points<L: Lanes, C: Coefficient>(
    matrices: &PointMatrices<C>,
    fields: &[F8],
    nodes: &mut [F8],
    between: &mut [F8],
    points: &mut [F8],
) -> usize {
    FieldsToPoints::<C, DEFORMATION> { matrices, fields, nodes, between, points }.run::<L>();
    matrices.points()
}

/// h_(n+1) = law(F, h_n, dt) at all points.
#[inline(always)]
pub(super) fn remember<L: Lanes, M: Material>(law: M, points: &PointValues, before: &[F8], after: &mut [F8], dt: f64) {
    let variables = count::<M>();
    if variables == 0 {
        return;
    }
    for (p, after) in after.chunks_exact_mut(variables).enumerate() {
        let mut past = Past { history: recall::<L, M>(before, p), dt };
        law.stress(points.at::<L>(p), &mut past);
        for (value, after) in past.history.slice().iter().zip(after) {
            value.store(after);
        }
    }
}
