//! From the numbers of single states to the one of a run.

use crate::error::Error;
use crate::words::{Saved, Words};

names! {
    /// What is taken of the numbers of all states of a run.
    Statistic {
        /// The largest.
        Max = "max",
        /// The smallest.
        Min = "min",
        /// The mean over time.
        Mean = "mean",
        /// The largest absolute value.
        Size = "abs",
    }
}

/// When a quantity is taken.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum When {
    /// At the end of the run.
    End,
    /// At a time, s: between the states before and after it, on a straight line.
    At(f64),
    /// Over all states of the run.
    Over(Statistic),
}

/// Two times count as equal within this share of them.
const SAME: f64 = 1e-12;

impl When {
    /// Whether a run that begins at a time, s, can never have it: only a time before the start. A sum of steps may be a rounding behind
    /// the start.
    pub fn is_before(self, start: f64) -> bool {
        matches!(self, Self::At(at) if start - at > SAME * start.abs())
    }
}

/// What is known of a quantity so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reading {
    when: When,
    /// Its number; NaN before there is one.
    pub value: f64,
    /// Whether a number at a time is known, or can never be: the run has begun behind it.
    settled: bool,
    /// Time and number of the state that was taken last; of what steps meter time and int q dt.
    last: Option<[f64; 2]>,
    /// Of a mean: int q dt over the steps between two states that have a number, and the sum of these steps, s.
    sum: [f64; 2],
    /// Of what steps meter: time and int q dt of the first state.
    first: Option<[f64; 2]>,
}

impl Reading {
    /// Before the first state.
    pub fn new(when: When) -> Self {
        Self { when, value: f64::NAN, settled: false, last: None, sum: [0.0; 2], first: None }
    }

    /// Saves what is known.
    pub fn save(&self, to: &mut Words) {
        to.real(self.value).flag(self.settled).reals(&self.sum);
        for pair in [self.last, self.first] {
            to.flag(pair.is_some()).reals(&pair.unwrap_or_default());
        }
    }

