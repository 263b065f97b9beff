//! Elastic foundation.

use super::{Boundary, FacePoint, Moment};
use crate::riemann::{Trace, star, tangent};
use crate::tensor::dot;

/// t* = -k u - c v* along the normal N and the tangent, both of the initial configuration, per area of it. u, the memory, is the displacement
/// of the face point since the start: du/dt = v*.
///
/// v* = v + theta (t* - t) / z_p has t* with the u of the middle of the step, u + dt v*/2, and is solved for v*. So a step takes
/// k (u1^2 - u0^2)/2 + c v*^2 dt from the body exactly: with the energy of the springs, which counts as (negative) work of the outside, nothing
/// is made, however stiff they are. With u of the start of the step the run is stable for k dt / (rho0 c_p) < 1 alone.
#[derive(Debug, Clone, Copy)]
pub struct Foundation {
    /// k along the normal and along the tangent, Pa/m.
    pub stiffness: [f64; 2],
    /// c along the normal and along the tangent, Pa s/m.
    pub damping: [f64; 2],
}

impl Boundary for Foundation {
    /// u along the normal and along the tangent, m.
    fn memory(&self) -> &[f64] {
        &[0.0; 2]
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6] {
        let axes = [at.normal, tangent(at.normal)];
        let (y, half) = (at.admittance(inside), 0.5 * when.dt);
        let (mut v, mut t) = ([0.0; 2], [0.0; 2]);
        for (k, axis) in axes.into_iter().enumerate() {
            let (stiffness, damping, u) = (self.stiffness[k], self.damping[k], &mut memory[k]);
            let driven = dot(inside.v, axis) - y * (stiffness * *u + dot(inside.t, axis));
            let speed = driven / (1.0 + y * (damping + half * stiffness));
            let traction = -stiffness * (*u + half * speed) - damping * speed;
            *u += when.dt * speed;
            (0..2).for_each(|i| {
                v[i] += speed * axis[i];
                t[i] += traction * axis[i];
            });
        }
        star(v, t, at.normal)
    }
}
