//! Theory beside simulation: the closed-form solutions of entry with which the thesis validates its program.
//!
//! Each solution predicts speed, flight-path angle and drag at the density of the air through which a simulated flight passes.
//! The theories know a planet that does not rotate and a vehicle that does not bank: the whole lift points upward.
//! η = `ρSC_D/(2mβ)` is the density without its dimensions, β = 1/H, k = `C_L/C_D`, r₀ the equatorial radius and
//! g₀ the acceleration of gravity there; the subscript e denotes the initial state.
//!
//! # Reference
//! Jameson 2006, chapter V, "Comparison with First-Order Analytic Solutions", equations 74 to 90.

mod comparison;
mod exponential_integral;
mod solutions;

pub use comparison::{Comparison, Validity};

use std::f64::consts::PI;
use std::fmt;

use crate::atmosphere::Atmosphere;
use crate::coordinates::FlightPath;
use crate::motion::Parameters;
use crate::number_text::NumberText;
use crate::scenario::Scenario;
use crate::trajectory::{FlightPoint, Termination};
use crate::vehicle::{Aerodynamics, Vehicle};

/// A solution of the simplified equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solution {
    /// A hypersonic glide at small angles, near circular speed: equations 77 to 79.
    ShallowGlide,
    /// Loh's second-order solution for the flight-path angle, with the speed of the simulated flight: equation 80.
    Loh,
    /// A steep descent on which lift and drag outweigh all else: equations 81 to 83.
    SteepGlide,
    /// A descent without lift at a constant angle: equations 84 to 87.
    SteepBallistic,
    /// Wang and Ting's descent at a moderate angle, from more than circular speed: equations 88 to 90.
    MediumGlide,
}

/// What a solution predicts at an instant; `None` where it gives no number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// V, relative to the planet, m/s.
    pub speed: Option<f64>,
    /// γ, above the local horizontal, rad.
    pub flight_path_angle: Option<f64>,
    /// D/m, m/s², which the theories take for the whole deceleration; positive against the motion.
    pub drag_deceleration: Option<f64>,
}

/// Why a solution gives no numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The flight is over.
    Flight(Termination),
    /// The flight does not descend, as a theory of descents wants it.
    Climb,
    /// γ of equation 78 exceeds [`SMALL_ANGLE`].
    LargeAngle,
    /// cos γ of this equation exceeds 1.
    Level(u8),
    /// cos γ of this equation falls below 0.
    Vertical(u8),
    /// The denominator in this equation reaches zero.
    Pole(u8),
    /// The bracket of equation 88 reaches zero.
    Bracket,
    /// The numbers of the theory are too large or too small for a floating-point number.
    Overflow,
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flight(Termination::SurfaceImpact) => write!(f, "the flight ends at the surface"),
            Self::Flight(Termination::StopAltitude) => write!(f, "the flight ends at the stop altitude"),
            Self::Flight(Termination::TimeLimit) => write!(f, "the flight ends at the stop time"),
            Self::Flight(Termination::Condition(_)) => write!(f, "the flight ends by a condition"),
            Self::Flight(Termination::AtmosphereExit) => write!(f, "the flight ends at the ceiling"),
            Self::Climb => write!(f, "the flight no longer descends"),
            Self::LargeAngle => write!(f, "|γ| of equation 78 exceeds 5°"),
            Self::Level(equation) => write!(f, "cos γ of equation {equation} exceeds 1"),
            Self::Vertical(equation) => write!(f, "cos γ of equation {equation} falls below 0"),
            Self::Pole(equation) => write!(f, "the denominator in equation {equation} reaches zero"),
            Self::Bracket => write!(f, "the bracket of equation 88 reaches zero"),
            Self::Overflow => write!(f, "a value of the theory exceeds the range of floating-point numbers"),
        }
    }
}

/// The angle, 5°, up to which sin γ ≈ γ and cos γ ≈ 1 (Jameson 2006, equations 74 and 75) hold to 0.4 %.
pub const SMALL_ANGLE: f64 = PI / 36.0;

/// A flight-path angle this near zero, rad, is level to rounding.
const LEVEL: f64 = 16.0 * f64::EPSILON;

/// Why a theory does not apply to a case at all.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A glide without lift.
    #[error("must not be 0: the theory requires lift")]
    NoLift,
    /// A ballistic flight with lift.
    #[error("must be 0: the ballistic theory assumes no lift, got {}", NumberText(*.lift_coefficient))]
    Lift {
        /// `C_L`.
        lift_coefficient: f64,
    },
    /// No drag.
    #[error("must be greater than 0: the theory expresses altitude by drag (equation 76), got 0")]
    NoDrag,
    /// Nothing on which the air could act.
    #[error("must be greater than 0: the theory requires aerodynamic forces, got 0")]
    NoArea,
    /// No air.
    #[error("must be greater than 0: the theory requires air, got 0")]
    NoAir,
    /// No air, by its factor.
    #[error("must be greater than 0: the theory requires air, got 0")]
    NoDensity,
    /// Air without one scale height.
    #[error("must be exponential: the theory assumes one scale height")]
    NotExponential,
    /// Coefficients that change during the flight.
    #[error("must be constant or ballistic: the theory assumes constant coefficients")]
    NotConstant,
    /// A flight of several phases.
    #[error("must be omitted: the theory assumes one vehicle without thrust")]
    Events,
    /// The air at entry is thinner than any number.
    #[error("the air has no density at the initial altitude: the theory requires air")]
    NoAirAtEntry,
    /// The flight does not descend at first.
    #[error("the flight-path angle must be less than 0: the theory requires a descent")]
    NoDescent {
        /// `γ_e`, rad.
        flight_path_angle: f64,
    },
}

