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

use super::Scheme;
use crate::basis::Lagrange;
use crate::contact::{Interaction, Pairs};
use crate::lane::LANES;
use crate::mesh::{FACES, map};
use crate::operators::{Neighbour, Operators};
use crate::riemann::tangent;
use crate::state::{State, UNKNOWNS};
use crate::tensor::dot;
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

/// Face points of the largest degree.
const MOST: usize = Scheme::LARGEST_DEGREE + 1;

/// Faces whose directions are further from opposite than this cosine do not meet.
const OPPOSITE: f64 = -0.5;

/// Faces that overlap by more than this part of the smaller cell are no pair: they are the two sides of a thin body.
const OVERLAP: f64 = 0.25;

/// Pairs up to this part of a cell apart are looked at in each step. Between two searches faces may move by half of it.
const REACH: f64 = 0.5;

/// Steps of Newton's method to a point of a face; it starts at an error of the order of h^2, squared each time.
const NEWTON: usize = 3;

/// Points further from those of the chord than this part of a face are none.
const FOLDED: f64 = 0.3;

/// Shared parts shorter than this part of a face are none.
const SHORTEST: f64 = 1e-9;

/// A face of a group that interacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face {
    /// 4 block + local face.
    pub face: usize,
    /// The lane of its cell.
    pub lane: usize,
    /// Its ends in the initial configuration, in the direction of its points, m.
    ends: [[f64; 2]; 2],
    /// h_e of its cell, m.
    h: f64,
}

impl Face {
    /// Whether the body lies to the left of its direction, as for the faces xi1 = 1 and xi2 = 0.
    fn is_left(&self) -> bool {
        matches!(self.face % FACES, 1 | 2)
    }

    fn key(&self) -> usize {
        self.face * LANES + self.lane
    }
}

/// The faces of all pairings; the same during a run on one grid.
pub(super) struct Contacts {
    /// What acts, with its faces: of the first group and of the second.
    pairings: Vec<(Pairing, [Vec<usize>; 2])>,
    /// All faces, ascending by block, face and lane.
    pub faces: Vec<Face>,
    /// Where no pairs are found anew: the two sides of each edge of a cut.
    cuts: Vec<(usize, [usize; 2])>,
}

impl Contacts {
    /// Those of `pairings`; none without any.
    pub fn new(operators: &Operators, pairings: &[Pairing]) -> Option<Self> {
        if pairings.is_empty() {
            return None;
        }
        let (mut faces, mut groups) = (vec![], vec![]);
        for (block, around) in operators.blocks.neighbours.iter().enumerate() {
            for (face, lanes) in around.iter().enumerate() {
                for (lane, neighbour) in lanes.iter().enumerate() {
                    let Neighbour::Boundary(group) = neighbour else { continue };
                    if pairings.iter().any(|pairing| pairing.groups.contains(group)) {
                        faces.push(Face::new(operators, [block, face, lane]));
                        groups.push(*group);
                    }
                }
            }
        }
        let of = |group: usize| (0..faces.len()).filter(|&k| groups[k] == group).collect::<Vec<_>>();
        let pairings: Vec<_> = pairings.iter().map(|one| (one.clone(), one.groups.map(of))).collect();
        let mut out = Self { pairings, faces, cuts: vec![] };
        out.cuts = out.find_cuts();
        Some(out)
    }

    /// The law of a pairing.
    pub fn law(&self, pairing: usize) -> &dyn Interaction {
        &*self.pairings[pairing].0.law
    }

