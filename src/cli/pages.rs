//! `dgmpm schema`, `dgmpm completions`, `dgmpm man`: what editors, shells and manuals take from the program.

use super::line::Cli;
use super::print::{say, write};
use crate::error::{Error, Result};
use crate::io::pending;
use crate::scene::schema;
use clap::CommandFactory;
use std::path::PathBuf;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// The shell
    shell: clap_complete::Shell,
}

/// Arguments of `man`.
#[derive(Debug, clap::Args)]
pub struct Man {
    /// The folder for the pages, such as ~/.local/share/man/man1
    folder: PathBuf,
}

/// Prints the schema of scenes.
pub fn schema() -> Result<()> {
    write(&format!("{:#}", schema::schema()));
    Ok(())
}

/// Prints the completions of a shell.
pub fn completions(args: &Completions) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "dgmpm", &mut text);
    write(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// Writes a page for the program, and one for each command.
pub fn man(args: &Man) -> Result<()> {
    let mut all = Cli::command();
    all.build();
    let whole = std::iter::once(all.clone());
    let each = all.get_subcommands().filter(|one| one.get_name() != "help").cloned();
    let mut count = 0;
    for command in whole.chain(each) {
        let name = command.get_display_name().unwrap_or(command.get_name()).replace(' ', "-");
        let path = args.folder.join(format!("{name}.1"));
        let mut text = Vec::new();
        clap_mangen::Man::new(command).render(&mut text).map_err(|why| Error::output(&path, why))?;
        pending::write_text(&path, &String::from_utf8_lossy(&text))?;
        count += 1;
    }
    say(format!("{count} pages written to {}", args.folder.display()));
    Ok(())
}
