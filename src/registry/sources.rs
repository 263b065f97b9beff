//! The forces on the volume, `[[source]] kind = ..`.

use super::{ANY, Entry, FINITE, Fault, Form, POSITIVE, Parameter, Table, Values};
use crate::expression::Expression;
use crate::source::{BodyForce, Damping, PressurePulse, Source, Varies};
use std::sync::Arc;

/// Makes a source from its parameters, in the cells of the law of a number, or everywhere.
pub type Build = fn(&Values, Option<usize>) -> Arc<dyn Source>;

const VALUE: Parameter = Parameter::required("value", "the body force", "m/s^2", Form::Expressions(2));

const RATE: Parameter = Parameter::required("rate", "alpha in b = -alpha v", "1/s", Form::Number(POSITIVE));

const PULSE: &[Parameter] = &[
    Parameter::required("amplitude", "the largest pressure, in the middle", "Pa", Form::Number(FINITE)),
    Parameter::required("centre", "the middle, in reference coordinates", "m", Form::Vector(FINITE)),
    Parameter::required(
        "radius",
        "the pressure is 0 beyond this distance from the middle",
        "m",
        Form::Number(POSITIVE),
    ),
    Parameter::required("duration", "how long it acts; it is largest half-way", "s", Form::Number(POSITIVE)),
    Parameter::required("density", "rho0 of the cells there", "kg/m^3", Form::Number(POSITIVE)),
    Parameter::number("start", "when it begins", "s", FINITE, 0.0),
];

/// A force by two expressions, which know what they vary with.
fn body_force(of: &Values, material: Option<usize>) -> Arc<dyn Source> {
    let all = of.expressions("value");
    let varies = Varies {
        place: all.iter().any(Expression::depends_on_place),
        time: all.iter().any(Expression::depends_on_time),
        velocity: false,
    };
    Arc::new(BodyForce { value: of.pair("value"), varies, material })
}

/// Every source.
pub static SOURCES: Table<Build> = Table::new(&[
    Entry {
        name: "body-force",
        about: "force per unit mass, which may depend on place and time",
        parameters: &[VALUE],
        check: ANY,
        build: body_force,
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
        build: body_force,
    },
    Entry {
        name: "damping",
        about: "damping in proportion to mass: b = -alpha v",
        parameters: &[RATE],
        check: ANY,
        build: |of, material| Arc::new(Damping { rate: of.number("rate"), share: None, material }),
    },
    Entry {
        name: "sponge",
        about: "layer that takes up waves: damping that rises smoothly over some cells towards an edge, b = -alpha s v",
        parameters: &[
            RATE,
            Parameter::required(
                "region",
                "the share s of the rate, cut to 0..1, such as \"((x - 2)/0.5)^2*step(x - 2)\"",
                "",
                Form::Expression,
            ),
        ],
        check: ANY,
        build: |of, material| Arc::new(Damping { rate: of.number("rate"), share: Some(of.data("region")), material }),
    },
    Entry {
        name: "pressure-pulse",
        about: "smooth pulse of pressure p = A (1 - q^2)^3 sin^2(pi s) in a disc, q = r/radius, s = (t - start)/duration: b = -grad p/rho0",
        parameters: PULSE,
        check: ANY,
        build: |of, material| {
            Arc::new(PressurePulse {
                amplitude: of.number("amplitude"),
                centre: of.vector("centre"),
                radius: of.number("radius"),
                start: of.number("start"),
                duration: of.number("duration"),
                density: of.number("density"),
                material,
            })
        },
    },
]);
