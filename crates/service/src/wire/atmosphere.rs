//! The atmosphere of a request.

use std::sync::Arc;

use reentry::atmosphere::{
    Atmosphere as CoreAtmosphere, Gas, Layer as CoreLayer, Layers as CoreLayers, Table as CoreTable,
};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::{MOST_ENTRIES, NumberOrList, Object};

/// The atmosphere, which turns with the planet; altitudes are those along the radius vector.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("exponential" = "#/components/schemas/ExponentialAtmosphere"),
    ("us76" = "#/components/schemas/Us76Atmosphere"),
    ("layered_exponential" = "#/components/schemas/LayeredAtmosphere"),
    ("table" = "#/components/schemas/TableAtmosphere"),
    ("vacuum" = "#/components/schemas/Vacuum"),
)))]
pub enum Atmosphere {
    /// One scale height.
    Exponential(ExponentialAtmosphere),
    /// The U.S. Standard Atmosphere, 1976.
    Us76(Us76Atmosphere),
    /// Layers of one scale height each.
    Layered(LayeredAtmosphere),
    /// A table.
    Table(TableAtmosphere),
    /// No air.
    Vacuum(Vacuum),
}

/// Density ρ₀ e^(-h/H) at the altitude h along the radius vector.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ExponentialAtmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// ρ₀, at altitude 0, kg/m³.
    #[schema(required = false, minimum = 0, default = 1.54793)]
    pub surface_density: f64,
    /// H, m.
    #[schema(required = false, exclusive_minimum = 0, default = 6935)]
    pub scale_height: f64,
    /// Whether both numbers were given.
    #[serde(skip)]
    #[schema(ignore)]
    pub is_given: bool,
}

/// The U.S. Standard Atmosphere, 1976, from -5 to 1000 km, with temperature, pressure and speed of sound.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Us76Atmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
}

/// Density ρ e^(-(h - base)/H) in each of several layers. Exactly one of `layers` and `preset`.
// The layers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct LayeredAtmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// From the lowest to the highest; the first reaches down, the last up without end.
    #[schema(required = false, value_type = Vec<Layer>, min_items = 1, max_items = 10_000)]
    pub layers: Option<Vec<Layer>>,
    /// Layers whose numbers are known.
    #[schema(required = false, value_type = LayersPreset)]
    pub preset: Option<LayersPreset>,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreLayers>,
}

/// A layer, up to the base of the next.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Layer {
    /// Where it begins, m; greater than that of the layer before it.
    #[schema(minimum = -1e12, maximum = 1e12)]
    pub base_altitude: f64,
    /// ρ, there, kg/m³.
    #[schema(minimum = 0)]
    pub density: f64,
    /// H, m.
    #[schema(exclusive_minimum = 0)]
    pub scale_height: f64,
}

/// The layers whose numbers are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum LayersPreset {
    /// The Earth's, in seven layers derived from `us76`, whose density they have at their bases of 0, 10, 43, 68, 82, 112 and 120 km:
    /// within 5 % of it up to 130 km, and thinner above, by 47 % at 150 km.
    EarthSevenLayer,
}

/// The air by altitude, smooth between the entries; all lists have as many.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TableAtmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Along the radius vector, ascending, m.
    #[schema(min_items = 2, max_items = 10_000)]
    pub altitude: Vec<f64>,
    /// kg/m³. Beyond the altitudes its logarithm goes on in a straight line.
    #[schema(min_items = 2, max_items = 10_000)]
    pub density: Vec<f64>,
    /// K. With it the speed of sound is √(γRT/M): that of air, or of the gas with `molar_mass` and `heat_capacity_ratio`.
    #[schema(required = false, value_type = Vec<f64>, min_items = 2, max_items = 10_000)]
    pub temperature: Option<Vec<f64>>,
    /// Pa.
    #[schema(required = false, value_type = Vec<f64>, min_items = 2, max_items = 10_000)]
    pub pressure: Option<Vec<f64>>,
    /// m/s, in place of the one that follows from the temperature; not with `molar_mass` and `heat_capacity_ratio`.
    /// Beyond the altitudes it stays as it is at the end.
    #[schema(required = false, value_type = Vec<f64>, min_items = 2, max_items = 10_000)]
    pub speed_of_sound: Option<Vec<f64>>,
    /// M of the gas, kg/mol: a number, or one for each altitude; 0.04401 for carbon dioxide. With `heat_capacity_ratio` and `temperature`.
    #[schema(required = false, value_type = NumberOrList)]
    pub molar_mass: Option<NumberOrList>,
    /// γ of the gas: a number, or one for each altitude, of which γ/M is interpolated. With `molar_mass` and `temperature`.
    #[schema(required = false, value_type = NumberOrList)]
    pub heat_capacity_ratio: Option<NumberOrList>,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreTable>,
}

