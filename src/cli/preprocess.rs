//! `dgmpm preprocess`: all matrices, and what the run will cost.

use super::pipeline::{self, Body, Files};
use super::print::{mebibytes, row, say, seconds, table};
use super::{SceneArgs, keep};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::operators::certificate::{Certificate, certify};
use crate::operators::{Pool, Sampling};
use crate::run::Settings;
use crate::scene::Scene;
use crate::state::State;
use crate::step::{Scheme, Survey, Work, cfl};
use std::path::PathBuf;
use std::time::Instant;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: Files,
    /// Where to write
    #[arg(long, value_name = "FILE", default_value = "operators.h5")]
    out: PathBuf,
    /// Replace the file
    #[arg(long)]
    force: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let scene = Scene::load(&args.scene.scene, &args.scene.sets)?;
    let body = args.files.body(&scene)?;
    keep(&args.out, args.force)?;
    let (operators, reused) = pipeline::operators(&scene, &body, Some(&args.out))?;
    let scheme = pipeline::scheme(&scene, &body, operators);
    let settings = scene.settings(&scheme.method)?;
    let state = scene.initial_state(&body.mesh, &scheme)?;
    report(&scene, &body, &scheme, &state, settings)?;
    say(format!("{} {}", if reused { "reused" } else { "written to" }, args.out.display()));
    Ok(())
}

/// Certificates of all cells at the points where the method samples (nodes for RK).
pub fn certificates(scene: &Scene, body: &Body) -> Result<Vec<Certificate>> {
    let sampling = scene.needs(&body.cloud).sampling.unwrap_or(Sampling::Nodes);
    certify(&body.mesh, &crate::operators::Line::new(scene.scheme.degree), sampling)
}

/// Prints classes, memory, the smallest step and the largest Lebesgue constant with their cells, and the cost.
pub fn report(scene: &Scene, body: &Body, scheme: &Scheme, state: &State, settings: Settings) -> Result<()> {
    let certificates = certificates(scene, body)?;
    let operators = &scheme.operators;
    let h = extreme(&body.mesh, &certificates, |c| -c.h);
    let lebesgue = extreme(&body.mesh, &certificates, |c| c.lebesgue);
    let cost = cost(scheme, state, settings, -h.0);
    let memory = operators.bytes() + cost.work + size_of_val(&state.u[..]);
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
    rows.push(row("estimate", format!("{:.0} steps, {}", cost.steps, seconds(cost.seconds))));
    table(&rows);
    if let Some(growth) = cfl::growth(&scheme.method, scene.scheme.degree) {
        say(format!(
            "note: ADER of degree {} grows weakly at any dt: {growth:.0e} a step, a factor of {:.3} over this run",
            scene.scheme.degree,
            (growth * cost.steps).exp()
        ));
    }
    Ok(())
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

struct Cost {
    dt: f64,
    steps: f64,
    seconds: f64,
    work: usize,
}

/// The first step size, and the time of the run from two trial steps on a copy of the state.
fn cost(scheme: &Scheme, state: &State, settings: Settings, h: f64) -> Cost {
    let mut work = Work::new(scheme, state);
    let mut survey = Survey::default();
    // A sick initial state is reported by the run itself, with its cell.
    let healthy = scheme.survey(state, &work, &mut survey).is_ok() && survey.fastest > 0.0;
    let dt = if healthy { settings.courant * h / survey.fastest } else { f64::NAN };
    let steps = (settings.end / dt).ceil();
    let mut trial = || {
        let clock = Instant::now();
        if healthy {
            scheme.step(state, dt, &survey, &mut work);
            let mut after = survey.clone();
            let _ = scheme.survey(&work.next, &work, &mut after);
        }
        clock.elapsed().as_secs_f64()
    };
    // The first trial touches the memory for the first time.
    let _ = trial();
    let seconds = trial() * steps;
    Cost { dt, steps, seconds, work: work.bytes() }
}
