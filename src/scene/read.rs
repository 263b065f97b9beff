//! A document to a [`Scene`]: which tables it has, and what holds between the keys of a table.

use super::mesh::mesh;
use super::origin::Origin;
use super::points::General;
use super::reader::Reader;
use super::tables::{self, SAFETY, WATCHED};
use super::{Boundary, Cloud, Exact, Initial, Material, Scene, Scheme, Source, Step, Watch};
use crate::error::Result;
use crate::expression::Expression;
use crate::registry::{
    CONDITIONS, CONTROLS, Chosen, Entry, FLUXES, LAWS, LIMITERS, METHODS, Parameter, SOLUTIONS, SOURCES, Sweeps, Table,
    Value, controls, defaults, fluxes, laws, limiters,
};
use std::path::PathBuf;
use toml_edit::Document;

/// Reads a whole scene.
pub(super) fn scene(document: &Document<&str>, origin: Origin) -> Result<Scene> {
    let mut root = Reader::new(document.as_table(), Vec::new(), &origin, "the scene".to_owned());
    let title = root.text("title")?;
    let mut mesh_table = root.table("mesh")?;
    let mut cloud_table = root.table("cloud")?;
    let mut material_tables = root.tables("material")?;
    let mut initial_table = root.table("initial")?;
    let mut exact_table = root.table("exact")?;
    let boundary_tables = root.tables("boundary")?;
    let source_tables = root.tables("source")?;
    let mut curl_table = root.table("curl")?;
    let mut limiter_table = root.table("limiter")?;
    let mut scheme_table = root.table("scheme")?;
    let mut time_table = root.table("time")?;
    let mut watch_table = root.table("watch")?;
    let mut checkpoint_table = root.table("checkpoint")?;
    let output_tables = root.tables("output")?;
    let quantity_tables = root.tables("quantity")?;
    let regrid_tables = root.tables("regrid")?;
    root.finish()?;

    let need = |key: &'static str, remedy: &str| root.missing(key, remedy);
    let (mesh, mesh_groups) =
        mesh(mesh_table.as_mut().ok_or_else(|| need("mesh", "add [mesh] with file = \"name.msh\""))?)?;
    let mut scheme =
        scheme(scheme_table.as_mut().ok_or_else(|| need("scheme", "add [scheme] with method and degree"))?)?;
    let degree = scheme.degree;
    let boundaries = boundaries(boundary_tables, degree)?;
    let general = super::points::cloud(cloud_table.as_mut(), degree, boundaries.iter().any(Boundary::presses))?;
    if material_tables.is_empty() {
        return Err(need("material", "add [[material]] with law, density and the law's parameters"));
    }
    let materials = materials(&mut material_tables, &general, degree)?;
    let limiter = chosen(limiter_table.as_mut(), &tables::LIMITER[0], (&LIMITERS, limiters::DEFAULT), degree)?;
    let names_a_flux = scheme_table.as_ref().is_some_and(|table| table.has("flux"));
    let other = |material: &Material| laws::has_memory(material.law.entry) || laws::is_soft(&material.law);
    let keeps_its_flux = names_a_flux || degree == 0 || materials.iter().any(other);
    if let Some(entry) = limiter.build().flux.filter(|_| !keeps_its_flux).and_then(|name| FLUXES.find(name)) {
        scheme.flux = Chosen { entry, values: Default::default() };
    }
    if let (true, Some(table)) = (scheme.springs, &scheme_table) {
        let of_limiter = limiter.build().flux.filter(|_| !names_a_flux).map(|_| limiter.name());
        springs(table, &scheme, &materials, of_limiter)?;
    }
    let (start, end) = time(time_table.as_mut().ok_or_else(|| need("time", "add [time] with end, in s"))?)?;
    let scene = Scene {
        title: title.unwrap_or_else(|| origin.path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
        mesh,
        mesh_groups,
        initial: initial(initial_table.as_mut(), &general.cloud)?,
        cloud: general.cloud,
        limits: general.limits,
        exact: exact(exact_table.as_mut(), initial_table.is_none(), degree)?,
        boundaries,
        sources: source_tables.into_iter().map(|table| source(table, degree)).collect::<Result<_>>()?,
        curl: chosen(curl_table.as_mut(), &tables::CURL[0], (&CONTROLS, controls::DEFAULT), degree)?,
        limiter,
        scheme,
        start,
        end,
        outputs: super::outputs::outputs(output_tables, &materials, [start, end], degree)?,
        quantities: super::quantities::quantities(quantity_tables, &materials, [start, end], degree)?,
        materials,
        watch: watch(watch_table.as_mut())?,
        checkpoint: checkpoint_table.as_mut().map(super::times::checkpoint).transpose()?,
        regrids: super::regrid::regrids(regrid_tables, [start, end], degree)?,
        origin: Origin::default(),
    };
    Ok(Scene { origin, ..scene })
}

fn scheme(table: &mut Reader) -> Result<Scheme> {
    table.later(&["impedance"]);
    let mut values = table.values(tables::SCHEME)?;
    table.finish()?;
    table.complete(tables::SCHEME, &mut values, 0)?;
    let (method, flux) =
        (METHODS.find(values.text("method")), FLUXES.find(values.maybe_text("flux").unwrap_or(fluxes::DEFAULT)));
    // Both names have been found in their lists.
    let method = method.unwrap_or(METHODS.first()).build.method;
    let flux = Chosen { entry: flux.unwrap_or(FLUXES.first()), values: Default::default() };
    let degree = values.integer("degree");
    let step = match (values.maybe("cfl"), values.maybe("safety")) {
        (Some(cfl), None) => Step::Cfl(cfl),
        (None, safety) => Step::Safety(safety.unwrap_or(SAFETY)),
        (Some(_), Some(_)) => {
            let remedy = "cfl is the paper's dt = cfl h / ((2N+1) c), safety a share of the measured limit: keep one";
            return Err(table.wrong("safety", "[scheme] has both `cfl` and `safety`", remedy));
        }
    };
    let time_degree = values.maybe_integer("time_degree").unwrap_or(degree);
    let named = |name: &str| Sweeps::NAMES.iter().find(|(known, _)| *known == name).map(|(_, sweeps)| *sweeps);
    let sweeps = match values.maybe_text("sweeps").and_then(named) {
        Some(Sweeps::Ladder) if time_degree != degree => {
            let what = format!("the ladder needs time_degree = degree, and here they are {time_degree} and {degree}");
            let remedy = "give sweeps = \"paper\" (the default where the degrees differ), or equal degrees";
            return Err(table.wrong("sweeps", &what, remedy));
        }
        Some(sweeps) => sweeps,
        None if time_degree == degree => Sweeps::Ladder,
        None => Sweeps::Paper,
    };
    let angular_momentum = values.boolean("angular_momentum");
    let springs = values.boolean("springs");
    Ok(Scheme { method, degree, time_degree, flux, step, sweeps, angular_momentum, springs })
}

/// Whether faces can have the springs that a scene asks for; `limiter` is the name of one that chose the flux.
fn springs(table: &Reader, scheme: &Scheme, materials: &[Material], limiter: Option<&str>) -> Result<()> {
    let wrong = |what: &str, remedy: &str| Err(table.wrong("springs", what, remedy));
    if scheme.degree == 0 {
        let what = "at degree 0 the jump at a face is all that a cell knows of its neighbour, and no spring holds it";
        return wrong(what, "give degree 1 or more, or remove this key");
    }
    if !fluxes::may_have_springs(scheme.flux.build()) {
        let of_limiter = limiter.map_or(String::new(), |name| format!(", which the limiter `{name}` brings"));
        let what =
            format!("springs in the faces need the flux `dual`, and here it is `{}`{of_limiter}", scheme.flux.name());
        return wrong(&what, "give flux = \"dual\", or remove this key");
    }
    if materials.iter().all(|material| laws::has_memory(material.law.entry)) {
        let what = "a law with internal variables has no springs in its faces: where it flows they would make energy";
        return wrong(what, "remove this key, or give a part of the body another law");
    }
    Ok(())
}

fn materials(tables: &mut [Reader], general: &General, degree: usize) -> Result<Vec<Material>> {
    let several = tables.len() > 1;
    let mut materials: Vec<Material> = Vec::with_capacity(tables.len());
    for table in tables {
        let material = material(table, general, degree)?;
        if several && material.group.is_none() {
            return Err(table.missing("group", "with several materials each names its group of cells"));
        }
        if materials.iter().any(|other| other.group == material.group) {
            let group = material.group.unwrap_or_default();
            let remedy = "a group of cells has one material: remove one, or give it another group";
            return Err(table.wrong("group", format!("two [[material]] on the group \"{group}\""), remedy));
        }
        materials.push(material);
    }
    Ok(materials)
}

fn material(table: &mut Reader, general: &General, degree: usize) -> Result<Material> {
    let group = table.text("group")?;
    let law = table.entry(&tables::LAW, &LAWS)?;
    let mut values = table.values(law.parameters)?;
    let (cloud, histories) = super::points::of_material(table, general, law.name, laws::has_memory(law), degree)?;
    table.finish()?;
    table.complete(law.parameters, &mut values, degree)?;
    table.fits(law, &values)?;
    Ok(Material { group, law: Chosen { entry: law, values }, cloud, histories })
}

fn initial(table: Option<&mut Reader>, cloud: &Cloud) -> Result<Initial> {
    let number = Expression::number;
    let mut initial = Initial {
        from_cloud: false,
        velocity: [number(0.0), number(0.0)],
        deformation: [number(1.0), number(0.0), number(0.0), number(1.0)],
        snapshot: None,
        fields: None,
    };
    let Some(table) = table else { return Ok(initial) };
    if let Some(path) = table.text("snapshot")? {
        alone(table, "snapshot", "keep one: a snapshot holds the whole state")?;
        table.finish()?;
        return Ok(Initial { snapshot: Some(PathBuf::from(path)), ..initial });
    }
    initial.from_cloud = table.values(&[tables::FROM])?.has("from");
    if initial.from_cloud {
        alone(table, "from", "keep one: with `from` the whole state comes from the cloud file")?;
        if !cloud.layout.build().is_file() {
            let remedy = "give [cloud] layout = \"file\" and path, such as the points_*.vtu of an export";
            return Err(table.wrong("from", "the points of this scene come from no file", remedy));
        }
        table.finish()?;
        return Ok(initial);
    }
    initial.fields = super::fields::read(table)?;
    if let Some(velocity) = table.expressions("velocity")? {
        at_start(table, "velocity", &velocity)?;
        initial.velocity = velocity;
    }
    if let Some(deformation) = table.expressions("deformation")? {
        at_start(table, "deformation", &deformation)?;
        if let [Some(f11), Some(f12), Some(f21), Some(f22)] = deformation.each_ref().map(Expression::constant)
            && f11 * f22 <= f12 * f21
        {
            let what = format!("`deformation` has the determinant J = {}", f11 * f22 - f12 * f21);
            return Err(table.wrong("deformation", what, "J must be greater than 0; the order is F11, F12, F21, F22"));
        }
        initial.deformation = deformation;
    }
    table.finish()?;
    Ok(initial)
}

/// Whether a key is the only one of `[initial]`.
fn alone(table: &Reader, key: &str, remedy: &str) -> Result<()> {
    let other = tables::INITIAL.iter().map(|other| other.name).find(|other| *other != key && table.has(other));
    other.map_or(Ok(()), |other| Err(table.wrong(other, format!("[initial] has both `{key}` and `{other}`"), remedy)))
}

/// Initial values are values at t = 0.
fn at_start(table: &Reader, key: &str, expressions: &[Expression]) -> Result<()> {
    match expressions.iter().position(Expression::depends_on_time) {
        Some(i) => {
            Err(table.wrong_entry(key, i, format!("`{key}` depends on t"), "initial values depend on x and y only"))
        }
        None => Ok(()),
    }
}

/// Reads `[exact]`; `initial` says whether the solution gives the initial state.
fn exact(table: Option<&mut Reader>, initial: bool, degree: usize) -> Result<Option<Exact>> {
    let Some(table) = table else { return Ok(None) };
    let entry = table.entry(&tables::EXACT[0], &SOLUTIONS)?;
    Ok(Some(Exact { solution: table.rest(entry, degree)?, initial }))
}

fn boundaries(tables: Vec<Reader>, degree: usize) -> Result<Vec<Boundary>> {
    let mut boundaries: Vec<Boundary> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let boundary = boundary(&mut table, degree)?;
        if boundaries.iter().any(|other| other.group == boundary.group) {
            let what = format!("two [[boundary]] on the group \"{}\"", boundary.group);
            return Err(table.wrong("group", what, "a group of edges has one condition: remove one"));
        }
        if let Some((key, partner)) = boundary.partner()
            && boundary.is_joined()
            && partner == boundary.group
        {
            let what = format!("the group \"{partner}\" is its own `{key}`");
            return Err(table.wrong(key, what, "name the group at the other side of the body"));
        }
        if let Some(other) = boundaries.iter().find(|other| disagree(other, &boundary)) {
            let what = format!("the conditions of \"{}\" and \"{}\" do not agree", other.group, boundary.group);
            let remedy = "groups that are periodic have one `partner` each; the partner of a group in contact has no [[boundary]] of its own, or one \
                          that is contact as well, and with the same `friction` where both name each other";
            return Err(table.wrong("group", what, remedy));
        }
        boundaries.push(boundary);
    }
    Ok(boundaries)
}

