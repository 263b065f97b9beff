//! Pairs of boundary faces that interact: which they are, where they meet, and the traction there.
//!
//! Where two faces lie opposite each other, the part that they share is cut out along their mean direction, with the Gauss points of
//! the scheme on it (mortar segments: Puso, Laursen, Comput. Methods Appl. Mech. Eng. 193, 2004). Both sides are interpolated to the
//! same points, and what acts there goes back to the face points of both with the same weights:
//!
//! ```text
//! W_i t_i = sum_g w_g l_i(s_g) t_g,       v*_i = v_i + Z^-1 (t_i - T_i)
//! ```
//!
//! So the sum of the forces of both sides is 0 to rounding. Since sum_g w_g l_i l_j over a part of a face is never more than the mass
//! matrix W_i of the whole face, the face points take no more energy than the points of the segment lose.

use super::received::ReceivedBySide;
use super::segments::{
    Chord, DeepestOverlap, Face, MOST, OVERLAP, Point, REACH, SHORTEST, Segment, along, shared, whole,
};
use super::{Law, Scheme};
use crate::contact::{Interaction, Pairs};
use crate::lane::LANES;
use crate::mesh::{FACES, map};
use crate::operators::{Neighbour, Operators};
use crate::state::{State, UNKNOWNS};
use crate::sum::exact_sum;
use rstar::primitives::GeomWithData;
use rstar::{AABB, RTree};
use std::sync::Arc;

/// Two boundary groups (by number; the same twice where a group meets itself) and what acts between them.
#[derive(Clone)]
pub struct Pairing {
    /// The groups.
    pub groups: [usize; 2],
    /// What acts.
    pub law: Arc<dyn Interaction>,
}

/// The faces of all pairings; the same during a run on one grid.
pub(super) struct Contacts {
    /// What acts, with its faces: of the first group and of the second.
    pairings: Vec<(Pairing, [Vec<usize>; 2])>,
    /// All faces, ascending by cell of the mesh and local face: what several segments give to a face is added in this order, which
    /// does not depend on the blocks.
    pub faces: Vec<Face>,
    /// [`Face::key`] and the number of each face, ascending.
    by_key: Vec<(usize, usize)>,
    /// Where no pairs are found anew: the two sides of each edge of a cut.
    cuts: Vec<(usize, [usize; 2])>,
}

impl Contacts {
    /// Those of `pairings`; none without any.
    pub fn new(operators: &Operators, laws: &[Law], pairings: &[Pairing]) -> Option<Self> {
        if pairings.is_empty() {
            return None;
        }
        let (mut faces, mut groups) = (vec![], vec![]);
        for &(block, lane) in &operators.blocks.slot {
            for (face, lanes) in operators.blocks.neighbours[block].iter().enumerate() {
                let Neighbour::Boundary(group) = &lanes[lane] else { continue };
                if pairings.iter().any(|pairing| pairing.groups.contains(group)) {
                    let law = &laws[operators.blocks.material[block]];
                    faces.push(Face::new(operators, law, [block, face, lane]));
                    groups.push(*group);
                }
            }
        }
        let mut by_key: Vec<_> = faces.iter().map(Face::key).zip(0..).collect();
        by_key.sort_unstable();
        let of = |group: usize| (0..faces.len()).filter(|&k| groups[k] == group).collect::<Vec<_>>();
        let pairings: Vec<_> = pairings.iter().map(|one| (one.clone(), one.groups.map(of))).collect();
        let mut out = Self { pairings, faces, by_key, cuts: vec![] };
        out.cuts = out.find_cuts();
        Some(out)
    }

    /// The law of a pairing.
    pub fn law(&self, pairing: usize) -> &dyn Interaction {
        &*self.pairings[pairing].0.law
    }

    /// The number of a face among those that interact.
    pub fn number(&self, face: usize, lane: usize) -> Option<usize> {
        self.by_key.binary_search_by_key(&(face * LANES + lane), |(key, _)| *key).ok().map(|at| self.by_key[at].1)
    }

