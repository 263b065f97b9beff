//! The watch over the energy: no body ever makes any, so a rise is an error of the method, and is said while it runs.
//!
//! A(t) = kinetic + strain energy + what plastic flow has dissipated - work done by the outside never rises. Its rise above
//! the lowest value so far is energy made out of nothing. It is measured against the largest of the energy at the start, the
//! work done so far, and [`ROUNDING`] int rho0 c_p^2 dX: what is below is noise of the energy's own rounding.

use crate::operators::Blocks;
use crate::state::State;
use crate::step::{Balance, EnergyMade, Scheme, Totals, Work};

/// Shares of energy made at which something is done.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Limits {
    /// It is said.
    pub warn: f64,
    /// The run stops.
    pub stop: f64,
}

/// The bound that plastic runs have to keep, and a share that no result is good at.
impl Default for Limits {
    fn default() -> Self {
        Self { warn: 1e-3, stop: 0.1 }
    }
}

/// Energies below this share of int rho0 c_p^2 dX, which is that of strains of 1e-6, are not told from rounding: W of a
/// neo-Hookean solid is a difference of numbers of the size of the moduli, with an error of some 1e-16 of them. The default
/// [`Limits::warn`] of it is 1e-15.
const ROUNDING: f64 = 1e-12;

/// The energy is found every so many steps where no balance has it: measured as .2 to .4 % of a step of degrees 1 to 4
/// (docs/performance.md); what grows by a per cent in so many steps is caught in time.
const EVERY: usize = 16;

/// What the watch says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alarm {
    /// More than [`Limits::warn`]; once in a run.
    Warning(EnergyMade),
    /// More than [`Limits::stop`].
    Stop(EnergyMade),
}

/// The books of a run.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    limits: Option<Limits>,
    /// Work of the boundary and of sources so far, J/m.
    pub work: [f64; 2],
    /// What regrids added, which is not the step's.
    regrids: f64,
    /// See [`self`].
    scale: f64,
    /// The lowest A so far.
    lowest: f64,
    /// The largest rise so far.
    pub made: EnergyMade,
    warned: bool,
    cells: Vec<crate::lane::F8>,
}

impl Watch {
    /// From the totals at the start.
    pub fn new(scheme: &Scheme, first: &Totals, limits: Option<Limits>) -> Self {
        let scale = first.energy().max(ROUNDING * stiffness(scheme));
        Self { limits, scale, lowest: first.accounted(), ..Self::default() }
    }

    /// Whether it has something to look at every so many steps.
    pub fn is_on(&self) -> bool {
        self.limits.is_some()
    }

    /// Whether it has warned.
    pub fn warned(&self) -> bool {
        self.warned
    }

    /// Books the last step, which led to `state`; looks at the energy where it is known or due, or this is the `last` step.
    pub fn step(
        &mut self,
        scheme: &Scheme,
        state: &State,
        work: &Work,
        balance: Option<&Balance>,
        last: bool,
    ) -> Option<Alarm> {
        let [boundary, sources] = work.given();
        self.work = [self.work[0] + boundary, self.work[1] + sources];
        self.scale = self.scale.max(self.work[0] + self.work[1]);
        let limits = self.limits?;
        let energy = match balance {
            Some(balance) => balance.energy,
            None if last || state.step.is_multiple_of(EVERY) => scheme.energy(state, work, &mut self.cells),
            None => return None,
        };
        self.look(energy, state, limits)
    }

    fn look(&mut self, energy: f64, state: &State, limits: Limits) -> Option<Alarm> {
        let own = energy - self.work[0] - self.work[1] - self.regrids;
        self.lowest = self.lowest.min(own);
        let joule = own - self.lowest;
        let made = EnergyMade { joule, share: joule / self.scale, time: state.time, step: state.step };
        if made.share > self.made.share {
            self.made = made;
        }
        match made.share {
            share if share > limits.stop => Some(Alarm::Stop(made)),
            share if share > limits.warn && !self.warned => {
                self.warned = true;
                Some(Alarm::Warning(made))
            }
            _ => None,
        }
    }

    /// Another grid: what its energy differs by is booked apart.
    pub fn regrid(&mut self, before: f64, after: f64) {
        self.regrids += after - before;
    }
}

/// int rho0 c_p^2 dX, J/m, with c_p at F = 1.
fn stiffness(scheme: &Scheme) -> f64 {
    let Blocks { material, count, .. } = &scheme.operators.blocks;
    let moduli: Vec<f64> = scheme.laws.iter().map(|law| {
        law.density() * law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0].powi(2)
    }).collect();
    let area = |block: usize, lane: usize| {
        let [a, b, c, d] = scheme.operators.geometry.corners_of(block, lane);
        0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1])).abs()
    };
    let of_block = |block: usize| moduli[material[block]] * (0..count[block]).map(|lane| area(block, lane)).sum::<f64>();
    (0..count.len()).map(of_block).sum()
}
