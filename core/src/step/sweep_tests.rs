//! What the predictor holds for both schedules of its sweeps and for every form of its matrices.
use super::tests::*;
use super::*;
use crate::basis::TimeBasis;
use crate::cloud::{Cloud, seed};
use crate::mesh::rectangle;
use crate::operators::{PointMatrices, Share};

/// ADER with the paper's sweeps, N_T = N.
fn paper(degree: usize) -> Method {
    let time = TimeBasis::new(degree);
    Method::Ader { sweeps: Sweeps::paper(&time, degree + 1), time }
}

#[test]
fn noise_on_compressed_states_decays_with_both_schedules() {
    for degree in 1..=4 {
        for method in [Method::ader(degree, degree), paper(degree)] {
            noise_decays(Kind::AderDgmpm, degree, Some(method));
        }
    }
}

#[test]
fn the_ladder_is_the_papers_predictor_to_its_order() {
    // One step from a smooth state by both schedules: they differ in u^(N+1) of the predictor, which enters the
    // averages at dt^(N+1), the update at dt^(N+2). Halving dt divides the difference by 2^(N+2).
    let mesh = rectangle([1.0, 1.0], [4, 4]).unwrap();
    for degree in 1..=4 {
        let differ = |courant: f64| {
            let states = [Method::ader(degree, degree), paper(degree)].map(|method| {
                let scheme = Scheme { method, ..scheme(&mesh, Kind::AderDgfem, degree, &Cloud::default(), wall) };
                let mut state = state(&mesh, &scheme, wavy);
                march(&scheme, &mut state, 1, courant);
                unpacked(&scheme, &state)
            });
            largest_difference(&states[0], &states[1])
        };
        let limit = cfl::limit(&Method::ader(degree, degree), degree);
        let (full, half) = (differ(limit), differ(0.5 * limit));
        let order = (full / half).log2();
        println!("S{degree}: {full:.2e} {half:.2e}, order {order:.2}");
        // From the theory above; the difference is not rounding, and no more than an error of the order at hand.
        assert!((order - (degree + 2) as f64).abs() < 0.3, "S{degree}: {order}");
    }
}

/// The cloud with the points of each cell in another order: not a lattice by its order, but the same points.
fn shuffled(cloud: &Cloud, cells: usize, shift: fn(usize) -> usize) -> Cloud {
    let mut out = cloud.clone();
    for cell in 0..cells {
        let range = cloud.first[cell]..cloud.first[cell + 1];
        let count = range.len();
        out.xi[range].rotate_left(shift(cell) % count);
    }
    out
}

#[test]
fn lattices_shared_and_own_dense_matrices_give_the_same_run() {
    for mesh in [rectangle([1.0, 0.7], [4, 4]).unwrap(), distorted(4)] {
        for degree in 1..=4 {
            for more in [1, 2] {
                let lattice = seed::seed(seed::Layout::Midpoints, degree + more, 16);
                let clouds =
                    [lattice.clone(), shuffled(&lattice, 16, |_| 1), shuffled(&lattice, 16, |cell| cell % 3 + 1)];
                let states = clouds.each_ref().map(|cloud| {
                    let scheme = scheme(&mesh, Kind::AderDgmpm, degree, cloud, wall);
                    let pool = &scheme.operators.points.as_ref().unwrap().pool;
                    let dense = |m: &PointMatrices<f64>| matches!(m, PointMatrices::Dense { .. });
                    let form = match pool.share[0] {
                        Share::Own(_) => 2,
                        Share::Shared(k) => usize::from(dense(&pool.shared[k])),
                    };
                    let mut state = state(&mesh, &scheme, wavy);
                    march(&scheme, &mut state, 100, 0.8 * cfl::limit(&scheme.method, degree));
                    (form, unpacked(&scheme, &state))
                });
                assert_eq!(states.each_ref().map(|(form, _)| *form), [0, 1, 2]);
                for (form, other) in &states[1..] {
                    // Rounding of 100 stable steps times the condition of the fit.
                    let difference = largest_difference(&states[0].1, other);
                    assert!(difference < 1e-12, "S{degree}, {more} more, form {form}: {difference:e}");
                }
            }
        }
    }
}

#[test]
fn one_evaluation_from_the_constant_guess_is_as_good_as_one_at_every_node() {
    // The paper's first sweep on all nodes, written out: W = At from N_T + 1 nodes that all hold U^n.
    let mesh = distorted(4);
    for degree in 1..=3 {
        let time = TimeBasis::new(degree);
        let one = Sweeps::paper(&time, degree + 1);
        let mut every = one.clone();
        let len = time.len();
        // All nodes of the first sweep at U^n: rows of zeros from the single node before.
        every.inner.insert(
            1,
            sweeps::Sweep {
                to: len,
                tau: time.tau.clone(),
                from: 1,
                rates: vec![0.0; len],
                sources: vec![0.0; len * len],
                at_times: vec![0.0; len],
            },
        );
        every.inner[2] = sweeps::Sweep { to: len, from: len, rates: time.integration.clone(), ..one.inner[1].clone() };
        let states = [one, every].map(|sweeps| {
            let method = Method::Ader { sweeps, time: time.clone() };
            let scheme = Scheme { method, ..scheme(&mesh, Kind::AderDgfem, degree, &Cloud::default(), wall) };
            let mut state = state(&mesh, &scheme, wavy);
            march(&scheme, &mut state, 20, 0.03);
            unpacked(&scheme, &state)
        });
        // Rows of At sum to tau to 1e-13 times rates of size 1, times dt.
        assert!(largest_difference(&states[0], &states[1]) < 1e-13, "S{degree}");
    }
}
