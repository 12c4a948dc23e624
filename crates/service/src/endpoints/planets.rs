//! `GET /planets`: the planets that a case may name, every number with its source.

use axum::Json;
use reentry::body::BODIES;
use reentry::heating::SUTTON_GRAVES_AIR;
use reentry::planet::{Planet, Zonal};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::error::ApiError;
use crate::wire::planet::{MODELS, PlanetModel};
use crate::wire::schema::names;

/// Planets that a case may name.
#[derive(Debug, Serialize, ToSchema)]
pub struct Planets {
    /// All of them.
    planets: Vec<NamedPlanet>,
}

/// Planet that a case may name, with the numbers of its model.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct NamedPlanet {
    /// Model, as `planet.model` names it.
    #[schema(value_type = names::PlanetModel)]
    name: String,
    /// Name for people.
    title: String,
    /// Description.
    description: String,
    /// Gravitational parameter GM.
    gravitational_parameter: SourcedNumber,
    /// Equatorial radius.
    equatorial_radius: SourcedNumber,
    /// Polar radius.
    polar_radius: SourcedNumber,
    /// Rotation rate about the north pole, positive eastward.
    rotation_rate: SourcedNumber,
    /// Angle of the prime meridian.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    prime_meridian: Option<PrimeMeridian>,
    /// Zonal harmonics, for the equatorial radius.
    zonal: ZonalHarmonics,
    /// Constant k of the correlation of Sutton and Graves in the gas of the planet; absent if it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    sutton_graves_constant: Option<SourcedNumber>,
    /// Correlation of the radiative heat flux in the gas of the planet; absent if none is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    radiation: Option<SourcedWord>,
    /// Standard atmosphere; absent if the planet has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    atmosphere: Option<PlanetAtmosphere>,
    /// Remarks on the numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    notes: Option<String>,
}

/// Number with its unit and source.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct SourcedNumber {
    /// Value.
    value: f64,
    /// Unit.
    unit: String,
    /// Source of the value.
    source: String,
}

/// Word with its source.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct SourcedWord {
    /// Word, as a case names it.
    value: String,
    /// Source of the correlation.
    source: String,
}

/// Angle W of the prime meridian at J2000 (TDB), from the ascending node of the planet's equator on that of the ICRF.
///
/// It grows with the rotation rate.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct PrimeMeridian {
    /// Angle at J2000, without the periodic terms.
    value: f64,
    /// Unit.
    unit: String,
    /// Periodic terms a sin(b + c T), each as [a, b, c] in degrees, with T in Julian centuries of TDB since J2000.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    periodic_terms: Option<Vec<[f64; 3]>>,
    /// Source of the angle.
    source: String,
}

/// Zonal harmonics with their source.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct ZonalHarmonics {
    /// J₂.
    j2: f64,
    /// J₃.
    j3: f64,
    /// J₄.
    j4: f64,
    /// Source of the coefficients.
    source: String,
}

/// Standard atmosphere of a planet: a table, whose lists have one entry per altitude. That of the Earth is `us76`, without lists.
#[derive(Debug, Deserialize, Serialize, ToSchema)]
struct PlanetAtmosphere {
    /// Source of the atmosphere.
    source: String,
    /// How well the atmosphere is known: `high`, `medium` or `low`.
    confidence: String,
    /// Licence of the data.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    licence: Option<String>,
    /// Altitudes, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    altitude: Option<Vec<f64>>,
    /// Densities, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    density: Option<Vec<f64>>,
    /// Temperatures, K.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    temperature: Option<Vec<f64>>,
    /// Pressures, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pressure: Option<Vec<f64>>,
    /// Molar masses, kg/mol.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    molar_mass: Option<Vec<f64>>,
    /// Heat capacity ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    heat_capacity_ratio: Option<Vec<f64>>,
}

/// List the planets that a case may name.
///
/// Every number has its unit and source. Bodies other than the Earth have a standard atmosphere as a table, except the Moon.
#[utoipa::path(
    get,
    path = "/planets",
    tag = "reentry",
    responses((status = 200, description = "All planets, with the numbers of their models.", body = Planets)),
)]
pub async fn planets() -> Result<Json<Planets>, ApiError> {
    Planets::all().map(Json).map_err(|_| ApiError::Internal)
}

impl Planets {
    /// The Earths, and the bodies by their files.
    ///
    /// # Errors
    /// When the file of a body has not the form of the others.
    pub fn all() -> Result<Self, serde_json::Error> {
        let earths = [
            (PlanetModel::EarthWgs84, Planet::EARTH_WGS84, "WGS 84, NIMA TR8350.2 (2000), tables 3.1 and 3.3"),
            (PlanetModel::EarthJamesonListing, Planet::EARTH_JAMESON_LISTING, "Jameson, AFIT 2006, program listing"),
            (
                PlanetModel::EarthJamesonText,
                Planet::EARTH_JAMESON_TEXT,
                "Jameson, AFIT 2006, equations 32 to 35 and 42",
            ),
        ];
        let earths = earths.into_iter().map(|(model, planet, source)| Ok(earth(model, &planet, source)));
        let bodies = BODIES.iter().map(|body| serde_json::from_str(body.source));
        Ok(Self { planets: earths.chain(bodies).collect::<Result<_, _>>()? })
    }
}

fn earth(model: PlanetModel, planet: &Planet, source: &str) -> NamedPlanet {
    let number = |value, unit: &str| SourcedNumber { value, unit: unit.to_owned(), source: source.to_owned() };
    let (equatorial_radius, polar_radius) = planet.shape.semi_axes();
    let [j2, j3, j4] = Zonal::EARTH.coefficients;
    let word = MODELS.word_of(model);
    NamedPlanet {
        name: word.map_or("", |word| word.word).to_owned(),
        title: word.map_or("", |word| word.title).to_owned(),
        description: word.map_or("", |word| word.doc).to_owned(),
        gravitational_parameter: number(planet.gravitational_parameter, "m³/s²"),
        equatorial_radius: number(equatorial_radius, "m"),
        polar_radius: number(polar_radius, "m"),
        rotation_rate: number(planet.rotation_rate, "rad/s"),
        prime_meridian: None,
        zonal: ZonalHarmonics { j2, j3, j4, source: "WGS 84 for J2, EGM96 for J3 and J4".to_owned() },
        sutton_graves_constant: Some(SourcedNumber {
            value: SUTTON_GRAVES_AIR,
            unit: "√kg/m".to_owned(),
            source: "Sutton and Graves, NASA TR R-376 (1971), for air".to_owned(),
        }),
        radiation: Some(SourcedWord {
            value: "tauber_sutton".to_owned(),
            source: "M. E. Tauber and K. Sutton, Journal of Spacecraft and Rockets 28 (1991) 40-42".to_owned(),
        }),
        atmosphere: Some(PlanetAtmosphere {
            source: "U.S. Standard Atmosphere, 1976 (us76)".to_owned(),
            confidence: "high".to_owned(),
            licence: None,
            altitude: None,
            density: None,
            temperature: None,
            pressure: None,
            molar_mass: None,
            heat_capacity_ratio: None,
        }),
        notes: Some(
            "The rotation angle at an epoch is the Earth rotation angle of the IAU 2000 resolutions, with UTC for UT1."
                .to_owned(),
        ),
    }
}
