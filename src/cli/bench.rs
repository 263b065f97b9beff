//! `dgmpm bench`: the speed of the step, against the peaks of this machine.

use super::print::say;
use super::threads;
use crate::bench::{self, Campaign, Domain, Figures, Length, Setup};
use crate::error::{Error, Result};
use crate::registry::Method;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// ader-dgmpm, ader-dgfem or rk-dgfem
    #[arg(long, value_name = "NAME", default_value = "ader-dgmpm")]
    method: String,
    /// Degree N = N_T
    #[arg(long, value_name = "N", default_value_t = 2)]
    degree: usize,
    /// Square cells per direction
    #[arg(long, value_name = "NX,NY", value_delimiter = ',', default_value = "32,32")]
    cells: Vec<usize>,
    /// Mesh file of a rectangle in place of --cells (with --all: measured beside squares)
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Layout of the points of ADER-DGMPM: paper, midpoints, gauss, jitter [default: that of the degree]
    #[arg(long, value_name = "NAME")]
    layout: Option<String>,
    /// Law, with the constants of the paper's steel
    #[arg(long, value_name = "NAME", default_value = "neo-hookean")]
    law: String,
    /// Instruction set: avx512, avx2 or portable [default: the widest of this processor]
    #[arg(long, value_name = "NAME")]
    kernel: Option<String>,
    /// Threads
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Steps to time [default: until the wave has run its way]
    #[arg(long, value_name = "N", conflicts_with = "seconds")]
    steps: Option<usize>,
    /// Seconds to step
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// A further key of the scene, as often as needed: curl.control=off, scheme.flux=acoustic-curl
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Print one line: method degree dofs steps cpu DoF-updates/s/core=.. L2err=..
    #[arg(long)]
    oneline: bool,
    /// Measure everything into this folder (table, pictures, CSV): some minutes, see `make bench`
    #[arg(long, value_name = "DIR", conflicts_with_all = ["oneline", "steps", "seconds", "sets"])]
    all: Option<PathBuf>,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let kernel = threads::kernel(args.kernel.as_deref())?;
    if let Some(out) = &args.all {
        return Campaign { kernel, out: out.clone(), mesh: args.mesh.clone(), say: &|text| say(text) }.run();
    }
    threads::check_threads(args.threads)?;
    let (setup, length) = (args.setup(kernel)?, args.length()?);
    let problem = setup.build()?;
    let measured = bench::measure(&problem, args.threads, length)?;
    if args.oneline {
        say(bench::oneline(&setup, &measured));
        return Ok(());
    }
    let (flops, peaks) = (bench::count(&setup)?, bench::peaks(kernel, args.threads)?);
    bench::report(&Figures::new(&setup, &problem, measured, flops, peaks)).iter().for_each(say);
    Ok(())
}

impl Args {
    fn setup(&self, kernel: crate::lane::Kernel) -> Result<Setup> {
        let method = Method::NAMES.iter().find(|(name, _)| *name == self.method).map(|(_, method)| *method);
        let Some(method) = method else {
            let names: Vec<&str> = Method::NAMES.iter().map(|(name, _)| *name).collect();
            let what = format!("there is no method `{}`", self.method);
            return Err(Error::input(what, format!("--method takes {}", names.join(", "))));
        };
        let domain = match (&self.mesh, &self.cells[..]) {
            (Some(path), _) => Domain::File(path.clone()),
            (None, &[nx, ny]) if nx > 0 && ny > 0 => Domain::Cells([nx, ny]),
            _ => return Err(Error::input("--cells is not NX,NY", "give two numbers from 1, such as 32,32")),
        };
        let (layout, law) = (self.layout.clone(), self.law.clone());
        Ok(Setup { method, degree: self.degree, domain, layout, law, kernel, sets: self.sets.clone() })
    }

    fn length(&self) -> Result<Length> {
        match (self.steps, self.seconds) {
            (Some(0), _) => Err(Error::input("--steps is 0", "give a number of steps from 1")),
            (Some(steps), _) => Ok(Length::Steps(steps)),
            (_, Some(s)) if s.is_finite() && s > 0.0 => Ok(Length::Seconds(s)),
            (_, Some(s)) => Err(Error::input(format!("--seconds is {s}"), "give a number above 0")),
            _ => Ok(Length::Wave),
        }
    }
}
