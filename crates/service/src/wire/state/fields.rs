//! The fields of a state, by its kind.

use reentry::coordinates::{Geodetic, Inertial, OrbitShape, PlanetFixed, Site};
use reentry::scenario::Bound;
use serde_json::{Value, json};

use super::{Anomaly, Coordinates, Frame, Height, Sidereal, State};
use crate::wire::description::{Object, Variant, Words, variant, word};
use crate::wire::epoch::{self, SiderealTime};
use crate::wire::reader::text;
use crate::wire::sites::{ListedSite, slug_schema};

/// A state of any kind.
///
/// Without an epoch, the time since its frames were aligned is 0 where it does not say otherwise.
pub fn state(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named("State", "State in one of six coordinate systems. Angles are in `angle_unit`.");
    any_state(object, has_epoch, &[])
}

/// A state of any kind, or a launch.
pub fn initial_state(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named("InitialState", "State in one of six coordinate systems, or a launch. Angles are in `angle_unit`.");
    let launch = |object: &mut Object| launch(object, has_epoch);
    any_state(object, has_epoch, &[variant("launch", "Launch", "At rest on the rotating planet.", &launch)])
}

fn any_state(object: &mut Object, has_epoch: bool, more: &[Variant<State>]) -> Option<State> {
    object.variants_of(
        "Kind of state.",
        &[
            variant(
                "planet_relative",
                "Planet-relative",
                "Speed, flight-path angle and heading relative to the rotating planet, measured from the geocentric \
                 horizontal.",
                &|object| planet_relative(object, has_epoch),
            ),
            variant(
                "geodetic",
                "Geodetic",
                "Speed, flight-path angle and azimuth relative to the rotating planet, measured from the geodetic \
                 horizontal.",
                &|object| geodetic(object, has_epoch),
            ),
            variant("ecef", "ECEF vectors", "Planet-fixed position and velocity vectors.", &|object| {
                ecef(object, has_epoch)
            }),
            variant("eci", "ECI vectors", "Inertial position and velocity vectors.", &|object| eci(object, has_epoch)),
            variant("orbital_elements", "Orbital elements", "Classical orbital elements.", &|object| {
                orbital_elements(object, has_epoch)
            }),
            variant(
                "inertial_flight_path",
                "Inertial flight path",
                "Speed, flight-path angle and heading of the inertial velocity, measured from the geocentric \
                 horizontal.",
                &|object| inertial_flight_path(object, has_epoch),
            ),
        ],
        more,
    )
}

/// What a launch site is given by.
const SITE: &str = "site";

fn launch(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "Launch",
        "Launch: at rest on the rotating planet, at a site or at a place. Exactly one of `site` and \
         `geodetic_latitude` must be given.",
    );
    let place = object.alternatives(&[(SITE, &launch_site), ("geodetic_latitude", &launch_place)]);
    let azimuth = object
        .field("azimuth", "Azimuth")
        .doc(
            "Azimuth of the launch, clockwise from north, within ±2π (±360°). It defines the launch frame of steering \
             programs, the direction of `tilt` and that of `downrange`.",
        )
        .default(0.0)
        .angle(Bound::TURN);
    let hold_down = object
        .field("hold_down", "Hold down")
        .doc(
            "Whether the vehicle is held in place, with its engines burning, until thrust, gravity and centrifugal \
             force together point upward. This is the event `liftoff` of the response.",
        )
        .default(true)
        .boolean();
    let sidereal = sidereal(object, has_epoch);
    let place = Geodetic { azimuth: azimuth?, ..place? };
    let coordinates = Coordinates::Launch { place, hold_down: hold_down? };
    Some(State { coordinates, frame: None, sidereal })
}

fn launch_site(object: &mut Object) -> Option<Geodetic> {
    let site = object
        .field(SITE, "Site")
        .doc("Slug of a site that `GET /sites` lists; it gives latitude, longitude and altitude.")
        .optional()
        .value(slug_schema, |value| ListedSite::read(&text(value)?))?;
    let Site { longitude, geodetic_latitude } = site.place();
    Some(at_rest(site.geodetic_altitude, longitude, geodetic_latitude))
}

