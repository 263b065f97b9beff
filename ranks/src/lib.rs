//! `dgmpm` on several ranks, each of which is a process that MPI starts: `mpirun -n 4 dgmpm-mpi run SCENE`.
//!
//! A program that adds laws of its own to `dgmpm::registry` calls [`main`] after that, as `dgmpm-mpi` does without.
//!
//! However a run ends, all ranks end. What they can agree on ends them all with the exit code of `dgmpm`. Where one of them panics or no
//! longer answers, it or those who wait for it end the job ([`engine`]).

// But for one call of the allocator.
#![deny(unsafe_code)]
#![deny(missing_docs)]

mod allocator;
mod arguments;
pub mod engine;
mod partition;
mod threads;

use arguments::Arguments;
use engine::Engine;
use ferrompi::{Mpi, ThreadLevel};
use std::process::ExitCode;
use std::sync::Arc;

/// The program on the ranks that MPI has started, this process among them; its exit code is the same on all of them.
pub fn main() -> ExitCode {
    allocator::give_large_pieces_back();
    // Steps run on threads, and messages go from this one.
    let mpi = match Mpi::init_thread(ThreadLevel::Funneled) {
        Ok(mpi) => mpi,
        Err(why) => {
            eprintln!(
                "error: MPI does not start: {why}\n  start this program by the mpirun of the MPI that it was built with"
            );
            return ExitCode::from(engine::LOST);
        }
    };
    engine::end_all_on_panic(mpi.world());
    let parsed = Arguments::parse(std::env::args_os());
    let engine = Arc::new(Engine::new(mpi.world(), parsed.patience, parsed.partition));
    let code = run(&engine, parsed);
    drop(mpi);
    code
}

fn run(engine: &Arc<Engine>, parsed: Arguments) -> ExitCode {
    let refuse = |what: &str, remedy: &str| {
        if engine.is_first() {
            eprintln!("error: {what}\n  {remedy}");
        }
        ExitCode::from(2)
    };
    if let Some(rank) = engine.first_that_differs(arguments::hash(std::env::args_os().skip(1).collect::<Vec<_>>())) {
        return refuse(&format!("rank {rank} has another command line than rank 0"), "give all ranks the same one");
    }
    if let Some((what, remedy)) = parsed.fault {
        return refuse(&what, remedy);
    }
    if parsed.help && engine.is_first() {
        println!("{}\n", arguments::HELP);
    }
    let threads = threads::of_rank(engine);
    let code = dgmpm::main_on(engine.clone(), threads, parsed.rest);
    if parsed.meter {
        engine.report();
    }
    code
}
