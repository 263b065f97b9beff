//! What the springs that hold the jumps of the displacement store ([`crate::riemann::hold`]).

use super::Scheme;
use crate::lane::F8;
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::riemann::hold;
use crate::state::{State, UNKNOWNS};
use crate::sum::exact_sum;
use crate::tensor::{AXES, dot};
use rayon::prelude::*;

impl Scheme {
    /// Sum over the faces between cells of K/2 int |`[u]`|^2 ds, J/m, with K of the laws at F = 1: that of the state differs by its strain. `cells` is memory for it; the blocks are added by
    /// an exact sum.
    pub fn stored_by_jumps(&self, state: &State, cells: &mut Vec<F8>) -> f64 {
        if !state.has_displacement() || self.moduli.is_empty() {
            return 0.0;
        }
        cells.resize(self.operators.blocks.len(), F8::ZERO);
        let blocks = cells.par_iter_mut().enumerate();
        blocks.for_each(|(block, out)| *out = F8(std::array::from_fn(|lane| self.jumps_of_cell(state, block, lane))));
        exact_sum(cells.iter().map(|cell| cell.0.iter().sum()))
    }

    /// That of a cell: each face at the first of its two cells.
    fn jumps_of_cell(&self, state: &State, block: usize, lane: usize) -> f64 {
        let (blocks, m) = (&self.operators.blocks, self.operators.line.m);
        let (own, mut sum) = (blocks.material[block], 0.0);
        for face in 0..FACES {
            let (across, law) = match blocks.neighbours[block][face][lane] {
                Neighbour::Cell(across) => (across, own),
                Neighbour::Interface(across, law) => (across, law),
                Neighbour::Boundary(_) | Neighbour::Padding => continue,
            };
            let (there, face_there) = (across.face / FACES, across.face % FACES);
            if (there, across.lane, face_there) < (block, lane, face) {
                continue;
            }
            let moduli = [own, law].map(|law| self.moduli[law]);
            for (point, weight) in self.operators.line.basis.weights[..m].iter().enumerate() {
                let opposite = if across.flip { m - 1 - point } else { point };
                let here = self.held_displacement(state, [block, lane, face, point]);
                let beyond = self.held_displacement(state, [there, across.lane, face_there, opposite]);
                let gap = [beyond[0] - here[0], beyond[1] - here[1]];
                sum -= 0.5 * weight * dot(hold(gap, moduli, 1.0), gap);
            }
        }
        sum
    }

    /// The held trace of the displacement at a point of a face, m.
    fn held_displacement(&self, state: &State, [block, lane, face, point]: [usize; 4]) -> [f64; AXES] {
        let (line, n) = (&self.operators.line, self.operators.nodes());
        let (first, stride) = if face < 2 { (point, line.m) } else { (point * line.m, 1) };
        let u = &state.u[(block * state.components + UNKNOWNS) * n..];
        let unheld = (!state.unheld.is_empty()).then(|| &state.unheld[block * AXES * n..]);
        let mut out = [0.0; AXES];
        for (i, end) in line.held[face % 2].iter().enumerate() {
            for (k, out) in out.iter_mut().enumerate() {
                let at = k * n + first + stride * i;
                *out += end * (u[at].0[lane] - unheld.map_or(0.0, |unheld| unheld[at].0[lane]));
            }
        }
        out
    }
}