fn launch_place(object: &mut Object) -> Option<Geodetic> {
    let geodetic_latitude = object
        .field("geodetic_latitude", "Geodetic latitude")
        .doc("Geodetic latitude, north positive, within ±π/2 (±90°).")
        .optional()
        .angle(Bound::QUARTER_TURN);
    let longitude = longitude(object);
    let geodetic_altitude = object
        .field("geodetic_altitude", "Geodetic altitude")
        .doc("Altitude above the surface along its normal, m.")
        .unit("m")
        .default(0.0)
        .number(Bound::DISTANCE);
    Some(at_rest(geodetic_altitude?, longitude?, geodetic_latitude?))
}

fn at_rest(geodetic_altitude: f64, longitude: f64, geodetic_latitude: f64) -> Geodetic {
    Geodetic { geodetic_altitude, longitude, geodetic_latitude, speed: 0.0, flight_path_angle: 0.0, azimuth: 0.0 }
}

/// The planet-fixed longitude.
fn longitude(object: &mut Object) -> Option<f64> {
    let field = object.field("longitude", "Longitude");
    field.doc("Planet-fixed longitude, east positive, within ±2π (±360°).").angle(Bound::TURN)
}

/// The geocentric latitude.
fn geocentric_latitude(object: &mut Object) -> Option<f64> {
    let field = object.field("geocentric_latitude", "Geocentric latitude");
    field.doc("Latitude, north positive, within ±π/2 (±90°).").angle(Bound::QUARTER_TURN)
}

/// The speed relative to the rotating planet.
fn speed(object: &mut Object) -> Option<f64> {
    object.field("speed", "Speed").doc("Speed relative to the rotating planet, m/s.").unit("m/s").number(Bound::SPEED)
}

fn planet_relative(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "PlanetRelative",
        "Position and velocity relative to the rotating planet; angles are measured from the geocentric horizontal. \
         This is the vehicle-pointing system of the thesis.",
    );
    let height = height(object);
    let longitude = longitude(object);
    let geocentric_latitude = geocentric_latitude(object);
    let speed = speed(object);
    let flight_path_angle = object
        .field("flight_path_angle", "Flight-path angle")
        .doc(
            "Angle of the relative velocity above the local horizontal (the plane normal to the radius), within ±π/2 \
             (±90°); negative in descent.",
        )
        .angle(Bound::QUARTER_TURN);
    let heading = object
        .field("heading", "Heading, from east")
        .doc(
            "Heading of the relative velocity, from east (0) towards north (π/2), within ±2π (±360°). Exactly one of \
             `heading` and `azimuth` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    let azimuth = object
        .field("azimuth", "Azimuth, from north")
        .doc(
            "Azimuth of the relative velocity, clockwise from north, within ±2π (±360°). Exactly one of `heading` and \
             `azimuth` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    object.exactly_one(&["heading", "azimuth"]);
    let sidereal = sidereal(object, has_epoch);
    let coordinates = Coordinates::PlanetRelative {
        height: height?,
        longitude: longitude?,
        geocentric_latitude: geocentric_latitude?,
        speed: speed?,
        flight_path_angle: flight_path_angle?,
        heading: heading.or(azimuth.map(from_azimuth))?,
    };
    Some(State { coordinates, frame: None, sidereal })
}

fn geodetic(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "Geodetic",
        "Position and velocity relative to the rotating planet; angles are measured from the geodetic horizontal.",
    );
    let geodetic_altitude = object
        .field("geodetic_altitude", "Geodetic altitude")
        .doc("Altitude above the planet's surface along the surface normal, m.")
        .unit("m")
        .number(Bound::DISTANCE);
    let longitude = longitude(object);
    let geodetic_latitude = object
        .field("geodetic_latitude", "Geodetic latitude")
        .doc("Latitude, north positive, within ±π/2 (±90°).")
        .angle(Bound::QUARTER_TURN);
    let speed = speed(object);
    let flight_path_angle = object
        .field("flight_path_angle", "Flight-path angle")
        .doc("Angle of the relative velocity above the geodetic horizontal, within ±π/2 (±90°); negative in descent.")
        .angle(Bound::QUARTER_TURN);
    let azimuth = object
        .field("azimuth", "Azimuth, from north")
        .doc("Azimuth of the relative velocity, clockwise from north, within ±2π (±360°). Responses give [0, 2π).")
        .angle(Bound::TURN);
    let sidereal = sidereal(object, has_epoch);
    let coordinates = Coordinates::Geodetic(Geodetic {
        geodetic_altitude: geodetic_altitude?,
        longitude: longitude?,
        geodetic_latitude: geodetic_latitude?,
        speed: speed?,
        flight_path_angle: flight_path_angle?,
        azimuth: azimuth?,
    });
    Some(State { coordinates, frame: None, sidereal })
}