/// No air.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Vacuum {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
}

impl Atmosphere {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let read = object.choice::<fn(&mut Object) -> Option<Self>>(
            "type",
            &[
                ("exponential", |object| ExponentialAtmosphere::read(object).map(Self::Exponential)),
                ("us76", |_| Some(Self::Us76(Us76Atmosphere { kind: "us76" }))),
                ("layered_exponential", |object| LayeredAtmosphere::read(object).map(Self::Layered)),
                ("table", |object| TableAtmosphere::read(object).map(Self::Table)),
                ("vacuum", |_| Some(Self::Vacuum(Vacuum { kind: "vacuum" }))),
            ],
        )?;
        read(object)
    }

    pub(super) fn to_core(&self) -> CoreAtmosphere {
        match self {
            Self::Exponential(ExponentialAtmosphere { surface_density, scale_height, .. }) => {
                CoreAtmosphere::Exponential { surface_density: *surface_density, scale_height: *scale_height }
            }
            Self::Us76(_) => CoreAtmosphere::Us76,
            Self::Layered(layered) => CoreAtmosphere::Layers(Arc::clone(&layered.core)),
            Self::Table(table) => CoreAtmosphere::Table(Arc::clone(&table.core)),
            Self::Vacuum(_) => CoreAtmosphere::Vacuum,
        }
    }

    /// For a flight on another planet: what of it is the Earth's, and the remedy; nothing where all of it was given.
    pub(super) fn of_earth(&self) -> Option<&'static str> {
        match self {
            Self::Us76(_) => Some("Atmosphere us76 is the Earth's: give a table"),
            Self::Layered(LayeredAtmosphere { preset: Some(LayersPreset::EarthSevenLayer), .. }) => {
                Some("Atmosphere earth_seven_layer is the Earth's: give layers")
            }
            Self::Exponential(ExponentialAtmosphere { is_given: false, .. }) => {
                Some("Default density and scale height are the Earth's: give surface_density and scale_height")
            }
            Self::Table(table) if table.is_of_air() => Some(
                "Speed of sound is that of air: give molar_mass and heat_capacity_ratio, or speed_of_sound, in the table",
            ),
            Self::Exponential(_) | Self::Layered(_) | Self::Table(_) | Self::Vacuum(_) => None,
        }
    }

    /// Its `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Exponential(ExponentialAtmosphere { kind, .. })
            | Self::Us76(Us76Atmosphere { kind })
            | Self::Layered(LayeredAtmosphere { kind, .. })
            | Self::Table(TableAtmosphere { kind, .. })
            | Self::Vacuum(Vacuum { kind }) => kind,
        }
    }
}

impl ExponentialAtmosphere {
    fn read(object: &mut Object) -> Option<Self> {
        let is_given = object.has("surface_density") & object.has("scale_height");
        // Those of `CoreAtmosphere::EARTH_JAMESON`.
        let surface_density = object.number_or("surface_density", Bound::NON_NEGATIVE, 1.547_93);
        let scale_height = object.number_or("scale_height", Bound::POSITIVE, 6935.0);
        Some(Self { kind: "exponential", surface_density: surface_density?, scale_height: scale_height?, is_given })
    }
}

impl LayeredAtmosphere {
    fn read(object: &mut Object) -> Option<Self> {
        let layers = object.has("layers").then(|| {
            let layers = object.objects("layers", [1, MOST_ENTRIES], Layer::read)?;
            let bases: Vec<_> = layers.iter().map(|layer| layer.base_altitude).collect();
            object.ascending("layers", "/base_altitude", &bases).then_some(layers)
        });
        let presets = [("earth_seven_layer", LayersPreset::EarthSevenLayer)];
        let preset = object.has("preset").then(|| object.choice("preset", &presets));
        object.exactly_one(&["layers", "preset"])?;
        let (layers, preset) = (layers.flatten(), preset.flatten());
        let core = match (&layers, preset) {
            (Some(layers), _) => CoreLayers::new(layers.iter().copied().map(Layer::to_core).collect()),
            (None, Some(LayersPreset::EarthSevenLayer)) => Ok(CoreLayers::earth_seven_layer()),
            (None, None) => return None,
        };
        let core = Arc::new(object.sound(core)?);
        Some(Self { kind: "layered_exponential", layers, preset, core })
    }
}

impl Layer {
    fn read(object: &mut Object) -> Option<Self> {
        let base_altitude = object.number("base_altitude", Bound::DISTANCE);
        let density = object.number("density", Bound::NON_NEGATIVE);
        let scale_height = object.number("scale_height", Bound::POSITIVE);
        Some(Self { base_altitude: base_altitude?, density: density?, scale_height: scale_height? })
    }

