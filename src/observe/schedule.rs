//! The times at which an observer observes.

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

/// Times that were asked for, and how many of them have passed.
///
/// "At t" is the end of the step that is nearest to t, so that observing changes no bit of the run; with exact times
/// the steps are cut to end there. Times of a list that lie after the end of the run are nearest to its last state.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    when: When,
    exact: bool,
    with_end: bool,
    /// How many of these times have passed.
    served: usize,
}

/// Two times count as equal within this share of them: it allows for rounding in sums of steps and in multiples of an
/// interval.
const SAME: f64 = 1e-12;

impl Schedule {
    /// A schedule, before its first time.
    pub fn new(when: When, exact: bool) -> Self {
        Self { when, exact, with_end: false, served: 0 }
    }

    /// The same schedule, which also observes at the end of the run.
    pub fn with_end(self) -> Self {
        Self { with_end: true, ..self }
    }

    /// The same, which observes intervals of time or steps at the end of the run as well; a list of times is what was asked for.
    pub fn with_end_of_intervals(self) -> Self {
        let with_end = self.with_end || !matches!(self.when, When::At(_));
        Self { with_end, ..self }
    }

    /// Whether the state after `step` steps, at `time`, is due; `dt` is the step that follows, 0 at the end of the run.
    pub fn due(&mut self, step: usize, time: f64, dt: f64) -> bool {
        let last = dt == 0.0;
        let ahead = if self.exact { 0.0 } else { 0.5 * dt };
        let asked = match &self.when {
            When::At(times) if last => times.len(),
            _ => self.asked(step, time + ahead),
        };
        let due = asked > self.served || last && self.with_end;
        self.served = self.served.max(asked);
        due
    }

    /// How many of its times have passed.
    pub fn served(&self) -> usize {
        self.served
    }

    /// Goes on where so many of its times have passed.
    pub fn resume(&mut self, served: usize) {
        self.served = served;
    }

    /// The next time after `time` at which a step has to end, if times are exact.
    pub fn stop(&self, time: f64) -> Option<f64> {
        let next = self.asked(0, time);
        match &self.when {
            When::At(times) if self.exact => times.get(next).copied(),
            When::Every(interval) if self.exact => Some(interval * next as f64),
            _ => None,
        }
    }

    /// How many of these times are at or before a step or a time.
    fn asked(&self, step: usize, time: f64) -> usize {
        let time = time * (1.0 + SAME);
        match &self.when {
            When::At(times) => times.partition_point(|t| *t <= time),
            When::Every(interval) => ((time / interval).floor() as usize).saturating_add(1),
            When::EverySteps(steps) => step / steps + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps of size .1 up to 1 that a schedule looks at.
    fn looks(mut schedule: Schedule) -> Vec<usize> {
        let dt = |n| if n == 10 { 0.0 } else { 0.1 };
        (0..=10).filter(|&n| schedule.due(n, n as f64 * 0.1, dt(n))).collect()
    }

    #[test]
    fn the_nearest_step_is_taken_once() {
        // .24 lies nearest to .2, .26 and .28 to .3.
        assert_eq!(looks(Schedule::new(When::At(vec![0.0, 0.24, 0.26, 0.28, 1.0]), false)), [0, 2, 3, 10]);
    }

    #[test]
    fn the_last_state_stands_once_for_all_times_after_the_end() {
        assert_eq!(looks(Schedule::new(When::At(vec![0.5, 2.0, 3.0]), false)), [5, 10]);
        assert_eq!(looks(Schedule::new(When::At(vec![2.0]), true)), [10]);
    }

    #[test]
    fn intervals_count_from_the_start_and_stop_with_the_run() {
        assert_eq!(looks(Schedule::new(When::Every(0.25), false)), [0, 2, 5, 7, 10]);
        // 3 x .1 is a rounding above .3: a multiple of the interval is met all the same.
        assert_eq!(looks(Schedule::new(When::Every(0.1), true)), (0..=10).collect::<Vec<_>>());
        assert_eq!(looks(Schedule::new(When::Every(5.0), false)), [0]);
        assert_eq!(looks(Schedule::new(When::EverySteps(4), false)), [0, 4, 8]);
        assert_eq!(looks(Schedule::new(When::EverySteps(4), false).with_end()), [0, 4, 8, 10]);
        assert_eq!(looks(Schedule::new(When::EverySteps(5), false).with_end()), [0, 5, 10]);
        assert_eq!(looks(Schedule::new(When::Every(0.4), false).with_end_of_intervals()), [0, 4, 8, 10]);
        assert_eq!(looks(Schedule::new(When::At(vec![0.4]), false).with_end_of_intervals()), [4]);
    }

    #[test]
    fn an_interval_far_below_the_step_costs_nothing() {
        assert_eq!(looks(Schedule::new(When::Every(1e-15), false)), (0..=10).collect::<Vec<_>>());
    }

    #[test]
    fn exact_times_name_the_next_stop_and_are_not_served_before_it() {
        let mut schedule = Schedule::new(When::Every(0.25), true);
        assert_eq!(schedule.stop(0.0), Some(0.25));
        // The nearest step would do for times that are not exact.
        assert!(schedule.due(0, 0.0, 0.1) && !schedule.due(1, 0.24, 0.1) && schedule.due(2, 0.25, 0.1));
        assert_eq!(schedule.stop(0.25), Some(0.5));
        let list = Schedule::new(When::At(vec![0.1, 0.3]), true);
        assert_eq!([0.0, 0.1, 0.2, 0.3].map(|t| list.stop(t)), [Some(0.1), Some(0.3), Some(0.3), None]);
        assert_eq!(Schedule::new(When::At(vec![0.1]), false).stop(0.0), None);
    }
}