/// Whether a pair of conditions cannot both hold.
fn disagree(a: &Boundary, b: &Boundary) -> bool {
    let (of_a, of_b) = (a.partner().map(|(_, group)| group), b.partner().map(|(_, group)| group));
    let (to_b, to_a) = (of_a == Some(&b.group), of_b == Some(&a.group));
    if a.is_joined() || b.is_joined() {
        // One names the other and is not named back, or both name a third.
        return to_a != to_b || (of_a.is_some() && of_a == of_b);
    }
    // A body may touch several others. Whom one names must be in contact too, and in the same contact where it names it back.
    (to_a || to_b) && (a.condition.name() != b.condition.name() || (to_a && to_b && !act_alike(a, b)))
}

/// Whether two conditions that name each other are the same.
fn act_alike(a: &Boundary, b: &Boundary) -> bool {
    let but_partner = |one: &Boundary| {
        let mut values = one.condition.values.clone();
        one.partner().into_iter().for_each(|(key, _)| values.set(key, Value::Text(String::new())));
        values
    };
    but_partner(a) == but_partner(b)
}

fn boundary(table: &mut Reader, degree: usize) -> Result<Boundary> {
    let [group, kind] = [&tables::BOUNDARY[..1], &tables::BOUNDARY[1..]];
    let mut named = table.values(group)?;
    let entry = table.entry(&kind[0], &CONDITIONS)?;
    let condition = table.rest(entry, degree)?;
    table.complete(group, &mut named, degree)?;
    Ok(Boundary { group: named.text("group").to_owned(), condition })
}

