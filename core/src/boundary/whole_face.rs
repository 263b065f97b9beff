//! A face of the boundary as a whole: what a rigid obstacle does to it between its points.

use super::shape::{Shape, Tip};
use super::{FacePoint, free};
use crate::basis::Lagrange;
use crate::riemann::{Trace, star, tangent};
use crate::tensor::{cross, dot, minus};

/// A face of the boundary with all its points.
#[derive(Clone, Copy)]
pub struct WholeFace<'a> {
    /// Its ends in the initial configuration, in the direction of its points, m.
    pub ends: [[f64; 2]; 2],
    /// Where it is curved the vector d from the middle of its chord to its own, m: X(s) = a + s (b - a) + 4 s (1 - s) d.
    pub bulge: [f64; 2],
    /// Its points.
    pub points: &'a [FacePoint],
    /// What the cell shows at each.
    pub inside: &'a [Trace<f64>],
    /// The polynomials on them.
    pub basis: &'a Lagrange,
    /// At each end the current unit direction, away from it, of the face under the same condition that the boundary goes on with; none where
    /// another condition begins, or nothing is known.
    pub beyond: [Option<[f64; 2]>; 2],
}

/// A place of a face that an obstacle holds: v.n <= w.n there, by a force f n, f <= 0, and by friction.
pub(super) struct Touch {
    /// Its coordinate along the face, 0..=1.
    pub s: f64,
    /// Unit normal n, out of the body.
    pub normal: [f64; 2],
    /// l_i at the place, by point of the face.
    pub values: Vec<f64>,
    /// The force on the body along n and along its tangent, N/m.
    pub force: [f64; 2],
    /// How deep it lies in the obstacle, m.
    pub depth: f64,
}

/// The place of a face that is nearest to a point.
struct Place {
    /// Its coordinate along the face.
    s: f64,
    /// The way from it to the point, m.
    from: [f64; 2],
    /// dx/ds there, m.
    slope: [f64; 2],
    /// Whether the point lies beyond the end at s.
    over: bool,
}

/// How far beyond an end of a face the nearest place to a tip may lie; it is taken back to the end. A tip between two faces meets at least one.
const BEYOND: f64 = 0.05;

