//! Pi: the locally curl-free projection of the rows of F, and what a control takes of F - Pi F (not in the paper;
//! `docs/method.md`).

use super::curl_core::Curl;
use super::matrix::{Matrix, Pool, Share, classes};
use super::{Blocks, Geometry, Line};
use crate::lane::{F8, LANES, prefetch};
use crate::mesh::Mesh;
use crate::mesh::map::{self, CellMap};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Pivots below this share of the largest count as rounding. The set of columns is rank-deficient by construction,
/// with ranks 5, 10, 17 of 8, 18, 32 on affine cells and 6, 12, 20 on others (N = 1, 2, 3).
const RANK_TOLERANCE: f64 = 1e-9;

/// Above this count of numbers in a block, the numbers of the next block are prefetched. Below it the processor
/// prefetches by itself: to prefetch the 55 of S2 costs 4 %; for the 153 of S3 and the 351 of S4 it gains 3 %.
const FEW: usize = 128;

/// C of all blocks.
pub type CurlPool = Pool<Matrix<f64>, Matrix<F8>>;

/// The complement of the gradients: F - Pi F = C (C^T W F), C of 2 (N+1)^2 rows (direction, node), W the mass matrix.
///
/// Pi projects (F_i1, F_i2) at the nodes, in the weights w_a J_a, onto the gradients of Q_N in parent coordinates and
/// of P_(N+1) in X. Uniform F and the cell mean are kept exactly. Units of C: 1/m. C is stored in the form that the
/// step uses.
#[derive(Debug, Clone, PartialEq)]
pub struct CurlFree {
    /// By class of congruent cells.
    pub pool: Pool<Class, Vec<F8>>,
    /// The tables that the cells of mixed blocks share. The pool has the [`Curl::core`] of each.
    pub curl: Curl,
}

/// C of congruent cells.
#[derive(Debug, Clone, PartialEq)]
pub enum Class {
    /// C itself, for any shape.
    Whole(Matrix<f64>),
    /// The two halves by parity, for parallelograms.
    Halves(Halves),
}

/// C C^T W of a parallelogram, by parity.
///
/// Half a turn about the middle takes a parallelogram to itself and node a to (N+1)^2 - 1 - a = a'. So the sums F_a +
/// F_a' and the differences F_a - F_a' of each pair of nodes are projected separately, by matrices of half the size, on
/// rows (direction, a), a up to the middle. These matrices are so small that one product is no more work than C^T W and
/// then C.
#[derive(Debug, Clone, PartialEq)]
pub struct Halves {
    /// Acts on F_a + F_a' of ((N+1)^2 + 1)/2 nodes; at the node in the middle, if there is one, on F itself.
    pub even: Matrix<f64>,
    /// Acts on F_a - F_a' of (N+1)^2/2 nodes.
    pub odd: Matrix<f64>,
}

impl CurlFree {
    /// From the matrices of all blocks.
    pub fn new(pool: CurlPool, mesh: &Mesh, blocks: &Blocks, line: &Line) -> Self {
        let curl = Curl::new(line);
        let masses = |cell: &CellMap| (0..line.m * line.m).map(|a| mass(cell, line, a)).collect::<Vec<_>>();
        let congruent = Congruent::of(mesh);
        let none = CellMap { corners: [[0.0; 2]; 4], bulge: None };
        let (mut example, mut mixed) = (vec![none; pool.shared.len()], vec![[0; LANES]; pool.own.len()]);
        for (share, cells) in pool.share.iter().zip(&blocks.cells) {
            match *share {
                Share::Shared(k) => example[k] = congruent.examples[congruent.class[cells[0]]],
                Share::Own(k) => mixed[k] = *cells,
            }
        }
        let class = |(c, cell): (Matrix<f64>, CellMap)| match Halves::of(&c, &masses(&cell)) {
            Some(halves) => Class::Halves(halves),
            None => Class::Whole(c),
        };
        let core = |(c, cells): (&Matrix<F8>, &[usize; LANES])| {
            let lanes: [Vec<f64>; LANES] = std::array::from_fn(|lane| {
                let c = Matrix::new(c.rows, c.columns, c.data.iter().map(|entry| entry.0[lane]).collect());
                let cell = mesh.map(cells[lane]);
                curl.core(&c, &cell, line, &masses(&cell))
            });
            (0..lanes[0].len()).map(|e| F8(lanes.each_ref().map(|lane| lane[e]))).collect()
        };
        let own = pool.own.par_iter().zip(&mixed).map(core).collect();
        let shared = pool.shared.into_iter().zip(example).map(class).collect();
        Self { pool: Pool { share: pool.share, shared, own }, curl }
    }

