//! The watch over the energy: no body ever makes any, so a rise is an error of the method, and is said while it runs.
//!
//! A(t) = kinetic + strain energy + what laws have dissipated + what contact and cohesive edges store - work done by the outside never
//! rises. Its rise above
//! the lowest value so far is energy made out of nothing. It is measured against the largest of the energy at the start, the
//! work done so far, and [`ROUNDING`] int rho0 c_p^2 dX: what is below is noise of the energy's own rounding.

use crate::error::Result;
use crate::mesh::map;
use crate::operators::Blocks;
use crate::state::State;
use crate::step::{Balance, EnergyMade, Scheme, Totals, Work};
use crate::sum::exact_sum;
use crate::words::{Saved, Words};

/// Shares of energy made at which something is done.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Limits {
    /// It is said.
    pub warn: f64,
    /// The run stops.
    pub stop: f64,
}

/// The bound that runs with a history have to keep, and a share that no result is good at.
impl Default for Limits {
    fn default() -> Self {
        Self { warn: 1e-3, stop: 0.1 }
    }
}

/// Energies below this share of int rho0 c_p^2 dX, which is that of strains of 1e-6, are not told from rounding: W of a
/// neo-Hookean solid is a difference of numbers of the size of the moduli, with an error of some 1e-16 of them. The default
/// [`Limits::warn`] of it is 1e-15.
const ROUNDING: f64 = 1e-12;

/// It looks every so many steps. (The first steps from rest are no measure: work and energy are both next to nothing there.)
/// Where no balance has the energy it is found then, at 3 to 13 % of a step: .1 to .4 % in the mean (degrees 1 to 4, both laws
/// of both kinds, 100 x 100 cells, one thread). What doubles in a hundred steps is caught at 1.25 times the limit.
const EVERY: usize = 32;

/// What the watch says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alarm {
    /// Extras than [`Limits::warn`]; once in a run.
    Warning(EnergyMade),
    /// Extras than [`Limits::stop`].
    Stop(EnergyMade),
}

/// The books of a run.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    limits: Option<Limits>,
    /// Work of the boundary and of sources so far, J/m.
    pub work: [f64; 2],
    /// Work between faces of the body so far, J/m: of contact, friction and cohesive edges. It is no work of the outside.
    pub contact_work: f64,
    /// What contact and cohesive edges store, J/m, as the watch has seen it last.
    stored: f64,
    /// What regrids added, which is not the step's.
    regrids: f64,
    /// See [`self`].
    scale: f64,
    /// The lowest A so far.
    lowest: f64,
    /// The largest rise so far.
    pub made: EnergyMade,
    warned: bool,
    /// Whether laws are sampled away from the Gauss nodes.
    between_nodes: bool,
    /// Steps done under its eyes.
    steps: usize,
    cells: Vec<crate::lane::F8>,
}

impl Watch {
    /// From the totals at the start.
    pub fn new(scheme: &Scheme, first: &Totals, limits: Option<Limits>) -> Self {
        let scale = first.energy().max(ROUNDING * stiffness(scheme));
        Self { limits, scale, lowest: first.accounted(), ..Self::default() }
    }

    pub(super) fn save(&self, to: &mut Words) {
        let Self { work, contact_work, stored, regrids, scale, lowest, made, warned, steps, .. } = self;
        to.real(work[0]).real(work[1]).real(*contact_work).real(*stored).real(*regrids).real(*scale).real(*lowest);
        to.real(made.joule).real(made.share).real(made.time).count(made.step).flag(*warned).count(*steps);
    }

    pub(super) fn restored(from: &mut Saved, limits: Option<Limits>) -> Result<Self> {
        let (work, [contact_work, stored, regrids, scale, lowest]) = (from.array()?, from.array()?);
        let ([joule, share, time], step) = (from.array()?, from.count()?);
        let (made, warned, steps) =
            (EnergyMade { joule, share, time, step, between_nodes: false }, from.flag()?, from.count()?);
        Ok(Self { limits, work, contact_work, stored, regrids, scale, lowest, made, warned, steps, ..Self::default() })
    }

    /// Whether it has something to look at every so many steps.
    pub fn is_on(&self) -> bool {
        self.limits.is_some()
    }

    /// Whether it has warned.
    pub fn warned(&self) -> bool {
        self.warned
    }

