//! Quantities of interest, `[[quantity]] kind = ..`.

use super::fields::{
    AXIS, COMPONENT, axis, check_component, component, ends, field, known_group, place, shows_displacement, two_points,
    unit_of_field,
};
use super::{ANY, Entry, FINITE, Fault, Form, Parameter, Preset, Table, Values};
use crate::error::{self, Error};
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::observe::Samples;
use crate::operators::Neighbour;
use crate::quantity::{
    Energy, Extent, Extreme, Force, FrontWidth, Length, Overshoot, Part, Peak, Places, PointValue, Quantity, Seen,
};
use std::sync::Arc;

pub use crate::quantity::{Statistic, When};

/// What there is to know of a quantity.
pub struct Kind {
    /// Its unit; empty for a pure number.
    pub unit: fn(&Values) -> &'static str,
    /// Whether it is an error itself: an exact solution has 0.
    pub is_error: bool,
    /// Whether it needs the displacement.
    pub displacement: fn(&Values) -> bool,
    /// Whether the mesh has what it looks at.
    pub check: fn(&Values, &Mesh) -> Result<(), Fault>,
    /// Makes it.
    pub make: fn(&Values, &Start) -> error::Result<Box<dyn Quantity>>,
}

/// What a quantity is made for.
pub struct Start<'a> {
    /// The state at the start of the run.
    pub seen: &'a Seen<'a>,
    /// The exact solution, where the scene names one.
    pub exact: Option<&'a Arc<dyn Exact>>,
}

/// Samples of a line, where the scene does not say how many.
const SAMPLES: usize = 1001;

const AT: Parameter = Parameter::required("at", "the point", "m", Form::Vector(FINITE));
const FROM: Parameter =
    Parameter::required("from", "first point of the line, behind the front", "m", Form::Vector(FINITE));
const TO: Parameter = Parameter::required("to", "last point of the line, before the front", "m", Form::Vector(FINITE));
const COUNT: Parameter = Parameter::new(
    "samples",
    "number of samples of the line, with equal distances",
    "",
    Form::Integer(2, 1_000_000),
    Preset::Integer(SAMPLES),
);

