//! `probability`: a list of pattern numbers, each as often as it is probable (Lefebvre & Neyret 2003,
//! §3.2, probability map). A row of the shared tables: texel i holds (number i of the list, how often
//! the number i stands in the list, 0, 0).

use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};

/// The longest list.
const MAX_SIZE: usize = 4096;
/// From the blank pattern to the last layer that a texture may have.
const PATTERNS: std::ops::RangeInclusive<i32> = -1..=255;

/// The entries of the row: as many as the list has, or as many as the numbers reach.
///
/// # Errors
/// The list is empty or too long, or holds what is no pattern's number.
pub fn entries(place: Place, numbers: &[i32]) -> Result<Vec<[i32; 4]>, Vec<Diagnostic>> {
    let refuse = |message: String, reason: String| Err(vec![resources::no_table(place, message, reason)]);
    if !(1..=MAX_SIZE).contains(&numbers.len()) {
        let message = format!("a list of {} pattern numbers can't be made", numbers.len());
        return refuse(message, format!("its size is 1 to {MAX_SIZE}"));
    }
    if let Some(number) = numbers.iter().find(|number| !PATTERNS.contains(number)) {
        return refuse(format!("{number} is no pattern's number"), "patterns are -1 to 255".into());
    }
    let mut counts: Vec<i32> = vec![0; *PATTERNS.end() as usize + 1];
    for number in numbers {
        // The blank pattern is not counted: what is left of the list is it.
        if let Some(count) = usize::try_from(*number).ok().and_then(|number| counts.get_mut(number)) {
            *count += 1;
        }
    }
    let reach = counts.iter().rposition(|count| *count > 0).map_or(0, |last| last + 1);
    let entry = |i: usize| [numbers[i % numbers.len()], counts.get(i).copied().unwrap_or(0), 0, 0];
    Ok((0..numbers.len().max(reach)).map(entry).collect())
}
