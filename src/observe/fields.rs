//! The registry of output fields: names, components and values at a point.

use super::Point;
use crate::io::grid::Kind;
use crate::material::{Rank, Variable, cauchy};
use crate::step::Law;
use crate::tensor;

/// A field that outputs can name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Field {
    /// v, m/s.
    Velocity,
    /// u = x - X, m.
    Displacement,
    /// F.
    Deformation,
    /// First Piola-Kirchhoff stress P, Pa.
    Piola,
    /// sigma = P F^T / J, Pa.
    CauchyStress,
    /// J = det F.
    Jacobian,
    /// Von Mises equivalent of sigma (with sigma33), Pa.
    VonMises,
    /// A variable of the history of a law.
    History(&'static Variable),
}

impl serde::Serialize for Field {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Field {
    /// The fields of every body.
    pub const OF_ALL: [Field; 7] = [
        Field::Velocity,
        Field::Displacement,
        Field::Deformation,
        Field::Piola,
        Field::CauchyStress,
        Field::Jacobian,
        Field::VonMises,
    ];

    /// The fields of a body of these laws: those of every body, and the variables of histories.
    pub fn of_laws(laws: &[Law]) -> Vec<Field> {
        let mut out = Self::OF_ALL.to_vec();
        for variable in laws.iter().flat_map(|law| law.variables()) {
            if !out.contains(&Field::History(variable)) {
                out.push(Field::History(variable));
            }
        }
        out
    }

    /// Its name in scenes and results.
    pub fn name(self) -> &'static str {
        match self {
            Field::Velocity => "velocity",
            Field::Displacement => "displacement",
            Field::Deformation => "deformation",
            Field::Piola => "piola",
            Field::CauchyStress => "cauchy_stress",
            Field::Jacobian => "jacobian",
            Field::VonMises => "von_mises",
            Field::History(variable) => variable.name,
        }
    }

    /// Whether the field is a variable of a history.
    pub fn is_history(self) -> bool {
        matches!(self, Field::History(_))
    }

    /// Whether a body of these laws has the field: a variable needs a law that has it.
    pub fn is_of(self, laws: &[Law]) -> bool {
        match self {
            Field::History(variable) => laws.iter().any(|law| law.variables().contains(variable)),
            _ => true,
        }
    }

    /// Suffixes of its components, such as `_11`; an empty one of a field of one component.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Field::Velocity | Field::Displacement => &["_1", "_2"],
            Field::Deformation => &["_11", "_12", "_21", "_22"],
            Field::Piola => &["_11", "_12", "_21", "_22", "_33"],
            Field::CauchyStress => SYMMETRIC,
            Field::Jacobian | Field::VonMises => &[""],
            Field::History(variable) => match variable.rank {
                Rank::Scalar => &[""],
                Rank::SymmetricTensor => SYMMETRIC,
            },
        }
    }

    /// Names of its components, such as `cauchy_stress_11`.
    pub fn components(self) -> impl Iterator<Item = String> {
        self.suffixes().iter().map(move |suffix| format!("{}{suffix}", self.name()))
    }

    /// Whether an export writes the field as a scalar, vector or tensor.
    pub fn kind(self) -> Kind {
        match self.suffixes().len() {
            1 => Kind::Scalar,
            2 => Kind::Vector,
            _ => Kind::Tensor,
        }
    }

    /// Appends the value of the field for an export: vectors in space, tensors row by row with their third direction.
    pub fn push_spatial(self, law: &Law, at: &Point, out: &mut Vec<f64>) {
        let mut plane = Vec::with_capacity(5);
        self.push(law, at, &mut plane);
        match (self, &plane[..]) {
            (Field::Piola, &[p11, p12, p21, p22, p33]) => out.extend(spatial([p11, p12, p21, p22], p33)),
            (Field::Deformation, &[f11, f12, f21, f22]) => out.extend(spatial([f11, f12, f21, f22], 1.0)),
            (_, &[s11, s12, s22, s33]) => out.extend(spatial([s11, s12, s12, s22], s33)),
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
            Field::History(variable) => {
                let kept = law.place_of(variable.name).and_then(|place| at.history.get(place));
                out.extend(self.suffixes().iter().map(|suffix| number_of(variable, suffix, kept)));
            }
        }
    }
}

