//! Where names become types: from a scene to mesh, laws, conditions, sources, time integration and scheme.

use super::differences;
use crate::boundary;
use crate::cloud::Cloud;
use crate::contact::Pairs;
use crate::error::{Error, Result};
use crate::exact::ExactForce;
use crate::expression::Expression;
use crate::io::read_tagged;
use crate::io::unstructured::{Of, Tags};
use crate::lane::Kernel;
use crate::mesh::{self, Link, Mesh};
use crate::operators::{Limits, Needs, Operators, Sampling};
use crate::registry::methods::Samples;
use crate::riemann::Looks;
use crate::run::Limits as WatchLimits;
use crate::run::Settings;
use crate::scene::{self, Boundary, Mesh as Source, Scene, Step};
use crate::source;
use crate::step::{Control, Correction, Law, Method as Integration, Pairing, Rescue, Scheme, cfl};
use std::path::PathBuf;
use std::sync::Arc;

impl Scene {
    /// The mesh of the scene, its groups checked.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn build_mesh(&self) -> Result<Mesh> {
        let mesh = match &self.mesh {
            Source::Rectangle { size, cells } => {
                self.check_room("mesh.rectangle.cells", cells[0].saturating_mul(cells[1]))?;
                let place = || self.place("mesh.rectangle.cells");
                mesh::rectangle(*size, *cells).map_err(|why| Error::from(why).or_at(place()))?
            }
            Source::File(path) => {
                let path = self.existing("mesh.file", path)?;
                let facets = self.mesh_groups.facets.as_deref().map(|path| self.existing("mesh.facets", path));
                read_tagged(&path, &self.tags(facets.transpose()?))?
            }
        };
        let mesh = self.cut_mesh(mesh)?;
        self.check_loads()?;
        self.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// What names the groups of a mesh of another program; `facets` is the file of its lines, if it has one.
    pub fn tags(&self, facets: Option<PathBuf>) -> Tags {
        let of = |is_of_cells: bool| if is_of_cells { Of::Cells } else { Of::Edges };
        let names = self.mesh_groups.names.iter();
        let names = names.map(|entry| (of(entry.is_of_cells), entry.number as i64, entry.name.clone())).collect();
        Tags { data: self.mesh_groups.data.clone(), facets, names }
    }

    /// Pairs of boundary groups (by number) that are periodic to each other, each once.
    pub fn periodic_groups(&self, mesh: &Mesh) -> Vec<[usize; 2]> {
        let number = |name: &str| mesh.edge_groups.iter().position(|group| group == name);
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for boundary in self.boundaries.iter().filter(|boundary| boundary.is_joined()) {
            let Some((_, partner)) = boundary.partner() else { continue };
            // `check_mesh` has refused groups that the mesh lacks.
            let (Some(a), Some(b)) = (number(&boundary.group), number(partner)) else { continue };
            if !pairs.contains(&[b, a]) {
                pairs.push([a, b]);
            }
        }
        pairs
    }

    /// What acts between boundary groups.
    pub fn pairings(&self, mesh: &Mesh) -> Vec<Pairing> {
        let number = |name: &str| mesh.edge_groups.iter().position(|group| group == name);
        let of = |boundary: &Boundary| {
            let law = (boundary.condition.build().between.as_ref()?.make)(&boundary.condition.values);
            let partner = boundary.partner().map_or(boundary.group.as_str(), |(_, group)| group);
            Some(Pairing { groups: [number(&boundary.group)?, number(partner)?], law })
        };
        // Two groups that name each other are one pair.
        let named_before = |k: usize| {
            let is_that = |other: &Boundary| {
                let back = other.partner().map(|(_, group)| group) == Some(&self.boundaries[k].group);
                back && self.boundaries[k].partner().map(|(_, group)| group) == Some(&other.group)
            };
            self.boundaries[..k].iter().any(is_that)
        };
        (0..self.boundaries.len()).filter(|&k| !named_before(k)).filter_map(|k| of(&self.boundaries[k])).collect()
    }

    /// What lies behind the faces of each cell: the mesh's neighbours, and those across periodic boundaries.
    ///
    /// # Errors
    /// A mesh whose faces or periodic groups do not fit together.
    pub fn links(&self, mesh: &Mesh) -> Result<Vec<[Link; 4]>> {
        let links = mesh::periodic_links(mesh, &self.periodic_groups(mesh));
        links.map_err(|why| Error::from(why).or_at(self.place("mesh")))
    }

