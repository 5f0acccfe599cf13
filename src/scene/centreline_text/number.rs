//! Decimal text in mm and metres, without a rounding between.

/// Decimal text in mm as metres; `None` when it is no finite number.
pub fn from_millimetres(text: &str) -> Option<f64> {
    let (digits, exponent) = shifted(text, -3)?;
    format!("{digits}e{exponent}").parse().ok().filter(|value: &f64| value.is_finite())
}

/// Splits decimal text into digits and exponent, the exponent shifted.
pub fn shifted(text: &str, by: i32) -> Option<(&str, i32)> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())?;
    match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => Some((digits, exponent.parse::<i32>().ok()? + by)),
        None => Some((text, by)),
    }
}
