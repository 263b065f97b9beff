//! Quantities of interest: single numbers of a state that a scene names, such as the length of a bar at the end or the largest
//! stress of a run.
//!
//! A new quantity is one file with a type that implements [`Quantity`] and its entry in the registry. When it is taken and what
//! becomes of it over the run ([`When`]) is separate from what it is. [`Gauge`] is the observer of all quantities of a run: a run
//! without quantities has none.

mod component;
mod energy;
mod extent;
mod force;
mod front_width;
mod gauge;
mod length;
mod overshoot;
mod peak;
mod places;
mod reading;
mod value;

pub use component::Component;
pub use energy::{Energy, Part};
pub use extent::Extent;
pub use force::Force;
pub use front_width::{FrontWidth, width};
pub use gauge::{Gauge, Measured, Named};
pub use length::Length;
pub use overshoot::{Overshoot, overshoot};
pub use peak::{Extreme, Peak};
pub use places::{Outside, Place, Places};
pub use reading::{Statistic, When};
pub use value::PointValue;

use crate::error::Error;
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::observe::Solution;
use crate::state::State;
use crate::step::{Scheme, Totals};
use crate::words::{Saved, Words};
use std::cell::OnceCell;

/// A number that a state has.
pub trait Quantity {
    /// The number of a state; NaN where the state has none, such as the width of a front that is not there, and of a quantity that only
    /// steps have ([`Quantity::integral`]).
    fn of(&self, _seen: &Seen) -> f64 {
        f64::NAN
    }

    /// The number of the exact solution at a time, s. None where it is not known. `seen` is a state on the mesh: it has places
    /// and laws.
    fn exact(&self, _exact: &dyn Exact, _seen: &Seen, _time: f64) -> Option<f64> {
        None
    }

    /// int q dt since the start of the run, of a quantity that the steps meter ([`Quantity::is_metered`]): its number at a time is the mean
    /// over the step that the time lies in.
    fn integral(&self, _seen: &Seen) -> Option<f64> {
        None
    }

    /// Whether it is known of steps, as the forces are that a run meters if it is asked to ([`crate::observe::Observer::wants_forces`]).
    fn is_metered(&self) -> bool {
        false
    }

    /// Saves what the quantity has taken from the start of the run. By default nothing.
    fn save(&self, _: &mut Words) {}

    /// Goes on from what [`Quantity::save`] has saved.
    ///
    /// # Errors
    /// What was saved by another quantity.
    fn restore(&mut self, _: &mut Saved) -> Result<(), Error> {
        Ok(())
    }

    /// Called when the run goes on on another mesh. By default it does nothing; what keeps places in cells finds them again.
    ///
    /// # Errors
    /// A place that lies outside of this mesh.
    fn moved(&mut self, _mesh: &Mesh) -> Result<(), Error> {
        Ok(())
    }
}

/// A state that quantities are taken of. What several of them need is computed once, by the first that asks for it.
pub struct Seen<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The state.
    pub state: &'a State,
    material: &'a [usize],
    solution: OnceCell<Solution<'a>>,
    totals: OnceCell<Totals>,
}

impl<'a> Seen<'a> {
    /// A state on a mesh; `material` gives the law of each cell.
    pub fn new(mesh: &'a Mesh, scheme: &'a Scheme, state: &'a State, material: &'a [usize]) -> Self {
        Self { mesh, scheme, state, material, solution: OnceCell::new(), totals: OnceCell::new() }
    }

    /// The state as a function of the point.
    pub fn solution(&self) -> &Solution<'a> {
        self.solution.get_or_init(|| Solution::of_state(self.scheme, self.state, self.material))
    }

    /// Energies and momentum.
    pub fn totals(&self) -> &Totals {
        self.totals.get_or_init(|| self.scheme.totals(self.state))
    }
}
