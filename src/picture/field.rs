//! The fields that maps show.

use crate::chart::Palette;
use crate::error::{Error, Result};
use crate::material::Rank;
use crate::names::did_you_mean;
use crate::observe::{Field, Point};
use crate::quantity::Component;
use crate::step::Law;

/// A field that a map shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Shade {
    /// Its name, in commands and files.
    pub name: String,
    /// Its name in words.
    pub title: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its colours.
    pub palette: Palette,
    of: Of,
}

/// How the number of a point is found.
#[derive(Debug, Clone, PartialEq)]
enum Of {
    /// -tr(sigma)/3.
    Pressure,
    /// A component of a field, or the length of a vector.
    Component(Component),
}

impl Shade {
    fn of(field: Field, suffix: Option<&str>, name: &str, title: &str, palette: Palette) -> Option<Self> {
        let of = Of::Component(Component::new(field, suffix)?);
        Some(Self { name: name.to_owned(), title: title.to_owned(), unit: Component::unit(field), palette, of })
    }

    /// All that a body of these laws can show.
    pub fn all(laws: &[Law]) -> Vec<Self> {
        let pressure = Self {
            name: "pressure".to_owned(),
            title: "pressure".to_owned(),
            unit: "Pa",
            palette: Palette::Around(0.0),
            of: Of::Pressure,
        };
        let mut all = vec![pressure];
        all.extend(Self::of(Field::Velocity, None, "speed", "speed", Palette::Rising));
        all.extend(Self::of(Field::Displacement, None, "displacement", "displacement", Palette::Rising));
        for field in Field::of_laws(laws) {
            all.extend(field.suffixes().iter().filter_map(|suffix| Self::of_component(field, suffix)));
        }
        all
    }

    fn of_component(field: Field, suffix: &str) -> Option<Self> {
        let name = format!("{}{suffix}", field.name());
        let words = match field {
            Field::VonMises => "von Mises stress".to_owned(),
            Field::Jacobian => "J = det F".to_owned(),
            _ => format!("{} {}", field.name().replace('_', " "), suffix.trim_start_matches('_')),
        };
        let is_diagonal = ["_11", "_22", "_33"].contains(&suffix);
        let palette = match field {
            Field::VonMises => Palette::Rising,
            Field::Jacobian => Palette::Around(1.0),
            Field::Deformation if is_diagonal => Palette::Around(1.0),
            Field::History(variable) if variable.rank == Rank::Scalar => Palette::Rising,
            Field::History(_) if is_diagonal => Palette::Around(1.0),
            _ => Palette::Around(0.0),
        };
        let suffix = suffix.trim_start_matches('_');
        Self::of(field, (!suffix.is_empty()).then_some(suffix), &name, words.trim_end(), palette)
    }

    /// Those of a first look: von Mises stress, pressure, speed, J, and what laws remember as one number.
    pub fn usual(laws: &[Law]) -> Vec<Self> {
        let is_usual = |shade: &Shade| ["von_mises", "pressure", "speed", "jacobian"].contains(&&shade.name[..]);
        let scalars: Vec<String> = Field::of_laws(laws)
            .into_iter()
            .filter(|field| field.is_history() && field.suffixes().len() == 1)
            .map(|field| field.name().to_owned())
            .collect();
        Self::all(laws).into_iter().filter(|shade| is_usual(shade) || scalars.contains(&shade.name)).collect()
    }

    /// Those of these names, each once.
    ///
    /// # Errors
    /// A name that there is not, with those that there are.
    pub fn named(names: &[String], laws: &[Law]) -> Result<Vec<Self>> {
        let all = Self::all(laws);
        let find = |name: &String| {
            all.iter().find(|shade| shade.name == *name).cloned().ok_or_else(|| {
                let known: Vec<&str> = all.iter().map(|shade| shade.name.as_str()).collect();
                let remedy = format!("{}there are {}", did_you_mean(name, &known), known.join(", "));
                Error::input(format!("there is no field `{name}` to draw"), remedy)
            })
        };
        let is_first = |(k, name): &(usize, &String)| !names[..*k].contains(name);
        names.iter().enumerate().filter(is_first).map(|(_, name)| find(name)).collect()
    }

    /// Its number at a point.
    pub fn value(&self, law: &Law, at: &Point) -> f64 {
        match &self.of {
            Of::Component(component) => component.of(law, at),
            Of::Pressure => {
                let mut stress = Vec::with_capacity(4);
                Field::CauchyStress.push(law, at, &mut stress);
                match stress[..] {
                    [s11, _, s22, s33] => -(s11 + s22 + s33) / 3.0,
                    _ => f64::NAN,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{J2, NeoHookean};

    #[test]
    fn names_are_unique_and_the_usual_ones_follow_the_laws() {
        let elastic = [Law::from(NeoHookean::new(1.0, 0.3, 1.0))];
        let plastic = [Law::from(J2::new(1.0, 0.3, 1.0, 0.01, 0.1))];
        let names = |all: &[Shade]| all.iter().map(|shade| shade.name.clone()).collect::<Vec<_>>();
        for laws in [&elastic[..], &plastic] {
            let all = names(&Shade::all(laws));
            let distinct: std::collections::BTreeSet<_> = all.iter().collect();
            assert_eq!(distinct.len(), all.len(), "{all:?}");
        }
        assert_eq!(names(&Shade::usual(&elastic)), ["pressure", "speed", "jacobian", "von_mises"]);
        assert!(names(&Shade::usual(&plastic)).contains(&"plastic_strain".to_owned()));
        let why = Shade::named(&["presure".to_owned()], &elastic).unwrap_err().to_string();
        assert!(why.contains("did you mean `pressure`"), "{why}");
        let twice = ["speed", "pressure", "speed"].map(str::to_owned);
        assert_eq!(names(&Shade::named(&twice, &elastic).unwrap()), ["speed", "pressure"]);
    }

    #[test]
    fn the_pressure_of_a_compressed_body_is_positive() {
        let law = Law::from(NeoHookean::new(1.0, 0.3, 1.0));
        let shade = Shade::named(&["pressure".to_owned()], std::slice::from_ref(&law)).unwrap().remove(0);
        let at = |stretch: f64| Point {
            deformation: [stretch, 0.0, 0.0, stretch],
            velocity: [0.0; 2],
            displacement: [0.0; 2],
            history: vec![],
            stressed: [stretch, 0.0, 0.0, stretch],
        };
        assert!(shade.value(&law, &at(0.9)) > 0.0 && shade.value(&law, &at(1.1)) < 0.0);
    }
}
