//! The schemes that are compared, and further keys.

use crate::error::{Error, Result};

#[derive(Debug, clap::Args)]
pub struct Scheme {
    /// Methods [default: that of the scene; rk-dgfem without one]
    #[arg(long, value_name = "NAME,..")]
    method: Option<String>,
    /// Degrees N = N_T
    #[arg(long, value_name = "N,..")]
    degree: Option<String>,
    /// Layouts of the points of ADER-DGMPM
    #[arg(long, value_name = "NAME,..")]
    layout: Option<String>,
    /// Fluxes
    #[arg(long, value_name = "NAME,..")]
    flux: Option<String>,
    /// Controls of the curl
    #[arg(long, value_name = "NAME,..")]
    curl: Option<String>,
    /// Shares of the stability limit
    #[arg(long, value_name = "C,..", conflicts_with = "dt")]
    safety: Option<String>,
    /// Steps, as dt c / h
    #[arg(long, value_name = "C,..")]
    dt: Option<String>,
    /// Values of a further key: poisson=.3,.45,.4999, f11=.7,.9,1, curl.alpha=1,3
    #[arg(long, value_name = "KEY=V,..")]
    over: Vec<String>,
}

impl Scheme {
    /// Keys with their lists.
    pub fn lists(&self) -> [(&'static str, &Option<String>); 7] {
        [
            ("method", &self.method),
            ("degree", &self.degree),
            ("layout", &self.layout),
            ("flux", &self.flux),
            ("curl", &self.curl),
            ("safety", &self.safety),
            ("dt", &self.dt),
        ]
    }

    /// The keys of `--over` with their lists.
    pub fn over(&self) -> impl Iterator<Item = Result<(&str, &str)>> {
        self.over.iter().map(|text| {
            let remedy = "write --over poisson=.3,.45,.4999";
            text.split_once('=').ok_or_else(|| Error::input(format!("--over is `{text}`"), remedy))
        })
    }
}
