//! What the effects that a scene asks for have cost its run: one line each, and none for what is not on.

use super::Problem;
use crate::format::{Row, count, row};
use crate::operators::Neighbour;
use crate::run::Report;
use crate::step::{Part, Phase};
use serde_json::{Value, json};

/// An effect that a run had.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// The kind of thing and its name in scenes, such as "condition wall".
    pub name: String,
    /// Where it acts: a group, cells, points.
    pub place: String,
    /// Seconds on all processors.
    pub seconds: f64,
    /// Whether they are a share, by the number of points, of a clock that it has in common with others.
    pub by_points: bool,
    /// Bytes that are held for it.
    pub bytes: usize,
}

impl Effect {
    fn new(name: impl Into<String>, place: String, seconds: f64) -> Self {
        Self { name: name.into(), place, seconds, by_points: false, bytes: 0 }
    }

    fn bytes(self, bytes: usize) -> Self {
        Self { bytes, ..self }
    }
}

/// All effects of a run: conditions (a free side is none), sources, the control of the curl, limiter, angular momentum that is kept,
/// springs in the faces, rescue, balance, changes of grid, outputs, quantities.
pub fn effects(problem: &Problem, report: &Report) -> Vec<Effect> {
    let mut out = conditions(problem, report);
    out.extend(sources(problem, report));
    out.extend(of_the_step(problem, report));
    out.extend(observers(problem, report));
    out
}

/// The conditions, which have one clock in common, with the fluxes between materials.
fn conditions(Problem { scene, body, scheme, .. }: &Problem, report: &Report) -> Vec<Effect> {
    let m = scheme.operators.line.m;
    let (mut points, mut all) = (vec![0; body.mesh.edge_groups.len()], 0);
    for neighbour in scheme.operators.blocks.neighbours.iter().flatten().flatten() {
        match neighbour {
            Neighbour::Boundary(group) => points[*group] += m,
            Neighbour::Interface(..) => {}
            Neighbour::Cell(_) | Neighbour::Padding => continue,
        }
        all += m;
    }
    let seconds = report.phases.parts[Part::Conditions as usize];
    let with_memory = scheme.points_with_memory();
    let mut out = Vec::new();
    for boundary in scene.boundaries.iter().filter(|boundary| boundary.condition.name() != "free") {
        let Some(group) = body.mesh.edge_groups.iter().position(|name| *name == boundary.group) else { continue };
        if points[group] > 0 {
            let numbers: usize = with_memory.iter().filter(|p| p.group == group).map(|p| p.numbers.len()).sum();
            let place = format!("{}, {}", boundary.group, count(points[group], "point"));
            let name = format!("condition {}", boundary.condition.name());
            let own = Effect::new(name, place, seconds * points[group] as f64 / all as f64);
            out.push(Effect { by_points: points[group] < all, ..own }.bytes(numbers * size_of::<f64>()));
        }
    }
    out
}

/// The sources, which have one clock in common.
fn sources(Problem { scene, body, .. }: &Problem, report: &Report) -> Vec<Effect> {
    let cells = |group: Option<&str>| match group.and_then(|name| body.mesh.groups.iter().position(|own| own == name)) {
        Some(group) => body.mesh.cell_group.iter().filter(|own| **own == group).count(),
        None => body.mesh.cells.len(),
    };
    let all: usize = scene.sources.iter().map(|source| cells(source.group.as_deref())).sum();
    let seconds = report.phases.parts[Part::Sources as usize];
    let of = |source: &crate::scene::Source| {
        let own = cells(source.group.as_deref());
        let place = format!(
            "{}{}",
            source.group.as_ref().map_or(String::new(), |name| format!("{name}, ")),
            count(own, "cell")
        );
        let effect = Effect::new(format!("source {}", source.source.name()), place, seconds * own as f64 / all as f64);
        Effect { by_points: own < all, ..effect }
    };
    scene.sources.iter().map(of).collect()
}