    /// The number of the `[[material]]` of each cell.
    pub fn material_of_cells(&self, mesh: &Mesh) -> Vec<usize> {
        let of_group = |group: &String| self.materials.iter().position(|m| m.group.as_ref().is_none_or(|g| g == group));
        // `check_mesh` has refused groups without a material.
        let numbers: Vec<usize> = mesh.groups.iter().map(|group| of_group(group).unwrap_or(0)).collect();
        mesh.cell_group.iter().map(|&group| numbers[group]).collect()
    }

    /// What the method needs of the operators.
    pub fn needs<'a>(&self, cloud: &'a Cloud) -> Needs<'a> {
        let sampling = self.scheme.method.build().samples.map(|samples| match samples {
            Samples::Points => Sampling::Cloud(cloud),
            Samples::Nodes => Sampling::Nodes,
        });
        // Constants have no curl.
        let curl_free = self.scheme.degree > 0 && self.curl.build().relax.is_some();
        let held = (self.scheme.flux.build().make)().looks() == Looks::Displacement;
        Needs { degree: self.scheme.degree, sampling, curl_free, held }
    }

    /// Time integration.
    pub fn integration(&self) -> Integration {
        let scene::Scheme { method, degree, time_degree, sweeps, .. } = self.scheme;
        (method.build().integration)(degree, time_degree, sweeps)
    }

    /// The laws, in the order of the `[[material]]` tables.
    pub fn laws(&self) -> Vec<Law> {
        self.materials.iter().map(|material| (material.law.build())(&material.law.values)).collect()
    }

    /// Beyond what the points of a cell are replaced.
    pub fn limits_of_cells(&self) -> Limits {
        let scene::Limits { face_lebesgue, condition } = self.limits;
        let usual = Limits::of_degree(self.scheme.degree);
        Limits {
            lebesgue: face_lebesgue.unwrap_or(usual.lebesgue),
            condition: condition.unwrap_or(usual.condition),
            // Limits that are given hold for lattices too.
            lattices: face_lebesgue.is_some() || condition.is_some(),
        }
    }

    /// The scheme.
    ///
    /// # Errors
    /// As [`Scheme::new`].
    pub fn build_scheme(&self, mesh: &Mesh, operators: Operators, kernel: Kernel) -> Result<Scheme> {
        let boundaries = mesh.edge_groups.iter().map(|group| self.condition(group)).collect::<Result<_>>()?;
        let pairings = self.pairings(mesh);
        if !pairings.is_empty() && self.scheme.degree == 0 {
            let what = "faces do not act on each other at degree 0: constants have no displacement";
            return Err(self.error(
                "scheme.degree",
                what,
                "give degree 1 or more, or other conditions than contact and cohesive",
            ));
        }
        let rate = self.curl.values.number("alpha") * self.scheme.degree as f64;
        let curl = self.curl.build().relax.map(|relax| Control { relax, rate });
        let mut sources: Vec<_> = self.sources.iter().map(|s| self.source(s)).collect();
        // A solution has a body force everywhere and always, or nowhere.
        if let Some(exact) = self.build_exact().filter(|exact| exact.body_force([0.0; 2], 0.0).is_some()) {
            sources.push(Arc::new(ExactForce(exact)));
        }
        let (laws, flux) = (self.laws(), (self.scheme.flux.build().make)());
        let scheme = Scheme::new(operators, laws, self.integration(), flux, boundaries)?;
        let scheme = scheme.with_pairings(&pairings).map_err(|why| self.at_cut(why))?;
        let scheme = scheme.with_sources(sources).with_corrections(self.limiters()).with_kernel(kernel);
        let scheme = scheme.with_rescue(self.limiter.values.boolean("rescue").then(Rescue::default));
        let mut scheme = match self.scheme.angular_momentum {
            true => self.keeping_angular_momentum(scheme)?,
            false => scheme,
        };
        if self.scheme.springs {
            scheme = scheme.with_springs().map_err(|why| why.or_at(self.place("scheme.springs")))?;
        }
        scheme.scene = differences::hash(self);
        // Constants have no curl.
        match curl.filter(|_| self.scheme.degree > 0) {
            Some(control) => scheme.with_curl(control),
            None => Ok(scheme),
        }
    }

    fn keeping_angular_momentum(&self, scheme: Scheme) -> Result<Scheme> {
        if self.boundaries.iter().any(Boundary::is_joined) {
            let what = "a body that goes on at a periodic boundary has no angular momentum that could be kept";
            return Err(self.error("scheme.angular_momentum", what, "remove this key, or the periodic boundary"));
        }
        scheme.keeping_angular_momentum().map_err(|why| why.or_at(self.place("scheme.angular_momentum")))
    }

    /// An error of the pairs of a cut, at its condition.
    fn at_cut(&self, why: Error) -> Error {
        let of_cut = |boundary: &Boundary| {
            let interaction =
                boundary.condition.build().between.as_ref().map(|between| (between.make)(&boundary.condition.values));
            interaction.is_some_and(|interaction| interaction.pairs() == Pairs::Initial)
        };
        match (why, self.boundaries.iter().position(of_cut)) {
            (Error::Input { what, remedy, .. }, Some(k)) => self.error(&format!("boundary.{k}.group"), what, remedy),
            (why, _) => why,
        }
    }

    /// The limiter of the scene, where it has one: constants have no slopes.
    fn limiters(&self) -> Vec<Arc<dyn Correction>> {
        let (values, degree) = (&self.limiter.values, self.scheme.degree);
        let make = self.limiter.build().make.filter(|_| degree > 0);
        make.map(|make| make(values, degree)).into_iter().collect()
    }

    /// The condition of a group.
    fn condition(&self, group: &str) -> Result<Arc<dyn boundary::Boundary>> {
        match self.boundaries.iter().position(|boundary| boundary.group == group) {
            Some(k) => Ok((self.boundaries[k].condition.build().make)(&self.values_of_boundary(k)?)),
            // `check_mesh` has refused groups without a condition; no face looks at that of a periodic group.
            None => Ok(Arc::new(boundary::Free)),
        }
    }

    fn source(&self, source: &scene::Source) -> Arc<dyn source::Source> {
        let named = |m: &scene::Material| source.group.is_some() && m.group == source.group;
        (source.source.build())(&source.source.values, self.materials.iter().position(named))
    }

    /// The speeds that conditions prescribe: the group, and one component (along N) or both, m/s.
    pub fn prescribed_speeds(&self) -> Vec<(&str, Vec<&Expression>)> {
        fn of(boundary: &Boundary) -> Vec<&Expression> {
            let speeds = boundary.condition.expressions().filter(|(parameter, _)| parameter.unit == "m/s");
            speeds.flat_map(|(_, all)| all).collect()
        }
        self.boundaries.iter().map(|boundary| (boundary.group.as_str(), of(boundary))).collect()
    }

    /// dt c / h beyond which the method is unstable with the flux of the scene.
    pub fn step_limit(&self) -> f64 {
        let (n, integration) = (self.scheme.degree, self.integration());
        let flux = self.scheme.flux.build();
        let holds = (flux.make)().looks() == Looks::Displacement;
        let held = if holds { cfl::share_when_held(&integration, n) } else { 1.0 };
        held * flux.share * cfl::limit(&integration, n)
    }

    /// dt c / h and the end.
    ///
    /// # Errors
    /// A step beyond the stability limit.
    pub fn settings(&self) -> Result<Settings> {
        let (n, limit) = (self.scheme.degree, self.step_limit());
        if limit == 0.0 {
            return Err(self.error(
                "scheme.time_degree",
                format!("explicit Euler (time_degree = 0) is unstable at every step for degree {n}"),
                "give time_degree from 1 to 6 (the default is the degree), or degree = 0",
            ));
        }
        let (key, safety) = match self.scheme.step {
            Step::Safety(safety) => ("scheme.safety", safety),
            Step::Cfl(cfl) => ("scheme.cfl", cfl / ((2 * n + 1) as f64 * limit)),
        };
        if safety > 1.0 {
            let allowed = limit * (2 * n + 1) as f64;
            return Err(self.error(
                key,
                format!("the step is {safety:.2} of the stability limit in 2D (dt c / h = {limit:.4} for degree {n}) and blows up"),
                format!("give scheme.safety up to 1 (0.9 is the default), or scheme.cfl up to {allowed:.3}"),
            ));
        }
        let decay: f64 = self.sources.iter().map(|source| self.source(source).decay()).sum();
        Ok(Settings {
            end: self.end,
            courant: safety * limit,
            decay: decay / (safety * cfl::DECAY),
            watch: self.watch.map(|scene::Watch { warn, stop }| WatchLimits { warn, stop }),
        })
    }
}
