//! What is recorded, `[[output]] kind = ..`.

use super::fields::{
    self, AXIS, COMPONENT, axis, check_component, component, field, field_names, has, known_fields, known_group,
    unit_of_field,
};
use super::givers;
use super::{ANY, Chosen, Entry, FINITE, Fault, Field, Form, Parameter, Preset, Table, Value, Values};
use crate::error::Error;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::observe::{Contents, Ledger, Line, Observer, Outside, Samples, Schedule, Snapshots};
use crate::quantity::{Extent, Length, Places, Quantity};
use crate::run::Folder;
use crate::step::{Law, Scheme};
use crate::track::{Energies, Extremes, Forces, Lengths, Probe, Track, Tracked};

/// What there is to know of an output.
pub struct Output {
    /// Whether it shows fields.
    pub has_fields: bool,
    /// Whether it writes snapshots, with the grid of each beside them.
    pub snapshots: bool,
    /// Steps between two records where the scene gives no times; none: it has to.
    pub every_steps: Option<usize>,
    /// Of a kind that every run has, and a scene at most once: what a run has whose scene does not name it, as a change of the
    /// defaults and the steps between two records.
    pub always: Option<fn(&mut Values) -> usize>,
    /// Whether it needs the displacement, beside that of a field.
    pub displacement: fn(&Values) -> bool,
    /// The groups of edges whose conditions it looks at.
    pub conditions: fn(&Values) -> &[String],
    /// Whether the mesh has what it records.
    pub check: fn(&Values, &Mesh) -> std::result::Result<(), Fault>,
    /// Makes its observer.
    pub make: fn(&Values, Recording) -> Result<Box<dyn Observer>>,
}

impl Output {
    /// An output that needs nothing but its observer; a scene gives its times.
    pub const fn of(make: fn(&Values, Recording) -> Result<Box<dyn Observer>>) -> Self {
        Self {
            has_fields: false,
            snapshots: false,
            every_steps: None,
            always: None,
            displacement: |_| false,
            conditions: |_| &[],
            check: |_, _| Ok(()),
            make,
        }
    }

    /// Numbers through time: at every step where the scene gives no times.
    const fn track(make: fn(&Values, Recording) -> Result<Box<dyn Observer>>) -> Self {
        Self { every_steps: Some(1), ..Self::of(make) }
    }
}

/// What an observer is made for.
pub struct Recording<'a> {
    /// The name of the output.
    pub name: &'a str,
    /// The fields that it shows.
    pub fields: Vec<Field>,
    /// When it observes.
    pub schedule: Schedule,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The law of each cell.
    pub material: &'a [usize],
    /// The name of each material: that of its group, or "body".
    pub materials: Vec<String>,
    /// The folder of the run.
    pub folder: &'a Folder,
    /// What a ledger of the run has beside its first columns.
    pub contents: Contents,
}

impl Recording<'_> {
    /// The observer of numbers through time.
    fn track(self, what: impl Track + 'static) -> Result<Box<dyn Observer>> {
        let path = self.folder.track(self.name);
        Ok(Box::new(Tracked::create(&path, Box::new(what), self.material, self.schedule)?))
    }
}

const fn named(default: Preset) -> Parameter {
    Parameter { name: "name", about: "its name, unique", unit: "", form: Form::Text, default }
}

const fn fields(default: Preset) -> Parameter {
    Parameter { name: "fields", about: "the fields that it shows", unit: "", form: Form::Names(field_names), default }
}