/// What changes or meters a step.
fn of_the_step(Problem { scene, body, scheme, .. }: &Problem, report: &Report) -> Vec<Effect> {
    let (cells, phase) = (count(body.mesh.cells.len(), "cell"), |phase: Phase| report.phases.seconds[phase as usize]);
    let [at_faces, in_cells] = [Part::FaceBalance, Part::CellBalance].map(|part| report.phases.parts[part as usize]);
    let mut out = Vec::new();
    let mut add = |is_on: bool, name: String, seconds: f64, bytes: usize| {
        out.extend(is_on.then(|| Effect::new(name, cells.clone(), seconds).bytes(bytes)));
    };
    let matrices = scheme.operators.curl_free.as_ref().map_or(0, |curl_free| curl_free.bytes());
    let curl = (phase(Phase::CurlFree) - in_cells).max(0.0);
    add(scheme.curl.is_some(), format!("curl control {}", scene.curl.name()), curl, matrices);
    let limits = !scheme.corrections.is_empty();
    let turning = report.phases.parts[Part::AngularMomentum as usize];
    let limiting = (phase(Phase::Corrections) - turning).max(0.0);
    add(limits, format!("limiter {}", scene.limiter.name()), limiting, report.held.corrections);
    add(scheme.keeps_angular_momentum(), "angular momentum".to_owned(), turning, report.held.turning);
    add(scheme.rescue.is_some(), "rescue".to_owned(), report.rescue, report.held.rescue);
    add(report.balance.is_some(), "balance of energy".to_owned(), at_faces + in_cells, report.held.balance);
    if scheme.has_springs() {
        let seconds = report.phases.parts[Part::Springs as usize];
        let place = format!("{}; and a part of the flux", count(scheme.cells_with_springs(), "cell"));
        let own = Effect::new("springs", place, seconds);
        out.push(own.bytes(report.held.springs));
    }
    let (seconds, times) = report.regrids;
    if times > 0 {
        out.push(Effect::new("regrid", count(times, "time"), seconds));
    }
    out
}

/// Outputs and quantities: [`Problem::record`] has the observers of the scene first, and then that of the quantities.
fn observers(Problem { scene, .. }: &Problem, report: &Report) -> Vec<Effect> {
    let named = scene.outputs.iter().map(|output| (output.what.name(), Some(&output.name)));
    let always = super::outputs::always(scene).map(|entry| (entry.name, None));
    let of = |((kind, name), &(seconds, times)): ((&'static str, Option<&String>), &(f64, usize))| {
        let name = name.filter(|name| *name != kind).map_or(String::new(), |name| format!("{name}, "));
        let bytes = if kind == "force" { report.held.forces } else { 0 };
        Effect::new(format!("output {kind}"), format!("{name}{}", count(times, "time")), seconds).bytes(bytes)
    };
    let mut out: Vec<Effect> = named.chain(always).zip(&report.observed).map(of).collect();
    // The observer of quantities comes behind those of outputs.
    if let (false, Some(&(seconds, times))) = (scene.quantities.is_empty(), report.observed.get(out.len())) {
        let what = if scene.quantities.len() == 1 { "quantity" } else { "quantities" };
        let place = format!("{} {what}, {}", scene.quantities.len(), count(times, "time"));
        out.push(Effect::new("quantities", place, seconds));
    }
    out
}

/// The table at the end of a run: seconds, share of the run's seconds on all processors, memory, where. Nothing where a run has no
/// effect or no time.
pub fn rows(all: &[Effect], report: &Report) -> Vec<Row> {
    if all.is_empty() || report.cpu <= 0.0 {
        return vec![];
    }
    let shared =
        if all.iter().any(|effect| effect.by_points) { " (~: its share of a common clock, by points)" } else { "" };
    let of = |effect: &Effect| {
        let mark = if effect.by_points { "~" } else { " " };
        let share = 100.0 * effect.seconds / report.cpu;
        let memory = if effect.bytes > 0 { format!("{:.1} KiB", effect.bytes as f64 / 1024.0) } else { "-".to_owned() };
        let Effect { name, place, seconds, .. } = effect;
        row(format!("  {name}"), format!("{seconds:8.3} s {share:5.1} %{mark} {memory:>12}  {place}"))
    };
    let head = row("effects", format!("seconds, share of the run, memory, where{shared}"));
    std::iter::once(head).chain(all.iter().map(of)).collect()
}

/// For `summary.json`.
pub fn json(all: &[Effect], report: &Report) -> Value {
    let of = |effect: &Effect| {
        let share = if report.cpu > 0.0 { effect.seconds / report.cpu } else { 0.0 };
        json!({
            "effect": effect.name, "where": effect.place, "seconds": effect.seconds, "share": share,
            "bytes": effect.bytes, "by_points": effect.by_points,
        })
    };
    all.iter().map(of).collect()
}
