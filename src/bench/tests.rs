use super::series::SIZES;
use super::summary::{self, Row};
use super::*;
use crate::basis::TimeBasis;
use crate::chart::{Chart, Line, Marker, Scale, Stroke, save};
use crate::lane::counted::{self, Counts, SLOTS};
use crate::lane::{F8, Kernel, Lanes, Work, load_array};
use crate::material::{LinearElastic, Material, NeoHookean, Past, virgin};
use crate::registry::Method;
use crate::step::Phase;
use crate::step::sweeps::{Sweep, Sweeps};

fn setup(method: Method, degree: usize, layout: &str) -> Setup {
    Setup {
        method,
        degree,
        domain: Domain::Cells([8, 8]),
        layout: Some(layout.to_owned()),
        law: "neo-hookean".to_owned(),
        kernel: Kernel::Portable,
        sets: vec![],
    }
}

struct Stress<M>(M);
impl<M: Material> Work for Stress<M> {
    type Out = ();
    fn run<L: Lanes>(self) {
        let f = load_array::<L, 4>(&[1.1, 0.1, 0.2, 0.9].map(F8::splat));
        self.0.stress(f, &mut Past::now(virgin::<L, M>()));
    }
}

/// Flops of the stress of neo-Hookean: det 1 mul 1 fma; J^(-1/3) twice 3 mul 4 fma; I 2 mul 2 add 2 fma; powers of the
/// root and A 3 mul; B 3 mul 1 add 1 fma; A F + B cof F 4 mul 4 fma.
const STRESS: u64 = 54;

#[test]
fn stress_takes_the_flops_of_its_formula() {
    let of = |counts: [Counts; SLOTS]| counts[SLOTS - 1];
    let neo_hookean = of(counted::count(|| Kernel::Counting.run(Stress(NeoHookean::new(1.0, 0.3, 1.0)))));
    let expected = Counts { additions: 3, multiplications: 19, fused: 16, divisions: 0, roots: 0 };
    assert_eq!((neo_hookean, neo_hookean.flops()), (expected, STRESS));
    // tr eps 3 add, times lambda 1 mul; shear 1 add 1 mul; the diagonal 2 add 2 fma.
    let linear = of(counted::count(|| Kernel::Counting.run(Stress(LinearElastic::new(1.0, 0.3, 1.0)))));
    assert_eq!(linear, Counts { additions: 6, multiplications: 2, fused: 2, divisions: 0, roots: 0 });
}

#[test]
fn dense_products_at_the_points_take_two_flops_an_entry_and_field() {
    for degree in 1..=4 {
        let flops = count(&setup(Method::AderDgmpm, degree, "jitter")).unwrap();
        let n = ((degree + 1) * (degree + 1)) as f64;
        // G2P of six fields; P2G of F, v and P, ten fields.
        assert_eq!(flops.of(Phase::GridToPoints as usize), 2.0 * 6.0 * n * n, "S{degree}");
        assert_eq!(flops.of(Phase::PointsToGrid as usize), 2.0 * 10.0 * n * n, "S{degree}");
    }
}

#[test]
fn the_predictor_takes_the_flops_of_its_sweeps() {
    for degree in 1..=3 {
        let flops = count(&setup(Method::AderDgmpm, degree, "jitter")).unwrap();
        let n = ((degree + 1) * (degree + 1)) as u64;
        let sweeps = Sweeps::of_degree(degree, &TimeBasis::new(degree));
        // At a point and time node: u as a sum of rates, the law, p / rho0; then rows of D along X1, X2 for four fields
        // each (affine cells: the matrices hold derivatives along X).
        let inner = |s: &Sweep| s.to as u64 * n * (2 * 6 * s.from as u64 + STRESS + 2 + 2 * 8 * n);
        let (to, from) = (sweeps.last.to as u64, sweeps.last.from as u64);
        // Averages: of u from the rates, of P from F at the last nodes.
        let average = n * (2 * 6 * from + 2) + n * to * (2 * 4 * from + STRESS + 2 * 4);
        let expected = sweeps.inner.iter().map(inner).sum::<u64>() + average;
        assert_eq!(flops.of(Phase::Predictor as usize), expected as f64, "S{degree}");
    }
}

