//! Parachutes: drag areas that grow.

use crate::scalar::{Over, Scalar};

/// A parachute, whose drag adds to that of the vehicle. Its numbers may carry derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parachute<P = f64> {
    /// `C_D S` of the full canopy, m².
    pub drag_area: P,
    /// How long the canopy fills, s; 0: it opens at once.
    pub inflation_time: P,
    /// From the deployment until the canopy begins to fill, s.
    pub delay: P,
}

/// A parachute that was deployed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canopy<P = f64> {
    /// The number of the event that deployed it.
    pub event: usize,
    /// The parachute.
    pub parachute: Parachute<P>,
    /// The time of the deployment, s.
    pub deployed: P,
    /// The state of its inflation.
    pub inflation: Inflation,
}

/// The state of the inflation of a canopy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inflation {
    /// The inflation has not begun: the canopy has no drag.
    Ahead,
    /// The canopy fills: its drag area grows with the square of the time.
    Running,
    /// The canopy is full.
    Over,
}

impl<P: Scalar<Value = f64>> Canopy<P> {
    /// One that is deployed at a time, s.
    pub(crate) fn new(event: usize, parachute: Parachute<P>, deployed: P) -> Self {
        Self { event, parachute, deployed, inflation: Inflation::Ahead }.at(deployed)
    }

    /// The same in other numbers.
    pub(crate) fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> Canopy<Q> {
        let Self { event, parachute: Parachute { drag_area, inflation_time, delay }, deployed, inflation } = *self;
        let [drag_area, inflation_time, delay] = [drag_area, inflation_time, delay].map(number);
        Canopy {
            event,
            parachute: Parachute { drag_area, inflation_time, delay },
            deployed: number(deployed),
            inflation,
        }
    }

    /// When it begins to fill, s.
    fn opens(&self) -> P {
        self.deployed + self.parachute.delay
    }

    /// When it is full, s.
    fn is_full_at(&self) -> P {
        self.opens() + self.parachute.inflation_time
    }

    /// When it begins to fill, or is full, s, whichever comes next.
    pub(crate) fn next_corner(&self) -> Option<P> {
        match self.inflation {
            Inflation::Ahead => Some(self.opens()),
            Inflation::Running => Some(self.is_full_at()),
            Inflation::Over => None,
        }
    }

    /// The same, as far as it is at a time, s.
    #[must_use]
    pub(crate) fn at(&self, time: P) -> Self {
        let inflation = if time.value() >= self.is_full_at().value() {
            Inflation::Over
        } else if time.value() >= self.opens().value() {
            Inflation::Running
        } else {
            Inflation::Ahead
        };
        Self { inflation, ..*self }
    }
}

/// The canopies that are open, in numbers of the vehicle's mass at a given instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Canopies<P> {
    /// The drag area of all that are full over the mass, m²/kg.
    pub full: P,
    /// Those that fill.
    pub filling: Vec<Filling<P>>,
}

/// A canopy that fills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filling<P> {
    /// The drag area of the full canopy over the vehicle's mass, m²/kg.
    pub full: P,
    /// The time at which the inflation began, s.
    pub since: P,
    /// One over the duration of the inflation, 1/s.
    pub over_inflation_time: P,
}

impl<P: Scalar<Value = f64>> Canopies<P> {
    /// Those of a vehicle with one over its mass, 1/kg.
    pub(crate) fn of(canopies: &[Canopy<P>], over_mass: P) -> Option<Self> {
        let mut of_all = Self { full: P::zero(), filling: Vec::new() };
        // What has no drag at all may have no mass to speak of.
        for canopy in canopies.iter().filter(|canopy| canopy.parachute.drag_area.value() > 0.0) {
            let full = over_mass * canopy.parachute.drag_area;
            match canopy.inflation {
                Inflation::Ahead => {}
                Inflation::Running => {
                    let over_inflation_time = canopy.parachute.inflation_time.recip();
                    of_all.filling.push(Filling { full, since: canopy.opens(), over_inflation_time });
                }
                Inflation::Over => of_all.full += full,
            }
        }
        let Self { full, filling } = &of_all;
        (!filling.is_empty() || full.value() != 0.0).then_some(of_all)
    }
}

impl<P: Scalar> Canopies<P> {
    /// The drag area over the mass at a time, m²/kg.
    ///
    /// ```text
    /// C_D S(t) = C_D S (t/t_f)²   while the canopy fills
    /// ```
    ///
    /// # Reference
    /// T. W. Knacke, Parachute Recovery Systems Design Manual, NWC TP 6575, 1991, chapter 5: the drag area of canopies of solid cloth grows
    /// with the square of the time over the filling time.
    #[inline]
    pub(crate) fn area_over_mass<S: Over<P>>(&self, time: S) -> S {
        self.filling.iter().fold(S::zero() + self.full, |sum, filling| {
            let part = (time + -filling.since) * filling.over_inflation_time;
            sum + part * part * filling.full
        })
    }
}
