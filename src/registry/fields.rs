//! Fields, their components, places, groups: what outputs and quantities name alike.

use super::{Entry, Fault, Field, Form, Parameter, Preset, Values, quoted};
use crate::names::did_you_mean;
use crate::quantity::{Component, Outside};
use crate::step::Law;

/// The fields of every body, and the variables of all laws.
pub(super) fn known_fields() -> Vec<Field> {
    let laws: Vec<Law> = super::LAWS.iter().map(|entry| (entry.build)(&super::example(entry.parameters))).collect();
    Field::of_laws(&laws)
}

pub(super) fn field_names() -> Vec<&'static str> {
    known_fields().into_iter().map(Field::name).collect()
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

/// x and y.
const AXES: [&str; 2] = ["x", "y"];

pub(super) const AXIS: Parameter =
    Parameter::new("axis", "the direction", "", Form::Name(|| AXES.to_vec(), &[]), Preset::Name("x"));

pub(super) const fn field(default: Preset) -> Parameter {
    Parameter { name: "field", about: "the field", unit: "", form: Form::Name(field_names, &[]), default }
}

pub(super) const COMPONENT: Parameter = Parameter::new(
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

pub(super) fn axis(of: &Values) -> usize {
    usize::from(of.text("axis") == AXES[1])
}

pub(super) fn ends(of: &Values) -> [[f64; 2]; 2] {
    [of.vector("from"), of.vector("to")]
}

/// A fault of places at their keys.
pub(super) fn place<T>(found: Result<T, Outside>, keys: [&str; 2]) -> Result<(), Fault> {
    found.map(|_| ()).map_err(|outside| Fault::new(outside.key(keys), outside.to_string(), Outside::REMEDY))
}

/// `from` and `to` are two points.
pub(super) fn two_points(of: &Values) -> Result<(), Fault> {
    let [from, to] = ends(of);
    match from == to {
        true => Err(Fault::new("to", "`from` and `to` are the same point", "give two points")),
        false => Ok(()),
    }
}

/// The number of a group that a key names, in the first of some lists that has it.
pub(super) fn known_group(key: &str, name: &str, lists: &[(&str, &[String])]) -> Result<usize, Fault> {
    let number = |(_, groups): &(&str, &[String])| groups.iter().position(|known| *known == name);
    lists.iter().find_map(number).ok_or_else(|| {
        let known: Vec<&str> = lists.iter().flat_map(|(_, groups)| groups.iter().map(String::as_str)).collect();
        let words: Vec<String> =
            lists.iter().map(|(of, groups)| format!("its groups of {of} are {}", groups.join(", "))).collect();
        Fault::new(key, format!("the mesh has no group \"{name}\""), did_you_mean(name, &known) + &words.join("; "))
    })
}

/// The field that a quantity names, where it has one.
pub(super) fn field_of(of: &Values) -> Option<Field> {
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
pub(super) fn component(of: &Values) -> Component {
    maybe_component(of).unwrap_or_default()
}

/// Whether the field has the component.
pub(super) fn check_component(of: &Values) -> Result<(), Fault> {
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

pub(super) fn unit_of_field(of: &Values) -> &'static str {
    field_of(of).map_or("", Component::unit)
}

pub(super) fn shows_displacement(of: &Values) -> bool {
    field_of(of) == Some(Field::Displacement)
}

/// Whether the laws of a run have the field that a quantity or an output names.
///
/// # Errors
/// A field that they lack.
pub fn check_field(values: &Values, laws: &[Law]) -> Result<(), Fault> {
    match field_of(values).filter(|field| !field.is_of(laws)) {
        None => Ok(()),
        Some(field) => {
            let what = format!("no material of the scene has \"{}\"", field.name());
            Err(Fault::new("field", what, format!("give another field, or a material law = {}", has(field))))
        }
    }
}
