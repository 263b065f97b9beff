//! Faces of the boundary under conditions that are obstacles: how each goes on beyond its ends, and how deep bodies are in obstacles.

use super::block::Block;
use super::segments::DeepestOverlap;
use super::{Scheme, Stage};
use crate::boundary::{FacePoint, WholeFace};
use crate::mesh::map;
use crate::operators::Neighbour;
use crate::state::State;
use std::collections::HashMap;

/// Ends of faces at a corner: the number of the face, and which end of it.
type Ends = Vec<(usize, usize)>;

/// A face under an obstacle.
struct Face {
    /// Its condition.
    group: usize,
    /// Block, face of the cell, lane.
    place: [usize; 3],
    /// Ends in the initial configuration, m.
    ends: [[f64; 2]; 2],
    /// How it is curved, see [`WholeFace`].
    bulge: [f64; 2],
    /// Length h_e of its cell, m.
    h: f64,
    /// Its points.
    points: Vec<FacePoint>,
    /// At each end the face of the same group that the boundary goes on with, and which end of it.
    next: [Option<(usize, usize)>; 2],
    /// The direction of that face away from the end at the start of the step.
    beyond: [Option<[f64; 2]>; 2],
}

/// All of them, cells in the order of the mesh.
pub(super) struct Obstacles {
    faces: Vec<Face>,
    /// The number of a face by its place.
    by_place: HashMap<[usize; 3], usize>,
    /// Where the body was deepest in an obstacle at the start of a step.
    pub deepest: DeepestOverlap,
}

impl std::fmt::Debug for Obstacles {
    fn fmt(&self, to: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(to, "{} faces under obstacles", self.faces.len())
    }
}

/// The corners at the ends of a local face.
fn corners_of_face(face: usize) -> [usize; 2] {
    [[0, 3], [1, 2], [0, 1], [3, 2]][face]
}

impl Obstacles {
    /// Those of a scheme; none where no condition is an obstacle.
    pub fn new(scheme: &Scheme) -> Option<Box<Self>> {
        let is_obstacle: Vec<bool> =
            scheme.boundaries.iter().map(|own| own.gap([0.0; 2], own.memory()).is_some()).collect();
        let mut out = Self { faces: vec![], by_place: HashMap::new(), deepest: DeepestOverlap::default() };
        let blocks = &scheme.operators.blocks;
        // Corners are nodes of the mesh: those of two cells are equal to the last bit.
        let mut at_corner: HashMap<(usize, [u64; 2]), Ends> = HashMap::new();
        for &(block, lane) in &blocks.slot {
            let map = scheme.operators.geometry.map_of(block, lane);
            for (face, lanes) in blocks.neighbours[block].iter().enumerate() {
                let Neighbour::Boundary(group) = lanes[lane] else { continue };
                if !is_obstacle.get(group).is_some_and(|is| *is) {
                    continue;
                }
                for (end, corner) in corners_of_face(face).into_iter().enumerate() {
                    let key = (group, map.corners[corner].map(f64::to_bits));
                    at_corner.entry(key).or_default().push((out.faces.len(), end));
                }
                out.by_place.insert([block, face, lane], out.faces.len());
                out.faces.push(Face::new(scheme, group, [block, face, lane]));
            }
        }
        for ends in at_corner.values() {
            // Where more than two meet, at a corner that two bodies share, none is the next.
            if let [(a, end_a), (b, end_b)] = ends[..] {
                out.faces[a].next[end_a] = Some((b, end_b));
                out.faces[b].next[end_b] = Some((a, end_a));
            }
        }
        (!out.faces.is_empty()).then(|| Box::new(out))
    }

    /// Whether a condition of a scheme is an obstacle.
    pub fn is_asked_for(scheme: &Scheme) -> bool {
        scheme.boundaries.iter().any(|own| own.gap([0.0; 2], own.memory()).is_some())
    }

