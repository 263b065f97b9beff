//! Which faces have springs against their creep ([`crate::riemann::creep`]), how stiff these are, and what a state keeps of them:
//! room, energy, and what goes over to another grid.

use super::{Flux, Law, Scheme};
use crate::boundary::GivesBack;
use crate::error::{Error, Result};
use crate::lane::{F8, LANES};
use crate::mesh::FACES;
use crate::operators::{Blocks, Neighbour};
use crate::riemann::{Looks, creep};
use crate::state::State;
use crate::tensor::AXES;
use std::collections::HashMap;

/// rho0 c_p^2 at F = 1 by law, Pa; empty where the flux has no springs.
pub(super) fn moduli(laws: &[Law], flux: &Flux) -> Vec<f64> {
    let modulus = |law: &Law| law.density() * law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0].powi(2);
    let has_springs = flux.looks() == Looks::Displacement;
    if has_springs { laws.iter().map(modulus).collect() } else { vec![] }
}

/// How stiff the springs of the faces are, by law and by boundary group, found once: laws and conditions are dynamic calls away. Empty
/// where faces have none.
#[derive(Debug, Default)]
pub(super) struct Stiffness {
    /// beta M between two laws, Pa, [law][law].
    between: Vec<f64>,
    /// k l at a boundary, Pa, [law][group].
    at_edges: Vec<f64>,
    /// How the faces of a group give back what they creep.
    how: Vec<GivesBack>,
    /// Number of laws.
    laws: usize,
    /// The entry of `held` of each block: most blocks of a body share one, which stays in the first cache.
    entry: Vec<u32>,
    held: Vec<Held>,
}

/// What the predictor asks of the springs of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held {
    /// What a cell takes of l k of a face, Pa: half of it between two cells, all of it at a side that gives back all.
    pub moduli: [F8; FACES],
    /// Whether a face gives back along itself alone, with half of a spring: these are not in `moduli`.
    pub has_walls: bool,
}

impl Stiffness {
    /// Of a scheme whose faces give back what they creep.
    fn new(scheme: &Scheme) -> Self {
        let laws = scheme.laws.len();
        let how: Vec<_> = scheme.boundaries.iter().map(|condition| condition.gives_back()).collect();
        let between = (0..laws * laws).map(|pair| scheme.find_between([pair / laws, pair % laws])).collect();
        let at_edge = |law| how.iter().map(move |how| scheme.find_at_edge(*how, law));
        let at_edges = (0..laws).flat_map(at_edge).collect();
        let mut new = Self { between, at_edges, how, laws, ..Self::default() };
        let mut entries = HashMap::new();
        for block in 0..scheme.operators.blocks.len() {
            let held = new.held(&scheme.operators.blocks, block);
            let bits = held.moduli.map(|modulus| modulus.0.map(f64::to_bits));
            let entry = *entries.entry((bits, held.has_walls)).or_insert_with(|| {
                new.held.push(held);
                new.held.len() - 1
            });
            new.entry.push(entry as u32);
        }
        new
    }

    fn between(&self, [law, other]: [usize; 2]) -> f64 {
        self.between.get(law * self.laws + other).copied().unwrap_or(0.0)
    }

    fn at_edge(&self, group: usize, law: usize) -> f64 {
        self.at_edges.get(law * self.how.len() + group).copied().unwrap_or(0.0)
    }

    fn held(&self, blocks: &Blocks, block: usize) -> Held {
        let (law, mut has_walls) = (blocks.material[block], false);
        let mut modulus = |neighbour: &Neighbour| match neighbour {
            Neighbour::Cell(_) => 0.5 * self.between([law; 2]),
            Neighbour::Interface(_, there) => 0.5 * self.between([law, *there]),
            Neighbour::Boundary(group) => {
                has_walls |= self.how[*group] == GivesBack::Along;
                if self.how[*group] == GivesBack::All { self.at_edge(*group, law) } else { 0.0 }
            }
            Neighbour::Padding => 0.0,
        };
        let moduli = std::array::from_fn(|face| F8(blocks.neighbours[block][face].each_ref().map(&mut modulus)));
        Held { moduli, has_walls }
    }
}

/// What a face of a cell has at its other side.
#[derive(PartialEq)]
enum Behind {
    Cell(usize),
    Edge(GivesBack),
}