#[test]
fn the_volume_term_takes_the_flops_of_sum_factorisation() {
    for degree in 1..=4 {
        let flops = count(&setup(Method::AderDgfem, degree, "gauss")).unwrap();
        let m = (degree + 1) as f64;
        // At a node: four contravariant tractions at 1 mul 1 fma; eight sums along lines of 1 mul and m - 1 fma; four
        // gradients at 1 mul 1 fma; two rows of momentum at 1 add. Two cofactors of 1 fma on each of 2 m lines.
        let expected = m * m * (4.0 * 3.0 + 8.0 * (2.0 * m - 1.0) + 4.0 * 3.0 + 2.0) + 2.0 * m * 2.0 * 2.0;
        assert_eq!(flops.of(Phase::Volume as usize), expected, "S{degree}");
    }
}

#[test]
fn the_curl_free_projection_takes_the_flops_of_its_halves() {
    for degree in 1..=4 {
        for method in [Method::RkDgfem, Method::AderDgfem] {
            let lcf = Setup { sets: vec!["curl.control=lcf".into()], ..setup(method, degree, "gauss") };
            let flops = count(&lcf).unwrap();
            let n = (degree + 1) * (degree + 1);
            let (even, odd, middle) = (n.div_ceil(2) as f64, (n / 2) as f64, (n % 2) as f64);
            // For each of four fields a sum and a difference a pair of nodes and 2 more behind the products, then theta of
            // them is subtracted. Products of both rows of F with two square matrices, two rows a node; at four nodes sums do
            // not begin from zero.
            let mut product = 4.0 * (odd * 8.0 + middle * 2.0) + 2.0 * 2.0 * (4.0 * even * even + 4.0 * odd * odd);
            product -= if degree == 1 { 2.0 * 2.0 * (even + odd) } else { 0.0 };
            // theta: its argument 1 mul 1 div; k 1 mul 2 add, r 1 fma, the series 11 fma and 2 powers, q 1 fma, and 1 add 1
            // fma.
            let theta = 2.0 + 3.0 + 2.0 + 2.0 * 11.0 + 2.0 + 2.0 + 3.0;
            assert_eq!(flops.of(Phase::CurlFree as usize), product + theta, "{method:?} S{degree}");
        }
        let off = Setup { sets: vec!["curl.control=off".into()], ..setup(Method::RkDgfem, degree, "gauss") };
        assert_eq!(count(&off).unwrap().of(Phase::CurlFree as usize), 0.0);
    }
}

#[test]
fn counts_of_a_cell_do_not_depend_on_the_mesh() {
    let squares = setup(Method::RkDgfem, 2, "gauss");
    let slender = Setup { domain: Domain::Cells([48, 2]), ..squares.clone() };
    assert_eq!(count(&squares).unwrap(), count(&slender).unwrap());
}

#[test]
fn the_wave_is_solved_with_the_order_of_the_degree() {
    for method in [Method::RkDgfem, Method::AderDgmpm] {
        let errors = [16, 32].map(|n| {
            let setup = Setup { domain: Domain::Cells([n, 2]), ..setup(method, 2, "midpoints") };
            measure(&setup.build().unwrap(), 1, Length::Wave).unwrap().error
        });
        // Order 3; the pulse is one and two cells wide: from 2.5 up, and smaller than a third in any case.
        let order = (errors[0] / errors[1]).log2();
        assert!(order > 2.5 && errors[1] < 0.02, "{method:?}: {errors:?}");
    }
}

#[test]
fn a_measurement_has_the_steps_it_was_asked_for_and_starts_anew_after_the_wave() {
    let problem = setup(Method::RkDgfem, 1, "gauss").build().unwrap();
    let wave = measure(&problem, 1, Length::Wave).unwrap();
    let longer = measure(&problem, 2, Length::Steps(2 * wave.steps + 3)).unwrap();
    assert_eq!((longer.steps, longer.threads), (2 * wave.steps + 3, 2));
    // The error is that of the end of the wave: the same bits, however often it was run and on however many threads.
    assert_eq!(longer.error.to_bits(), wave.error.to_bits());
    assert_eq!((wave.dofs, wave.cells, wave.points, wave.stages), (64 * 24, 64, 256, 2));
    assert!(wave.cpu > 0.0 && wave.wall > 0.0 && wave.phases.seconds.iter().sum::<f64>() > 0.0);
}

