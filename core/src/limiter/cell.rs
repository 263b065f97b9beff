//! A cell that is limited, and what lies around it.

use super::modes::{Legendre, Modes, of_lane};
use super::neighbour::{Axes, around, behind};
use super::waves::Waves;
use crate::mesh::map;
use crate::operators::Neighbour;
use crate::state::UNKNOWNS;
use crate::step::{Law, Made};
use crate::tensor::dot;

/// A cell.
#[derive(Clone, Copy)]
pub struct Cell<'a> {
    /// The state.
    pub made: &'a Made<'a>,
    /// The modes of its degree.
    pub legendre: &'a Legendre,
    /// Its block.
    pub block: usize,
    /// Its lane.
    pub lane: usize,
}

/// What lies on one side of a cell, in the axes of the cell.
pub struct Beside {
    /// Modes of what lies there, scaled as if it were as long as the cell.
    pub modes: Modes,
    /// Length of the cell over the distance of the two middles.
    pub share: f64,
}

impl Cell<'_> {
    /// Its modes.
    pub fn modes(&self) -> Modes {
        let nodes = of_lane(self.made.unknowns(self.block), self.legendre.nodes(), self.lane);
        Modes { m: self.legendre.m(), of: self.legendre.modes(&nodes) }
    }

    /// Its law.
    pub fn law(&self) -> &Law {
        &self.made.scheme.laws[self.made.scheme.operators.blocks.material[self.block]]
    }

    /// Its lengths along its axes, m: |dX/dxi| in the middle.
    pub fn lengths(&self) -> [f64; 2] {
        // |J grad xi_2| = |dX/dxi_1|, and the other way round.
        [self.cofactor(1), self.cofactor(0)].map(|c| c[0].hypot(c[1]))
    }

    /// Characteristic variables along the direction in which xi of an axis grows, at F; of the momentum alone where a law has
    /// internal variables, and F is not limited.
    pub fn waves(&self, axis: usize, f: [f64; 4]) -> Waves {
        let waves = Waves::new(self.law(), f, self.normal(axis));
        if self.law().has_memory() { waves.of_momentum() } else { waves }
    }

    /// J grad xi of an axis in the middle, m.
    fn cofactor(&self, axis: usize) -> [f64; 2] {
        let map = self.made.scheme.operators.geometry.map_of(self.block, self.lane);
        let j = map::jacobian(&map, [0.5; 2]);
        if axis == 0 { [j[1][1], -j[0][1]] } else { [-j[1][0], j[0][0]] }
    }

    fn normal(&self, axis: usize) -> [f64; 2] {
        let [a, b] = self.cofactor(axis);
        let length = a.hypot(b);
        [a / length, b / length]
    }

    /// What lies behind a face: the neighbour, or the image of `own` behind a mirror; none where nothing is known.
    pub fn beside(&self, face: usize, own: &Modes) -> Option<Beside> {
        if let Some(there) = behind(&self.made.scheme.operators.blocks, self.block, self.lane, face) {
            let other = Cell { block: there.block, lane: there.lane, ..*self };
            let scale = self.scale(&other, there.axes);
            return Some(Beside {
                modes: other.modes().seen(there.axes, scale),
                share: 2.0 / (1.0 + 1.0 / scale[face / 2]),
            });
        }
        let modes = self.image(face, own)?;
        Some(Beside { modes, share: 1.0 })
    }

    /// Lengths of this cell over those of another along the axes of this one.
    fn scale(&self, other: &Cell, axes: Axes) -> [f64; 2] {
        let (own, others) = (self.lengths(), other.lengths());
        [0, 1].map(|axis| own[axis] / others[axes.of(axis)])
    }

    /// The image of `own` behind a boundary that is a mirror: F -> R F R, p -> R p + 2 rho0 v_w N with R = 1 - 2 N N^T, and with
    /// the axis of the face reversed.
    fn image(&self, face: usize, own: &Modes) -> Option<Modes> {
        let scheme = self.made.scheme;
        let Neighbour::Boundary(group) = scheme.operators.blocks.neighbours[self.block][face][self.lane] else {
            return None;
        };
        let map = scheme.operators.geometry.map_of(self.block, self.lane);
        let middle = [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0]][face];
        let (n, x) = (map::outward(&map, face, 0.5).0, map::position(&map, middle));
        let speed = scheme.boundaries[group].mirror(x, self.made.state.time)?;
        let mut axes = Axes::default();
        axes.reversed[face / 2] = true;
        let mut out = own.seen(axes, [1.0; 2]);
        for number in 0..self.legendre.nodes() {
            out.set(number, reflected(out.mode(number), n));
        }
        (0..2).for_each(|i| out.of[0][4 + i] += 2.0 * self.law().density() * speed * n[i]);
        Some(out)
    }

    /// Calls `see` with the modes of each cell around a corner, in the axes of this one and scaled to it.
    pub fn around(&self, ends: [usize; 2], see: &mut dyn FnMut(&Modes)) {
        around(&self.made.scheme.operators.blocks, (self.block, self.lane), ends, &mut |block, lane, axes| {
            let other = Cell { block, lane, ..*self };
            see(&other.modes().seen(axes, self.scale(&other, axes)));
        });
    }
}

/// R F R and R p with R = 1 - 2 N N^T.
pub fn reflected(u: [f64; UNKNOWNS], n: [f64; 2]) -> [f64; UNKNOWNS] {
    let reflect = |x: [f64; 2]| [0, 1].map(|i| x[i] - 2.0 * n[i] * dot(n, x));
    let [a, b] = [reflect([u[0], u[1]]), reflect([u[2], u[3]])];
    let (one, two, p) = (reflect([a[0], b[0]]), reflect([a[1], b[1]]), reflect([u[4], u[5]]));
    [one[0], two[0], one[1], two[1], p[0], p[1]]
}
