//! What is recorded, `[[output]] kind = ..`.

use super::{ANY, Chosen, Entry, FINITE, Fault, Field, Form, Parameter, Preset, Table, Value, Values};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::observe::{Contents, Ledger, Line, Observer, Outside, Samples, Schedule, Snapshots};
use crate::run::Folder;
use crate::step::Law;

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
    /// Whether the mesh has what it records.
    pub check: fn(&Values, &Mesh) -> std::result::Result<(), Fault>,
    /// Makes its observer.
    pub make: fn(&Values, Recording) -> Result<Box<dyn Observer>>,
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
    /// The law of each cell.
    pub material: &'a [usize],
    /// The folder of the run.
    pub folder: &'a Folder,
    /// What a ledger of the run has beside its first columns.
    pub contents: Contents,
}

/// The fields of every body, and the variables of all laws.
pub(super) fn known_fields() -> Vec<Field> {
    let laws: Vec<Law> = super::LAWS.iter().map(|entry| (entry.build)(&super::example(entry.parameters))).collect();
    Field::of_laws(&laws)
}

pub(super) fn field_names() -> Vec<&'static str> {
    known_fields().into_iter().map(Field::name).collect()
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
        about: "snapshots, for `dgmpm export`",
        parameters: &[named(Preset::Absent("the kind")), fields(Preset::Absent("all"))],
        check: ANY,
        build: Output {
            has_fields: true,
            snapshots: true,
            every_steps: None,
            always: None,
            displacement: |_| false,
            check: |_, _| Ok(()),
            make: |_, of| Ok(Box::new(Snapshots::new(&of.folder.snapshots(), of.schedule))),
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
            snapshots: false,
            every_steps: None,
            always: None,
            displacement: |_| false,
            check: |of, mesh| {
                samples(of, vec![]).check(mesh).map_err(|outside| {
                    let key = if outside.sample == 0 { "from" } else { "to" };
                    Fault::new(key, outside.to_string(), Outside::REMEDY)
                })
            },
            make: |of, Recording { name, fields, schedule, mesh, material, folder, .. }| {
                Ok(Box::new(Line::create(&folder.line(name), mesh, material, &samples(of, fields), schedule)?))
            },
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
            has_fields: false,
            snapshots: false,
            every_steps: Some(1),
            always: Some(|defaults| {
                defaults.set("balance", Value::Boolean(false));
                10
            }),
            // For the angular momentum.
            displacement: |of| of.boolean("balance"),
            check: |_, _| Ok(()),
            make: |of, Recording { schedule, folder, contents, .. }| {
                let contents = Contents { balance: of.boolean("balance"), ..contents };
                Ok(Box::new(Ledger::create(&folder.ledger(), schedule.with_end(), contents)?))
            },
        },
    },
]);

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

/// The names of the laws that have a field.
pub(super) fn has(field: Field) -> String {
    let of = |entry: &&Entry<super::laws::Build>| {
        let law = (entry.build)(&super::example(entry.parameters));
        field.is_of(&[law])
    };
    let names: Vec<&str> = super::LAWS.iter().filter(of).map(|entry| entry.name).collect();
    super::quoted(&names)
}
