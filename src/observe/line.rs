//! `lines/<name>.csv`: fields along a straight line of the initial configuration.

use super::{Field, Observer, Schedule, Solution, View};
use crate::cloud::locate::Locator;
use crate::error::Error;
use crate::mesh::Mesh;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Samples s_i = i L / (samples - 1); a point on an edge belongs to the cell of the lowest number.
pub struct Line {
    schedule: Schedule,
    path: PathBuf,
    file: BufWriter<File>,
    samples: Vec<Sample>,
    fields: Vec<Field>,
    /// The law of each cell.
    material: Vec<usize>,
}

struct Sample {
    s: f64,
    x: [f64; 2],
    cell: usize,
    xi: [f64; 2],
}

impl Line {
    /// Locates the samples and starts `path` with its header.
    ///
    /// # Errors
    /// A sample outside of the mesh; a file that cannot be made.
    pub fn create(path: &Path, mesh: &Mesh, material: &[usize], ends: [[f64; 2]; 2], samples: usize, fields: Vec<Field>, schedule: Schedule) -> Result<Self, Error> {
        let locator = Locator::new(mesh);
        let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
        let sample = |i: usize| {
            let share = i as f64 / (samples - 1) as f64;
            let x = [0, 1].map(|k| if i + 1 == samples { ends[1][k] } else { ends[0][k] + share * (ends[1][k] - ends[0][k]) });
            let (cell, xi) = locator.find(x).ok_or_else(|| {
                Error::input(
                    format!("sample {} of line {} at ({}, {}) lies outside of the mesh", i + 1, path.display(), x[0], x[1]),
                    "choose `from` and `to` inside of the body in its initial configuration",
                )
            })?;
            Ok(Sample { s: share * length, x, cell, xi })
        };
        let samples = (0..samples).map(sample).collect::<Result<Vec<_>, Error>>()?;
        let file = File::create(path).map_err(|why| Error::output(path, why))?;
        let mut line =
            Self { schedule, path: path.to_owned(), file: BufWriter::new(file), samples, fields, material: material.to_vec() };
        let names: Vec<String> = line.fields.iter().flat_map(|field| field.components()).collect();
        line.write(&format!("t,s,x,y,{}\n", names.join(",")))?;
        Ok(line)
    }

    fn write(&mut self, text: &str) -> Result<(), Error> {
        let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.flush());
        written.map_err(|why| Error::output(&self.path, why))
    }
}

impl Observer for Line {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        let operators = &view.scheme.operators;
        let solution = Solution {
            basis: &operators.line.basis,
            laws: &view.scheme.laws,
            material: &self.material,
            components: view.state.components,
            u: view.state.unpack(&operators.blocks, operators.nodes()),
        };
        let mut text = String::new();
        for sample in &self.samples {
            let point = solution.at(sample.cell, sample.xi);
            let mut row = vec![view.state.time, sample.s, sample.x[0], sample.x[1]];
            self.fields.iter().for_each(|field| field.push(solution.law(sample.cell), &point, &mut row));
            text.push_str(&row.iter().map(|x| format!("{x:e}")).collect::<Vec<_>>().join(","));
            text.push('\n');
        }
        self.write(&text)
    }
}
