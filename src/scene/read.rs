//! A document to a [`Scene`]: the keys of each table, with their ranges and defaults.

use std::path::PathBuf;

use toml_edit::Document;

use super::origin::Origin;
use super::points::General;
use super::reader::{Check, FINITE, POSITIVE, Reader};
use super::{
    Boundary, Cloud, Condition, Curl, Expression, Flux, Initial, LAWS, Layout, Material, Mesh, Method, Scene, Scheme,
    Source, Step, Sweeps,
};
use crate::error::Result;
use crate::run::Limits;

/// Reads a whole scene.
pub(super) fn scene(document: &Document<&str>, origin: Origin) -> Result<Scene> {
    let mut root = Reader::new(document.as_table(), Vec::new(), &origin, "the scene".to_owned());
    root.later(&["limiter", "checkpoint"]);
    let title = root.text("title")?;
    let mut mesh_table = root.table("mesh")?;
    let mut cloud_table = root.table("cloud")?;
    let mut material_tables = root.tables("material")?;
    let mut initial_table = root.table("initial")?;
    let mut exact_table = root.table("exact")?;
    let boundary_tables = root.tables("boundary")?;
    let source_tables = root.tables("source")?;
    let mut curl_table = root.table("curl")?;
    let mut scheme_table = root.table("scheme")?;
    let mut time_table = root.table("time")?;
    let mut watch_table = root.table("watch")?;
    let output_tables = root.tables("output")?;
    let regrid_tables = root.tables("regrid")?;
    root.finish()?;

    let need = |key: &'static str, remedy: &str| root.missing(key, remedy);
    let mesh = mesh(mesh_table.as_mut().ok_or_else(|| need("mesh", "add [mesh] with file = \"name.msh\""))?)?;
    let scheme = scheme(scheme_table.as_mut().ok_or_else(|| need("scheme", "add [scheme] with method and degree"))?)?;
    let general = super::points::cloud(cloud_table.as_mut(), scheme.degree)?;
    if material_tables.is_empty() {
        return Err(need("material", "add [[material]] with law, density and the law's parameters"));
    }
    let materials = materials(&mut material_tables, &general, scheme.degree)?;
    let (start, end) = time(time_table.as_mut().ok_or_else(|| need("time", "add [time] with end, in s"))?)?;
    let scene = Scene {
        title: title.unwrap_or_else(|| origin.path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
        mesh,
        initial: initial(initial_table.as_mut(), &general.cloud)?,
        cloud: general.cloud,
        limits: general.limits,
        exact: super::exact::exact(exact_table.as_mut(), initial_table.is_none())?,
        boundaries: boundaries(boundary_tables)?,
        sources: source_tables.into_iter().map(source).collect::<Result<_>>()?,
        curl: curl(curl_table.as_mut(), scheme.degree)?,
        scheme,
        start,
        end,
        outputs: super::outputs::outputs(output_tables, &super::laws::laws(&materials), start)?,
        materials,
        watch: watch(watch_table.as_mut())?,
        regrids: super::regrid::regrids(regrid_tables)?,
        origin: Origin::default(),
    };
    Ok(Scene { origin, ..scene })
}

fn mesh(table: &mut Reader) -> Result<Mesh> {
    let file = table.text("file")?;
    let rectangle = table.table("rectangle")?;
    table.finish()?;
    match (file, rectangle) {
        (Some(file), None) => Ok(Mesh::File(PathBuf::from(file))),
        (None, Some(mut rectangle)) => {
            let size = rectangle.array("size", POSITIVE)?;
            let cells = rectangle.array("cells", CELLS)?;
            rectangle.finish()?;
            let size = size.ok_or_else(|| rectangle.missing("size", "for instance size = [3.0, 3.0], in m"))?;
            let cells = cells.ok_or_else(|| rectangle.missing("cells", "for instance cells = [30, 30]"))?;
            Ok(Mesh::Rectangle { size, cells: cells.map(|n: f64| n as usize) })
        }
        (Some(_), Some(_)) => {
            Err(table.wrong("rectangle", "[mesh] has both `file` and `rectangle`", "keep one of them"))
        }
        (None, None) => Err(table.missing("file", "or rectangle = { size = [3.0, 3.0], cells = [30, 30] }")),
    }
}

const CELLS: Check =
    Check { range: "whole, from 1 to 100000", holds: |n| n.fract() == 0.0 && (1.0..=100_000.0).contains(&n) };

fn scheme(table: &mut Reader) -> Result<Scheme> {
    table.later(&["impedance"]);
    let method = table.choice("method", Method::NAMES, &[])?;
    let degree = table.integer("degree", 0..=6)?;
    let time_degree = table.integer("time_degree", 0..=6)?;
    let flux = table.choice("flux", Flux::NAMES, &[])?.unwrap_or(Flux::Dual);
    let cfl = table.number("cfl", POSITIVE)?;
    let safety = table.number("safety", POSITIVE)?;
    let sweeps = table.choice("sweeps", Sweeps::NAMES, &[])?;
    table.finish()?;
    let names = "\"ader-dgmpm\", \"ader-dgfem\" or \"rk-dgfem\"";
    let method = method.ok_or_else(|| table.missing("method", &format!("choose {names}")))?;
    let degree = degree.ok_or_else(|| table.missing("degree", "the degree N of the cells, 0 to 6"))?;
    let step = match (cfl, safety) {
        (Some(cfl), None) => Step::Cfl(cfl),
        (None, safety) => Step::Safety(safety.unwrap_or(0.9)),
        (Some(_), Some(_)) => {
            let remedy = "cfl is the paper's dt = cfl h / ((2N+1) c), safety a share of the measured limit: keep one";
            return Err(table.wrong("safety", "[scheme] has both `cfl` and `safety`", remedy));
        }
    };
    let time_degree = time_degree.unwrap_or(degree);
    let sweeps = match sweeps {
        Some(Sweeps::Ladder) if time_degree != degree => {
            let what = format!("the ladder needs time_degree = degree, and here they are {time_degree} and {degree}");
            let remedy = "give sweeps = \"paper\" (the default where the degrees differ), or equal degrees";
            return Err(table.wrong("sweeps", &what, remedy));
        }
        Some(sweeps) => sweeps,
        None if time_degree == degree => Sweeps::Ladder,
        None => Sweeps::Paper,
    };
    Ok(Scheme { method, degree, time_degree, flux, step, sweeps })
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
    let laws: Vec<(&str, usize)> = LAWS.iter().enumerate().map(|(i, law)| (law.name, i)).collect();
    let names: Vec<String> = laws.iter().map(|(name, _)| format!("\"{name}\"")).collect();
    let law = table.choice("law", &laws, &[])?;
    let law = law.ok_or_else(|| table.missing("law", &format!("there are {}", names.join(", "))))?;
    let law = &LAWS[law];
    let density = table.number("density", POSITIVE)?;
    let mut given = Vec::new();
    for parameter in law.parameters {
        given.push((parameter, table.number(parameter.name, parameter.check)?));
    }
    let (cloud, histories) = super::points::of_material(table, general, law, degree)?;
    table.finish()?;
    let density = density.ok_or_else(|| table.missing("density", "the density at t = 0, in kg/m^3"))?;
    let mut parameters = std::collections::BTreeMap::new();
    for (parameter, value) in given {
        let remedy = format!("law \"{}\": {}, {} {}", law.name, parameter.name, parameter.check.range, parameter.unit);
        let value = value.ok_or_else(|| table.missing(parameter.name, remedy.trim_end()))?;
        parameters.insert(parameter.name.to_owned(), value);
    }
    Ok(Material { group, law: law.name.to_owned(), density, parameters, cloud, histories })
}

fn initial(table: Option<&mut Reader>, cloud: &Cloud) -> Result<Initial> {
    let number = Expression::number;
    let mut initial = Initial {
        from_cloud: false,
        velocity: [number(0.0), number(0.0)],
        deformation: [number(1.0), number(0.0), number(0.0), number(1.0)],
        snapshot: None,
    };
    let Some(table) = table else { return Ok(initial) };
    if let Some(path) = table.text("snapshot")? {
        if let Some(other) = ["velocity", "deformation"].into_iter().find(|key| table.has(key)) {
            let what = format!("[initial] has both `snapshot` and `{other}`");
            return Err(table.wrong(other, what, "keep one: a snapshot holds the whole state"));
        }
        table.finish()?;
        return Ok(Initial { snapshot: Some(PathBuf::from(path)), ..initial });
    }
    initial.from_cloud = table.choice("from", &[("cloud", true)], &[])?.unwrap_or(false);
    if initial.from_cloud {
        table.of_kind("cloud");
        if !matches!(cloud.layout, Layout::File(_)) {
            let remedy = "give [cloud] layout = \"file\" and path, such as the points_*.vtu of an export";
            return Err(table.wrong("from", "the points of this scene come from no file", remedy));
        }
        table.finish()?;
        return Ok(initial);
    }
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

/// Initial values are values at t = 0.
fn at_start(table: &Reader, key: &str, expressions: &[Expression]) -> Result<()> {
    match expressions.iter().position(Expression::depends_on_time) {
        Some(i) => {
            Err(table.wrong_entry(key, i, format!("`{key}` depends on t"), "initial values depend on x and y only"))
        }
        None => Ok(()),
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Wall,
    Symmetry,
    Free,
    Clamped,
    Velocity,
    Traction,
    Absorbing,
    Periodic,
}

const KINDS: [(&str, Kind); 8] = [
    ("wall", Kind::Wall),
    ("symmetry", Kind::Symmetry),
    ("free", Kind::Free),
    ("clamped", Kind::Clamped),
    ("velocity", Kind::Velocity),
    ("traction", Kind::Traction),
    ("absorbing", Kind::Absorbing),
    ("periodic", Kind::Periodic),
];

fn boundaries(tables: Vec<Reader>) -> Result<Vec<Boundary>> {
    let mut boundaries: Vec<Boundary> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let boundary = boundary(&mut table)?;
        if boundaries.iter().any(|other| other.group == boundary.group) {
            let what = format!("two [[boundary]] on the group \"{}\"", boundary.group);
            return Err(table.wrong("group", what, "a group of edges has one condition: remove one"));
        }
        if matches!(&boundary.condition, Condition::Periodic { partner } if *partner == boundary.group) {
            let what = format!("the group \"{}\" is its own `partner`", boundary.group);
            return Err(table.wrong("partner", what, "name the group at the other side of the body"));
        }
        if let Some(other) = boundaries.iter().find(|other| rivals(other, &boundary)) {
            let what = format!("the conditions of \"{}\" and \"{}\" do not agree", other.group, boundary.group);
            let remedy = "a group has one `partner`, which is periodic to it or has no [[boundary]] of its own";
            return Err(table.wrong("group", what, remedy));
        }
        boundaries.push(boundary);
    }
    Ok(boundaries)
}

/// Whether one names the other or a third as its partner, and is not named back.
fn rivals(a: &Boundary, b: &Boundary) -> bool {
    let partner = |boundary: &Boundary| match &boundary.condition {
        Condition::Periodic { partner } => Some(partner.clone()),
        _ => None,
    };
    let (of_a, of_b) = (partner(a), partner(b));
    let (to_b, to_a) = (of_a.as_ref() == Some(&b.group), of_b.as_ref() == Some(&a.group));
    to_a != to_b || (of_a.is_some() && of_a == of_b)
}

fn boundary(table: &mut Reader) -> Result<Boundary> {
    table.later(&["gap", "friction"]);
    let group = table.text("group")?;
    let kind = table.choice("kind", &KINDS, &["unilateral", "contact"])?;
    let names: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
    let kind = kind.ok_or_else(|| table.missing("kind", &format!("one of {}", names.join(", "))))?;
    let value = |table: &mut Reader, unit: &str| {
        let value = table.expressions("value")?;
        value.ok_or_else(|| table.missing("value", &format!("two expressions of x, y, t, in {unit}")))
    };
    let condition = match kind {
        Kind::Wall => Condition::Wall { speed: table.expression("speed")?.unwrap_or_else(|| Expression::number(0.0)) },
        Kind::Symmetry => Condition::Symmetry,
        Kind::Free => Condition::Free,
        Kind::Clamped => Condition::Clamped,
        Kind::Velocity => Condition::Velocity(value(table, "m/s")?),
        Kind::Traction => Condition::Traction(value(table, "Pa")?),
        Kind::Absorbing => Condition::Absorbing,
        Kind::Periodic => {
            let partner = table.text("partner")?;
            let remedy = "the group at the other side of the body, for instance \"right\"";
            Condition::Periodic { partner: partner.ok_or_else(|| table.missing("partner", remedy))? }
        }
    };
    table.of_kind(names[kind as usize]);
    table.finish()?;
    let group = group.ok_or_else(|| table.missing("group", "the group of edges in the mesh, for instance \"left\""))?;
    Ok(Boundary { group, condition })
}

fn source(mut table: Reader) -> Result<Source> {
    let group = table.text("group")?;
    let gravity = table.choice("kind", &[("body-force", false), ("gravity", true)], &[])?;
    let gravity = gravity.ok_or_else(|| table.missing("kind", "\"body-force\" or \"gravity\""))?;
    let value = table.expressions("value")?;
    table.finish()?;
    let value = value.ok_or_else(|| table.missing("value", "two components per unit mass, in m/s^2"))?;
    if let (true, Some(i)) = (gravity, value.iter().position(|v| v.constant().is_none())) {
        let what = "gravity depends on x, y or t".to_owned();
        return Err(table.wrong_entry(
            "value",
            i,
            what,
            "gravity is constant; kind = \"body-force\" takes expressions",
        ));
    }
    Ok(Source { group, value })
}

fn curl(table: Option<&mut Reader>, degree: usize) -> Result<Curl> {
    let alpha = if degree >= 4 { 6.0 } else { 3.0 };
    let Some(table) = table else { return Ok(Curl::Rotation { alpha }) };
    let controls = [("rotation", Curl::Rotation { alpha }), ("lcf", Curl::Lcf { alpha }), ("off", Curl::Off)];
    let mut curl = table.choice("control", &controls, &["auto"])?.unwrap_or(Curl::Rotation { alpha });
    if let Curl::Rotation { alpha } | Curl::Lcf { alpha } = &mut curl {
        *alpha = table.number("alpha", POSITIVE)?.unwrap_or(*alpha);
    }
    table.of_kind(match curl {
        Curl::Rotation { .. } => "rotation",
        Curl::Lcf { .. } => "lcf",
        Curl::Off => "off",
    });
    table.finish()?;
    Ok(curl)
}

fn watch(table: Option<&mut Reader>) -> Result<Option<Limits>> {
    let Some(table) = table else { return Ok(Some(Limits::default())) };
    let off = table.is_text("energy", "off");
    let stop = if off { table.text("energy")?.map(|_| f64::INFINITY) } else { table.number("energy", POSITIVE)? };
    let warn = table.number("warn", POSITIVE)?;
    table.finish()?;
    let stop = stop.unwrap_or(Limits::default().stop);
    let warn = warn.unwrap_or(Limits::default().warn.min(stop));
    if off && table.has("warn") || warn > stop {
        let what =
            format!("the run would warn at {warn}, and {}", if off { "the watch is off" } else { "stop before" });
        return Err(table.wrong("warn", what, "give a share up to that of `energy`, or leave it out"));
    }
    Ok((!off).then_some(Limits { warn, stop }))
}

fn time(table: &mut Reader) -> Result<(f64, f64)> {
    let start = table.number("start", FINITE)?.unwrap_or(0.0);
    let end = table.number("end", POSITIVE)?;
    table.finish()?;
    let end = end.ok_or_else(|| table.missing("end", "the end time, in s"))?;
    if end <= start {
        let what = format!("`end` is {end}, and the run starts at {start}");
        return Err(table.wrong("end", what, "give an end after the start"));
    }
    Ok((start, end))
}
