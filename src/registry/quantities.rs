//! Quantities of interest, `[[quantity]] kind = ..`.

use super::outputs::{field_names, has, known_fields};
use super::{ANY, Chosen, Entry, FINITE, Fault, Field, Form, Parameter, Preset, Table, Values, quoted};
use crate::error::{self, Error};
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::names::did_you_mean;
use crate::observe::Samples;
use crate::operators::Neighbour;
use crate::quantity::{
    Component, Energy, Extent, Extreme, Force, FrontWidth, Length, Outside, Overshoot, Part, Peak, Places, PointValue,
    Quantity, Seen,
};
use crate::step::Law;
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

/// x and y.
const AXES: [&str; 2] = ["x", "y"];
const AXIS: Parameter =
    Parameter::new("axis", "the direction", "", Form::Name(|| AXES.to_vec(), &[]), Preset::Name("x"));

const fn field(default: Preset) -> Parameter {
    Parameter { name: "field", about: "the field", unit: "", form: Form::Name(field_names, &[]), default }
}

const COMPONENT: Parameter = Parameter::new(
    "component",
    "its component",
    "",
    Form::Name(component_names, &[]),
    Preset::Absent("the field has one, or the length of the vector"),
);

/// The components of all fields.
fn component_names() -> Vec<&'static str> {
    let mut all: Vec<&str> = known_fields().into_iter().flat_map(Component::names).collect();
    all.sort_unstable();
    all.dedup();
    all
}

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
            make: |of, _| Ok(Box::new(Extent { axis: axis(of) })),
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
        about: "the force that the condition of a boundary group exerts on the body, per metre of thickness",
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

fn axis(of: &Values) -> usize {
    usize::from(of.text("axis") == AXES[1])
}

fn ends(of: &Values) -> [[f64; 2]; 2] {
    [of.vector("from"), of.vector("to")]
}

fn samples(of: &Values) -> Samples {
    Samples { ends: ends(of), count: of.integer("samples"), fields: vec![] }
}

/// A fault of places at their keys.
fn place<T>(found: Result<T, Outside>, keys: [&str; 2]) -> Result<(), Fault> {
    found.map(|_| ()).map_err(|outside| Fault::new(outside.key(keys), outside.to_string(), Outside::REMEDY))
}

/// `from` and `to` are two points.
fn two_points(of: &Values) -> Result<(), Fault> {
    let [from, to] = ends(of);
    match from == to {
        true => Err(Fault::new("to", "`from` and `to` are the same point", "give two points")),
        false => Ok(()),
    }
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
    let (name, known) = (of.text("group"), mesh.edge_groups.iter().map(String::as_str).collect::<Vec<_>>());
    known.iter().position(|known| *known == name).ok_or_else(|| {
        let remedy = format!("{}its groups of boundary edges are {}", did_you_mean(name, &known), known.join(", "));
        Fault::new("group", format!("the mesh has no group \"{name}\""), remedy)
    })
}

/// The field that a quantity names, where it has one.
fn field_of(of: &Values) -> Option<Field> {
    let name = of.maybe_text("field")?;
    known_fields().into_iter().find(|field| field.name() == name)
}

/// The component that a quantity looks at; none where the field has no such component.
fn maybe_component(of: &Values) -> Option<Component> {
    let (field, given) = (field_of(of)?, of.maybe_text("component"));
    // What goes through a front, or over its range, has a sign.
    let signed = of.has("samples") && field == Field::Velocity;
    Component::new(field, given.or(signed.then_some("1")))
}

/// As [`maybe_component`], of values that the entry has checked.
fn component(of: &Values) -> Component {
    maybe_component(of).unwrap_or_default()
}

/// Whether the field has the component.
fn check_component(of: &Values) -> Result<(), Fault> {
    let Some(field) = field_of(of).filter(|_| maybe_component(of).is_none()) else { return Ok(()) };
    let (name, known) = (field.name(), Component::names(field));
    let remedy = match known[..] {
        [] => "remove `component`: the field has one only".to_owned(),
        _ => format!("its components are {}", quoted(&known)),
    };
    match of.maybe_text("component") {
        Some(given) => Err(Fault::new("component", format!("\"{name}\" has no component \"{given}\""), remedy)),
        None => Err(Fault::new("field", format!("\"{name}\" needs a `component`"), remedy)),
    }
}

fn unit_of_field(of: &Values) -> &'static str {
    field_of(of).map_or("", Component::unit)
}

fn shows_displacement(of: &Values) -> bool {
    field_of(of) == Some(Field::Displacement)
}

/// Whether the laws of a run have the field that a quantity names.
///
/// # Errors
/// A field that they lack.
pub fn check_field(quantity: &Chosen<Kind>, laws: &[Law]) -> Result<(), Fault> {
    match field_of(&quantity.values).filter(|field| !field.is_of(laws)) {
        None => Ok(()),
        Some(field) => {
            let what = format!("no material of the scene has \"{}\"", field.name());
            Err(Fault::new("field", what, format!("give another field, or a material law = {}", has(field))))
        }
    }
}
