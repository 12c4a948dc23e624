//! The heating that a request asks for.

use reentry::heating::{Convective as CoreConvective, Heating as CoreHeating, Radiative as CoreRadiative};
use reentry::scenario::Bound;
use serde::Serialize;
use serde_json::json;
use utoipa::openapi::schema::{OneOfBuilder, RefBuilder};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::reader::Object;

/// The heating of the stagnation point, whose `nose_radius` the vehicle then must have: fluxes into a cold wall, their integral, and the
/// temperature of a wall that radiates as much as it gets.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Heating {
    /// The flux by convection: a correlation for air by its name, or that of Sutton and Graves with the constant of another gas.
    #[schema(required = false, default = "sutton_graves")]
    pub convective: ConvectiveFlux,
    /// The flux by radiation of the shocked air.
    #[schema(required = false, default = "none")]
    pub radiative: Radiative,
    /// Of the wall, from 0 to 1.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 0.85)]
    pub emissivity: f64,
}

/// How the convective flux is computed.
#[derive(Clone, Copy, Debug)]
pub enum ConvectiveFlux {
    /// By a correlation for air.
    OfAir(Convective),
    /// In another gas.
    OfGas(SuttonGraves),
}

/// Sutton and Graves's correlation in a gas: k √(ρ/r) V³.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct SuttonGraves {
    /// The kind of correlation.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// k, kg^0.5/m; 1.7415e-4 for air. NASA TR R-376 has it for other gases.
    #[schema(exclusive_minimum = 0)]
    pub constant: f64,
}

impl PartialSchema for ConvectiveFlux {
    fn schema() -> RefOr<Schema> {
        let of_air = RefBuilder::new().ref_location_from_schema_name(Convective::name());
        let of_gas = RefBuilder::new().ref_location_from_schema_name(SuttonGraves::name());
        let description = "The convective flux: by a correlation for air, or in another gas.";
        OneOfBuilder::new().item(of_air).item(of_gas).description(Some(description)).into()
    }
}

impl ToSchema for ConvectiveFlux {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        schemas.push((Convective::name().into(), Convective::schema()));
        schemas.push((SuttonGraves::name().into(), SuttonGraves::schema()));
    }
}

/// Correlations of the convective flux in air, W/m², with the density ρ, kg/m³, the speed V relative to the air, m/s, and the nose radius r, m.
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

impl SuttonGraves {
    fn read(object: &mut Object) -> Option<Self> {
        let kind = object.choice("type", &[("sutton_graves", "sutton_graves")]);
        let constant = object.number("constant", Bound::POSITIVE);
        Some(Self { kind: kind?, constant: constant? })
    }
}

impl Heating {
    /// The correlations that are those of air.
    pub(super) fn of_air(&self) -> Vec<&'static str> {
        let convective = match self.convective {
            ConvectiveFlux::OfAir(Convective::SuttonGraves) => Some("sutton_graves"),
            ConvectiveFlux::OfAir(Convective::DetraKempRiddell) => Some("detra_kemp_riddell"),
            ConvectiveFlux::OfAir(Convective::Chapman) => Some("chapman"),
            ConvectiveFlux::OfGas(_) => None,
        };
        let radiative = match self.radiative {
            Radiative::None => None,
            Radiative::TauberSutton => Some("tauber_sutton"),
        };
        convective.into_iter().chain(radiative).collect()
    }

    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let convective = [
            ("sutton_graves", ConvectiveFlux::OfAir(Convective::SuttonGraves)),
            ("detra_kemp_riddell", ConvectiveFlux::OfAir(Convective::DetraKempRiddell)),
            ("chapman", ConvectiveFlux::OfAir(Convective::Chapman)),
        ];
        object.fill("convective", json!("sutton_graves"));
        let convective = if object.has_object("convective") {
            object.object("convective", SuttonGraves::read).map(ConvectiveFlux::OfGas)
        } else {
            object.choice("convective", &convective)
        };
        let radiative = [("none", Radiative::None), ("tauber_sutton", Radiative::TauberSutton)];
        let radiative = object.choice_or("radiative", &radiative, "none");
        let emissivity = object.number_or("emissivity", Bound::EMISSIVITY, 0.85);
        Some(Self { convective: convective?, radiative: radiative?, emissivity: emissivity? })
    }

    pub(super) fn to_core(self) -> CoreHeating {
        CoreHeating {
            convective: match self.convective {
                ConvectiveFlux::OfAir(Convective::SuttonGraves) => CoreConvective::SUTTON_GRAVES,
                ConvectiveFlux::OfAir(Convective::DetraKempRiddell) => CoreConvective::DetraKempRiddell,
                ConvectiveFlux::OfAir(Convective::Chapman) => CoreConvective::Chapman,
                ConvectiveFlux::OfGas(SuttonGraves { constant, .. }) => CoreConvective::SuttonGraves { constant },
            },
            radiative: match self.radiative {
                Radiative::None => CoreRadiative::None,
                Radiative::TauberSutton => CoreRadiative::TauberSutton,
            },
            emissivity: self.emissivity,
        }
    }
}
