//! `[[output]]`: what is recorded, and when.

use super::reader::Reader;
use super::tables::OUTPUT;
use super::times::{self, Times};
use super::{Material, Output, When};
use crate::error::Result;
use crate::registry::{OUTPUTS, outputs};

/// Reads every `[[output]]` of a body of these materials, in a run from `span[0]` to `span[1]`.
pub(super) fn outputs(
    tables: Vec<Reader>,
    materials: &[Material],
    span: [f64; 2],
    degree: usize,
) -> Result<Vec<Output>> {
    let laws: Vec<_> = materials.iter().map(|material| (material.law.build())(&material.law.values)).collect();
    let mut outputs: Vec<Output> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let output = output(&mut table, span, degree)?;
        outputs::check_fields(&output.what, &laws).map_err(|fault| table.fault(&fault))?;
        let (kind, once) = (output.what.name(), output.what.build().always.is_some());
        if once && outputs.iter().any(|other| other.what.name() == kind) {
            let what = format!("two [[output]] of kind \"{kind}\"");
            return Err(table.wrong("kind", what, format!("one {kind} records all: remove one")));
        }
        if outputs.iter().any(|other| other.name == output.name) {
            let what = format!("two [[output]] have the name \"{}\"", output.name);
            return Err(table.wrong("name", what, "give each a `name` of its own (default: the kind)"));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

fn output(table: &mut Reader, span: [f64; 2], degree: usize) -> Result<Output> {
    let entry = table.entry(&OUTPUT[0], &OUTPUTS)?;
    table.of_kind(entry.name);
    let Times { when, exact } = times::read(table, span)?;
    let what = table.rest_of(entry, degree)?;
    let name = what.values.maybe_text("name").unwrap_or(entry.name).to_owned();
    if !fit_for_a_file(&name) {
        let remedy = "it becomes the name of a file: letters, digits, `_`, `-` and `.`, not a `.` first";
        return Err(table.wrong("name", format!("`name` is \"{name}\""), remedy));
    }
    let default = entry.build.every_steps.map(When::EverySteps);
    let when = when.or(default);
    let when = when.ok_or_else(|| table.missing("at", "a list of times, in s; or every (s), or every_steps"))?;
    Ok(Output { name, what, when, exact_times: exact })
}

/// Whether a name is fit for a file, or for a column of a table.
pub(super) fn fit_for_a_file(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    name.len() <= 100 && !name.starts_with('.') && name.chars().all(plain)
}
