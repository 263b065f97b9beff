//! Boundary conditions as star states (v*, t*) of a face point, for every interface flux.
//!
//! A new condition is one file with a type that implements [`Boundary`] and its entry in the registry.

mod absorbing;
mod foundation;
mod free;
mod obstacle;
mod pressure;
mod shape;
mod surface;
mod traction;
mod unilateral;
mod velocity;
mod wall;
mod whole_face;

pub use absorbing::Absorbing;
pub use foundation::Foundation;
pub use free::Free;
pub use obstacle::Obstacle;
pub use pressure::Pressure;
pub use shape::Shape;
pub use traction::Traction;
pub use unilateral::Unilateral;
pub use velocity::Velocity;
pub use wall::Wall;
pub use whole_face::WholeFace;

use crate::riemann::{Impedance, Medium, Trace, current_normal};
use std::sync::Arc;

/// A number that a user prescribes over reference coordinates X (m) and time (s).
pub type Data = Arc<dyn Fn([f64; 2], f64) -> f64 + Send + Sync>;

/// A time node of a step and its weight: data that depends on time enters as sum_s w_s (.)(X, t_s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeNode {
    /// Time t_n + tau_s dt, in s.
    pub time: f64,
    /// Weight w_s; the weights sum to 1.
    pub weight: f64,
}

/// A point of a boundary face.
#[derive(Debug, Clone, Copy)]
pub struct FacePoint {
    /// Reference coordinates X, m.
    pub x: [f64; 2],
    /// Unit outward normal N in the initial configuration.
    pub normal: [f64; 2],
    /// What the cell is made of.
    pub medium: Medium<f64>,
}

impl FacePoint {
    /// Z of the inside with its current normal and speeds: what comes out keeps its characteristic. With the initial normal for a law of the
    /// small strain: with the current one a body of it that turned before an absorbing edge made energy.
    pub fn characteristic(&self, inside: &Trace<f64>) -> Impedance<f64> {
        let normal = match self.medium.is_objective {
            true => current_normal(inside.f, inside.f, self.normal),
            false => self.normal,
        };
        Impedance::new(inside.c, self.medium.density, normal)
    }

    /// z_p = rho0 c_p with the current speed of the inside, kg/(m^2 s), for all directions: of what holds the body, as in the
    /// flux [`crate::riemann::Dual`].
    pub fn impedance(&self, inside: &Trace<f64>) -> f64 {
        self.medium.density * inside.c[0]
    }

    /// theta/z_p, m^2 s/kg: what the velocity of the face owes to a jump of traction.
    pub fn admittance(&self, inside: &Trace<f64>) -> f64 {
        self.medium.share / self.impedance(inside)
    }
}

/// When a condition is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// The time nodes over which data that depends on time is averaged.
    pub times: &'a [TimeNode],
    /// What this evaluation counts in the step, s: dt for ADER, b_i dt for stage i of Runge-Kutta. A memory that follows a rate
    /// grows by `dt` times the rate.
    pub dt: f64,
}

/// How a boundary face gives back what it creeps ([`crate::riemann::creep`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GivesBack {
    /// Not at all.
    Nothing,
    /// v* = v + Y (t* - t), and t* does not depend on t: the spring pulls in any direction.
    All,
    /// The same along the face, and nothing across it: the plane of symmetry, where half of a spring is the image's.
    Along,
}

/// A boundary condition.
pub trait Boundary: Send + Sync {
    /// The numbers that the condition keeps at each point of its faces, at the start of a run: a gap, a slip. None by default.
    /// They are part of the state: snapshots hold them, another grid takes those of the nearest point.
    fn memory(&self) -> &[f64] {
        &[]
    }

    /// Where the body goes on behind the boundary as its mirror image: the speed of the mirror along N at a time, m/s. Limiters take the
    /// image for the neighbour. None by default: nothing is known of what lies behind.
    fn mirror(&self, _x: [f64; 2], _time: f64) -> Option<f64> {
        None
    }

    /// How its faces give back what they creep; not at all by default.
    fn gives_back(&self) -> GivesBack {
        GivesBack::Nothing
    }

    /// The gap to an obstacle at a point X with this memory, below 0 inside of it, m; none where the condition is no obstacle.
    fn gap(&self, _x: [f64; 2], _memory: &[f64]) -> Option<f64> {
        None
    }

    /// How deep a face lies in the obstacle, m; the `inside` of the face may be empty. By default that of its deepest point.
    fn depth(&self, face: &WholeFace, memory: &[f64]) -> f64 {
        let width = memory.len() / face.points.len();
        let gaps = face.points.iter().enumerate().filter_map(|(i, at)| self.gap(at.x, &memory[i * width..][..width]));
        gaps.fold(0.0, |deepest, gap| deepest.max(-gap))
    }

    /// Whether it looks at whole faces, by [`Boundary::face_flux`]; not by default.
    fn sees_faces(&self) -> bool {
        false
    }

    /// Flux*.N at all points of a face, where what lies between the points decides; else false, and the memory as it was: then
    /// [`Boundary::flux`] is asked at each point. `memory` are the numbers of all points of the face.
    fn face_flux(&self, _face: &WholeFace, _when: &Moment, _memory: &mut [f64], _flux: &mut [[f64; 6]]) -> bool {
        false
    }

    /// Flux*.N at a face point, in the order of U. Called once a point and stage. `memory` are the numbers of that point, as the
    /// stage before has left them.
    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6];
}

/// sum_s w_s data(X, t_s).
fn mean(data: &Data, x: [f64; 2], when: &Moment) -> f64 {
    when.times.iter().map(|node| node.weight * data(x, node.time)).sum()
}

#[cfg(test)]
mod tests;
