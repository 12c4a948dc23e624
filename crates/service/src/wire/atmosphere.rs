//! The atmosphere of a request.

use std::sync::Arc;

use reentry::atmosphere::nrlmsise00::{Ap, Nrlmsise00, SpaceWeather};
use reentry::atmosphere::{Atmosphere as CoreAtmosphere, EARTH_JAMESON, Gas, Layer, Layers, Table};
use reentry::body::Body;
use reentry::scenario::Bound;
use serde_json::json;

use super::description::{Object, Words, variant, word};
use super::epoch::Epoch;
use super::planet::PlanetModel;
use super::reader::{MOST_ENTRIES, NumberOrList};
use super::space_weather;

/// The atmosphere of a request.
#[derive(Clone, Debug)]
pub struct Atmosphere {
    /// The model.
    pub core: CoreAtmosphere,
    /// The body whose standard atmosphere it is; none of other atmospheres.
    pub standard_of: Option<&'static Body>,
    /// The indices that NRLMSISE-00 takes.
    pub space_weather: Option<SpaceWeather>,
    /// For a flight away from the Earth: what of it is the Earth's, and the remedy; nothing where all of it was given.
    pub of_earth: Option<&'static str>,
}

impl Atmosphere {
    fn of(core: CoreAtmosphere) -> Self {
        Self { core, standard_of: None, space_weather: None, of_earth: None }
    }

    fn of_earth(core: CoreAtmosphere, remedy: &'static str) -> Self {
        Self { of_earth: Some(remedy), ..Self::of(core) }
    }

    /// Its `type`.
    pub fn kind(&self) -> &'static str {
        match self.core {
            _ if self.standard_of.is_some() => "standard",
            CoreAtmosphere::Exponential { .. } => "exponential",
            CoreAtmosphere::Us76 => "us76",
            CoreAtmosphere::Nrlmsise00(_) => "nrlmsise00",
            CoreAtmosphere::Layers(_) => "layered_exponential",
            CoreAtmosphere::Table(_) => "table",
            CoreAtmosphere::Vacuum => "vacuum",
        }
    }
}

/// The atmosphere.
pub(super) fn atmosphere(object: &mut Object, planet: Option<PlanetModel>, epoch: Option<Epoch>) -> Option<Atmosphere> {
    object.named(
        "Atmosphere",
        "Atmosphere model. The air rotates with the planet; altitudes are along the radius vector.",
    );
    object.variants(
        "Kind of atmosphere.",
        &[
            variant("standard", "Standard", "Standard atmosphere of the planet.", &|object| standard(object, planet)),
            variant("exponential", "Exponential", "Density with one scale height.", &exponential),
            variant("us76", "U.S. Standard 1976", "U.S. Standard Atmosphere, 1976.", &us76),
            variant(
                "nrlmsise00",
                "NRLMSISE-00",
                "NRLMSISE-00, by place, time, solar flux and geomagnetic activity.",
                &|object| nrlmsise00(object, epoch),
            ),
            variant(
                "layered_exponential",
                "Layered exponential",
                "Layers with one scale height each.",
                &layered_exponential,
            ),
            variant("table", "Table", "Table by altitude.", &table),
            variant("vacuum", "Vacuum", "No air.", &vacuum),
        ],
    )
}

fn standard(object: &mut Object, planet: Option<PlanetModel>) -> Option<Atmosphere> {
    object.named(
        "StandardAtmosphere",
        "Standard atmosphere of the planet: `us76` on the Earth; on the named planets the table that `GET /planets` \
         lists, with its source; no air on the Moon. A custom planet has none.",
    );
    match planet? {
        PlanetModel::Body(body) => Some(Atmosphere { standard_of: Some(body), ..Atmosphere::of(body.atmosphere()) }),
        PlanetModel::Custom => {
            object.fault_of("type", "must not be standard: a custom planet has no standard atmosphere");
            None
        }
        _ => Some(Atmosphere::of(CoreAtmosphere::Us76)),
    }
}

#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn us76(object: &mut Object) -> Option<Atmosphere> {
    object.named(
        "Us76Atmosphere",
        "U.S. Standard Atmosphere, 1976, from -5 to 1000 km: density, temperature, pressure and speed of sound.",
    );
    Some(Atmosphere::of_earth(CoreAtmosphere::Us76, "Atmosphere us76 is the Earth's: give that of the planet"))
}

