//! The laws that scenes can name, with their parameters: what a `[[material]]` is checked against.

use super::reader::{Check, NOT_NEGATIVE, POSITIVE};
use super::{Material, Scene};
use crate::material::{J2, LinearElastic, NeoHookean};
use crate::step;

/// A law and its parameters, all required.
#[derive(Debug)]
pub struct Law {
    /// Its name in scenes.
    pub name: &'static str,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// Makes it from its parameters, by name, and rho0 (kg/m^3).
    pub build: Build,
}

impl Law {
    /// It with parameters in the range of all of them.
    pub(super) fn sample(&self) -> step::Law {
        (self.build)(&|_| 0.25, 1.0)
    }

    /// Whether it has internal variables.
    pub fn has_memory(&self) -> bool {
        // What they are does not depend on the parameters.
        self.sample().has_memory()
    }
}

/// Parameters by name and rho0 to a law.
pub type Build = fn(&dyn Fn(&str) -> f64, f64) -> step::Law;

/// A parameter of a law.
#[derive(Debug)]
pub struct Parameter {
    /// Its key in scenes.
    pub name: &'static str,
    /// Its unit, empty for a pure number.
    pub unit: &'static str,
    /// What values it takes.
    pub(super) check: Check,
}

const YOUNG: Parameter = Parameter { name: "young", unit: "Pa", check: POSITIVE };
const POISSON: Parameter = Parameter {
    name: "poisson",
    unit: "",
    check: Check { range: "greater than -1 and less than 0.5", holds: |nu| nu > -1.0 && nu < 0.5 },
};

/// Young's modulus and Poisson's ratio.
const ISOTROPIC: &[Parameter] = &[YOUNG, POISSON];

/// Every law.
pub const LAWS: &[Law] = &[
    Law {
        name: "neo-hookean",
        parameters: ISOTROPIC,
        build: |of, density| step::Law::new(NeoHookean::new(of("young"), of("poisson"), density)),
    },
    Law {
        name: "linear-elastic",
        parameters: ISOTROPIC,
        build: |of, density| step::Law::new(LinearElastic::new(of("young"), of("poisson"), density)),
    },
    Law {
        name: "j2",
        parameters: &[
            YOUNG,
            POISSON,
            Parameter { name: "yield_stress", unit: "Pa", check: POSITIVE },
            Parameter { name: "hardening", unit: "Pa", check: NOT_NEGATIVE },
        ],
        build: |of, density| {
            let (yield_stress, hardening) = (of("yield_stress"), of("hardening"));
            step::Law::new(J2::new(of("young"), of("poisson"), density, yield_stress, hardening))
        },
    },
];

impl Scene {
    /// The laws, in the order of the `[[material]]` tables.
    pub fn laws(&self) -> Vec<step::Law> {
        laws(&self.materials)
    }
}

/// The laws of some materials.
pub(super) fn laws(materials: &[Material]) -> Vec<step::Law> {
    let build = |m: &Material| {
        let parameter = |name: &str| m.parameters.get(name).copied().unwrap_or(f64::NAN);
        let law = LAWS.iter().find(|law| law.name == m.law)?;
        Some((law.build)(&parameter, m.density))
    };
    // Parsing has refused names that the list lacks.
    materials.iter().filter_map(build).collect()
}
