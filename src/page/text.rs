//! Numbers as people read them.

/// A number with so many decimals, a true minus sign, and no sign on zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.contains(|c: char| ('1'..='9').contains(&c)) => format!("−{digits}"),
        Some(digits) => digits.to_string(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::fixed;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(fixed(-1e-9, 4), "0.0000");
        assert_eq!((fixed(-1.25, 1), fixed(20.71, 2)), ("−1.2".to_string(), "20.71".to_string()));
    }
}
