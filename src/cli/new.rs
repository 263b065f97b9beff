//! `dgmpm new`: a first scene for a mesh.

use super::keep::{keep_as, keep_from};
use super::print::{note, say, table};
use crate::error::Result;
use crate::format::shell;
use crate::io::{pending, write_mesh};
use crate::problem::First;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A mesh (.msh, .h5, .vtu, .xdmf), or a Gmsh geometry (.geo), which the program `gmsh` meshes
    mesh: PathBuf,
    /// Where to write the scene [default: the name of the mesh with .toml, beside it]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace scene and mesh
    #[arg(long)]
    force: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let out = args.out.clone().unwrap_or_else(|| args.mesh.with_extension("toml"));
    keep_from(&out, args.force, &[args.mesh.clone(), args.mesh.with_extension("msh")])?;
    let first = First::read(&args.mesh)?;
    if first.is_new {
        keep_as(&first.path, args.force, "name it in place of the geometry")?;
    }
    let (text, more) = first.scene(&out)?;
    if first.is_new {
        write_mesh(&first.path, &first.mesh)?;
        say(format!("mesh written to {}", first.path.display()));
    }
    table(&first.mesh.rows());
    first.notes.iter().chain(&more).for_each(note);
    pending::write_text(&out, &text)?;
    let name = out.file_stem().unwrap_or_default().to_string_lossy();
    say(format!("scene written to {}; it runs as it is:", out.display()));
    say(format!("  dgmpm run {}", shell(out.display())));
    say(format!("  dgmpm plot {}", shell(format!("runs/{name}"))));
    Ok(())
}
