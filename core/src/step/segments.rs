//! Faces that lie opposite each other, and the segments that they share.

use super::Law;
use crate::basis::Lagrange;
use crate::contact;
use crate::lane::LANES;
use crate::mesh::{FACES, map};
use crate::operators::Operators;
use crate::riemann::tangent;
use crate::tensor::dot;

/// Face points of the largest degree.
pub(super) const MOST: usize = super::Scheme::LARGEST_DEGREE + 1;

/// Faces whose directions are further from opposite than this cosine do not meet.
const OPPOSITE: f64 = -0.5;

/// Faces that overlap by more than this part of the smaller cell are no pair.
pub(super) const OVERLAP: f64 = 1.0;

/// The same for faces that lie back to back in the initial configuration: they may be the two sides of a thin body.
const OVERLAP_OF_BACKS: f64 = 0.25;

/// Pairs up to this part of a cell apart are looked at in each step. Between two searches faces may move by half of it.
pub(super) const REACH: f64 = 0.5;

/// Steps of Newton's method to a point of a face; it starts at an error of the order of h^2, squared each time.
const NEWTON: usize = 3;

/// Points further from those of the chord than this part of a face are none.
const FOLDED: f64 = 0.3;

/// Shared parts shorter than this part of a face are none.
pub(super) const SHORTEST: f64 = 1e-9;

/// A face of a group that interacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face {
    /// 4 block + local face.
    pub face: usize,
    /// The lane of its cell.
    pub lane: usize,
    /// Its ends in the initial configuration, in the direction of its points, m.
    pub ends: [[f64; 2]; 2],
    /// Where it is curved the vector from the middle of its chord to its own, m.
    pub bulge: [f64; 2],
    /// h_e of its cell, m.
    pub h: f64,
    /// rho0 c_p^2/h_e at F = 1, Pa/m.
    pub stiffness: f64,
}

impl Face {
    /// Whether the body lies to the left of its direction, as for the faces xi1 = 1 and xi2 = 0.
    fn is_left(&self) -> bool {
        matches!(self.face % FACES, 1 | 2)
    }

    pub fn key(&self) -> usize {
        self.face * LANES + self.lane
    }

    /// By how much of the smaller cell it may overlap with another face that it meets.
    pub fn overlap_with(&self, other: &Face) -> f64 {
        let middle = |face: &Face| [0, 1].map(|k| 0.5 * (face.ends[0][k] + face.ends[1][k]));
        let (own, other_middle) = (middle(self), middle(other));
        let apart = [0, 1].map(|k| other_middle[k] - own[k]);
        let is_behind = |face: &Face, to: [f64; 2]| dot(Chord::new(face, face.ends).outward(), to) < 0.0;
        let back_to_back = is_behind(self, apart) && is_behind(other, apart.map(|x| -x));
        if back_to_back { OVERLAP_OF_BACKS } else { OVERLAP }
    }
}

impl Face {
    pub fn new(operators: &Operators, law: &Law, [block, face, lane]: [usize; 3]) -> Self {
        let map = operators.geometry.map_of(block, lane);
        let ends = [0.0, 1.0].map(|s| map::position(&map, map::on_face(face, s)));
        let bulge = map.bulge.map_or([0.0; 2], |bulge| bulge[face]);
        let h = operators.geometry.blocks[block].lane(lane).h;
        let speed = law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
        Self { face: FACES * block + face, lane, ends, bulge, h, stiffness: law.density() * speed * speed / h }
    }
}

/// A Gauss point of a segment.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Point {
    /// w_g, its share of the current length (for the sides of a cut of the initial one), m.
    pub weight: f64,
    /// (x_2 - x_1).n, m.
    pub gap: f64,
    /// The length that w_g counts over the initial one, of both sides.
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
    /// Its length, m.
    pub length: f64,
    /// Of the cells of both faces in a row, Pa/m.
    pub stiffness: f64,
    /// Its points.
    pub points: [Point; MOST],
}

pub(super) fn along(values: &[f64], points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| values.iter().zip(points).map(|(value, x)| value * x[k]).sum())
}

/// A face as the straight line between its ends, with the body to its left.
pub(super) struct Chord {
    from: [f64; 2],
    to: [f64; 2],
    /// Unit direction.
    direction: [f64; 2],
    /// In the initial configuration, m.
    length: f64,
    /// b - a and the bulge d of its curve in the initial configuration, X(s) = a + s (b - a) + 4 s (1 - s) d; none where it is straight.
    curve: Option<[[f64; 2]; 2]>,
    /// Whether its points run the other way.
    reversed: bool,
}

impl Chord {
    pub fn new(face: &Face, ends: [[f64; 2]; 2]) -> Self {
        let reversed = !face.is_left();
        let [from, to] = if reversed { [ends[1], ends[0]] } else { ends };
        let d = [to[0] - from[0], to[1] - from[1]];
        let current = d[0].hypot(d[1]).max(f64::MIN_POSITIVE);
        let [a, b] = face.ends;
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let curve = (face.bulge != [0.0; 2]).then(|| [[b[0] - a[0], b[1] - a[1]], face.bulge]);
        Self { from, to, direction: d.map(|d| d / current), length, curve, reversed }
    }

