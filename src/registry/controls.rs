//! The controls of the part of F that is no gradient, `[curl] control = ..`.

use super::{ANY, Entry, Form, POSITIVE, Parameter, Preset, Table};
use crate::step::Relax;

/// What there is to know of a control.
pub struct Control {
    /// What of the curl it relaxes; none: nothing.
    pub relax: Option<Relax>,
    /// What a run is told that has it; empty: nothing.
    pub notice: &'static str,
    /// What may help a run that lost stability with it; empty: nothing.
    pub when_lost: &'static str,
}

/// The control of a scene that names none.
pub const DEFAULT: &str = "rotation";

/// The rate over N, where the scene gives none.
const ALPHA: Parameter = Parameter::new(
    "alpha",
    "rate of the control, times the degree N",
    "",
    Form::Number(POSITIVE),
    Preset::ByDegree("3, from degree 4 on 6", |degree| if degree >= 4 { 6.0 } else { 3.0 }),
);

/// Every control.
pub static CONTROLS: Table<Control> = Table::new(&[
    Entry {
        name: "rotation",
        about: "relaxes the rotation and the deviator of the part that is no gradient, at a rate tied to compression",
        parameters: &[ALPHA],
        check: ANY,
        build: Control { relax: Some(Relax::Rotation), notice: "", when_lost: "" },
    },
    Entry {
        name: "lcf",
        about: "locally curl-free: projects F in each cell onto gradients; makes energy on thin, soft and flowing bodies",
        parameters: &[ALPHA],
        check: ANY,
        build: Control {
            relax: Some(Relax::Gradient),
            notice: "[curl] control = \"lcf\" makes energy on free, thin, soft and flowing bodies; it is there for \
                     comparison, the default is \"rotation\"",
            when_lost: "",
        },
    },
    Entry {
        name: "off",
        about: "no control",
        parameters: &[],
        check: ANY,
        build: Control {
            relax: None,
            notice: "",
            when_lost: "[curl] control is \"off\", and a body in compression is then unstable: leave it out",
        },
    },
]);
