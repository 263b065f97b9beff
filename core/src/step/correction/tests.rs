//! What a correction sees and changes; that the survey and the balance follow; that without one nothing is different.
use super::*;
use crate::step::tests::{KINDS, Kind, chessboard, distorted, midpoints, scheme, state, wall, wavy};
use crate::step::{Balance, LossKind, Motion, Survey};
use std::sync::Arc;
use std::sync::Mutex;

/// A correction that does `change` to blocks for which `which` holds, and notes the stages that it has seen.
struct Change {
    which: fn(usize) -> bool,
    change: fn(&Made, &mut Corrected),
    after_stages: bool,
    stages: &'static Mutex<Vec<Option<usize>>>,
}

impl Correction for Change {
    fn name(&self) -> &str {
        "change"
    }
    fn after_stages(&self) -> bool {
        self.after_stages
    }
    fn applies(&self, made: &Made, block: usize) -> bool {
        if block == 0 {
            self.stages.lock().unwrap().push(made.stage);
        }
        (self.which)(block)
    }
    fn correct(&self, made: &Made, block: &mut Corrected) {
        (self.change)(made, block);
    }
}

fn change(which: fn(usize) -> bool, change: fn(&Made, &mut Corrected)) -> Change {
    Change { which, change, after_stages: false, stages: Box::leak(Box::default()) }
}

/// The scheme of a kind at degree 2 with corrections, and a smooth state.
fn problem(cells: usize, kind: Kind, corrections: Vec<Arc<dyn Correction>>) -> (Scheme, State) {
    let mesh = distorted(cells);
    let scheme = Scheme { corrections, ..scheme(&mesh, kind, 2, &midpoints(&mesh, 2), wall) };
    let state = state(&mesh, &scheme, wavy);
    (scheme, state)
}

/// After some steps, with a balance.
fn moved(scheme: &Scheme, state: &State, steps: usize) -> (Motion, Balance) {
    let mut motion = Motion::unsurveyed(scheme, state.clone()).with_balance(scheme);
    motion.survey(scheme).unwrap();
    let mut balance = Balance::starting_at(scheme.totals(state).energy());
    for _ in 0..steps {
        motion.advance(scheme, 2e-3).unwrap();
        motion.work.settle(scheme, &mut balance);
    }
    (motion, balance)
}

fn nothing(_: &Made, _: &mut Corrected) {}

/// Momenta by a factor.
fn damp(made: &Made, block: &mut Corrected) {
    let n = made.scheme.operators.nodes();
    block.u[4 * n..6 * n].iter_mut().for_each(|p| p.0.iter_mut().for_each(|p| *p *= 0.9));
}

/// F by a factor, so that wave speeds and J change.
fn stretch(made: &Made, block: &mut Corrected) {
    let n = made.scheme.operators.nodes();
    block.u[..4 * n].iter_mut().for_each(|f| f.0.iter_mut().for_each(|f| *f *= 0.999));
}

#[test]
fn without_a_correction_nothing_is_stored_and_one_that_does_not_apply_changes_no_bit() {
    for kind in KINDS {
        let (plain, start) = problem(5, kind, vec![]);
        let (idle, _) = problem(5, kind, vec![Arc::new(change(|_| false, stretch))]);
        let (same, _) = problem(5, kind, vec![Arc::new(change(|_| true, nothing))]);
        let [plain, idle, same] = [&plain, &idle, &same].map(|scheme| moved(scheme, &start, 20));
        assert!(plain.0.work.corrections.is_none() && idle.0.work.bytes() > plain.0.work.bytes());
        for other in [&idle, &same] {
            assert!(other.0.state == plain.0.state && other.0.survey == plain.0.survey, "{kind:?}");
            assert_eq!(other.1.energy, plain.1.energy);
        }
    }
}

#[test]
fn a_correction_acts_on_its_blocks_whose_survey_is_renewed_for_any_number_of_threads() {
    for kind in KINDS {
        let (plain, start) = problem(40, kind, vec![]);
        let (corrected, _) = problem(40, kind, vec![Arc::new(change(|block| block % 3 == 1, stretch))]);
        let results = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| moved(&corrected, &start, 1).0)
        });
        assert!(results[0].state == results[1].state && results[0].survey == results[1].survey);
        let (found, before) = (&results[0], &moved(&plain, &start, 1).0);
        let blocks = found.state.u.chunks(6 * 9).zip(before.state.u.chunks(6 * 9));
        assert!(blocks.enumerate().all(|(block, (new, old))| (new == old) == (block % 3 != 1)), "{kind:?}");
        let mut expected = Survey::default();
        corrected.survey(&found.state, &found.work, &mut expected).unwrap();
        assert_eq!((&found.survey.speed, found.survey.fastest), (&expected.speed, expected.fastest), "{kind:?}");
        // The step has seen the faces of the state before, too.
        assert!(found.survey.min_j <= expected.min_j && found.survey.speed != before.survey.speed);
    }
}

