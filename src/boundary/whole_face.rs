//! A face of the boundary as a whole: what a rigid obstacle does to it between its points.

use super::shape::{Shape, Tip, minus};
use super::{FacePoint, free};
use crate::basis::Lagrange;
use crate::riemann::{Trace, star, tangent};
use crate::tensor::dot;

/// A face of the boundary with all its points.
#[derive(Clone, Copy)]
pub struct WholeFace<'a> {
    /// Its ends in the initial configuration, in the direction of its points, m.
    pub ends: [[f64; 2]; 2],
    /// Its points.
    pub points: &'a [FacePoint],
    /// What the cell shows at each.
    pub inside: &'a [Trace<f64>],
    /// The polynomials on them.
    pub basis: &'a Lagrange,
}

/// A place of a face that an obstacle holds: v.n <= w.n there, by a force f n, f <= 0, and by friction.
pub(super) struct Touch {
    /// Unit normal n, out of the body.
    pub normal: [f64; 2],
    /// l_i at the place, by point of the face.
    pub values: Vec<f64>,
    /// The force on the body along n and along its tangent, N/m.
    pub force: [f64; 2],
}

/// How far beyond an end of a face the nearest place to a tip may lie; it is taken back to the end. A tip between two faces meets at least one.
const BEYOND: f64 = 0.05;

/// Steps of Newton's method to the place of a face that is nearest to a tip, from its place along the chord.
const NEWTON: usize = 5;

/// Rounds over the touches of a face, and the change of velocity, over the largest velocity, that ends them.
const ROUNDS: usize = 200;
const CLOSE: f64 = 1e-15;

/// Directions this far out of the cone of a corner (a sine) still look at it.
const ASKEW: f64 = 0.1;

fn along(values: &[f64], points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| values.iter().zip(points).map(|(value, x)| value * x[k]).sum())
}