    fn to_core(self) -> CoreLayer {
        let Self { base_altitude, density, scale_height } = self;
        CoreLayer { base_altitude, density, scale_height }
    }
}

impl TableAtmosphere {
    /// Whether its speed of sound is that of air.
    fn is_of_air(&self) -> bool {
        self.temperature.is_some() && self.speed_of_sound.is_none() && self.molar_mass.is_none()
    }

    fn read(object: &mut Object) -> Option<Self> {
        let altitude = object.entries("altitude", Bound::DISTANCE, [2, MOST_ENTRIES]);
        let altitude = altitude.filter(|altitude| object.ascending("altitude", "", altitude));
        let density = object.entries("density", Bound::POSITIVE, [2, MOST_ENTRIES]);
        let temperature = object.optional_entries("temperature", Bound::POSITIVE, [2, MOST_ENTRIES]);
        let pressure = object.optional_entries("pressure", Bound::POSITIVE, [2, MOST_ENTRIES]);
        let speed_of_sound = object.optional_entries("speed_of_sound", Bound::POSITIVE, [2, MOST_ENTRIES]);
        let mut of_gas = |name, bound| {
            if object.has(name) { object.number_or_entries(name, bound, [2, MOST_ENTRIES]) } else { None }
        };
        let molar_mass = of_gas("molar_mass", Bound::MOLAR_MASS);
        let heat_capacity_ratio = of_gas("heat_capacity_ratio", Bound::HEAT_CAPACITY_RATIO);
        let lists = ["density", "temperature", "pressure", "speed_of_sound", "molar_mass", "heat_capacity_ratio"];
        let sound = object.equally_long("altitude", &lists) & Self::has_one_gas(object);
        let (altitude, density) = (altitude?, density?);
        let optional = [
            ("temperature", temperature.is_none()),
            ("pressure", pressure.is_none()),
            ("speed_of_sound", speed_of_sound.is_none()),
            ("molar_mass", molar_mass.is_none()),
            ("heat_capacity_ratio", heat_capacity_ratio.is_none()),
        ];
        let lost = optional.into_iter().any(|(name, is_missing)| is_missing && object.has(name));
        if lost || !sound {
            return None;
        }
        let core = CoreTable::new(&altitude, &density, temperature.as_deref(), pressure.as_deref());
        let core = core.and_then(|core| match (&speed_of_sound, &molar_mass, &heat_capacity_ratio) {
            (Some(speed_of_sound), ..) => core.with_speed_of_sound(&altitude, speed_of_sound),
            (None, Some(NumberOrList::Number(mass)), Some(NumberOrList::Number(ratio))) => {
                core.with_gas(&altitude, Gas::Uniform { molar_mass: *mass, heat_capacity_ratio: *ratio })
            }
            (None, Some(mass), Some(ratio)) => {
                let [mass, ratio] = [mass, ratio].map(|of| of.spread(altitude.len()));
                core.with_gas(&altitude, Gas::ByAltitude { molar_mass: &mass, heat_capacity_ratio: &ratio })
            }
            _ => Ok(core),
        });
        let core = Arc::new(object.sound(core)?);
        Some(Self {
            kind: "table",
            altitude,
            density,
            temperature,
            pressure,
            speed_of_sound,
            molar_mass,
            heat_capacity_ratio,
            core,
        })
    }

    /// Notes a fault unless the gas is given by both of its numbers, beside a temperature, or by the speed of sound, or not at all.
    fn has_one_gas(object: &mut Object) -> bool {
        const NUMBERS: [&str; 2] = ["molar_mass", "heat_capacity_ratio"];
        let given = NUMBERS.map(|name| object.has(name));
        let mut sound = true;
        let mut fault = |object: &mut Object, name: &str, detail: &str| {
            object.fault_of(name, detail.to_owned());
            sound = false;
        };
        match given {
            [false, false] => {}
            _ if object.has("speed_of_sound") => {
                for (name, _) in NUMBERS.into_iter().zip(given).filter(|(_, given)| *given) {
                    fault(object, name, "must not be given together with speed_of_sound");
                }
            }
            [of_mass, of_ratio] => {
                if !of_mass {
                    fault(object, NUMBERS[0], "is required together with heat_capacity_ratio");
                }
                if !of_ratio {
                    fault(object, NUMBERS[1], "is required together with molar_mass");
                }
                if !object.has("temperature") {
                    fault(object, "temperature", "is required together with molar_mass and heat_capacity_ratio");
                }
            }
        }
        sound
    }
}
