//! Names in scenes and results: enums whose variants have names, each list written once, where the enum stands; and for
//! a name that does not exist the nearest one that does ("did you mean").

/// An enum whose variants have names: `NAMES`, `name()` and serialisation as the name.
#[doc(hidden)]
#[macro_export]
macro_rules! names {
    ($(#[$doc:meta])* $type:ident { $($(#[$variant_doc:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $type {
            $($(#[$variant_doc])* $variant,)+
        }

        impl $type {
            /// Every variant with its name.
            pub const NAMES: &'static [(&'static str, $type)] = &[$(($name, $type::$variant),)+];

            /// The variant of a name.
            pub fn named(name: &str) -> Option<Self> {
                Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, variant)| *variant)
            }

            /// All names, for messages: `a, b, c`.
            pub fn listed() -> String {
                Self::NAMES.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
            }

            /// The name in scenes and results.
            pub fn name(self) -> &'static str {
                match self {
                    $($type::$variant => $name,)+
                }
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }
    };
}

/// Names that things had before, and what they are called now.
const FORMER: &[(&str, &str)] = &[("plastic-impact", "j2-impact"), ("plastic_dissipation", "material_dissipation")];

/// The present name of what was called `given` before, where it is known here.
fn renamed<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    let (_, now) = FORMER.iter().find(|(former, _)| *former == given)?;
    known.iter().copied().find(|name| name == now)
}

/// The name at an edit distance of at most a third of its length (and at least 1), if there is one.
pub fn nearest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    let distance = |name: &&str| strsim::damerau_levenshtein(&given.to_lowercase(), name);
    let name = known.iter().copied().min_by_key(distance)?;
    let allowed = (name.chars().count().max(given.chars().count()) / 3).max(1);
    // a single letter is never a misspelling of another one
    let alike = distance(&name) <= allowed && (name.len() > 1 || distance(&name) == 0);
    alike.then_some(name)
}

/// "did you mean `name`? ", or nothing.
pub fn did_you_mean(given: &str, known: &[&str]) -> String {
    if let Some(now) = renamed(given, known) {
        return format!("`{given}` is called `{now}` now; ");
    }
    nearest(given, known).map(|name| format!("did you mean `{name}`? ")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_names() {
        let known = ["method", "degree", "time_degree", "flux", "cfl"];
        assert_eq!(nearest("metod", &known), Some("method"));
        assert_eq!(nearest("Degree", &known), Some("degree"));
        assert_eq!(nearest("clf", &known), Some("cfl"));
        assert_eq!(nearest("banana", &known), None);
        assert_eq!(nearest("z", &["x", "y", "sin"]), None);
        assert_eq!(nearest("a", &[]), None);
    }

    #[test]
    fn former_names_are_answered_by_the_present_ones_where_these_are_known() {
        let known = ["wall-impact", "j2-impact"];
        assert_eq!(did_you_mean("plastic-impact", &known), "`plastic-impact` is called `j2-impact` now; ");
        assert_eq!(did_you_mean("plastic-impact", &known[..1]), "");
        let columns = ["total_energy", "material_dissipation"];
        assert!(did_you_mean("plastic_dissipation", &columns).contains("material_dissipation"));
    }
}
