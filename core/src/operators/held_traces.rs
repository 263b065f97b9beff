//! The traces of the displacement whose jump is held, of cells that are not equal to their neighbours.
//!
//! The displacement that cells carry is their part of degree N of a smooth function. Its traces of degree N jump at a face by the rest,
//! which is of the order h^(N+1), and to hold that jump costs an order. Between equal parallelograms the traces of
//! [`super::Line::held`] do not jump. Elsewhere the rest is that of derivatives along other lines and of other lengths on either side; but the
//! two cells together know all derivatives of degree N + 1 as differences of their highest coefficients. So there each trace leaves out a
//! part of these, such that polynomials in X of degree N + 1 do not jump ([`Fit::traces`]). A linear function of u remains what is held, on either
//! side: any such traces keep the energy law.
//!
//! Between two laws the traces are those of equal cells, since u has a kink there; so they are at a boundary, where nothing is held.

use super::held_fit::Fit;
use super::{Blocks, Line, Neighbour};
use crate::lane::{F8, LANES};
use crate::mesh::map::CellMap;
use crate::mesh::{FACES, Mesh};
use rayon::prelude::*;

/// The place of a block of equal cells.
const EQUAL: u32 = u32::MAX;
/// Cells whose edges differ by less, over the largest of them, are equal.
const ROUNDING: f64 = 1e-10;

/// Traces of the blocks that have a cell which is not equal to a neighbour.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldTraces {
    /// The place of each block below, or `EQUAL`.
    place: Vec<u32>,
    /// The factors of the nodes, `[place][face][point][node]`, a lane a cell.
    factors: Vec<F8>,
    /// Numbers of a block.
    size: usize,
}

impl HeldTraces {
    /// The same for blocks in another order: place k has block `order[k]`.
    pub(super) fn in_order(self, order: &[usize]) -> Self {
        Self { place: order.iter().map(|&block| self.place[block]).collect(), ..self }
    }

    /// Those of a mesh; none where all cells are equal, and at degree 0, which holds nothing.
    pub fn of(mesh: &Mesh, blocks: &Blocks, line: &Line) -> Option<Self> {
        if line.m < 2 {
            return None;
        }
        let (fit, size) = (Fit::new(line), FACES * line.m.pow(3));
        let of_block = |block: usize| of_block(mesh, blocks, &fit, block);
        let all: Vec<Option<Vec<F8>>> = (0..blocks.len()).into_par_iter().map(of_block).collect();
        let mut out = Self { place: vec![], factors: vec![], size };
        for factors in all {
            out.place.push(if factors.is_some() { (out.factors.len() / size) as u32 } else { EQUAL });
            out.factors.extend(factors.into_iter().flatten());
        }
        (!out.factors.is_empty()).then_some(out)
    }

    /// Those of a block, `[face][point][node]`; none where its cells are equal to their neighbours.
    #[inline]
    pub fn block(&self, block: usize) -> Option<&[F8]> {
        let place = self.place[block];
        (place != EQUAL).then(|| &self.factors[place as usize * self.size..][..self.size])
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.place[..]) + size_of_val(&self.factors[..])
    }
}

/// The factors of a block; none where its cells are equal to their neighbours.
fn of_block(mesh: &Mesh, blocks: &Blocks, fit: &Fit, block: usize) -> Option<Vec<F8>> {
    let cell = |block: usize, lane: usize| mesh.map(blocks.cells[block][lane]);
    let unequal = |face: usize, lane: usize| match &blocks.neighbours[block][face][lane] {
        Neighbour::Cell(there) => {
            let (own, other) = (cell(block, lane), cell(there.face / FACES, there.lane));
            let is_equal = are_equal(&own, &other) && there.face % FACES == (face ^ 1);
            (!is_equal).then_some((own, other, there.face % FACES, there.flip))
        }
        Neighbour::Interface(..) | Neighbour::Boundary(_) | Neighbour::Padding => None,
    };
    let pairs: Vec<_> = (0..FACES * LANES).map(|k| unequal(k / LANES, k % LANES)).collect();
    if pairs.iter().all(Option::is_none) {
        return None;
    }
    let mut out = vec![];
    for (face, pairs) in pairs.chunks_exact(LANES).enumerate() {
        let of_lane = |(lane, pair): (usize, &Option<_>)| match pair {
            Some((own, other, there, flip)) => fit.traces((own, face, false), (other, *there, *flip)),
            None => fit.of_equal((&cell(block, lane), face, false)),
        };
        let lanes: Vec<Vec<f64>> = pairs.iter().enumerate().map(of_lane).collect();
        out.extend((0..lanes[0].len()).map(|k| F8(std::array::from_fn(|lane| lanes[lane][k]))));
    }
    Some(out)
}

/// Whether two cells are the same parallelogram, but for their places.
fn are_equal(one: &CellMap, two: &CellMap) -> bool {
    let edge = |cell: &CellMap, from: usize, to: usize| [0, 1].map(|i| cell.corners[to][i] - cell.corners[from][i]);
    let [a, b] = [edge(one, 0, 1), edge(one, 0, 3)];
    let near = |x: [f64; 2], y: [f64; 2]| {
        let size = a[0].hypot(a[1]).max(b[0].hypot(b[1]));
        (x[0] - y[0]).hypot(x[1] - y[1]) < ROUNDING * size
    };
    let is_straight = one.bulge.is_none() && two.bulge.is_none();
    is_straight
        && [(one, 3, 2, a), (two, 0, 1, a), (two, 3, 2, a), (two, 0, 3, b)]
            .iter()
            .all(|(cell, from, to, as_in)| near(edge(cell, *from, *to), *as_in))
}