    /// Builds C for all blocks.
    pub fn matrices(mesh: &Mesh, blocks: &Blocks, line: &Line) -> CurlPool {
        let Congruent { class, examples } = Congruent::of(mesh);
        let all: Vec<_> = examples.par_iter().map(|cell| complement(cell, line)).collect();
        let columns = all.iter().map(|c| c.columns).max().unwrap_or(0);
        Pool::new(&blocks.cells, &class, all, |lanes| {
            let padded = lanes.map(|c| widen(c, columns));
            Matrix::interleave(padded.each_ref())
        })
    }

    /// F <- Pi F of the cell in a lane of a block: `f` as `[component][node]`. The step has its own, which works on eight cells.
    pub fn project(&self, line: &Line, geometry: &Geometry, [block, lane]: [usize; 2], f: &mut [f64]) {
        let masses: Vec<f64> = geometry.masses(line, block, lane).collect();
        match self.pool.share[block] {
            Share::Shared(k) => match &self.pool.shared[k] {
                Class::Whole(c) => project(c, &masses, f),
                Class::Halves(halves) => halves.project(f),
            },
            Share::Own(k) => {
                let core = |e: usize| self.pool.own[k][e].0[lane];
                self.curl.project(core, &geometry.map_of(block, lane), line, &masses, f);
            }
        }
    }

    /// Prefetches the matrices of a block, if the block has its own.
    #[inline]
    pub fn ask_for(&self, block: usize) {
        if let Some(&Share::Own(k)) = self.pool.share.get(block)
            && self.pool.own[k].len() > FEW
        {
            prefetch(&self.pool.own[k]);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let class = |class: &Class| match class {
            Class::Whole(c) => c.data.len() * 8,
            Class::Halves(halves) => (halves.even.data.len() + halves.odd.data.len()) * 8,
        };
        self.pool.shared.iter().map(class).sum::<usize>()
            + self.pool.own.iter().map(|core| core.len() * 64).sum::<usize>()
    }
}

/// Classes of cells that are congruent up to the rounding of the coordinates of their nodes.
struct Congruent {
    /// Of each cell.
    class: Vec<usize>,
    /// The cell that stands for each class, its first corner at the origin.
    examples: Vec<CellMap>,
}

impl Congruent {
    /// Cells are congruent whose edges agree to 1e-12 of the size of the mesh. The least of a class, number by number, stands for it:
    /// which one that is does not depend on the order of the cells.
    fn of(mesh: &Mesh) -> Self {
        let size = mesh.nodes.iter().flatten().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        let edges = |cell: usize| {
            let map = mesh.map(cell);
            map.moved(map.corners[0].map(|x| -x))
        };
        let rounded = |x: f64| (x / (size * 1e-12)).round() as i64;
        let key = |cell: usize| {
            let CellMap { corners, bulge } = edges(cell);
            (corners.map(|x| x.map(rounded)), bulge.map(|bulge| bulge.map(|d| d.map(rounded))))
        };
        let (class, first) = classes(mesh.cells.len(), key);
        let mut examples: Vec<_> = first.into_iter().map(edges).collect();
        for (cell, &class) in class.iter().enumerate() {
            let (least, own) = (&mut examples[class], edges(cell));
            let numbers =
                |map: &CellMap| [map.corners.as_flattened(), map.bulge.unwrap_or_default().as_flattened()].concat();
            let (ours, theirs) = (numbers(&own), numbers(least));
            let pairs = ours.iter().zip(&theirs);
            if pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).is_some_and(Ordering::is_lt) {
                *least = own;
            }
        }
        Self { class, examples }
    }
}

