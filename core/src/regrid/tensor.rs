//! The projection between two grids of axis-aligned rectangles, by products of 1D matrices, without clipping.

use super::nodal::{Nodal, Values, combine, gather, scatter, spread};
use super::{Field, Grid, Share};
use crate::basis::Lagrange;
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// Lines that are nearer to each other than this part of the extent count as one line, because coordinates are rounded.
const SAME_LINE: f64 = 1e-13;

/// A mesh that is the product of two lists of lines.
#[derive(Debug, Clone)]
pub struct TensorGrid {
    /// x and y of the lines, rising, in m.
    pub lines: [Vec<f64>; 2],
    /// The cell between lines ix, ix + 1 and iy, iy + 1 at `ix + nx iy`.
    cells: Vec<usize>,
    /// For each cell its number ix + nx iy.
    place: Vec<usize>,
    /// For each cell the number of its lower left corner.
    turn: Vec<u8>,
}

impl TensorGrid {
    /// The lines of a mesh; `None` if the mesh is no such grid.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        let lines = [0, 1].map(|axis| lines(mesh, axis));
        let [nx, ny] = [lines[0].len().checked_sub(1)?, lines[1].len().checked_sub(1)?];
        if nx.checked_mul(ny)? != mesh.cells.len() || mesh.curved_cells() > 0 {
            return None;
        }
        let slack = [0, 1].map(|axis| slack(&lines[axis]));
        let find = |axis: usize, x: f64| {
            let k = lines[axis].partition_point(|line| *line < x - slack[axis]);
            lines[axis].get(k).is_some_and(|line| (line - x).abs() <= slack[axis]).then_some(k)
        };
        let mut out = Self { cells: vec![usize::MAX; nx * ny], place: vec![], turn: vec![], lines: [vec![], vec![]] };
        for cell in 0..mesh.cells.len() {
            let corners = mesh.corners(cell);
            let mut at = [[0; 2]; 4];
            for (at, x) in at.iter_mut().zip(corners) {
                *at = [find(0, x[0])?, find(1, x[1])?];
            }
            let turn = (0..4).find(|&k| {
                let [x, y] = at[k];
                [1, 2, 3].map(|step| at[(k + step) % 4]) == [[x + 1, y], [x + 1, y + 1], [x, y + 1]]
            })?;
            let place = at[turn][0] + nx * at[turn][1];
            if std::mem::replace(&mut out.cells[place], cell) != usize::MAX {
                return None;
            }
            out.place.push(place);
            out.turn.push(turn as u8);
        }
        out.lines = lines;
        Some(out)
    }

    /// Whether both grids fill the same rectangle.
    pub fn covers(&self, other: &Self) -> bool {
        (0..2).all(|axis| {
            let ends = |lines: &[f64]| [lines[0], lines[lines.len() - 1]];
            let (a, b) = (ends(&self.lines[axis]), ends(&other.lines[axis]));
            (0..2).all(|k| (a[k] - b[k]).abs() <= slack(&self.lines[axis]))
        })
    }

    /// ix and iy of a cell.
    fn at(&self, cell: usize) -> [usize; 2] {
        let nx = self.lines[0].len() - 1;
        [self.place[cell] % nx, self.place[cell] / nx]
    }

    fn cell(&self, at: [usize; 2]) -> usize {
        self.cells[at[0] + (self.lines[0].len() - 1) * at[1]]
    }

    /// The node of a cell that stands i-th along x and j-th along y (a = i M + j).
    fn node<const M: usize>(&self, cell: usize, a: usize) -> usize {
        let (i, j) = (a / M, a % M);
        match self.turn[cell] {
            0 => a,
            // Corner 1 is the lower left one: xi1 runs against y, xi2 along x.
            1 => (M - 1 - j) * M + i,
            2 => (M - 1 - i) * M + (M - 1 - j),
            _ => j * M + (M - 1 - i),
        }
    }
}

fn slack(lines: &[f64]) -> f64 {
    SAME_LINE * lines.iter().fold(0.0_f64, |far, x| far.max(x.abs()))
}

fn lines(mesh: &Mesh, axis: usize) -> Vec<f64> {
    let mut all: Vec<f64> = mesh.cells.iter().flatten().map(|&node| mesh.nodes[node][axis]).collect();
    all.sort_unstable_by(f64::total_cmp);
    let near = slack(&all);
    all.dedup_by(|b, a| *b - *a <= near);
    all
}

/// The common part of a new interval and an old interval.
#[derive(Debug, Clone)]
struct Overlap<const M: usize> {
    old: usize,
    /// Weights of M Gauss points on the common part, over the length of the new interval.
    weight: [f64; M],
    /// l_b of the old interval at these points.
    old_at: [[f64; M]; M],
    /// l_a of the new interval at these points.
    new_at: [[f64; M]; M],
}

