//! The criteria of hard cases.

use super::run::Finished;
use super::{Verdict, exact};
use dgmpm::parts::quantity;

/// A criterion that a run is checked by.
pub struct Check {
    /// The word by which a case names it as open.
    pub kind: &'static str,
    /// The check.
    pub of: Box<dyn Fn(&Finished) -> Verdict + Send>,
}

/// Of the sizes of a list the largest.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most: f64, x| if x.is_nan() { f64::NAN } else { most.max(x.abs()) })
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn check(kind: &'static str, of: impl Fn(&Finished) -> Verdict + Send + 'static) -> Check {
    Check { kind, of: Box::new(of) }
}

fn verdict(criterion: impl Into<String>, figure: String, met: bool) -> Verdict {
    Verdict { criterion: criterion.into(), figure, met }
}

/// It runs to its end.
pub fn ends() -> Check {
    check("end", |run| {
        let figure = match run.code {
            Some(0) => "done".to_owned(),
            _ => {
                let error = run.message.lines().find(|line| line.starts_with("error")).unwrap_or_default();
                format!("exit code {:?} at {:.3e} s, {error}", run.code.unwrap_or(-1), run.number(&["end_time"]))
            }
        };
        verdict("reaches its end", figure, run.code == Some(0))
    })
}

/// J > 0 in all states.
pub fn sound() -> Check {
    check("J", |run| {
        let least = run.number(&["min_j"]);
        let rescued = run.number(&["treated_cells", "steps_with_rescue"]);
        let rescued = if rescued > 0.0 { format!("; cells rescued in {rescued} steps") } else { String::new() };
        verdict("J > 0 everywhere", format!("smallest J {least:.3}{rescued}"), least > 0.0)
    })
}

/// The deformed shape agrees with F.
pub fn shape() -> Check {
    check("shape", |run| {
        let drift = run.number(&["max_drift"]);
        // A fifth of its length is what the shape of a cell may be off by before cells are seen to be torn apart.
        verdict(
            "shape and F agree: grad u - (F - 1) below .2 in each cell at the end",
            format!("{drift:.3}"),
            drift < 0.2,
        )
    })
}

/// Total energy, with what laws have dissipated, against the start and the work: at most this share above.
const ENERGY: f64 = 1e-6;

/// Energy never above the start plus work.
pub fn energy() -> Check {
    check("energy", |run| {
        let table = run.ledger();
        let mut energy = table.column("total_energy");
        if table.has("material_dissipation") {
            energy.iter_mut().zip(table.column("material_dissipation")).for_each(|(e, d)| *e += d);
        }
        let work = table.column("boundary_work");
        let scale = largest(work.iter().copied()).max(energy[0]);
        let above = energy.iter().zip(work).map(|(e, w)| (e - w - energy[0]) / scale);
        let ends = run.number(&["total_energy_ratio"]);
        // The state of the last step has no row where the run stops between two rows.
        let most = above.fold(ends - 1.0, f64::max);
        verdict(
            "energy never above start and work by more than 1e-6",
            format!("at most {most:.1e} above; {ends:.4} of it at the end"),
            most <= ENERGY,
        )
    })
}

/// The watch over the energy has nothing to say.
pub fn watch() -> Check {
    check("watch", |run| {
        let share = run.number(&["energy_made", "share"]);
        verdict("less than .1 % of energy made out of nothing", format!("{share:.1e}"), share < 1e-3)
    })
}

/// Energy never rises above its lowest value so far.
pub fn monotone() -> Check {
    check("monotone", |run| {
        let share = run.number(&["energy_made", "share"]);
        verdict("energy never rises by more than 1e-6", format!("by {share:.1e}"), share <= ENERGY)
    })
}

/// Energy grows by less than a growth of the state by `growth` a step lets expect.
pub fn budget(growth: f64) -> Check {
    check("budget", move |run| {
        let (share, steps) = (run.number(&["energy_made", "share"]), run.number(&["steps"]));
        let budget = (2.0 * growth * steps).exp_m1();
        let figure = format!("{share:.1e} in {steps} steps, budget {budget:.1e}");
        verdict("energy rises by less than the growth that is printed before the run", figure, share <= budget)
    })
}

