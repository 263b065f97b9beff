//! The figures of a campaign as lines, CSV and Markdown.

use super::Figures;
use super::series::{AS_MANY, SERIES, SIZES, UNSTRUCTURED};
use crate::step::Phase;
use crate::step::phase::NAMES;

/// One row of `bench.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of its series.
    pub series: usize,
    /// What differs from the standard; empty: nothing.
    pub variant: &'static str,
    /// DoFs that were aimed at.
    pub size: usize,
    /// Runs of which the median stands.
    pub runs: usize,
    /// DoF-updates per CPU second of the fastest.
    pub best: f64,
    /// Steps per second on the clock of the fastest.
    pub wall: f64,
    /// The median run.
    pub figures: Figures,
}

/// A row on the terminal.
pub fn line(row: &Row) -> String {
    let m = &row.figures.measured;
    let name = format!("{} S{} {}", SERIES[row.series].0, row.figures.setup.degree, row.variant);
    format!(
        "  {name:<42} {:>9} DoF, {} threads: {:.3e} DoF-updates/s/core (best {:.3e}), {:.2e} cell-steps/s/core, {:.1} GFLOP/s",
        m.dofs,
        m.threads,
        m.rate(),
        row.best,
        m.cell_steps(),
        1e-9 * row.figures.flop_rate()
    )
}

/// `bench.csv`: rates are per CPU second (core), of the median of `runs`; seconds of phases in s of all threads; peaks of
/// all threads.
pub fn csv(rows: &[Row]) -> String {
    let phases: Vec<String> = NAMES.iter().map(|name| format!("\"s: {name}\"")).collect();
    let mut text =
        "method,degree,layout,law,variant,kernel,threads,cells,dofs,points,runs,steps,cpu_seconds,wall_seconds,\
                    dof_updates_per_second,best,cell_steps_per_second,particle_steps_per_second,flops_per_cell_step,\
                    bytes_per_cell_step,flops_per_second,fma_peak,triad_peak,memory_mib,error,"
            .to_owned();
    text += &(phases.join(",") + "\n");
    for row in rows {
        let (f, m, setup) = (&row.figures, &row.figures.measured, &row.figures.setup);
        let mut cells = vec![setup.method.name().to_owned(), setup.degree.to_string()];
        cells.extend([setup.layout.clone().unwrap_or_default(), setup.law.clone(), row.variant.to_owned()]);
        cells.push(setup.kernel.name().to_owned());
        cells.extend([m.threads, m.cells, m.dofs, m.points, row.runs, m.steps].map(|n| n.to_string()));
        cells.extend([m.cpu, m.wall].map(|s| format!("{s:.6}")));
        let rates = [m.rate(), row.best, m.cell_steps(), m.particle_steps(), f.flops.total(), f.bytes, f.flop_rate()];
        cells.extend(rates.into_iter().chain([f.peaks.fma, f.peaks.triad]).map(|x| format!("{x:.4e}")));
        cells.extend([format!("{:.1}", m.bytes as f64 / f64::from(1 << 20)), format!("{:.4e}", m.error)]);
        cells.extend(m.phases.seconds.iter().map(|s| format!("{s:.6}")));
        text += &(cells.join(",") + "\n");
    }
    text
}

/// Which rows a table takes its numbers from.
#[derive(Clone, Copy)]
struct Choice {
    size: usize,
    variant: &'static str,
    threads: usize,
}

const STANDARD: Choice = Choice { size: SIZES[0], variant: "", threads: 1 };

fn find(rows: &[Row], choice: Choice, series: usize, degree: usize) -> Option<&Row> {
    rows.iter().find(|row| {
        let f = &row.figures;
        (row.size, row.variant, f.measured.threads) == (choice.size, choice.variant, choice.threads)
            && (row.series, f.setup.degree) == (series, degree)
    })
}

/// A table of series by degree; what was not measured stays empty, and a table without a number is none.
fn grid(title: &str, value: impl Fn(usize, usize) -> Option<String>) -> String {
    let mut text = format!("| {title} | S1 | S2 | S3 | S4 | S5 | S6 |\n|---|---|---|---|---|---|---|\n");
    let mut any = false;
    for (series, (name, ..)) in SERIES.iter().enumerate() {
        let cells: Vec<Option<String>> = (1..=6).map(|degree| value(series, degree)).collect();
        if cells.iter().any(Option::is_some) {
            any = true;
            let cells: Vec<String> = cells.into_iter().map(Option::unwrap_or_default).collect();
            text += &format!("| {name} | {} |\n", cells.join(" | "));
        }
    }
    if any { text + "\n" } else { String::new() }
}

fn exponent(x: f64) -> String {
    format!("{x:.2e}")
}

fn percent(x: f64) -> String {
    format!("{:.0} %", 100.0 * x)
}

