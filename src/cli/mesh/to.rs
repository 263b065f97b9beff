//! Where a mesh goes.

use crate::cli::keep::{keep, keep_from};
use crate::cli::print::{note, say, table};
use crate::error::Result;
use crate::format::{Row, row};
use crate::io::{hash, write_mesh};
use crate::mesh::{Link, Mesh};
use crate::problem::notices;
use std::path::{Path, PathBuf};

/// Where a mesh goes.
#[derive(Debug, clap::Args)]
pub struct To {
    /// Where to write: .h5, .msh for Gmsh, .xdmf for DOLFINx [default: the input's name with .h5 (_mesh.h5 for .xdmf), or rectangle.h5]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace the file
    #[arg(long)]
    pub force: bool,
}

impl To {
    /// Where the mesh that is read from a file goes, with the file beside it not in the way. The `.h5` of an XDMF file has its numbers.
    pub fn path(&self, from: &Path) -> Result<PathBuf> {
        let of_xdmf = from.extension().is_some_and(|ending| ending == "xdmf" || ending == "xmf");
        let stem = from.file_stem().unwrap_or_default().to_string_lossy();
        let default = || from.with_file_name(if of_xdmf { format!("{stem}_mesh.h5") } else { format!("{stem}.h5") });
        let out = self.out.clone().unwrap_or_else(default);
        // A mesh may be written in the place of the one that was read, but not into half of it.
        let numbers = if of_xdmf { vec![from.with_extension("h5")] } else { vec![] };
        keep_from(&out, self.force, &numbers)?;
        let beside = out.extension().is_some_and(|ending| ending == "xdmf").then(|| out.with_extension("h5"));
        beside.map_or(Ok(()), |beside| keep(&beside, self.force)).map(|()| out)
    }
}

/// Writes a mesh whose boundary is wholly tagged.
pub fn write(mesh: &Mesh, links: &[[Link; 4]], to: &To, from: &Path) -> Result<()> {
    let out = to.path(from)?;
    write_mesh(&out, mesh)?;
    table(&rows(mesh));
    notices::of_mesh(mesh, links).iter().for_each(note);
    say(format!("written to {}", out.display()));
    Ok(())
}

/// What a mesh holds, as a table.
pub fn rows(mesh: &Mesh) -> Vec<Row> {
    [mesh.rows(), vec![row("fingerprint", hash::of_places(mesh))]].concat()
}
