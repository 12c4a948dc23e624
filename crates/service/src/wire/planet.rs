//! The planet of a request.

use reentry::planet::{Gravity, Planet as CorePlanet, Shape as CoreShape, Zonal};
use reentry::scenario::Bound;
use serde_json::json;

use super::description::{Object, Words, variant, word};
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
    /// The four numbers given beside it.
    Custom,
}

/// The words for planets.
pub const MODELS: Words<PlanetModel> = Words {
    name: "PlanetModel",
    doc: "The planets whose numbers are known.",
    words: &[
        word("earth_wgs84", PlanetModel::EarthWgs84, "Earth, WGS 84").doc("WGS 84."),
        word("earth_jameson_listing", PlanetModel::EarthJamesonListing, "Earth, thesis listing")
            .doc("The numbers of the thesis's program, which made its results: g₀ = 9.798 m/s²."),
        word("earth_jameson_text", PlanetModel::EarthJamesonText, "Earth, thesis text")
            .doc("The numbers of the thesis's text: g₀ = 9.7803253359 m/s²."),
        word("custom", PlanetModel::Custom, "Custom").doc("The four numbers given beside it."),
    ],
};

/// A kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Sphere,
    Ellipsoid,
}

const SHAPES: Words<Shape> = Words {
    name: "Shape",
    doc: "The surface from which altitudes are measured.",
    words: &[
        word("sphere", Shape::Sphere, "Sphere").doc("A sphere of the equatorial radius."),
        word("ellipsoid", Shape::Ellipsoid, "Ellipsoid").doc("An ellipsoid of revolution."),
    ],
};

/// The planet of a request.
#[derive(Clone, Copy, Debug)]
pub struct Planet {
    /// Which it is.
    pub model: PlanetModel,
    /// Its numbers.
    pub core: CorePlanet,
}

impl Planet {
    /// Whether it is an Earth, whose rotation angle and frames follow from the date.
    pub fn is_earth(&self) -> bool {
        self.model != PlanetModel::Custom
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
    object.named("Planet", "The planet. The four numbers are given with the model `custom`, and only there.");
    let model = object.field("model", "Planet").doc("Which planet.").default("earth_wgs84").word(&MODELS);
    let shape = object.field("shape", "Shape").doc("Its surface.").default("ellipsoid").word(&SHAPES);
    let gravity = object
        .field("gravity", "Gravity")
        .doc("How its gravity falls off.")
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
        PlanetModel::Custom => custom?,
    };
    let core = CorePlanet { gravity: gravity?, ..core };
    Some(Planet { model, core: if shape? == Shape::Sphere { core.spherical() } else { core } })
}

/// The numbers of a planet that has no name.
fn custom(object: &mut Object) -> Option<CorePlanet> {
    let gravitational_parameter = object
        .field("gravitational_parameter", "Gravitational parameter")
        .doc("Acceleration of gravity times the squared radius, m³/s²; of a custom planet.")
        .unit("m³/s²")
        .number(Bound::GRAVITATIONAL_PARAMETER);
    let equatorial_radius = object
        .field("equatorial_radius", "Equatorial radius")
        .doc("m; of a custom planet.")
        .unit("m")
        .number(Bound::PLANET_RADIUS);
    let polar_radius = object
        .field("polar_radius", "Polar radius")
        .doc("Between 0.1 and 10 times the equatorial radius, m; of a custom planet.")
        .unit("m")
        .number(Bound::PLANET_RADIUS);
    let rotation_rate = object
        .field("rotation_rate", "Rotation rate")
        .doc("Relative to inertial space, positive to the east, rad/s whatever the `angle_unit`; of a custom planet; 0 is allowed.")
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
    object.named("Gravity", "How gravity falls off.");
    object.variants(
        "The kind of gravity.",
        &[
            variant("inverse_square", "Inverse square", "That of a point.", &|object| {
                object.named("InverseSquareGravity", "Gravity of a point at the planet's centre.");
                Some(Gravity::InverseSquare)
            }),
            variant("zonal", "Zonal harmonics", "That of a body which is flattened at its poles.", &|object| {
                zonal(object, model).map(Gravity::Zonal)
            }),
        ],
    )
}

fn zonal(object: &mut Object, model: Option<PlanetModel>) -> Option<Zonal> {
    object.named(
        "ZonalGravity",
        "Gravity with zonal harmonics: U = -GM/r (1 - Σ Jₙ (a/r)ⁿ Pₙ(sin φ)), with the equatorial radius a and the geocentric latitude φ. \
         Coefficients are given up to the degree, and must be for a custom planet; a named one has the Earth's, of WGS 84 and EGM96.",
    );
    let degree = object.field("degree", "Degree").doc("The greatest n of the sum.").default(2).whole_number([2, 4]);
    let mut coefficient = |order, name, title, doc, of_earth: f64| {
        let field = object.field(name, title).doc(doc);
        let field = match (degree, model) {
            // Whether it belongs here is not known; what is given is looked at all the same.
            (None, _) | (_, None) => field.optional(),
            (Some(degree), _) if degree < order => return None,
            (Some(_), Some(PlanetModel::Custom)) => field,
            (Some(_), Some(_)) => field.default(of_earth),
        };
        field.number(Bound::ZONAL_COEFFICIENT)
    };
    let [j2, j3, j4] = Zonal::EARTH.coefficients;
    let j2 = coefficient(2, "j2", "J₂", "J₂; the Earth's is 0.0010826298213.", j2);
    let j3 = coefficient(3, "j3", "J₃", "J₃, from degree 3 on; the Earth's is -2.5326564853e-6.", j3);
    let j4 = coefficient(4, "j4", "J₄", "J₄, with degree 4; the Earth's is -1.6196215914e-6.", j4);
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