/// The words for indices that the request does not give.
const INDICES: Words<()> = Words {
    name: "SpaceWeatherIndices",
    doc: "Indices of the space weather.",
    words: &[word("file", (), "From the file").doc(
        "Those of the epoch, from the file that the service was started with; the geomagnetic activity with its history.",
    )],
};

fn nrlmsise00(object: &mut Object, epoch: Option<Epoch>) -> Option<Atmosphere> {
    const NUMBERS: [&str; 3] = ["f107", "f107_average", "ap"];
    object.named(
        "Nrlmsise00Atmosphere",
        "NRLMSISE-00 model of the Earth's atmosphere from -5 to 1000 km: density, temperature, pressure and speed of \
         sound by geodetic place and time. It requires an `epoch`.",
    );
    let indices = object
        .field("indices", "Indices")
        .doc("`file` takes the indices from the space-weather file of the service, in place of the numbers.")
        .optional()
        .word(&INDICES);
    let from_file = object.has("indices");
    object.condition(|| {
        let numbers = NUMBERS.map(|name| json!({"required": [name]}));
        json!({"dependentSchemas": {"indices": {"not": {"anyOf": numbers}}}})
    });
    if from_file {
        for name in NUMBERS {
            if object.has(name) {
                object.fault_of(name, "must not be given together with indices");
            }
        }
        indices?;
        let space_weather = space_weather::at(epoch?);
        return match space_weather {
            Ok(space_weather) => Some(of_space_weather(epoch?, space_weather)),
            Err(detail) => {
                object.fault_of("indices", format!("\"file\" {detail}"));
                None
            }
        };
    }
    let medium = SpaceWeather::MEDIUM;
    let mut flux =
        |name, title, doc, default: f64| object.field(name, title).doc(doc).default(default).number(Bound::SOLAR_FLUX);
    let f107 = flux(
        "f107",
        "F10.7",
        "Solar flux F10.7 of the day before, as observed, in solar flux units of 1e-22 W/(m² Hz).",
        medium.f107,
    );
    let f107_average = flux(
        "f107_average",
        "Mean F10.7",
        "Mean of F10.7 over 81 days around the day, in solar flux units.",
        medium.f107_average,
    );
    let ap = object
        .field("ap", "Ap")
        .doc(
            "Index Ap of the geomagnetic activity: the mean of the day, or a list of seven: the mean of the day; ap of \
             the three hours of the epoch, and of 3, 6 and 9 hours before; the means from 12 to 33 and from 36 to 57 \
             hours before.",
        )
        .default(4.0)
        .number_or_numbers(Bound::GEOMAGNETIC_AP, [7, 7]);
    let ap = match ap? {
        NumberOrList::Number(daily) => Ap::Daily(daily),
        NumberOrList::List(list) => Ap::History(list.try_into().ok()?),
    };
    Some(of_space_weather(epoch?, SpaceWeather { f107: f107?, f107_average: f107_average?, ap }))
}

fn of_space_weather(epoch: Epoch, space_weather: SpaceWeather) -> Atmosphere {
    let (day_of_year, second) = epoch.day_of_year();
    let model = CoreAtmosphere::Nrlmsise00(Arc::new(Nrlmsise00::new(day_of_year, second, space_weather)));
    let remedy = "Atmosphere nrlmsise00 is the Earth's: give that of the planet";
    Atmosphere { space_weather: Some(space_weather), ..Atmosphere::of_earth(model, remedy) }
}

#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn vacuum(object: &mut Object) -> Option<Atmosphere> {
    object.named("Vacuum", "No air.");
    Some(Atmosphere::of(CoreAtmosphere::Vacuum))
}

fn exponential(object: &mut Object) -> Option<Atmosphere> {
    object.named("ExponentialAtmosphere", "Density ρ₀ e^(-h/H) at the altitude h along the radius vector.");
    let is_given = object.has("surface_density") & object.has("scale_height");
    let surface_density = object
        .field("surface_density", "Surface density")
        .doc("Density ρ₀ at altitude 0, kg/m³.")
        .unit("kg/m³")
        .default(EARTH_JAMESON[0])
        .number(Bound::NON_NEGATIVE);
    let scale_height = object
        .field("scale_height", "Scale height")
        .doc("Scale height H, m.")
        .unit("m")
        .default(EARTH_JAMESON[1])
        .number(Bound::POSITIVE);
    let core = CoreAtmosphere::Exponential { surface_density: surface_density?, scale_height: scale_height? };
    let remedy = "Default density and scale height are the Earth's: give surface_density and scale_height";
    Some(if is_given { Atmosphere::of(core) } else { Atmosphere::of_earth(core, remedy) })
}

