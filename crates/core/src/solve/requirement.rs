//! What is wanted of a number of a flight, and how far a flight is from it.

/// What a number is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// This.
    Equals(f64),
    /// No less.
    AtLeast(f64),
    /// No more.
    AtMost(f64),
    /// No less than the first and no more than the second.
    Between([f64; 2]),
}

/// A requirement on a number, in the unit of the number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// What the number is to be.
    pub wanted: Wanted,
    /// The full turn of an angle, by which its differences from a value or from the middle of a range are taken on the circle.
    pub turn: Option<f64>,
    /// How near is reached; greater than 0.
    pub tolerance: f64,
    /// The change of the number that counts as a margin of 1; greater than 0.
    pub size: f64,
}

impl Requirement {
    /// By how much a number misses what is wanted: negative where it is too small, 0 where it is within its range.
    pub fn miss(&self, number: f64) -> f64 {
        match self.wanted {
            Wanted::Equals(value) => self.difference(number, value),
            Wanted::AtLeast(least) => (number - least).min(0.0),
            Wanted::AtMost(most) => (number - most).max(0.0),
            Wanted::Between([least, most]) => {
                let from_middle = self.difference(number, 0.5 * (least + most));
                let half = 0.5 * (most - least);
                (from_middle.abs() - half).max(0.0).copysign(from_middle)
            }
        }
    }

    /// By how much the requirement is kept, in parts of its size; negative where it is broken.
    pub fn margin(&self, number: f64) -> f64 {
        let kept = match self.wanted {
            Wanted::Equals(value) => self.tolerance - self.difference(number, value).abs(),
            Wanted::AtLeast(least) => number - least,
            Wanted::AtMost(most) => most - number,
            Wanted::Between([least, most]) => {
                0.5 * (most - least) - self.difference(number, 0.5 * (least + most)).abs()
            }
        };
        kept / self.size
    }

    /// Whether a number is as near as it is to be.
    pub fn is_met(&self, number: f64) -> bool {
        self.miss(number).abs() <= self.tolerance
    }

    /// Whether one value is wanted, and not a range.
    pub fn is_equality(&self) -> bool {
        matches!(self.wanted, Wanted::Equals(_))
    }

    fn difference(&self, number: f64, from: f64) -> f64 {
        let difference = number - from;
        self.turn.map_or(difference, |turn| difference - turn * (difference / turn).round())
    }
}

#[cfg(test)]
mod tests {
    use super::{Requirement, Wanted};

    fn of(wanted: Wanted, turn: Option<f64>) -> Requirement {
        Requirement { wanted, turn, tolerance: 0.5, size: 10.0 }
    }

    #[test]
    fn misses_have_the_sign_of_the_number_and_margins_that_of_the_requirement() {
        let check = |wanted: Wanted, number: f64, miss: f64, margin: f64| {
            let requirement = of(wanted, None);
            assert_eq!(requirement.miss(number).to_bits(), miss.to_bits(), "{wanted:?} of {number}");
            assert_eq!(requirement.margin(number).to_bits(), margin.to_bits(), "{wanted:?} of {number}");
        };
        check(Wanted::Equals(4.0), 3.0, -1.0, -0.05);
        check(Wanted::AtLeast(4.0), 3.0, -1.0, -0.1);
        check(Wanted::AtLeast(4.0), 5.0, 0.0, 0.1);
        check(Wanted::AtMost(4.0), 5.0, 1.0, -0.1);
        check(Wanted::AtMost(4.0), 3.0, 0.0, 0.1);
        check(Wanted::Between([2.0, 4.0]), 5.0, 1.0, -0.1);
        check(Wanted::Between([2.0, 4.0]), 1.0, -1.0, -0.1);
        check(Wanted::Between([2.0, 4.0]), 3.0, 0.0, 0.1);
    }

    #[test]
    fn angles_differ_on_the_circle() {
        let equals = of(Wanted::Equals(179.0), Some(360.0));
        assert!((equals.miss(-179.0) - 2.0).abs() < 1e-12);
        let between = of(Wanted::Between([170.0, 190.0]), Some(360.0));
        assert!(between.is_met(-175.0) && (between.miss(-160.0) - 10.0).abs() < 1e-12);
    }
}