/// For each new interval its common parts with old intervals. M points are exact for products of degree 2 M - 1.
fn overlaps<const M: usize>(nodal: &Nodal<M>, basis: &Lagrange, old: &[f64], new: &[f64]) -> Vec<Vec<Overlap<M>>> {
    let near = slack(old);
    let of = |ends: &[f64]| {
        let (a, h) = (ends[0], ends[1] - ends[0]);
        let first = old.partition_point(|x| *x <= a + near).saturating_sub(1);
        let mut found = Vec::new();
        for k in first..old.len() - 1 {
            let (c, l) = (old[k], old[k + 1] - old[k]);
            let (low, high) = (a.max(c), ends[1].min(old[k + 1]));
            if high - low <= near {
                if c >= ends[1] {
                    break;
                }
                continue;
            }
            // First relative to the interval: if both intervals are equal, both get the nodes of the basis, to the bit.
            let inside = |start: f64, length: f64, q: usize| {
                ((low - start) / length + (high - low) / length * basis.nodes[q]).clamp(0.0, 1.0)
            };
            found.push(Overlap {
                old: k,
                weight: std::array::from_fn(|q| (high - low) / h * basis.weights[q]),
                old_at: std::array::from_fn(|q| nodal.at(inside(c, l, q))),
                new_at: std::array::from_fn(|q| nodal.at(inside(a, h, q))),
            });
        }
        found
    };
    new.windows(2).map(of).collect()
}

/// Projects `field` onto the new cells that `same` does not name. Fills `u` and gives each cell's share of the error.
/// `None` if one of the two is no such grid, or if they do not fill the same rectangle with the same materials.
pub(super) fn project<const M: usize>(
    old: &Grid,
    new: &Grid,
    field: &Field,
    same: &[Option<usize>],
    u: &mut [f64],
) -> Option<Vec<Share>> {
    let (from, to) = (TensorGrid::of(old.mesh)?, TensorGrid::of(new.mesh)?);
    if !from.covers(&to) {
        return None;
    }
    let nodal = Nodal::<M>::new(field.basis);
    let along = [0, 1].map(|axis| overlaps(&nodal, field.basis, &from.lines[axis], &to.lines[axis]));
    let job = Job { from: &from, to: &to, along: &along, old, new, field };
    let cells: Vec<usize> = (0..same.len()).filter(|&cell| same[cell].is_none()).collect();
    if !cells.par_iter().all(|&cell| job.is_one_material(cell)) {
        return None;
    }
    let stride = field.components * M * M;
    let shares = u.par_chunks_exact_mut(stride).enumerate().map(|(cell, u)| match same[cell] {
        Some(twin) => {
            u.copy_from_slice(&field.u[stride * twin..stride * (twin + 1)]);
            Share::default()
        }
        None => job.cell(cell, u),
    });
    Some(shares.collect())
}

struct Job<'a, const M: usize> {
    from: &'a TensorGrid,
    to: &'a TensorGrid,
    along: &'a [Vec<Vec<Overlap<M>>>; 2],
    old: &'a Grid<'a>,
    new: &'a Grid<'a>,
    field: &'a Field<'a>,
}

impl<const M: usize> Job<'_, M> {
    /// Pairs of overlaps of a new cell, with the old cell of each.
    fn pairs(&self, cell: usize) -> impl Iterator<Item = (usize, &Overlap<M>, &Overlap<M>)> {
        let [ix, iy] = self.to.at(cell);
        let (xs, ys) = (&self.along[0][ix], &self.along[1][iy]);
        xs.iter().flat_map(move |x| ys.iter().map(move |y| (self.from.cell([x.old, y.old]), x, y)))
    }

    fn is_one_material(&self, cell: usize) -> bool {
        self.pairs(cell).all(|(twin, _, _)| self.old.material[twin] == self.new.material[cell])
    }

    /// sum over old cells of int Phi_a U_old over the common part, over the mass w_a J; then int |U_new - U_old|^2.
    fn cell(&self, cell: usize, u: &mut [f64]) -> Share {
        let stride = self.field.components * M * M;
        let mut values = [[[0.0; 8]; M]; M];
        let unknowns =
            |old: usize| gather::<M>(&self.field.u[stride * old..stride * (old + 1)], |a| self.from.node::<M>(old, a));
        for (old, x, y) in self.pairs(cell) {
            let there = unknowns(old);
            for (q, r) in (0..M).flat_map(|q| (0..M).map(move |r| (q, r))) {
                let value = combine(&there, &x.old_at[q], &y.old_at[r]);
                let value = value.map(|v| x.weight[q] * y.weight[r] * v);
                spread(&value, &x.new_at[q], &y.new_at[r], &mut values);
            }
        }
        let weights = &self.field.basis.weights;
        for (i, j) in (0..M).flat_map(|i| (0..M).map(move |j| (i, j))) {
            let mass = weights[i] * weights[j];
            values[i][j].iter_mut().for_each(|v| *v /= mass);
        }
        let scale = &self.field.scale[self.new.material[cell]];
        let mut share = Share::default();
        for (old, x, y) in self.pairs(cell) {
            let there = unknowns(old);
            for (q, r) in (0..M).flat_map(|q| (0..M).map(move |r| (q, r))) {
                let before = combine(&there, &x.old_at[q], &y.old_at[r]);
                let after = combine(&values, &x.new_at[q], &y.new_at[r]);
                share.add(x.weight[q] * y.weight[r], &before, &after, scale);
            }
        }
        scatter::<M>(&values, |a| self.to.node::<M>(cell, a), u);
        share.times(map::area(&self.new.mesh.map(cell)))
    }
}

impl Share {
    /// Adds the squared distance of two values, weighted by component.
    #[inline(always)]
    pub(super) fn add(&mut self, weight: f64, before: &Values, after: &Values, scale: &Values) {
        let mut sum = 0.0;
        for k in 0..8 {
            let gap = before[k] - after[k];
            sum += scale[k] * gap * gap;
        }
        self.error += weight * sum;
    }

    fn times(mut self, factor: f64) -> Self {
        self.error *= factor;
        self
    }
}
