//! The grids that a run can change to, `[[regrid]]`: an entry bears the name of its first key, which chooses it.

mod cells;
mod files;
mod fronts;
mod geometry;
mod lines;
mod rectangles;
mod same;
mod shift;
mod strips;

pub use files::{Stored, copy, copy_text};
pub use fronts::fronts;
pub use strips::FRONT;

use super::{ANY, CELLS, Entry, FINITE, Form, POSITIVE, Parameter, Preset, Table, Values};
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::observe::View;
use std::path::PathBuf;

/// What there is to know of a kind of new grid.
pub struct Grid {
    /// Whether it changes the cells that are there, so that each time it is due they change again.
    pub repeats: bool,
    /// The files that its first key names, and what becomes of them in the folder of a run.
    pub files: Option<Stored>,
    /// Looks before the first step at what can be known then.
    pub check: fn(&Values, &dyn Rule, &Mesh) -> Result<()>,
    /// Makes the mesh; the number says how often the rule has fired before.
    pub make: fn(&Values, &dyn Rule, usize, &Present) -> Result<Mesh>,
}

/// What a new grid may depend on.
#[derive(Clone, Copy)]
pub struct Present<'a> {
    /// The state.
    pub view: &'a View<'a>,
    /// Its points.
    pub cloud: &'a Cloud,
    /// The material of each cell.
    pub material: &'a [usize],
    /// How many cells the run began with.
    pub start: usize,
}

/// A `[[regrid]]` in its scene.
pub trait Rule {
    /// A path of the scene.
    fn resolve(&self, path: &str) -> PathBuf;
    /// Whether it is the only one of the scene: no other one then changes the cells before it is due.
    fn is_alone(&self) -> bool;
    /// The mesh of the scene.
    ///
    /// # Errors
    /// A mesh that cannot be made.
    fn base(&self) -> Result<Mesh>;
    /// Whether a mesh has the groups of the scene.
    ///
    /// # Errors
    /// A group that it lacks.
    fn accepts(&self, mesh: &Mesh) -> Result<()>;
    /// Whether a grid of so many cells has room in the memory; one of its keys asks for it.
    ///
    /// # Errors
    /// It has none.
    fn has_room(&self, key: &str, cells: usize) -> Result<()>;
    /// An error at the value of one of its keys.
    fn wrong(&self, key: &str, what: String, remedy: &str) -> Error;
}

/// A rectangle of equal cells with the groups left, right, bottom, top and body.
pub const RECTANGLE: &[Parameter] = &[
    Parameter::required("size", "lengths of the edges", "m", Form::Vector(POSITIVE)),
    Parameter::required("cells", "cells in each direction", "", Form::Vector(CELLS)),
];

/// Size and cells of a rectangle.
pub fn rectangle(of: &Values) -> ([f64; 2], [usize; 2]) {
    (of.vector("size"), of.vector("cells").map(|n| n as usize))
}

const fn by(make: fn(&Values, &dyn Rule, usize, &Present) -> Result<Mesh>) -> Grid {
    Grid { repeats: false, files: None, check: |_, _, _| Ok(()), make }
}

const FACTOR: Form = Form::Integer(2, 64);

/// Every kind of new grid.
pub static GRIDS: Table<Grid> = Table::new(&[
    Entry {
        name: "mesh",
        about: "a mesh file, or a list of files that are used one after the other",
        parameters: &[Parameter::required("mesh", "files of Gmsh, .vtu, .xdmf or .h5", "", Form::Texts)],
        check: ANY,
        build: Grid { files: Some(files::MESHES), check: files::check, ..by(files::make) },
    },
    Entry {
        name: "rectangle",
        about: "a rectangle of equal cells",
        parameters: &[Parameter::required("rectangle", "the rectangle", "", Form::Table(RECTANGLE))],
        check: ANY,
        build: Grid {
            check: |of, rule, first| rectangles::check(of, "rectangle", rule, first),
            ..by(|of, rule, count, _| rectangles::make(of, "rectangle", rule, count))
        },
    },
    Entry {
        name: "rectangles",
        about: "rectangles that are used one after the other",
        parameters: &[Parameter::required("rectangles", "the rectangles", "", Form::Tables(RECTANGLE))],
        check: ANY,
        build: Grid {
            check: |of, rule, first| rectangles::check(of, "rectangles", rule, first),
            ..by(|of, rule, count, _| rectangles::make(of, "rectangles", rule, count))
        },
    },
    Entry {
        name: "refine",
        about: "each cell of the present mesh becomes k x k cells",
        parameters: &[Parameter::required("refine", "k", "", FACTOR)],
        check: ANY,
        build: Grid { repeats: true, ..by(|of, rule, _, present| cells::finer(of, rule, present)) },
    },
    Entry {
        name: "coarsen",
        about: "k x k cells of the present mesh, a grid of lines, become one cell",
        parameters: &[Parameter::required("coarsen", "k", "", FACTOR)],
        check: ANY,
        build: Grid {
            repeats: true,
            check: |of, rule, first| if rule.is_alone() { cells::coarser(of, rule, first).map(drop) } else { Ok(()) },
            ..by(|of, rule, _, present| cells::coarser(of, rule, present.view.mesh))
        },
    },
    Entry {
        name: "shift",
        about: "moves the inner nodes of the present mesh, and the next time back",
        parameters: &[Parameter::required("shift", "the move", "m", Form::Vector(FINITE))],
        check: ANY,
        build: Grid { check: shift::check, ..by(shift::make) },
    },
    Entry {
        name: "strips",
        about: "finer strips of the mesh of the scene, a grid of lines, so that no node hangs",
        parameters: &[Parameter::required("strips", "the strips", "", Form::Tables(strips::STRIP))],
        check: strips::fit,
        build: by(strips::make),
    },
    Entry {
        name: "geo",
        about: "a new mesh of Gmsh; the program `gmsh` must be on the path",
        parameters: &[
            Parameter::required("geo", "the geometry, a .geo file", "", Form::Text),
            Parameter::new(
                "size",
                "size of the cells, such as \"0.02 + 0.1*abs(x - 5900*t)\"",
                "m",
                Form::Expression,
                Preset::Absent("as the geometry says"),
            ),
        ],
        check: ANY,
        build: Grid { files: Some(files::GEOMETRY), check: geometry::check, ..by(geometry::make) },
    },
]);
