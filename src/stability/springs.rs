//! The springs in the faces, where the flux holds the jumps of the displacement ([`crate::riemann::hold`]), and the displacement
//! counted by them.
//!
//! A step looks at u by the held jumps J u alone: a displacement without jumps changes nothing, and moves with v only (rigid
//! translations for ever: a Jordan block of the eigenvalue 1, which is no growth). So the operator acts on the displacements
//! modulo those without jumps. With the energy of the springs u* H u / 2 = sum over faces of K/2 int `[u]`^2 ds, H = V Lambda V*,
//! the unknowns are z = Lambda^(1/2) V* u of the positive Lambda: |z|^2 / 2 is that energy. Both components of u have the same H.

use super::Problem;
use super::spectrum::{Number, no_end};
use crate::error::Result;
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::operators::sides::Across;
use crate::riemann::hold;
use crate::tensor::AXES;
use faer::traits::ext::ComplexFieldExt;
use faer::{Mat, Side, c64};

/// Eigenvalues below this part of the largest are those of displacements without jumps. Rounding leaves 1e-15; the smallest of a
/// jump is 1e-2, over the contrast of two laws.
const NONE: f64 = 1e-12;

/// The form H of one component of the displacement, in units h of u, J/m.
pub struct Springs {
    /// Blocks of H by the offset of the unit that they act on, as those of the operator; of a body one.
    blocks: Vec<([i32; 2], Mat<f64>)>,
}

/// The displacement of all cells counted by jumps.
pub struct Jumps<N> {
    /// z of one component: Lambda^(1/2) V*.
    of: Mat<N>,
    /// Back: V Lambda^(-1/2).
    back: Mat<N>,
}

impl Springs {
    /// Of the faces of a problem, at its state; none where the flux holds nothing.
    pub fn new(problem: &Problem) -> Option<Self> {
        let cells = problem.columns();
        let n = problem.scheme.operators.nodes();
        if !problem.state.has_displacement() {
            return None;
        }
        let faces = Faces::new(problem);
        let mut springs = Self { blocks: vec![] };
        for (row, &cell) in cells.iter().enumerate() {
            for face in 0..FACES {
                let Some((across, Sides { own, beyond })) = faces.springs(cell, face) else { continue };
                let (offset, column) = faces.place(across);
                springs.add([0, 0], cells.len() * n, [row * n, row * n], &own, &own, 1.0);
                springs.add(offset, cells.len() * n, [row * n, column * n], &own, &beyond, -1.0);
            }
        }
        Some(springs)
    }

    /// Adds `sign` sum_p a_p (x) b_p to the block of an offset, from a row and a column on.
    fn add(&mut self, offset: [i32; 2], size: usize, at: [usize; 2], a: &[Vec<f64>], b: &[Vec<f64>], sign: f64) {
        let found = self.blocks.iter().position(|(known, _)| *known == offset);
        let found = found.unwrap_or_else(|| {
            self.blocks.push((offset, Mat::zeros(size, size)));
            self.blocks.len() - 1
        });
        let block = &mut self.blocks[found].1;
        for (a, b) in a.iter().zip(b) {
            for (i, a) in a.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                b.iter().enumerate().for_each(|(j, b)| block[(at[0] + i, at[1] + j)] += sign * a * b);
            }
        }
    }

    /// Those of a body.
    ///
    /// # Errors
    /// The eigenvalues of H cannot be computed.
    pub fn of_body(&self) -> Result<Jumps<f64>> {
        let size = self.blocks.first().map_or(0, |(_, block)| block.nrows());
        let mut form = Mat::zeros(size, size);
        self.blocks.iter().for_each(|(_, block)| form += block);
        Jumps::new(&form)
    }

    /// Those of a patch at Bloch angles.
    ///
    /// # Errors
    /// As for a body.
    pub fn at(&self, theta: [f64; 2]) -> Result<Jumps<c64>> {
        let size = self.blocks.first().map_or(0, |(_, block)| block.nrows());
        let mut form = Mat::<c64>::zeros(size, size);
        for (offset, block) in &self.blocks {
            let angle = -(theta[0] * f64::from(offset[0]) + theta[1] * f64::from(offset[1]));
            let phase = c64::new(angle.cos(), angle.sin());
            form += Mat::from_fn(size, size, |i, j| phase * block[(i, j)]);
        }
        Jumps::new(&form)
    }
}

