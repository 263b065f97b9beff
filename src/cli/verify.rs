//! `dgmpm verify`: whether the folder of a run is whole, and whether this machine gives its bits.

use super::print::{say, table};
use super::threads::start_threads;
use crate::error::{Error, Result};
use crate::format::{Row, count, row};
use crate::problem::{Repeated, kernel_of_run, repeat};
use crate::run::{Folder, Whole};
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square; nothing in it is changed
    run: PathBuf,
    /// Steps that are done again from the start; 0: look at the files alone [default: to the second row of the ledger]
    #[arg(long, value_name = "K")]
    steps: Option<usize>,
    /// Threads [default: all processors]; the results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    args.threads.map_or(Ok(()), start_threads)?;
    let folder = Folder::new(&args.run);
    let whole = Whole::look(&folder)?;
    table(&rows(&whole));
    if !whole.faults.is_empty() {
        let what = format!("{} is not whole", folder.root.display());
        return Err(Error::NotWhole([vec![what], whole.faults].concat()));
    }
    if args.steps == Some(0) {
        return Ok(());
    }
    let kernel = kernel_of_run(&folder, &whole.summary)?;
    let Repeated { steps, snapshots, rows, differs } = repeat(&folder, args.steps, kernel)?;
    if !differs.is_empty() {
        let what = format!("{} steps done again on {} have other bits than the run", steps, kernel.name());
        let hint =
            "a run that was extended by `resume` is repeated up to its first end alone: give fewer --steps".to_owned();
        return Err(Error::NotWhole([vec![what], differs, vec![hint]].concat()));
    }
    let (snapshots, rows) = (count(snapshots, "snapshot"), count(rows, "row"));
    say(format!("{steps} steps done again on {}: the same bits in {snapshots} and {rows} of tables", kernel.name()));
    Ok(())
}

fn rows(whole: &Whole) -> Vec<Row> {
    let status = whole.summary["status"].as_str().unwrap_or("no summary.json: the run was killed");
    let mut rows = vec![
        row("run", status),
        row("whole by their seal", count(whole.sealed, "file")),
        row("whole by their hash in .dgmpm", count(whole.hashed, "file")),
        row("without a hash", count(whole.open.len(), "file")),
    ];
    rows.extend(whole.unmade.first().map(|name| row("begun and not made", name)));
    rows
}
