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
//! - where s is so large that the trace would be an extrapolation;
//! - where what is left out of X itself jumps, as where curved lines meet at N = 2: a body that turns as a whole has u linear in X.
//!
//! Between two laws s is that of equal cells, since u has a kink there. So it is at N = 1: a is the strain there, and a trace without a part
//! of the strain holds too little. With shares at N = 1, a bar with a thin soft layer came apart at the faces of the layer, and lost 27 % of
//! its energy in place of .1 %; a cantilever of cells 1 : 3 lost 18 % in place of 12 %.
//!
//! With w = 0 the traces are those of degree N.

use super::{Blocks, Neighbour};
use crate::lane::F8;
use crate::mesh::map::{self, CellMap};
use crate::mesh::{FACES, Mesh};

/// The angle of the lines, as a sine, up to which w = 1, and from which on w = 0.
const ANGLES: [f64; 2] = [0.2, 0.4];
/// The largest part of a that a trace leaves out.
const MOST: f64 = 0.5;
/// The jump of X, over the length of the shorter cell, up to which w = 1, and from which on w = 0. (A ring of 32 equal
/// curved cells has 3e-4 at N = 2.)
const PLACES: [f64; 2] = [1e-3, 2e-3];
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
    /// Those of a mesh; none where all cells are equal, and at degrees 0 and 1.
    pub fn of(mesh: &Mesh, blocks: &Blocks, degree: usize) -> Option<Self> {
        if degree < 2 {
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
        Neighbour::Cell(there) => there,
        Neighbour::Interface(..) | Neighbour::Boundary(_) | Neighbour::Padding => return of_equal(degree),
    };
    let own = Across::of(&mesh.map(blocks.cells[block][lane]), face, false, degree);
    let cell = blocks.cells[there.face / FACES][there.lane];
    share(&own, &Across::of(&mesh.map(cell), there.face % FACES, there.flip, degree), degree)
}

/// What the lines of a cell across a face say.
struct Across {
    /// dX/dxi outward at the middle of the face, m: its length is that of the cell there.
    line: [f64; 2],
    /// The coefficient a of X itself, m, at the ends and the middle of the face. It is 0 for N > 2, and at N = 2 on straight lines.
    of_place: [[f64; 2]; 3],
}

impl Across {
    fn of(map: &CellMap, face: usize, flip: bool, degree: usize) -> Self {
        let (axis, end) = (face / 2, (face % 2) as f64);
        let outward = 2.0 * end - 1.0;
        let at = |xi: f64, along: f64| if axis == 0 { [xi, along] } else { [along, xi] };
        let slope = |xi: f64, along: f64| map::jacobian(map, at(xi, along)).map(|row| outward * row[axis]);
        let minus = |a: [f64; 2], b: [f64; 2], factor: f64| [factor * (a[0] - b[0]), factor * (a[1] - b[1])];
        let of_place = [0.0, 0.5, 1.0].map(|along| {
            let along = if flip { 1.0 - along } else { along };
            match degree {
                2 => minus(slope(end, along), slope(1.0 - end, along), 1.0 / 12.0),
                _ => [0.0; 2],
            }
        });
        Self { line: slope(end, 0.5), of_place }
    }
}

/// The share of a cell across a face, whose neighbour has the lines `other`, outward from there.
fn share(own: &Across, other: &Across, degree: usize) -> f64 {
    let ([a, b], [c, d]) = (own.line, other.line);
    let (h, k, n) = (a.hypot(b), c.hypot(d), degree as i32);
    let (sine, along) = ((a * d - b * c).abs() / (h * k), -(a * c + b * d));
    let sign = 2.0 * of_equal(degree) - 1.0;
    let full = |h: f64, k: f64| (h.powi(n + 1) + sign * k.powi(n + 1)) / ((h + k) * h.powi(n));
    let (full, there) = (full(h, k), full(k, h));
    let part = f64::from(2 * n + 1);
    let mut weight = if along > 0.0 { falling(sine, ANGLES) } else { 0.0 };
    weight *= MOST / (full.abs().max(there.abs()) / part).max(MOST);
    let jump = |(own, other): (&[f64; 2], &[f64; 2])| {
        let of = |i: usize| weight * (full * own[i] - there * other[i]) / (part * h.min(k));
        of(0).hypot(of(1))
    };
    let jumps = own.of_place.iter().zip(&other.of_place).map(jump).fold(0.0, f64::max);
    let share = weight * falling(jumps, PLACES) * full;
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

    /// Two rectangles side by side of lengths h and k, and the second one turned about the lower end of their face.
    fn shares(h: f64, k: f64, angle: f64, degree: usize) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        let left = [[-h, 0.0], [0.0, 0.0], [0.0, 1.0], [-h, 1.0]];
        let right = [[0.0, 0.0], [k * cos, k * sin], [k * cos, 1.0 + k * sin], [0.0, 1.0]];
        let of = |corners, face| Across::of(&CellMap { corners, bulge: None }, face, false, degree);
        let (left, right) = (of(left, 1), of(right, 0));
        [share(&left, &right, degree), share(&right, &left, degree)]
    }

    #[test]
    fn equal_cells_have_the_traces_of_the_line_and_kinks_the_plain_ones() {
        for degree in 2..=6 {
            assert_eq!(shares(0.3, 0.3 + 1e-12, 0.0, degree), [of_equal(degree); 2]);
            assert_eq!(shares(0.3, 0.3, 0.5, degree), [0.0; 2]);
            // However unequal the cells, no trace leaves out more than the largest part (and a rounding).
            for k in [1e-3, 0.1, 0.2, 0.4, 1e3] {
                let most = MOST * (2 * degree + 1) as f64 * (1.0 + 1e-12);
                assert!(shares(0.3, k, 0.0, degree).iter().all(|share| share.abs() <= most));
            }
        }
    }

    #[test]
    fn degree_1_and_faces_between_two_laws_have_the_traces_of_equal_cells() {
        let mut mesh = crate::mesh::rectangle([2.0, 1.0], [2, 1]).unwrap();
        mesh.nodes.iter_mut().filter(|x| x[0] == 1.0).for_each(|x| x[0] = 0.8);
        let links = crate::mesh::links(&mesh).unwrap();
        let of = |laws: [usize; 2], degree| HeldShares::of(&mesh, &Blocks::new(&laws, &links), degree);
        for degree in 2..=6 {
            assert!(of([0, 0], degree).is_some() && of([0, 1], degree).is_none(), "{degree}");
        }
        assert!(of([0, 0], 0).is_none() && of([0, 0], 1).is_none());
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
        for degree in 2..=5 {
            let line = Line::new(degree);
            let (own, other) = (0.1, 0.13);
            let jump = |[s, t]: [f64; 2]| trace(&line, [0.2, other], 0, t) - trace(&line, [0.2 - own, own], 1, s);
            let shares = shares(own, other, 0.0, degree);
            // Rounding alone is left, of sums of some ten numbers up to .33^(N+1).
            assert!(jump(shares).abs() < 1e-15, "{degree}: {:e}", jump(shares));
            // The traces that fit equal cells jump.
            let equal = jump([of_equal(degree); 2]).abs();
            assert!(equal > 1e-3 * own.powi(degree as i32 + 1), "{degree}: {equal:e}");
        }
    }
}
