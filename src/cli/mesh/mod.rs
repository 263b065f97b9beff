//! `dgmpm mesh`: import, make, inspect.

mod args;
mod groups;
mod to;

use super::print::{note, result};
use crate::error::{Error, Place, Result};
use crate::info::Info;
use crate::io::{FORMATS, read_tagged};
use crate::mesh::{Link, Mesh, links, rectangle};
use crate::problem::{notices, room::check_mesh};
use args::Action;
use std::path::Path;
use to::{rows, write};

pub use args::Args;

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    match (&args.action, &args.file) {
        (Some(Action::Info { file, groups }), _) => {
            let mesh = read_tagged(file, &groups.tags()?)?;
            result(&rows(&mesh), &Info::of_mesh("mesh", &mesh).json());
            notices::of_mesh(&mesh, &links_of(&mesh, file)?).iter().for_each(note);
            Ok(())
        }
        (Some(Action::Rectangle { size, cells, to }), _) => {
            let pair = |what| Error::input(format!("{what} wants two numbers"), "for example --size 3,3 --cells 30,30");
            let size = size[..].try_into().map_err(|_| pair("--size"))?;
            let cells: [usize; 2] = cells[..].try_into().map_err(|_| pair("--cells"))?;
            check_mesh(cells[0].saturating_mul(cells[1]))?;
            let mesh = rectangle(size, cells)?;
            write(&mesh, &links(&mesh)?, to, Path::new("rectangle.msh"))
        }
        (None, Some(file)) => {
            let mesh = read_tagged(file, &args.groups.tags()?)?;
            write(&mesh, &links_of(&mesh, file)?, &args.to, file)
        }
        (None, None) => Err(Error::input("no mesh is named", format!("{FORMATS}, or `rectangle`, or `info FILE`"))),
    }
}

fn links_of(mesh: &Mesh, file: &Path) -> Result<Vec<[Link; 4]>> {
    links(mesh).map_err(|why| Error::from(why).or_at(Place::file(file)))
}
