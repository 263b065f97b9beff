//! How long a step is, and where it ends.

use super::Settings;
use crate::error::Error;
use crate::step::Scheme;

/// The time after a step: one that is meant to end at the end of the run or at an exact time ends there to the last bit.
pub(super) fn end_of_step(time: f64, dt: f64, stop: f64) -> f64 {
    let end = time + dt;
    if (stop - end).abs() < 1e-9 * dt { stop } else { end }
}

/// Steps of a run that no machine does.
const ENDLESS: f64 = 1e13;

impl Settings {
    /// The largest step for cells of the least size `h` and the least `height`, m, and waves of speed `fastest`, m/s. The height counts on cells
    /// that are much longer than wide ([`Scheme::limit_at_walls`]).
    pub(crate) fn stable_step(&self, scheme: &Scheme, [h, height]: [f64; 2], fastest: f64) -> f64 {
        let of_cells = self.courant * h;
        let of_waves = scheme.limit_at_walls().map_or(of_cells, |limit| of_cells.min(limit * height)) / fastest;
        // Without damping to the last bit what it is without this line.
        if self.decay == 0.0 { of_waves } else { 1.0 / (1.0 / of_waves + self.decay) }
    }
}

/// Refuses a step of `dt` to the time `next` that does not lead to the end: not to a later time, or with a stable step of next to nothing.
///
/// # Errors
/// Bad input: cells without a size, a limit of the step of nothing, or a time whose own rounding is larger than the step.
pub(super) fn check_advance([time, next, end]: [f64; 3], [stable, dt]: [f64; 2], h: f64) -> Result<(), Error> {
    let (advance, endless) = (next - time, (end - time) / stable > ENDLESS);
    // A hundredth of a step lost by rounding is no noise any more.
    if dt > 0.0 && advance > 0.0 && (advance - dt).abs() <= 0.01 * dt && !endless {
        return Ok(());
    }
    let what = format!("at t = {time:e} s the next step is {dt:e} s: the run would not get to its end at {end:e} s");
    let remedy = match (h > 0.0, stable > 0.0 && !endless) {
        (false, _) => {
            format!("the smallest cell has the size {h:e} m: give a mesh without collapsed or inverted cells")
        }
        (true, false) => format!(
            "the step is a share of {h:e} m, the size of the smallest cell, over the wave speed: give larger cells, a larger cfl or safety, or a smaller `rate` \
             where a [[source]] damps"
        ),
        (true, true) => "times have 16 digits: let [time] start nearer to 0, or give a larger cfl or safety".to_owned(),
    };
    Err(Error::input(what, remedy))
}

/// The stable step, shortened evenly over the last ones before a time that lies `rest` ahead.
pub(super) fn step_size(rest: f64, stable: f64) -> f64 {
    let steps = (rest / stable - 1e-9).ceil();
    // Two steps suffice for evenness: none is shorter than half of the stable one.
    if steps <= 2.0 { rest / steps.max(1.0) } else { stable }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of size up to `stable` through `rest`.
    fn steps(rest: f64, stable: f64) -> Vec<f64> {
        let (mut left, mut out) = (rest, Vec::new());
        while left > 1e-9 * stable {
            out.push(step_size(left, stable));
            left -= out.last().unwrap();
        }
        out
    }

    #[test]
    fn as_few_steps_as_the_limit_allows_and_the_last_two_are_even() {
        for rest in [0.3, 1.0, 1.2, 2.0, 2.01, 3.0, 7.001, 7.999, 8.0, 41.5] {
            let all = steps(rest, 1.0);
            assert_eq!(all.len(), f64::ceil(rest) as usize, "{rest}: {all:?}");
            // The limit may be passed by the rounding that `step_size` forgives.
            assert!(all.iter().all(|dt| *dt <= 1.0 + 1e-9), "{rest}: {all:?}");
            if let [.., a, b] = all[..] {
                // Roundings of sums of up to 42 steps; neither is shorter than half of the stable step.
                assert!((a - b).abs() < 1e-12 && b > 0.5, "{rest}: {all:?}");
            }
        }
    }
}
