//! The state of a vehicle, with names, and as the numbers that are integrated.

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::coordinates::PlanetFixed;
use crate::scalar::Scalar;

/// The state of a vehicle: what is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S: nalgebra::Scalar> {
    /// Planet-fixed, m.
    pub position: Vector3<S>,
    /// Relative to the rotating planet, m/s.
    pub velocity: Vector3<S>,
    /// kg; none where it is not integrated: it is that of the phase then.
    pub mass: Option<S>,
    /// Into the stagnation point since the start, J/m²; none where it is not integrated.
    pub heat_load: Option<S>,
}

impl<S: Scalar> State<S> {
    /// Place and motion.
    #[inline(always)]
    pub fn planet_fixed(&self) -> PlanetFixed<S> {
        PlanetFixed { position: self.position, velocity: self.velocity }
    }

    /// The same in other numbers.
    pub fn map<T: nalgebra::Scalar>(&self, number: impl Fn(S) -> T + Copy) -> State<T> {
        State {
            position: self.position.map(number),
            velocity: self.velocity.map(number),
            mass: self.mass.map(number),
            heat_load: self.heat_load.map(number),
        }
    }

    /// As the six numbers of place and motion in some coordinates, a seventh that is the heat load, and an eighth that is the mass.
    #[inline(always)]
    pub(super) fn numbers<const N: usize>(&self, coordinates: [S; 6]) -> [S; N] {
        std::array::from_fn(|i| match i {
            HEAT_LOAD => self.heat_load.unwrap_or_else(S::zero),
            MASS => self.mass.unwrap_or_else(S::zero),
            _ => coordinates[i],
        })
    }

    /// Of the numbers of a state, of which those of place and motion are given as such.
    #[inline(always)]
    pub(super) fn of<const N: usize>(PlanetFixed { position, velocity }: PlanetFixed<S>, numbers: &[S; N]) -> Self {
        let [mass, heat_load] = [MASS, HEAT_LOAD].map(|index| numbers.get(index).copied());
        Self { position, velocity, mass, heat_load }
    }
}

impl State<Dual64> {
    /// What it will be a time later, s, if the acceleration stays: the numbers change by their rates.
    pub(super) fn later(&self, time: f64) -> Self {
        let evenly = |number: Dual64| Dual64::new(number.re + number.eps * time, number.eps);
        let fallen = |place: Dual64, velocity: Dual64| {
            Dual64::new(place.re + (velocity.re + 0.5 * velocity.eps * time) * time, evenly(velocity).re)
        };
        Self {
            position: self.position.zip_map(&self.velocity, fallen),
            velocity: self.velocity.map(evenly),
            mass: self.mass.map(evenly),
            heat_load: self.heat_load.map(evenly),
        }
    }
}

/// Place and motion, without mass and heat load.
impl<S: Scalar> From<PlanetFixed<S>> for State<S> {
    #[inline(always)]
    fn from(PlanetFixed { position, velocity }: PlanetFixed<S>) -> Self {
        Self { position, velocity, mass: None, heat_load: None }
    }
}

/// The six numbers of place and motion.
#[inline(always)]
pub(super) fn coordinates<S: Scalar, const N: usize>(numbers: &[S; N]) -> [S; 6] {
    std::array::from_fn(|i| numbers[i])
}

/// The place of the heat load among the numbers.
const HEAT_LOAD: usize = 6;
/// The place of the mass among the numbers.
pub(crate) const MASS: usize = 7;
