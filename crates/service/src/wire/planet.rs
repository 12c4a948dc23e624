//! The planet of a request.

use reentry::planet::{Gravity as CoreGravity, Planet as CorePlanet, Shape as CoreShape, Zonal};
use reentry::scenario::Bound;
use serde::Serialize;
use serde_json::json;
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
    /// How its gravity falls off.
    #[schema(required = false)]
    pub gravity: Gravity,
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

/// How gravity falls off.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("inverse_square" = "#/components/schemas/InverseSquareGravity"),
    ("zonal" = "#/components/schemas/ZonalGravity"),
)))]
pub enum Gravity {
    /// That of a point.
    InverseSquare(InverseSquareGravity),
    /// That of a body which is flattened at its poles.
    Zonal(ZonalGravity),
}

/// Gravity of a point at the planet's centre.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct InverseSquareGravity {
    /// The kind of gravity.
    #[serde(rename = "type")]
    pub kind: &'static str,
}

/// Gravity with zonal harmonics: U = -GM/r (1 - Σ Jₙ (a/r)ⁿ Pₙ(sin φ)), with the equatorial radius a and the geocentric latitude φ.
/// Coefficients are given up to the degree, and must be for a custom planet; a named one has the Earth's, of WGS 84 and EGM96.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ZonalGravity {
    /// The kind of gravity.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The greatest n of the sum.
    #[schema(required = false, minimum = 2, maximum = 4, default = 2)]
    pub degree: usize,
    /// J₂; the Earth's is 0.0010826298213.
    #[schema(required = false, value_type = f64, minimum = -0.1, maximum = 0.1)]
    pub j2: f64,
    /// J₃, from degree 3 on; the Earth's is -2.5326564853e-6.
    #[schema(required = false, value_type = f64, minimum = -0.1, maximum = 0.1)]
    pub j3: Option<f64>,
    /// J₄, with degree 4; the Earth's is -1.6196215914e-6.
    #[schema(required = false, value_type = f64, minimum = -0.1, maximum = 0.1)]
    pub j4: Option<f64>,
}

impl Gravity {
    fn read(object: &mut Object, model: Option<PlanetModel>) -> Option<Self> {
        let read = object.choice::<fn(&mut Object, Option<PlanetModel>) -> Option<Self>>(
            "type",
            &[
                ("inverse_square", |_, _| Some(Self::InverseSquare(InverseSquareGravity { kind: "inverse_square" }))),
                ("zonal", |object, model| ZonalGravity::read(object, model).map(Self::Zonal)),
            ],
        )?;
        read(object, model)
    }

    fn to_core(self) -> CoreGravity {
        match self {
            Self::InverseSquare(_) => CoreGravity::InverseSquare,
            Self::Zonal(ZonalGravity { j2, j3, j4, .. }) => {
                CoreGravity::Zonal(Zonal { coefficients: [j2, j3.unwrap_or(0.0), j4.unwrap_or(0.0)] })
            }
        }
    }

    /// Its `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::InverseSquare(InverseSquareGravity { kind }) | Self::Zonal(ZonalGravity { kind, .. }) => kind,
        }
    }
}

impl ZonalGravity {
    fn read(object: &mut Object, model: Option<PlanetModel>) -> Option<Self> {
        let degree = object.whole_number_or("degree", [2, 4], 2);
        let mut coefficient = |order, name, of_earth| match (degree, model) {
            // Whether it belongs here is not known; what is given is looked at all the same.
            (None, _) | (_, None) => Some(object.optional_number(name, Bound::ZONAL_COEFFICIENT)),
            (Some(degree), _) if degree < order => Some(None),
            (Some(_), Some(PlanetModel::Custom)) => object.number(name, Bound::ZONAL_COEFFICIENT).map(Some),
            (Some(_), Some(_)) => object.number_or(name, Bound::ZONAL_COEFFICIENT, of_earth).map(Some),
        };
        let [j2, j3, j4] = Zonal::EARTH.coefficients;
        let (j2, j3, j4) = (coefficient(2, "j2", j2), coefficient(3, "j3", j3), coefficient(4, "j4", j4));
        Some(Self { kind: "zonal", degree: degree?, j2: j2??, j3: j3?, j4: j4? })
    }
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
        let gravity =
            object.object_or("gravity", json!({"type": "inverse_square"}), |object| Gravity::read(object, model));
        let core = match model? {
            PlanetModel::EarthWgs84 => CorePlanet::EARTH_WGS84,
            PlanetModel::EarthJamesonListing => CorePlanet::EARTH_JAMESON_LISTING,
            PlanetModel::EarthJamesonText => CorePlanet::EARTH_JAMESON_TEXT,
            PlanetModel::Custom => Self::read_custom(object)?,
        };
        let core = CorePlanet { gravity: gravity?.to_core(), ..core };
        let core = if shape? == Shape::Sphere { core.spherical() } else { core };
        let custom = model? == PlanetModel::Custom;
        let (equatorial_radius, polar_radius) = core.shape.semi_axes();
        Some(Self {
            model: model?,
            shape: shape?,
            gravity: gravity?,
            gravitational_parameter: custom.then_some(core.gravitational_parameter),
            equatorial_radius: custom.then_some(equatorial_radius),
            polar_radius: custom.then_some(polar_radius),
            rotation_rate: custom.then_some(core.rotation_rate),
            core,
        })
    }

    /// Whether it is an Earth, whose rotation angle and frames follow from the date.
    pub fn is_earth(&self) -> bool {
        self.model != PlanetModel::Custom
    }

    fn read_custom(object: &mut Object) -> Option<CorePlanet> {
        let gravitational_parameter = object.number("gravitational_parameter", Bound::GRAVITATIONAL_PARAMETER);
        let equatorial_radius = object.number("equatorial_radius", Bound::PLANET_RADIUS);
        let polar_radius = object.number("polar_radius", Bound::PLANET_RADIUS);
        let rotation_rate = object.number("rotation_rate", Bound::ROTATION_RATE);
        Some(CorePlanet {
            shape: CoreShape::Ellipsoid { equatorial_radius: equatorial_radius?, polar_radius: polar_radius? },
            gravity: CoreGravity::InverseSquare,
            gravitational_parameter: gravitational_parameter?,
            orbital_gravitational_parameter: gravitational_parameter?,
            rotation_rate: rotation_rate?,
        })
    }
}
