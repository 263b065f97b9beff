//! What names the groups of a mesh of another program.

use crate::error::{Error, Result};
use crate::io::unstructured::{Of, Tags};
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Groups {
    /// Of a VTU or XDMF file: the data at its cells that have the numbers of groups, or none
    #[arg(long, value_name = "DATA")]
    groups: Option<String>,
    /// The VTU or XDMF file of the lines with the numbers of groups of edges
    #[arg(long, value_name = "FILE")]
    facets: Option<PathBuf>,
    /// Names for the numbers of groups, such as cells:1=steel,edges:2=left
    #[arg(long, value_name = "OF:NUMBER=NAME", value_delimiter = ',')]
    names: Vec<String>,
}

impl Groups {
    /// As the library has them.
    pub fn tags(&self) -> Result<Tags> {
        let names = self.names.iter().map(|text| named(text)).collect::<Result<_>>()?;
        Ok(Tags { data: self.groups.clone(), facets: self.facets.clone(), names })
    }
}

/// `cells:1=steel`.
fn named(text: &str) -> Result<(Of, i64, String)> {
    let parts = text.split_once('=').and_then(|(key, name)| Some((key.split_once(':')?, name)));
    let found = parts.and_then(|((of, number), name)| {
        let of = match of {
            "cells" => Of::Cells,
            "edges" => Of::Edges,
            _ => return None,
        };
        Some((of, number.parse().ok()?, name.to_owned())).filter(|_| !name.is_empty())
    });
    found.ok_or_else(|| {
        Error::input(format!("--names {text} names no group"), "give such as cells:1=steel or edges:2=left")
    })
}
