//! The observer of all quantities of a run.

use super::reading::Reading;
use super::{Quantity, Seen, When};
use crate::error::Error;
use crate::exact::Exact;
use crate::observe::{self, NewGrid, Observer, Schedule, View};
use crate::words::{Saved, Words};
use cpu_time::ProcessTime;
use std::sync::Arc;
use std::time::Instant;

/// A quantity under its name.
pub struct Named {
    /// The name in scene and results.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// When it is taken.
    pub when: When,
    /// What it is.
    pub quantity: Box<dyn Quantity>,
}

/// What came of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Its number; NaN where the run did not get to its time, or where there is none.
    pub value: f64,
    /// The number that the exact solution has, where it is known.
    pub exact: Option<f64>,
}

/// Takes the quantities of a run, and nothing else: it writes no file.
pub struct Gauge {
    all: Vec<(Named, Reading)>,
    exact: Option<Arc<dyn Exact>>,
    expected: Vec<Option<f64>>,
    schedule: Schedule,
    /// The law of each cell.
    material: Vec<usize>,
    /// Whether the run has got to its end.
    ended: bool,
    /// What the quantities have cost so far: CPU seconds and seconds on the clock.
    pub cost: [f64; 2],
}

impl Gauge {
    /// For these quantities. `material` gives the law of each cell. Where an exact solution is given, its numbers are found too.
    pub fn new(all: Vec<Named>, material: &[usize], exact: Option<Arc<dyn Exact>>) -> Self {
        // States between start and end are looked at only where a quantity needs them.
        let at_end = all.iter().all(|named| named.when == When::End && !named.quantity.is_metered());
        let times = if at_end { observe::When::At(vec![]) } else { observe::When::EverySteps(1) };
        let (schedule, expected) = (Schedule::new(times, false).with_end(), vec![None; all.len()]);
        let with_reading = |named: Named| {
            let reading = Reading::new(named.when);
            (named, reading)
        };
        let all = all.into_iter().map(with_reading).collect();
        Self { all, exact, expected, schedule, material: material.to_vec(), ended: false, cost: [0.0; 2] }
    }

    /// What came of all quantities.
    pub fn measured(&self) -> Vec<Measured> {
        let of = |((named, reading), exact): (&(Named, Reading), &Option<f64>)| Measured {
            name: named.name.clone(),
            unit: named.unit,
            // A statistic of a part of a run is not that of the run.
            value: if self.ended || !matches!(named.when, When::Over(_)) { reading.value } else { f64::NAN },
            exact: *exact,
        };
        self.all.iter().zip(&self.expected).map(of).collect()
    }

    fn look(&mut self, view: &View) {
        let (time, last) = (view.state.time, view.dt == 0.0);
        self.ended |= last;
        let seen = Seen::new(view.mesh, view.scheme, view.state, &self.material);
        for ((named, reading), expected) in self.all.iter_mut().zip(&mut self.expected) {
            match named.quantity.integral(&seen) {
                Some(integral) => reading.take_step(time, integral),
                None if reading.needs(time, view.dt) => reading.take(time, named.quantity.of(&seen)),
                None => {}
            }
            let at = match named.when {
                When::End => time,
                When::At(at) => at,
                When::Over(_) => continue,
            };
            if let Some(exact) = self.exact.as_ref().filter(|_| last) {
                *expected = named.quantity.exact(exact.as_ref(), &seen, at);
            }
        }
    }
}

impl Observer for &mut Gauge {
    fn wants_forces(&self) -> bool {
        self.all.iter().any(|(named, _)| named.quantity.is_metered())
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        self.look(view);
        self.cost[0] += cpu.elapsed().as_secs_f64();
        self.cost[1] += wall.elapsed().as_secs_f64();
        Ok(())
    }

    fn save(&mut self, to: &mut Words) -> Result<(), Error> {
        to.count(self.all.len());
        for (named, reading) in &self.all {
            reading.save(to);
            named.quantity.save(to);
        }
        Ok(())
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        if from.count()? != self.all.len() {
            let what = "the checkpoint was saved with other quantities";
            return Err(Error::input(what, "give the [[quantity]] tables of that run"));
        }
        for (named, reading) in &mut self.all {
            reading.restore(from)?;
            named.quantity.restore(from)?;
        }
        Ok(())
    }

    fn regrid(&mut self, grid: &NewGrid) -> Result<(), Error> {
        self.material = grid.material.to_vec();
        self.all.iter_mut().try_for_each(|(named, _)| named.quantity.moved(grid.mesh))
    }
}
