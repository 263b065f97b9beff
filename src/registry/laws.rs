//! The material laws, `[[material]] law = ..`.

use super::{ANY, Check, Entry, Form, NOT_NEGATIVE, POSITIVE, Parameter, Table, Values};
use crate::material::{J2, LinearElastic, NeoHookean, StVenantKirchhoff};
use crate::step::Law;

/// Makes a law from its parameters.
pub type Build = fn(&Values) -> Law;

const DENSITY: Parameter =
    Parameter::required("density", "rho0, in the initial configuration", "kg/m^3", Form::Number(POSITIVE));
const YOUNG: Parameter = Parameter::required("young", "Young's modulus E", "Pa", Form::Number(POSITIVE));
const POISSON: Parameter = Parameter::required(
    "poisson",
    "Poisson's ratio nu",
    "",
    Form::Number(Check { range: "greater than -1 and less than 0.5", holds: |nu| nu > -1.0 && nu < 0.5 }),
);

/// Every law.
pub static LAWS: Table<Build> = Table::new(&[
    Entry {
        name: "neo-hookean",
        about: "compressible neo-Hookean, finite strain, in plane strain",
        parameters: &[YOUNG, POISSON, DENSITY],
        check: ANY,
        build: |of| Law::from(NeoHookean::new(of.number("young"), of.number("poisson"), of.number("density"))),
    },
    Entry {
        name: "linear-elastic",
        about: "linear elastic, small strain",
        parameters: &[YOUNG, POISSON, DENSITY],
        check: ANY,
        build: |of| Law::from(LinearElastic::new(of.number("young"), of.number("poisson"), of.number("density"))),
    },
    Entry {
        name: "st-venant-kirchhoff",
        about: "St. Venant-Kirchhoff, Hooke's law in Green's strain; stiffens in tension, loses hyperbolicity in compression",
        parameters: &[YOUNG, POISSON, DENSITY],
        check: ANY,
        build: |of| Law::from(StVenantKirchhoff::new(of.number("young"), of.number("poisson"), of.number("density"))),
    },
    #[cfg(feature = "effect-memory")]
    Entry {
        name: "j2",
        about: J2::ABOUT,
        parameters: &[
            YOUNG,
            POISSON,
            DENSITY,
            Parameter::required("yield_stress", "the stress sigma_y of the first yield", "Pa", Form::Number(POSITIVE)),
            Parameter::required(
                "hardening",
                "H: the yield stress grows with the strain p of the flow as sigma_y + H p; 0: it does not grow",
                "Pa",
                Form::Number(NOT_NEGATIVE),
            ),
        ],
        check: ANY,
        build: |of| {
            let [young, poisson, density] = ["young", "poisson", "density"].map(|name| of.number(name));
            Law::from(J2::new(young, poisson, density, of.number("yield_stress"), of.number("hardening")))
        },
    },
]);

/// Whether a body of the law is nearly incompressible: (c_p/c_s)^2 above 11, Poisson's ratio above .45.
pub fn is_soft(law: &super::Chosen<Build>) -> bool {
    let [larger, smaller] = (law.build())(&law.values).moduli([1.0, 0.0, 0.0, 1.0], [1.0, 0.0]);
    larger > 11.001 * smaller
}

/// Whether a law has internal variables.
pub fn has_memory(entry: &Entry<Build>) -> bool {
    // What they are does not depend on the parameters.
    (entry.build)(&super::example(entry.parameters)).has_memory()
}
