//! Rigid wall that the body may leave and reach.

use super::surface::Surface;
use super::{Boundary, Data, FacePoint, Moment, mean, wall};
use crate::riemann::{Trace, star};
use crate::tensor::dot;

/// A wall along the boundary of the initial configuration, a gap away. With T_N = t.N - z_p (v.N - v_w) of the averaged trace:
/// T_N <= 0 and gap <= 0 is the wall, anything else the free surface; then gap <- gap - dt (v*.N - v_w). One decision for each face
/// point and step, so that nothing chatters within a step.
///
/// The gap goes below 0 in the step in which it closes, by dt v at most, and keeps that: it is the true distance, so that what a body goes
/// in at each impact does not add up. (A bar of 1 m that flies between two walls at 1 mm/s, c = 1 m/s, 20 cells, goes 1e-5 m beyond them in
/// 60 s; with gap <- max(0, ..) it is 3e-5 m, and more with each of the 25 impacts.) A wall at rest does no work, whatever the gap: no rule
/// for it makes energy.
///
/// Without friction a closed point has what the bilateral wall adds to the rows of F for the image behind it. A square (10 x 10 cells) thrown
/// at 600 and 60 m/s against the wall loses 4.3 % of its energy without it (S3) and 3.4 % with it, with a curl of 47 and of 1.3 1/m; at 200 m/s it
/// makes no difference of 1e-5. With friction it would take the shear that friction makes, and the run blows up.
#[derive(Clone)]
pub struct Unilateral {
    /// The gap at the start, m.
    pub gap: [f64; 1],
    /// Speed v_w of the wall along the outward normal, m/s; none for a wall at rest.
    pub speed: Option<Data>,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
}

impl Boundary for Unilateral {
    fn memory(&self) -> &[f64] {
        &self.gap
    }

    fn gap(&self, _: [f64; 2], memory: &[f64]) -> Option<f64> {
        Some(memory[0])
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6] {
        let (n, gap) = (at.normal, &mut memory[0]);
        let moving = self.speed.as_ref().map_or(0.0, |speed| mean(speed, at.x, when));
        let surface = Surface { normal: n, speed: [moving, 0.0], friction: self.friction };
        let (state, closed) = surface.unilateral(inside, at, *gap <= 0.0);
        *gap -= when.dt * (dot(state.v, n) - moving);
        let mut flux = star(state.v, state.t, n);
        if closed && self.friction == 0.0 {
            let add = wall::image(inside, at);
            (0..4).for_each(|k| flux[k] += add[k]);
        }
        flux
    }
}
