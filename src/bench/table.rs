//! A measurement as one line and as a table.

use super::{Flops, Measured, Peaks, Setup, Subject, traffic};
use crate::step::phase::{NAMES, PHASES};

/// A measurement with what it is set against.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// What was measured.
    pub setup: Setup,
    /// What came out.
    pub measured: Measured,
    /// Flops of a cell in a step.
    pub flops: Flops,
    /// Bytes of a cell in a step, see `bench::traffic`.
    pub bytes: f64,
    /// What the machine can do on as many threads.
    pub peaks: Peaks,
}

impl Figures {
    /// Puts them together.
    pub fn new(setup: &Setup, subject: &Subject, measured: Measured, flops: Flops, peaks: Peaks) -> Self {
        Self { setup: setup.clone(), measured, flops, bytes: traffic(subject), peaks }
    }

    /// Flops per CPU second.
    pub fn flop_rate(&self) -> f64 {
        self.flops.total() * self.measured.cell_steps()
    }

    /// Peak of fused multiplications of one thread, flops per second.
    pub fn peak(&self) -> f64 {
        self.peaks.fma / self.measured.threads as f64
    }

    /// Triad of one thread, bytes per second.
    pub fn triad(&self) -> f64 {
        self.peaks.triad / self.measured.threads as f64
    }

    /// Bytes per CPU second by [`traffic`].
    pub fn byte_rate(&self) -> f64 {
        self.bytes * self.measured.cell_steps()
    }

    /// Flops per second of a phase; 0 where it does not occur.
    pub fn phase_rate(&self, phase: usize) -> f64 {
        let seconds = self.measured.phases.seconds[phase];
        let flops = self.flops.of(phase) * (self.measured.cells * self.measured.steps) as f64;
        if seconds > 0.0 { flops / seconds } else { 0.0 }
    }

    /// Part of the seconds of all phases.
    pub fn phase_share(&self, phase: usize) -> f64 {
        let seconds = &self.measured.phases.seconds;
        seconds[phase] / seconds.iter().sum::<f64>()
    }
}

/// `method degree dofs steps cpu DoF-updates/s/core=.. L2err=..`.
pub fn oneline(setup: &Setup, m: &Measured) -> String {
    format!(
        "{} {} {} {} {:.6} DoF-updates/s/core={:.4e} L2err={:.6e}",
        setup.method.name(),
        setup.degree,
        m.dofs,
        m.steps,
        m.cpu,
        m.rate(),
        m.error
    )
}

/// Lines of the table of one measurement.
pub fn report(figures: &Figures) -> Vec<String> {
    let Figures { setup, measured: m, flops, bytes, .. } = figures;
    let percent = |x: f64, of: f64| format!("{:.0} %", 100.0 * x / of);
    let giga = |x: f64| format!("{:.2}", 1e-9 * x);
    let row = |name: &str, value: String| format!("  {name:<26} {value}");
    let layout = setup.layout.as_ref().map_or(String::new(), |layout| format!(", {layout}"));
    let mut lines = vec![
        format!("{} S{}{layout}, {}, {}", setup.method.name(), setup.degree, setup.law, setup.kernel.name()),
        row("cells, DoFs, points", format!("{}, {}, {}", m.cells, m.dofs, m.points)),
        row("threads, steps, stages", format!("{}, {}, {}", m.threads, m.steps, m.stages)),
        row("CPU s, wall s", format!("{:.4}, {:.4}", m.cpu, m.wall)),
        row("DoF-updates/s/core", format!("{:.3e}", m.rate())),
        row("cell-steps/s/core", format!("{:.3e}", m.cell_steps())),
        row("particle-steps/s/core", format!("{:.3e}", m.particle_steps())),
        row("flops, bytes a cell-step", format!("{:.0}, {bytes:.0}", flops.total())),
        row(
            "GFLOP/s/core, FMA peak",
            format!("{}, {}: {}", giga(figures.flop_rate()), giga(figures.peak()), {
                percent(figures.flop_rate(), figures.peak())
            }),
        ),
        row(
            "GB/s/core, triad",
            format!("{}, {}: {}", giga(figures.byte_rate()), giga(figures.triad()), {
                percent(figures.byte_rate(), figures.triad())
            }),
        ),
        row("MiB", format!("{:.1}", m.bytes as f64 / f64::from(1 << 20))),
        row("L2 error", format!("{:.4e}", m.error)),
        format!(
            "  {:<26} {:>9} {:>7} {:>12} {:>9} {:>6}",
            "phase (quietest step)", "s", "share", "flops a cell", "GFLOP/s", "peak"
        ),
    ];
    for phase in (0..PHASES).filter(|&phase| m.phases.seconds[phase] > 0.0) {
        let (seconds, rate) = (m.phases.seconds[phase], figures.phase_rate(phase));
        let share = percent(figures.phase_share(phase), 1.0);
        let (flops, part) = (flops.of(phase), percent(rate, figures.peak()));
        let name = NAMES[phase];
        lines.push(format!("  {name:<26} {seconds:>9.4} {share:>7} {flops:>12.0} {:>9} {part:>6}", giga(rate)));
    }
    lines
}
