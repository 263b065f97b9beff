//! `dgmpm mesh`: import, make, inspect.

mod args;

use super::output::keep;
use super::print::{note, result, say, table};
use crate::error::{Error, Place, Result};
use crate::info::Info;
use crate::io::{read_mesh, write_mesh};
use crate::mesh::{Link, Mesh, links, rectangle};
use crate::problem::{notices, room::check_mesh};
use args::{Action, To};
use std::path::Path;

pub use args::Args;

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    match (&args.action, &args.file) {
        (Some(Action::Info { file }), _) => {
            let (info, mesh) = (Info::of(file)?, read_mesh(file)?);
            result(&mesh.rows(), &info.json());
            notices::of_mesh(&mesh, &links_of(&mesh, file)?).iter().for_each(note);
            Ok(())
        }
        (Some(Action::Rectangle { size, cells, to }), _) => {
            let pair = |what| Error::input(format!("{what} wants two numbers"), "for example --size 3,3 --cells 30,30");
            let size = size[..].try_into().map_err(|_| pair("--size"))?;
            let cells: [usize; 2] = cells[..].try_into().map_err(|_| pair("--cells"))?;
            check_mesh(cells[0].saturating_mul(cells[1]))?;
            let mesh = rectangle(size, cells)?;
            write(&mesh, &links(&mesh)?, to, Path::new("rectangle.h5"))
        }
        (None, Some(file)) => {
            let mesh = read_mesh(file)?;
            write(&mesh, &links_of(&mesh, file)?, &args.to, &file.with_extension("h5"))
        }
        (None, None) => Err(Error::input("no mesh is named", "give a Gmsh file, or `rectangle`, or `info FILE`")),
    }
}

fn links_of(mesh: &Mesh, file: &Path) -> Result<Vec<[Link; 4]>> {
    links(mesh).map_err(|why| Error::from(why).or_at(Place::file(file)))
}

/// Writes a mesh whose boundary is wholly tagged.
fn write(mesh: &Mesh, links: &[[Link; 4]], to: &To, default: &Path) -> Result<()> {
    let out = to.out.as_deref().unwrap_or(default);
    keep(out, to.force)?;
    write_mesh(out, mesh)?;
    info(mesh, links);
    say(format!("written to {}", out.display()));
    Ok(())
}

fn info(mesh: &Mesh, links: &[[Link; 4]]) {
    table(&mesh.rows());
    notices::of_mesh(mesh, links).iter().for_each(note);
}
