//! When an observer looks.

/// The times that were asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum When {
    /// At these times, s, ascending.
    At(Vec<f64>),
    /// At 0 and then every so many seconds.
    Every(f64),
    /// At the start and then every so many steps.
    EverySteps(usize),
}

/// Times that were asked for, and how far they have been served.
///
/// "At t" is the end of the step that is nearest to t, so that observing changes no bit of the run; with exact times
/// the steps are cut to end there.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    when: When,
    exact: bool,
    served: usize,
}

impl Schedule {
    /// A schedule from its start.
    pub fn new(when: When, exact: bool) -> Self {
        Self { when, exact, served: 0 }
    }

    /// Whether the state at the end of step `step` is due, at time `time`, if the next step is `dt`; `end` is the end
    /// of the run, which is never passed.
    pub fn due(&mut self, step: usize, time: f64, dt: f64) -> bool {
        let mut due = false;
        while let Some(asked) = self.next() {
            let now = match asked {
                Asked::Time(asked) => asked <= time + 0.5 * dt,
                Asked::Step(asked) => asked <= step,
            };
            if !now {
                break;
            }
            due = true;
            self.served += 1;
        }
        due
    }

    /// The next time at which a step has to end, if times are exact.
    pub fn stop(&self) -> Option<f64> {
        match self.next() {
            Some(Asked::Time(time)) if self.exact => Some(time),
            _ => None,
        }
    }

    fn next(&self) -> Option<Asked> {
        match &self.when {
            When::At(times) => times.get(self.served).map(|t| Asked::Time(*t)),
            When::Every(interval) => Some(Asked::Time(interval * self.served as f64)),
            When::EverySteps(steps) => Some(Asked::Step(steps * self.served)),
        }
    }
}

enum Asked {
    Time(f64),
    Step(usize),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_step_is_taken_once() {
        let mut schedule = Schedule::new(When::At(vec![0.24, 0.26, 1.0]), false);
        let due: Vec<usize> = (0..=10).filter(|&n| schedule.due(n, n as f64 * 0.1, 0.1)).collect();
        // .24 lies nearest to .2, .26 to .3.
        assert_eq!(due, [2, 3, 10]);
    }

    #[test]
    fn steps_and_intervals_count_from_the_start() {
        let mut steps = Schedule::new(When::EverySteps(4), false);
        let mut every = Schedule::new(When::Every(0.25), true);
        assert_eq!((0..=10).filter(|&n| steps.due(n, n as f64 * 0.1, 0.1)).collect::<Vec<_>>(), [0, 4, 8]);
        assert_eq!(every.stop(), Some(0.0));
        assert!(every.due(0, 0.0, 0.1));
        assert_eq!(every.stop(), Some(0.25));
    }
}