impl Halves {
    /// Subtracts from both rows of F their part that is no gradient.
    fn project(&self, f: &mut [f64]) {
        let (evens, odds) = (self.even.rows / 2, self.odd.rows / 2);
        let n = evens + odds;
        for row in f.chunks_exact_mut(2 * n) {
            let pair = |r: usize, nodes: usize| (r / nodes * n + r % nodes, r / nodes * n + (n - 1 - r % nodes));
            let part = |r: usize, nodes: usize, sign: f64| {
                let (one, two) = pair(r, nodes);
                if one == two { row[one] } else { row[one] + sign * row[two] }
            };
            let times = |matrix: &Matrix<f64>, nodes: usize, sign: f64| -> Vec<f64> {
                let parts: Vec<f64> = (0..2 * nodes).map(|r| part(r, nodes, sign)).collect();
                (0..2 * nodes).map(|r| matrix.row(r).iter().zip(&parts).map(|(m, p)| m * p).sum()).collect()
            };
            let (even, odd) = (times(&self.even, evens, 1.0), times(&self.odd, odds, -1.0));
            for (parts, nodes, sign) in [(even, evens, 1.0), (odd, odds, -1.0)] {
                for (r, part) in parts.into_iter().enumerate() {
                    let (one, two) = pair(r, nodes);
                    row[one] -= part;
                    if one != two {
                        row[two] -= sign * part;
                    }
                }
            }
        }
    }

    /// The two halves of a complement; `None` if half a turn changes the projection.
    fn of(c: &Matrix<f64>, masses: &[f64]) -> Option<Self> {
        let n = masses.len();
        let full = |r: usize, s: usize| {
            let products = c.row(r).iter().zip(c.row(s)).map(|(a, b)| a * b);
            products.sum::<f64>() * masses[s % n]
        };
        let turned = |r: usize| r / n * n + (n - 1 - r % n);
        // The entries of a projection are of order one.
        let same = |r: usize, s: usize| (full(r, s) - full(turned(r), turned(s))).abs() <= RANK_TOLERANCE;
        if !(0..2 * n).all(|r| (0..2 * n).all(|s| same(r, s))) {
            return None;
        }
        let half = |nodes: usize, sign: f64| {
            let row = |k: usize| k / nodes * n + k % nodes;
            let entry = |r: usize, s: usize| {
                let mean = |s: usize| 0.5 * (full(r, s) + sign * full(turned(r), s));
                if s == turned(s) { mean(s) } else { 0.5 * (mean(s) + sign * mean(turned(s))) }
            };
            let all = (0..2 * nodes).flat_map(|r| (0..2 * nodes).map(move |s| (r, s)));
            Matrix::new(2 * nodes, 2 * nodes, all.map(|(r, s)| entry(row(r), row(s))).collect())
        };
        Some(Self { even: half(n.div_ceil(2), 1.0), odd: half(n / 2, -1.0) })
    }
}

/// The part of R = F - Pi F that a control removes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relax {
    /// All of R. Pi is orthogonal in the mass matrix, not in the energy: it may turn rotations into strain, and so make
    /// energy out of nothing.
    Gradient,
    /// The rotation and the deviator of R, at a rate that follows the compression.
    Rotation,
}

/// Both rows of F (rows of C long) less C (C^T W F).
fn project(c: &Matrix<f64>, masses: &[f64], f: &mut [f64]) {
    for row in f.chunks_exact_mut(c.rows) {
        let mut coefficients = vec![0.0; c.columns];
        for (r, f) in row.iter().enumerate() {
            let weighted = masses[r % masses.len()] * f;
            coefficients.iter_mut().zip(c.row(r)).for_each(|(sum, entry)| *sum += entry * weighted);
        }
        for (r, f) in row.iter_mut().enumerate() {
            *f -= coefficients.iter().zip(c.row(r)).map(|(k, entry)| k * entry).sum::<f64>();
        }
    }
}