/// Every output.
pub static OUTPUTS: Table<Output> = Table::new(&[
    Entry {
        name: "fields",
        about: "snapshots, for `dgmpm export`; at the end of the run, too, unless `at` lists the times",
        parameters: &[named(Preset::Absent("the kind")), fields(Preset::Absent("all"))],
        check: ANY,
        build: Output {
            has_fields: true,
            snapshots: true,
            ..Output::of(|_, of| {
                Ok(Box::new(Snapshots::new(&of.folder.snapshots(), of.schedule.with_end_of_intervals())))
            })
        },
    },
    Entry {
        name: "line",
        about: "samples along a line of the initial configuration: `lines/<name>.csv`",
        parameters: &[
            Parameter { about: "the name of the file `lines/<name>.csv`, unique", ..named(Preset::Required) },
            Parameter::required("from", "first point of the line", "m", Form::Vector(FINITE)),
            Parameter::required("to", "last point of the line", "m", Form::Vector(FINITE)),
            Parameter::required("samples", "number of samples, with equal distances", "", Form::Integer(2, 1_000_000)),
            fields(Preset::Names(&["cauchy_stress", "velocity"])),
        ],
        check: |of| match of.vector("from") == of.vector("to") {
            true => Err(Fault::new("to", "the line has no length: `from` and `to` are the same", "give two points")),
            false => Ok(()),
        },
        build: Output {
            has_fields: true,
            check: |of, mesh| {
                samples(of, vec![]).check(mesh).map_err(|outside| {
                    let key = if outside.sample == 0 { "from" } else { "to" };
                    Fault::new(key, outside.to_string(), Outside::REMEDY)
                })
            },
            ..Output::of(|of, Recording { name, fields, schedule, mesh, folder, .. }| {
                Ok(Box::new(Line::create(&folder.line(name), mesh, &samples(of, fields), schedule)?))
            })
        },
    },
    Entry {
        name: "ledger",
        about: "energy and momentum: ledger.csv; a run without this table has one too, every 10 steps and without balance",
        parameters: &[Parameter::new(
            "balance",
            "where energy came from and went to, see run.md",
            "",
            Form::Boolean,
            Preset::Boolean(true),
        )],
        check: ANY,
        build: Output {
            every_steps: Some(1),
            always: Some(|defaults| {
                defaults.set("balance", Value::Boolean(false));
                10
            }),
            // For the angular momentum.
            displacement: |of| of.boolean("balance"),
            ..Output::of(|of, Recording { schedule, folder, contents, .. }| {
                let contents = Contents { balance: of.boolean("balance"), ..contents };
                Ok(Box::new(Ledger::create(&folder.ledger(), schedule.with_end(), contents)?))
            })
        },
    },
    #[cfg(feature = "effect-outputs")]
    Entry {
        name: "probe",
        about: "a point of the material through time, its place x = X + u and fields: `tracks/<name>.csv`; what a line of one sample would be",
        parameters: &[
            TRACK,
            Parameter::required("point", "the point X in the initial configuration", "m", Form::Vector(FINITE)),
            fields(Preset::Names(&["cauchy_stress", "velocity"])),
        ],
        check: ANY,
        build: Output {
            has_fields: true,
            displacement: |_| true,
            check: |of, mesh| fields::place(Places::points(vec![of.vector("point")], mesh), ["point", "point"]),
            ..Output::track(|of, mut to| {
                let at = Places::points(vec![of.vector("point")], to.mesh)?;
                let fields = std::mem::take(&mut to.fields);
                to.track(Probe::new(at, fields))
            })
        },
    },
    #[cfg(feature = "effect-outputs")]
    Entry {
        name: "force",
        about: "force, impulse and work of the conditions of boundary groups on the body through time, per metre of thickness: `tracks/<name>.csv`",
        parameters: &[
            TRACK,
            Parameter::new(
                "groups",
                "the groups of edges in the mesh, such as \"left\"",
                "",
                Form::Texts,
                Preset::Absent("all on the boundary"),
            ),
            Parameter::new(
                "by",
                "`\"group\"`: from the condition of each group; `\"pair\"`: from one group in contact to the other, in columns `a_by_b_..`",
                "",
                Form::Name(|| vec!["group", "pair"], &[]),
                Preset::Name("group"),
            ),
        ],
        check: ANY,
        build: Output {
            conditions: |of| of.texts("groups"),
            check: check_groups,
            ..Output::track(|of, to| {
                let all = if of.text("by") == "pair" { givers::pairs } else { givers::groups };
                let givers = all(of.texts("groups"), to.mesh, to.scheme);
                if givers.is_empty() {
                    let what =
                        "an [[output]] of kind \"force\" has nothing to record: no pair of these groups is in contact";
                    return Err(Error::input(
                        what,
                        "give by = \"group\", groups that touch each other, or a [[boundary]] kind = \"contact\"",
                    ));
                }
                to.track(Forces::new(givers))
            })
        },
    },
    #[cfg(feature = "effect-outputs")]
    Entry {
        name: "extreme",
        about: "the smallest and the largest value of a field through time, and the points X of both: `tracks/<name>.csv`",
        parameters: &[TRACK, field(Preset::Required), COMPONENT, GROUP],
        check: check_component,
        build: Output {
            displacement: fields::shows_displacement,
            check: check_group,
            ..Output::track(|of, to| {
                let at = places(of, &to);
                to.track(Extremes::new(component(of), unit_of_field(of), at))
            })
        },
    },
    #[cfg(feature = "effect-outputs")]
    Entry {
        name: "length",
        about: "the distance of two points of the material, or how far a group or the body reaches along an axis, through time: `tracks/<name>.csv`",
        parameters: &[
            TRACK,
            Parameter::new(
                "from",
                "one point",
                "m",
                Form::Vector(FINITE),
                Preset::Absent("no distance, but an extent"),
            ),
            Parameter::new("to", "the other point", "m", Form::Vector(FINITE), Preset::Absent("as `from`")),
            GROUP,
            AXIS,
        ],
        check: check_length,
        build: Output {
            displacement: |_| true,
            check: |of, mesh| match of.has("from") {
                true => fields::place(Places::points(fields::ends(of).to_vec(), mesh), ["from", "to"]),
                false => check_group(of, mesh),
            },
            ..Output::track(|of, to| {
                let length: Box<dyn Quantity> = match of.has("from") {
                    true => Box::new(Length { ends: Places::points(fields::ends(of).to_vec(), to.mesh)? }),
                    false => Box::new(Extent { axis: axis(of), at: of.has("group").then(|| places(of, &to)) }),
                };
                to.track(Lengths(length))
            })
        },
    },
    #[cfg(feature = "effect-outputs")]
    Entry {
        name: "energy",
        about: "kinetic, strain and dissipated energy of each material through time, per metre of thickness: `tracks/<name>.csv`",
        parameters: &[TRACK],
        check: ANY,
        build: Output::track(|_, mut to| {
            let names = std::mem::take(&mut to.materials);
            to.track(Energies { names })
        }),
    },
]);

