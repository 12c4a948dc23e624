//! The planet of a request.

use reentry::planet::{Planet as CorePlanet, Shape as CoreShape};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::Object;

/// The planets whose numbers are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlanetModel {
    /// WGS 84.
    EarthWgs84,
    /// The numbers of the thesis's program, which made its results: g₀ = 9.798 m/s².
    EarthJamesonListing,
    /// The numbers of the thesis's text: g₀ = 9.7803253359 m/s².
    EarthJamesonText,
    /// The four numbers given beside it.
    Custom,
}

/// The surface from which altitudes are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A sphere of the equatorial radius.
    Sphere,
    /// An ellipsoid of revolution.
    Ellipsoid,
}

/// The planet. The four numbers are given with the model `custom`, and only there.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Planet {
    /// Which planet.
    #[schema(required = false, default = "earth_wgs84")]
    pub model: PlanetModel,
    /// Its surface.
    #[schema(required = false, default = "ellipsoid")]
    pub shape: Shape,
    /// Acceleration of gravity times the squared radius, m³/s²; of a custom planet.
    #[schema(required = false, value_type = f64, minimum = 1e-6, maximum = 1e25)]
    pub gravitational_parameter: Option<f64>,
    /// m; of a custom planet.
    #[schema(required = false, value_type = f64, minimum = 1, maximum = 1e12)]
    pub equatorial_radius: Option<f64>,
    /// Between 0.1 and 10 times the equatorial radius, m; of a custom planet.
    #[schema(required = false, value_type = f64, minimum = 1, maximum = 1e12)]
    pub polar_radius: Option<f64>,
    /// Relative to inertial space, positive to the east, rad/s whatever the `angle_unit`; of a custom planet; 0 is allowed.
    #[schema(required = false, value_type = f64, minimum = -1, maximum = 1)]
    pub rotation_rate: Option<f64>,
    /// The same, for the core.
    #[schema(ignore)]
    pub core: CorePlanet,
}

impl Planet {
    /// Reads a planet; a named one must not have numbers of its own.
    pub fn read(object: &mut Object) -> Option<Self> {
        const MODELS: [(&str, PlanetModel); 4] = [
            ("earth_wgs84", PlanetModel::EarthWgs84),
            ("earth_jameson_listing", PlanetModel::EarthJamesonListing),
            ("earth_jameson_text", PlanetModel::EarthJamesonText),
            ("custom", PlanetModel::Custom),
        ];
        let model = object.choice_or("model", &MODELS, "earth_wgs84");
        let shape =
            object.choice_or("shape", &[("sphere", Shape::Sphere), ("ellipsoid", Shape::Ellipsoid)], "ellipsoid");
        let core = match model? {
            PlanetModel::EarthWgs84 => CorePlanet::EARTH_WGS84,
            PlanetModel::EarthJamesonListing => CorePlanet::EARTH_JAMESON_LISTING,
            PlanetModel::EarthJamesonText => CorePlanet::EARTH_JAMESON_TEXT,
            PlanetModel::Custom => Self::read_custom(object)?,
        };
        let core = if shape? == Shape::Sphere { core.spherical() } else { core };
        let custom = model? == PlanetModel::Custom;
        let (equatorial_radius, polar_radius) = core.shape.semi_axes();
        Some(Self {
            model: model?,
            shape: shape?,
            gravitational_parameter: custom.then_some(core.gravitational_parameter),
            equatorial_radius: custom.then_some(equatorial_radius),
            polar_radius: custom.then_some(polar_radius),
            rotation_rate: custom.then_some(core.rotation_rate),
            core,
        })
    }

    fn read_custom(object: &mut Object) -> Option<CorePlanet> {
        let gravitational_parameter = object.number("gravitational_parameter", Bound::GRAVITATIONAL_PARAMETER);
        let equatorial_radius = object.number("equatorial_radius", Bound::PLANET_RADIUS);
        let polar_radius = object.number("polar_radius", Bound::PLANET_RADIUS);
        let rotation_rate = object.number("rotation_rate", Bound::ROTATION_RATE);
        Some(CorePlanet {
            shape: CoreShape::Ellipsoid { equatorial_radius: equatorial_radius?, polar_radius: polar_radius? },
            gravitational_parameter: gravitational_parameter?,
            orbital_gravitational_parameter: gravitational_parameter?,
            rotation_rate: rotation_rate?,
        })
    }
}
