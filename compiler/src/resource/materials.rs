//! `materials`: probabilities or patterns chosen by a number (Lefebvre & Neyret 2003, §3.2, materials
//! map).

use super::{Argument, Arguments, Filter, Made, Part};
use crate::diagnostic::{Diagnostic, constructors};
use crate::graph::{Constant, Scalar};
use crate::manifest::Recipe;

/// The longest row of the texture that small tables share.
const MAX_ROW: u64 = 8192;
/// The longest that all lists are made to give them one length.
const MAX_COMMON: u64 = 4096;
/// The most layers of a texture.
const MAX_LAYERS: i32 = 256;
/// The greatest number of a family.
const MAX_FAMILY: i32 = 255;
/// The longest side to which patterns are resampled.
const MAX_SIDE: i32 = 8192;

/// The recipe of a constructor call.
///
/// # Errors
/// No materials, or ones of different kinds or ways to be read; families of others; lists or layers
/// that are too many together.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let parts = a.parts("items");
    let first = parts.first().ok_or_else(|| constructors::no_materials(a.place("items")))?;
    let is_patterns = of_one_kind(parts, first)?;
    let size = if is_patterns { size(a)? } else { None };
    let tiles = if is_patterns { layers(a, parts)? } else { 0 };
    let lengths: Vec<u64> = parts.iter().map(|part| length(part, is_patterns, tiles)).collect();
    let length = common(a, &lengths)?;
    let bounds = if is_patterns { (0, tiles) } else { reach(parts) };
    let is_linear = first.sampler.is_none_or(|sampler| sampler.filter == Filter::Linear);
    let fields = [
        ("count", parts.len() as i32),
        ("size", length as i32),
        ("least", bounds.0),
        ("reach", bounds.1),
        ("tiles", tiles),
        ("linear", i32::from(is_linear)),
        ("taps", first.int("taps")),
        ("normals", first.int("normals")),
    ];
    let items = parts.iter().map(|part| part.index).collect();
    Ok(Made {
        recipe: Recipe::Materials { items, families: families(a, parts.len())?, length, size },
        constants: fields.map(|(name, value)| (name, Constant::ints(&[value]))).into(),
        sampler: first.sampler,
        lender: None,
    })
}

/// Whether all are patterns, rather than all probabilities.
fn of_one_kind(parts: &[Part], first: &Part) -> Result<bool, Diagnostic> {
    for part in parts {
        match part.kind {
            "probability" | "patterns" if part.kind == first.kind => {}
            "probability" | "patterns" => {
                return Err(constructors::not_a_material(part.place, part.kind, Some(first.kind)));
            }
            kind => return Err(constructors::not_a_material(part.place, kind, None)),
        }
        let encoding = |part: &Part| match part.recipe {
            Recipe::Patterns { encoding, .. } => Some(encoding),
            _ => None,
        };
        if encoding(part) != encoding(first) {
            return Err(constructors::materials_differ(part.place, "encoding"));
        }
        if part.sampler.map(|s| s.filter) != first.sampler.map(|s| s.filter) {
            return Err(constructors::materials_differ(part.place, "filter"));
        }
        if part.sampler != first.sampler || part.int("taps") != first.int("taps") {
            return Err(constructors::materials_differ(part.place, "anisotropy"));
        }
    }
    Ok(first.kind == "patterns")
}

/// The size to which patterns are resampled, if one is given.
fn size(a: &Arguments) -> Result<Option<[u32; 2]>, Diagnostic> {
    let size = match a.get("size") {
        Some((Argument::Number(c), _)) => [c.int(0), c.int(1)],
        _ => [0, 0],
    };
    match size.iter().find(|side| !(1..=MAX_SIDE).contains(*side)) {
        _ if size == [0, 0] => Ok(None),
        Some(side) => Err(constructors::out_of_bounds(a.place("size"), "size", *side, 1, MAX_SIDE)),
        None => Ok(Some(size.map(|side| side as u32))),
    }
}

/// The layers of all patterns together.
fn layers(a: &Arguments, parts: &[Part]) -> Result<i32, Diagnostic> {
    let tiles: i64 = parts.iter().map(|part| i64::from(part.int("count"))).sum();
    let count = i32::try_from(tiles).ok().filter(|count| *count <= MAX_LAYERS);
    count.ok_or_else(|| constructors::too_many_patterns(a.place("items"), tiles))
}

/// The least number that any list holds, and one more than the greatest.
fn reach(parts: &[Part]) -> (i32, i32) {
    let least = parts.iter().map(|part| part.int("least")).min();
    let reach = parts.iter().map(|part| part.int("reach")).max();
    (least.unwrap_or(0), reach.unwrap_or(0))
}

/// Entries of a material's list: as often the whole of it as the numbers in it need.
fn length(part: &Part, is_patterns: bool, tiles: i32) -> u64 {
    let (entries, reach) =
        if is_patterns { (part.int("count"), tiles) } else { (part.int("size"), part.int("reach")) };
    let entries = entries.max(1);
    u64::from(entries.unsigned_abs())
        * u64::from(reach.unsigned_abs()).div_ceil(u64::from(entries.unsigned_abs())).max(1)
}

/// The length of all lists, where one is short enough; else 0.
fn common(a: &Arguments, lengths: &[u64]) -> Result<u32, Diagnostic> {
    let count = lengths.len() as u64;
    let multiple =
        lengths.iter().fold(
            1,
            |all: u64, length| {
                if all > MAX_COMMON { all } else { all / divisor(all, *length) * length }
            },
        );
    if multiple * count <= MAX_COMMON {
        return Ok(multiple as u32);
    }
    let entries = count + lengths.iter().sum::<u64>();
    if entries > MAX_ROW {
        return Err(constructors::materials_too_long(a.place("items"), entries, MAX_ROW));
    }
    Ok(0)
}

/// The greatest common divisor.
fn divisor(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

/// The family of each material: its own, if none are given.
fn families(a: &Arguments, materials: usize) -> Result<Vec<i32>, Diagnostic> {
    let Some(given) = a.numbers("families") else { return Ok((0..materials as i32).collect()) };
    if given.len() != materials {
        return Err(constructors::families_of_others(a.place("families"), given.len(), materials));
    }
    let family = |(number, place): &(Constant, crate::diagnostic::Place)| match number.int(0) {
        _ if number.scalar() != Scalar::Int => {
            Err(constructors::wrong_argument(*place, "families", "a list of ints"))
        }
        family if (0..=MAX_FAMILY).contains(&family) => Ok(family),
        family => Err(constructors::out_of_bounds(*place, "family", family, 0, MAX_FAMILY)),
    };
    given.iter().map(family).collect()
}
