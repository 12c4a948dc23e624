//! The planet of a request.

use reentry::body::{BODIES, Body};
use reentry::planet::{Gravity, Planet as CorePlanet, Shape as CoreShape, Zonal};
use reentry::scenario::Bound;
use serde_json::json;

use super::description::{Object, Word, Words, variant, word};
use super::epoch::Epoch;
use super::schema::is;

/// The planets whose numbers are known, and those whose numbers a request gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanetModel {
    /// WGS 84.
    EarthWgs84,
    /// The numbers of the thesis's program.
    EarthJamesonListing,
    /// The numbers of the thesis's text.
    EarthJamesonText,
    /// Another body whose numbers are known.
    Body(&'static Body),
    /// The four numbers given beside it.
    Custom,
}

/// The words for planets.
pub const MODELS: Words<PlanetModel> = Words {
    name: "PlanetModel",
    doc: "Planet model. `GET /planets` lists the numbers of each, with their sources.",
    words: &WORDS,
};

const EARTHS: [Word<PlanetModel>; 3] = [
    word("earth_wgs84", PlanetModel::EarthWgs84, "Earth, WGS 84").doc("Earth with the constants of WGS 84."),
    word("earth_jameson_listing", PlanetModel::EarthJamesonListing, "Earth, thesis listing")
        .doc("Earth with the constants of the thesis's program, which computed its results: g₀ = 9.798 m/s²."),
    word("earth_jameson_text", PlanetModel::EarthJamesonText, "Earth, thesis text")
        .doc("Earth with the constants of the thesis's text: g₀ = 9.7803253359 m/s²."),
];

const CUSTOM: Word<PlanetModel> = word("custom", PlanetModel::Custom, "Custom")
    .doc("Planet given by `gravitational_parameter`, `equatorial_radius`, `polar_radius` and `rotation_rate`.");

/// The Earths, the bodies, and the planet that a request describes.
const WORDS: [Word<PlanetModel>; EARTHS.len() + BODIES.len() + 1] = {
    let mut words = [CUSTOM; EARTHS.len() + BODIES.len() + 1];
    let mut index = 0;
    while index < EARTHS.len() {
        words[index] = EARTHS[index];
        index += 1;
    }
    while index < EARTHS.len() + BODIES.len() {
        let body = &BODIES[index - EARTHS.len()];
        words[index] = word(body.name, PlanetModel::Body(body), body.title).doc(body.doc);
        index += 1;
    }
    words
};

/// A kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Sphere,
    Ellipsoid,
}

const SHAPES: Words<Shape> = Words {
    name: "Shape",
    doc: "Surface from which altitudes are measured.",
    words: &[
        word("sphere", Shape::Sphere, "Sphere").doc("Sphere with the equatorial radius."),
        word("ellipsoid", Shape::Ellipsoid, "Ellipsoid").doc("Ellipsoid of revolution."),
    ],
};

impl PlanetModel {
    /// Whether it is an Earth.
    pub fn is_earth(self) -> bool {
        matches!(self, Self::EarthWgs84 | Self::EarthJamesonListing | Self::EarthJamesonText)
    }

    /// How faults and warnings call it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Body(body) => body.title,
            Self::Custom => "a custom planet",
            _ => "the Earth",
        }
    }
}

/// The planet of a request.
#[derive(Clone, Copy, Debug)]
pub struct Planet {
    /// Which it is.
    pub model: PlanetModel,
    /// Its numbers.
    pub core: CorePlanet,
}

impl Planet {
    /// Whether it is an Earth.
    pub fn is_earth(&self) -> bool {
        self.model.is_earth()
    }

    /// How faults and warnings call it.
    pub fn title(&self) -> &'static str {
        self.model.title()
    }

    /// How far it is turned at an instant from the inertial frame of date, rad; none of a planet whose rotation angle is not known.
    pub fn rotation_angle(&self, epoch: Epoch) -> Option<f64> {
        match self.model {
            PlanetModel::Body(body) => Some(body.rotation_angle(epoch.barycentric_days())),
            PlanetModel::Custom => None,
            _ => Some(epoch.earth_rotation_angle()),
        }
    }

    /// The word for its surface.
    pub fn shape(&self) -> &'static str {
        SHAPES.of(match self.core.shape {
            CoreShape::Sphere { .. } => Shape::Sphere,
            CoreShape::Ellipsoid { .. } => Shape::Ellipsoid,
        })
    }

    /// The `type` of its gravity.
    pub fn gravity(&self) -> &'static str {
        match self.core.gravity {
            Gravity::InverseSquare => "inverse_square",
            Gravity::Zonal(_) => "zonal",
        }
    }
}

