//! What a file has that is not used, as facts; their words stand in [`super::wording`].

/// Where in a file something stands.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Name of the entity, as the file has it.
    pub entity: String,
    /// Its number, where the format gives one (`#12`).
    pub number: Option<u64>,
    /// Its line, from 1.
    pub line: usize,
}

/// Why something is not used.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// Entities of its kind are not read.
    Kind,
    /// It refers to an instance that the file does not have.
    Missing(u64),
    /// It refers to an instance that is no such thing.
    Unexpected {
        /// The instance.
        number: u64,
        /// What it would have to be.
        wanted: &'static str,
    },
    /// An attribute cannot be used, and what it has to be.
    Unusable(&'static str),
    /// It refers to itself, perhaps through others.
    Circular,
    /// It has no length.
    NoLength,
    /// It comes back to where it begins, and wires have two ends.
    Closed,
    /// It is a solid or a shell, but no tube around one line, because of this.
    NoTube(&'static str),
    /// Its unit of length is not given.
    NoUnit,
    /// The same line is there already.
    Twice,
    /// It stands on a sheet, not in the model.
    OnSheet,
}

/// Something that is not used.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unread {
    /// Why.
    pub why: Why,
    /// What and where.
    pub place: Place,
}
