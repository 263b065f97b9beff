//! `dgmpm study`: what accuracy costs in time.

use super::args::{SceneArgs, keep};
use super::print::say;
use super::threads::start_threads;
use crate::error::{Error, Result};
use crate::lane::Kernel;
use crate::registry::Method;
use crate::scene::Scene;
use crate::study::{Aim, Case, Plan, Reference, Series, Session, Study, machine};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The smallest error that a study looks for: double precision over thousands of steps.
const ROUNDING: f64 = 1e-13;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Methods
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "rk-dgfem,ader-dgfem,ader-dgmpm")]
    methods: Vec<String>,
    /// Degrees N
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "1,2,3,4")]
    degrees: Vec<usize>,
    /// Degrees N_T of each N [default: N alone]
    #[arg(long, value_name = "N,..", value_delimiter = ',')]
    time_degrees: Vec<usize>,
    /// Cells per direction over those of the scene; whole numbers where its mesh is a file [default: 0.25,0.5,1, of a
    /// file 1,2]
    #[arg(long, value_name = "R,..", value_delimiter = ',', allow_negative_numbers = true)]
    refine: Vec<f64>,
    /// Layouts of the points of ADER-DGMPM, such as paper, midpoints, random, rotated [default: that of the scene]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    layouts: Vec<String>,
    /// Degree and refinement of the run that errors are taken against where no exact solution is known [default: one
    /// degree more than the largest, on the finest mesh]
    #[arg(long, value_name = "N,R", value_delimiter = ',', num_args = 1)]
    reference: Vec<f64>,
    /// Find and run the cheapest setting with this standard error, such as 1e-3
    #[arg(long, value_name = "E", conflicts_with = "seconds", allow_negative_numbers = true)]
    error: Option<f64>,
    /// Find and run the most accurate setting that takes so many CPU seconds
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Runs of a case that takes less than half a second; the fastest counts
    #[arg(long, value_name = "N", default_value_t = 3)]
    repeat: usize,
    /// Folder for table and plots [default: runs/<scene name>-study]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results of an earlier study
    #[arg(long)]
    force: bool,
    /// Threads; one by default, so that seconds are CPU seconds
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    start_threads(args.threads)?;
    let scene = args.scene.load()?;
    if !scene.regrids.is_empty() {
        let remedy = "leave them out by --set regrid=[]";
        return Err(scene.error(
            "regrid",
            "a study compares runs on one grid each, and the scene has [[regrid]]",
            remedy,
        ));
    }
    let (plan, [degree, refinement]) = (args.plan(&scene)?, args.reference(&scene)?);
    let out = args.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{}-study", scene.name())));
    keep(&out.join("study.csv"), args.force)?;
    let mesh = scene.build_mesh()?;
    // Never set: the table is kept after each run, and an interrupt may simply end the program.
    let interrupt = AtomicBool::new(false);
    say(format!("{}: what accuracy costs in time", scene.title));
    let reference = Reference::new(&scene, degree as usize, refinement, &interrupt)?;
    let head = vec![
        format!("problem: {}", scene.title),
        format!("error: standard measure against {}", reference.words()),
        format!("machine: {}", machine(Kernel::widest())),
    ];
    head.iter().for_each(say);
    let (cells, h) = (mesh.cells.len(), mesh.smallest_h());
    let study =
        Study { scene: &scene, cells, h, reference, records: vec![], repeat: args.repeat, interrupt: &interrupt };
    Session { study, plan, out, head, say: &|text| say(text) }.run()
}

impl Args {
    fn plan(&self, scene: &Scene) -> Result<Plan> {
        let aim = match (self.error, self.seconds) {
            (Some(x), _) | (_, Some(x)) if !(x.is_finite() && x > 0.0) => {
                return Err(Error::input(format!("--error or --seconds is {x}"), "give a number above 0"));
            }
            (Some(error), _) if error < ROUNDING => {
                let what = format!("--error is {error:e}, below what rounding leaves of any run");
                return Err(Error::input(what, format!("give {ROUNDING:e} or more")));
            }
            (Some(error), _) => Some(Aim::Error(error)),
            (_, seconds) => seconds.map(Aim::Seconds),
        };
        Ok(Plan { series: self.series(scene)?, refinements: self.refinements(scene)?, aim })
    }

    /// The meshes, from coarse to fine.
    fn refinements(&self, scene: &Scene) -> Result<Vec<f64>> {
        let of_file = scene.mesh_path().is_some();
        let mut all = self.refine.clone();
        if all.is_empty() {
            all = if of_file { vec![1.0, 2.0] } else { vec![0.25, 0.5, 1.0] };
        }
        all.sort_by(f64::total_cmp);
        all.dedup();
        let usable = |r: f64| r.is_finite() && r > 0.0 && (!of_file || r.fract() == 0.0);
        if let Some(bad) = all.iter().chain(self.reference.get(1)).find(|r| !usable(**r)) {
            let range = if of_file { "whole numbers from 1: the mesh is a file" } else { "numbers above 0" };
            return Err(Error::input(format!("a refinement is {bad}"), format!("give {range}")));
        }
        Ok(all)
    }

    /// Degree and refinement of the reference run.
    fn reference(&self, scene: &Scene) -> Result<[f64; 2]> {
        let finest = self.refinements(scene)?.last().copied().unwrap_or(1.0);
        let largest = self.degrees.iter().copied().max().unwrap_or(1);
        match self.reference[..] {
            [] => Ok([(largest + 1).min(6) as f64, finest]),
            [degree, refinement] if degree.fract() == 0.0 && (0.0..=6.0).contains(&degree) => Ok([degree, refinement]),
            _ => Err(Error::input("--reference is not DEGREE,REFINEMENT", "give two numbers, such as 5,2")),
        }
    }

    fn series(&self, scene: &Scene) -> Result<Vec<Series>> {
        let mut all = Vec::new();
        for name in &self.methods {
            let names: Vec<&str> = Method::NAMES.iter().map(|(name, _)| *name).collect();
            let method = Method::NAMES.iter().find(|(known, _)| known == name).map(|(_, method)| *method);
            let Some(method) = method else {
                let what = format!("there is no method `{name}`");
                return Err(Error::input(what, format!("--methods takes {}", names.join(", "))));
            };
            for &degree in &self.degrees {
                let layouts: Vec<Option<String>> = match method {
                    Method::AderDgmpm if !self.layouts.is_empty() => self.layouts.iter().cloned().map(Some).collect(),
                    _ => vec![None],
                };
                let own = [degree];
                let times = if self.time_degrees.is_empty() { &own[..] } else { &self.time_degrees };
                for &time_degree in times {
                    let series =
                        |layout: &Option<String>| Series { method, degree, time_degree, layout: layout.clone() };
                    all.extend(layouts.iter().map(series));
                }
            }
        }
        // A misspelt layout or a degree beyond the range is an error of the command line, not of one case.
        for series in &all {
            scene.with(&Case { series: series.clone(), refinement: 1.0 }.sets(scene))?.settings()?;
        }
        Ok(all)
    }
}
