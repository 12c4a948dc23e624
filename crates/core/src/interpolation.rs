//! Smooth interpolation in tables.

/// The cell in which a table was last looked at.
#[derive(Clone, Debug, Default)]
pub struct Hint(std::cell::Cell<usize>);

/// Why numbers are not a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// Too few entries.
    #[error("must have at least {least} entries, got {entries}")]
    TooShort {
        /// How many there are.
        entries: usize,
        /// How many are needed.
        least: usize,
    },
    /// Lists of different lengths.
    #[error("must have as many entries as the others, {expected}, got {entries}")]
    LengthsDiffer {
        /// How many there are.
        entries: usize,
        /// How many the others have.
        expected: usize,
    },
    /// The abscissae do not ascend.
    #[error("must ascend, but entry {index} is not greater than the one before it")]
    NotAscending {
        /// Of the first that does not.
        index: usize,
    },
    /// A number that the table cannot hold.
    #[error("entry {index} is out of bounds")]
    OutOfBounds {
        /// Of the first.
        index: usize,
    },
}

/// Whether the abscissae ascend strictly, and every column has as many finite numbers.
///
/// # Errors
/// With the first fault.
pub fn check(abscissae: &[f64], columns: &[&[f64]]) -> Result<(), TableError> {
    if abscissae.is_empty() {
        return Err(TableError::TooShort { entries: 0, least: 1 });
    }
    if let Some(column) = columns.iter().find(|column| column.len() != abscissae.len()) {
        return Err(TableError::LengthsDiffer { entries: column.len(), expected: abscissae.len() });
    }
    for numbers in columns.iter().chain([&abscissae]) {
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            return Err(TableError::OutOfBounds { index });
        }
    }
    match abscissae.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(before) => Err(TableError::NotAscending { index: before + 1 }),
        None => Ok(()),
    }
}
