//! `probability`: weights rounded to a list of pattern numbers (Lefebvre & Neyret 2003, §3.2,
//! probability map).

use super::{Arguments, Made};
use crate::diagnostic::{Diagnostic, Place, constructors};
use crate::graph::{Constant, Scalar};
use crate::manifest::Recipe;

/// The longest list; its width must fit the texture that small tables share.
const MAX_SIZE: i32 = 4096;
/// The length of a list of weights where none is given.
const DEFAULT_SIZE: u32 = 256;
/// The blank pattern: nothing is drawn.
const BLANK: i32 = -1;
/// The greatest number of a pattern: a pattern is a layer of a texture.
const MAX_PATTERN: i32 = 255;

/// The recipe of a constructor call.
///
/// # Errors
/// Neither a list nor weights, or both; a number that no pattern has; a weight below 0, or one above
/// 0 that no entry is left for.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let numbers = match (a.numbers("numbers"), a.numbers("weights")) {
        (Some(list), None) => listed(a, list)?,
        (None, Some(weights)) => weighed(a, weights)?,
        (list, _) => return Err(constructors::list_or_weights(a.place, list.is_some())),
    };
    let least = numbers.iter().copied().min().unwrap_or(BLANK);
    let greatest = numbers.iter().copied().max().unwrap_or(BLANK);
    let fields = [("size", numbers.len() as i32), ("least", least), ("reach", greatest + 1)];
    let constants = fields.map(|(name, value)| (name, Constant::ints(&[value]))).into();
    Ok(Made { recipe: Recipe::Probability { numbers }, constants, sampler: None, lender: None })
}

/// A list as it is written.
fn listed(a: &Arguments, list: &[(Constant, Place)]) -> Result<Vec<i32>, Diagnostic> {
    if a.int("size") != 0 || a.float("blank") != 0.0 {
        let name = if a.int("size") != 0 { "size" } else { "blank" };
        return Err(constructors::size_of_a_list(a.place(name), list.len()));
    }
    if !(1..=MAX_SIZE as usize).contains(&list.len()) {
        let length = i32::try_from(list.len()).unwrap_or(i32::MAX);
        return Err(constructors::out_of_bounds(a.place("numbers"), "length", length, 1, MAX_SIZE));
    }
    let number = |(number, place): &(Constant, Place)| match number.int(0) {
        _ if number.scalar() != Scalar::Int => Err(constructors::not_a_list_of_patterns(*place)),
        pattern if (BLANK..=MAX_PATTERN).contains(&pattern) => Ok(pattern),
        pattern => Err(constructors::out_of_bounds(*place, "pattern", pattern, BLANK, MAX_PATTERN)),
    };
    list.iter().map(number).collect()
}

/// A list of each pattern as often as its weight asks for; blank entries stand last.
fn weighed(a: &Arguments, given: &[(Constant, Place)]) -> Result<Vec<i32>, Diagnostic> {
    let size = if a.int("size") == 0 { DEFAULT_SIZE } else { a.count("size", 1, MAX_SIZE)? };
    if given.len() > MAX_PATTERN as usize + 1 {
        return Err(constructors::too_many_patterns(a.place("weights"), given.len() as i64));
    }
    let blank = (Constant::floats(&[a.float("blank")]), a.place("blank"));
    let all: Vec<(f64, Place)> = given.iter().chain([&blank]).map(|(c, at)| (weight(c), *at)).collect();
    if let Some((_, place)) = all.iter().find(|(weight, _)| *weight < 0.0) {
        return Err(constructors::negative_weight(*place));
    }
    let weights: Vec<f64> = all.iter().map(|(weight, _)| *weight).collect();
    if weights.iter().all(|weight| *weight == 0.0) {
        return Err(constructors::nothing_probable(a.place("weights")));
    }
    let counts = apportioned(&weights, size);
    if let Some(i) = unheard(&weights, &counts) {
        let place = all.get(i).map_or(a.place, |(_, place)| *place);
        return Err(constructors::list_too_short(place, size, least_size(&weights, size)));
    }
    let patterns = (0..given.len() as i32).chain([BLANK]);
    Ok(patterns
        .zip(counts)
        .flat_map(|(pattern, count)| std::iter::repeat_n(pattern, count as usize))
        .collect())
}

fn weight(number: &Constant) -> f64 {
    match number.scalar() {
        Scalar::Float => f64::from(number.float(0)),
        Scalar::Int | Scalar::Bool => f64::from(number.int(0)),
    }
}

/// The first weight above 0 that has no entry.
fn unheard(weights: &[f64], counts: &[u32]) -> Option<usize> {
    weights.iter().zip(counts).position(|(weight, count)| *weight > 0.0 && *count == 0)
}

/// The least size, above one that is too small, in which every weight has an entry; 0 where a list
/// can't be that long.
fn least_size(weights: &[f64], size: u32) -> u32 {
    let fits = |size: &u32| unheard(weights, &apportioned(weights, *size)).is_none();
    (size + 1..=MAX_SIZE as u32).find(fits).unwrap_or(0)
}

/// `size` entries in proportion to weights, whose sum is above 0, by largest remainder: each has the
/// whole part of its share, and what is left goes to the greatest remainders, the first of equals.
fn apportioned(weights: &[f64], size: u32) -> Vec<u32> {
    let sum: f64 = weights.iter().sum();
    let shares: Vec<f64> = weights.iter().map(|weight| weight / sum * f64::from(size)).collect();
    let mut counts: Vec<u32> = shares.iter().map(|share| share.floor() as u32).collect();
    let mut order: Vec<usize> = (0..shares.len()).collect();
    order.sort_by(|a, b| shares[*b].fract().total_cmp(&shares[*a].fract()));
    let left = size.saturating_sub(counts.iter().sum());
    for i in order.into_iter().take(left as usize) {
        counts[i] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::{apportioned, least_size};

    #[test]
    fn entries_are_shared_by_largest_remainder() {
        assert_eq!(apportioned(&[8.0, 8.0, 4.0, 4.0, 1.0, 1.0, 1.0, 1.0], 64), [18, 18, 9, 9, 3, 3, 2, 2]);
        assert_eq!(apportioned(&[1.0, 1.0, 1.0], 64), [22, 21, 21]);
        assert_eq!(apportioned(&[3.0, 1.0, 0.0], 4), [3, 1, 0]);
        for size in 1..200 {
            let counts = apportioned(&[0.3, 5.0, 0.0, 1e-3, 2.7], size);
            assert_eq!(counts.iter().sum::<u32>(), size);
            assert_eq!(counts[2], 0);
        }
    }

    #[test]
    fn the_least_size_is_the_first_that_hears_every_weight() {
        assert_eq!(least_size(&[1000.0, 1.0], 64), 501);
        assert_eq!(least_size(&[1e9, 1.0], 64), 0);
    }
}