fn ecef(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "Ecef",
        "Planet-fixed position and velocity, relative to the rotating planet. The x axis points to longitude 0 on the \
         equator, the z axis to the north pole.",
    );
    let position = position(object);
    let velocity = object
        .field("velocity", "Velocity")
        .doc("Velocity [x, y, z] relative to the rotating planet, m/s. Its magnitude must be at most 1e6.")
        .unit("m/s")
        .vector(Bound::VELOCITY);
    let sidereal = sidereal(object, has_epoch);
    let coordinates = Coordinates::Ecef(PlanetFixed { position: position?.into(), velocity: velocity?.into() });
    Some(State { coordinates, frame: None, sidereal })
}

fn eci(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "Eci",
        "Inertial position and velocity in the frame `frame`. By default this is the planet-fixed frame at \
         `sidereal_time` 0 or, with an `epoch`, the equator and origin of date.",
    );
    let frame = frame(object);
    let position = position(object);
    let velocity = object
        .field("velocity", "Velocity")
        .doc("Inertial velocity [x, y, z], m/s. The speed relative to the rotating planet must be at most 1e6.")
        .unit("m/s")
        .vector(Bound::FINITE);
    let sidereal = sidereal_of_frame(object, frame, has_epoch);
    let coordinates = Coordinates::Eci(Inertial { position: position?.into(), velocity: velocity?.into() });
    Some(State { coordinates, frame: Some(frame?), sidereal })
}

