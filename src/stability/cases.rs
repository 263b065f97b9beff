//! The cases of a command: every combination of the lists that are given.

use super::problem::{Domain, Pattern, Setup};
use crate::error::{Error, Result};

/// What a command asks for; a list that is empty leaves the scene as it is.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The body.
    pub domain: Domain,
    /// `--set` for all cases.
    pub sets: Vec<String>,
    /// Keys and their values: each list multiplies the cases.
    pub lists: Vec<(String, Vec<String>)>,
    /// Ratio of two Young's moduli; 1: one material.
    pub contrast: f64,
    /// Where the stiffer cells are.
    pub pattern: Pattern,
    /// dt c / h in place of what the scene says.
    pub courant: Option<f64>,
    /// Whether the limit dt -> 0 is looked at.
    pub semi_discrete: bool,
}

/// A setup, and the values of the key of [`Plan::lists`] that stands last.
#[derive(Debug, Clone)]
pub struct Case {
    /// The setup.
    pub setup: Setup,
    /// Key and value of each list.
    pub labels: Vec<(String, String)>,
}

impl Plan {
    /// All cases, the last list running fastest.
    ///
    /// # Errors
    /// A value of a key that is no number where one is needed.
    pub fn cases(&self) -> Result<Vec<Case>> {
        let setup = Setup {
            domain: self.domain.clone(),
            sets: self.sets.clone(),
            contrast: self.contrast,
            pattern: self.pattern,
            courant: self.courant,
            semi_discrete: self.semi_discrete,
        };
        let mut cases = vec![Case { setup, labels: vec![] }];
        for (key, values) in self.lists.iter().filter(|(_, values)| !values.is_empty()) {
            let mut more = Vec::new();
            for case in &cases {
                for value in values {
                    let mut case = case.clone();
                    case.apply(key, value)?;
                    case.labels.push((key.clone(), value.clone()));
                    more.push(case);
                }
            }
            cases = more;
        }
        Ok(cases)
    }
}

impl Case {
    /// Gives a key a value: a short name, or the path of a key of the scene.
    fn apply(&mut self, key: &str, value: &str) -> Result<()> {
        let setup = &mut self.setup;
        let path = |path: &str| format!("{path}={value}");
        match key {
            "method" | "flux" | "safety" => setup.sets.push(path(&format!("scheme.{key}"))),
            "degree" => {
                setup.sets.extend([path("scheme.degree"), path("scheme.time_degree")]);
            }
            "layout" => setup.sets.push(path("cloud.layout")),
            "curl" => setup.sets.push(path("curl.control")),
            "alpha" => setup.sets.push(path("curl.alpha")),
            "law" | "young" | "poisson" | "density" => {
                let materials = if let Domain::Scene(scene) = &setup.domain { scene.materials.len() } else { 1 };
                setup.sets.extend((0..materials).map(|k| format!("material.{k}.{key}={value}")));
            }
            "dt" => setup.courant = Some(number(key, value)?),
            "contrast" => setup.contrast = number(key, value)?,
            "deformation" => set_deformation(setup, &value.split(',').map(str::to_owned).collect::<Vec<_>>())?,
            // A state under one or two equal stretches.
            "f11" => set_deformation(setup, &[value, "0", "0", "1"].map(str::to_owned))?,
            "stretch" => set_deformation(setup, &[value, "0", "0", value].map(str::to_owned))?,
            "shear" => set_deformation(setup, &["1", value, "0", "1"].map(str::to_owned))?,
            other if other.contains('.') => setup.sets.push(path(other)),
            _ => {
                let known = "method, degree, layout, flux, curl, alpha, law, young, poisson, density, safety, dt, contrast, \
                     f11, stretch, shear";
                let remedy = format!("there are {known}, and keys of the scene such as scheme.time_degree");
                return Err(Error::input(format!("--over has the key `{key}`"), remedy));
            }
        }
        Ok(())
    }
}

/// A positive number.
fn number(key: &str, value: &str) -> Result<f64> {
    match value.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err(Error::input(format!("{key} is `{value}`"), "give a number above 0")),
    }
}

/// The uniform deformation F11, F12, F21, F22 of a setup.
fn set_deformation(setup: &mut Setup, f: &[String]) -> Result<()> {
    let remedy = "give F11,F12,F21,F22 with F11 F22 - F12 F21 > 0, such as 0.9,0,0,0.9";
    let numbers: Vec<f64> = f.iter().filter_map(|x| x.trim().parse().ok()).collect();
    let [a, b, c, d] = numbers[..] else {
        return Err(Error::input(format!("the deformation is `{}`", f.join(",")), remedy));
    };
    // NaN is not above 0 either.
    if !(a * d - b * c > 0.0 && numbers.iter().all(|x| x.is_finite())) {
        return Err(Error::input(format!("the deformation {} has J = {}", f.join(","), a * d - b * c), remedy));
    }
    setup.sets.push(format!("initial.deformation=[{a:?}, {b:?}, {c:?}, {d:?}]"));
    Ok(())
}