    /// |dX/ds| in the initial configuration, m.
    fn length_at(&self, s: f64) -> f64 {
        let Some([edge, bulge]) = self.curve else { return self.length };
        let [a, b] = [0, 1].map(|k| edge[k] + (4.0 - 8.0 * s) * bulge[k]);
        a.hypot(b)
    }

    /// The unit normal out of the body, which is to the left.
    fn outward(&self) -> [f64; 2] {
        tangent(self.direction).map(|x| -x)
    }

    /// The coordinate of its points at `x` along `axis`.
    fn parameter(&self, x: f64, axis: [f64; 2]) -> f64 {
        let (from, to) = (dot(self.from, axis), dot(self.to, axis));
        let s = (x - from) / (to - from);
        if self.reversed { 1.0 - s } else { s }
    }

    /// l_i(s) and |dx/ds| along `axis` over |dX/ds| at the point of the face whose coordinate along `axis` is `x`: then both sides of a segment
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
            return (basis.values(first), chord / self.length_at(first));
        }
        (basis.values(s), slope.abs() / self.length_at(s))
    }
}

/// The part that two faces share, with its points; none where they do not lie opposite each other.
pub(super) fn shared(chords: &[Chord; 2], points: [&[[f64; 2]; MOST]; 2], basis: &Lagrange) -> Option<Segment> {
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
    let mut out = Segment::empty(normal, high - low);
    for (out, (node, weight)) in out.points.iter_mut().zip(basis.nodes.iter().zip(&basis.weights)) {
        let x = low + (high - low) * node;
        let mut at = [[0.0; 2]; 2];
        for (side, chord) in chords.iter().enumerate() {
            let (values, stretch) = chord.reach(x, axis, points[side], basis);
            at[side] = along(&values, points[side]);
            out.values[side][..values.len()].copy_from_slice(&values);
            out.stretch[side] = stretch;
        }
        out.weight = (high - low) * weight;
        out.gap = dot([at[1][0] - at[0][0], at[1][1] - at[0][1]], normal);
    }
    Some(out)
}

/// The two sides of an edge of a cut: each point of the one faces that of the other at the same place in the initial configuration,
/// wherever both are now. Lengths are those of the initial configuration.
pub(super) fn whole(
    faces: [&Face; 2],
    chords: &[Chord; 2],
    points: [&[[f64; 2]; MOST]; 2],
    basis: &Lagrange,
) -> Segment {
    let [a, b] = chords;
    let mean = [a.direction[0] - b.direction[0], a.direction[1] - b.direction[1]];
    let size = mean[0].hypot(mean[1]);
    // Sides that have turned onto each other have no mean direction.
    let axis = if size > SHORTEST { mean.map(|x| x / size) } else { a.direction };
    let normal = tangent(axis).map(|x| -x);
    let mut out = Segment::empty(normal, a.length);
    let far = |end: usize| {
        let (x, y) = (faces[0].ends[0], faces[1].ends[end]);
        (x[0] - y[0]).hypot(x[1] - y[1])
    };
    let flip = far(1) < far(0);
    for (i, (out, weight)) in out.points.iter_mut().zip(&basis.weights).enumerate() {
        let length = a.length_at(basis.nodes[i]);
        let j = if flip { basis.len() - 1 - i } else { i };
        (out.values[0][i], out.values[1][j]) = (1.0, 1.0);
        (out.weight, out.stretch) = (length * weight, [1.0; 2]);
        out.gap = dot([points[1][j][0] - points[0][i][0], points[1][j][1] - points[0][i][1]], normal);
    }
    out
}

impl Segment {
    /// Without points and faces yet.
    fn empty(normal: [f64; 2], length: f64) -> Self {
        Self { pairing: 0, faces: [0; 2], normal, length, stiffness: 0.0, points: [Point::default(); MOST] }
    }

    /// How far its sides overlap at a point.
    pub fn overlap(&self, at: &Point) -> contact::Overlap {
        contact::Overlap { depth: (-at.gap).max(0.0), stiffness: self.stiffness }
    }

    /// Whether its sides are near each other, and overlap by no more than a part of the length `h`.
    pub fn is_near(&self, m: usize, h: f64, overlap: f64) -> bool {
        let gaps = || self.points[..m].iter().map(|point| point.gap);
        gaps().fold(f64::INFINITY, f64::min) < REACH * h && self.mean_gap(m) > -overlap * h
    }

    /// The mean of the gaps at its points, m.
    pub fn mean_gap(&self, m: usize) -> f64 {
        self.points[..m].iter().map(|point| point.gap).sum::<f64>() / m as f64
    }
}

/// The deepest overlap of two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeepestOverlap {
    /// The mean of a segment of two faces, m.
    pub depth: f64,
    /// The same over the length h_e of the smaller cell. Beyond 1 faces are no pair any more.
    pub share: f64,
    /// Where, in the current configuration, m.
    pub x: [f64; 2],
}

impl DeepestOverlap {
    /// The deeper one, by the share of a cell.
    #[must_use]
    pub fn or(self, other: DeepestOverlap) -> DeepestOverlap {
        if other.share > self.share { other } else { self }
    }
}
