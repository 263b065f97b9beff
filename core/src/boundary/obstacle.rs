//! A rigid obstacle in the current configuration.

use super::shape::Shape;
use super::surface::Surface;
use super::whole_face::{Touch, WholeFace};
use super::{Boundary, Data, FacePoint, Moment, mean};
use crate::riemann::{Trace, current_normal, star};
use crate::tensor::dot;

/// A rigid obstacle that moves without turning, with the velocity w. Each point of the boundary keeps r, how far it has moved relative
/// to the obstacle: dr/dt = v* - w, 0 at the start. It is at X + r in the axes of the obstacle, whose distance there is the gap, with the
/// normal -n out of the obstacle. T_N = t.n - z_p (v - w).n <= 0 and gap <= 0 is contact: v*.n = w.n, t* = T_N n without friction,
/// per area of the initial configuration; anything else is the free surface.
///
/// The gap is the true distance: a body goes in by dt v at most when it closes, that stays while they touch, and does not add up. A step
/// along a curved obstacle opens the gap by (dt slip)^2 / (2 radius), so that now and then a step is free; a
/// correction of the position or of w would make energy. An obstacle at rest does no work but that of friction.
///
/// What is finer than the points of a face, a corner of a polygon or a disc, is tested against the face itself: see [`WholeFace`].
#[derive(Clone)]
pub struct Obstacle {
    /// What it is, where it stands at the start.
    pub shape: Shape,
    /// Its velocity w, m/s, which depends on time alone; none for an obstacle at rest.
    pub velocity: Option<[Data; 2]>,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
}

impl Boundary for Obstacle {
    fn memory(&self) -> &[f64] {
        &[0.0; 2]
    }

    fn gap(&self, x: [f64; 2], memory: &[f64]) -> Option<f64> {
        Some(self.shape.distance([x[0] + memory[0], x[1] + memory[1]]).0)
    }

    fn depth(&self, face: &WholeFace, memory: &[f64]) -> f64 {
        let (moved, _) = memory.as_chunks::<2>();
        let mut deepest = 0.0_f64;
        for (i, at) in face.points.iter().enumerate() {
            let (gap, out) = self.shape.distance([at.x[0] + moved[i][0], at.x[1] + moved[i][1]]);
            if gap < 0.0 && dot(face.normal_at(i, moved), out) < 0.0 {
                deepest = deepest.max(-gap);
            }
        }
        self.shape.each_tip(|tip| deepest = face.touch(&tip, moved).map_or(deepest, |touch| deepest.max(touch.depth)));
        deepest
    }

    fn sees_faces(&self) -> bool {
        self.shape.has_tips()
    }

    fn face_flux(&self, face: &WholeFace, when: &Moment, memory: &mut [f64], flux: &mut [[f64; 6]]) -> bool {
        let (moved, _) = memory.as_chunks::<2>();
        let w = self.velocity_at(&face.points[0], when);
        if !w.iter().all(|w| w.is_finite()) {
            return false;
        }
        let mut touches = vec![];
        self.shape.each_tip(|tip| touches.extend(face.touch(&tip, moved)));
        if touches.is_empty() {
            return false;
        }
        let tips = touches.len();
        for (i, (at, inside)) in face.points.iter().zip(face.inside).enumerate() {
            let (gap, out) = self.shape.distance([at.x[0] + moved[i][0], at.x[1] + moved[i][1]]);
            let normal = out.map(|out| -out);
            let s = face.basis.nodes[i];
            let is_held = touches[..tips].iter().any(|tip| (tip.s - s).abs() < BESIDE);
            if gap <= 0.0 && !is_held && looks(inside, at, normal) {
                let values = (0..moved.len()).map(|k| f64::from(u8::from(k == i))).collect();
                touches.push(Touch { s, normal, values, force: [0.0; 2], depth: -gap });
            }
        }
        let v = face.held(&mut touches, w, self.friction, flux);
        if touches[..tips].iter().all(|tip| tip.force[0] == 0.0) {
            return false;
        }
        for (memory, v) in memory.as_chunks_mut::<2>().0.iter_mut().zip(v) {
            (0..2).for_each(|i| memory[i] += when.dt * (v[i] - w[i]));
        }
        true
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6] {
        let w = self.velocity_at(at, when);
        let (gap, out) = self.shape.distance([at.x[0] + memory[0], at.x[1] + memory[1]]);
        let n = out.map(|out| -out);
        let surface = Surface { normal: n, speed: [dot(w, n), n[0] * w[1] - n[1] * w[0]], friction: self.friction };
        let (state, _) = surface.unilateral(inside, at, gap <= 0.0 && looks(inside, at, n));
        (0..2).for_each(|i| memory[i] += when.dt * (state.v[i] - w[i]));
        star(state.v, state.t, at.normal)
    }
}

/// A point of a face this near to a tip, over the length of the face, is held with the tip. By itself it would be nearly the same condition
/// along another normal, and forces that are found in turn would come to no end: they made up to 6e-6 of the energy of the face in a step.
const BESIDE: f64 = 0.02;

impl Obstacle {
    fn velocity_at(&self, at: &FacePoint, when: &Moment) -> [f64; 2] {
        self.velocity.as_ref().map_or([0.0; 2], |both| [0, 1].map(|i| mean(&both[i], at.x, when)))
    }
}

/// Whether a face point looks along n, into the obstacle. The far side of a thin body may lie within the obstacle too: it does not.
fn looks(inside: &Trace<f64>, at: &FacePoint, n: [f64; 2]) -> bool {
    dot(current_normal(inside.f, inside.f, at.normal), n) > 0.0
}
