//! The flux at face points whose face meets another one.

use super::across::Traces;
use super::block::Block;
use super::segments::{Point, Segment};
use super::sides::Met;
use super::single_face::SingleFace;
use crate::contact::{Meeting, Side};
use crate::lane::F8;
use crate::mesh::FACES;
use crate::riemann::{Trace, star};
use crate::state::UNKNOWNS;

/// The unit normal of a face where its polynomials have these values; that of a straight face to the bit.
fn mean_normal(values: &[f64], normals: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let all: Vec<[f64; 2]> = normals.collect();
    if all.iter().all(|normal| *normal == all[0]) {
        return all[0];
    }
    let sum = |k: usize| values.iter().zip(&all).map(|(value, normal)| value * normal[k]).sum::<f64>();
    let [a, b] = [sum(0), sum(1)];
    let size = a.hypot(b);
    [a / size, b / size]
}

impl Block<'_> {
    /// The flux at a point of a face that meets others: with the traction t that they leave there and the push q of overlaps, t* = t + q,
    /// v* = v + Z^-1 (t - T). None where it meets nothing.
    pub(super) fn flux_of_meeting(
        &self,
        met: Met,
        of_cell: &SingleFace,
        own: &[F8],
        point: usize,
        memory: &mut [f64],
    ) -> Option<[f64; UNKNOWNS]> {
        let (face, lane) = (of_cell.face, of_cell.lane);
        let contacts = self.scheme.contacts.as_ref()?;
        let number = contacts.number(FACES * self.number + face, lane)?;
        let met_by = &met.meetings.of_face[number];
        if met_by.is_empty() {
            return None;
        }
        let line = &self.scheme.operators.line;
        let memory = self.scheme.boundary_memory.of_point(memory, [self.number, face, lane, point]);
        let (mut force, mut push) = ([0.0; 2], [0.0; 2]);
        let mut shares = vec![];
        for &(number, side) in met_by {
            let segment = &met.meetings.segments[number];
            let [t, q] = self.force_of_segment(met, (segment, side), point, own.len(), memory);
            (0..2).for_each(|i| force[i] += t[i]);
            (0..2).for_each(|i| push[i] += q[i]);
            if met.meetings.received.is_some() {
                shares.push((number, side, [0, 1].map(|i| t[i] + q[i])));
            }
        }
        let at = of_cell.point(point);
        let (_, length) = of_cell.normal_and_length(point);
        let per_length = |force: f64| force / (line.basis.weights[point] * length);
        let (t, push) = (force.map(per_length), push.map(per_length));
        let x = |k: usize| own[k].0[lane];
        let f = [x(0), x(1), x(2), x(3)];
        let inside = Trace { f, v: [x(4), x(5)], t: [x(6), x(7)], c: self.law().speeds(f, at.normal) };
        let dv = at.characteristic(&inside).solve([t[0] - inside.t[0], t[1] - inside.t[1]]);
        let v = [inside.v[0] + dv[0], inside.v[1] + dv[1]];
        if let Some(received) = &met.meetings.received {
            shares.into_iter().for_each(|(segment, side, share)| received[segment][side].add(share, v, self.factor()));
        }
        Some(star(v, [t[0] + push[0], t[1] + push[1]], at.normal))
    }

    /// The force of a segment at a point of a face, the side of it of this number, N/m: of the traction, and of the push of overlaps. `width`:
    /// numbers of the traces of a face.
    fn force_of_segment(
        &self,
        met: Met,
        (segment, side): (&Segment, usize),
        point: usize,
        width: usize,
        memory: &mut [f64],
    ) -> [[f64; 2]; 2] {
        let (mut force, mut push) = ([0.0; 2], [0.0; 2]);
        let Some(contacts) = &self.scheme.contacts else { return [force, push] };
        let law = contacts.law(segment.pairing);
        // The points of a cut are those of the faces: `share` is 0 but at one, whose memory this is.
        for at in &segment.points[..self.scheme.operators.line.m] {
            let share = at.values[side][point];
            if share == 0.0 {
                continue;
            }
            let sides = [0, 1].map(|k| self.side(segment, at, k, met.traces, width));
            let (gap, step, dt) = (at.gap, self.stage.dt, self.factor());
            let (normal, overlap, length) = (segment.normal, segment.overlap(at), segment.length);
            let meeting = Meeting { sides, normal, gap, overlap, length, step, dt };
            let (t, pressure) = (law.traction(&meeting, memory), law.push(&meeting));
            let weight = if side == 0 { at.weight * share } else { -at.weight * share };
            (0..2).for_each(|i| force[i] += weight * t[i]);
            (0..2).for_each(|i| push[i] -= weight * pressure * normal[i]);
        }
        [force, push]
    }

    /// What a side of a segment shows at a point of it.
    fn side(&self, segment: &Segment, at: &Point, side: usize, traces: &Traces, width: usize) -> Side {
        let (scheme, m) = (self.scheme, self.scheme.operators.line.m);
        let Some(contacts) = &scheme.contacts else { return Side { v: [0.0; 2], t: [0.0; 2], z: [1.0; 2] } };
        let face = &contacts.faces[segment.faces[side]];
        let (block, numbers) = (face.face / FACES, traces.faces(face.face, 1, m * width));
        let of = |k: usize| -> f64 { (0..m).map(|i| at.values[side][i] * numbers[i * width + k].0[face.lane]).sum() };
        let law = &scheme.laws[scheme.operators.blocks.material[block]];
        let metric = scheme.operators.geometry.of(block);
        let normals = (0..m).map(|i| metric.at_face_of(face.lane, face.face % FACES, i).0);
        let normal = mean_normal(&at.values[side][..m], normals);
        let c = law.speeds([of(0), of(1), of(2), of(3)], normal);
        let per_length = 1.0 / at.stretch[side];
        Side {
            v: [of(4), of(5)],
            t: [per_length * of(6), per_length * of(7)],
            z: c.map(|c| law.density() * c * per_length),
        }
    }
}
