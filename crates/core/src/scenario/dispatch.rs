//! The one place that knows which formulations there are, and with how many numbers each holds a state.

use super::Equations;
use crate::integrate::{AnyStep, Step, System};
use crate::motion::{Cartesian, Forces, Formulation, Spherical};
use crate::scalar::Scalar;

/// A formulation in numbers of any type: `f64`, or with derivatives.
pub(crate) trait FormulationIn<P: Scalar, const N: usize>: Formulation<N> {
    /// Its equations in these numbers.
    type Motion: System<P, N>;

    /// Its equations with these forces.
    fn of(forces: Forces<P>) -> Self::Motion;

    /// Its equations with these forces, without derivatives.
    fn of_plain(forces: Forces) -> Self;
}

impl<P: Scalar, const N: usize> FormulationIn<P, N> for Cartesian
where
    Self: Formulation<N>,
    Cartesian<P>: System<P, N>,
{
    type Motion = Cartesian<P>;

    fn of(forces: Forces<P>) -> Cartesian<P> {
        Cartesian(forces)
    }

    fn of_plain(forces: Forces) -> Self {
        Self(forces)
    }
}

impl<P: Scalar, const N: usize> FormulationIn<P, N> for Spherical
where
    Self: Formulation<N>,
    Spherical<P>: System<P, N>,
{
    type Motion = Spherical<P>;

    fn of(forces: Forces<P>) -> Spherical<P> {
        Spherical(forces)
    }

    fn of_plain(forces: Forces) -> Self {
        Self(forces)
    }
}

/// A computation that is written once for every formulation.
pub(crate) trait ForFormulation {
    /// The numbers in which it needs the equations beside `f64`.
    type Number: Scalar;
    /// What it gives.
    type Output;

    /// The computation with a formulation whose states are `N` numbers.
    fn with<F: FormulationIn<Self::Number, N>, const N: usize>(self) -> Self::Output
    where
        AnyStep: From<Step<N>>;
}

/// What a state holds beside place and motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StateLayout {
    /// Nothing.
    Motion,
    /// The heat load and the mass. One of them may stay as it is: for each size of states, all that flies is compiled once more.
    HeatLoadAndMass,
}

/// Does a computation with the formulation that a case asks for, whose states have this layout.
pub(crate) fn dispatch<C: ForFormulation>(equations: Equations, layout: StateLayout, computation: C) -> C::Output {
    match (equations, layout) {
        (Equations::Cartesian, StateLayout::Motion) => computation.with::<Cartesian, 6>(),
        (Equations::Spherical, StateLayout::Motion) => computation.with::<Spherical, 6>(),
        (Equations::Cartesian, StateLayout::HeatLoadAndMass) => computation.with::<Cartesian, 8>(),
        (Equations::Spherical, StateLayout::HeatLoadAndMass) => computation.with::<Spherical, 8>(),
    }
}
