//! How much of their highest coefficient the traces of the displacement leave out between unequal cells.
//!
//! The part of a smooth function u that no polynomial of degree N has begins with c P_(N+1), c = kappa h^(N+1) u^(N+1), where h is the
//! length of the cell and the derivative is along its line across the face. So the traces of both sides of a face jump by c^- + c^+ for
//! even N and by c^- - c^+ for odd N, seen along the line. Their highest coefficients are a = 2 (2N+1) kappa h^N u^(N), with u^(N) at the
//! centres of the cells. Where each side leaves out s a/(2N+1) with
//!
//! ```text
//! s = w (h^(N+1) +- k^(N+1)) / ((h + k) h^N),    + for even N, - for odd N,    k the length of the other cell,
//! ```
//!
//! what is left out on both sides differs by the jump of a polynomial of degree N + 1, whatever the lengths. Between equal cells s is 1
//! for even N and 0 for odd N, which [`super::Line::held`] has. The weight w, the same for both sides, is less than 1
//!
//! - where the two lines make an angle at the face: they see two derivatives, and a^+ - a^- is one order less than the jump;
//! - where s is so large that the trace would be an extrapolation.
//!
//! With w = 0 the traces are those of degree N.

use super::{Blocks, Neighbour};
use crate::lane::{F8, LANES};
use crate::mesh::{FACES, Mesh, map};

/// The angle of the lines, as a sine, up to which w = 1, and from which on w = 0.
const ANGLES: [f64; 2] = [0.2, 0.4];
/// The largest part of a that a trace leaves out.
const MOST: f64 = 0.5;
/// Shares that differ by less are those of equal cells: rounding.
const ROUNDING: f64 = 1e-9;
/// The place of a block of equal cells.
const EQUAL: u32 = u32::MAX;

/// Shares s of the blocks that have unequal cells.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldShares {
    /// The place of each block below, or `EQUAL`.
    place: Vec<u32>,
    /// `[place][face]`, a lane a cell.
    of: Vec<[F8; FACES]>,
}

impl HeldShares {
    /// Those of a mesh; none where all cells are equal, and at degree 0, which holds nothing.
    pub fn of(mesh: &Mesh, blocks: &Blocks, degree: usize) -> Option<Self> {
        if degree == 0 {
            return None;
        }
        let mut out = Self { place: vec![], of: vec![] };
        for block in 0..blocks.len() {
            let of_lane = |face, lane| share_of_lane(mesh, blocks, [block, face, lane], degree);
            let shares: [F8; FACES] = std::array::from_fn(|face| F8(std::array::from_fn(|lane| of_lane(face, lane))));
            let is_equal = shares.iter().all(|share| share.0.iter().all(|s| *s == of_equal(degree)));
            out.place.push(if is_equal { EQUAL } else { out.of.len() as u32 });
            if !is_equal {
                out.of.push(shares);
            }
        }
        (!out.of.is_empty()).then_some(out)
    }

    /// Those of a block, by face; none where its cells are equal.
    #[inline]
    pub fn block(&self, block: usize) -> Option<&[F8; FACES]> {
        let place = self.place[block];
        (place != EQUAL).then(|| &self.of[place as usize])
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.place[..]) + size_of_val(&self.of[..])
    }
}

/// s between equal cells.
fn of_equal(degree: usize) -> f64 {
    if degree.is_multiple_of(2) { 1.0 } else { 0.0 }
}

/// The share of the cell in a lane of a block at a face.
fn share_of_lane(mesh: &Mesh, blocks: &Blocks, [block, face, lane]: [usize; 3], degree: usize) -> f64 {
    let there = match &blocks.neighbours[block][face][lane] {
        Neighbour::Cell(there) | Neighbour::Interface(there, _) => there,
        Neighbour::Boundary(_) | Neighbour::Padding => return of_equal(degree),
    };
    let own = line_across(mesh, blocks.cells[block][lane], face);
    let other = line_across(mesh, blocks.cells[there.face / FACES][there.lane % LANES], there.face % FACES);
    share(own, [-other[0], -other[1]], degree)
}

