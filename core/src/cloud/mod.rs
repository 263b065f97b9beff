//! The cloud of material points, sorted by cell.

pub mod body;
pub mod locate;
mod near;
pub mod seed;
mod walk;

pub use body::Pattern;
pub use locate::{Locator, Outside, from_points};
pub use near::{Tree, trees};
pub use seed::{Layout, default_layout, seed, seed_by};

/// Material points: for each cell a run of points with their parent coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// Points of cell c are `first[c]..first[c + 1]` (length: cells + 1).
    pub first: Vec<usize>,
    /// Parent coordinates xi in [0, 1]^2 of each point.
    pub xi: Vec<[f64; 2]>,
}

impl Cloud {
    /// The cloud of the cells 0..`cells`; `push` appends the points of a cell.
    pub fn of_cells(cells: usize, mut push: impl FnMut(usize, &mut Vec<[f64; 2]>)) -> Self {
        let mut cloud = Self { first: vec![0], xi: Vec::new() };
        for cell in 0..cells {
            push(cell, &mut cloud.xi);
            cloud.first.push(cloud.xi.len());
        }
        cloud
    }

    /// Parent coordinates of the points of a cell.
    pub fn of(&self, cell: usize) -> &[[f64; 2]] {
        &self.xi[self.first[cell]..self.first[cell + 1]]
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.xi.len()
    }

    /// Whether there is no point at all.
    pub fn is_empty(&self) -> bool {
        self.xi.is_empty()
    }
}