/// The planet.
pub(super) fn planet(object: &mut Object) -> Option<Planet> {
    object.named(
        "Planet",
        "Planet: shape, gravity and rotation. The model `custom` requires `gravitational_parameter`, \
         `equatorial_radius`, `polar_radius` and `rotation_rate`; the other models do not accept them.",
    );
    let model = object.field("model", "Planet").doc("Planet model.").default("earth_wgs84").word(&MODELS);
    let shape = object
        .field("shape", "Shape")
        .doc("Surface from which altitudes are measured.")
        .default("ellipsoid")
        .word(&SHAPES);
    let gravity = object
        .field("gravity", "Gravity")
        .doc("Gravity model.")
        .default(json!({"type": "inverse_square"}))
        .object(|object| gravity(object, model));
    let custom = object.only_where("model", "custom", custom);
    object.condition(|| {
        let up_to = |degree: usize, name: &str| {
            let least = json!({"properties": {"degree": {"minimum": degree}}, "required": ["degree"]});
            json!({"if": least, "then": {"required": [name]}})
        };
        let coefficients = json!({"required": ["j2"], "allOf": [up_to(3, "j3"), up_to(4, "j4")]});
        let gravity = json!({"if": is("type", "zonal"), "then": coefficients});
        json!({"if": is("model", "custom"), "then": {"properties": {"gravity": gravity}}})
    });
    let model = model?;
    let core = match model {
        PlanetModel::EarthWgs84 => CorePlanet::EARTH_WGS84,
        PlanetModel::EarthJamesonListing => CorePlanet::EARTH_JAMESON_LISTING,
        PlanetModel::EarthJamesonText => CorePlanet::EARTH_JAMESON_TEXT,
        PlanetModel::Body(body) => body.planet(),
        PlanetModel::Custom => custom?,
    };
    let core = CorePlanet { gravity: gravity?, ..core };
    Some(Planet { model, core: if shape? == Shape::Sphere { core.spherical() } else { core } })
}

/// The numbers of a planet that has no name.
fn custom(object: &mut Object) -> Option<CorePlanet> {
    let gravitational_parameter = object
        .field("gravitational_parameter", "Gravitational parameter")
        .doc("Gravitational parameter GM of a custom planet, m³/s².")
        .unit("m³/s²")
        .number(Bound::GRAVITATIONAL_PARAMETER);
    let equatorial_radius = object
        .field("equatorial_radius", "Equatorial radius")
        .doc("Equatorial radius of a custom planet, m.")
        .unit("m")
        .number(Bound::PLANET_RADIUS);
    let polar_radius = object
        .field("polar_radius", "Polar radius")
        .doc("Polar radius of a custom planet, m; from 0.1 to 10 times the equatorial radius.")
        .unit("m")
        .number(Bound::PLANET_RADIUS);
    let rotation_rate = object
        .field("rotation_rate", "Rotation rate")
        .doc(
            "Rotation rate of a custom planet relative to inertial space, positive eastward, in rad/s regardless of \
             `angle_unit`; 0 is allowed.",
        )
        .unit("rad/s")
        .number(Bound::ROTATION_RATE);
    Some(CorePlanet {
        shape: CoreShape::Ellipsoid { equatorial_radius: equatorial_radius?, polar_radius: polar_radius? },
        gravity: Gravity::InverseSquare,
        gravitational_parameter: gravitational_parameter?,
        orbital_gravitational_parameter: gravitational_parameter?,
        rotation_rate: rotation_rate?,
    })
}

fn gravity(object: &mut Object, model: Option<PlanetModel>) -> Option<Gravity> {
    object.named("Gravity", "Gravity model.");
    object.variants(
        "Kind of gravity.",
        &[
            variant("inverse_square", "Inverse square", "Gravity of a point mass.", &|object| {
                object.named("InverseSquareGravity", "Gravity of a point mass at the planet's centre.");
                Some(Gravity::InverseSquare)
            }),
            variant(
                "zonal",
                "Zonal harmonics",
                "Gravity of a flattened body: zonal harmonics up to degree 4.",
                &|object| zonal(object, model).map(Gravity::Zonal),
            ),
        ],
    )
}

fn zonal(object: &mut Object, model: Option<PlanetModel>) -> Option<Zonal> {
    object.named(
        "ZonalGravity",
        "Gravity with zonal harmonics: U = -GM/r (1 - Σ Jₙ (a/r)ⁿ Pₙ(sin φ)), with the equatorial radius a and the \
         geocentric latitude φ. A custom planet requires the coefficients up to `degree`; for the other models they \
         default to those of the body: of the Earth from WGS 84 and EGM96, of the others as `GET /planets` lists them.",
    );
    let degree = object.field("degree", "Degree").doc("Highest degree n of the sum.").default(2).whole_number([2, 4]);
    let known = match model {
        Some(PlanetModel::Body(body)) => body.zonal(),
        _ => Zonal::EARTH,
    };
    let mut coefficient = |order, name, title, doc, known: f64| {
        let field = object.field(name, title).doc(doc);
        let field = match (degree, model) {
            // Whether it belongs here is not known; what is given is looked at all the same.
            (None, _) | (_, None) => field.optional(),
            (Some(degree), _) if degree < order => return None,
            (Some(_), Some(PlanetModel::Custom)) => field,
            (Some(_), Some(_)) => field.default(known),
        };
        field.number(Bound::ZONAL_COEFFICIENT)
    };
    let [j2, j3, j4] = known.coefficients;
    let j2 = coefficient(2, "j2", "J₂", "Coefficient J₂; the Earth's is 0.0010826298213.", j2);
    let j3 =
        coefficient(3, "j3", "J₃", "Coefficient J₃, for degree 3 and higher; the Earth's is -2.5326564853e-6.", j3);
    let j4 = coefficient(4, "j4", "J₄", "Coefficient J₄, for degree 4; the Earth's is -1.6196215914e-6.", j4);
    for (degree, name) in [(3, "j3"), (4, "j4")] {
        // Without a degree it is 2, and the condition holds.
        object.condition(|| {
            let below = json!({"properties": {"degree": {"exclusiveMaximum": degree}}});
            json!({"if": below, "then": {"properties": {(name): false}}})
        });
    }
    degree?;
    Some(Zonal { coefficients: [j2?, j3.unwrap_or(0.0), j4.unwrap_or(0.0)] })
}