#[test]
fn traffic_of_rk2_is_what_its_sweeps_read_and_write() {
    let problem = setup(Method::RkDgfem, 1, "gauss").build().unwrap();
    let operators = &problem.problem.scheme.operators;
    // U and the displacement; a trace with the flux dual: F, v, t, c_p, u.
    let (unknowns, traces) = (8.0 * 4.0 * 8.0, 4.0 * 2.0 * 11.0 * 8.0);
    let cells = problem.problem.body.mesh.cells.len() as f64;
    let geometry = (2 * operators.geometry.bytes() + operators.blocks.bytes()) as f64 / cells;
    let curl_free = operators.curl_free.as_ref().unwrap().bytes() as f64 / cells;
    // Two stages; one earlier rate in the second, two in the update; U in, U out.
    let expected = 2.0 * (4.0 * unknowns + 2.0 * traces + geometry) + 3.0 * unknowns + 2.0 * unknowns + curl_free;
    assert!((traffic(&problem) - expected).abs() < 1e-9 * expected, "{} {expected}", traffic(&problem));
}

#[test]
fn peaks_are_those_of_a_machine() {
    let peaks = peaks(Kernel::widest(), 1).unwrap();
    // From a slow laptop under load to a processor that does not exist yet.
    assert!((1e8..1e12).contains(&peaks.fma) && (1e8..1e12).contains(&peaks.triad), "{peaks:?}");
}

#[test]
fn tables_hold_what_was_measured_and_leave_out_what_was_not() {
    let setup = setup(Method::RkDgfem, 2, "gauss");
    let problem = setup.build().unwrap();
    let measured = measure(&problem, 1, Length::Steps(2)).unwrap();
    let peaks = Peaks { fma: 4e10, triad: 2e10 };
    let figures = Figures::new(&setup, &problem, measured.clone(), count(&setup).unwrap(), peaks);
    let row =
        |variant, figures: Figures| Row { series: 0, variant, size: SIZES[0], runs: 1, best: 1.0, wall: 1.0, figures };
    let twice = Measured { cpu: 2.0 * measured.cpu, ..measured.clone() };
    let linear = Figures { measured: twice, ..figures.clone() };
    let rows = [row("", figures), row("linear-elastic", linear)];
    let text = summary::markdown(&rows);
    let line = |title: &str| text.lines().skip_while(|line| !line.contains(title)).nth(2).unwrap_or_default();
    assert_eq!(line("DoF-updates/s/core, 6e4"), format!("| rk-dgfem |  | {:.2e} |  |  |  |  |", measured.rate()));
    assert_eq!(line("rate of the linear law"), "| rk-dgfem |  | 0.50 |  |  |  |  |");
    assert!(!text.contains("two threads") && !text.contains("predictor: share") && text.contains("40.0 GFLOP/s"));
    let csv = summary::csv(&rows);
    // Names of phases have commas and stand in quotes.
    let columns = |line: &str| line.split('"').step_by(2).map(|part| part.matches(',').count()).sum::<usize>();
    assert!(csv.lines().all(|line| columns(line) == columns(csv.lines().next().unwrap())), "{csv}");
    assert_eq!(csv.lines().count(), 3);
}

#[test]
fn a_chart_is_drawn_and_an_empty_one_refused() {
    let folder = tempfile::tempdir().unwrap();
    let line = |marker| Line {
        name: format!("{marker:?}"),
        colour: 2,
        marker,
        stroke: Stroke::Full,
        points: vec![(1.0, 10.0), (5.0, 70.0)],
    };
    let markers = [Marker::Bare, Marker::Circle, Marker::Triangle, Marker::Square, Marker::Cross];
    let [title, x, y] = ["title", "x", "y"].map(str::to_owned);
    let chart = Chart { title, x, y, scales: [Scale::Log; 2], lines: markers.map(line).to_vec() };
    save(&chart, &folder.path().join("chart.svg")).unwrap();
    let svg = std::fs::read_to_string(folder.path().join("chart.svg")).unwrap();
    assert!(svg.starts_with("<svg") && markers.iter().all(|marker| svg.contains(&format!("{marker:?}"))));
    for scales in [[Scale::Linear; 2], [Scale::Log, Scale::Linear]] {
        save(&Chart { scales, ..chart.clone() }, &folder.path().join("linear.svg")).unwrap();
    }
    let empty = Chart { lines: vec![], ..chart };
    assert!(save(&empty, &folder.path().join("empty.png")).is_err());
}
