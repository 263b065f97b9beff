//! All measurements of `make bench`, into CSV, tables and pictures.

use super::series::{AS_MANY, SERIES, SIZES, UNSTRUCTURED};
use super::summary::{self, Row};
use super::{Domain, Figures, Flops, Length, Measured, Peaks, Setup, count, measure, peaks};
use crate::chart::{Chart, Line, Marker, Scale, Stroke, save};
use crate::error::Result;
use crate::io::pending::write_text;
use crate::io::read_mesh;
use crate::lane::Kernel;
use crate::study::machine;
use std::path::{Path, PathBuf};

/// Runs of the headline, of which the median stands; of the rest; seconds of a run.
const RUNS: usize = 5;
const FEW: usize = 3;
const SECONDS: f64 = 0.3;
/// Steps of the largest size.
const STEPS: usize = 4;

/// Measurements that are alternated, so that a busy moment of the machine meets all of them.
struct Batch {
    /// What is measured, with the number of its series and its variant.
    setups: Vec<(usize, &'static str, Setup)>,
    size: usize,
    threads: Vec<usize>,
    runs: usize,
    length: Length,
}

/// All measurements of this machine.
pub struct Campaign<'a> {
    /// The instruction set.
    pub kernel: Kernel,
    /// The folder of its files.
    pub out: PathBuf,
    /// An unstructured mesh to set beside squares.
    pub mesh: Option<PathBuf>,
    /// Takes a line for the user.
    pub say: &'a dyn Fn(&str),
}

impl Campaign<'_> {
    /// Measures everything; the files are written anew after each batch.
    ///
    /// # Errors
    /// Files that cannot be written, a problem that cannot be built.
    pub fn run(&self) -> Result<()> {
        let mut rows = Vec::new();
        for batch in self.batches()? {
            self.measure(&batch, &mut rows)?;
            highest_peaks(&mut rows);
            self.write(&rows)?;
        }
        (self.say)(&format!("results in {}", self.out.display()));
        Ok(())
    }

    fn write(&self, rows: &[Row]) -> Result<()> {
        let head = format!("# machine: {}\n", machine(self.kernel));
        write_text(&self.out.join("bench.csv"), &(head + &summary::csv(rows)))?;
        write_text(&self.out.join("tables.md"), &summary::markdown(rows))?;
        let charts = [("rates", rates(rows)), ("roofline", roofline(rows))];
        // The first batches have nothing for the roofline.
        for (name, chart) in charts.into_iter().filter(|(_, chart)| !chart.lines.is_empty()) {
            for ending in ["svg", "png"] {
                save(&chart, &self.out.join(format!("{name}.{ending}")))?;
            }
        }
        Ok(())
    }

    fn setup(&self, series: usize, degree: usize, size: usize) -> Setup {
        let (_, method, layout, _) = SERIES[series];
        // The square with the nearest number of unknowns.
        let side = (size as f64 / (6 * (degree + 1) * (degree + 1)) as f64).sqrt().round().max(1.0) as usize;
        Setup {
            method,
            degree,
            domain: Domain::Cells([side, side]),
            layout: layout.map(str::to_owned),
            law: "neo-hookean".to_owned(),
            kernel: self.kernel,
            sets: vec![],
        }
    }

    fn batches(&self) -> Result<Vec<Batch>> {
        let squares = self.mesh.as_deref().map(as_many_squares).transpose()?;
        let all = |size, series: &[usize], degrees: std::ops::RangeInclusive<usize>| -> Vec<_> {
            let pairs = series.iter().flat_map(|&s| degrees.clone().map(move |d| (s, d)));
            pairs.map(|(s, d)| (s, "", self.setup(s, d, size))).collect()
        };
        let timed = Length::Seconds(SECONDS);
        let batch = |setups, size, threads: &[usize], runs| Batch {
            setups,
            size,
            threads: threads.to_vec(),
            runs,
            length: timed,
        };
        let mut out = vec![batch(all(SIZES[0], &[0, 1, 2, 3], 1..=6), SIZES[0], &[1], RUNS)];
        let mut variants = Vec::new();
        for (series, degree) in [0, 2].into_iter().flat_map(|s| (1..=4).map(move |d| (s, d))) {
            let base = self.setup(series, degree, SIZES[0]);
            let free = Setup { sets: vec!["curl.control=off".to_owned()], ..base.clone() };
            let linear = Setup { law: "linear-elastic".to_owned(), ..base.clone() };
            variants.extend([(series, "no LCF", free), (series, "linear-elastic", linear)]);
            if let Some((path, squares)) = self.mesh.as_ref().zip(squares) {
                variants.push((series, AS_MANY, Setup { domain: Domain::Cells(squares), ..base.clone() }));
                variants.push((series, UNSTRUCTURED, Setup { domain: Domain::File(path.clone()), ..base }));
            }
        }
        out.push(batch(variants, SIZES[0], &[1], RUNS));
        // Alone in memory: each is built, measured on one and two threads in turn, and dropped.
        for setup in all(SIZES[1], &[0, 2, 3], 1..=4) {
            out.push(batch(vec![setup], SIZES[1], &[1, 2], RUNS));
        }
        for setup in all(SIZES[1], &[0, 2, 3], 5..=6) {
            out.push(batch(vec![setup], SIZES[1], &[1], FEW));
        }
        for setup in all(SIZES[2], &[0, 2], 1..=4) {
            out.push(Batch { length: Length::Steps(STEPS), ..batch(vec![setup], SIZES[2], &[1], 1) });
        }
        Ok(out)
    }

    fn measure(&self, batch: &Batch, rows: &mut Vec<Row>) -> Result<()> {
        let peaks: Vec<Peaks> = batch.threads.iter().map(|&n| peaks(self.kernel, n)).collect::<Result<_>>()?;
        let problems = batch.setups.iter().map(|(_, _, setup)| setup.build()).collect::<Result<Vec<_>>>()?;
        let flops: Vec<Flops> = batch.setups.iter().map(|(_, _, setup)| count(setup)).collect::<Result<_>>()?;
        let mut found: Vec<Vec<Measured>> = vec![vec![]; problems.len() * batch.threads.len()];
        for _ in 0..batch.runs {
            for (k, problem) in problems.iter().enumerate() {
                for (t, &threads) in batch.threads.iter().enumerate() {
                    found[k * batch.threads.len() + t].push(measure(problem, threads, batch.length)?);
                }
            }
        }
        for (at, mut runs) in found.into_iter().enumerate() {
            let (k, t) = (at / batch.threads.len(), at % batch.threads.len());
            runs.sort_by(|a, b| a.rate().total_cmp(&b.rate()));
            let best = runs[runs.len() - 1].rate();
            let wall = runs.iter().map(|run| run.steps as f64 / run.wall).fold(0.0, f64::max);
            let (series, variant, setup) = &batch.setups[k];
            let median = runs[runs.len() / 2].clone();
            let figures = Figures::new(setup, &problems[k], median, flops[k], peaks[t]);
            let row = Row { series: *series, variant, size: batch.size, runs: batch.runs, best, wall, figures };
            (self.say)(&summary::line(&row));
            rows.push(row);
        }
        Ok(())
    }
}