/// Layers whose numbers are known.
const PRESETS: Words<()> = Words {
    name: "LayersPreset",
    doc: "Predefined layers.",
    words: &[word("earth_seven_layer", (), "Earth, 7 layers").doc(
        "The Earth in seven layers that match the density of `us76` at their bases of 0, 10, 43, 68, 82, 112 and 120 \
         km. The density is within 5 % of `us76` up to 130 km, and 47 % lower at 150 km.",
    )],
};

fn layered_exponential(object: &mut Object) -> Option<Atmosphere> {
    object.named(
        "LayeredAtmosphere",
        "Density ρ e^(-(h - base)/H) in each layer. Exactly one of `layers` and `preset` must be given.",
    );
    let layers = object
        .field("layers", "Layers")
        .doc("Layers from the lowest to the highest. The first extends downward and the last upward without limit.")
        .optional()
        .objects([1, MOST_ENTRIES], layer);
    let preset = object.field("preset", "Preset").doc("Predefined layers.").optional().word(&PRESETS);
    let bases: Vec<_> = layers.iter().flatten().map(|layer| layer.base_altitude).collect();
    let sound = object.ascending("layers", "/base_altitude", &bases);
    object.exactly_one(&["layers", "preset"])?;
    match (layers, preset) {
        (Some(layers), _) => {
            let layers = sound.then(|| Layers::new(layers))?;
            Some(Atmosphere::of(CoreAtmosphere::Layers(Arc::new(object.sound(layers)?))))
        }
        (None, preset) => {
            preset?;
            let remedy = "Atmosphere earth_seven_layer is the Earth's: give layers";
            Some(Atmosphere::of_earth(CoreAtmosphere::Layers(Arc::new(Layers::earth_seven_layer())), remedy))
        }
    }
}

fn layer(object: &mut Object) -> Option<Layer> {
    object.named("Layer", "Layer of the atmosphere, up to the base of the next one.");
    let base_altitude = object
        .field("base_altitude", "Base altitude")
        .doc("Altitude of the base along the radius vector, m. It must be greater than that of the previous layer.")
        .unit("m")
        .number(Bound::DISTANCE);
    let density = object
        .field("density", "Density")
        .doc("Density ρ at the base, kg/m³.")
        .unit("kg/m³")
        .number(Bound::NON_NEGATIVE);
    let scale_height =
        object.field("scale_height", "Scale height").doc("Scale height H, m.").unit("m").number(Bound::POSITIVE);
    Some(Layer { base_altitude: base_altitude?, density: density?, scale_height: scale_height? })
}

/// The numbers of entries of a table of air.
const ENTRIES: [usize; 2] = [2, MOST_ENTRIES];