fn orbital_elements(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named("OrbitalElements", "Classical orbital elements in the inertial frame `frame`.");
    let frame = frame(object);
    let semi_major_axis = object
        .field("semi_major_axis", "Semi-major axis")
        .doc(
            "Semi-major axis, m; positive for eccentricities below 1, negative above. Exactly one of \
             `semi_major_axis` and `semi_latus_rectum` must be given.",
        )
        .unit("m")
        .optional()
        .number(Bound::FINITE);
    let semi_latus_rectum = object
        .field("semi_latus_rectum", "Semi-latus rectum")
        .doc(
            "Semi-latus rectum, m; required for a parabola. Exactly one of `semi_major_axis` and `semi_latus_rectum` \
             must be given.",
        )
        .unit("m")
        .optional()
        .number(Bound::POSITIVE);
    object.exactly_one(&["semi_major_axis", "semi_latus_rectum"]);
    let eccentricity = object
        .field("eccentricity", "Eccentricity")
        .doc("Eccentricity: 0 for a circle, below 1 for an ellipse, 1 for a parabola, above 1 for a hyperbola.")
        .number(Bound::NON_NEGATIVE);
    let inclination = object
        .field("inclination", "Inclination")
        .doc("Angle between the orbit's angular momentum and the north pole, in [0, π] (0 to 180°).")
        .angle(Bound::HALF_TURN);
    let raan = object
        .field("raan", "Ascending node (RAAN)")
        .doc("Right ascension of the ascending node, within ±2π (±360°). Responses give [0, 2π).")
        .angle(Bound::TURN);
    let argument_of_periapsis = object
        .field("argument_of_periapsis", "Argument of periapsis")
        .doc("Angle from the ascending node to the periapsis, within ±2π (±360°). Responses give [0, 2π).")
        .angle(Bound::TURN);
    let true_anomaly = object
        .field("true_anomaly", "True anomaly")
        .doc(
            "Angle from the periapsis to the vehicle, within ±2π (±360°). Responses give [0, 2π). Exactly one of \
             `true_anomaly` and `mean_anomaly` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    let mean_anomaly = object
        .field("mean_anomaly", "Mean anomaly")
        .doc(
            "Time since the periapsis as a fraction of the orbital period, expressed as an angle within ±2π (±360°). \
             It requires an eccentricity below 1. Exactly one of `true_anomaly` and `mean_anomaly` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    object.exactly_one(&["true_anomaly", "mean_anomaly"]);
    let sidereal = sidereal_of_frame(object, frame, has_epoch);
    object.condition(|| {
        let bound = json!({"properties": {"eccentricity": {"exclusiveMaximum": 1}}});
        json!({"if": {"required": ["mean_anomaly"]}, "then": bound})
    });
    let by_axis = semi_major_axis.map(OrbitShape::SemiMajorAxis);
    let coordinates = Coordinates::OrbitalElements {
        shape: semi_latus_rectum.map(OrbitShape::SemiLatusRectum).or(by_axis)?,
        eccentricity: eccentricity?,
        inclination: inclination?,
        raan: raan?,
        argument_of_periapsis: argument_of_periapsis?,
        anomaly: true_anomaly.map(Anomaly::True).or(mean_anomaly.map(Anomaly::Mean))?,
    };
    Some(State { coordinates, frame: Some(frame?), sidereal })
}

fn inertial_flight_path(object: &mut Object, has_epoch: bool) -> Option<State> {
    object.named(
        "InertialFlightPath",
        "Position relative to the rotating planet and inertial velocity; angles are measured from the geocentric \
         horizontal. Flight reports give the entry interface in this form.",
    );
    let height = height(object);
    let longitude = longitude(object);
    let geocentric_latitude = geocentric_latitude(object);
    let inertial_speed = object
        .field("inertial_speed", "Inertial speed")
        .doc("Magnitude of the inertial velocity, m/s. The speed relative to the rotating planet must be at most 1e6.")
        .unit("m/s")
        .number(Bound::NON_NEGATIVE);
    let inertial_flight_path_angle = object
        .field("inertial_flight_path_angle", "Inertial flight-path angle")
        .doc(
            "Angle of the inertial velocity above the local horizontal (the plane normal to the radius), within ±π/2 \
             (±90°); negative in descent.",
        )
        .angle(Bound::QUARTER_TURN);
    let inertial_heading = object
        .field("inertial_heading", "Inertial heading")
        .doc(
            "Heading of the inertial velocity, from east (0) towards north (π/2), within ±2π (±360°). Exactly one of \
             `inertial_heading` and `inertial_azimuth` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    let inertial_azimuth = object
        .field("inertial_azimuth", "Inertial azimuth")
        .doc(
            "Azimuth of the inertial velocity, clockwise from north, within ±2π (±360°). Exactly one of \
             `inertial_heading` and `inertial_azimuth` must be given.",
        )
        .optional()
        .angle(Bound::TURN);
    object.exactly_one(&["inertial_heading", "inertial_azimuth"]);
    let sidereal = sidereal(object, has_epoch);
    let coordinates = Coordinates::InertialFlightPath {
        height: height?,
        longitude: longitude?,
        geocentric_latitude: geocentric_latitude?,
        inertial_speed: inertial_speed?,
        inertial_flight_path_angle: inertial_flight_path_angle?,
        inertial_heading: inertial_heading.or(inertial_azimuth.map(from_azimuth))?,
    };
    Some(State { coordinates, frame: None, sidereal })
}

/// The heading of an azimuth, rad.
fn from_azimuth(azimuth: f64) -> f64 {
    std::f64::consts::FRAC_PI_2 - azimuth
}

/// The height of a place on the geocentric horizontal.
fn height(object: &mut Object) -> Option<Height> {
    let radius = object
        .field("radius", "Radius")
        .doc("Distance from the planet's centre, m. Exactly one of `radius` and `altitude` must be given.")
        .unit("m")
        .optional()
        .number(Bound::RADIUS);
    let altitude = object
        .field("altitude", "Altitude")
        .doc(
            "Altitude above the planet's surface along the radius vector, m. Exactly one of `radius` and `altitude` \
             must be given.",
        )
        .unit("m")
        .optional()
        .number(Bound::DISTANCE);
    object.exactly_one(&["radius", "altitude"])?;
    radius.map(Height::Radius).or(altitude.map(Height::Altitude))
}

fn position(object: &mut Object) -> Option<[f64; 3]> {
    object
        .field("position", "Position")
        .doc("Position [x, y, z], m; each component within ±1e12.")
        .unit("m")
        .vector(Bound::DISTANCE)
}

/// The words for inertial frames.
pub const FRAMES: Words<Frame> = Words {
    name: "Frame",
    doc: "Inertial frame.",
    words: &[
        word("date", Frame::Date, "Equator of date").doc(
            "The planet's equator, with the planet rotated from it by the sidereal time; with an epoch on the Earth, \
             the equator and the celestial intermediate origin of date.",
        ),
        word("teme", Frame::Teme, "TEME (SGP4)")
            .doc("True equator and mean equinox of date, the frame of SGP4 and two-line elements."),
        word("gcrf", Frame::Gcrf, "GCRF (J2000)")
            .doc("Geocentric celestial reference frame; J2000 differs from it by less than 0.1 arc seconds."),
    ],
};

fn frame(object: &mut Object) -> Option<Frame> {
    object
        .field("frame", "Inertial frame")
        .doc(
            "Inertial frame. `teme` and `gcrf` require an Earth model and an `epoch` from 1900 to 2100, and do not \
             accept a sidereal time or angle. They are accurate to 10 m at the surface, apart from polar motion (at \
             most 18 m) and UT1-UTC (at most 0.9 s, 420 m), which are neglected.",
        )
        .default("date")
        .word(&FRAMES)
}

/// The sidereal time or angle, which is for the frame of date alone.
fn sidereal_of_frame(object: &mut Object, frame: Option<Frame>, has_epoch: bool) -> Sidereal {
    let Some(of_epoch) = frame.filter(|frame| *frame != Frame::Date) else {
        let sidereal = sidereal(object, has_epoch);
        let absent = json!({"properties": {"sidereal_time": false, "sidereal_angle": false}});
        object.condition(|| json!({"if": frames_of_epoch(), "then": absent}));
        return sidereal;
    };
    for name in ["sidereal_time", "sidereal_angle"] {
        if object.has(name) {
            let frame = FRAMES.of(of_epoch);
            object.fault_of(name, format!("must be omitted with the frame {frame:?}: the epoch defines its angle"));
        }
    }
    Sidereal::default()
}

fn sidereal(object: &mut Object, has_epoch: bool) -> Sidereal {
    let has_angle = object.has("sidereal_angle");
    if !has_epoch && !has_angle {
        object.fill("sidereal_time", json!(0));
    }
    let time = object
        .field("sidereal_time", "Sidereal time")
        .doc(
            "Time since the inertial and the planet-fixed frame were aligned, s, within ±1e9. The default is 0, or \
             follows from the `epoch`. At most one of `sidereal_time` and `sidereal_angle` may be given.",
        )
        .unit("s")
        .optional()
        .number_or_text("SiderealTime", Bound::SIDEREAL_TIME, epoch::sidereal_time_schema, SiderealTime::read);
    let angle = object
        .field("sidereal_angle", "Sidereal angle")
        .doc(
            "Angle from the inertial to the planet-fixed frame, positive eastward, within ±2π (±360°). At most one of \
             `sidereal_time` and `sidereal_angle` may be given.",
        )
        .optional()
        .angle_as_given(Bound::TURN);
    object.condition(|| json!({"not": {"required": ["sidereal_time", "sidereal_angle"]}}));
    if has_angle && object.has("sidereal_time") {
        object.fault::<()>("must have at most one of sidereal_time, sidereal_angle, got both");
    }
    Sidereal { time, angle }
}

/// The condition that a state is in a frame that the epoch turns.
fn frames_of_epoch() -> Value {
    json!({"properties": {"frame": {"enum": ["teme", "gcrf"]}}, "required": ["frame"]})
}

/// What an inertial state, in the field of this name, asks of the epoch and of the planet beside it.
pub fn inertial_conditions(object: &mut Object, state: &str) {
    let of = |schema: Value| json!({"properties": {(state): schema}, "required": [state]});
    let custom = json!({"properties": {"model": {"const": "custom"}}, "required": ["model"]});
    let on_custom = json!({"properties": {"planet": custom}, "required": ["planet"]});
    let inertial = json!({"properties": {"type": {"enum": ["eci", "orbital_elements"]}}, "required": ["type"]});
    let turned = json!({"anyOf": [{"required": ["sidereal_time"]}, {"required": ["sidereal_angle"]}]});
    object.condition(|| json!({"if": of(frames_of_epoch()), "then": {"required": ["epoch"], "not": on_custom}}));
    object.condition(|| json!({"if": {"required": ["epoch"], "allOf": [on_custom, of(inertial)]}, "then": of(turned)}));
}