#[test]
fn a_correction_sees_all_blocks_as_they_were_before_it() {
    // Each block takes the momenta of the next one: done in place, those of the first would go all around.
    fn next(made: &Made, block: &mut Corrected) {
        let (n, all) = (made.scheme.operators.nodes(), made.scheme.operators.blocks.len());
        block.u[4 * n..].copy_from_slice(&made.unknowns((block.number + 1) % all)[4 * n..]);
    }
    let (plain, start) = problem(16, Kind::AderDgmpm, vec![]);
    let (corrected, _) = problem(16, Kind::AderDgmpm, vec![Arc::new(change(|_| true, next))]);
    let [plain, found] = [&plain, &corrected].map(|scheme| moved(scheme, &start, 1).0.state.u);
    for block in 0..32 {
        let momenta = |u: &[F8], block: usize| u[54 * block + 36..54 * (block + 1)].to_vec();
        assert_eq!(momenta(&found, block), momenta(&plain, (block + 1) % 32), "{block}");
    }
}

#[test]
fn a_correction_that_acts_on_stages_sees_each_and_changes_no_bit_where_it_changes_nothing() {
    for cells in [5, 40] {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let (plain, start) = problem(cells, Kind::RkDgfem, vec![]);
                let nothing = Change { after_stages: true, ..change(|_| true, nothing) };
                let seen = nothing.stages;
                let (corrected, _) = problem(cells, Kind::RkDgfem, vec![Arc::new(nothing)]);
                let [(plain, _), (found, _)] = [&plain, &corrected].map(|scheme| moved(scheme, &start, 5));
                assert!(found.state == plain.state && found.survey == plain.survey, "{cells} {threads}");
                // RK4: the first stage begins with the state that the step before has left.
                assert_eq!(*seen.lock().unwrap(), [Some(1), Some(2), Some(3), None].repeat(5));
                let damping = Change { after_stages: true, ..change(|_| true, damp) };
                let (damped, _) = problem(cells, Kind::RkDgfem, vec![Arc::new(damping)]);
                let (late, _) = problem(cells, Kind::RkDgfem, vec![Arc::new(change(|_| true, damp))]);
                let [damped, late] = [&damped, &late].map(|scheme| moved(scheme, &start, 1).0);
                assert!(damped.state != late.state, "what is changed in a stage goes into its rates");
            });
        }
    }
    // Of ADER there are no stages.
    let nothing = Change { after_stages: true, ..change(|_| true, nothing) };
    let seen = nothing.stages;
    let (ader, start) = problem(5, Kind::AderDgmpm, vec![Arc::new(nothing)]);
    moved(&ader, &start, 2);
    assert_eq!(*seen.lock().unwrap(), [None, None]);
}

#[test]
fn what_a_correction_takes_of_the_energy_has_an_entry_of_its_own_in_the_balance() {
    for kind in KINDS {
        let (damped, start) = problem(5, kind, vec![Arc::new(change(|block| block != 2, damp))]);
        let (motion, balance) = moved(&damped, &start, 10);
        let energy = damped.totals(&motion.state).energy();
        assert!(balance.correction_dissipation > 1e-3 * balance.start, "{kind:?}: {balance:?}");
        // As without: the rounding of sums in another order.
        assert!((balance.remainder(energy) / energy).abs() < 1e-13, "{kind:?}: {balance:?}");
    }
}

#[test]
fn a_correction_that_ruins_a_block_is_a_loss_and_the_state_stays() {
    fn invert(_: &Made, block: &mut Corrected) {
        block.u[..9].iter_mut().for_each(|f11| f11.0[3] = -1.0);
    }
    let (corrected, start) = problem(5, Kind::AderDgfem, vec![Arc::new(change(|block| block == 1, invert))]);
    let mut motion = Motion::new(&corrected, start.clone()).unwrap();
    let loss = motion.advance(&corrected, 1e-3).unwrap_err();
    assert_eq!((loss.cell, motion.state == start), (corrected.operators.blocks.cells[1][3], true));
    assert!(matches!(loss.kind, LossKind::Inverted(_)));
}

#[test]
fn two_corrections_act_one_after_the_other_in_a_body_of_two_laws() {
    let mesh = distorted(4);
    let run = |corrections: Vec<Arc<dyn Correction>>| {
        let scheme = Scheme { corrections, ..chessboard(&mesh, Kind::AderDgmpm).0 };
        let start = state(&mesh, &scheme, wavy);
        moved(&scheme, &start, 1).0.state
    };
    fn one(_: &Made, block: &mut Corrected) {
        block.u.iter_mut().for_each(|u| u.0[0] += 1e-3);
    }
    fn twice(_: &Made, block: &mut Corrected) {
        block.u.iter_mut().for_each(|u| (0..8).for_each(|lane| u.0[lane] *= 1.001));
    }
    let changes = || (Arc::new(change(|_| true, one)), Arc::new(change(|_| true, twice)));
    let ((a, b), (c, d)) = (changes(), changes());
    assert!(run(vec![a, b]) != run(vec![d, c]), "the order counts");
}
