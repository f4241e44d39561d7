//! Codes of messages: `error[out-of-range]` is a section of `docs/guide/troubleshooting.md`.

use std::fmt;

/// The kind of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The file cannot be read as text.
    Unreadable,
    /// The text breaks the grammar of RON.
    Syntax,
    /// The text ends too early.
    Truncated,
    /// There is no such field.
    UnknownField,
    /// A field is not there.
    MissingField,
    /// A field by a former name.
    Renamed,
    /// A field is there twice.
    DuplicateField,
    /// There is no such choice.
    UnknownChoice,
    /// A value of another type.
    WrongType,
    /// NaN or infinite.
    NotFinite,
    /// Not a unit of the field.
    Unit,
    /// An expression without a value.
    Expression,
    /// `--set` leads nowhere.
    Override,
    /// A value outside of what is allowed.
    OutOfRange,
    /// A vector that points nowhere.
    NoDirection,
    /// A name that cannot be one, or is used twice.
    BadName,
    /// A name of nothing in the scene.
    UnknownName,
    /// A file is not where the scene says.
    MissingFile,
    /// Parts that do not go together.
    DoesNotFit,
    /// Something cannot be built as it is written.
    CannotBuild,
    /// More than the memory there is can hold.
    TooLarge,
    /// Blocks that are in each other at the start.
    Overlap,
    /// A value that looks like one in another unit.
    UnitSlip,
    /// Results will be worse than they look.
    Inexact,
    /// Something has no effect.
    NoEffect,
    /// Blocks that no support holds, although they were probably meant to be held.
    NotHeld,
}

impl Code {
    /// All codes.
    pub const ALL: [Self; 26] = [
        Self::Unreadable,
        Self::Syntax,
        Self::Truncated,
        Self::UnknownField,
        Self::MissingField,
        Self::Renamed,
        Self::DuplicateField,
        Self::UnknownChoice,
        Self::WrongType,
        Self::NotFinite,
        Self::Unit,
        Self::Expression,
        Self::Override,
        Self::OutOfRange,
        Self::NoDirection,
        Self::BadName,
        Self::UnknownName,
        Self::MissingFile,
        Self::DoesNotFit,
        Self::CannotBuild,
        Self::TooLarge,
        Self::Overlap,
        Self::UnitSlip,
        Self::Inexact,
        Self::NoEffect,
        Self::NotHeld,
    ];
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The name of the variant in words: `OutOfRange` is out-of-range.
        for (i, letter) in format!("{self:?}").chars().enumerate() {
            if letter.is_uppercase() && i > 0 {
                f.write_str("-")?;
            }
            write!(f, "{}", letter.to_ascii_lowercase())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_printed_in_words() {
        assert_eq!(Code::OutOfRange.to_string(), "out-of-range");
        assert_eq!(Code::Unit.to_string(), "unit");
    }
}
