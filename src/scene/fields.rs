//! The keys of `[initial]` that take the start from fields at the nodes of a mesh of another program.

use super::reader::Reader;
use super::tables::key;
use crate::error::Result;
use crate::registry::{FINITE, Form, Parameter, Preset};
use serde::Serialize;
use std::path::PathBuf;

/// Fields at the nodes of a mesh of another program that a run starts from. Names are none where the usual ones are looked for.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Fields {
    /// The file, as written in the scene.
    pub path: PathBuf,
    /// The name of v.
    pub velocity: Option<String>,
    /// The name of u.
    pub displacement: Option<String>,
    /// The name of F.
    pub deformation: Option<String>,
    /// The time of a series, in s; none: the last.
    pub time: Option<f64>,
}

pub(super) const FILE: Parameter = key(
    "fields",
    "a VTU or XDMF file of another program with velocity, and displacement or deformation, at the nodes of its quadrilaterals",
    "",
    Form::Text,
    Preset::Absent("none"),
);
pub(super) const VELOCITY: Parameter = key(
    "velocity_field",
    "the name of the velocity in this file",
    "",
    Form::Text,
    Preset::Absent("\"velocity\", if it is there and no `velocity` here"),
);
pub(super) const DISPLACEMENT: Parameter = key(
    "displacement_field",
    "the name of the displacement in this file: F is I + its gradient",
    "",
    Form::Text,
    Preset::Absent("\"displacement\", if it is there and no `deformation`"),
);
pub(super) const DEFORMATION: Parameter = key(
    "deformation_field",
    "the name of F in this file, 4 or 9 numbers row by row",
    "",
    Form::Text,
    Preset::Absent("\"deformation\", if it is there and no `deformation` here"),
);
pub(super) const TIME: Parameter = key(
    "fields_time",
    "the time in this file that is taken, of an XDMF series",
    "s",
    Form::Number(FINITE),
    Preset::Absent("the last one"),
);

/// What takes the place of what: a key, and those that cannot stand beside it.
const INSTEAD: [(&str, &[&str]); 3] = [
    ("velocity", &["velocity_field"]),
    ("deformation", &["deformation_field", "displacement_field"]),
    ("deformation_field", &["displacement_field"]),
];

/// The keys that say what of the file is taken.
pub(super) const NAMES: [&str; 4] = ["velocity_field", "displacement_field", "deformation_field", "fields_time"];

/// Reads them; none where there is no file.
pub(super) fn read(table: &mut Reader) -> Result<Option<Fields>> {
    let values = table.values(&[FILE, VELOCITY, DISPLACEMENT, DEFORMATION, TIME])?;
    let Some(path) = values.maybe_text("fields") else {
        return match NAMES.into_iter().find(|key| table.has(key)) {
            None => Ok(None),
            Some(key) => {
                let what = format!("`{key}` says what is taken from a file, and there is no `fields`");
                Err(table.wrong(key, what, "give fields = \"before.vtu\", or remove this key"))
            }
        };
    };
    for (key, others) in INSTEAD {
        if let Some(other) = others.iter().find(|other| table.has(key) && table.has(other)) {
            return Err(table.wrong(other, format!("[initial] has both `{key}` and `{other}`"), "keep one of them"));
        }
    }
    let text = |key: &str| values.maybe_text(key).map(str::to_owned);
    Ok(Some(Fields {
        path: PathBuf::from(path),
        velocity: text("velocity_field"),
        displacement: text("displacement_field"),
        deformation: text("deformation_field"),
        time: values.maybe("fields_time"),
    }))
}
