//! The registry of output fields: names, components and values at a point.

use super::Point;
use crate::io::grid::Kind;
use crate::material::{Law, cauchy};
use crate::tensor;

names! {
    /// A field that outputs can name.
    Field {
        /// v, m/s.
        Velocity = "velocity",
        /// u = x - X, m.
        Displacement = "displacement",
        /// F.
        Deformation = "deformation",
        /// First Piola-Kirchhoff stress P, Pa.
        Piola = "piola",
        /// sigma = P F^T / J, Pa.
        CauchyStress = "cauchy_stress",
        /// J = det F.
        Jacobian = "jacobian",
        /// Von Mises equivalent of sigma (with sigma33), Pa.
        VonMises = "von_mises",
        /// Cumulated plastic strain p.
        PlasticStrain = "plastic_strain",
        /// Cp^-1.
        InversePlasticMetric = "inverse_plastic_metric",
    }
}

impl Field {
    /// The field with this name.
    pub fn of(name: &str) -> Option<Field> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, field)| *field)
    }

    /// The internal variables that the field shows, each with the value for laws that do not have it. Empty for other
    /// fields.
    fn variables(self) -> &'static [(&'static str, f64)] {
        match self {
            Field::PlasticStrain => &[("plastic_strain", 0.0)],
            Field::InversePlasticMetric => &[
                ("inverse_plastic_metric_11", 1.0),
                ("inverse_plastic_metric_12", 0.0),
                ("inverse_plastic_metric_22", 1.0),
                ("inverse_plastic_metric_33", 1.0),
            ],
            _ => &[],
        }
    }

    /// Whether the field shows internal variables.
    pub fn is_internal(self) -> bool {
        !self.variables().is_empty()
    }

    /// Whether a body of these laws has the field: internal variables need a law that has them.
    pub fn is_of(self, laws: &[Law]) -> bool {
        let has = |name: &str| laws.iter().any(|law| law.internal().contains(&name));
        self.variables().iter().all(|(name, _)| has(name))
    }

    /// Suffixes of its components.
    fn suffixes(self) -> &'static [&'static str] {
        match self {
            Field::Velocity | Field::Displacement => &["_1", "_2"],
            Field::Deformation => &["_11", "_12", "_21", "_22"],
            Field::Piola => &["_11", "_12", "_21", "_22", "_33"],
            Field::CauchyStress | Field::InversePlasticMetric => &["_11", "_12", "_22", "_33"],
            Field::Jacobian | Field::VonMises | Field::PlasticStrain => &[""],
        }
    }

    /// Names of its components, such as `cauchy_stress_11`.
    pub fn components(self) -> impl Iterator<Item = String> {
        self.suffixes().iter().map(move |suffix| format!("{}{suffix}", self.name()))
    }

    /// Whether an export writes the field as a scalar, vector or tensor.
    pub fn kind(self) -> Kind {
        match self {
            Field::Velocity | Field::Displacement => Kind::Vector,
            Field::Deformation | Field::Piola | Field::CauchyStress | Field::InversePlasticMetric => Kind::Tensor,
            Field::Jacobian | Field::VonMises | Field::PlasticStrain => Kind::Scalar,
        }
    }

    /// Appends the value of the field for an export: vectors in space, tensors row by row with their third direction.
    pub fn push_spatial(self, law: &Law, at: &Point, out: &mut Vec<f64>) {
        let mut plane = Vec::with_capacity(5);
        self.push(law, at, &mut plane);
        match (self, &plane[..]) {
            (Field::CauchyStress | Field::InversePlasticMetric, &[s11, s12, s22, s33]) => {
                out.extend(spatial([s11, s12, s12, s22], s33))
            }
            (Field::Piola, &[p11, p12, p21, p22, p33]) => out.extend(spatial([p11, p12, p21, p22], p33)),
            (Field::Deformation, &[f11, f12, f21, f22]) => out.extend(spatial([f11, f12, f21, f22], 1.0)),
            (Field::Velocity | Field::Displacement, &[x, y]) => out.extend([x, y, 0.0]),
            (_, values) => out.extend_from_slice(values),
        }
    }

    /// Appends the components of the field at a point.
    pub fn push(self, law: &Law, at: &Point, out: &mut Vec<f64>) {
        match self {
            Field::Velocity => out.extend(at.velocity),
            Field::Displacement => out.extend(at.displacement),
            Field::Deformation => out.extend(at.deformation),
            Field::Piola => {
                let response = at.response(law);
                out.extend(response.piola);
                out.push(response.piola33);
            }
            Field::CauchyStress => out.extend(stress(law, at)),
            Field::Jacobian => out.push(tensor::det(at.deformation)),
            Field::VonMises => out.push(von_mises(stress(law, at))),
            Field::PlasticStrain | Field::InversePlasticMetric => {
                let position = |name: &str| law.internal().iter().position(|known| *known == name);
                let value = |&(name, other): &(&str, f64)| position(name).map_or(other, |k| at.internal[k]);
                out.extend(self.variables().iter().map(value));
            }
        }
    }
}

/// A tensor row by row, with the third direction of plane strain.
fn spatial(t: [f64; 4], t33: f64) -> [f64; 9] {
    [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, t33]
}

/// Cauchy stress [11, 12, 22, 33], Pa.
fn stress(law: &Law, at: &Point) -> [f64; 4] {
    let response = at.response(law);
    cauchy(at.deformation, response.piola, response.piola33)
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
        let elastic = Law::NeoHookean(crate::material::NeoHookean::new(1.0, 0.3, 1.0));
        let plastic = Law::J2(crate::material::J2::new(1.0, 0.3, 1.0, 0.01, 0.1));
        let (deformation, internal) = ([1.1, 0.1, 0.0, 0.9], [1.1, 0.8, 0.1, 1.2, 0.3]);
        let at = Point { deformation, velocity: [1.0, 2.0], displacement: [0.0; 2], internal };
        for (&(name, field), law) in Field::NAMES.iter().flat_map(|pair| [(pair, &elastic), (pair, &plastic)]) {
            assert_eq!(Field::of(name), Some(field));
            let mut values = Vec::new();
            field.push(law, &at, &mut values);
            assert_eq!(values.len(), field.components().count(), "{name}");
            let mut spatial = Vec::new();
            field.push_spatial(law, &at, &mut spatial);
            assert_eq!(spatial.len(), field.kind().components(), "{name}");
        }
        let of = |law: &Law, field: Field| {
            let mut values = Vec::new();
            field.push(law, &at, &mut values);
            values
        };
        assert_eq!(of(&plastic, Field::InversePlasticMetric), [1.1, 0.1, 0.8, 1.2]);
        assert_eq!([of(&plastic, Field::PlasticStrain), of(&elastic, Field::PlasticStrain)], [[0.3], [0.0]]);
        assert_eq!(of(&elastic, Field::InversePlasticMetric), [1.0, 0.0, 1.0, 1.0]);
        assert!(
            !Field::PlasticStrain.is_of(std::slice::from_ref(&elastic))
                && Field::PlasticStrain.is_of(&[elastic, plastic])
        );
    }
}