impl WholeFace<'_> {
    /// The length in the initial configuration, m.
    pub fn length(&self) -> f64 {
        let [a, b] = self.ends;
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    /// Where a tip touches the face, whose points have moved by `moved`; none where it does not.
    pub(super) fn touch(&self, tip: &Tip, moved: &[[f64; 2]]) -> Option<Touch> {
        let [a, b] = self.ends;
        let far = |x: [f64; 2], y: [f64; 2]| (x[0] - y[0]).hypot(x[1] - y[1]);
        let at = |i: usize| [0, 1].map(|k| self.points[i].x[k] + moved[i][k]);
        let last = self.points.len() - 1;
        // Twice the way between the outer points is more than the face, but at degree 0.
        let size = self.length().max(2.0 * far(at(0), at(last)));
        if (0..=last).all(|i| far(at(i), tip.at) > tip.radius + size) {
            return None;
        }
        let edge = minus(b, a);
        let (mut s, mut values, mut slope, mut from) = (0.5, vec![], edge, [0.0; 2]);
        for _ in 0..=NEWTON {
            values = self.basis.values(s);
            let gradient = along(&self.basis.derivatives(s), moved);
            slope = [0, 1].map(|k| edge[k] + gradient[k]);
            let place = along(&values, moved);
            from = [0, 1].map(|k| tip.at[k] - (a[k] + s * edge[k] + place[k]));
            let step = dot(from, slope) / dot(slope, slope).max(f64::MIN_POSITIVE);
            if s + step < -BEYOND && s <= 0.0 || s + step > 1.0 + BEYOND && s >= 1.0 {
                return None;
            }
            s = (s + step).clamp(0.0, 1.0);
        }
        let out = dot(self.points[0].normal, tangent(edge)).signum();
        let length = slope[0].hypot(slope[1]).max(f64::MIN_POSITIVE);
        let normal = tangent(slope).map(|x| out * x / length);
        // A tip deeper than that is none that came through this face.
        let gap = dot(from, normal) - tip.radius;
        let deepest = if tip.radius > 0.0 { tip.radius.min(0.5 * length) } else { 0.5 * length };
        (gap <= 0.0 && gap > -deepest && tip.is_seen_along(normal)).then_some(Touch { normal, values, force: [0.0; 2] })
    }

    /// The flux at all points under these touches of an obstacle of velocity `w` with friction, and v* there. From the free surface, a = v -
    /// Z^-1 T, touches change the velocities of the points by
    ///
    /// ```text
    /// W_i t_i = sum_g l_i(s_g) f_g,      v*_i = a_i + Z_i^-1 t_i,      0 >= f_g.n_g,  (v*(s_g) - w).n_g <= 0,  one of both 0
    /// ```
    ///
    /// with Coulomb friction along the tangents. With b = v + Z^-1 T the face has the power sum_i W_i (t_i.b_i - T_i.Z^-1 T_i), which is
    /// sum_g f_g.v*(s_g) less a sum of squares: an obstacle at rest never makes energy, wherever it touches (the
    /// decomposition of Moreau, 1962). The forces on the body sum to those of the obstacle.
    pub(super) fn held(
        &self,
        touches: &mut [Touch],
        w: [f64; 2],
        friction: f64,
        flux: &mut [[f64; 6]],
    ) -> Vec<[f64; 2]> {
        let weight = |i: usize| self.basis.weights[i] * self.length();
        let z: Vec<_> = self.points.iter().zip(self.inside).map(|(at, inside)| at.characteristic(inside)).collect();
        let mut v: Vec<_> =
            self.points.iter().zip(self.inside).map(|(at, inside)| free::velocity(inside, at)).collect();
        let mut t = vec![[0.0; 2]; v.len()];
        let fastest = v.iter().flatten().chain(&w).fold(f64::MIN_POSITIVE, |most, v| most.max(v.abs()));
        for _ in 0..ROUNDS {
            let mut change = 0.0_f64;
            for touch in &mut *touches {
                for (k, axis) in
                    [touch.normal, tangent(touch.normal)].into_iter().enumerate().take(1 + usize::from(friction > 0.0))
                {
                    let give = |i: usize| z[i].solve(axis).map(|x| x * touch.values[i] / weight(i));
                    let own = along(&touch.values, &v);
                    let speed = dot([own[0] - w[0], own[1] - w[1]], axis);
                    let compliance: f64 = (0..v.len()).map(|i| touch.values[i] * dot(give(i), axis)).sum();
                    let most = friction * touch.force[0].abs();
                    let wanted = touch.force[k] - speed / compliance;
                    let force = if k == 0 { wanted.min(0.0) } else { wanted.clamp(-most, most) };
                    let more = force - touch.force[k];
                    touch.force[k] = force;
                    for i in 0..v.len() {
                        let give = give(i);
                        (0..2).for_each(|j| v[i][j] += more * give[j]);
                        (0..2).for_each(|j| t[i][j] += more * axis[j] * touch.values[i] / weight(i));
                    }
                    change = change.max((more * compliance).abs());
                }
            }
            if change <= CLOSE * fastest {
                break;
            }
        }
        for (i, flux) in flux.iter_mut().enumerate() {
            *flux = star(v[i], t[i], self.points[i].normal);
        }
        v
    }
}

impl Tip {
    /// Whether a face with this outward normal looks at it: the far side of a thin body does not.
    fn is_seen_along(&self, normal: [f64; 2]) -> bool {
        let back = normal.map(|n| -n);
        let Some([first, second]) = self.cone else { return true };
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let middle = [first[0] + second[0], first[1] + second[1]];
        cross(first, back) >= -ASKEW && cross(back, second) >= -ASKEW && dot(back, middle) > 0.0
    }
}

impl Shape {
    /// What of the obstacle may lie between the points of a face.
    pub(super) fn has_tips(&self) -> bool {
        !matches!(self, Self::HalfPlane { .. })
    }
}
