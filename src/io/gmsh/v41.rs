//! Entities, nodes and elements of MSH 4.1.

use std::collections::HashMap;

use super::Raw;
use super::error::Error;
use super::kinds::Kind;
use super::source::Source;

/// Physical tags of each entity, by dimension and tag.
pub type Entities = HashMap<(i32, i32), Vec<i32>>;

/// Numbers of points, curves, surfaces, volumes; then `tag box number-of-physical-tags tags.. number-of-bounds bounds..`
/// each, the box being one point for points and two for the others, which alone have bounds.
pub fn entities(source: &mut Source, raw: &mut Raw, entities: &mut Entities) -> Result<(), Error> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = source.size("a number of entities")?;
    }
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = source.int("the tag of an entity")?;
            entity(source, raw, entities, (dimension, tag))?;
        }
    }
    Ok(())
}

/// The entities of a partitioned mesh. Each entity begins with `tag parent-dimension parent-tag
/// number-of-partitions partitions..`.
pub fn partitioned_entities(source: &mut Source, raw: &mut Raw, entities: &mut Entities) -> Result<(), Error> {
    source.size("the number of partitions")?;
    for _ in 0..source.size("the number of ghost entities")? {
        ints(source, 2, "a ghost entity")?;
    }
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = source.size("a number of entities")?;
    }
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = source.int("the tag of an entity")?;
            ints(source, 2, "the parent of an entity")?;
            let partitions = source.size("the number of partitions")?;
            ints(source, partitions, "a partition")?;
            entity(source, raw, entities, (dimension, tag))?;
        }
    }
    Ok(())
}

fn entity(source: &mut Source, raw: &mut Raw, entities: &mut Entities, key: (i32, i32)) -> Result<(), Error> {
    for _ in 0..if key.0 == 0 { 3 } else { 6 } {
        source.double("a coordinate of an entity")?;
    }
    let mut physical = Vec::new();
    for _ in 0..source.size("the number of physical tags")? {
        let tag = source.int("a physical tag")?;
        let tag = tag.checked_abs().ok_or_else(|| source.wrong("a physical tag"))?;
        // Gmsh adds groups of its own to the parts of a partitioned mesh; they are not the user's.
        let own = raw.names.get(&(key.0, tag)).is_some_and(|name| name.starts_with("_part{"));
        if !own && tag != 0 && !physical.contains(&tag) {
            physical.push(tag);
        }
    }
    if key.0 > 0 {
        let bounds = source.size("the number of bounds of an entity")?;
        ints(source, bounds, "a bound of an entity")?;
    }
    raw.surfaces |= key.0 == 2 && !physical.is_empty();
    entities.insert(key, physical);
    Ok(())
}

fn ints(source: &mut Source, count: u64, what: &str) -> Result<(), Error> {
    for _ in 0..count {
        source.int(what)?;
    }
    Ok(())
}

/// `blocks nodes min max`; each block `dimension entity parametric nodes`, then all numbers, then `x y z` each, with
/// as many parameters behind as the entity has dimensions if it is parametric.
pub fn nodes(source: &mut Source, raw: &mut Raw) -> Result<(), Error> {
    let blocks = head(source, "nodes")?;
    for _ in 0..blocks {
        let dimension = source.int("the dimension of an entity")?;
        let known = usize::try_from(dimension).ok().filter(|d| *d <= 3);
        let dimension = known.ok_or_else(|| source.wrong("a dimension from 0 to 3"))?;
        source.int("the tag of an entity")?;
        let parameters = match source.int("0 or 1 (parametric nodes)")? {
            0 => 0,
            1 => dimension,
            _ => return Err(source.wrong("0 or 1 (parametric nodes)")),
        };
        let count = source.size("the number of nodes of a block")?;
        let count = source.fits(count, 4 + parameters, 8 * (4 + parameters), "nodes")?;
        let first = raw.nodes.len();
        raw.nodes.reserve(count);
        for _ in 0..count {
            raw.nodes.push((source.size("the number of a node")?, [0.0; 3]));
        }
        for (_, x) in &mut raw.nodes[first..] {
            for x in x {
                *x = source.double("a coordinate")?;
            }
            for _ in 0..parameters {
                source.double("a parameter of a node")?;
            }
        }
    }
    Ok(())
}

/// `blocks elements min max`; each block `dimension entity type elements`, then `number nodes..` each.
pub fn elements(source: &mut Source, raw: &mut Raw, entities: &Entities) -> Result<(), Error> {
    let blocks = head(source, "elements")?;
    for _ in 0..blocks {
        let dimension = source.int("the dimension of an entity")?;
        let entity = source.int("the tag of an entity")?;
        let kind = Kind::of(source.int("the type of an element")?);
        let kind = kind
            .ok_or_else(|| source.wrong("a known type of element (lines are 1 and 8, quadrilaterals 3, 10 and 16)"))?;
        if i32::from(kind.dimension) != dimension {
            return Err(source.wrong(format!("elements of dimension {dimension}")));
        }
        let count = source.size("the number of elements of a block")?;
        let count = source.fits(count, 1 + kind.nodes, 8 * (1 + kind.nodes), "elements")?;
        let group = group(raw, entities, (dimension, entity), kind)?;
        for _ in 0..count {
            element(source, raw, kind, group)?;
        }
    }
    Ok(())
}

fn head(source: &mut Source, what: &str) -> Result<u64, Error> {
    let blocks = source.size(&format!("the number of blocks of {what}"))?;
    for _ in 0..3 {
        source.size(&format!("number, smallest and largest number of {what}"))?;
    }
    Ok(blocks)
}

/// The one physical group of an entity whose lines or quadrilaterals are about to be read, 0 for none.
fn group(raw: &Raw, entities: &Entities, key: (i32, i32), kind: Kind) -> Result<i32, Error> {
    match entities.get(&key).map_or(&[][..], Vec::as_slice) {
        [] => Ok(0),
        [group] => Ok(*group),
        _ if !(kind.is_line() || kind.is_quad()) => Ok(0),
        several => {
            let what = format!("{} {}", if key.0 == 1 { "curve" } else { "surface" }, key.1);
            let names = several.iter().map(|&tag| format!("`{}`", raw.name(key.0, tag))).collect();
            Err(Error::ManyGroups { what, names })
        }
    }
}

fn element(source: &mut Source, raw: &mut Raw, kind: Kind, group: i32) -> Result<(), Error> {
    let number = source.size("the number of an element")?;
    super::element(raw, kind, (number, group), || source.size("the number of a node"))
}
