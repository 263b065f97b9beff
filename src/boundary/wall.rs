//! Frictionless bilateral wall, moving or not; at rest it is the plane of symmetry.

use super::{Boundary, Data, FacePoint, TimeNode, mean};
use crate::riemann::{Trace, add_tangential, star, tangent};
use crate::tensor::{dot, times as product};

/// v*.N = v_w, t*.N = t.N - z_p (v.N - v_w), t*.T = 0, v*.T = v.T - t.T / z_s, and
/// Flux*_F += c_s N (N.F T) (x) T, which drives the shear N.F T of the wall to 0.
#[derive(Clone)]
pub struct Wall {
    /// Speed v_w of the wall along the outward normal, m/s; none for a wall at rest.
    pub speed: Option<Data>,
}

impl Boundary for Wall {
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, times: &[TimeNode]) -> [f64; 6] {
        let (n, t) = (at.normal, tangent(at.normal));
        let z = inside.c.map(|c| at.density * c);
        let wall = self.speed.as_ref().map_or(0.0, |speed| mean(speed, at.x, times));
        // The wall pushes against v.N - v_w > 0, so that the traction along N falls.
        let pressure = dot(inside.t, n) - z[0] * (dot(inside.v, n) - wall);
        let slip = dot(inside.v, t) - dot(inside.t, t) / z[1];
        let v = [0, 1].map(|i| wall * n[i] + slip * t[i]);
        let mut flux = star(v, n.map(|x| pressure * x), n);
        let shear = inside.c[1] * dot(n, product(inside.f, t));
        add_tangential(&mut flux, n.map(|x| shear * x), n);
        flux
    }
}
