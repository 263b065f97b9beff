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
    /// Time and number of the state that was taken last.
    last: Option<[f64; 2]>,
    /// Of a mean: int q dt over the steps between two states that have a number, and the sum of these steps, s.
    sum: [f64; 2],
    /// Of a mean that the steps meter: time and int q dt of the first state.
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

    /// Takes the number of a state, and int q dt up to it where the steps meter it.
    pub fn take(&mut self, time: f64, value: f64, integral: Option<f64>) {
        if let (When::Over(Statistic::Mean), Some(integral)) = (self.when, integral) {
            let [start, first] = *self.first.get_or_insert([time, integral]);
            // A single state is its own mean.
            self.value = if time > start { (integral - first) / (time - start) } else { value };
            return;
        }
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
                reading.take(time, q(time), None);
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
    fn a_mean_that_steps_meter_is_the_integral_over_the_time() {
        let mut reading = Reading::new(When::Over(Statistic::Mean));
        reading.take(1.0, 7.0, Some(10.0));
        assert_eq!(reading.value, 7.0);
        reading.take(3.0, 0.0, Some(15.0));
        assert_eq!(reading.value, 2.5);
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
