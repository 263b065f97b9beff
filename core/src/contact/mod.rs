//! What acts between two parts of the boundary that face each other: contact of bodies, cracks that close, cohesive edges.
//!
//! A new interaction is one file with a type that implements [`Interaction`] and its entry in the registry of conditions.

mod cohesive;
mod sliding;

pub use cohesive::Cohesive;
pub use sliding::Sliding;

use crate::boundary::{Boundary, FacePoint, Free, Moment};
use crate::riemann::Trace;
use crate::tensor::dot;
use std::sync::Arc;

/// What one side shows at a point of contact. Tractions and impedances count per current length, at the sides of
/// a cut ([`Pairs::Initial`]) per initial length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Velocity, m/s.
    pub v: [f64; 2],
    /// Traction on this side with its own outward normal, Pa.
    pub t: [f64; 2],
    /// Impedances z_p = rho0 c_p, z_s = rho0 c_s, kg/(m^2 s).
    pub z: [f64; 2],
}

/// How far two sides overlap at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Overlap {
    /// max(0, -gap), m.
    pub depth: f64,
    /// Of the cells of both sides in a row: 1/(1/k_1 + 1/k_2) with k_i = rho0 c_p^2/h_e at F = 1, Pa/m.
    pub stiffness: f64,
}

/// A point where two sides face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Both sides; what acts on the first acts on the second with the opposite sign.
    pub sides: [Side; 2],
    /// The current unit normal, out of the first side.
    pub normal: [f64; 2],
    /// (x_2 - x_1).n at the start of the step, m: below 0 the sides overlap.
    pub gap: f64,
    /// How far the sides overlap at the start of the step.
    pub overlap: Overlap,
    /// The length of the part that both faces share, m.
    pub length: f64,
    /// dt of the whole step, s.
    pub step: f64,
    /// How long the interaction acts, s: dt for ADER, b_i dt for stage i of Runge-Kutta.
    pub dt: f64,
}

impl Meeting {
    /// The star state of two sides that stick to each other, on the axes normal and tangent: the traction on the first side
    /// t* = (z_2 t_1 - z_1 t_2 + z_1 z_2 (v_2 - v_1)) / (z_1 + z_2), and the compliance 1/z_1 + 1/z_2. With the traction t the
    /// sides part at the rate (t* - t)(1/z_1 + 1/z_2).
    pub fn stick(&self) -> [(f64, f64); 2] {
        let axes = [self.normal, crate::riemann::tangent(self.normal)];
        std::array::from_fn(|k| {
            let [one, two] = &self.sides;
            let (z1, z2, axis) = (one.z[k], two.z[k], axes[k]);
            let push = z2 * dot(one.t, axis) - z1 * dot(two.t, axis) + z1 * z2 * (dot(two.v, axis) - dot(one.v, axis));
            (push / (z1 + z2), 1.0 / z1 + 1.0 / z2)
        })
    }
}

/// How pairs of points are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairs {
    /// Anew in each step, from the current positions of the faces: bodies that move along each other.
    Current,
    /// Once: the two sides of each edge of a cut.
    Initial,
}

#[cfg(test)]
mod tests;

/// The condition of a group whose faces interact with others: free, with the memory of what acts.
pub struct Paired(pub Arc<dyn Interaction>);

impl Boundary for Paired {
    fn memory(&self) -> &[f64] {
        self.0.memory()
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6] {
        Free.flux(inside, at, when, memory)
    }
}

/// An interaction of two sides.
pub trait Interaction: Send + Sync {
    /// How pairs of points are found.
    fn pairs(&self) -> Pairs;

    /// The numbers that it keeps at each point of a pair, at the start of a run; none for [`Pairs::Current`]. Each side keeps a copy:
    /// it must be the same with the sides exchanged.
    fn memory(&self) -> &[f64] {
        &[]
    }

    /// The pressure of a spring that pushes overlapping sides apart, Pa; not below 0. It acts beside [`Interaction::traction`], and the
    /// velocities of the star state do not know of it: see [`Sliding`].
    fn push(&self, _at: &Meeting) -> f64 {
        0.0
    }

    /// The energy that the sides store and can give back, J/m^2: of the spring, and of an edge with `memory`, whose faces share so
    /// much length, m.
    fn stored(&self, _overlap: &Overlap, _length: f64, _memory: &[f64]) -> f64 {
        0.0
    }

    /// The traction on the first side per current length, for [`Pairs::Initial`] per initial length, Pa.
    fn traction(&self, at: &Meeting, memory: &mut [f64]) -> [f64; 2];
}
