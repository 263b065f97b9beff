//! One number of a field at a point.

use crate::exact::Exact;
use crate::observe::{Field, Point};
use crate::step::Law;

/// A component of a field, a field of one component, or the length of a vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    field: Field,
    /// Which of its components; none: the length of the vector.
    index: Option<usize>,
}

/// J.
impl Default for Component {
    fn default() -> Self {
        Self { field: Field::Jacobian, index: Some(0) }
    }
}

impl Component {
    /// The component of a field with this suffix, such as `11`. Without a suffix it is a field of one component, or the length of
    /// a vector. None where there is no such thing.
    pub fn new(field: Field, given: Option<&str>) -> Option<Self> {
        match (given, field.suffixes().len()) {
            (Some(given), _) => {
                let index = Self::names(field).iter().position(|name| *name == given)?;
                Some(Self { field, index: Some(index) })
            }
            (None, 1) => Some(Self { field, index: Some(0) }),
            (None, 2) => Some(Self { field, index: None }),
            (None, _) => None,
        }
    }

    /// The components of a field as scenes name them, such as `11`; none of a field of one component.
    pub fn names(field: Field) -> Vec<&'static str> {
        field.suffixes().iter().map(|suffix| suffix.trim_start_matches('_')).filter(|name| !name.is_empty()).collect()
    }

    /// The unit of a field; empty for a pure number and for variables of laws.
    pub fn unit(field: Field) -> &'static str {
        match field {
            Field::Velocity => "m/s",
            Field::Displacement => "m",
            Field::Piola | Field::CauchyStress | Field::VonMises => "Pa",
            Field::Deformation | Field::Jacobian | Field::History(_) => "",
        }
    }

    /// Differences below this are rounding: 1e-10 of c_p, of rho0 c_p^2 or of 1.
    pub fn rounding(&self, law: &Law) -> f64 {
        let c = law.pressure_speed([1.0, 0.0, 0.0, 1.0], [1.0, 0.0]);
        1e-10
            * match Self::unit(self.field) {
                "m/s" => c,
                "Pa" => law.density() * c * c,
                _ => 1.0,
            }
    }

    /// Its number at a point.
    pub fn of(&self, law: &Law, at: &Point) -> f64 {
        let mut values = Vec::with_capacity(5);
        self.field.push(law, at, &mut values);
        match self.index {
            Some(index) => values[index],
            None => values.iter().map(|x| x * x).sum::<f64>().sqrt(),
        }
    }

    /// Its number in an exact solution at X (m) and t (s); none of the displacement, which no solution has.
    pub fn exact(&self, exact: &dyn Exact, law: &Law, x: [f64; 2], time: f64) -> Option<f64> {
        let history = exact.internal(x, time).unwrap_or_else(|| law.virgin());
        let (deformation, velocity) = (exact.deformation(x, time), exact.velocity(x, time));
        let at = Point { deformation, velocity, displacement: [0.0; 2], history, stressed: deformation };
        (self.field != Field::Displacement).then(|| self.of(law, &at))
    }
}