/// Adds zero columns up to `columns`, because cells of one block may have complements of different sizes.
fn widen(c: &Matrix<f64>, columns: usize) -> Matrix<f64> {
    let entry = |e: usize| c.row(e / columns).get(e % columns).copied().unwrap_or(0.0);
    Matrix::new(c.rows, columns, (0..c.rows * columns).map(entry).collect())
}

/// C of one cell: W^(-1/2) times an orthonormal basis of the complement of W^(1/2) times the gradients.
fn complement(corners: &CellMap, line: &Line) -> Matrix<f64> {
    let n = line.m * line.m;
    let root: Vec<f64> = (0..n).map(|a| mass(corners, line, a).sqrt()).collect();
    let gradients = gradients(corners, line);
    // Zero columns make it at least square, so that Q spans the whole space.
    let size = (2 * n).max(gradients.len());
    let mut matrix = DMatrix::zeros(2 * n, size);
    for (k, column) in gradients.iter().enumerate() {
        let weighted: Vec<f64> = column.iter().enumerate().map(|(r, g)| g * root[r % n]).collect();
        let norm = weighted.iter().map(|g| g * g).sum::<f64>().sqrt();
        for (r, g) in weighted.into_iter().enumerate() {
            matrix[(r, k)] = g / norm;
        }
    }
    let qr = matrix.col_piv_qr();
    let (u, r) = (qr.q(), qr.r());
    // Pivoted: the diagonal of R falls, and columns of Q behind the rank span the complement.
    let outside: Vec<usize> = (0..2 * n).filter(|&k| r[(k, k)].abs() <= RANK_TOLERANCE * r[(0, 0)].abs()).collect();
    let entries = (0..2 * n).flat_map(|r| outside.iter().map(move |&k| (r, k))).map(|(r, k)| u[(r, k)] / root[r % n]);
    Matrix::new(2 * n, outside.len(), entries.collect())
}

fn mass(corners: &CellMap, line: &Line, a: usize) -> f64 {
    line.basis.weight_2d(a) * map::determinant(&map::jacobian(corners, line.basis.node_2d(a)))
}

/// Columns [direction][node]: gradients in X of the monomials of Q_N in xi and of P_(N+1) in (X - Xc)/h.
///
/// In a curved cell the monomials beyond degree 1 are taken of the place that xi has in the cell of the same corners with straight
/// edges. Of X itself they would span nearly all fields (N = 3: 27 of 32), and little would be left to control: a periodic square of
/// curved cells at diag(.9, .9) grew by 2.4e-3 c/h at N = 3 and by 1.6e-4 at N = 2; so it does not grow.
fn gradients(cell: &CellMap, line: &Line) -> Vec<Vec<f64>> {
    let (m, centre, h) = (line.m as i32, map::position(cell, [0.5, 0.5]), map::h_e(cell));
    let nodes = line.nodes();
    let mut columns = Vec::new();
    for (i, j) in (0..m).flat_map(|i| (0..m).map(move |j| (i, j))).filter(|&(i, j)| i + j > 0) {
        columns.push(stack(nodes.iter().map(|&xi| {
            let inverse = map::inverse(&map::jacobian(cell, xi));
            // Monomials about the middle are better conditioned and span the same space.
            let g = monomial_gradient([xi[0] - 0.5, xi[1] - 0.5], i, j);
            [0, 1].map(|axis| g[0] * inverse[0][axis] + g[1] * inverse[1][axis])
        })));
    }
    for (i, j) in (0..=m).flat_map(|i| (0..=m - i).map(move |j| (i, j))).filter(|&(i, j)| i + j > 0) {
        columns.push(stack(nodes.iter().map(|&xi| {
            if cell.bulge.is_some() && i + j > 1 {
                return pulled(cell, xi, |x| monomial_gradient([(x[0] - centre[0]) / h, (x[1] - centre[1]) / h], i, j));
            }
            let x = map::position(cell, xi);
            monomial_gradient([(x[0] - centre[0]) / h, (x[1] - centre[1]) / h], i, j)
        })));
    }
    columns
}

