//! `dgmpm verify`: whether the folder of a run is whole, and whether this machine gives its bits.

use super::print::{note, say, table};
use super::threads::start_threads;
use crate::error::{Error, Result};
use crate::format::{Row, count, row};
use crate::problem::{Repeated, kernel_of_run, look, repeat};
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
    let whole = look(&folder)?;
    table(&rows(&whole));
    if !whole.faults.is_empty() {
        let what = format!("{} is not whole", folder.root.display());
        return Err(Error::NotWhole([vec![what], whole.faults].concat()));
    }
    if args.steps == Some(0) {
        return Ok(());
    }
    let kernel = kernel_of_run(&folder, &whole.summary)?;
    let Repeated { steps, snapshots, rows, notes, differs } = repeat(&folder, &whole.summary, args.steps, kernel)?;
    notes.iter().for_each(note);
    if !differs.is_empty() {
        let what = format!("{} done again on {} have other bits than the run", count(steps, "step"), kernel.name());
        return Err(Error::NotWhole([vec![what], differs].concat()));
    }
    let of = |[start, behind]: [usize; 2], one: &str| format!("{} ({start} of the start)", count(start + behind, one));
    let (steps, snapshots, rows) = (count(steps, "step"), of(snapshots, "snapshot"), of(rows, "row"));
    say(format!("{steps} done again on {}: the same bits in {snapshots} and {rows} of tables", kernel.name()));
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