/// A rectangle of as many squares as a mesh has cells, as near to a square as can be.
fn as_many_squares(mesh: &Path) -> Result<[usize; 2]> {
    let cells = read_mesh(mesh)?.cells.len() as f64;
    let side = cells.sqrt().round().max(1.0);
    Ok([side as usize, (cells / side).round().max(1.0) as usize])
}

/// A peak is the most that was seen: all rows of a number of threads get the highest of their batches.
fn highest_peaks(rows: &mut [Row]) {
    for threads in [1, 2] {
        let of = |row: &&mut Row| row.figures.measured.threads == threads;
        let highest = |peaks: Peaks, row: &mut Row| Peaks {
            fma: peaks.fma.max(row.figures.peaks.fma),
            triad: peaks.triad.max(row.figures.peaks.triad),
        };
        let all = rows.iter_mut().filter(of).fold(Peaks { fma: 0.0, triad: 0.0 }, highest);
        rows.iter_mut().filter(of).for_each(|row| row.figures.peaks = all);
    }
}

/// Rates over size, a line for each series and degree.
fn rates(rows: &[Row]) -> Chart {
    let mut lines: Vec<Line> = Vec::new();
    for row in rows.iter().filter(|row| row.variant.is_empty() && row.figures.measured.threads == 1) {
        let (name, _, _, marker) = SERIES[row.series];
        let degree = row.figures.setup.degree;
        let (name, at) = (format!("{name} S{degree}"), (row.figures.measured.dofs as f64, row.figures.measured.rate()));
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.points.push(at),
            None => lines.push(Line { name, colour: degree, marker, stroke: Stroke::Full, points: vec![at] }),
        }
    }
    Chart {
        title: "Speed of the step, one thread".to_owned(),
        x: "degrees of freedom".to_owned(),
        y: "DoF-updates/s".to_owned(),
        scales: [Scale::Log; 2],
        lines,
    }
}

/// Flops per second over flops per byte, under the roofs of the machine; the state lies in memory.
fn roofline(rows: &[Row]) -> Chart {
    let shown = |row: &&Row| row.variant.is_empty() && row.figures.measured.threads == 1 && row.size == SIZES[1];
    let rows: Vec<&Row> = rows.iter().filter(shown).collect();
    let fma = rows.iter().map(|row| row.figures.peak()).fold(0.0, f64::max);
    let triad = rows.iter().map(|row| row.figures.triad()).fold(0.0, f64::max);
    // From a tenth of a flop a byte, through the ridge, to beyond every kernel.
    let roof = vec![(0.1, 0.1 * triad), (fma / triad, fma), (1000.0, fma)];
    let mut lines = Vec::new();
    if !rows.is_empty() {
        let name = "triad, FMA (measured)".to_owned();
        lines.push(Line { name, colour: 0, marker: Marker::Bare, stroke: Stroke::Full, points: roof });
    }
    for row in rows {
        let (name, _, _, marker) = SERIES[row.series];
        let degree = row.figures.setup.degree;
        let at = (row.figures.flops.total() / row.figures.bytes, row.figures.flop_rate());
        lines.push(Line {
            name: format!("{name} S{degree}"),
            colour: degree,
            marker,
            stroke: Stroke::Full,
            points: vec![at],
        });
    }
    Chart {
        title: "Roofline of one thread, 9e5 DoF".to_owned(),
        x: "flops per byte (counted flops; state, traces and operators from memory)".to_owned(),
        y: "flops/s".to_owned(),
        scales: [Scale::Log; 2],
        lines,
    }
}