impl Scheme {
    /// With springs that give back what faces creep ([`creep`]).
    ///
    /// # Errors
    /// A flux that lets no face creep so.
    pub fn with_springs(self) -> Result<Self> {
        if self.moduli.is_empty() {
            let what = "springs in the faces need the flux `dual`";
            return Err(Error::input(what, "give flux = \"dual\", or remove `springs` of [scheme]"));
        }
        if self.laws.iter().all(|law| law.has_memory()) {
            let what =
                "a law with internal variables has no springs in its faces: where it flows they would make energy";
            return Err(Error::input(what, "remove `springs` of [scheme], or give a part of the body another law"));
        }
        Ok(self.with_stiffness())
    }

    /// With springs whose stiffness is that of its laws and conditions.
    pub(super) fn with_stiffness(self) -> Self {
        let stiffness = Stiffness::new(&self);
        Self { stiffness, ..self }
    }

    /// Whether springs give back what faces creep.
    pub fn has_springs(&self) -> bool {
        self.stiffness.laws > 0
    }

    /// How the faces of a boundary group give back what they creep, where the scheme has springs.
    #[inline]
    pub(super) fn gives_back(&self, group: usize) -> GivesBack {
        self.stiffness.how[group]
    }

    /// How many cells have springs in their faces.
    pub fn cells_with_springs(&self) -> usize {
        let blocks = &self.operators.blocks;
        let own = blocks.material.iter().zip(&blocks.count).filter(|(law, _)| self.spring_between([**law; 2]) > 0.0);
        own.map(|(_, count)| count).sum()
    }

    /// Whether faces keep their creep.
    pub fn keeps_creep(&self) -> bool {
        (0..self.moduli.len()).any(|law| self.spring_between([law; 2]) > 0.0)
    }

    /// k l at a boundary group, Pa.
    #[inline]
    pub fn spring_at(&self, group: usize, law: usize) -> f64 {
        self.stiffness.at_edge(group, law)
    }

    /// beta M = k l of a face between two laws, Pa.
    #[inline]
    pub fn spring_between(&self, laws: [usize; 2]) -> f64 {
        self.stiffness.between(laws)
    }

    /// What the predictor asks of the springs of a block, where the scheme has springs.
    #[inline]
    pub(super) fn held_of(&self, block: usize) -> &Held {
        &self.stiffness.held[self.stiffness.entry[block] as usize]
    }

    /// k l at a boundary whose faces give back what they creep, Pa. The shear of a free side creeps at 1/(rho0 c_s): k is so much less that
    /// its relaxation is no faster than inside, at any c_p/c_s.
    fn find_at_edge(&self, how: GivesBack, law: usize) -> f64 {
        let inside = self.find_between([law; 2]);
        match how {
            GivesBack::Nothing => 0.0,
            GivesBack::Along => inside,
            GivesBack::All if inside > 0.0 => inside * (self.laws[law].shear_modulus() / self.moduli[law]).sqrt(),
            GivesBack::All => 0.0,
        }
    }

    /// beta M of a face between two laws, Pa; 0 where one of them has memory, see [`creep::spring`].
    fn find_between(&self, laws: [usize; 2]) -> f64 {
        let flows = laws.iter().any(|law| self.laws[*law].has_memory());
        if flows { 0.0 } else { creep::spring(self.operators.degree) * self.modulus_between(laws) }
    }

    /// M of a face between two laws, Pa.
    fn modulus_between(&self, laws: [usize; 2]) -> f64 {
        let of = |law: usize| self.moduli.get(law).copied().unwrap_or(0.0);
        if laws.iter().all(|law| of(*law) > 0.0) { creep::in_series(laws.map(of)) } else { 0.0 }
    }

    /// Numbers of the creep of a block.
    pub fn creep_of_block(&self) -> usize {
        FACES * self.operators.line.m * AXES
    }