fn table(object: &mut Object) -> Option<Atmosphere> {
    object.named(
        "TableAtmosphere",
        "Properties of the air by altitude, interpolated smoothly. All lists must have the same length.",
    );
    let altitude = object
        .field("altitude", "Altitude")
        .doc("Altitudes along the radius vector, ascending, m.")
        .unit("m")
        .ascending()
        .numbers(Bound::DISTANCE, ENTRIES);
    let density = object
        .field("density", "Density")
        .doc("Densities, kg/m³. Outside the table, the logarithm of the density is extrapolated linearly.")
        .unit("kg/m³")
        .numbers(Bound::POSITIVE, ENTRIES);
    let temperature = object
        .field("temperature", "Temperature")
        .doc(
            "Temperatures, K. They give the speed of sound √(γRT/M), with γ and M of air, or of the gas given by \
             `molar_mass` and `heat_capacity_ratio`.",
        )
        .unit("K")
        .optional()
        .numbers(Bound::POSITIVE, ENTRIES);
    let pressure = object
        .field("pressure", "Pressure")
        .doc("Pressures, Pa.")
        .unit("Pa")
        .optional()
        .numbers(Bound::POSITIVE, ENTRIES);
    let speed_of_sound = object
        .field("speed_of_sound", "Speed of sound")
        .doc(
            "Speeds of sound, m/s, in place of those from the temperature. Not supported with `molar_mass` and \
             `heat_capacity_ratio`. Outside the table, the value at its end is used.",
        )
        .unit("m/s")
        .optional()
        .numbers(Bound::POSITIVE, ENTRIES);
    let molar_mass = object
        .field("molar_mass", "Molar mass")
        .doc(
            "Molar mass M of the gas, kg/mol: one number, or one per altitude; 0.04401 for carbon dioxide. It \
             requires `heat_capacity_ratio` and `temperature`.",
        )
        .unit("kg/mol")
        .optional()
        .number_or_numbers(Bound::MOLAR_MASS, ENTRIES);
    let heat_capacity_ratio = object
        .field("heat_capacity_ratio", "Heat capacity ratio")
        .doc(
            "Heat capacity ratio γ of the gas: one number, or one per altitude; γ/M is interpolated. It requires \
             `molar_mass` and `temperature`.",
        )
        .optional()
        .number_or_numbers(Bound::HEAT_CAPACITY_RATIO, ENTRIES);
    let lists = ["density", "temperature", "pressure", "speed_of_sound", "molar_mass", "heat_capacity_ratio"];
    let sound = object.equally_long("altitude", &lists) & has_one_gas(object);
    let (altitude, density) = (altitude?, density?);
    if !sound {
        return None;
    }
    let is_of_air = temperature.is_some() && speed_of_sound.is_none() && molar_mass.is_none();
    let table = Table::new(&altitude, &density, temperature.as_deref(), pressure.as_deref());
    let table = table.and_then(|table| match (&speed_of_sound, &molar_mass, &heat_capacity_ratio) {
        (Some(speed_of_sound), ..) => table.with_speed_of_sound(&altitude, speed_of_sound),
        (None, Some(NumberOrList::Number(mass)), Some(NumberOrList::Number(ratio))) => {
            table.with_gas(&altitude, Gas::Uniform { molar_mass: *mass, heat_capacity_ratio: *ratio })
        }
        (None, Some(mass), Some(ratio)) => {
            let [mass, ratio] = [mass, ratio].map(|of| of.spread(altitude.len()));
            table.with_gas(&altitude, Gas::ByAltitude { molar_mass: &mass, heat_capacity_ratio: &ratio })
        }
        _ => Ok(table),
    });
    let core = CoreAtmosphere::Table(Arc::new(object.sound(table)?));
    let remedy =
        "Speed of sound is that of air: give molar_mass and heat_capacity_ratio, or speed_of_sound, in the table";
    Some(if is_of_air { Atmosphere::of_earth(core, remedy) } else { Atmosphere::of(core) })
}

/// Notes a fault unless the gas is given by both of its numbers, beside a temperature, or by the speed of sound, or not at all.
fn has_one_gas(object: &mut Object) -> bool {
    const NUMBERS: [&str; 2] = ["molar_mass", "heat_capacity_ratio"];
    object.condition(|| {
        json!({"dependentRequired":
            {"molar_mass": ["heat_capacity_ratio", "temperature"], "heat_capacity_ratio": ["molar_mass"]}})
    });
    object.condition(|| {
        let gas = NUMBERS.map(|name| json!({"required": [name]}));
        json!({"dependentSchemas": {"speed_of_sound": {"not": {"anyOf": gas}}}})
    });
    let given = NUMBERS.map(|name| object.has(name));
    let mut faults = Vec::new();
    match given {
        [false, false] => {}
        _ if object.has("speed_of_sound") => {
            let given = NUMBERS.into_iter().zip(given).filter(|(_, given)| *given);
            faults.extend(given.map(|(name, _)| (name, "must not be given together with speed_of_sound")));
        }
        [of_mass, of_ratio] => {
            if !of_mass {
                faults.push((NUMBERS[0], "is required together with heat_capacity_ratio"));
            }
            if !of_ratio {
                faults.push((NUMBERS[1], "is required together with molar_mass"));
            }
            if !object.has("temperature") {
                faults.push(("temperature", "is required together with molar_mass and heat_capacity_ratio"));
            }
        }
    }
    for (name, detail) in &faults {
        object.fault_of(name, *detail);
    }
    faults.is_empty()
}
