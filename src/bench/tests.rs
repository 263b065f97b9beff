use super::series::SIZES;
use super::summary::{self, Row};
use super::*;
use crate::chart::{Chart, Line, Marker, Scale, Stroke, save};
use crate::lane::Kernel;
use crate::registry::Method;

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
