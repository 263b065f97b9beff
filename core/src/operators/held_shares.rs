//! How much of their highest coefficient the traces of the displacement leave out, where neighbours have unequal cells.
//!
//! For even N the traces whose jump is held leave out a_N/(2N+1) ([`super::Line::held`]), since between two equal cells this takes away the jump
//! that a smooth function has. That jump is (h1^(N+1) + h2^(N+1)) kappa u^(N+1), and a_N = (2N+1)/2 kappa h^N u^(N) with the length h of a cell and
//! the derivatives along its line across the face. So between cells of unequal length each leaves out the share
//!
//! ```text
//! s = w (g/h)^N,    g^N = (h1^(N+1) + h2^(N+1)) / (h1 + h2)
//! ```
//!
//! of it: the difference of both is then h1 + h2 times a difference quotient of u^(N), whatever the lengths. Where the two lines make an angle at the face, they
//! see two derivatives, and the difference of a_N would be one order more than the jump that it takes away. The weight w falls from 1 to 0
//! there: the traces are those of degree N, as at odd N.

use super::{Blocks, Neighbour};
use crate::lane::{F8, LANES};
use crate::mesh::{FACES, Mesh, map};

/// The angle of the lines, as a sine, up to which w = 1, and from which on w = 0.
const ANGLES: [f64; 2] = [0.2, 0.4];
/// The ratio of the lengths up to which w = 1, and from which on w = 0.
const RATIOS: [f64; 2] = [1.5, 2.0];
/// Shares that differ from 1 by less are 1: rounding of equal cells.
const ROUNDING: f64 = 1e-9;
/// The place of a block whose shares are all 1.
const EQUAL: u32 = u32::MAX;

/// Shares s of the blocks that have one other than 1.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldShares {
    /// The place of each block below, or `EQUAL`.
    place: Vec<u32>,
    /// `[place][face]`, a lane a cell.
    of: Vec<[F8; FACES]>,
}

impl HeldShares {
    /// Those of a mesh; none where all are 1, and where the traces leave nothing out: at odd degrees and at degree 0.
    pub fn of(mesh: &Mesh, blocks: &Blocks, degree: usize) -> Option<Self> {
        if degree % 2 == 1 || degree == 0 {
            return None;
        }
        let mut out = Self { place: vec![], of: vec![] };
        for block in 0..blocks.len() {
            let shares = std::array::from_fn(|face| {
                F8(std::array::from_fn(|lane| share_of_lane(mesh, blocks, [block, face, lane], degree)))
            });
            let is_equal = shares.iter().all(|share: &F8| share.0.iter().all(|s| *s == 1.0));
            out.place.push(if is_equal { EQUAL } else { out.of.len() as u32 });
            if !is_equal {
                out.of.push(shares);
            }
        }
        (!out.of.is_empty()).then_some(out)
    }

    /// Those of a block, by face; none where all are 1.
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

/// The share of the cell in a lane of a block at a face.
fn share_of_lane(mesh: &Mesh, blocks: &Blocks, [block, face, lane]: [usize; 3], degree: usize) -> f64 {
    let there = match &blocks.neighbours[block][face][lane] {
        Neighbour::Cell(there) | Neighbour::Interface(there, _) => there,
        Neighbour::Boundary(_) | Neighbour::Padding => return 1.0,
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
    let (h, there) = (own[0].hypot(own[1]), other[0].hypot(other[1]));
    let sine = (own[0] * other[1] - own[1] * other[0]).abs() / (h * there);
    let along = own[0] * other[0] + own[1] * other[1];
    let ratio = h.max(there) / h.min(there);
    let weight = if along > 0.0 { falling(sine, ANGLES) * falling(ratio, RATIOS) } else { 0.0 };
    let n = degree as i32;
    let share = weight * (h.powi(n + 1) + there.powi(n + 1)) / ((h + there) * h.powi(n));
    if (share - 1.0).abs() < ROUNDING { 1.0 } else { share }
}

/// 1 below the first of two numbers, 0 above the second, straight between them.
fn falling(x: f64, [from, to]: [f64; 2]) -> f64 {
    ((to - x) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_cells_leave_out_all_and_kinks_and_jumps_of_size_nothing() {
        for degree in [2, 4, 6] {
            assert_eq!(share([0.3, 0.1], [0.3, 0.1 + 1e-12], degree), 1.0);
            assert_eq!(share([0.3, 0.0], [0.2, 0.2], degree), 0.0);
            assert_eq!(share([0.3, 0.0], [0.1, 0.0], degree), 0.0);
            assert_eq!(share([0.3, 0.0], [-0.3, 0.0], degree), 0.0);
        }
    }

    #[test]
    fn the_traces_of_a_power_jump_less_than_the_power_itself_between_unequal_cells() {
        // u = x^(N+1)/(N+1)! about x = 0, of which each cell has its L2 projection: the jump of the plain traces is kappa (h1^(N+1) + h2^(N+1))
        // with kappa = (1/2)^(N+1) 2/(1 3 .. (2N+1)) 2^(N+1)..., and a_N comes from the same expansion. Measured here by Gauss quadrature.
        for degree in [2_usize, 4] {
            let (own, other) = (0.1, 0.13);
            let line = super::super::Line::new(degree);
            let trace = |from: f64, h: f64, end: usize, share: f64| {
                // The projection by Lagrange interpolation at Gauss nodes of degree N is not the L2 one: project with more points.
                let (x, w) = crate::quadrature::gauss_legendre(degree + 3);
                let u: Vec<f64> = (0..line.m)
                    .map(|k| {
                        let at = |x: f64| line.basis.values(x)[k];
                        let load: f64 =
                            x.iter().zip(&w).map(|(x, w)| w * at(*x) * (from + h * x).powi(degree as i32 + 1)).sum();
                        load / line.basis.weights[k]
                    })
                    .collect();
                let sum = |row: &[f64]| row.iter().zip(&u).map(|(l, u)| l * u).sum::<f64>();
                sum(&line.ends[end]) + share * (sum(&line.held[end]) - sum(&line.ends[end]))
            };
            let jump = |shares: [f64; 2]| trace(0.0, other, 0, shares[1]) - trace(-own, own, 1, shares[0]);
            let shares = [share([own, 0.0], [other, 0.0], degree), share([other, 0.0], [own, 0.0], degree)];
            let (plain, equal, held) = (jump([0.0; 2]), jump([1.0; 2]), jump(shares));
            // A power of degree N + 1 has no higher part: rounding alone is left.
            assert!(held.abs() < 1e-10 * plain.abs(), "{degree}: {plain:e} {equal:e} {held:e}");
            assert!(equal.abs() > 1e-2 * plain.abs(), "{degree}: {plain:e} {equal:e}");
        }
    }
}
