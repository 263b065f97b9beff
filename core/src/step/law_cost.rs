//! What a law costs at a point: its operations, counted.

use crate::lane::Lane;
use crate::lane::counted::{Counted, Counts, SLOTS, count};
use crate::material::{Material, Past, virgin};

/// Operations of a law at a point, in those of additions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawCost {
    /// P(F).
    pub stress: f64,
    /// c_p of a trace.
    pub speed: f64,
    /// The speeds that the survey looks at.
    pub survey: f64,
    /// Whether it has a history, with which it goes through more in the survey.
    pub has_memory: bool,
}

/// A division or a root takes the time of so many other operations: AVX-512 and AVX2 do 8 to 16 additions meanwhile, of which others can
/// do a part.
const DIVISION: u64 = 8;

impl LawCost {
    /// Counts those of a law. What a law does depends on no number, so that they are the same on every machine.
    pub fn of<M: Material>(law: &M) -> Self {
        let f = || [1.0, 0.1, 0.0, 1.0].map(Counted::splat);
        let history = || virgin::<Counted, M>();
        let stress = operations(|| _ = law.stress(f(), &mut Past::now(history())));
        let speed = operations(|| _ = law.pressure_speed(f(), [1.0, 0.0].map(Counted::splat)));
        let survey = operations(|| _ = law.largest_squares(f(), &history()));
        Self { stress, speed, survey, has_memory: !M::HISTORY.is_empty() }
    }
}

fn operations(body: impl FnOnce()) -> f64 {
    let counts = count(body)[SLOTS - 1];
    let Counts { divisions, roots, .. } = counts;
    (counts.flops() + (DIVISION - 1) * (divisions + roots)) as f64
}