    /// Blocks whose traces each other's faces may read, by block: what a plan of the step has to know.
    pub fn link(&self, graph: &mut [Vec<usize>]) {
        let block = |face: &usize| self.faces[*face].face / FACES;
        let mut link = |a: usize, b: usize| {
            graph[a].push(b);
            graph[b].push(a);
        };
        for (pairing, [first, second]) in &self.pairings {
            if pairing.law.pairs() == Pairs::Current {
                let blocks = [first, second].map(|faces| {
                    let mut blocks: Vec<usize> = faces.iter().map(block).collect();
                    blocks.sort_unstable();
                    blocks.dedup();
                    blocks
                });
                blocks[0].iter().for_each(|&a| blocks[1].iter().for_each(|&b| link(a, b)));
            }
        }
        self.cuts.iter().for_each(|(_, [a, b])| link(block(a), block(b)));
        for near in graph {
            near.sort_unstable();
            near.dedup();
        }
    }

    /// The two sides of each edge of a cut: faces of the group with the same middle.
    fn find_cuts(&self) -> Vec<(usize, [usize; 2])> {
        let mut cuts = vec![];
        for (number, (pairing, [faces, _])) in self.pairings.iter().enumerate() {
            if pairing.law.pairs() == Pairs::Current {
                continue;
            }
            let middle =
                |face: usize| [0, 1].map(|k| 0.5 * (self.faces[face].ends[0][k] + self.faces[face].ends[1][k]));
            let tree = RTree::bulk_load(faces.iter().map(|&face| GeomWithData::new(middle(face), face)).collect());
            for &face in faces {
                let near = SHORTEST * self.faces[face].h;
                let found = tree.locate_within_distance(middle(face), near * near).map(|found| found.data);
                cuts.extend(found.filter(|other| *other > face).map(|other| (number, [face, other])));
            }
        }
        cuts.sort_unstable();
        cuts
    }

    /// How many pairings there are.
    pub fn len(&self) -> usize {
        self.pairings.len()
    }

    /// Whether each face of the pairings of cuts has its other side; else the first that has none.
    pub fn without_partner(&self) -> Option<[[f64; 2]; 2]> {
        let mut has = vec![false; self.faces.len()];
        self.cuts.iter().flat_map(|(_, faces)| faces).for_each(|&face| has[face] = true);
        let of_cuts = self.pairings.iter().filter(|(pairing, _)| pairing.law.pairs() == Pairs::Initial);
        of_cuts.flat_map(|(_, [faces, _])| faces).find(|face| !has[**face]).map(|&face| self.faces[face].ends)
    }
}

impl Scheme {
    /// The deepest overlap of bodies in `state`; none where no condition pairs any.
    pub fn overlap(&self, state: &State) -> Option<DeepestOverlap> {
        let mut meetings = Meetings::new(self)?;
        meetings.find(self, state);
        Some(meetings.deepest)
    }

    /// The boundary groups of each pairing, by number: of the first and of the second side.
    pub fn pairs(&self) -> Vec<[usize; 2]> {
        self.contacts.iter().flat_map(|contacts| contacts.pairings.iter().map(|(pairing, _)| pairing.groups)).collect()
    }

    /// By pairing of boundary groups, the cells whose faces may act on each other.
    pub fn cells_that_meet(&self) -> Vec<Vec<usize>> {
        let Some(contacts) = &self.contacts else { return vec![] };
        let cell = |face: &usize| {
            let face = &contacts.faces[*face];
            self.operators.blocks.cells[face.face / FACES][face.lane]
        };
        contacts.pairings.iter().map(|(_, faces)| faces.iter().flatten().map(cell).collect()).collect()
    }
}