/// Everything that keeps a theory from applying to a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the theory does not apply: {}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct AnalyticError(pub Vec<Fault>);

impl Solution {
    /// What in a vehicle and its air keeps the theory from applying.
    pub fn vehicle_faults(self, vehicle: &Vehicle, atmosphere: &Atmosphere, density_factor: f64) -> Vec<Fault> {
        let ballistic = self == Self::SteepBallistic;
        let of_lift = |lift_coefficient: f64| {
            let without = (!ballistic && lift_coefficient == 0.0).then_some(Fault::NoLift);
            without.or((ballistic && lift_coefficient != 0.0).then_some(Fault::Lift { lift_coefficient }))
        };
        let of_vehicle = match vehicle.aerodynamics {
            Aerodynamics::Constant { lift_coefficient, drag_coefficient } => [
                of_lift(lift_coefficient),
                (drag_coefficient == 0.0).then_some(Fault::NoDrag),
                (vehicle.reference_area == 0.0).then_some(Fault::NoArea),
            ],
            Aerodynamics::Ballistic { lift_to_drag, .. } => [of_lift(lift_to_drag), None, None],
            Aerodynamics::MachTable(_) | Aerodynamics::AlphaMachTable(_) => [Some(Fault::NotConstant), None, None],
        };
        let of_air = match atmosphere.surface_density() {
            Some(surface_density) => (surface_density == 0.0).then_some(Fault::NoAir),
            None => Some(Fault::NotExponential),
        };
        let of_factor = (density_factor == 0.0).then_some(Fault::NoDensity);
        of_vehicle.into_iter().chain([of_air, of_factor]).flatten().collect()
    }

    /// Whether the theory is of a descent, and ends with it.
    fn descends(self) -> bool {
        matches!(self, Self::SteepGlide | Self::SteepBallistic | Self::MediumGlide)
    }
}

/// A solution for a case: the constants of its equations, and the conditions at entry.
#[derive(Clone, Copy, Debug)]
pub struct Theory {
    solution: Solution,
    /// `SC_D/(2mβ)`, m³/kg: η over the density.
    eta_by_density: f64,
    /// k = `C_L/C_D`.
    k: f64,
    /// β = 1/H, 1/m.
    beta: f64,
    /// g₀, m/s².
    g0: f64,
    /// r₀, m.
    r0: f64,
    /// `V_e`, m/s.
    speed_e: f64,
    /// `γ_e`, rad.
    gamma_e: f64,
    /// `η_e`.
    eta_e: f64,
}

impl Theory {
    /// The solution for a scenario.
    ///
    /// # Errors
    /// With everything that keeps the theory from applying.
    pub fn new(solution: Solution, scenario: &Scenario) -> Result<Self, AnalyticError> {
        let case = scenario.case();
        let Parameters { mass, reference_area, lift_coefficient, drag_coefficient, .. } = case.parameters();
        let entry = FlightPath::from_planet_fixed(&case.initial_state);
        let beta = case.atmosphere.scale_height().recip();
        let r0 = case.planet.equatorial_radius();
        // (76) η = ρSC_D / (2mβ)
        let eta_by_density = reference_area * drag_coefficient / (2.0 * mass * beta);
        let eta_e = eta_by_density * case.forces().loads(0.0, &case.initial_state.into()).density;

        let mut faults = solution.vehicle_faults(&case.vehicle, &case.atmosphere, case.density_factor);
        if !case.events.is_empty() {
            faults.push(Fault::Events);
        }
        if faults.is_empty() && eta_e == 0.0 {
            faults.push(Fault::NoAirAtEntry);
        }
        if solution.descends() && entry.flight_path_angle >= -LEVEL {
            faults.push(Fault::NoDescent { flight_path_angle: entry.flight_path_angle.max(0.0) });
        }
        if !faults.is_empty() {
            return Err(AnalyticError(faults));
        }
        Ok(Self {
            solution,
            eta_by_density,
            k: lift_coefficient / drag_coefficient,
            beta,
            g0: case.planet.point_gravity(r0.recip()),
            r0,
            speed_e: entry.speed,
            gamma_e: entry.flight_path_angle,
            eta_e,
        })
    }

    /// What the theory predicts at the altitude of a point of the flight; [`Solution::Loh`] takes the speed from there as well.
    ///
    /// # Errors
    /// With the reason, where it gives no numbers.
    pub fn prediction(&self, point: &FlightPoint) -> Result<Prediction, End> {
        let eta = self.eta_by_density * point.loads.density;
        if self.solution.descends() && point.flight_path.flight_path_angle >= 0.0 {
            return Err(End::Climb);
        }
        let prediction = match self.solution {
            Solution::ShallowGlide => self.shallow_glide(eta),
            Solution::Loh => self.loh(eta, point.flight_path.speed),
            Solution::SteepGlide => self.steep_glide(eta),
            Solution::SteepBallistic => Ok(self.steep_ballistic(eta)),
            Solution::MediumGlide => self.medium_glide(eta),
        }?;
        let Prediction { speed, flight_path_angle, drag_deceleration } = prediction;
        let finite = [speed, flight_path_angle, drag_deceleration].into_iter().flatten().all(f64::is_finite);
        if finite { Ok(prediction) } else { Err(End::Overflow) }
    }
}