impl<N: Number> Jumps<N> {
    fn new(form: &Mat<N>) -> Result<Self> {
        let eigen = form.self_adjoint_eigen(Side::Lower).map_err(|_| no_end())?;
        let values: Vec<f64> = eigen.S().column_vector().iter().map(|value| value.abs()).collect();
        let least = NONE * values.iter().copied().fold(0.0, f64::max);
        let kept: Vec<usize> = (0..values.len()).filter(|k| values[*k] > least).collect();
        let vectors = eigen.U();
        let back = |i: usize, k: usize| vectors[(i, kept[k])] * values[kept[k]].sqrt().recip();
        let of = |k: usize, j: usize| vectors[(j, kept[k])].conj() * values[kept[k]].sqrt();
        let (size, count) = (values.len(), kept.len());
        Ok(Self { of: Mat::from_fn(count, size, of), back: Mat::from_fn(size, count, back) })
    }

    /// A matrix whose last rows and columns are those of both components of u, with the jumps in their place.
    pub fn reduce(&self, matrix: &Mat<N>) -> Mat<N> {
        let (size, count) = (self.of.ncols(), self.of.nrows());
        let first = matrix.nrows() - AXES * size;
        let mut columns = Mat::<N>::zeros(matrix.nrows(), first + AXES * count);
        columns.subcols_mut(0, first).copy_from(matrix.subcols(0, first));
        for k in 0..AXES {
            let part = matrix.subcols(first + k * size, size) * &self.back;
            columns.subcols_mut(first + k * count, count).copy_from(&part);
        }
        let mut out = Mat::<N>::zeros(columns.ncols(), columns.ncols());
        out.subrows_mut(0, first).copy_from(columns.subrows(0, first));
        for k in 0..AXES {
            let part = &self.of * columns.subrows(first + k * size, size);
            out.subrows_mut(first + k * count, count).copy_from(&part);
        }
        out
    }
}

/// By point of a face, the factors of the nodes of the cells on both sides in (w l K)^(1/2) h times the held trace of u; the jump is
/// the difference of the two.
struct Sides {
    own: Vec<Vec<f64>>,
    beyond: Vec<Vec<f64>>,
}

/// The faces of a problem.
struct Faces<'a> {
    problem: &'a Problem,
    /// F and the other unknowns, `[cell][component][node]`.
    base: Vec<f64>,
}

impl<'a> Faces<'a> {
    fn new(problem: &'a Problem) -> Self {
        let (blocks, nodes) = (&problem.scheme.operators.blocks, problem.scheme.operators.nodes());
        Self { problem, base: problem.state.unpack(blocks, nodes) }
    }

    /// The cell beyond a face between cells, and the factors of both; none at the boundary of the body.
    fn springs(&self, cell: usize, face: usize) -> Option<(usize, Sides)> {
        let operators = &self.problem.scheme.operators;
        let (block, lane) = operators.blocks.slot[cell];
        let (Neighbour::Cell(across) | Neighbour::Interface(across, _)) =
            operators.blocks.neighbours[block][face][lane]
        else {
            return None;
        };
        let (there, other) = (operators.blocks.cells[across.face / FACES][across.lane], across.face % FACES);
        let (mut own, mut beyond) = (vec![], vec![]);
        for point in 0..operators.line.m {
            let (normal, _) = operators.geometry.of(block).at_face_of(lane, face, point);
            let opposite = Self::opposite(&across, point, operators.line.m);
            let moduli = [self.modulus(cell, face, point, normal), self.modulus(there, other, opposite, normal)];
            let [stiffness, _] = hold([-1.0, 0.0], moduli, 1.0);
            let factor = (operators.line.basis.weights[point] * stiffness).sqrt() * self.problem.h;
            let of = |held: Vec<f64>| held.iter().map(|held| factor * held).collect();
            own.push(of(operators.held_trace(block, face, lane, point)));
            beyond.push(of(operators.held_trace(across.face / FACES, other, across.lane, opposite)));
        }
        Some((there, Sides { own, beyond }))
    }