    /// Goes on from what [`Reading::save`] has saved.
    ///
    /// # Errors
    /// What was saved by something else.
    pub fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        let pair = |from: &mut Saved| -> Result<[f64; 2], Error> {
            from.count()?;
            from.array()
        };
        (self.value, self.settled, self.sum) = (from.real()?, from.flag()?, pair(from)?);
        for known in [&mut self.last, &mut self.first] {
            let (is_known, values) = (from.flag()?, pair(from)?);
            *known = is_known.then_some(values);
        }
        Ok(())
    }

    /// Whether the number of the state at `time` is needed; `dt` is the step that follows, 0 at the end of the run.
    pub fn needs(&self, time: f64, dt: f64) -> bool {
        match self.when {
            When::End => dt == 0.0,
            When::Over(_) => true,
            // The last state before, and the first that is not.
            When::At(at) => !self.settled && time + 1.5 * dt >= at,
        }
    }

    /// Takes int q dt up to a state, where steps meter it: q of the step that ends there is its mean over the step.
    pub fn take_step(&mut self, time: f64, integral: f64) {
        let [start, first] = *self.first.get_or_insert([time, integral]);
        let before = self.last.replace([time, integral]);
        let Some([begin, until]) = before.filter(|[begin, _]| time > *begin) else { return };
        let mean = (integral - until) / (time - begin);
        match self.when {
            When::End => self.value = mean,
            When::At(at) if !self.settled && time >= at => {
                self.value = if self.when.is_before(start) { f64::NAN } else { mean };
                self.settled = true;
            }
            When::At(_) => {}
            When::Over(Statistic::Max) => self.value = self.value.max(mean),
            When::Over(Statistic::Min) => self.value = self.value.min(mean),
            When::Over(Statistic::Size) => self.value = self.value.max(mean.abs()),
            When::Over(Statistic::Mean) => self.value = (integral - first) / (time - start),
        }
    }

    /// Takes the number of a state.
    pub fn take(&mut self, time: f64, value: f64) {
        match (self.when, self.last) {
            (When::End, _) => self.value = value,
            (When::At(at), _) if time < at => {}
            (When::At(_), None) => {
                self.value = if self.when.is_before(time) { f64::NAN } else { value };
                self.settled = true;
            }
            (When::At(at), Some([before, of_before])) => {
                self.value = of_before + (at - before) / (time - before) * (value - of_before);
                self.settled = true;
            }
            // A state without a number, such as one without a front, does not count.
            (When::Over(Statistic::Max), _) => self.value = self.value.max(value),
            (When::Over(Statistic::Min), _) => self.value = self.value.min(value),
            (When::Over(Statistic::Size), _) => self.value = self.value.max(value.abs()),
            (When::Over(Statistic::Mean), Some([before, of_before])) if !of_before.is_nan() && !value.is_nan() => {
                self.sum[0] += 0.5 * (time - before) * (value + of_before);
                self.sum[1] += time - before;
                self.value = self.sum[0] / self.sum[1];
            }
            // A single state is its own mean.
            (When::Over(Statistic::Mean), _) if self.sum[1] == 0.0 && !value.is_nan() => self.value = value,
            (When::Over(Statistic::Mean), _) => {}
        }
        self.last = Some([time, value]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of q(t) in steps of .1 up to 1.
    fn reading(when: When, q: impl Fn(f64) -> f64) -> (f64, usize) {
        let (mut reading, mut taken) = (Reading::new(when), 0);
        for n in 0..=10 {
            let (time, dt) = (0.1 * f64::from(n), if n == 10 { 0.0 } else { 0.1 });
            if reading.needs(time, dt) {
                reading.take(time, q(time));
                taken += 1;
            }
        }
        (reading.value, taken)
    }

    #[test]
    fn an_end_a_time_and_statistics_of_a_line() {
        let line = |t: f64| 3.0 - 2.0 * t;
        // A line is found by a straight line and by the trapezoidal rule; a few roundings.
        for (when, expected, states) in [
            (When::End, 1.0, 1),
            (When::At(0.44), 2.12, 3),
            (When::At(0.0), 3.0, 1),
            (When::At(1.0), 1.0, 3),
            (When::Over(Statistic::Max), 3.0, 11),
            (When::Over(Statistic::Min), 1.0, 11),
            (When::Over(Statistic::Mean), 2.0, 11),
        ] {
            let (value, taken) = reading(when, line);
            assert!((value - expected).abs() < 1e-14, "{when:?}: {value}");
            assert!(taken <= states, "{when:?}: {taken} states");
        }
    }

    #[test]
    fn what_steps_meter_is_their_mean_and_over_a_run_the_integral_over_the_time() {
        // Steps from 1 to 3, 4 and 6 with means 2.5, -5 and 1.
        let of = |when: When| {
            let mut reading = Reading::new(when);
            [[1.0, 10.0], [3.0, 15.0], [4.0, 10.0], [6.0, 12.0]].map(|[time, sum]| {
                reading.take_step(time, sum);
                reading.value
            })
        };
        assert_eq!(of(When::Over(Statistic::Mean))[1..], [2.5, 0.0, 0.4]);
        assert!(of(When::Over(Statistic::Mean))[0].is_nan());
        assert_eq!(of(When::Over(Statistic::Max))[3], 2.5);
        assert_eq!(of(When::Over(Statistic::Min))[3], -5.0);
        assert_eq!(of(When::Over(Statistic::Size))[3], 5.0);
        assert_eq!(of(When::End)[3], 1.0);
        // The step that the time lies in, the first one at the start; none before it.
        assert_eq!([1.0, 2.0, 3.5, 4.0, 6.0].map(|at| of(When::At(at))[3]), [2.5, 2.5, -5.0, -5.0, 1.0]);
        assert!(of(When::At(0.5))[3].is_nan() && of(When::At(7.0))[3].is_nan());
    }

    #[test]
    fn a_run_that_begins_behind_a_time_has_no_number_for_it() {
        assert!(reading(When::At(-0.1), |t| t).0.is_nan());
    }

    #[test]
    fn states_without_a_number_do_not_count_in_a_maximum_and_a_mean() {
        let late = |t: f64| if t < 0.45 { f64::NAN } else { t };
        assert_eq!(reading(When::Over(Statistic::Max), late).0, 1.0);
        // The mean of t from .5 to 1; some roundings.
        assert!((reading(When::Over(Statistic::Mean), late).0 - 0.75).abs() < 1e-14);
        assert!(reading(When::End, |_| f64::NAN).0.is_nan());
    }
}