/// Rows of a line, by time: t, places and values.
fn by_time(run: &Finished, line: &str, field: &str) -> Vec<(f64, Vec<[f64; 2]>)> {
    let table = run.line(line);
    let mut times: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for ((t, x), value) in table.column("t").into_iter().zip(table.column("x")).zip(table.column(field)) {
        match times.last_mut() {
            Some((last, rows)) if *last == t => rows.push([x, value]),
            _ => times.push((t, vec![[x, value]])),
        }
    }
    times
}

/// A plateau behind a front that goes to the right from x = `from` at t = 0.
#[derive(Clone, Copy)]
pub struct Plateau {
    /// Name of the line and of the field.
    pub of: [&'static str; 2],
    /// Where the front starts, m.
    pub from: f64,
    /// Its exact speed, m/s.
    pub speed: f64,
    /// Values behind and before it.
    pub values: [f64; 2],
    /// Length of a cell, m.
    pub cell: f64,
}

impl Plateau {
    /// That of neo-Hookean steel which hits a wall at v, by cells of so many m.
    pub fn impact(v: f64, cell: f64) -> Self {
        let shock = exact::impact(v);
        Self { of: ["bottom", "cauchy_stress_11"], from: 0.0, speed: shock.speed, values: [shock.stress, 0.0], cell }
    }

    /// By time and x: the value, 1 behind and 0 before the front.
    fn relative(&self, run: &Finished) -> Vec<(f64, Vec<[f64; 2]>)> {
        let [behind, before] = self.values;
        let mut times = by_time(run, self.of[0], self.of[1]);
        times.iter_mut().flat_map(|(_, rows)| rows).for_each(|row| row[1] = (row[1] - before) / (behind - before));
        times
    }

    /// The value is within .5 % up to so many cells behind the exact front; the cell at the start is left out.
    pub fn exact(self, kind: &'static str, cells: f64) -> Check {
        check(kind, move |run| {
            let within = |(t, rows): &(f64, Vec<[f64; 2]>)| {
                let ends = [self.from + self.cell, self.from + self.speed * t - cells * self.cell];
                largest(rows.iter().filter(|[x, _]| ends[0] <= *x && *x <= ends[1]).map(|[_, value]| value - 1.0))
            };
            let most = largest(self.relative(run).iter().map(within));
            verdict(
                format!("{} of the exact shock within .5 % up to {cells} cells behind it", self.of[1]),
                format!("off by {}", percent(most)),
                most <= 5e-3,
            )
        })
    }