/// The tables of `docs/performance.md`.
pub fn markdown(rows: &[Row]) -> String {
    let one = |choice: Choice, value: fn(&Row) -> String| move |s, d| find(rows, choice, s, d).map(value);
    let ratio = |choice: Choice, base: Choice, show: fn(f64) -> String, value: fn(&Row) -> f64| {
        move |s, d| Some(show(value(find(rows, choice, s, d)?) / value(find(rows, base, s, d)?)))
    };
    let rate: fn(&Row) -> f64 = |row| row.figures.measured.rate();
    let wall: fn(&Row) -> f64 = |row| row.wall;
    let cell_time: fn(&Row) -> f64 = |row| 1.0 / row.figures.measured.cell_steps();
    let large = Choice { size: SIZES[1], ..STANDARD };
    let factor: fn(f64) -> String = |x| format!("{x:.2}");
    let two = Choice { threads: 2, ..large };
    let variant = |variant| Choice { variant, ..STANDARD };
    let mut text = peaks(rows);
    text += &grid("DoF-updates/s/core, 6e4 DoF", one(STANDARD, |row| exponent(row.figures.measured.rate())));
    text += &grid("the same, 9e5 DoF", one(large, |row| exponent(row.figures.measured.rate())));
    text += &grid("cell-steps/s/core, 6e4 DoF", one(STANDARD, |row| exponent(row.figures.measured.cell_steps())));
    text += &grid("GFLOP/s/core, share of FMA peak, 6e4 DoF", one(STANDARD, flop_rate));
    text += &grid("GFLOP/s/core, share of FMA peak, 9e5 DoF", one(large, flop_rate));
    text += &grid("predictor: share of FMA peak, 6e4 DoF", |s, d| {
        find(rows, STANDARD, s, d).filter(|row| row.figures.flops.of(Phase::Predictor as usize) > 0.0).map(predictor)
    });
    text += &grid("control of the curl and survey: share of a step", one(STANDARD, guards));
    text += &grid(
        "rate without the control of the curl over that with it",
        ratio(variant("no LCF"), STANDARD, factor, rate),
    );
    text += &grid("rate of the linear law over neo-Hookean", ratio(variant("linear-elastic"), STANDARD, factor, rate));
    text += &grid("rate on an unstructured mesh over as many squares", {
        ratio(variant(UNSTRUCTURED), variant(AS_MANY), factor, rate)
    });
    text +=
        &grid("two threads: times faster than one on the clock (best runs), 9e5 DoF", ratio(two, large, factor, wall));
    text += &grid("time per cell at 9e5 over 6e4 DoF", ratio(large, STANDARD, factor, cell_time));
    text += &grid("time per cell at 1e7 over 9e5 DoF", {
        ratio(Choice { size: SIZES[2], ..STANDARD }, large, factor, cell_time)
    });
    text + &phases(rows)
}

fn flop_rate(row: &Row) -> String {
    let rate = row.figures.flop_rate();
    format!("{:.1}, {}", 1e-9 * rate, percent(rate / row.figures.peak()))
}

fn predictor(row: &Row) -> String {
    percent(row.figures.phase_rate(Phase::Predictor as usize) / row.figures.peak())
}

fn guards(row: &Row) -> String {
    let share = |phase: Phase| row.figures.phase_share(phase as usize);
    format!("{} + {}", percent(share(Phase::CurlFree)), percent(share(Phase::Survey)))
}

/// The peaks.
fn peaks(rows: &[Row]) -> String {
    let mut text = String::new();
    for threads in [1, 2] {
        if let Some(row) = rows.iter().find(|row| row.figures.measured.threads == threads) {
            let (fma, triad) = (1e-9 * row.figures.peaks.fma, 1e-9 * row.figures.peaks.triad);
            text += &format!("Peaks, threads: {threads}: {fma:.1} GFLOP/s (FMA), {triad:.1} GB/s (triad).\n\n");
        }
    }
    text
}

/// What limits each kernel: seconds, flops and rates by phase, at degree 2.
fn phases(rows: &[Row]) -> String {
    let found: Vec<&Row> = (0..SERIES.len()).filter_map(|series| find(rows, STANDARD, series, 2)).collect();
    let names: Vec<&str> = found.iter().map(|row| SERIES[row.series].0).collect();
    let mut text = format!(
        "| S2, 6e4 DoF: share of the step, GFLOP/s | {} |\n|---|{}\n",
        names.join(" | "),
        "---|".repeat(names.len())
    );
    for (phase, name) in NAMES.iter().enumerate() {
        let cell = |row: &&Row| {
            let share = row.figures.phase_share(phase);
            let rate = 1e-9 * row.figures.phase_rate(phase);
            if share > 0.0 { format!("{}, {rate:.1}", percent(share)) } else { String::new() }
        };
        let cells: Vec<String> = found.iter().map(cell).collect();
        text += &format!("| {name} | {} |\n", cells.join(" | "));
    }
    text
}