fn source(mut table: Reader, degree: usize) -> Result<Source> {
    let group = table.text("group")?;
    let entry = table.entry(&tables::SOURCE[1], &SOURCES)?;
    Ok(Source { group, source: table.rest(entry, degree)? })
}

/// The entry that a table chooses by `key`, with the values of its parameters; that of the default where there is no such table.
fn chosen<B>(
    table: Option<&mut Reader>,
    key: &Parameter,
    (entries, default): (&'static Table<B>, &str),
    degree: usize,
) -> Result<Chosen<B>> {
    let default = entries.find(default).unwrap_or(entries.first());
    let Some(table) = table else {
        return Ok(Chosen { entry: default, values: defaults(default.parameters, degree) });
    };
    let entry: Option<&'static Entry<B>> = table.maybe_entry(key, entries)?;
    table.rest(entry.unwrap_or(default), degree)
}

fn watch(table: Option<&mut Reader>) -> Result<Option<Watch>> {
    let [stop, warn] = WATCHED;
    let Some(table) = table else { return Ok(Some(Watch { warn, stop })) };
    let values = table.values(tables::WATCH)?;
    table.finish()?;
    let off = values.has("energy") && values.maybe("energy").is_none();
    let stop = if off { f64::INFINITY } else { values.maybe("energy").unwrap_or(stop) };
    let warn = values.maybe("warn").unwrap_or(warn.min(stop));
    if off && table.has("warn") || warn > stop {
        let what =
            format!("the run would warn at {warn}, and {}", if off { "the watch is off" } else { "stop before" });
        return Err(table.wrong("warn", what, "give a share up to that of `energy`, or leave it out"));
    }
    Ok((!off).then_some(Watch { warn, stop }))
}

fn time(table: &mut Reader) -> Result<(f64, f64)> {
    let mut values = table.values(tables::TIME)?;
    table.finish()?;
    table.complete(tables::TIME, &mut values, 0)?;
    let (start, end) = (values.number("start"), values.number("end"));
    if end <= start {
        let what = format!("`end` is {end}, and the run starts at {start}");
        return Err(table.wrong("end", what, "give an end after the start"));
    }
    Ok((start, end))
}
