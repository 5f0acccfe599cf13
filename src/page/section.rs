//! A section of the page.

use maud::Markup;

/// A part of the page. One that has nothing to show says so in a sentence.
pub struct Section {
    /// Its anchor.
    pub id: &'static str,
    /// Its heading.
    pub title: &'static str,
    /// What it says.
    pub body: Markup,
}
