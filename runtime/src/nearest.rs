//! Which name was meant.

/// The candidate nearest to `name`, if one is near enough to be a slip of the keyboard: at most a
/// third of the characters wrong, capitals not counted. The first of equals.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = name.to_lowercase();
    let allowed = (name.chars().count() / 3).max(1);
    let distances = candidates.into_iter().map(|candidate| {
        let distance = strsim::damerau_levenshtein(&folded, &candidate.to_lowercase());
        (distance, candidate)
    });
    let near = distances.filter(|(distance, _)| *distance <= allowed);
    near.min_by_key(|(distance, _)| *distance).map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_are_mended_and_strangers_are_not() {
        assert_eq!(nearest("gras.png", ["sand.png", "grass.png"]), Some("grass.png"));
        assert_eq!(nearest("Grass.PNG", ["grass.png"]), Some("grass.png"));
        assert_eq!(nearest("meadow", ["sand", "rock"]), None);
        assert_eq!(nearest("", ["sand"]), None);
    }
}
