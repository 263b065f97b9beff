//! Frictionless bilateral wall, moving or not; at rest it is the plane of symmetry.

use super::surface::Surface;
use super::{Boundary, Data, FacePoint, GivesBack, Moment, mean};
use crate::riemann::{Dual, Trace, star};
use crate::tensor::dot;

/// v*.N = v_w, t*.N = t.N - z_p (v.N - v_w), t*.T = 0, v*.T = v.T - theta t.T / z_p: the flux [`Dual`] against the mirror image of
/// the inside, with what that flux adds to the rows of F for the jump of F to its image: it turns the body's edge into the
/// wall without work.
#[derive(Clone)]
pub struct Wall {
    /// Speed v_w of the wall along the outward normal, m/s; none for a wall at rest.
    pub speed: Option<Data>,
}

/// What the jump of F to its image counts. With 1 a J2 bar at 227 m/s loses J > 0 in the corner of two walls (S3, S4); 3 is
/// beyond the step limit between walls.
const IMAGE: f64 = 2.0;

impl Boundary for Wall {
    fn mirror(&self, x: [f64; 2], time: f64) -> Option<f64> {
        Some(self.speed.as_ref().map_or(0.0, |speed| speed(x, time)))
    }

    fn gives_back(&self) -> GivesBack {
        GivesBack::Along
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, _: &mut [f64]) -> [f64; 6] {
        let n = at.normal;
        let wall = self.speed.as_ref().map_or(0.0, |speed| mean(speed, at.x, when));
        let surface = Surface { normal: n, speed: [wall, 0.0], friction: 0.0 };
        let state = surface.held(inside, at, surface.traction(inside, at));
        let mut flux = star(state.v, state.t, n);
        let add = image(inside, at);
        (0..4).for_each(|k| flux[k] += add[k]);
        flux
    }
}

/// What is added to the rows of F for the jump of F to its image.
pub(super) fn image(inside: &Trace<f64>, at: &FacePoint) -> [f64; 4] {
    let n = at.normal;
    Dual::incompatible(inside, &mirror(inside, n), n, inside.c[0], &at.medium).map(|add| IMAGE * add)
}

/// The image of F and t behind the wall: M F M and M t with M = 1 - 2 N N^T, and t looked at with the same N.
fn mirror(inside: &Trace<f64>, n: [f64; 2]) -> Trace<f64> {
    let reflect = |x: [f64; 2]| [0, 1].map(|i| x[i] - 2.0 * n[i] * dot(n, x));
    let [a, b] = [reflect([inside.f[0], inside.f[1]]), reflect([inside.f[2], inside.f[3]])];
    let (one, two) = (reflect([a[0], b[0]]), reflect([a[1], b[1]]));
    let along = dot(inside.t, n);
    // Of the traction the normal part stays and the tangential one turns.
    let t = [0, 1].map(|i| 2.0 * along * n[i] - inside.t[i]);
    Trace { f: [one[0], two[0], one[1], two[1]], t, ..*inside }
}