    /// The creep of the faces of a block in a state; empty where they have no springs.
    pub(super) fn creep_of<'s>(&self, state: &'s State, block: usize) -> &'s [F8] {
        let (count, at) = (self.creep_of_block(), block - state.part.block);
        state.creep.get(count * at..count * (at + 1)).unwrap_or_default()
    }

    /// Numbers of the creep of a whole state.
    fn numbers_of_creep(&self) -> usize {
        if self.keeps_creep() { self.creep_of_block() * self.operators.blocks.len() } else { 0 }
    }

    /// Whether a whole state has the creep of its faces.
    pub(super) fn has_room_for_creep(&self, state: &State) -> bool {
        state.creep.len() == self.numbers_of_creep()
    }

    /// A state with room for the creep of its faces, which begins at 0 where the state has none.
    pub(super) fn make_room_for_creep(&self, state: &mut State) {
        if !self.has_room_for_creep(state) {
            state.creep = vec![F8::ZERO; self.numbers_of_creep()];
        }
    }

    /// The creep of a state of `before` on this grid, whose cells that are copies of old ones `same` names: faces between two of
    /// them that met there before keep it, and those at a boundary that is as it was; others begin at 0. Empty where they have no springs.
    pub fn creep_from(&self, before: &Scheme, state: &State, same: &[Option<usize>]) -> Vec<F8> {
        if state.creep.is_empty() || !self.keeps_creep() {
            return vec![];
        }
        let (blocks, count) = (&self.operators.blocks, self.creep_of_block());
        let old = before.operators.blocks.unpack(&state.creep, count);
        let mut new = vec![0.0; count * blocks.slot.len()];
        let copied = |cell: usize| same.get(cell).copied().flatten();
        for cell in 0..blocks.slot.len() {
            let Some(twin) = copied(cell) else { continue };
            for face in 0..FACES {
                let there = before.behind(twin, face);
                let stays = match self.behind(cell, face) {
                    Behind::Cell(other) => copied(other).is_some_and(|other| there == Behind::Cell(other)),
                    edge @ Behind::Edge(_) => there == edge,
                };
                if stays {
                    let of_face = face * count / FACES..(face + 1) * count / FACES;
                    new[count * cell..][of_face.clone()].copy_from_slice(&old[count * twin..][of_face]);
                }
            }
        }
        blocks.pack(&new, count, |_| 0.0)
    }

    fn behind(&self, cell: usize, face: usize) -> Behind {
        let blocks = &self.operators.blocks;
        let (block, lane) = blocks.slot[cell];
        match blocks.neighbours[block][face][lane] {
            Neighbour::Cell(there) | Neighbour::Interface(there, _) => {
                Behind::Cell(blocks.cells[there.face / FACES][there.lane])
            }
            Neighbour::Boundary(group) => Behind::Edge(self.boundaries[group].gives_back()),
            Neighbour::Padding => Behind::Edge(GivesBack::Nothing),
        }
    }

    /// What the springs of the faces of a block store, sum k/2 |a|^2 w l, J/m, a lane a cell; each side of an inner face has half.
    pub(super) fn stored_by_creep(&self, block: usize, creep: &[F8]) -> F8 {
        let mut out = F8::ZERO;
        if creep.is_empty() || self.spring_between([self.operators.blocks.material[block]; 2]) == 0.0 {
            return out;
        }
        let (m, blocks) = (self.operators.line.m, &self.operators.blocks);
        let law = blocks.material[block];
        let own = self.spring_between([law; 2]);
        let faces = creep.as_chunks::<AXES>().0.chunks_exact(m).zip(&blocks.neighbours[block]);
        for (points, neighbours) in faces {
            let mut sum = F8::ZERO;
            for (a, weight) in points.iter().zip(&self.operators.line.basis.weights) {
                for lane in 0..LANES {
                    sum.0[lane] += weight * (a[0].0[lane] * a[0].0[lane] + a[1].0[lane] * a[1].0[lane]);
                }
            }
            for (lane, neighbour) in neighbours.iter().enumerate() {
                let modulus = match neighbour {
                    Neighbour::Boundary(group) => match self.gives_back(*group) {
                        GivesBack::Along => 0.5 * own,
                        _ => self.spring_at(*group, law),
                    },
                    Neighbour::Cell(_) => 0.5 * own,
                    Neighbour::Interface(_, there) => 0.5 * self.spring_between([law, *there]),
                    Neighbour::Padding => 0.0,
                };
                out.0[lane] += 0.5 * modulus * sum.0[lane];
            }
        }
        out
    }
}
