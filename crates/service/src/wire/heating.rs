//! The heating that a request asks for.

use reentry::heating::{Convective as CoreConvective, Heating as CoreHeating, Radiative as CoreRadiative};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::Object;

/// The heating of the stagnation point, whose `nose_radius` the vehicle then must have: fluxes into a cold wall, their integral, and the
/// temperature of a wall that radiates as much as it gets.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Heating {
    /// The flux by convection.
    #[schema(required = false, default = "sutton_graves")]
    pub convective: Convective,
    /// The flux by radiation of the shocked air.
    #[schema(required = false, default = "none")]
    pub radiative: Radiative,
    /// Of the wall, from 0 to 1.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 0.85)]
    pub emissivity: f64,
}

/// Correlations of the convective flux, W/m², with the density ρ, kg/m³, the speed V relative to the air, m/s, and the nose radius r, m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Convective {
    /// 1.7415e-4 √(ρ/r) V³; NASA TR R-376, for 2.1 to 15.2 km/s.
    SuttonGraves,
    /// 1.1035e8/√r √(ρ/1.225) (V/7924.8)^3.15; Jet Propulsion 27 (1957), up to 8 km/s.
    DetraKempRiddell,
    /// 1.1035e8/√r √(ρ/1.225) (V/7924.8)³; NASA TR R-11, up to 11.2 km/s.
    Chapman,
}

/// Correlations of the radiative flux.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Radiative {
    /// No radiation.
    None,
    /// 4.736e8 r^a ρ^1.22 f(V), with f tabulated from 9 to 16 km/s and none below; J. Spacecraft 28 (1991), for 10 to 16 km/s, 0.3 to 3 m
    /// of nose radius and 6.66e-5 to 6.31e-4 kg/m³.
    TauberSutton,
}

impl Heating {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let convective = [
            ("sutton_graves", Convective::SuttonGraves),
            ("detra_kemp_riddell", Convective::DetraKempRiddell),
            ("chapman", Convective::Chapman),
        ];
        let convective = object.choice_or("convective", &convective, "sutton_graves");
        let radiative = [("none", Radiative::None), ("tauber_sutton", Radiative::TauberSutton)];
        let radiative = object.choice_or("radiative", &radiative, "none");
        let emissivity = object.number_or("emissivity", Bound::EMISSIVITY, 0.85);
        Some(Self { convective: convective?, radiative: radiative?, emissivity: emissivity? })
    }

    pub(super) fn to_core(self) -> CoreHeating {
        CoreHeating {
            convective: match self.convective {
                Convective::SuttonGraves => CoreConvective::SuttonGraves,
                Convective::DetraKempRiddell => CoreConvective::DetraKempRiddell,
                Convective::Chapman => CoreConvective::Chapman,
            },
            radiative: match self.radiative {
                Radiative::None => CoreRadiative::None,
                Radiative::TauberSutton => CoreRadiative::TauberSutton,
            },
            emissivity: self.emissivity,
        }
    }
}
