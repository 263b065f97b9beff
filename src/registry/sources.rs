//! The forces on the volume, `[[source]] kind = ..`.

use super::{ANY, Entry, Fault, Form, Parameter, Table, Values};
use crate::source::{BodyForce, Source};
use std::sync::Arc;

/// Makes a source from its parameters, in the cells of the law of a number, or everywhere.
pub type Build = fn(&Values, Option<usize>) -> Arc<dyn Source>;

const VALUE: Parameter = Parameter::required("value", "the body force", "m/s^2", Form::Expressions(2));

/// Every source.
pub static SOURCES: Table<Build> = Table::new(&[
    Entry {
        name: "body-force",
        about: "force per unit mass, which may depend on place and time",
        parameters: &[VALUE],
        check: ANY,
        build: |of, material| Arc::new(BodyForce { value: of.pair("value"), material }),
    },
    Entry {
        name: "gravity",
        about: "constant force per unit mass",
        parameters: &[VALUE],
        check: |of| match of.expressions("value").iter().position(|value| value.constant().is_none()) {
            None => Ok(()),
            Some(k) => Err(Fault::new(
                format!("value.{k}"),
                "gravity depends on x, y or t",
                "gravity is constant; kind = \"body-force\" takes expressions",
            )),
        },
        build: |of, material| Arc::new(BodyForce { value: of.pair("value"), material }),
    },
]);