fn names_of<T>(names: &[(&'static str, T)]) -> Vec<&'static str> {
    names.iter().map(|(name, _)| *name).collect()
}

/// Every quantity.
pub static QUANTITIES: Table<Kind> = Table::new(&[
    Entry {
        name: "value",
        about: "a field at a point of the initial configuration",
        parameters: &[AT, field(Preset::Required), COMPONENT],
        check: check_component,
        build: Kind {
            unit: unit_of_field,
            is_error: false,
            displacement: shows_displacement,
            check: |of, mesh| place(Places::points(vec![of.vector("at")], mesh), ["at", "at"]),
            make: |of, start| {
                let at = Places::points(vec![of.vector("at")], start.seen.mesh)?;
                Ok(Box::new(PointValue { component: component(of), at }))
            },
        },
    },
    Entry {
        name: "peak",
        about: "the largest or smallest value of a field over the body, at the nodes, on the faces and in the corners of all cells",
        parameters: &[
            field(Preset::Required),
            COMPONENT,
            Parameter::new(
                "extreme",
                "which end of the values",
                "",
                Form::Name(|| names_of(Extreme::NAMES), &[]),
                Preset::Name("largest"),
            ),
        ],
        check: check_component,
        build: Kind {
            unit: unit_of_field,
            is_error: false,
            displacement: shows_displacement,
            check: |_, _| Ok(()),
            make: |of, start| {
                let extreme = Extreme::named(of.text("extreme")).unwrap_or(Extreme::Largest);
                Ok(Box::new(Peak { component: component(of), extreme, at: Places::body(start.seen) }))
            },
        },
    },
    Entry {
        name: "extent",
        about: "how far the deformed body reaches along an axis, such as the final length of a bar; displacements count from the start, whatever F is there",
        parameters: &[AXIS],
        check: ANY,
        build: Kind {
            unit: |_| "m",
            is_error: false,
            displacement: |_| true,
            check: |_, _| Ok(()),
            make: |of, _| Ok(Box::new(Extent { axis: axis(of), at: None })),
        },
    },
    Entry {
        name: "length",
        about: "the distance of two points of the material in the deformed body; displacements count from the start, whatever F is there",
        parameters: &[
            Parameter::required("from", "one point", "m", Form::Vector(FINITE)),
            Parameter::required("to", "the other point", "m", Form::Vector(FINITE)),
        ],
        check: two_points,
        build: Kind {
            unit: |_| "m",
            is_error: false,
            displacement: |_| true,
            check: |of, mesh| place(Places::points(ends(of).to_vec(), mesh), ["from", "to"]),
            make: |of, start| Ok(Box::new(Length { ends: Places::points(ends(of).to_vec(), start.seen.mesh)? })),
        },
    },
    Entry {
        name: "force",
        about: "the force on a boundary group by its condition and by what it touches, per metre of thickness: at a time the mean over its step",
        parameters: &[
            Parameter::required("group", "the group of edges in the mesh, such as \"left\"", "", Form::Text),
            AXIS,
        ],
        check: ANY,
        build: Kind {
            unit: |_| "N/m",
            is_error: false,
            displacement: |_| false,
            check: |of, mesh| group(of, mesh).map(|_| ()),
            make: |of, start| {
                // The check has found the group.
                let group = group(of, start.seen.mesh).unwrap_or(usize::MAX);
                let mut faces = start.seen.scheme.operators.blocks.neighbours.iter().flatten().flatten();
                if group != usize::MAX && !faces.any(|there| *there == Neighbour::Boundary(group)) {
                    let what = format!(
                        "no face of \"{}\" is a boundary: it is periodic, or inside the body",
                        of.text("group")
                    );
                    return Err(lacks("force", &what, "name a group on which a condition acts"));
                }
                Ok(Box::new(Force { name: of.text("group").to_owned(), group, axis: axis(of) }))
            },
        },
    },
    Entry {
        name: "energy",
        about: "an energy of the body, per metre of thickness",
        parameters: &[Parameter::new(
            "part",
            "which energy; total is kinetic and strain energy together",
            "",
            Form::Name(|| names_of(Part::NAMES), &[]),
            Preset::Name("total"),
        )],
        check: ANY,
        build: Kind {
            unit: |_| "J/m",
            is_error: false,
            displacement: |_| false,
            check: |_, _| Ok(()),
            make: |of, _| Ok(Box::new(Energy { part: Part::named(of.text("part")).unwrap_or(Part::Total) })),
        },
    },
    Entry {
        name: "front-width",
        about: "the distance along a line between 10 % and 90 % of the jump of a field",
        parameters: &[
            FROM,
            TO,
            COUNT,
            field(Preset::Name("velocity")),
            Parameter { default: Preset::Absent("as for any field; of velocity 1"), ..COMPONENT },
            Parameter::new(
                "values",
                "the values behind and before the front",
                "unit of the field",
                Form::Vector(FINITE),
                Preset::Absent("those at the ends of the line, of the exact solution where the scene has one"),
            ),
            Parameter::new(
                "unit",
                "in lengths of the cell at the front along the line, or in m",
                "",
                Form::Name(|| vec!["cells", "m"], &[]),
                Preset::Name("cells"),
            ),
        ],
        check: |of| {
            two_points(of)?;
            check_component(of)?;
            differ(
                of,
                "values",
                |a, b| a != b,
                "the values behind and before the front are the same",
                "give two values",
            )
        },
        build: Kind {
            unit: |of| if of.text("unit") == "m" { "m" } else { "cells" },
            is_error: true,
            displacement: shows_displacement,
            check: |of, mesh| place(Places::line(samples(of), mesh), ["from", "to"]),
            make: |of, start| {
                Ok(Box::new(FrontWidth {
                    component: component(of),
                    line: Places::line(samples(of), start.seen.mesh)?,
                    ends: ends(of),
                    values: of.has("values").then(|| of.vector("values")),
                    solution: start.exact.cloned(),
                    in_cells: of.text("unit") != "m",
                }))
            },
        },
    },
    Entry {
        name: "overshoot",
        about: "how far a field leaves a range, as a share of the range; along a line, or over the body where no line is given",
        parameters: &[
            Parameter { default: Preset::Absent("the whole body"), about: "first point of the line", ..FROM },
            Parameter { default: Preset::Absent("the whole body"), about: "last point of the line", ..TO },
            COUNT,
            field(Preset::Name("velocity")),
            Parameter { default: Preset::Absent("as for any field; of velocity 1"), ..COMPONENT },
            Parameter::new(
                "range",
                "the smallest and the largest value that are right",
                "unit of the field",
                Form::Vector(FINITE),
                Preset::Absent("those of the exact solution at that time; without one those of the start and 0"),
            ),
        ],
        check: |of| {
            match (of.has("from"), of.has("to")) {
                (true, true) => two_points(of)?,
                (false, false) => {}
                (from, _) => {
                    let (given, other) = if from { ("from", "to") } else { ("to", "from") };
                    let what = format!("the line has `{given}` and no `{other}`");
                    return Err(Fault::new(given, what, "give both ends of the line, or none for the whole body"));
                }
            }
            check_component(of)?;
            differ(of, "range", |low, high| low < high, "the range has no size", "give the smaller value first")
        },
        build: Kind {
            unit: |_| "",
            is_error: true,
            displacement: shows_displacement,
            check: |of, mesh| match of.has("from") {
                true => place(Places::line(samples(of), mesh), ["from", "to"]),
                false => Ok(()),
            },
            make: |of, Start { seen, exact }| {
                let (component, is_line) = (component(of), of.has("from"));
                let at = if is_line { Places::line(samples(of), seen.mesh)? } else { Places::body(seen) };
                let given = of.has("range").then(|| of.vector("range"));
                let range = given.unwrap_or_else(|| Overshoot::range_of(&component, &at, seen));
                let solution = exact.filter(|_| given.is_none()).cloned();
                if given.is_none() && solution.is_none() && Overshoot::is_empty(&component, range, seen) {
                    let what =
                        "the field is the same everywhere at the start: there is no range that it should stay in";
                    return Err(lacks("overshoot", what, "give `range`"));
                }
                Ok(Box::new(Overshoot { component, at, range, solution }))
            },
        },
    },
]);

/// A fault of a quantity at the start of a run.
fn lacks(kind: &str, what: &str, remedy: &str) -> Error {
    Error::input(format!("[[quantity]] of kind \"{kind}\": {what}"), remedy)
}

fn samples(of: &Values) -> Samples {
    Samples { ends: ends(of), count: of.integer("samples"), fields: vec![] }
}

/// Whether the two numbers of a key, where it is given, are what they must be to each other.
fn differ(of: &Values, key: &str, fit: fn(f64, f64) -> bool, what: &str, remedy: &str) -> Result<(), Fault> {
    if !of.has(key) {
        return Ok(());
    }
    let [a, b] = of.vector(key);
    if fit(a, b) { Ok(()) } else { Err(Fault::new(key, what, remedy)) }
}

/// The number of the boundary group in a mesh.
fn group(of: &Values, mesh: &Mesh) -> Result<usize, Fault> {
    known_group("group", of.text("group"), &[("boundary edges", &mesh.edge_groups)])
}
