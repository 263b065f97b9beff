//! Where the memory of boundary conditions lies in [`State::boundary`]: by block, face, lane and point. Nothing where no condition
//! has any.

use super::Scheme;
use super::history::between;
use crate::boundary::Boundary;
use crate::lane::LANES;
use crate::mesh::{FACES, map};
use crate::operators::{Neighbour, Operators};
use crate::state::State;
use std::ops::Range;
use std::sync::Arc;

/// The places of the numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct BoundaryMemory {
    /// Numbers before each block (length: blocks + 1); empty where no condition has memory.
    first: Vec<usize>,
    /// By block, face and lane: behind so many numbers of the block those of the face begin, and how many a point has.
    faces: Vec<[[(u32, u32); LANES]; FACES]>,
}

impl BoundaryMemory {
    /// Those of the faces of `operators` under these conditions.
    pub fn new(operators: &Operators, boundaries: &[Arc<dyn Boundary>]) -> Self {
        if boundaries.iter().all(|boundary| boundary.memory().is_empty()) {
            return Self::default();
        }
        let (blocks, m) = (&operators.blocks, operators.line.m as u32);
        let mut out = Self { first: vec![0], faces: vec![] };
        for neighbours in &blocks.neighbours {
            let (mut faces, mut used) = ([[(0, 0); LANES]; FACES], 0);
            for (faces, neighbours) in faces.iter_mut().zip(neighbours) {
                for (place, neighbour) in faces.iter_mut().zip(neighbours) {
                    if let Neighbour::Boundary(group) = neighbour {
                        let count = boundaries[*group].memory().len() as u32;
                        *place = (used, count);
                        used += m * count;
                    }
                }
            }
            out.first.push(out.first[out.first.len() - 1] + used as usize);
            out.faces.push(faces);
        }
        out
    }

    /// Numbers of a state.
    pub fn len(&self) -> usize {
        self.first.last().copied().unwrap_or(0)
    }

    /// Where those of a block lie.
    #[inline]
    pub fn range(&self, block: usize) -> Range<usize> {
        between(&self.first, block)
    }

    /// Those of a point among all.
    pub fn look<'a>(&self, numbers: &'a [f64], [block, face, lane, point]: [usize; 4]) -> &'a [f64] {
        let Some(faces) = self.faces.get(block) else { return &[] };
        let (first, count) = faces[face][lane];
        let first = self.first[block] + (first + count * point as u32) as usize;
        numbers.get(first..first + count as usize).unwrap_or_default()
    }

    /// Those of all points of a face among all.
    pub fn look_at_face<'a>(&self, numbers: &'a [f64], [block, face, lane]: [usize; 3], points: usize) -> &'a [f64] {
        let Some(faces) = self.faces.get(block) else { return &[] };
        let (first, count) = faces[face][lane];
        let first = self.first[block] + first as usize;
        numbers.get(first..first + count as usize * points).unwrap_or_default()
    }

    /// Those of a point among the numbers of its block.
    #[inline]
    pub fn of_point<'a>(&self, numbers: &'a mut [f64], [block, face, lane, point]: [usize; 4]) -> &'a mut [f64] {
        let Some(faces) = self.faces.get(block) else { return &mut [] };
        let (first, count) = faces[face][lane];
        let first = (first + count * point as u32) as usize;
        &mut numbers[first..first + count as usize]
    }

    /// Those of all points of a face among the numbers of its block.
    pub fn of_face<'a>(&self, numbers: &'a mut [f64], [block, face, lane]: [usize; 3], points: usize) -> &'a mut [f64] {
        let Some(faces) = self.faces.get(block) else { return &mut [] };
        let (first, count) = faces[face][lane];
        &mut numbers[first as usize..][..count as usize * points]
    }
}

/// A boundary point whose condition has memory.
#[derive(Debug, Clone, PartialEq)]
pub struct PointWithMemory {
    /// The number of its boundary group.
    pub group: usize,
    /// Reference coordinates X, m.
    pub x: [f64; 2],
    /// Where its numbers stand in [`Scheme::boundary_memory_of`].
    pub numbers: Range<usize>,
}

impl Scheme {
    /// Calls `visit(group, [block, face, lane, point])` for each boundary point with memory: cells in the order of the mesh.
    fn each_point_with_memory(&self, mut visit: impl FnMut(usize, [usize; 4])) {
        let blocks = &self.operators.blocks;
        for &(block, lane) in blocks.slot.iter().filter(|_| self.boundary_memory.len() > 0) {
            for (face, neighbours) in blocks.neighbours[block].iter().enumerate() {
                if let Neighbour::Boundary(group) = neighbours[lane] {
                    (0..self.operators.line.m).for_each(|point| visit(group, [block, face, lane, point]));
                }
            }
        }
    }

    /// The boundary points whose conditions have memory: cells in the order of the mesh, faces, points.
    pub fn points_with_memory(&self) -> Vec<PointWithMemory> {
        let (mut out, mut first) = (Vec::new(), 0);
        let (geometry, basis) = (&self.operators.geometry, &self.operators.line.basis);
        self.each_point_with_memory(|group, [block, face, lane, point]| {
            let count = self.boundaries[group].memory().len();
            let x = map::position(&geometry.map_of(block, lane), map::on_face(face, basis.nodes[point]));
            if count > 0 {
                out.push(PointWithMemory { group, x, numbers: first..first + count });
            }
            first += count;
        });
        out
    }

    /// The memory of the conditions, in the order of [`Scheme::points_with_memory`].
    pub fn boundary_memory_of(&self, state: &State) -> Vec<f64> {
        let (mut out, mut numbers) = (Vec::new(), state.boundary.clone());
        if numbers.len() != self.boundary_memory.len() {
            // A state that has not been stepped yet, such as that of a run whose outputs cannot be made.
            let mut start = State::default();
            self.set_boundary_memory(&mut start, &[]);
            numbers = start.boundary;
        }
        self.each_point_with_memory(|_, at| {
            let of_block = &mut numbers[self.boundary_memory.range(at[0])];
            out.extend_from_slice(self.boundary_memory.of_point(of_block, at));
        });
        out
    }

    /// The inverse of [`Scheme::boundary_memory_of`]; what is missing in `values` is that of the start of a run.
    pub fn set_boundary_memory(&self, state: &mut State, values: &[f64]) {
        state.boundary = vec![0.0; self.boundary_memory.len()];
        let mut next = values.iter();
        self.each_point_with_memory(|group, at| {
            let of_block = &mut state.boundary[self.boundary_memory.range(at[0])];
            let own = self.boundary_memory.of_point(of_block, at);
            for (out, start) in own.iter_mut().zip(self.boundaries[group].memory()) {
                *out = next.next().copied().unwrap_or(*start);
            }
        });
    }
}