    fn opposite(across: &Across, point: usize, m: usize) -> usize {
        if across.flip { m - 1 - point } else { point }
    }

    /// rho0 c_p^2 of a cell at a point of a face, Pa.
    fn modulus(&self, cell: usize, face: usize, point: usize, normal: [f64; 2]) -> f64 {
        let (scheme, stride) = (&self.problem.scheme, self.problem.at_nodes());
        let n = scheme.operators.nodes();
        let ends = scheme.operators.line.spread(&scheme.operators.line.ends[face % 2], face, point);
        let f = std::array::from_fn(|k| {
            ends.iter().zip(&self.base[cell * stride + k * n..]).map(|(end, f)| end * f).sum::<f64>()
        });
        let law = &scheme.laws[scheme.operators.blocks.material[scheme.operators.blocks.slot[cell].0]];
        law.density() * law.speeds(f, normal)[0].powi(2)
    }

    /// Where the block of a cell in H stands: the offset of the row unit from that of the cell, and the place of the cell in its unit.
    fn place(&self, cell: usize) -> ([i32; 2], usize) {
        let Some(unit) = self.problem.unit else { return ([0, 0], cell) };
        let per_row = unit[0] * self.problem.units;
        let [ix, iy] = [cell % per_row, cell / per_row];
        let middle = (self.problem.units as i32 - 1) / 2;
        let offset = [ix / unit[0], iy / unit[1]].map(|at| middle - at as i32);
        (offset, iy % unit[1] * unit[0] + ix % unit[0])
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Domain, Pattern, Setup};
    use super::*;

    fn problem(degree: usize, springs: bool) -> Problem {
        let mut sets = vec![format!("scheme.degree={degree}"), format!("scheme.time_degree={degree}")];
        sets.push(format!("scheme.springs={springs}"));
        let (contrast, pattern) = (1.0, Pattern::Checkerboard);
        let setup = Setup { domain: Domain::Patch, sets, contrast, pattern, courant: None, semi_discrete: false };
        setup.build().unwrap()
    }

    /// The creep stands behind the unknowns at the nodes of a cell, and is none of them.
    #[test]
    fn what_holds_jumps_of_the_displacement_is_the_same_with_and_without_the_creep_of_faces() {
        for degree in 1..=3 {
            let [with, without] = [true, false].map(|springs| Springs::new(&problem(degree, springs)).unwrap());
            assert_eq!(with.blocks, without.blocks, "S{degree}");
        }
    }

    #[test]
    fn displacements_without_jumps_are_left_out_and_no_others() {
        for degree in 1..=4 {
            let springs = Springs::new(&problem(degree, false)).unwrap();
            for theta in [[0.0, 0.0], [1.0, 2.0], [std::f64::consts::PI; 2], [1e-2, 0.0]] {
                let jumps = springs.at(theta).unwrap();
                // Without jumps: in each direction N of the N + 1 shapes of a cell, whatever the phase.
                let [all, without] = [degree + 1, degree].map(|n| n * n);
                assert_eq!((jumps.of.nrows(), jumps.of.ncols()), (all - without, all), "S{degree} {theta:?}");
                let one = &jumps.of * &jumps.back;
                let error = |i: usize, j: usize| (one[(i, j)] - if i == j { 1.0 } else { 0.0 }).abs();
                let largest =
                    (0..one.nrows()).flat_map(|i| (0..one.nrows()).map(move |j| error(i, j))).fold(0.0, f64::max);
                // Rounding of the eigenvectors, over the root of the ratio of two eigenvalues.
                assert!(largest < 1e-11, "S{degree} {theta:?}: {largest:e}");
            }
        }
    }
}
