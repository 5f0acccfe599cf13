//! "Did you mean …": the nearest of a set of words.

/// The candidate most like `word`, if any is like enough to be a slip of the pen.
///
/// Damerau–Levenshtein distance of at most a third of the word's length (but 1 at least), or one of the two begins
/// with the other.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (word.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (distance(word, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn distance(word: &str, candidate: &str) -> usize {
    let (word, candidate) = (word.to_lowercase(), candidate.to_lowercase());
    let prefix = word.len() >= 3 && (candidate.starts_with(&word) || word.starts_with(&candidate));
    let edits = strsim::damerau_levenshtein(&word, &candidate);
    if prefix { edits.min(1) } else { edits }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let keys = ["length", "pitch", "wire_diameter"];
        assert_eq!(nearest("pich", keys), Some("pitch"));
        assert_eq!(nearest("lenght", keys), Some("length"));
        assert_eq!(nearest("wire_dia", keys), Some("wire_diameter"));
        assert_eq!(nearest("banana", keys), None);
    }
}
