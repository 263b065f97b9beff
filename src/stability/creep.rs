//! The creep of faces among the unknowns: both cells of a face keep it, and one of them counts it.

use super::Problem;
use crate::boundary::GivesBack;
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::operators::sides::Across;
use crate::state::State;
use crate::tensor::AXES;

impl Problem {
    /// The cell beyond a face between cells, and where it lies there.
    fn beyond(&self, cell: usize, face: usize) -> Option<Across> {
        let blocks = &self.scheme.operators.blocks;
        let (block, lane) = blocks.slot[cell];
        match blocks.neighbours[block][face][lane] {
            Neighbour::Cell(across) | Neighbour::Interface(across, _) => Some(across),
            Neighbour::Boundary(_) | Neighbour::Padding => None,
        }
    }

    /// Numbers of the creep that a cell counts, `[face][point][2]`: at the boundary its own, between cells those of faces with odd
    /// numbers, which in a patch are the right and the upper ones of all cells, and of two odd or even ones those of the first.
    pub(super) fn own_creep(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let of_face = if self.state.creep.is_empty() { 0 } else { self.scheme.creep_of_block() / FACES };
        let is_own = move |face: &usize| {
            if self.spring_of(cell, *face) == 0.0 {
                return false;
            }
            let Some(across) = self.beyond(cell, *face) else { return true };
            let blocks = &self.scheme.operators.blocks;
            let (there, other) = (blocks.cells[across.face / FACES][across.lane], across.face % FACES);
            if face % 2 == other % 2 { (cell, *face) < (there, other) } else { face % 2 == 1 }
        };
        (0..FACES).filter(is_own).flat_map(move |face| face * of_face..(face + 1) * of_face)
    }

    /// Gives number k of the creep of a cell a value, on both sides of its face.
    pub(super) fn set_creep(&self, state: &mut State, cell: usize, k: usize, value: f64) {
        for (cell, k) in std::iter::once((cell, k)).chain(self.twin_of_creep(cell, k)) {
            let (block, lane) = self.scheme.operators.blocks.slot[cell];
            state.creep[block * self.scheme.creep_of_block() + k].0[lane] = value;
        }
    }

    /// The cell and the number of the creep beyond a face that are the same as number k of a cell; none at the boundary.
    pub(super) fn twin_of_creep(&self, cell: usize, k: usize) -> Option<(usize, usize)> {
        let (m, of_face) = (self.scheme.operators.line.m, self.scheme.creep_of_block() / FACES);
        let (face, point, axis) = (k / of_face, k % of_face / AXES, k % AXES);
        let across = self.beyond(cell, face)?;
        let point = if across.flip { m - 1 - point } else { point };
        let there = self.scheme.operators.blocks.cells[across.face / FACES][across.lane];
        Some((there, across.face % FACES * of_face + AXES * point + axis))
    }

    /// k l of a face of a cell, Pa; 0 where it has no spring.
    fn spring_of(&self, cell: usize, face: usize) -> f64 {
        let (scheme, blocks) = (&self.scheme, &self.scheme.operators.blocks);
        let (block, lane) = blocks.slot[cell];
        let own = blocks.material[block];
        match blocks.neighbours[block][face][lane] {
            Neighbour::Cell(_) => scheme.spring_between([own; 2]),
            Neighbour::Interface(_, law) => scheme.spring_between([own, law]),
            // The other half is the image's.
            Neighbour::Boundary(group) if scheme.boundaries[group].gives_back() == GivesBack::Along => {
                0.5 * scheme.spring_at(group, own)
            }
            Neighbour::Boundary(group) => scheme.spring_at(group, own),
            Neighbour::Padding => 0.0,
        }
    }

    /// (k w l)^(1/2) h of a number of the creep of a cell, whose energy in units h is half of its square.
    pub(super) fn root_of_creep(&self, cell: usize, k: usize) -> f64 {
        let of_face = self.scheme.creep_of_block() / FACES;
        let weight = self.scheme.operators.line.basis.weights[k % of_face / AXES];
        (self.spring_of(cell, k / of_face) * weight).sqrt() * self.h
    }
}
