//! The format of pictures.

/// The format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Pixels
    Png,
    /// Lines and text
    Svg,
}

impl Format {
    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        if self == Self::Png { "png" } else { "svg" }
    }
}
