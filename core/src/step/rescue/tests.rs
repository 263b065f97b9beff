//! What the rescue holds: it acts where a step is lost and nowhere else, and keeps mass, momentum and mean F.
use super::*;
use crate::boundary::{Boundary, Free};
use crate::state::UNKNOWNS;
use crate::step::tests::{KINDS, Kind, distorted, midpoints, scheme, state, wavy};
use crate::step::{Balance, Motion};
use std::sync::Arc;

/// Of the limit of all methods at S2, but for speeds that grow in compression.
const DT: f64 = 0.0025;
const STEPS: usize = 10;
/// Cells along a side: more than the layers of rescued cells on both sides of the middle take.
const CELLS: usize = 12;

fn free() -> Arc<dyn Boundary> {
    Arc::new(Free)
}

fn problem(kind: Kind, rescue: Option<Rescue>) -> (Scheme, State, State) {
    let mesh = distorted(CELLS);
    let scheme = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), free).with_rescue(rescue);
    // Two parts beside a corner that fly into each other at 2.3 times the speed of waves.
    let crushed = |x: [f64; 2], number: usize| {
        let mut u = wavy(x, number);
        let (column, row) = (number / 9 % CELLS, number / 9 / CELLS);
        if column < 4 && row < 2 {
            u[4] = if column < 2 { 1.5 } else { -1.5 };
        }
        u
    };
    let (smooth, crushed) = (state(&mesh, &scheme, wavy), state(&mesh, &scheme, crushed));
    (scheme, smooth, crushed)
}

/// Momentum of the body.
fn momentum(scheme: &Scheme, state: &State) -> Vec<f64> {
    let n = scheme.operators.nodes();
    let of = |k: usize| {
        let cell = |&(block, lane): &(usize, usize)| -> f64 {
            let weights = scheme.operators.node_weights(block, lane);
            (0..n).map(|a| weights[a] * state.u[(block * UNKNOWNS + k) * n + a].0[lane]).sum()
        };
        scheme.operators.blocks.slot.iter().map(cell).sum()
    };
    (4..UNKNOWNS).map(of).collect()
}

#[test]
fn a_run_that_loses_no_cell_keeps_its_bits_and_counts_nothing() {
    for kind in KINDS {
        let runs = [None, Some(Rescue::default())].map(|rescue| {
            let (scheme, smooth, _) = problem(kind, rescue);
            let mut motion = Motion::new(&scheme, smooth).unwrap();
            (0..10).for_each(|_| motion.advance(&scheme, 1e-3).unwrap());
            (motion.state, motion.survey, motion.work.counts().rescued)
        });
        assert!(runs[0].0 == runs[1].0 && runs[0].1 == runs[1].1 && runs[1].2 == 0, "{kind:?}");
    }
}

#[test]
fn cells_that_a_step_loses_are_stepped_at_order_0_and_the_balance_closes() {
    for kind in KINDS {
        let (plain, _, crushed) = problem(kind, None);
        let mut motion = Motion::new(&plain, crushed.clone()).unwrap();
        let lost = (0..STEPS).any(|_| motion.advance(&plain, DT).is_err());
        assert!(lost, "{kind:?}: without rescue the run is lost");
        let (scheme, ..) = problem(kind, Some(Rescue::default()));
        let mut motion = Motion::new(&scheme, crushed.clone()).unwrap().with_balance(&scheme);
        let mut balance = Balance::starting_at(scheme.totals(&crushed).energy());
        let (mut rescued, before) = (0, momentum(&scheme, &crushed));
        for _ in 0..STEPS {
            motion.advance(&scheme, DT).unwrap();
            motion.work.settle(&scheme, &mut balance);
            rescued += motion.work.counts().rescued;
        }
        // All edges are free: what the faces inside exchange goes from one cell to the other. Rounding of sums of 1296 nodes.
        let after = momentum(&scheme, &motion.state);
        assert!((0..2).all(|k| (after[k] - before[k]).abs() < 1e-12), "{kind:?}: {before:?} {after:?}");
        assert!(rescued > 0 && rescued < STEPS * CELLS * CELLS, "{kind:?}: {rescued}");
        let counted: f64 = motion.work.treated().iter().skip(1).step_by(2).flat_map(|cells| cells.0).sum();
        assert_eq!(counted as usize, rescued);
        let totals = scheme.totals(&motion.state);
        assert!(totals.min_j > 0.0 && balance.correction_dissipation > 0.0);
        // Rounding of sums in another order.
        let remainder = balance.remainder(totals.energy()) / balance.start;
        assert!(remainder.abs() < 1e-12, "{kind:?}: {remainder:e}");
    }
}

#[test]
fn a_rescue_is_the_same_for_any_number_of_threads() {
    for kind in KINDS {
        let runs = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let (scheme, _, crushed) = problem(kind, Some(Rescue::default()));
                let mut motion = Motion::new(&scheme, crushed).unwrap();
                (0..STEPS).for_each(|_| motion.advance(&scheme, DT).unwrap());
                (motion.state, motion.work.counts())
            })
        });
        assert!(runs[0] == runs[1], "{kind:?}");
    }
}

#[test]
fn a_cell_whose_mean_is_lost_is_a_loss() {
    let (scheme, smooth, _) = problem(Kind::AderDgmpm, Some(Rescue::default()));
    let mut motion = Motion::new(&scheme, smooth).unwrap();
    // Fifty times the stable step: no order helps.
    let lost = (0..20).find_map(|_| motion.advance(&scheme, 5.0).err());
    assert!(lost.is_some());
}