/// The gradient in X of a function of the place that xi has in the cell with straight edges; `gradient` is that in this place.
fn pulled(cell: &CellMap, xi: [f64; 2], gradient: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let g = gradient(map::position(&cell.corners, xi));
    let (straight, inverse) = (map::jacobian(&cell.corners, xi), map::inverse(&map::jacobian(cell, xi)));
    let along = [0, 1].map(|b| g[0] * straight[0][b] + g[1] * straight[1][b]);
    [0, 1].map(|axis| along[0] * inverse[0][axis] + along[1] * inverse[1][axis])
}

fn stack(gradients: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
    let (first, second): (Vec<f64>, Vec<f64>) = gradients.map(|g| (g[0], g[1])).unzip();
    [first, second].concat()
}

/// Gradient of x^i y^j.
fn monomial_gradient(x: [f64; 2], i: i32, j: i32) -> [f64; 2] {
    let slope = |x: f64, k: i32| if k == 0 { 0.0 } else { k as f64 * x.powi(k - 1) };
    [slope(x[0], i) * x[1].powi(j), x[0].powi(i) * slope(x[1], j)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{BoundaryEdge, links, rectangle};

    /// Eight cells: parallelograms, equal trapezoids apart from each other, all different, or all curved.
    fn mesh(kind: usize) -> Mesh {
        let mut mesh = rectangle([4.0, 2.0], [4, 2]).unwrap();
        if kind == 1 {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.2], [0.0, 0.8]];
            mesh.nodes = (0..32)
                .map(|k| [2.0 * f64::from(k / 4) + corners[k as usize % 4][0], corners[k as usize % 4][1]])
                .collect();
            mesh.cells = (0..8).map(|cell| [0, 1, 2, 3].map(|k| 4 * cell + k)).collect();
            mesh.edges = (0..32).map(|k| BoundaryEdge { cell: k / 4, face: k % 4, group: 0 }).collect();
            return mesh;
        }
        let place = |x: [f64; 2]| match kind {
            0 => [x[0] + 0.3 * x[1], 0.7 * x[1]],
            _ => [1e-3 * (x[0] + 0.2 * (5.0 * x[1]).sin()), 1e-3 * (x[1] + 0.2 * (3.0 * x[0]).cos())],
        };
        mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
        if kind == 3 {
            let bulge = |k: usize| [[1e-4, 0.0], [0.0, 5e-5], [0.0, -1e-4], [2e-5, 1e-5 * k as f64], [3e-5, 0.0]];
            mesh.bulges = (0..8).map(bulge).collect();
        }
        mesh
    }

    #[test]
    fn every_form_of_the_projection_is_that_of_the_complement() {
        for kind in 0..4 {
            let mesh = mesh(kind);
            let congruent = Congruent::of(&mesh);
            let mut worst = 0.0f64;
            for degree in 1..=6 {
                let line = Line::new(degree);
                let blocks = Blocks::new(&[0; 8], &links(&mesh).unwrap());
                let geometry = Geometry::new(&mesh, &blocks, &line);
                let all = CurlFree::new(CurlFree::matrices(&mesh, &blocks, &line), &mesh, &blocks, &line);
                let is = match &all.pool.shared[..] {
                    [Class::Halves(_)] => 0,
                    [Class::Whole(_)] => 1,
                    _ => 2,
                };
                assert_eq!(is, kind.min(2));
                for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
                    let masses: Vec<f64> = geometry.masses(&line, block, lane).collect();
                    let mut f: Vec<f64> = (0..4 * masses.len()).map(|k| ((7 * k + cell) as f64).sin()).collect();
                    let mut expected = f.clone();
                    // Equal cells have the complement of one. (At S6 that of others differs by 1e-9: the smallest of the
                    // pivots that count are 1e-7 of the largest.)
                    let example = &congruent.examples[congruent.class[cell]];
                    project(&complement(example, &line), &masses, &mut expected);
                    all.project(&line, &geometry, [block, lane], &mut f);
                    for (f, expected) in f.iter().zip(&expected) {
                        worst = worst.max((f - expected).abs());
                    }
                }
            }
            // Derivatives of degree 6 are up to 60 times their function: measured 6e-14.
            assert!(worst < 2e-13, "{kind}: {worst:e}");
        }
    }
}