/// The same where the boundary goes on: both faces hold a tip near the end at which they join. With .05 the end of the other face fell past a
/// disc that lay a tenth of a cell away from it.
const JOINED: f64 = 0.25;

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
    /// dX/ds in the initial configuration, m.
    fn edge(&self, s: f64) -> [f64; 2] {
        let ([a, b], d) = (self.ends, self.bulge);
        [0, 1].map(|k| b[k] - a[k] + (4.0 - 8.0 * s) * d[k])
    }

    /// The length of its chord in the initial configuration, m.
    pub fn length(&self) -> f64 {
        let [a, b] = self.ends;
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    /// Where a tip touches the face, whose points have moved by `moved`; none where it does not.
    ///
    /// Near an end at which the boundary goes on both faces see a tip along nearly the same normal, and each holds it with its own trace: were
    /// it along the normal of each, the two ends would slip apart along the tip, which would go in between. A tip below that end, in the
    /// wedge that is beyond both faces, is held there too.
    pub(super) fn touch(&self, tip: &Tip, moved: &[[f64; 2]]) -> Option<Touch> {
        let far = |x: [f64; 2], y: [f64; 2]| (x[0] - y[0]).hypot(x[1] - y[1]);
        let at = |i: usize| [0, 1].map(|k| self.points[i].x[k] + moved[i][k]);
        let last = self.points.len() - 1;
        // Twice the way between the outer points is more than the face, but at degree 0.
        let size = self.length().max(2.0 * far(at(0), at(last)));
        if (0..=last).all(|i| far(at(i), tip.at) > tip.radius + size) {
            return None;
        }
        let Place { s, from, slope, over } = self.nearest(tip.at, moved)?;
        let length = slope[0].hypot(slope[1]).max(f64::MIN_POSITIVE);
        let own = self.outward(slope);
        let mut normal = self.smooth_normal(own, s, moved);
        let mut gap = dot(from, own) - tip.radius;
        if s == 0.0 || s == 1.0 {
            let end = usize::from(s == 1.0);
            if let Some(on) = self.beyond[end] {
                let (next, away) = (self.next_normal(end, on), if end == 0 { slope.map(|x| -x) } else { slope });
                // The other face has it, if this end is not in a disc, too; or it lies beside a corner that stands out.
                let is_in = from[0].hypot(from[1]) < tip.radius;
                if over && dot(from, on) >= 0.0 && !is_in || dot(away, next) > 0.0 && dot(from, next) > tip.radius {
                    return None;
                }
            }
            // What is nearest is a corner of the body.
            let (distance, along) = (from[0].hypot(from[1]), dot(from, normal));
            gap = if tip.radius > 0.0 { distance.copysign(along) } else { along } - tip.radius;
            if over && along > 0.0 {
                normal = from.map(|x| x / distance);
            }
        }
        // A tip deeper than that is none that came through this face.
        let deepest = if tip.radius > 0.0 { tip.radius.min(0.5 * length) } else { 0.5 * length };
        let values = self.basis.values(s);
        let holds = gap <= 0.0 && gap > -deepest && tip.is_seen_along(normal);
        holds.then_some(Touch { s, normal, values, force: [0.0; 2], depth: -gap })
    }

    /// The outward normal at s with its own value there made continuous along the boundary: at an end at which this goes on it is the mean of both
    /// faces', and what that changes fades towards the other end (averaged normals: Yang, Laursen, Meng, Int. J. Numer. Methods Eng. 62, 2005).
    fn smooth_normal(&self, own: [f64; 2], s: f64, moved: &[[f64; 2]]) -> [f64; 2] {
        let mut sum = own;
        for (end, share) in [1.0 - s, s].into_iter().enumerate() {
            let Some(on) = self.beyond[end].filter(|_| share > 0.0) else { continue };
            let next = self.next_normal(end, on);
            let direction = self.direction_from(end, moved);
            let here = self.outward(if end == 0 { direction } else { direction.map(|x| -x) });
            let mean = [here[0] + next[0], here[1] + next[1]];
            let size = mean[0].hypot(mean[1]);
            // Faces that lie back to back have no mean.
            if size > ASKEW {
                (0..2).for_each(|k| sum[k] += share * (mean[k] / size - here[k]));
            }
        }
        let size = sum[0].hypot(sum[1]);
        if size > ASKEW { sum.map(|x| x / size) } else { own }
    }

    /// The outward normal of the face that goes on beyond an end in the direction `on`.
    fn next_normal(&self, end: usize, on: [f64; 2]) -> [f64; 2] {
        self.outward(if end == 0 { on.map(|x| -x) } else { on })
    }

    /// The place of the face that is nearest to a point; none where that lies beyond an end at which the boundary does not go on.
    fn nearest(&self, x: [f64; 2], moved: &[[f64; 2]]) -> Option<Place> {
        let ([a, b], d) = (self.ends, self.bulge);
        let chord = minus(b, a);
        let mut out = Place { s: 0.5, from: [0.0; 2], slope: chord, over: false };
        for _ in 0..=NEWTON {
            let gradient = along(&self.basis.derivatives(out.s), moved);
            let edge = self.edge(out.s);
            out.slope = [0, 1].map(|k| edge[k] + gradient[k]);
            let place = along(&self.basis.values(out.s), moved);
            let bump = 4.0 * out.s * (1.0 - out.s);
            out.from = [0, 1].map(|k| x[k] - (a[k] + out.s * chord[k] + bump * d[k] + place[k]));
            let next = out.s + dot(out.from, out.slope) / dot(out.slope, out.slope).max(f64::MIN_POSITIVE);
            let beyond = self.beyond.map(|on| if on.is_some() { JOINED } else { BEYOND });
            out.over = next < -beyond[0] && out.s <= 0.0 || next > 1.0 + beyond[1] && out.s >= 1.0;
            if out.over {
                let end = usize::from(out.s >= 1.0);
                return self.beyond[end].is_some().then_some(out);
            }
            out.s = next.clamp(0.0, 1.0);
        }
        Some(out)
    }

    /// The unit normal out of the body of a face with this direction, which goes as its points do.
    fn outward(&self, direction: [f64; 2]) -> [f64; 2] {
        let out = dot(self.points[0].normal, tangent(minus(self.ends[1], self.ends[0]))).signum();
        let length = direction[0].hypot(direction[1]).max(f64::MIN_POSITIVE);
        tangent(direction).map(|x| out * x / length)
    }

    /// The current outward normal at a point.
    pub(super) fn normal_at(&self, point: usize, moved: &[[f64; 2]]) -> [f64; 2] {
        let gradient = along(&self.basis.derivatives(self.basis.nodes[point]), moved);
        let edge = self.edge(self.basis.nodes[point]);
        self.outward([edge[0] + gradient[0], edge[1] + gradient[1]])
    }

    /// The current direction of the face away from an end, a unit vector.
    pub fn direction_from(&self, end: usize, moved: &[[f64; 2]]) -> [f64; 2] {
        let gradient = along(&self.basis.derivatives(end as f64), moved);
        let edge = self.edge(end as f64);
        let sign = if end == 0 { 1.0 } else { -1.0 };
        let slope = [0, 1].map(|k| sign * (edge[k] + gradient[k]));
        let length = slope[0].hypot(slope[1]).max(f64::MIN_POSITIVE);
        slope.map(|x| x / length)
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
        let weight = |i: usize| {
            let [a, b] = self.edge(self.basis.nodes[i]);
            self.basis.weights[i] * a.hypot(b)
        };
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
