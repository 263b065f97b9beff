//! The rigid surface that conditions of contact share: what it does to a point of the boundary that is pressed against it.

use super::{FacePoint, free};
use crate::riemann::{Trace, tangent};
use crate::tensor::dot;

/// A rigid surface at a point of the boundary.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    /// Unit normal n, out of the body and into the obstacle.
    pub normal: [f64; 2],
    /// Speed of the surface along n and along its tangent (-n2, n1), m/s.
    pub speed: [f64; 2],
    /// Coulomb's coefficient of friction mu; 0 is a surface without friction.
    pub friction: f64,
}

/// A star state.
pub(super) struct Star {
    /// v*, m/s.
    pub v: [f64; 2],
    /// t*, Pa.
    pub t: [f64; 2],
}

impl Surface {
    /// The traction along n that keeps the body on the surface: T_N = t.n - z_p (v.n - w_n), Pa; below 0 where the surface pushes.
    pub fn traction(&self, inside: &Trace<f64>, at: &FacePoint) -> f64 {
        dot(inside.t, self.normal) - at.impedance(inside) * (dot(inside.v, self.normal) - self.speed[0])
    }

    /// The state on the surface: v*.n = w_n and t*.n = T_N, `along`. Without friction t* has no tangential part, and the body slips
    /// with v*.T = v.T - theta t.T/z_p. With friction t*.T is the traction t.T - z_p (v.T - w_T) of a body that sticks, cut to
    /// mu |T_N|, and v*.T = v.T + (t*.T - t.T)/z_p: w_T where it sticks. Where it slips it slips against t*.T, so that friction takes energy;
    /// with theta < 1 that would not be so.
    pub fn held(&self, inside: &Trace<f64>, at: &FacePoint, along: f64) -> Star {
        let (n, tangential) = (self.normal, tangent(self.normal));
        let (v, t) = (dot(inside.v, tangential), dot(inside.t, tangential));
        if self.friction == 0.0 {
            let slip = v - at.admittance(inside) * t;
            return Star { v: [0, 1].map(|i| self.speed[0] * n[i] + slip * tangential[i]), t: n.map(|n| along * n) };
        }
        let (z, limit) = (at.impedance(inside), self.friction * along.abs());
        let stick = t - z * (v - self.speed[1]);
        let drag = stick.clamp(-limit, limit);
        let slip = if drag == stick { self.speed[1] } else { v + (drag - t) / z };
        Star {
            v: [0, 1].map(|i| self.speed[0] * n[i] + slip * tangential[i]),
            t: [0, 1].map(|i| along * n[i] + drag * tangential[i]),
        }
    }

    /// The state of a body that touches the surface and may leave it, and whether the surface holds it: where the surface would
    /// have to pull, or where they do not touch, the boundary is free.
    pub fn unilateral(&self, inside: &Trace<f64>, at: &FacePoint, touches: bool) -> (Star, bool) {
        if !self.speed.iter().all(|speed| speed.is_finite()) {
            // An expression that is no number ends the run, as that of a wall that never lets go does.
            return (Star { v: [f64::NAN; 2], t: [f64::NAN; 2] }, false);
        }
        let along = self.traction(inside, at);
        // Not `along > 0`: a traction that is not a number is no contact.
        if touches && along <= 0.0 {
            return (self.held(inside, at, along), true);
        }
        (Star { v: free::velocity(inside, at), t: [0.0; 2] }, false)
    }
}