/// Where faces meet in a step.
#[derive(Default)]
pub(super) struct Meetings {
    /// The shared parts.
    pub segments: Vec<Segment>,
    /// By face, the segments in which it is the first or the second side.
    pub of_face: Vec<Vec<(usize, usize)>>,
    /// Current positions of the points of each face, and of its ends.
    points: Vec<[[f64; 2]; MOST]>,
    ends: Vec<[[f64; 2]; 2]>,
    /// What each side of a segment receives in the step; none where nobody asks for it.
    pub received: Option<Vec<[ReceivedBySide; 2]>>,
    /// The deepest overlap so far.
    pub deepest: DeepestOverlap,
    /// Pairs that may meet, and the positions of the ends when they were found.
    candidates: Vec<(usize, [usize; 2])>,
    found_at: Vec<[[f64; 2]; 2]>,
}

impl Meetings {
    /// Those of no step yet.
    pub fn new(scheme: &Scheme) -> Option<Box<Self>> {
        let faces = scheme.contacts.as_ref()?.faces.len();
        Some(Box::new(Self {
            of_face: vec![vec![]; faces],
            points: vec![[[0.0; 2]; MOST]; faces],
            ends: vec![[[0.0; 2]; 2]; faces],
            ..Self::default()
        }))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.segments[..])
            + size_of_val(&self.points[..])
            + 2 * size_of_val(&self.ends[..])
            + size_of_val(&self.candidates[..])
            + self.received.as_ref().map_or(0, |received| size_of_val(&received[..]))
    }

    /// Finds where the faces meet in `state`.
    pub fn find(&mut self, scheme: &Scheme, state: &State) {
        let Some(contacts) = &scheme.contacts else { return };
        self.place(scheme, contacts, state);
        if self.has_moved(contacts) {
            self.search(contacts);
        }
        self.segments.clear();
        self.of_face.iter_mut().for_each(Vec::clear);
        let line = &scheme.operators.line;
        for &(pairing, faces) in &self.candidates {
            let chords = faces.map(|face| Chord::new(&contacts.faces[face], self.ends[face]));
            let points = faces.map(|face| &self.points[face]);
            let h = contacts.faces[faces[0]].h.min(contacts.faces[faces[1]].h);
            let segment = match contacts.law(pairing).pairs() {
                Pairs::Initial => Some(whole(faces.map(|face| &contacts.faces[face]), &chords, points, &line.basis)),
                Pairs::Current => {
                    let overlap = contacts.faces[faces[0]].overlap_with(&contacts.faces[faces[1]]);
                    let found = shared(&chords, points, &line.basis);
                    found.filter(|found| found.is_near(line.m, h, overlap)).inspect(|found| {
                        let depth = -found.mean_gap(line.m);
                        let new = DeepestOverlap { depth, share: depth / h, x: self.ends[faces[0]][0] };
                        self.deepest = self.deepest.or(new);
                    })
                }
            };
            if let Some(mut segment) = segment {
                (segment.pairing, segment.faces) = (pairing, faces);
                let [one, two] = faces.map(|face| contacts.faces[face].stiffness);
                segment.stiffness = one * two / (one + two);
                (0..2).for_each(|side| self.of_face[faces[side]].push((self.segments.len(), side)));
                self.segments.push(segment);
            }
        }
        if let Some(received) = &mut self.received {
            received.clear();
            received.resize_with(self.segments.len(), Default::default);
        }
    }

    /// The energy that springs between overlapping sides and edges with memory store in `state`, J/m.
    pub fn stored(&mut self, scheme: &Scheme, state: &State) -> f64 {
        self.find(scheme, state);
        let Some(contacts) = &scheme.contacts else { return 0.0 };
        let m = scheme.operators.line.m;
        let of_segment = |segment: &Segment| -> f64 {
            let (law, face) = (contacts.law(segment.pairing), &contacts.faces[segment.faces[0]]);
            let of_point = |(i, at): (usize, &Point)| {
                let place = [face.face / FACES, face.face % FACES, face.lane, i];
                at.weight
                    * law.stored(
                        &segment.overlap(at),
                        segment.length,
                        scheme.boundary_memory.look(&state.boundary, place),
                    )
            };
            // Points of a cut are those of the faces, in the order of the first.
            segment.points[..m].iter().enumerate().map(of_point).sum()
        };
        exact_sum(self.segments.iter().map(of_segment))
    }

    /// Current positions: X, and u where the state has it.
    fn place(&mut self, scheme: &Scheme, contacts: &Contacts, state: &State) {
        let (operators, line) = (&scheme.operators, &scheme.operators.line);
        let (m, n, stride) = (line.m, line.m * line.m, state.components * line.m * line.m);
        for (k, face) in contacts.faces.iter().enumerate() {
            let (block, local) = (face.face / FACES, face.face % FACES);
            let corners = operators.geometry.map_of(block, face.lane);
            let moved = |i: usize, s: f64| {
                let x = map::position(&corners, map::on_face(local, s));
                if !state.has_displacement() {
                    return x;
                }
                // u on the face: along the other direction the values at its end.
                let value = |axis: usize| -> f64 {
                    let u = &state.u[block * stride + (UNKNOWNS + axis) * n..][..n];
                    let node = |j: usize| if local < 2 { j * m + i } else { i * m + j };
                    (0..m).map(|j| line.ends[local % 2][j] * u[node(j)].0[face.lane]).sum()
                };
                [x[0] + value(0), x[1] + value(1)]
            };
            for (i, s) in line.basis.nodes.iter().enumerate() {
                self.points[k][i] = moved(i, *s);
            }
            for (end, values) in line.ends.iter().enumerate() {
                self.ends[k][end] = along(values, &self.points[k]);
            }
        }
    }

    /// Whether faces may have come so near since the last search that new pairs meet.
    fn has_moved(&self, contacts: &Contacts) -> bool {
        let far = |(face, then): (usize, &[[f64; 2]; 2])| {
            let now = &self.ends[face];
            let moved = |k: usize| (now[k][0] - then[k][0]).hypot(now[k][1] - then[k][1]);
            moved(0).max(moved(1)) > 0.5 * REACH * contacts.faces[face].h
        };
        self.found_at.is_empty() || self.found_at.iter().enumerate().any(far)
    }

    /// Finds the pairs that may meet before [`Meetings::has_moved`]: those whose boxes, widened, overlap.
    fn search(&mut self, contacts: &Contacts) {
        let bound = |face: usize, by: f64| {
            let [[a, b], [c, d]] = self.ends[face];
            AABB::from_corners([a.min(c) - by, b.min(d) - by], [a.max(c) + by, b.max(d) + by])
        };
        let largest = contacts.faces.iter().map(|face| face.h).fold(0.0, f64::max);
        self.candidates.clear();
        self.candidates.extend_from_slice(&contacts.cuts);
        for (number, (pairing, [first, second])) in contacts.pairings.iter().enumerate() {
            if pairing.law.pairs() == Pairs::Initial {
                continue;
            }
            let boxes = second.iter().map(|&face| {
                let bound = bound(face, 0.0);
                GeomWithData::new(rstar::primitives::Rectangle::from_aabb(bound), face)
            });
            let tree = RTree::bulk_load(boxes.collect());
            let is_self = pairing.groups[0] == pairing.groups[1];
            for &face in first {
                let near = tree.locate_in_envelope_intersecting(bound(face, (REACH + OVERLAP) * largest));
                let new = |other: &usize| {
                    contacts.faces[*other].face / FACES != contacts.faces[face].face / FACES
                        || contacts.faces[*other].lane != contacts.faces[face].lane
                };
                let others = near.map(|found| found.data).filter(|other| (!is_self || *other > face) && new(other));
                self.candidates.extend(others.map(|other| (number, [face, other])));
            }
        }
        self.candidates.sort_unstable();
        self.found_at.clone_from(&self.ends);
    }
}
