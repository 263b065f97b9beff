//! Keeping a run so that it can be resumed: when, and what of it. Where it goes is the business of [`Keep`].

use super::{Pause, Report};
use crate::error::Error;
use crate::observe::Observer;
use crate::state::State;
use crate::step::{Motion, Scheme};
use crate::words::Words;

/// A run between two steps: a state that is not observed yet, and what lives on beside it.
pub struct Moment<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The state.
    pub state: &'a State,
    /// The numbers of what lives on, under its name.
    pub parts: Vec<(String, Words)>,
}

/// Who keeps a run.
pub trait Keep {
    /// What [`Motion::save`] has saved of the run that is resumed; none where the run begins, and after the first call.
    fn resumed(&mut self) -> Option<Words>;

    /// Whether the run is kept at a state; `stops` where it has been asked to stop there.
    fn due(&mut self, state: &State, stops: bool) -> bool;

    /// Whether it is kept at its end.
    fn at_end(&self) -> bool;

    /// Keeps it.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn keep(&mut self, moment: &Moment) -> Result<(), Error>;
}

/// The name of the part of [`Motion`].
pub const MOTION: &str = "motion";
/// That of the report.
pub const REPORT: &str = "report";
/// That of [`Pause`].
pub const PAUSE: &str = "pause";

/// The name of the part of an observer, by its place in the list.
pub fn observer(number: usize) -> String {
    format!("observer_{number}")
}

/// All that lives on.
pub(super) fn parts(
    scheme: &Scheme,
    motion: &Motion,
    report: &Report,
    pause: &mut dyn Pause,
    observers: &mut [Box<dyn Observer + '_>],
) -> Result<Vec<(String, Words)>, Error> {
    let mut out = Vec::new();
    let mut part = |name: &str, save: &mut dyn FnMut(&mut Words) -> Result<(), Error>| {
        let mut words = Words::default();
        save(&mut words)?;
        out.push((name.to_owned(), words));
        Ok::<(), Error>(())
    };
    part(MOTION, &mut |to| {
        motion.save(scheme, to);
        Ok(())
    })?;
    part(REPORT, &mut |to| {
        report.save(to);
        Ok(())
    })?;
    part(PAUSE, &mut |to| pause.save(to))?;
    for (number, observed) in observers.iter_mut().enumerate() {
        part(&observer(number), &mut |to| {
            to.count(observed.schedule().served());
            observed.save(to)
        })?;
    }
    Ok(out)
}