    /// Books the last step, which led to `state`, and looks at the energy where that is due.
    pub fn step(
        &mut self,
        scheme: &Scheme,
        state: &State,
        work: &mut Work,
        balance: Option<&Balance>,
    ) -> Option<Alarm> {
        let [boundary, sources, between] = work.external_work(scheme);
        self.work = [self.work[0] + boundary, self.work[1] + sources];
        self.contact_work += between;
        self.scale = self.scale.max(self.work[0] + self.work[1]);
        let limits = self.limits?;
        self.steps += 1;
        // An impact that begins may make energy in the first step of all.
        if self.steps > 1 && !self.steps.is_multiple_of(EVERY) {
            return None;
        }
        let energy = match balance {
            Some(balance) => balance.energy,
            None => work.energy(scheme, state, &mut self.cells),
        };
        self.stored = work.stored_in_contact(scheme, state);
        self.between_nodes = scheme.samples_between_nodes();
        self.look(energy, state, limits)
    }

    /// Looks at the last state of a run, whose energy is known.
    pub fn close(&mut self, energy: f64, state: &State) {
        if let (Some(limits), true) = (self.limits, self.steps > EVERY) {
            self.look(energy, state, limits);
        }
    }

    fn look(&mut self, energy: f64, state: &State, limits: Limits) -> Option<Alarm> {
        let own = energy + self.stored - self.work[0] - self.work[1] - self.regrids;
        self.lowest = self.lowest.min(own);
        let joule = own - self.lowest;
        let (time, step, between_nodes) = (state.time, state.step, self.between_nodes);
        let made = EnergyMade { joule, share: joule / self.scale, time, step, between_nodes };
        if made.share > self.made.share {
            self.made = made;
        }
        let warned = self.warned;
        self.warned |= made.share > limits.warn;
        match made.share {
            share if share > limits.stop => Some(Alarm::Stop(made)),
            share if share > limits.warn && !warned => Some(Alarm::Warning(made)),
            _ => None,
        }
    }

    /// Another grid: what it takes of the energy is booked apart, and what it adds is made out of nothing.
    pub fn regrid(&mut self, before: f64, after: f64) {
        self.regrids += (after - before).min(0.0);
    }
}

/// int rho0 c_p^2 dX, J/m, with c_p at F = 1.
fn stiffness(scheme: &Scheme) -> f64 {
    let Blocks { material, count, .. } = &scheme.operators.blocks;
    let moduli: Vec<f64> =
        scheme.laws.iter().map(|law| law.density() * law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0].powi(2)).collect();
    let area = |block: usize, lane: usize| map::area(&scheme.operators.geometry.map_of(block, lane)).abs();
    let of_block =
        |block: usize| moduli[material[block]] * (0..count[block]).map(|lane| area(block, lane)).sum::<f64>();
    exact_sum((0..count.len()).map(of_block))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(step: usize) -> State {
        State { time: 1e-3 * step as f64, step, components: 6, ..State::default() }
    }

    /// A watch over a body that starts with 10 J/m.
    fn watch() -> Watch {
        Watch { limits: Some(Limits::default()), scale: 10.0, lowest: 10.0, ..Watch::default() }
    }

    fn look(watch: &mut Watch, step: usize, energy: f64) -> Option<Alarm> {
        watch.look(energy, &state(step), Limits::default())
    }

    #[test]
    fn a_rise_above_the_lowest_energy_so_far_is_made_whatever_was_lost_before() {
        let mut watch = watch();
        assert_eq!((look(&mut watch, 1, 4.0), look(&mut watch, 2, 4.009)), (None, None));
        let Some(Alarm::Warning(made)) = look(&mut watch, 3, 4.02) else { panic!("{watch:?}") };
        // .02 of 10 J/m, to rounding.
        assert!((made.joule - 0.02).abs() < 1e-14 && (made.share - 0.002).abs() < 1e-15 && made.step == 3);
        assert_eq!(look(&mut watch, 4, 4.03), None, "it is said once");
        assert_eq!(look(&mut watch, 5, 3.0), None);
        assert!((watch.made.share - 0.003).abs() < 1e-15 && watch.made.step == 4, "the largest rise: {watch:?}");
        let Some(Alarm::Stop(made)) = look(&mut watch, 6, 4.1) else { panic!("{watch:?}") };
        assert!((made.joule - 1.1).abs() < 1e-14 && watch.made == made);
    }

    #[test]
    fn what_the_outside_gives_is_not_made_and_what_a_regrid_adds_is() {
        let mut watch = watch();
        (watch.work, watch.scale) = ([80.0, 20.0], 100.0);
        assert_eq!(look(&mut watch, 1, 110.0), None);
        // What it takes is no credit for a later rise.
        watch.regrid(110.0, 100.0);
        assert_eq!((look(&mut watch, 2, 100.0), watch.made.joule), (None, 0.0));
        // .05 J/m are less than a thousandth of the work.
        assert_eq!(look(&mut watch, 3, 100.05), None);
        watch.regrid(100.05, 100.2);
        assert!(matches!(look(&mut watch, 4, 100.2), Some(Alarm::Warning(_))));
    }
}
