//! `dgmpm bench`: the speed of the step, against the peaks of this machine.

mod args;

use super::print::{answer, say};
use super::threads;
use crate::bench::{self, Campaign, Domain, Figures, Length, Setup};
use crate::error::{Error, Result};
use crate::file::check_place_of_folder;
use crate::lane::Kernel;
use crate::registry::Method;

pub use args::Args;

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let kernel = threads::kernel(args.kernel.as_deref())?;
    if let Some(out) = &args.all {
        check_place_of_folder(out)?;
        return Campaign { kernel, out: out.clone(), mesh: args.mesh.clone(), say: &|text| say(text) }.run();
    }
    threads::check_threads(args.threads)?;
    let (setup, length) = (setup(args, kernel)?, Length::of(args.steps, args.seconds)?);
    let problem = setup.build()?;
    let measured = bench::measure(&problem, args.threads, length)?;
    if args.oneline {
        answer(bench::oneline(&setup, &measured));
        return Ok(());
    }
    let (flops, peaks) = (bench::count(&setup)?, bench::peaks(kernel, args.threads)?);
    bench::report(&Figures::new(&setup, &problem, measured, flops, peaks)).iter().for_each(answer);
    Ok(())
}

/// What is measured.
fn setup(args: &Args, kernel: Kernel) -> Result<Setup> {
    let Some(method) = Method::named(&args.method) else {
        let what = format!("there is no method `{}`", args.method);
        return Err(Error::input(what, format!("--method takes {}", Method::listed())));
    };
    let domain = match (&args.mesh, &args.cells[..]) {
        (Some(path), _) => Domain::File(path.clone()),
        (None, &[nx, ny]) if nx > 0 && ny > 0 => Domain::Cells([nx, ny]),
        _ => return Err(Error::input("--cells is not NX,NY", "give two numbers from 1, such as 32,32")),
    };
    let (layout, law) = (args.layout.clone(), args.law.clone());
    Ok(Setup { method, degree: args.degree, domain, layout, law, kernel, sets: args.sets.clone() })
}
