//! The conditions on groups of boundary edges, `[[boundary]] kind = ..`.

use super::{ANY, Entry, Form, Parameter, Preset, Table, Values};
use crate::boundary::{Absorbing, Boundary, Free, Traction, Velocity, Wall};
use crate::expression::Expression;
use std::sync::Arc;

/// What there is to know of a condition.
pub struct Condition {
    /// Makes it from its parameters.
    pub make: fn(&Values) -> Arc<dyn Boundary>,
    /// The parameter that names another group, where the faces of both are joined: they are inner faces then.
    pub partner: Option<&'static str>,
}

impl Condition {
    const fn of(make: fn(&Values) -> Arc<dyn Boundary>) -> Self {
        Self { make, partner: None }
    }
}

/// Every condition. What is said of an expression that is not finite begins with the line that describes its parameter.
pub static CONDITIONS: Table<Condition> = Table::new(&[
    Entry {
        name: "wall",
        about: "rigid wall without friction, bilateral: it never opens; `speed` moves it along the outward normal",
        parameters: &[Parameter::new(
            "speed",
            "the speed of the wall",
            "m/s",
            Form::Expression,
            Preset::Constant(&[0.0]),
        )],
        check: ANY,
        build: Condition::of(|of| {
            let at_rest = of.expression("speed").and_then(Expression::constant) == Some(0.0);
            Arc::new(Wall { speed: (!at_rest).then(|| of.data("speed")) })
        }),
    },
    Entry {
        name: "symmetry",
        about: "line of symmetry: a wall at rest",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Wall { speed: None })),
    },
    Entry { name: "free", about: "no traction", parameters: &[], check: ANY, build: Condition::of(|_| Arc::new(Free)) },
    Entry {
        name: "clamped",
        about: "no velocity",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Velocity { value: [Arc::new(|_, _| 0.0), Arc::new(|_, _| 0.0)] })),
    },
    Entry {
        name: "velocity",
        about: "prescribed velocity",
        parameters: &[Parameter::required("value", "the velocity of the boundary", "m/s", Form::Expressions(2))],
        check: ANY,
        build: Condition::of(|of| Arc::new(Velocity { value: of.pair("value") })),
    },
    Entry {
        name: "traction",
        about: "prescribed traction P N, per area of the initial configuration",
        parameters: &[Parameter::required("value", "the traction on the boundary", "Pa", Form::Expressions(2))],
        check: ANY,
        build: Condition::of(|of| Arc::new(Traction { value: of.pair("value") })),
    },
    Entry {
        name: "absorbing",
        about: "nothing comes in, and plane waves go out",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Absorbing)),
    },
    Entry {
        name: "periodic",
        about: "the body continues at another group, which is this one moved",
        parameters: &[Parameter::required(
            "partner",
            "the group at the other side of the body, such as \"right\"; it needs no [[boundary]] of its own",
            "",
            Form::Text,
        )],
        check: ANY,
        // The faces are inner faces: nothing asks for their condition.
        build: Condition { partner: Some("partner"), ..Condition::of(|_| Arc::new(Free)) },
    },
]);
