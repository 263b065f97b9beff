//! A start from material points alone: F, v and internal variables of a cloud file, on whatever grid.

use super::points::Given;
use crate::error::Result;
use crate::io::grid::{self, Kind};
use crate::mesh::{Mesh, map};
use crate::observe::{Field, Solution};
use crate::operators::{carry, from_points};
use crate::scene::Scene;
use crate::state::{State, UNKNOWNS};
use crate::step::Scheme;

impl Scene {
    /// P2G of the fields of the cloud file by chi (18), see [`from_points`].
    pub(super) fn state_from_cloud(&self, mesh: &Mesh, scheme: &Scheme) -> Result<State> {
        let given = self.given_points(mesh)?;
        let components = self.components();
        let values = self.unknowns_of_points(mesh, scheme, &given, components)?;
        let (line, n) = (&scheme.operators.line, scheme.operators.nodes());
        let cells = from_points(mesh, line, &given.cloud, &self.limits_of_cells(), &values, components)?;
        let material = self.material_of_cells(mesh);
        for (cell, values) in cells.chunks(components * n).enumerate() {
            let density = scheme.laws[material[cell]].density();
            for (a, xi) in line.nodes().into_iter().enumerate() {
                let u = |k: usize| values[k * n + a];
                let (f, v) = ([0, 1, 2, 3].map(u), [4, 5].map(|k| u(k) / density));
                self.check_initial(f, v, map::position(&mesh.map(cell), xi), mesh.number(cell))?;
            }
        }
        let mut state = State { time: self.start, ..State::pack(&scheme.operators.blocks, n, components, &cells) };
        state = state.holding_from_now(n);
        if !scheme.histories.is_empty() {
            scheme.set_internal(&mut state, &self.internal_of_points(mesh, scheme, &given)?);
        }
        Ok(state)
    }

    /// Internal variables where the scheme has them, in the order of [`Scheme::internal_of`]: those of the same given point or
    /// of the nearest one, never interpolated.
    fn internal_of_points(&self, mesh: &Mesh, scheme: &Scheme, given: &Given) -> Result<Vec<f64>> {
        let material = self.material_of_cells(mesh);
        let on_nodes = match self.scheme.method.has_points() {
            true => self.on_nodes(&material),
            // Nodes are to the cloud what virtual points are.
            false => vec![true; material.len()],
        };
        let carried = carry(mesh, &scheme.operators.line, &given.cloud, &self.limits_of_cells(), &on_nodes)?;
        let of_law = |law: usize| {
            let variables = scheme.laws[law].variables().iter();
            let names = variables.flat_map(|v| v.numbers.iter().map(|(suffix, _)| format!("{}{suffix}", v.name)));
            names.map(|name| self.variable_of(given, &name)).collect::<Result<Vec<_>>>()
        };
        let columns = (0..scheme.laws.len()).map(of_law).collect::<Result<Vec<_>>>()?;
        let mut values = Vec::new();
        for (cell, law) in material.into_iter().enumerate() {
            for &p in &carried.source[carried.cloud.first[cell]..carried.cloud.first[cell + 1]] {
                values.extend(columns[law].iter().map(|(values, stride, k)| values[stride * p + k]));
            }
        }
        Ok(values)
    }

    /// An internal variable in the fields of a cloud file: values, numbers of a point, place among them. It is a scalar of its
    /// name, or a component `name_11` of a tensor, as exports have it.
    fn variable_of<'a>(&self, given: &'a Given, name: &str) -> Result<(&'a [f64], usize, usize)> {
        let find = |name: &str, kind: Kind| given.fields.iter().find(|field| field.name == name && field.kind == kind);
        if let Some(field) = find(name, Kind::Scalar) {
            return Ok((&field.values, 1, 0));
        }
        let places = [("11", 0), ("12", 1), ("21", 3), ("22", 4), ("33", 8)];
        let split = name.rsplit_once('_');
        let component = split.and_then(|(stem, suffix)| {
            let place = places.iter().find(|(known, _)| *known == suffix)?.1;
            Some((&find(stem, Kind::Tensor)?.values[..], Kind::Tensor.components(), place))
        });
        component.ok_or_else(|| {
            let what = format!("the cloud file has no internal variable `{name}`, which a law of this scene has");
            self.error("initial.from", what, "export the run with all fields, or give laws without internal variables")
        })
    }

    /// U, and where it is asked for the displacement, at the given points: `[point][component]`.
    fn unknowns_of_points(&self, mesh: &Mesh, scheme: &Scheme, given: &Given, components: usize) -> Result<Vec<f64>> {
        let deformation = self.field_of(given, Field::Deformation)?;
        let velocity = self.field_of(given, Field::Velocity)?;
        // Without the field the displacement counts from the start, as it does from expressions.
        let displacement = self.field_of(given, Field::Displacement).ok();
        let material = self.material_of_cells(mesh);
        let mut values = Vec::with_capacity(given.cloud.len() * components);
        for (cell, &law) in material.iter().enumerate() {
            let density = scheme.laws[law].density();
            for p in given.cloud.first[cell]..given.cloud.first[cell + 1] {
                let (f, v) = (&deformation[9 * p..9 * p + 9], &velocity[3 * p..3 * p + 3]);
                values.extend([f[0], f[1], f[3], f[4], density * v[0], density * v[1]]);
                if components > UNKNOWNS {
                    let u = displacement.map_or([0.0; 2], |u| [u[3 * p], u[3 * p + 1]]);
                    values.extend(u);
                }
            }
        }
        Ok(values)
    }

    /// A field of the cloud file with its components in space.
    fn field_of<'a>(&self, given: &'a Given, field: Field) -> Result<&'a [f64]> {
        let name = field.name();
        let fits = |other: &&grid::Field| other.name == name && other.kind == field.kind();
        match given.fields.iter().find(fits) {
            Some(found) => Ok(&found.values),
            None => {
                let known: Vec<&str> = given.fields.iter().map(|field| field.name.as_str()).collect();
                let there = if known.is_empty() { "no field at all".to_owned() } else { known.join(", ") };
                let what =
                    format!("the cloud file has no field `{name}` with {} components", field.kind().components());
                let remedy = format!("it has {there}; a start needs velocity and deformation, as exports have them");
                Err(self.error("initial.from", what, remedy))
            }
        }
    }

    /// What a cloud file needs for a start from it.
    pub fn fields_of_points(&self, solution: &Solution) -> Vec<Field> {
        let mut fields = vec![Field::Velocity, Field::Deformation];
        fields.extend(solution.has_displacement().then_some(Field::Displacement));
        fields.extend(Field::of_laws(solution.laws).into_iter().filter(|field| field.is_history()));
        fields
    }
}