    /// Looks at a state at the start of a step.
    pub fn look(&mut self, scheme: &Scheme, state: &State) {
        if scheme.sees_faces {
            for number in 0..self.faces.len() {
                let beyond = self.faces[number].next.map(|next| {
                    let (other, end) = next?;
                    let other = &self.faces[other];
                    let (moved, _) = other.memory(scheme, state)?.as_chunks::<2>();
                    Some(other.whole(scheme).direction_from(end, moved))
                });
                self.faces[number].beyond = beyond;
            }
        }
        for face in &self.faces {
            let Some(memory) = face.memory(scheme, state) else { continue };
            let depth = scheme.boundaries[face.group].depth(&face.whole(scheme), memory);
            if depth > 0.0 {
                let new = DeepestOverlap { depth, share: depth / face.h, x: face.ends[0] };
                self.deepest = self.deepest.or(new);
            }
        }
    }

    /// How the boundary goes on beyond the ends of a face.
    pub fn beyond(&self, place: [usize; 3]) -> [Option<[f64; 2]>; 2] {
        self.by_place.get(&place).map_or([None; 2], |number| self.faces[*number].beyond)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let points: usize = self.faces.iter().map(|face| size_of_val(&face.points[..])).sum();
        points + size_of_val(&self.faces[..]) + self.by_place.len() * size_of::<([usize; 3], usize)>()
    }
}

impl Face {
    fn new(scheme: &Scheme, group: usize, place: [usize; 3]) -> Self {
        let [number, face, lane] = place;
        let geometry = &scheme.operators.geometry;
        let stage = Stage { number: 0, times: &[], row: &[], dt: 0.0, elapsed: 0.0, obstacles: None };
        let block = Block { scheme, stage: &stage, number };
        let map = geometry.map_of(number, lane);
        Self {
            group,
            place,
            ends: [0.0, 1.0].map(|s| map::position(&map, map::on_face(face, s))),
            bulge: map.bulge.map_or([0.0; 2], |bulge| bulge[face]),
            h: geometry.blocks[number].lane(lane).h,
            points: block.face_points(face, lane),
            next: [None; 2],
            beyond: [None; 2],
        }
    }

    /// The face, without what its cell shows.
    fn whole<'a>(&'a self, scheme: &'a Scheme) -> WholeFace<'a> {
        let basis = &scheme.operators.line.basis;
        WholeFace { ends: self.ends, bulge: self.bulge, points: &self.points, inside: &[], basis, beyond: self.beyond }
    }

    /// The memory of its points in a state; none of a state that was not stepped yet.
    fn memory<'a>(&self, scheme: &Scheme, state: &'a State) -> Option<&'a [f64]> {
        let numbers = scheme.boundary_memory.look_at_face(&state.boundary, self.place, self.points.len());
        (!numbers.is_empty()).then_some(numbers)
    }
}

impl Scheme {
    /// Of each group whose condition is an obstacle, how many of its points lie in it in `state`, and the deepest: group, count, number of
    /// points, depth over all with the share of the cell and the place.
    pub fn points_in_obstacles(&self, state: &State) -> Vec<(usize, usize, usize, DeepestOverlap)> {
        let Some(obstacles) = Obstacles::new(self) else { return vec![] };
        let mut start = State::default();
        // A state that has not been stepped yet may lack the memory.
        let state = if state.boundary.len() == self.boundary_memory.len() {
            state
        } else {
            self.set_boundary_memory(&mut start, &[]);
            &start
        };
        let mut out: Vec<(usize, usize, usize, DeepestOverlap)> = vec![];
        for face in &obstacles.faces {
            let Some(memory) = face.memory(self, state) else { continue };
            if out.iter().all(|(group, ..)| *group != face.group) {
                out.push((face.group, 0, 0, DeepestOverlap::default()));
            }
            let Some(own) = out.iter_mut().find(|(group, ..)| *group == face.group) else { continue };
            for (at, memory) in face.points.iter().zip(memory.chunks(memory.len() / face.points.len())) {
                let depth = -self.boundaries[face.group].gap(at.x, memory).unwrap_or(0.0);
                own.2 += 1;
                if depth > 0.0 {
                    own.1 += 1;
                    own.3 = own.3.or(DeepestOverlap { depth, share: depth / face.h, x: at.x });
                }
            }
        }
        out
    }
}
