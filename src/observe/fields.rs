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
    }
}

impl Field {
    /// The field of a name.
    pub fn of(name: &str) -> Option<Field> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, field)| *field)
    }

    /// Suffixes of its components.
    fn suffixes(self) -> &'static [&'static str] {
        match self {
            Field::Velocity | Field::Displacement => &["_1", "_2"],
            Field::Deformation => &["_11", "_12", "_21", "_22"],
            Field::Piola => &["_11", "_12", "_21", "_22", "_33"],
            Field::CauchyStress => &["_11", "_12", "_22", "_33"],
            Field::Jacobian | Field::VonMises => &[""],
        }
    }

    /// Names of its components, such as `cauchy_stress_11`.
    pub fn components(self) -> impl Iterator<Item = String> {
        self.suffixes().iter().map(move |suffix| format!("{}{suffix}", self.name()))
    }

    /// How many directions it has: what an export makes of it.
    pub fn kind(self) -> Kind {
        match self {
            Field::Velocity | Field::Displacement => Kind::Vector,
            Field::Deformation | Field::Piola | Field::CauchyStress => Kind::Tensor,
            Field::Jacobian | Field::VonMises => Kind::Scalar,
        }
    }

    /// Appends it as an export has it: vectors in space, tensors row by row with their third direction.
    pub fn push_spatial(self, law: &Law, at: &Point, out: &mut Vec<f64>) {
        let mut plane = Vec::with_capacity(5);
        self.push(law, at, &mut plane);
        match (self, &plane[..]) {
            (Field::CauchyStress, &[s11, s12, s22, s33]) => out.extend(spatial([s11, s12, s12, s22], s33)),
            (Field::Piola, &[p11, p12, p21, p22, p33]) => out.extend(spatial([p11, p12, p21, p22], p33)),
            (Field::Deformation, &[f11, f12, f21, f22]) => out.extend(spatial([f11, f12, f21, f22], 1.0)),
            (Field::Velocity | Field::Displacement, &[x, y]) => out.extend([x, y, 0.0]),
            (_, values) => out.extend_from_slice(values),
        }
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

/// Row by row with the third direction of plane strain.
fn spatial(t: [f64; 4], t33: f64) -> [f64; 9] {
    [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, t33]
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
        for &(name, field) in Field::NAMES {
            assert_eq!(Field::of(name), Some(field));
            let mut values = Vec::new();
            field.push(&law, &at, &mut values);
            assert_eq!(values.len(), field.components().count(), "{name}");
            let mut spatial = Vec::new();
            field.push_spatial(&law, &at, &mut spatial);
            assert_eq!(spatial.len(), field.kind().components(), "{name}");
        }
    }
}
