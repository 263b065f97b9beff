//! The shapes of rigid obstacles: the signed distance of a point, and the normal there.

use crate::tensor::{cross, dot, minus};

/// A rigid obstacle in the plane, where it stands at the start.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// All points x with (x - point).normal < 0.
    HalfPlane {
        /// A point of its edge, m.
        point: [f64; 2],
        /// Unit normal out of the obstacle.
        normal: [f64; 2],
    },
    /// All points nearer to the centre than the radius.
    Disc {
        /// The centre, m.
        centre: [f64; 2],
        /// The radius, m.
        radius: f64,
    },
    /// The inside of a closed line, convex or not.
    Polygon {
        /// The corners, either way around, m.
        corners: Vec<[f64; 2]>,
    },
}

/// A part of an obstacle that may lie between the points of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tip {
    /// Where, m.
    pub at: [f64; 2],
    /// How far its surface is from there, m.
    pub radius: f64,
    /// The normals of both edges of a corner, counterclockwise: between them lie the directions that lead away from it. All do, for none.
    pub cone: Option<[[f64; 2]; 2]>,
}

impl Shape {
    /// The distance of x from the surface, below 0 inside of the obstacle, m; and the unit normal out of the obstacle at the nearest
    /// point of the surface.
    pub fn distance(&self, x: [f64; 2]) -> (f64, [f64; 2]) {
        match self {
            Self::HalfPlane { point, normal } => (dot(minus(x, *point), *normal), *normal),
            Self::Disc { centre, radius } => {
                let from = minus(x, *centre);
                let length = from[0].hypot(from[1]);
                // At the centre all directions are as good.
                let normal = if length > 0.0 { from.map(|from| from / length) } else { [0.0, 1.0] };
                (length - radius, normal)
            }
            Self::Polygon { corners } => of_polygon(corners, x),
        }
    }

    /// Calls `visit` with each corner of a polygon that stands out, and with a disc.
    pub(super) fn each_tip(&self, mut visit: impl FnMut(Tip)) {
        match self {
            Self::HalfPlane { .. } => {}
            Self::Disc { centre, radius } => visit(Tip { at: *centre, radius: *radius, cone: None }),
            Self::Polygon { corners } => {
                let (turn, count) = (Self::twice_area(corners).signum(), corners.len());
                let outward = |from: [f64; 2], to: [f64; 2]| {
                    let edge = minus(to, from);
                    let length = turn * edge[0].hypot(edge[1]);
                    [edge[1] / length, -edge[0] / length]
                };
                for (i, at) in corners.iter().enumerate() {
                    let (before, after) = (corners[(i + count - 1) % count], corners[(i + 1) % count]);
                    let mut cone = [outward(before, *at), outward(*at, after)];
                    if turn < 0.0 {
                        cone.swap(0, 1);
                    }
                    if cross(cone[0], cone[1]) > 0.0 {
                        visit(Tip { at: *at, radius: 0.0, cone: Some(cone) });
                    }
                }
            }
        }
    }

    /// Twice the area within a closed line, above 0 where it goes counterclockwise, m^2.
    pub fn twice_area(corners: &[[f64; 2]]) -> f64 {
        edges(corners).map(|(a, b)| cross(a, b)).sum()
    }

    /// Two edges of a closed line that cross or touch, by their numbers; neighbours meet in their corner alone.
    pub fn crossing(corners: &[[f64; 2]]) -> Option<[usize; 2]> {
        let all: Vec<_> = edges(corners).collect();
        let neighbours = |i: usize, j: usize| j == i + 1 || (i == 0 && j + 1 == all.len());
        let cross_at = |i: usize, j: usize| {
            let ((a, b), (c, d)) = (all[i], all[j]);
            let side = |p, q, x| cross(minus(q, p), minus(x, p));
            // Edges along one line, which are on no side of each other, may be apart.
            let near = |k: usize| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]);
            near(0) && near(1) && side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
        };
        let pairs = (0..all.len()).flat_map(|i| (i + 1..all.len()).map(move |j| (i, j)));
        pairs.filter(|&(i, j)| !neighbours(i, j)).find(|&(i, j)| cross_at(i, j)).map(|(i, j)| [i, j])
    }
}

fn of_polygon(corners: &[[f64; 2]], x: [f64; 2]) -> (f64, [f64; 2]) {
    let turn = Shape::twice_area(corners).signum();
    let (mut nearest, mut normal, mut at_corner, mut inside) = (f64::INFINITY, [0.0; 2], false, false);
    for (a, b) in edges(corners) {
        let (edge, from) = (minus(b, a), minus(x, a));
        let share = (dot(from, edge) / dot(edge, edge)).clamp(0.0, 1.0);
        let off = [0, 1].map(|k| from[k] - share * edge[k]);
        let distance = off[0].hypot(off[1]);
        if distance < nearest {
            nearest = distance;
            let length = turn * edge[0].hypot(edge[1]);
            // Out of the obstacle: of the edge, unless the nearest point is a corner.
            let of_edge = [edge[1] / length, -edge[0] / length];
            at_corner = (share == 0.0 || share == 1.0) && distance > 0.0;
            normal = if at_corner { off.map(|off| off / distance) } else { of_edge };
        }
        // A ray along x from the point crosses the edge.
        let crosses = (a[1] > x[1]) != (b[1] > x[1]);
        inside ^= crosses && x[0] < a[0] + (x[1] - a[1]) / edge[1] * edge[0];
    }
    match (inside, at_corner) {
        (false, _) => (nearest, normal),
        // Seen from inside, the way to a corner goes out of the obstacle.
        (true, true) => (-nearest, normal.map(|n| -n)),
        (true, false) => (-nearest, normal),
    }
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}
