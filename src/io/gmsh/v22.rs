//! Nodes and elements of MSH 2.2.

use super::Raw;
use super::error::Error;
use super::kinds::Kind;
use super::source::Source;

/// `number-of-nodes`, then `number x y z` each; in `$ParametricNodes` (`Mesh.SaveParametric = 1`) with `dimension entity`
/// behind them, and as many parameters as the entity is a curve (1) or a surface (2).
pub fn nodes(source: &mut Source, raw: &mut Raw, parametric: bool) -> Result<(), Error> {
    let count = source.number("the number of nodes")?;
    let more = if parametric { 2 } else { 0 };
    let count = source.fits(count, 4 + more, 4 + 3 * 8 + 4 * more, "nodes")?;
    source.line();
    raw.nodes.reserve(count);
    for _ in 0..count {
        let number = positive(source, "the number of a node")?;
        let mut x = [0.0; 3];
        for x in &mut x {
            *x = source.double("a coordinate")?;
        }
        raw.nodes.push((number, x));
        if parametric {
            parameters(source)?;
        }
    }
    Ok(())
}

/// Skips the entries of a parametric node after its coordinates.
fn parameters(source: &mut Source) -> Result<(), Error> {
    let count = match source.int("the dimension of an entity")? {
        0 | 3 => 0,
        1 => 1,
        2 => 2,
        _ => return Err(source.wrong("a dimension from 0 to 3")),
    };
    source.int("the tag of an entity")?;
    for _ in 0..count {
        source.double("a parameter of a node")?;
    }
    Ok(())
}

/// `number-of-elements`; then in text `number type number-of-tags tags.. nodes..` each; in binary blocks of
/// `type number-in-block number-of-tags`, then `number tags.. nodes..` each. The first tag is the physical group.
pub fn elements(source: &mut Source, raw: &mut Raw) -> Result<(), Error> {
    let count = source.number("the number of elements")?;
    let count = source.fits(count, 4, 4 + 4, "elements")?;
    source.line();
    let mut left = count;
    while left > 0 {
        let number = if source.binary { None } else { Some(positive(source, "the number of an element")?) };
        let kind = kind(source)?;
        let block = match number {
            Some(_) => 1,
            None => source.int("the number of elements of a block")?,
        };
        let block = usize::try_from(block).ok().filter(|n| (1..=left).contains(n));
        let block = block.ok_or_else(|| source.wrong(format!("a block of 1 to {left} elements")))?;
        let tags = source.int("the number of tags")?;
        let tags = u64::try_from(tags).map_err(|_| source.wrong("the number of tags"))?;
        let tags = source.fits(tags, 1, 4, "tags")?;
        for _ in 0..block {
            element(source, raw, kind, number, tags)?;
        }
        left -= block;
    }
    Ok(())
}

fn element(source: &mut Source, raw: &mut Raw, kind: Kind, number: Option<u64>, tags: usize) -> Result<(), Error> {
    let number = match number {
        Some(number) => number,
        None => positive(source, "the number of an element")?,
    };
    let mut group = 0;
    for tag in 0..tags {
        let value = source.int("a tag")?;
        if tag == 0 {
            // A negative tag only says that the curve is run through backwards.
            group = value.checked_abs().ok_or_else(|| source.wrong("a tag"))?;
        }
    }
    raw.surfaces |= kind.is_quad() && group != 0;
    super::element(raw, kind, (number, group), || node(source))
}

fn kind(source: &mut Source) -> Result<Kind, Error> {
    let kind = Kind::of(source.int("the type of an element")?);
    kind.ok_or_else(|| source.wrong("a known type of element (lines are 1 and 8, quadrilaterals 3, 10 and 16)"))
}

fn node(source: &mut Source) -> Result<u64, Error> {
    positive(source, "the number of a node")
}

fn positive(source: &mut Source, what: &str) -> Result<u64, Error> {
    match u64::try_from(source.int(what)?) {
        Ok(number) if number > 0 => Ok(number),
        _ => Err(source.wrong(what)),
    }
}
