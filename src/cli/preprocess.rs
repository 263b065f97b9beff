//! `dgmpm preprocess`: all matrices, and what the run will cost.

use super::pipeline::{self, Body, Files, Store};
use super::print::{mebibytes, note, row, say, seconds, table, warn};
use super::{SceneArgs, certificates, keep, notices};
use crate::error::{Error, Result};
use crate::io::operators_file;
use crate::lane::Kernel;
use crate::mesh::Mesh;
use crate::operators::{Certificate, Pool};
use crate::run::{Kept, Settings};
use crate::scene::Scene;
use crate::state::State;
use crate::step::{Loss, Motion, Scheme, Survey, cfl};
use std::path::PathBuf;
use std::time::Instant;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: Files,
    /// Where to write; matrices that are there already are reused if they belong to the same input
    #[arg(long, value_name = "FILE", default_value = "operators.h5")]
    out: PathBuf,
    /// Build again, and replace the file whatever it is
    #[arg(long)]
    force: bool,
    /// Refuse cells whose points are beyond the limits ([cloud] face_lebesgue, condition), in place of virtual points
    #[arg(long)]
    strict: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let scene = Scene::load(&args.scene.scene, &args.scene.sets)?;
    keep(&args.out, args.force || operators_file::may_replace(&args.out))?;
    let settings = scene.settings()?;
    let body = args.files.body(&scene)?;
    if args.strict {
        certificates::strict(&scene, &body)?;
    }
    let look = if args.force { vec![] } else { vec![args.out.as_path()] };
    let (operators, origin) = pipeline::operators(&scene, &body, &Store { look: &look, write: &args.out })?;
    let scheme = pipeline::scheme(&scene, &body, operators, Kernel::widest());
    let state = scene.initial_state(&body.mesh, &scheme)?;
    report(&scene, &body, &scheme, &state, settings)?;
    say(origin);
    Ok(())
}

/// Prints classes, memory, the smallest step and the worst cells, and the cost; answers the certificates of the cells.
pub fn report(
    scene: &Scene,
    body: &Body,
    scheme: &Scheme,
    state: &State,
    settings: Settings,
) -> Result<Vec<Certificate>> {
    let mut certificates = body.certificates(scene)?;
    let operators = &scheme.operators;
    let h = extreme(&body.mesh, &certificates, |c| -c.h);
    let lebesgue = extreme(&body.mesh, &certificates, |c| c.lebesgue);
    let cost = cost(scheme, state, settings, -h.0).map_err(|loss| sick(scene, body, scheme, &loss))?;
    for (certificate, &(block, lane)) in certificates.iter_mut().zip(&operators.blocks.slot) {
        certificate.dt = settings.courant * certificate.h / cost.survey.speed[block].fastest.0[lane];
    }
    let states = size_of_val(&state.u[..]) + size_of_val(&state.internal[..]) + Kept::bytes(state);
    let memory = operators.bytes() + cost.work + states;
    let mut rows = vec![
        row("method", format!("{} S{}T{}", scene.scheme.method.name(), scene.scheme.degree, scene.scheme.time_degree)),
        row(
            "cells, points, dofs",
            format!("{}, {}, {}", body.mesh.cells.len(), body.cloud.len(), crate::run::dofs(scheme)),
        ),
    ];
    if let Some(points) = &operators.points {
        rows.push(row("point matrices", classes(&points.pool)));
    }
    if let Some(curl_free) = &operators.curl_free {
        rows.push(row("curl-free projections", classes(&curl_free.pool)));
    }
    rows.push(row("memory", mebibytes(memory)));
    rows.push(row("first dt", format!("{:.4e} s, set by cell {}", cost.dt, h.1)));
    rows.push(row("largest face Lebesgue constant", format!("{:.2} in cell {}", lebesgue.0, lebesgue.1)));
    rows.extend(certificates::rows(&body.mesh, &certificates));
    rows.push(row("estimate", format!("{:.0} steps, {}", cost.steps, seconds(cost.seconds))));
    table(&rows);
    certificates::word(scene, body).into_iter().for_each(say);
    let first = (cost.steps, cost.dt);
    notices::of_run(scene, body, (scheme, state), &cost.survey, first).iter().for_each(note);
    certificates::memory(body).into_iter().for_each(say);
    certificates::warning(scene, body, &certificates).iter().for_each(warn);
    if let Some(growth) = cfl::growth(&scheme.method, scene.scheme.degree) {
        note(format!(
            "ADER of degree {} grows weakly at any dt: {growth:.0e} a step, a factor of {:.3} over this run",
            scene.scheme.degree,
            (growth * cost.steps).exp()
        ));
    }
    Ok(certificates)
}

/// The largest value of a figure, and the number of its cell.
fn extreme(mesh: &Mesh, certificates: &[Certificate], figure: impl Fn(&Certificate) -> f64) -> (f64, u64) {
    let values = certificates.iter().map(figure).enumerate();
    let (cell, value) = values.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    (value, mesh.number(cell))
}

fn classes<S, O>(pool: &Pool<S, O>) -> String {
    format!("{} shared by congruent cells, {} blocks with their own", pool.shared.len(), pool.own.len())
}

/// The initial state is healthy at the nodes, and not at the points or faces that its polynomial is sampled at.
fn sick(scene: &Scene, body: &Body, scheme: &Scheme, loss: &Loss) -> Error {
    let what = format!("the initial state is lost: {}", pipeline::describe(loss, scheme, &body.mesh));
    match scene.initial.snapshot {
        Some(_) => scene.error("initial.snapshot", what, "give the snapshot of an earlier step"),
        None => {
            let remedy = "give a deformation that is smooth at the size of a cell, or a finer mesh";
            scene.error("initial.deformation", what, remedy)
        }
    }
}

struct Cost {
    survey: Survey,
    dt: f64,
    steps: f64,
    seconds: f64,
    work: usize,
}

/// The first step size, and the time of the run from two trial steps on a copy of the state.
fn cost(scheme: &Scheme, state: &State, settings: Settings, h: f64) -> std::result::Result<Cost, Loss> {
    let mut motion = Motion::new(scheme, state.clone())?;
    let dt = settings.courant * h / motion.survey.fastest;
    let steps = ((settings.end - state.time) / dt).ceil();
    let mut trial = || {
        let clock = Instant::now();
        // What becomes of the first step is for the run to say.
        let _ = motion.attempt(scheme, dt);
        clock.elapsed().as_secs_f64()
    };
    // The first trial touches the memory for the first time.
    let _ = trial();
    let seconds = trial() * steps;
    Ok(Cost { work: motion.work.bytes(), survey: motion.survey, dt, steps, seconds })
}
