//! What a study compares.

use crate::study::Request;

#[derive(Debug, clap::Args)]
pub struct Compared {
    /// Methods
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "rk-dgfem,ader-dgfem,ader-dgmpm")]
    methods: Vec<String>,
    /// Degrees N
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "1,2,3,4")]
    degrees: Vec<usize>,
    /// Degrees N_T of each N [default: N alone]
    #[arg(long, value_name = "N,..", value_delimiter = ',')]
    time_degrees: Vec<usize>,
    /// Cells per direction over those of the scene; whole numbers where its mesh is a file [default: 0.25,0.5,1, of a
    /// file 1,2]
    #[arg(long, value_name = "R,..", value_delimiter = ',', allow_negative_numbers = true)]
    refine: Vec<f64>,
    /// Layouts of the points of ADER-DGMPM, such as paper, midpoints, random, rotated [default: that of the scene]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    layouts: Vec<String>,
    /// Values of a key of the scene, each as a setting of its own: "curl.control=lcf|off"; several options: each with each
    #[arg(long, value_name = "KEY=A|B")]
    compare: Vec<String>,
    /// Degree and refinement of the run that errors are taken against where no exact solution is known [default: one
    /// degree more than the largest, on the finest mesh]
    #[arg(long, value_name = "N,R", value_delimiter = ',', num_args = 1)]
    reference: Vec<f64>,
    /// What settings are compared and chosen by: standard, l1 (against the exact solution or a finer run), or the name of a
    /// [[quantity]] of the scene (by its relative error)
    #[arg(long, value_name = "NAME", default_value = "standard", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    measure: String,
    /// Find and run the cheapest setting with this error, such as 1e-3
    #[arg(long, value_name = "E", conflicts_with = "seconds", allow_negative_numbers = true)]
    error: Option<f64>,
    /// Find and run the most accurate setting that takes so many CPU seconds
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seconds: Option<f64>,
}

impl Compared {
    /// As the library has it.
    pub fn request(&self) -> Request {
        Request {
            methods: self.methods.clone(),
            degrees: self.degrees.clone(),
            time_degrees: self.time_degrees.clone(),
            refinements: self.refine.clone(),
            layouts: self.layouts.clone(),
            compare: self.compare.clone(),
            reference: self.reference.clone(),
            measure: self.measure.clone(),
            error: self.error,
            seconds: self.seconds,
        }
    }
}
