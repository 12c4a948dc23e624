//! Parachutes: drag areas that grow.

use crate::scalar::{Over, Scalar};

/// A parachute, whose drag adds to that of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parachute {
    /// `C_D S` of the full canopy, m².
    pub drag_area: f64,
    /// How long the canopy fills, s; 0: it opens at once.
    pub inflation_time: f64,
    /// From the deployment until the canopy begins to fill, s.
    pub delay: f64,
}

/// A parachute that was deployed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canopy {
    /// The number of the event that deployed it.
    pub event: usize,
    /// The parachute.
    pub parachute: Parachute,
    /// The time of the deployment, s.
    pub deployed: f64,
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

impl Parachute {
    /// When the canopy begins to fill, s, if it is deployed at a time, s.
    pub(crate) fn opens<S: Scalar>(&self, deployed: S) -> S {
        deployed + self.delay
    }

    /// When the canopy is full, s, if it is deployed at a time, s.
    pub(crate) fn is_full_at<S: Scalar>(&self, deployed: S) -> S {
        self.opens(deployed) + self.inflation_time
    }
}

impl Canopy {
    /// One that is deployed at a time, s.
    pub(crate) fn new(event: usize, parachute: Parachute, deployed: f64) -> Self {
        Self { event, parachute, deployed, inflation: Inflation::Ahead }.at(deployed)
    }

    /// When it begins to fill, or is full, s, whichever comes next.
    pub(crate) fn next_corner(&self) -> Option<f64> {
        self.corner(self.deployed)
    }

    /// When it begins to fill, or is full, s, whichever comes next, if it is deployed at a time, s.
    pub(crate) fn corner<S: Scalar>(&self, deployed: S) -> Option<S> {
        match self.inflation {
            Inflation::Ahead => Some(self.parachute.opens(deployed)),
            Inflation::Running => Some(self.parachute.is_full_at(deployed)),
            Inflation::Over => None,
        }
    }

    /// The same, as far as it is at a time, s.
    #[must_use]
    pub(crate) fn at(&self, time: f64) -> Self {
        let inflation = if time >= self.parachute.is_full_at(self.deployed) {
            Inflation::Over
        } else if time >= self.parachute.opens(self.deployed) {
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
    /// The duration of the inflation, s.
    pub inflation_time: f64,
}

impl<P: Scalar> Canopies<P> {
    /// Those of a vehicle with one over its mass, 1/kg, each with the time at which it was deployed, s.
    pub(crate) fn of(canopies: impl Iterator<Item = (Canopy, P)>, over_mass: P) -> Option<Self> {
        let mut of_all = Self { full: P::zero(), filling: Vec::new() };
        // What has no drag at all may have no mass to speak of.
        for (Canopy { parachute, inflation, .. }, deployed) in canopies.filter(|(it, _)| it.parachute.drag_area > 0.0) {
            let full = over_mass * parachute.drag_area;
            match inflation {
                Inflation::Ahead => {}
                Inflation::Running => {
                    let (since, inflation_time) = (parachute.opens(deployed), parachute.inflation_time);
                    of_all.filling.push(Filling { full, since, inflation_time });
                }
                Inflation::Over => of_all.full += full,
            }
        }
        let Self { full, filling } = &of_all;
        (!filling.is_empty() || *full != P::zero()).then_some(of_all)
    }

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
            let part = (time + -filling.since) / filling.inflation_time;
            sum + part * part * filling.full
        })
    }
}
