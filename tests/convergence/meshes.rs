//! The families of meshes: the periodic unit square, regular or distorted at every level, and a strip.

use dgmpm::parts::mesh::{Mesh, rectangle};
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
