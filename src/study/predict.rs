//! From records of a series to the seconds and the error on a finer mesh.

use super::case::Record;
use crate::lane::LANES;

/// What counts of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Level {
    refinement: f64,
    h: f64,
    error: f64,
    cpu: f64,
    steps: f64,
    blocks: f64,
}

/// The size of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Cells per direction over those of the scene, which errors go with.
    pub refinement: f64,
    /// min_e h_e in any unit that is the same for all meshes, which steps go with.
    pub h: f64,
    /// Blocks of eight cells, which the seconds of a step go with.
    pub blocks: f64,
}

/// What is expected of a run.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Prediction {
    /// CPU seconds.
    pub cpu: f64,
    /// Standard error.
    pub error: f64,
}

/// The smallest rate that is believed: a shock's is 1/2 in L2.
const SLOWEST: f64 = 0.25;

/// A rate above this is that of a smooth solution.
const SMOOTH: f64 = 0.8;

/// e ~ h^p and seconds ~ steps (a + b blocks), from the finest levels of a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    levels: Vec<Level>,
    rate: f64,
}

impl Model {
    /// From records of one series of degree N, in any order; none without one that went well.
    pub fn fit<'a>(degree: usize, records: impl Iterator<Item = &'a Record>) -> Option<Self> {
        let level = |r: &Record| {
            let blocks = (r.cells as f64 / LANES as f64).ceil();
            let error = r.error().filter(|e| e.is_finite() && *e > 0.0)?;
            Some(Level { refinement: r.case.refinement, h: r.h, error, cpu: r.cpu, steps: r.steps as f64, blocks })
        };
        let mut levels: Vec<Level> = records.filter_map(level).collect();
        levels.sort_by(|a, b| a.refinement.total_cmp(&b.refinement));
        levels.dedup_by(|a, b| a.refinement == b.refinement);
        let full = degree as f64 + 1.0;
        let rates: Vec<f64> = levels.windows(2).map(|pair| rate(&pair[0], &pair[1])).collect();
        // A rate that still rises goes on rising, but not beyond the order of the method. Of two levels that see a smooth
        // solution (the L2 rate at a shock is 1/2) the next rate lies half-way to that order: measured on the simple wave
        // and the box, S1 to S4, where the error is then met within 15 %, and missed by up to 3 with the last rate.
        let rate = match rates[..] {
            [] => full,
            [only] if only > SMOOTH => 0.5 * (only + full.max(only)),
            [only] => only,
            [.., before, last] => last + (0.5 * (last - before)).clamp(0.0, (full - last).max(0.0)),
        };
        (!levels.is_empty()).then_some(Self { levels, rate: rate.clamp(SLOWEST, full + 0.5) })
    }

    fn finest(&self) -> Level {
        self.levels[self.levels.len() - 1]
    }

    /// The finest refinement that the model rests on.
    pub fn reach(&self) -> f64 {
        self.finest().refinement
    }

    /// The finest level, or the finer of the two around a refinement, and the rate there.
    fn near(&self, is_above: impl Fn(&Level) -> bool) -> (Level, f64) {
        match self.levels.iter().position(is_above) {
            None => (self.finest(), self.rate),
            Some(_) if self.levels.len() == 1 => (self.finest(), self.rate),
            Some(k) => {
                let fine = k.max(1);
                (self.levels[fine], rate(&self.levels[fine - 1], &self.levels[fine]).max(SLOWEST))
            }
        }
    }

    /// Seconds and error on a mesh.
    pub fn at(&self, size: Size) -> Prediction {
        let (level, rate) = self.near(|level| level.refinement >= size.refinement);
        let steps = level.steps * level.h / size.h;
        let error = level.error * (level.refinement / size.refinement).powf(rate);
        Prediction { cpu: steps * self.step(size.blocks), error }
    }

    /// Seconds of a step with so many blocks.
    fn step(&self, blocks: f64) -> f64 {
        let of = |level: &Level| level.cpu / level.steps.max(1.0);
        let finest = self.finest();
        // What a step costs whatever its size: between nothing and half of the coarser level's.
        let fixed = match self.levels[..] {
            [.., before, _] if finest.blocks > before.blocks => {
                let apart = (of(&finest) - of(&before)) / (finest.blocks - before.blocks);
                (of(&finest) - apart * finest.blocks).clamp(0.0, 0.5 * of(&before))
            }
            _ => 0.0,
        };
        fixed + (of(&finest) - fixed) / finest.blocks * blocks
    }

    /// The refinement that an error needs; not below half of the coarsest one measured.
    pub fn refinement_for(&self, error: f64) -> f64 {
        let (level, rate) = self.near(|level| level.error <= error);
        let refinement = level.refinement * (level.error / error).powf(1.0 / rate);
        refinement.max(0.5 * self.levels[0].refinement)
    }
}

/// The observed rate between two levels.
fn rate(coarse: &Level, fine: &Level) -> f64 {
    (coarse.error / fine.error).ln() / (fine.refinement / coarse.refinement).ln()
}