    /// The number of a face among those that interact.
    pub fn number(&self, face: usize, lane: usize) -> Option<usize> {
        self.faces.binary_search_by_key(&(face * LANES + lane), Face::key).ok()
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

    /// Whether each face of the pairings of cuts has its other side; else the first that has none.
    pub fn without_partner(&self) -> Option<[[f64; 2]; 2]> {
        let mut has = vec![false; self.faces.len()];
        self.cuts.iter().flat_map(|(_, faces)| faces).for_each(|&face| has[face] = true);
        let of_cuts = self.pairings.iter().filter(|(pairing, _)| pairing.law.pairs() == Pairs::Initial);
        of_cuts.flat_map(|(_, [faces, _])| faces).find(|face| !has[**face]).map(|&face| self.faces[face].ends)
    }
}

impl Scheme {
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

impl Face {
    fn new(operators: &Operators, [block, face, lane]: [usize; 3]) -> Self {
        let corners = operators.geometry.corners_of(block, lane);
        let ends = [0.0, 1.0].map(|s| map::position(&corners, on_face(face, s)));
        let h = operators.geometry.blocks[block].lane(lane).h;
        Self { face: FACES * block + face, lane, ends, h }
    }
}

/// Parent coordinates at s on a local face.
fn on_face(face: usize, s: f64) -> [f64; 2] {
    let end = (face % 2) as f64;
    if face < 2 { [end, s] } else { [s, end] }
}

/// A Gauss point of a segment.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Point {
    /// w_g, its share of the current length, m.
    pub weight: f64,
    /// (x_2 - x_1).n, m.
    pub gap: f64,
    /// Current over initial length of both sides.
    pub stretch: [f64; 2],
    /// l_i(s_g) on both sides.
    pub values: [[f64; MOST]; 2],
}

/// What two faces share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// The pairing.
    pub pairing: usize,
    /// Both faces, see [`Contacts::faces`].
    pub faces: [usize; 2],
    /// The current unit normal, out of the first.
    pub normal: [f64; 2],
    /// Its points.
    pub points: [Point; MOST],
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
            let Some(mut segment) = shared(&chords, points, &line.basis) else { continue };
            let h = contacts.faces[faces[0]].h.min(contacts.faces[faces[1]].h);
            let cut = contacts.law(pairing).pairs() == Pairs::Initial;
            if cut || segment.is_near(line.m, h) {
                (segment.pairing, segment.faces) = (pairing, faces);
                (0..2).for_each(|side| self.of_face[faces[side]].push((self.segments.len(), side)));
                self.segments.push(segment);
            }
        }
    }

    /// Current positions: X, and u where the state has it.
    fn place(&mut self, scheme: &Scheme, contacts: &Contacts, state: &State) {
        let (operators, line) = (&scheme.operators, &scheme.operators.line);
        let (m, n, stride) = (line.m, line.m * line.m, state.components * line.m * line.m);
        for (k, face) in contacts.faces.iter().enumerate() {
            let (block, local) = (face.face / FACES, face.face % FACES);
            let corners = operators.geometry.corners_of(block, face.lane);
            let moved = |i: usize, s: f64| {
                let x = map::position(&corners, on_face(local, s));
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
        let far = |((face, now), then): ((&Face, &[[f64; 2]; 2]), &[[f64; 2]; 2])| {
            let moved = |k: usize| (now[k][0] - then[k][0]).hypot(now[k][1] - then[k][1]);
            moved(0).max(moved(1)) > 0.5 * REACH * face.h
        };
        self.found_at.is_empty() || contacts.faces.iter().zip(&self.ends).zip(&self.found_at).any(far)
    }

    /// Finds the pairs that may meet before [`Meetings::has_moved`]: those whose boxes, widened by a cell, overlap.
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
                let near = tree.locate_in_envelope_intersecting(bound(face, 2.0 * REACH * largest));
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

fn along(values: &[f64], points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| values.iter().zip(points).map(|(value, x)| value * x[k]).sum())
}

/// A face as the straight line between its ends, with the body to its left.
struct Chord {
    from: [f64; 2],
    to: [f64; 2],
    /// Unit direction.
    direction: [f64; 2],
    /// In the initial configuration, m.
    length: f64,
    /// Whether its points run the other way.
    reversed: bool,
}

impl Chord {
    fn new(face: &Face, ends: [[f64; 2]; 2]) -> Self {
        let reversed = !face.is_left();
        let [from, to] = if reversed { [ends[1], ends[0]] } else { ends };
        let d = [to[0] - from[0], to[1] - from[1]];
        let current = d[0].hypot(d[1]).max(f64::MIN_POSITIVE);
        let [a, b] = face.ends;
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        Self { from, to, direction: d.map(|d| d / current), length, reversed }
    }

    /// The coordinate of its points at `x` along `axis`.
    fn parameter(&self, x: f64, axis: [f64; 2]) -> f64 {
        let (from, to) = (dot(self.from, axis), dot(self.to, axis));
        let s = (x - from) / (to - from);
        if self.reversed { 1.0 - s } else { s }
    }

    /// l_i(s) and |dx/ds| along `axis` at the point of the face whose coordinate along `axis` is `x`: then both sides of a segment
    /// stand opposite each other along the normal, and a pressure between them has no moment. (With s of the chord two discs that
    /// meet obliquely gain 1.9 % of their angular momentum at S2, with this they lose .16 %.)
    fn reach(&self, x: f64, axis: [f64; 2], points: &[[f64; 2]], basis: &Lagrange) -> (Vec<f64>, f64) {
        let first = self.parameter(x, axis);
        let chord = (dot(self.to, axis) - dot(self.from, axis)).abs();
        let mut s = first;
        let mut slope = chord;
        for _ in 0..NEWTON {
            let at = dot(along(&basis.values(s), points), axis);
            slope = dot(along(&basis.derivatives(s), points), axis);
            s -= (at - x) / slope;
        }
        // A face that folds over has no such point.
        if (s - first).abs() > FOLDED || slope.abs() < FOLDED * chord {
            return (basis.values(first), chord);
        }
        (basis.values(s), slope.abs())
    }
}

/// The part that two faces share, with its points; none where they do not lie opposite each other.
fn shared(chords: &[Chord; 2], points: [&[[f64; 2]; MOST]; 2], basis: &Lagrange) -> Option<Segment> {
    let [a, b] = chords;
    if dot(a.direction, b.direction) > OPPOSITE {
        return None;
    }
    let mean = [a.direction[0] - b.direction[0], a.direction[1] - b.direction[1]];
    let size = mean[0].hypot(mean[1]);
    let axis = mean.map(|x| x / size);
    // The body is to the left of a, the outside to its right.
    let normal = tangent(axis).map(|x| -x);
    let ([a0, a1], [b0, b1]) = ([a.from, a.to].map(|x| dot(x, axis)), [b.to, b.from].map(|x| dot(x, axis)));
    let (low, high) = (a0.max(b0), a1.min(b1));
    if high - low <= SHORTEST * a.length.min(b.length) {
        return None;
    }
    let mut out = Segment { pairing: 0, faces: [0; 2], normal, points: [Point::default(); MOST] };
    for (out, (node, weight)) in out.points.iter_mut().zip(basis.nodes.iter().zip(&basis.weights)) {
        let x = low + (high - low) * node;
        let mut at = [[0.0; 2]; 2];
        for (side, chord) in chords.iter().enumerate() {
            let (values, slope) = chord.reach(x, axis, points[side], basis);
            at[side] = along(&values, points[side]);
            out.values[side][..values.len()].copy_from_slice(&values);
            out.stretch[side] = slope / chord.length;
        }
        out.weight = (high - low) * weight;
        out.gap = dot([at[1][0] - at[0][0], at[1][1] - at[0][1]], normal);
    }
    Some(out)
}

impl Segment {
    /// Whether its sides are near each other, and do not overlap so far that they are the two sides of a thin body.
    fn is_near(&self, m: usize, h: f64) -> bool {
        let gaps = || self.points[..m].iter().map(|point| point.gap);
        gaps().fold(f64::INFINITY, f64::min) < REACH * h && gaps().sum::<f64>() > -OVERLAP * h * m as f64
    }
}
