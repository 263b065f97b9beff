//! The work that the outside does on the body in a step: metered in every run, since it is known at boundary points and in
//! cells with sources at next to no cost.

use super::balance::add;
use super::{Scheme, Work};
use crate::lane::{F8, Lanes, Work as Kernel, load_array};
use crate::operators::Neighbour;
use crate::tensor::dot;

/// Work on the cells of a block in a step, J/m, a lane a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Given {
    /// int t*.v* over boundary and time.
    pub boundary: F8,
    /// int rho0 b.v over cell and time.
    pub source: F8,
    /// int b dt, m/s, b the mean of a source over the cell.
    pub impulse: [F8; 2],
}

/// A stage of the work of sources: their mean over the cell into the impulse, and the rest, b - mean b, with the velocity of the
/// stage into the work.
pub(super) struct SourceStage<'a> {
    /// rho0.
    pub density: f64,
    /// dt b_i of the stage.
    pub factor: f64,
    /// By node.
    pub masses: &'a [F8],
    /// [node][6] with v behind F.
    pub mean: &'a [F8],
    /// b, [2][node].
    pub source: &'a [F8],
    /// Out.
    pub given: &'a mut Given,
}

impl SourceStage<'_> {
    /// Adds it.
    #[inline(always)]
    pub fn add<L: Lanes>(self) {
        let n = self.masses.len();
        let (mut all, mut sum, mut momentum, mut power) = (L::zero(), [L::zero(); 2], [L::zero(); 2], L::zero());
        for (a, mass) in self.masses.iter().enumerate() {
            let (mass, b) = (L::load(mass), [L::load(&self.source[a]), L::load(&self.source[n + a])]);
            let v = load_array::<L, 2>(&self.mean[6 * a + 4..6 * a + 6]);
            all = all + mass;
            power = mass.mul_add(dot(b, v), power);
            for k in 0..2 {
                sum[k] = mass.mul_add(b[k], sum[k]);
                momentum[k] = mass.mul_add(v[k], momentum[k]);
            }
        }
        let (factor, inverse) = (L::splat(self.factor), L::splat(1.0) / all);
        let b = [sum[0] * inverse, sum[1] * inverse];
        add(factor * L::splat(self.density), power - dot(b, momentum), &mut self.given.source);
        (0..2).for_each(|k| add(factor, b[k], &mut self.given.impulse[k]));
    }
}

/// The rest of the work of sources at the end of a step: the impulse with the mean of the momenta before and after. It is what a
/// uniform source gives to the kinetic energy, exactly: the averages of ADER's predictor, which does not see the neighbours,
/// would miss it by what the faces correct.
pub(super) struct SourceEnd<'a> {
    /// By node.
    pub masses: &'a [F8],
    /// Momenta before the step, [2][node].
    pub before: &'a [F8],
    /// And after.
    pub after: &'a [F8],
    /// Out.
    pub given: &'a mut Given,
}

impl Kernel for SourceEnd<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = self.masses.len();
        for k in 0..2 {
            let mut sum = L::zero();
            for (a, mass) in self.masses.iter().enumerate() {
                let momenta = L::load(&self.before[k * n + a]) + L::load(&self.after[k * n + a]);
                sum = L::load(mass).mul_add(momenta, sum);
            }
            add(L::splat(0.5) * L::load(&self.given.impulse[k]), sum, &mut self.given.source);
        }
    }
}

/// That of all blocks on which something outside acts; the others have no entry.
pub(super) struct Outside {
    /// Entries before each block (length: blocks + 1).
    pub first: Vec<u32>,
    /// The cells of the block of each entry.
    cells: Vec<usize>,
    /// The entries.
    pub given: Vec<Given>,
}

impl Outside {
    /// No work on any block of a scheme yet.
    pub fn new(scheme: &Scheme) -> Self {
        let blocks = &scheme.operators.blocks;
        let mut out = Self { first: vec![0], cells: vec![], given: vec![] };
        for (faces, &count) in blocks.neighbours.iter().zip(&blocks.count) {
            let at_boundary = faces.iter().flatten().any(|beyond| matches!(beyond, Neighbour::Boundary(_)));
            if at_boundary || !scheme.sources.is_empty() {
                out.cells.push(count);
            }
            out.first.push(out.cells.len() as u32);
        }
        out.given = vec![Given::default(); out.cells.len()];
        out
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..]) + size_of_val(&self.cells[..]) + size_of_val(&self.given[..])
    }
}

/// The entry of a block among `given`, those of the blocks from `start` on.
#[inline]
pub(super) fn entry<'a>(first: &[u32], start: usize, given: &'a mut [Given], block: usize) -> Option<&'a mut Given> {
    let (from, to) = (first[block], first[block + 1]);
    if from == to { None } else { given.get_mut((from - first[start]) as usize) }
}

impl Work {
    /// The work of the boundary and of sources in the last step, J/m, cells in a fixed order.
    pub fn given(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (given, &cells) in self.outside.given.iter().zip(&self.outside.cells) {
            sum[0] += given.boundary.0[..cells].iter().sum::<f64>();
            sum[1] += given.source.0[..cells].iter().sum::<f64>();
        }
        sum
    }
}
