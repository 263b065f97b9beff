//! The one number that stands for the error of a run.

use crate::error::{Error, Result};
use crate::names::did_you_mean;
use crate::scene::{MEASURES, Scene};

/// What settings are compared and chosen by.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Measure {
    /// The standard measure, [`crate::accuracy::Errors::standard`].
    #[default]
    Standard,
    /// The same in L1, [`crate::accuracy::Errors::standard_l1`].
    L1,
    /// The error of a quantity of the scene.
    Quantity {
        /// Its number in the scene.
        number: usize,
        /// Its name.
        name: String,
        /// Its unit, where it is an error itself: then its value counts. Else none: its relative error counts.
        unit: Option<&'static str>,
    },
}

impl Measure {
    /// `standard`, `l1` or a quantity of the scene.
    ///
    /// # Errors
    /// Another name.
    pub fn named(name: &str, scene: &Scene) -> Result<Self> {
        let [standard, l1] = MEASURES;
        match scene.quantities.iter().position(|quantity| quantity.name == name) {
            _ if name == standard => Ok(Self::Standard),
            _ if name == l1 => Ok(Self::L1),
            Some(number) => {
                let what = &scene.quantities[number].what;
                let unit = what.build().is_error.then(|| (what.build().unit)(&what.values));
                Ok(Self::Quantity { number, name: name.to_owned(), unit })
            }
            None => {
                let quantities = scene.quantities.iter().map(|quantity| quantity.name.as_str());
                let known: Vec<&str> = MEASURES.into_iter().chain(quantities).collect();
                let remedy = format!(
                    "{}--measure takes {}: the last are the [[quantity]] of the scene",
                    did_you_mean(name, &known),
                    known.join(", ")
                );
                Err(Error::input(format!("there is no measure `{name}`"), remedy))
            }
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Standard => MEASURES[0],
            Self::L1 => MEASURES[1],
            Self::Quantity { name, .. } => name,
        }
    }

    /// Whether a reference solution is needed for it.
    pub fn needs_reference(&self) -> bool {
        !matches!(self, Self::Quantity { .. })
    }

    /// What it is, for the axis of a plot.
    pub fn label(&self) -> String {
        match self {
            Self::Standard => "relative error (standard measure)".to_owned(),
            Self::L1 => "relative error (L1)".to_owned(),
            Self::Quantity { name, unit: None, .. } => format!("relative error of {name}"),
            Self::Quantity { name, unit: Some(unit), .. } => format!("{name} {unit}").trim_end().to_owned(),
        }
    }

    /// What it is taken against, where `reference` is what states are compared with.
    pub fn against(&self, reference: &str) -> String {
        match self {
            Self::Quantity { unit: Some(_), .. } => "0".to_owned(),
            Self::Quantity { .. } => {
                "the exact value where the scene has one, else Richardson's extrapolation of each series".to_owned()
            }
            Self::Standard | Self::L1 => reference.to_owned(),
        }
    }

    /// An error in words: `1 %`; of a quantity with a unit `2.5 cells`.
    pub fn words(&self, error: f64) -> String {
        match self {
            Self::Quantity { unit: Some(unit), .. } if !unit.is_empty() => format!("{error:.3} {unit}"),
            _ => percent(error),
        }
    }
}

/// 1 %, 0.01 %; below that as a power of ten.
fn percent(error: f64) -> String {
    if error >= 0.9e-5 { format!("{} %", (error * 1e8).round() / 1e6) } else { format!("{error:.0e}") }
}