    /// 10 to 90 % of the jump within three cells.
    pub fn narrow(self) -> Check {
        check("width", move |run| {
            let width = |(_, rows): &(f64, Vec<[f64; 2]>)| quantity::width(rows).0 / self.cell;
            let most = largest(self.relative(run).iter().map(width));
            verdict("front (10 to 90 %) at most 3 cells wide", format!("{most:.2} cells"), most <= 3.0)
        })
    }
}

/// A field of a line stays in a range, but for .5 % of its length.
pub fn overshoot(of: [&'static str; 2], range: [f64; 2]) -> Check {
    check("overshoot", move |run| {
        let most = quantity::overshoot(run.line(of[0]).column(of[1]).into_iter(), range);
        verdict(format!("{} overshoots by less than .5 %", of[1]), percent(most), most < 5e-3)
    })
}

/// Few cells are marked by the limiter.
pub fn marked() -> Check {
    check("marked", |run| {
        let of = |key| run.number(&["treated_cells", "marked", key]);
        let (mean, most) = (of("mean"), of("most"));
        verdict(
            "at most 12 % of the cells marked in the mean over the run",
            format!("{}, at most {} in a step", percent(mean), percent(most)),
            mean <= 0.12,
        )
    })
}

/// The relative L1 error of F11 along a line from a profile of |x - 1.5 m| and t.
pub fn profile(line: &'static str, exact: impl Fn(f64, f64) -> f64 + Send + 'static) -> Check {
    check("profile", move |run| {
        let (mut error, mut size) = (0.0, 0.0);
        for (t, rows) in by_time(run, line, "deformation_11") {
            for [x, f] in rows {
                let f_exact = exact((x - 1.5).abs(), t);
                error += (f - f_exact).abs();
                size += (f_exact - 1.0).abs();
            }
        }
        verdict("F11 off by at most 5 % of F11 - 1 (L1)", percent(error / size), error <= 0.05 * size)
    })
}

/// F11 = 1 - 1000 t, and the run stops by loss of hyperbolicity at this F11, within .5 %.
pub fn collapses(at: f64) -> Check {
    check("collapse", move |run| {
        let stretch = 1.0 - 1e3 * run.number(&["loss", "time"]);
        let right = run.code == Some(3) && run.message.contains("loss of hyperbolicity");
        verdict(
            format!("stops by loss of hyperbolicity at F11 = {at} within .5 %, exit code 3"),
            format!("F11 = {stretch:.4}, exit code {:?}", run.code.unwrap_or(-1)),
            right && (stretch / at - 1.0).abs() <= 5e-3,
        )
    })
}

/// The state that a stopped run has kept is a start for another run, half of the way to the stop.
pub fn goes_on() -> Check {
    check("goes on", |run| {
        let of = |key| run.number(&["loss", key]);
        let code = run.goes_on(0.5 * (of("time") + of("kept_time")));
        verdict("a run goes on from the saved state", format!("exit code {:?}", code.unwrap_or(-1)), code == Some(0))
    })
}

/// The step is refused.
pub fn refused() -> Check {
    check("refused", |run| {
        let right = run.code == Some(2) && run.message.contains("stability limit");
        verdict("refused with exit code 2", format!("exit code {:?}", run.code.unwrap_or(-1)), right)
    })
}

/// Angular momentum stays.
pub fn turns() -> Check {
    check("turns", |run| {
        let moment = run.ledger().column("angular_momentum");
        let most = largest(moment.iter().map(|l| l / moment[0] - 1.0));
        verdict("angular momentum kept to .1 %", format!("{most:.1e}"), most <= 1e-3)
    })
}

/// A share of the energy is left at the end.
pub fn keeps(share: f64) -> Check {
    check("keeps", move |run| {
        let ratio = run.number(&["total_energy_ratio"]);
        verdict(format!("keeps {share} of its energy"), format!("{ratio:.4}"), ratio >= share)
    })
}

/// Momentum of a free body at rest in the mean, against a momentum, kg/s.
pub fn no_drift(scale: f64) -> Check {
    check("drift", move |run| {
        let table = run.ledger();
        let most = largest(["momentum_1", "momentum_2"].iter().flat_map(|name| table.column(name))) / scale;
        verdict("momentum stays within 1e-10", format!("{most:.1e}"), most <= 1e-10)
    })
}

/// The second crossing of zero of the displacement at the tip, against a period, s.
pub fn period(thin: f64) -> Check {
    check("period", move |run| {
        let table = run.line("tip");
        let rows = table.column("t").into_iter().zip(table.column("displacement_2")).zip(table.column("s"));
        let swing: Vec<_> = rows.filter(|(_, s)| *s == 0.0).map(|(row, _)| row).collect();
        let crossings = swing.windows(2).filter(|pair| pair[0].1 * pair[1].1 < 0.0);
        let time = |pair: &[(f64, f64)]| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1);
        let found = crossings.map(time).nth(1).unwrap_or(f64::NAN);
        verdict(
            format!("period above {thin} s by 0 to 3 %"),
            format!("{found:.5} s, {:+.2} %", 100.0 * (found / thin - 1.0)),
            (1.0..=1.03).contains(&(found / thin)),
        )
    })
}

/// Kinetic energy of the noise at the end is at most that after the first step.
pub fn decays() -> Check {
    check("noise", |run| {
        let kinetic = run.ledger().column("kinetic_energy");
        let ratio = kinetic[kinetic.len() - 1] / kinetic[1];
        let figure = format!("times {:.2e} in {} steps", ratio.sqrt(), kinetic.len() - 2);
        verdict("velocity of the noise does not grow after the first step", figure, ratio <= 1.0)
    })
}

/// The length of a bar along its axis at the end, and the largest plastic strain there: no criterion of its own but that it is a number.
pub fn length() -> Check {
    check("length", |run| {
        let axis = run.line("axis");
        let (x, u, p) = (axis.column("x"), axis.column("displacement_1"), axis.column("plastic_strain"));
        let [first, last] = [0, x.len().saturating_sub(1)];
        let length = if x.is_empty() { f64::NAN } else { x[last] + u[last] - x[first] };
        verdict(
            "has a final length",
            format!("{length:.5e} m; plastic strain on the axis {:.2}", largest(p)),
            length.is_finite(),
        )
    })
}