/// Suffixes of a symmetric tensor.
const SYMMETRIC: &[&str] = &["_11", "_12", "_22", "_33"];

/// The number of a variable with this suffix among those that are kept; that of virgin material, for laws that do not have it.
fn number_of(variable: &Variable, suffix: &str, kept: Option<&[f64]>) -> f64 {
    let place = variable.numbers.iter().position(|(known, _)| *known == suffix);
    let virgin = place.map_or(0.0, |place| variable.numbers[place].1);
    kept.zip(place).map_or(virgin, |(kept, place)| kept[place])
}

/// A tensor row by row, with the third direction of plane strain.
fn spatial(t: [f64; 4], t33: f64) -> [f64; 9] {
    [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, t33]
}

/// Cauchy stress [11, 12, 22, 33], Pa.
fn stress(law: &Law, at: &Point) -> [f64; 4] {
    let response = at.response(law);
    cauchy(at.stressed, response.piola, response.piola33)
}

/// sqrt(3/2 s:s) of the deviator of [s11, s12, s22, s33].
fn von_mises(s: [f64; 4]) -> f64 {
    let squares = (s[0] - s[2]).powi(2) + (s[2] - s[3]).powi(2) + (s[3] - s[0]).powi(2);
    (0.5 * squares + 3.0 * s[1] * s[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{J2, NeoHookean};

    #[test]
    fn von_mises_of_uniaxial_stress_and_of_pressure() {
        assert_eq!(von_mises([3.0, 0.0, 0.0, 0.0]), 3.0);
        assert_eq!(von_mises([2.0, 0.0, 2.0, 2.0]), 0.0);
        // Pure shear: sqrt(3) tau; one rounding of the root.
        assert!((von_mises([0.0, 1.0, 0.0, 0.0]) - 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn every_field_has_its_name_back_and_as_many_components_as_values() {
        let elastic = Law::from(NeoHookean::new(1.0, 0.3, 1.0));
        let with_history = Law::from(J2::new(1.0, 0.3, 1.0, 0.01, 0.1));
        let fields = Field::of_laws(&[elastic.clone(), with_history.clone()]);
        let (deformation, history) = ([1.1, 0.1, 0.0, 0.9], vec![1.1, 0.8, 0.1, 1.2, 0.3]);
        let at = Point { deformation, velocity: [1.0, 2.0], displacement: [0.0; 2], history, stressed: deformation };
        let of = |law: &Law, field: Field| {
            let mut values = Vec::new();
            field.push(law, &at, &mut values);
            values
        };
        for (field, law) in fields.iter().flat_map(|field| [(*field, &elastic), (*field, &with_history)]) {
            let name = field.name();
            assert_eq!(fields.iter().filter(|other| other.name() == name).count(), 1);
            assert_eq!(of(law, field).len(), field.components().count(), "{name}");
            let mut spatial = Vec::new();
            field.push_spatial(law, &at, &mut spatial);
            assert_eq!(spatial.len(), field.kind().components(), "{name}");
        }
        let variables: Vec<Field> = fields.into_iter().filter(|field| field.is_history()).collect();
        let all = |law: &Law| variables.iter().map(|field| of(law, *field)).collect::<Vec<_>>();
        assert_eq!(all(&with_history), [vec![1.1, 0.1, 0.8, 1.2], vec![0.3]]);
        assert_eq!(all(&elastic), [vec![1.0, 0.0, 1.0, 1.0], vec![0.0]]);
        let of_elastic = Field::of_laws(std::slice::from_ref(&elastic));
        assert!(
            of_elastic == Field::OF_ALL
                && variables.iter().all(|field| field.is_of(&[elastic.clone(), with_history.clone()]))
        );
        assert!(!variables[0].is_of(&[elastic]));
    }
}
