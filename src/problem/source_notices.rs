//! Words on sources that do nothing, or that the cells and steps of a run do not resolve.

use super::{Body, Problem};
use crate::mesh::map;
use crate::registry::Values;
use crate::scene::{Scene, Source};
use crate::step::Scheme;

/// A pulse of pressure needs so many cells along its radius: with one (S2) its forces add up to a tenth of their sizes in place of 0, with
/// two to a hundredth.
const CELLS: f64 = 2.0;
/// And so many steps.
const STEPS: f64 = 8.0;

/// The notices on the sources of a run, whose first step is `dt`, s.
pub(super) fn of_sources(problem: &Problem, dt: f64) -> Vec<String> {
    let Problem { scene, body, scheme, .. } = problem;
    let of = |(number, source): (usize, &Source)| match source.source.name() {
        "pressure-pulse" => of_pulse(&format!("source.{number}"), source, (scene, body, scheme), dt),
        "sponge" => is_dry(source, body, scheme)
            .then(|| format!("source.{number} does nothing: its `region` is 0 or less at all nodes of its cells")),
        _ => None,
    };
    scene.sources.iter().enumerate().filter_map(of).collect()
}

/// The cells that a source acts on.
fn cells<'a>(source: &'a Source, body: &'a Body) -> impl Iterator<Item = usize> + 'a {
    let mesh = &body.mesh;
    let is_own =
        move |cell: &usize| source.group.as_ref().is_none_or(|group| *group == mesh.groups[mesh.cell_group[*cell]]);
    (0..mesh.cells.len()).filter(is_own)
}

fn is_dry(source: &Source, body: &Body, scheme: &Scheme) -> bool {
    let [region] = source.source.values.expressions("region") else { return false };
    // One that changes may act later; one that is no number ends the run with its own message.
    if region.depends_on_time() {
        return false;
    }
    let nodes = scheme.operators.line.nodes();
    let is_wet = |cell: usize| {
        let at = |xi: &[f64; 2]| region.eval(map::position(&body.mesh.map(cell), *xi), 0.0);
        nodes.iter().map(at).any(|share| share.is_nan() || share > 0.0)
    };
    !cells(source, body).any(is_wet)
}

fn of_pulse(key: &str, source: &Source, (scene, body, scheme): (&Scene, &Body, &Scheme), dt: f64) -> Option<String> {
    let of: &Values = &source.source.values;
    let (centre, radius, start, duration) =
        (of.vector("centre"), of.number("radius"), of.number("start"), of.number("duration"));
    if start >= scene.end || start + duration <= scene.start {
        return Some(format!(
            "{key} does nothing: the pulse acts from {start:e} s to {:e} s, and the run is from {:e} s to {:e} s",
            start + duration,
            scene.start,
            scene.end
        ));
    }
    let nodes = scheme.operators.line.nodes();
    let is_hit = |cell: &usize| {
        let map = body.mesh.map(*cell);
        let is_near = |xi: &[f64; 2]| {
            let x = map::position(&map, *xi);
            (x[0] - centre[0]).hypot(x[1] - centre[1]) < radius
        };
        map::parent(&map, centre).is_some_and(|xi| xi.iter().all(|xi| (0.0..=1.0).contains(xi)))
            || nodes.iter().any(is_near)
    };
    let hit: Vec<usize> = cells(source, body).filter(is_hit).collect();
    let Some(&first) = hit.first() else {
        return Some(format!("{key} does nothing: the disc of the pulse lies outside of its cells"));
    };
    let h = hit.iter().map(|&cell| map::h_e(&body.mesh.map(cell))).fold(0.0, f64::max);
    if radius < CELLS * h {
        return Some(format!(
            "the cells do not resolve {key}: the pulse has a radius of {radius:e} m, and cells there have {h:.3e} m; with less than {CELLS} cells along \
             the radius its forces do not add up to 0"
        ));
    }
    if duration < STEPS * dt {
        return Some(format!(
            "the steps do not resolve {key}: the pulse lasts {duration:e} s, and a step is {dt:.3e} s"
        ));
    }
    let (given, own) = (of.number("density"), scheme.laws[body.material[first]].density());
    ((given - own).abs() > 1e-6 * own).then(|| {
        format!("the density of {key} is {given:e} kg/m^3, and that of the cells there {own:e}: its accelerations are those of another material")
    })
}
