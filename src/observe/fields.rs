//! The registry of output fields: names, components and values at a point.

use super::Point;
use crate::material::{Law, cauchy};
use crate::tensor;

/// A field that outputs can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// v, m/s.
    Velocity,
    /// u, m.
    Displacement,
    /// F.
    Deformation,
    /// P, Pa.
    Piola,
    /// sigma = P F^T / J, Pa.
    CauchyStress,
    /// J = det F.
    Jacobian,
    /// Von Mises equivalent of sigma (with sigma33), Pa.
    VonMises,
}

/// All fields with their names and the suffixes of their components.
pub const FIELDS: [(Field, &str, &[&str]); 7] = [
    (Field::Velocity, "velocity", &["_1", "_2"]),
    (Field::Displacement, "displacement", &["_1", "_2"]),
    (Field::Deformation, "deformation", &["_11", "_12", "_21", "_22"]),
    (Field::Piola, "piola", &["_11", "_12", "_21", "_22", "_33"]),
    (Field::CauchyStress, "cauchy_stress", &["_11", "_12", "_22", "_33"]),
    (Field::Jacobian, "jacobian", &[""]),
    (Field::VonMises, "von_mises", &[""]),
];

impl Field {
    /// The field of a name.
    pub fn of(name: &str) -> Option<Field> {
        FIELDS.iter().find(|(_, known, _)| *known == name).map(|(field, _, _)| *field)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        FIELDS.iter().find(|(field, _, _)| *field == self).map_or("", |(_, name, _)| name)
    }

    /// Names of its components, such as `cauchy_stress_11`.
    pub fn components(self) -> impl Iterator<Item = String> {
        let entry = FIELDS.iter().find(|(field, _, _)| *field == self);
        entry.into_iter().flat_map(|(_, name, suffixes)| suffixes.iter().map(move |s| format!("{name}{s}")))
    }

    /// Appends its components at a point.
    pub fn push(self, law: &Law, at: &Point, out: &mut Vec<f64>) {
        match self {
            Field::Velocity => out.extend(at.velocity),
            Field::Displacement => out.extend(at.displacement),
            Field::Deformation => out.extend(at.deformation),
            Field::Piola => {
                out.extend(law.stress(at.deformation));
                out.push(law.stress33(at.deformation));
            }
            Field::CauchyStress => out.extend(stress(law, at)),
            Field::Jacobian => out.push(tensor::det(at.deformation)),
            Field::VonMises => out.push(von_mises(stress(law, at))),
        }
    }
}

/// Cauchy stress [11, 12, 22, 33], Pa.
fn stress(law: &Law, at: &Point) -> [f64; 4] {
    cauchy(at.deformation, law.stress(at.deformation), law.stress33(at.deformation))
}

/// sqrt(3/2 s:s) of the deviator of [s11, s12, s22, s33].
fn von_mises(s: [f64; 4]) -> f64 {
    let squares = (s[0] - s[2]).powi(2) + (s[2] - s[3]).powi(2) + (s[3] - s[0]).powi(2);
    (0.5 * squares + 3.0 * s[1] * s[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_of_uniaxial_stress_and_of_pressure() {
        assert_eq!(von_mises([3.0, 0.0, 0.0, 0.0]), 3.0);
        assert_eq!(von_mises([2.0, 0.0, 2.0, 2.0]), 0.0);
        // Pure shear: sqrt(3) tau; one rounding of the root.
        assert!((von_mises([0.0, 1.0, 0.0, 0.0]) - 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn every_field_has_its_name_back_and_as_many_components_as_values() {
        let law = Law::NeoHookean(crate::material::NeoHookean::new(1.0, 0.3, 1.0));
        let at = Point { deformation: [1.1, 0.1, 0.0, 0.9], velocity: [1.0, 2.0], displacement: [0.0; 2] };
        for (field, name, _) in FIELDS {
            assert_eq!(Field::of(name), Some(field));
            let mut values = Vec::new();
            field.push(&law, &at, &mut values);
            assert_eq!(values.len(), field.components().count(), "{name}");
        }
    }
}