/// dX/dxi across a face of a cell, outward, at the middle of the face, m: its length is that of the cell there.
fn line_across(mesh: &Mesh, cell: usize, face: usize) -> [f64; 2] {
    let (axis, end) = (face / 2, (face % 2) as f64);
    let middle = if axis == 0 { [end, 0.5] } else { [0.5, end] };
    let slopes = map::jacobian(&mesh.map(cell), middle);
    let outward = 2.0 * end - 1.0;
    [outward * slopes[0][axis], outward * slopes[1][axis]]
}

/// The share of a cell with the line `own` across a face, whose neighbour has the line `other` in the same direction.
fn share(own: [f64; 2], other: [f64; 2], degree: usize) -> f64 {
    let (h, k, n) = (own[0].hypot(own[1]), other[0].hypot(other[1]), degree as i32);
    let sine = (own[0] * other[1] - own[1] * other[0]).abs() / (h * k);
    let along = own[0] * other[0] + own[1] * other[1];
    let sign = 2.0 * of_equal(degree) - 1.0;
    let full = |h: f64, k: f64| (h.powi(n + 1) + sign * k.powi(n + 1)) / ((h + k) * h.powi(n));
    let largest = full(h, k).abs().max(full(k, h).abs()) / f64::from(2 * n + 1);
    let weight = if along > 0.0 { falling(sine, ANGLES) * (MOST / largest.max(MOST)) } else { 0.0 };
    let share = weight * full(h, k);
    if (share - of_equal(degree)).abs() < ROUNDING { of_equal(degree) } else { share }
}

/// 1 below the first of two numbers, 0 above the second, straight between them.
fn falling(x: f64, [from, to]: [f64; 2]) -> f64 {
    ((to - x) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::Line;
    use super::*;
    use crate::quadrature::gauss_legendre;

    #[test]
    fn equal_cells_have_the_traces_of_the_line_and_kinks_the_plain_ones() {
        for degree in 1..=6 {
            assert_eq!(share([0.3, 0.1], [0.3, 0.1 + 1e-12], degree), of_equal(degree));
            assert_eq!(share([0.3, 0.0], [0.2, 0.2], degree), 0.0);
            assert_eq!(share([0.3, 0.0], [-0.3, 0.0], degree), 0.0);
            // However unequal the cells, no trace leaves out more than the largest part (and a rounding).
            for k in [1e-3, 0.1, 0.2, 0.4, 1e3] {
                assert!(share([0.3, 0.0], [k, 0.0], degree).abs() <= MOST * (2 * degree + 1) as f64 * (1.0 + 1e-12));
            }
        }
    }

    /// The trace of the L2 projection of x^(N+1) on the cell from `from` of length `h` at one of its ends, less the share.
    fn trace(line: &Line, [from, h]: [f64; 2], end: usize, share: f64) -> f64 {
        let (x, w) = gauss_legendre(line.m + 2);
        let projected = |k: usize| {
            let at = |(x, w): (&f64, &f64)| w * line.basis.values(*x)[k] * (from + h * x).powi(line.m as i32);
            x.iter().zip(&w).map(at).sum::<f64>() / line.basis.weights[k]
        };
        let part = |k: usize| (line.ends[end][k] - share * line.highest[end][k]) * projected(k);
        (0..line.m).map(part).sum()
    }

    #[test]
    fn held_traces_of_a_polynomial_of_degree_n_plus_1_do_not_jump_between_cells_of_unequal_length() {
        for degree in 1..=4 {
            let line = Line::new(degree);
            let (own, other) = (0.1, 0.13);
            let jump = |[s, t]: [f64; 2]| trace(&line, [0.0, other], 0, t) - trace(&line, [-own, own], 1, s);
            let shares = [share([own, 0.0], [other, 0.0], degree), share([other, 0.0], [own, 0.0], degree)];
            // Rounding alone is left, of traces up to .13^(N+1).
            assert!(jump(shares).abs() < 1e-16, "{degree}: {:e}", jump(shares));
            // The traces that fit equal cells jump.
            let equal = jump([of_equal(degree); 2]).abs();
            assert!(equal > 1e-3 * own.powi(degree as i32 + 1), "{degree}: {equal:e}");
        }
    }
}
