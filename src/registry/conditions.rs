//! The conditions on groups of boundary edges, `[[boundary]] kind = ..`.

use super::{ANY, Entry, Fault, Form, NOT_NEGATIVE, POSITIVE, Parameter, Preset, Table, Values};
use crate::boundary::{Absorbing, Boundary, Free, Traction, Velocity, Wall};
use crate::contact::{Cohesive, Interaction, Paired, Sliding};
use crate::expression::Expression;
use std::sync::Arc;

/// What there is to know of a condition.
pub struct Condition {
    /// Makes it from its parameters.
    pub make: fn(&Values) -> Arc<dyn Boundary>,
    /// The parameter that names another group: the faces of both are joined and are inner faces then, or, with an interaction, act on
    /// each other.
    pub partner: Option<&'static str>,
    /// Makes what acts between the faces of the group and those of its partner (or of the group itself).
    pub interaction: Option<fn(&Values) -> Arc<dyn Interaction>>,
}

impl Condition {
    /// A condition that knows of its own faces only.
    pub const fn of(make: fn(&Values) -> Arc<dyn Boundary>) -> Self {
        Self { make, partner: None, interaction: None }
    }

    /// What acts between faces.
    const fn between(
        make: fn(&Values) -> Arc<dyn Boundary>,
        interaction: fn(&Values) -> Arc<dyn Interaction>,
        partner: Option<&'static str>,
    ) -> Self {
        Self { make, partner, interaction: Some(interaction) }
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
    Entry {
        name: "contact",
        about: "contact with the faces of another group, or of its own: they press on each other where they touch, and part freely",
        parameters: &[
            Parameter {
                name: "partner",
                about: "the group of the other body, such as \"right\"; it needs no [[boundary]] of its own",
                unit: "",
                form: Form::Text,
                default: Preset::Absent("the group itself: the two sides of a crack, a body that folds"),
            },
            Parameter::new(
                "friction",
                "the coefficient of Coulomb friction",
                "",
                Form::Number(NOT_NEGATIVE),
                Preset::Number(0.0),
            ),
        ],
        check: ANY,
        build: Condition::between(|of| Arc::new(Paired(sliding(of))), sliding, Some("partner")),
    },
    Entry {
        name: "cohesive",
        about: "a cut inside of the body that takes energy to open: a bilinear law of traction and opening",
        parameters: &[
            Parameter::required("strength", "the largest traction", "Pa", Form::Number(POSITIVE)),
            Parameter::required(
                "energy",
                "the energy that takes to break it, per area",
                "J/m^2",
                Form::Number(POSITIVE),
            ),
            Parameter {
                name: "stiffness",
                about: "traction over opening before damage",
                unit: "Pa/m",
                form: Form::Number(POSITIVE),
                default: Preset::Absent("50 strength^2/energy: damage begins at 1 % of the opening where it is broken"),
            },
        ],
        check: |of| {
            let [strength, energy] = ["strength", "energy"].map(|name| of.number(name));
            match of.maybe("stiffness") {
                Some(stiffness) if 2.0 * energy * stiffness <= strength * strength => Err(Fault::new(
                    "stiffness",
                    format!(
                        "a stiffness of {stiffness} Pa/m lets it store more than its energy before the strength is reached"
                    ),
                    format!("give more than strength^2/(2 energy) = {} Pa/m", strength * strength / (2.0 * energy)),
                )),
                _ => Ok(()),
            }
        },
        build: Condition::between(|of| Arc::new(Paired(cohesive(of))), cohesive, None),
    },
]);

fn sliding(of: &Values) -> Arc<dyn Interaction> {
    Arc::new(Sliding { friction: of.number("friction") })
}

fn cohesive(of: &Values) -> Arc<dyn Interaction> {
    let [strength, energy] = ["strength", "energy"].map(|name| of.number(name));
    let stiffness = of.maybe("stiffness").unwrap_or(50.0 * strength * strength / energy);
    Arc::new(Cohesive { strength, energy, stiffness })
}
