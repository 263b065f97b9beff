//! Enums whose variants have names in scenes and results: each list is written once, where the enum stands.

/// An enum whose variants have names: `NAMES`, `name()` and serialisation as the name.
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
