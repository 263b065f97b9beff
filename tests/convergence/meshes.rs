//! The families of meshes: the periodic unit square, regular or distorted at every level, and a strip.

use dgmpm::parts::mesh::{Mesh, map, rectangle};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// A family of meshes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grid {
    /// Equal squares.
    Squares,
    /// The nodes of each odd row stand .3 h above and below it in turn: trapezoids at every level, so that cells do not
    /// become parallelograms under refinement. Needs even numbers of cells.
    Trapezoids,
    /// Each node stands anywhere in a disc of radius .2 h about its place, by its own random numbers at every level:
    /// no mesh is nested in another. Both ends of a row, and of a column, move alike.
    Random,
    /// The smooth image (x + .05 sin(2 pi y), y + .05 sin(2 pi x)) of the squares, by cells of 9 nodes: all edges are curved.
    Curved,
    /// Squares whose edges and middles bulge anywhere by up to .1 h.
    Bulging,
    /// Equal squares in one row along 0 <= X <= 3, not periodic.
    Strip,
}

impl Grid {
    /// The mesh with so many cells per direction.
    pub fn mesh(self, cells: usize) -> Mesh {
        let h = 1.0 / cells as f64;
        let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
        let shifts = match self {
            Grid::Squares => return mesh,
            Grid::Strip => return rectangle([3.0, 3.0 * h], [cells, 1]).unwrap(),
            Grid::Trapezoids => trapezoids(cells),
            Grid::Random => discs(cells),
            Grid::Curved => return curved(cells),
            Grid::Bulging => return bulging(cells),
        };
        for (node, x) in mesh.nodes.iter_mut().enumerate() {
            let (i, j) = (node % (cells + 1) % cells, node / (cells + 1) % cells);
            let shift = shifts[i + cells * j];
            *x = [x[0] + h * shift[0], x[1] + h * shift[1]];
        }
        mesh
    }
}

/// Moves in units of h of the cells x cells different nodes of the periodic square.
fn trapezoids(cells: usize) -> Vec<[f64; 2]> {
    let up = |i: usize, j: usize| 0.3 * [[0.0, 0.0], [1.0, -1.0]][j % 2][i % 2];
    (0..cells * cells).map(|k| [0.0, up(k % cells, k / cells)]).collect()
}

/// The mesh of cells of 9 nodes on the image of the squares.
fn curved(cells: usize) -> Mesh {
    let place = |x: [f64; 2]| [x[0] + 0.05 * (TAU * x[1]).sin(), x[1] + 0.05 * (TAU * x[0]).sin()];
    let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
    let flat = mesh.clone();
    mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
    let bulge = |cell: usize| {
        let [a, b, c, d, own] = map::middles(&flat.map(cell)).map(place);
        map::bulge_of(&mesh.corners(cell), [a, b, c, d], Some(own)).unwrap_or_default()
    };
    let bulges = (0..mesh.cells.len()).map(bulge).collect();
    Mesh { bulges, ..mesh }
}

/// Opposite sides bulge alike, so that the square stays periodic.
fn bulging(cells: usize) -> Mesh {
    let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
    let (h, moves) = (1.0 / cells as f64, discs(2 * cells));
    // Three vectors of each cell, at most .1 h long: of its left edge, its lower edge and its middle.
    let of = |which: usize, i: usize, j: usize| {
        let at = 4 * (i % cells + cells * (j % cells)) + which;
        moves[at].map(|x| 0.5 * h * x)
    };
    let bulge = |cell: usize| {
        let (i, j) = (cell % cells, cell / cells);
        [of(0, i, j), of(0, i + 1, j), of(1, i, j), of(1, i, j + 1), of(2, i, j)]
    };
    mesh.bulges = (0..cells * cells).map(bulge).collect();
    mesh.checked().unwrap()
}

fn discs(cells: usize) -> Vec<[f64; 2]> {
    let mut random = ChaCha8Rng::seed_from_u64(cells as u64);
    let mut uniform = || (random.next_u64() >> 11) as f64 * 2f64.powi(-53);
    let mut disc = || {
        // The root makes it even over the area.
        let ((sine, cosine), radius) = ((TAU * uniform()).sin_cos(), 0.2 * uniform().sqrt());
        [radius * cosine, radius * sine]
    };
    (0..cells * cells).map(|_| disc()).collect()
}