/// The name of numbers through time.
const TRACK: Parameter = Parameter {
    name: "name",
    about: "the name of the file `tracks/<name>.csv`, unique",
    unit: "",
    form: Form::Text,
    default: Preset::Required,
};

/// A part of the body.
const GROUP: Parameter = Parameter {
    name: "group",
    about: "a group of cells or of edges in the mesh",
    unit: "",
    form: Form::Text,
    default: Preset::Absent("the whole body"),
};

/// Whether the mesh has the group of cells or edges.
fn check_group(of: &Values, mesh: &Mesh) -> std::result::Result<(), Fault> {
    let Some(name) = of.maybe_text("group") else { return Ok(()) };
    known_group("group", name, &[("cells", &mesh.groups), ("edges", &mesh.edge_groups)]).map(|_| ())
}

/// The group that an output names, or the whole body.
fn places(of: &Values, to: &Recording) -> Places {
    let degree = to.scheme.operators.degree;
    of.maybe_text("group")
        .map_or_else(|| Places::everywhere(to.mesh, degree), |group| Places::group(group, to.mesh, degree))
}

/// `from` and `to`, or neither; `group` and `axis` belong to an extent.
fn check_length(of: &Values) -> std::result::Result<(), Fault> {
    match (of.has("from"), of.has("to"), of.has("group")) {
        (true, true, false) => fields::two_points(of),
        (false, false, _) => Ok(()),
        (true, true, true) => {
            let what = "a length is a distance of two points or the extent of a group, and here it is both";
            Err(Fault::new("group", what, "remove `group`, or `from` and `to`"))
        }
        (from, ..) => {
            let (given, other) = if from { ("from", "to") } else { ("to", "from") };
            let what = format!("the length has `{given}` and no `{other}`");
            Err(Fault::new(given, what, "give both points, or none for the extent of a group or of the body"))
        }
    }
}

/// Whether the mesh has the groups of edges, with edges on the boundary.
fn check_groups(of: &Values, mesh: &Mesh) -> std::result::Result<(), Fault> {
    let counts = mesh.edge_counts();
    for (k, name) in of.texts("groups").iter().enumerate() {
        let key = format!("groups.{k}");
        let group = known_group(&key, name, &[("boundary edges", &mesh.edge_groups)])?;
        if counts[group].boundary == 0 {
            let what = format!("no edge of \"{name}\" is on the boundary");
            return Err(Fault::new(key, what, "name a group on which a condition acts"));
        }
    }
    Ok(())
}

fn samples(of: &Values, fields: Vec<Field>) -> Samples {
    Samples { ends: [of.vector("from"), of.vector("to")], count: of.integer("samples"), fields }
}

/// The fields that an output shows in a run of these laws: those that it names, or all.
pub fn fields_of(output: &Chosen<Output>, laws: &[Law]) -> Vec<Field> {
    let named = output.values.texts("fields");
    match (output.build().has_fields, named) {
        (false, _) => vec![],
        (true, []) => Field::of_laws(laws),
        (true, named) => {
            let known = known_fields();
            named.iter().filter_map(|name| known.iter().find(|field| field.name() == name)).copied().collect()
        }
    }
}

/// Whether the laws of a run have the fields that an output names.
///
/// # Errors
/// The first field that they lack.
pub fn check_fields(output: &Chosen<Output>, laws: &[Law]) -> std::result::Result<(), Fault> {
    fields::check_field(&output.values, laws)?;
    let fields = fields_of(output, laws);
    match fields.iter().position(|field| !field.is_of(laws)) {
        None => Ok(()),
        Some(k) => {
            let what = format!("no material of the scene has \"{}\"", fields[k].name());
            Err(Fault::new(
                format!("fields.{k}"),
                what,
                format!("remove it, or give a material law = {}", has(fields[k])),
            ))
        }
    }
}
