//! How well the cells are shaped, for reports and refusals.

use std::fmt;

use super::{Mesh, map};

/// The shape of one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Scaled Jacobian: min of det / (|a| |b|) over the corners, of a curved cell over all of it; 1 for rectangles, 0 or less for
    /// singular cells.
    pub scaled_jacobian: f64,
    /// The length of design and time step, [`map::h_e`], in m.
    pub h_e: f64,
    /// Area, in m^2.
    pub area: f64,
    /// Longest edge over shortest edge.
    pub aspect: f64,
}

/// det / (|a| |b|) at a place of a cell, a and b the tangents dX/dxi1 and dX/dxi2.
pub fn scaled_jacobian(cell: &impl map::Map, xi: [f64; 2]) -> f64 {
    let j = map::jacobian(cell, xi);
    map::determinant(&j) / (j[0][0].hypot(j[1][0]) * j[0][1].hypot(j[1][1]))
}

/// Steps a direction in which a curved cell is looked at for its smallest det, which is of degree 3 in each direction.
const STEPS: i32 = 32;

/// The smallest det / (|a| |b|) of a cell, and where: at its corners, or of a curved cell anywhere.
pub fn smallest_scaled_jacobian(cell: &impl map::Map) -> (f64, [f64; 2]) {
    let steps = if cell.bulge().is_some() { STEPS } else { 1 };
    let at = |k: i32| f64::from(k) / f64::from(steps);
    let places = (0..=steps).flat_map(|i| (0..=steps).map(move |j| [at(i), at(j)]));
    let scaled = places.map(|xi| (scaled_jacobian(cell, xi), xi));
    // NaN is the smallest, which no check passes.
    scaled.reduce(|a, b| if a.0 <= b.0 || a.0.is_nan() { a } else { b }).unwrap_or((f64::NAN, [0.0; 2]))
}

/// det / (|a| |b|) at each corner, a and b the edges that leave it.
pub fn corner_jacobians(cell: &impl map::Map) -> [f64; 4] {
    map::CORNER_XI.map(|xi| scaled_jacobian(cell, xi))
}

/// The shape of a cell.
pub fn shape(cell: &impl map::Map) -> Shape {
    let lengths: [f64; 4] = std::array::from_fn(|k| {
        let (a, b) = (cell.corners()[k], cell.corners()[(k + 1) % 4]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    });
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
    Shape {
        scaled_jacobian: smallest_scaled_jacobian(cell).0,
        h_e: map::h_e(cell),
        area: map::area(cell),
        aspect: longest / shortest,
    }
}

/// The worst and the mean of all cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// The smallest scaled Jacobian and its cell.
    pub scaled_jacobian: (f64, usize),
    /// The mean of the scaled Jacobians.
    pub mean_scaled_jacobian: f64,
    /// The smallest h_e and its cell, in m.
    pub smallest_h_e: (f64, usize),
    /// The largest h_e and its cell, in m.
    pub largest_h_e: (f64, usize),
    /// The largest aspect and its cell.
    pub aspect: (f64, usize),
    /// The area of the mesh, in m^2.
    pub area: f64,
}

impl Quality {
    /// The quality of a mesh. For an empty mesh the figures are infinite and 0.
    pub fn of(mesh: &Mesh) -> Self {
        let mut quality = Quality {
            scaled_jacobian: (f64::INFINITY, 0),
            mean_scaled_jacobian: 0.0,
            smallest_h_e: (f64::INFINITY, 0),
            largest_h_e: (0.0, 0),
            aspect: (0.0, 0),
            area: 0.0,
        };
        for cell in 0..mesh.cells.len() {
            quality.take(cell, &shape(&mesh.map(cell)));
        }
        quality.mean_scaled_jacobian /= mesh.cells.len().max(1) as f64;
        quality
    }

    fn take(&mut self, cell: usize, shape: &Shape) {
        let lower = |kept: &mut (f64, usize), value: f64| {
            if value < kept.0 {
                *kept = (value, cell);
            }
        };
        lower(&mut self.scaled_jacobian, shape.scaled_jacobian);
        lower(&mut self.smallest_h_e, shape.h_e);
        let higher = |kept: &mut (f64, usize), value: f64| {
            if value > kept.0 {
                *kept = (value, cell);
            }
        };
        higher(&mut self.largest_h_e, shape.h_e);
        higher(&mut self.aspect, shape.aspect);
        self.mean_scaled_jacobian += shape.scaled_jacobian;
        self.area += shape.area;
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "scaled Jacobian {:.4} (cell {}), mean {:.4}; h {:.4e} (cell {}) to {:.4e} m (cell {}); aspect up to {:.3} (cell {}); area {:.6e} m^2",
            self.scaled_jacobian.0,
            self.scaled_jacobian.1,
            self.mean_scaled_jacobian,
            self.smallest_h_e.0,
            self.smallest_h_e.1,
            self.largest_h_e.0,
            self.largest_h_e.1,
            self.aspect.0,
            self.aspect.1,
            self.area,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    #[test]
    fn rectangles_have_scaled_jacobian_one() {
        let quality = Quality::of(&rectangle([3.0, 1.0], [3, 4]).unwrap());
        assert_eq!(quality.scaled_jacobian.0, 1.0);
        // Twelve cells of 1 m x 0.25 m: aspect 4, h_e 0.5 / 1.25.
        assert_eq!((quality.aspect.0, quality.smallest_h_e.0), (4.0, 0.4));
        assert!((quality.area - 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_rhombus_of_30_degrees_has_scaled_jacobian_one_half() {
        let (c, s) = (3f64.sqrt() / 2.0, 0.5);
        let shape = shape(&[[0.0, 0.0], [1.0, 0.0], [1.0 + c, s], [c, s]]);
        assert!((shape.scaled_jacobian - 0.5).abs() < 1e-15 && (shape.h_e - 0.5).abs() < 1e-15);
    }

    #[test]
    fn the_worst_cell_is_named() {
        let mut mesh = rectangle([2.0, 2.0], [2, 2]).unwrap();
        mesh.nodes[8] = [1.5, 1.5];
        assert_eq!(Quality::of(&mesh).scaled_jacobian.1, 3);
    }

    #[test]
    fn concave_cells_have_a_negative_scaled_jacobian() {
        assert!(shape(&[[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]).scaled_jacobian < 0.0);
    }
}
