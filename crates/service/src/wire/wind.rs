//! The wind of a request.

use std::sync::Arc;

use reentry::scenario::Bound;
use reentry::wind::{Wind as CoreWind, WindTable as CoreTable};
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::{MOST_ENTRIES, Object};

/// The velocity of the air relative to the rotating planet, along east and north of the plane normal to the radius.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("constant" = "#/components/schemas/ConstantWind"),
    ("table" = "#/components/schemas/TableWind"),
)))]
pub enum Wind {
    /// The same everywhere.
    Constant(ConstantWind),
    /// By altitude.
    Table(TableWind),
}

/// The same wind everywhere.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ConstantWind {
    /// The kind of wind.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Towards the east, m/s.
    #[schema(required = false, minimum = -1e4, maximum = 1e4)]
    pub east: f64,
    /// Towards the north, m/s.
    #[schema(required = false, minimum = -1e4, maximum = 1e4)]
    pub north: f64,
    /// m/s; with `from` in place of `east` and `north`.
    #[schema(required = false, value_type = f64, minimum = 0, maximum = 1e4)]
    pub speed: Option<f64>,
    /// The compass direction from which the wind blows, clockwise from north: 0 is a north wind, 270° a west wind.
    #[schema(required = false, value_type = f64)]
    pub from: Option<f64>,
}

/// Wind by altitude, smooth between the entries; beyond the first and the last their wind holds. All lists have as many.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TableWind {
    /// The kind of wind.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Along the radius vector, ascending, m.
    #[schema(min_items = 1, max_items = 10_000)]
    pub altitude: Vec<f64>,
    /// Towards the east, m/s.
    #[schema(required = false, min_items = 1, max_items = 10_000)]
    pub east: Vec<f64>,
    /// Towards the north, m/s.
    #[schema(required = false, min_items = 1, max_items = 10_000)]
    pub north: Vec<f64>,
    /// m/s; with `from` in place of `east` and `north`, which are what is interpolated.
    #[schema(required = false, value_type = Vec<f64>, min_items = 1, max_items = 10_000)]
    pub speed: Option<Vec<f64>>,
    /// The compass directions from which the wind blows, clockwise from north, within ±2π (±360°).
    #[schema(required = false, value_type = Vec<f64>, min_items = 1, max_items = 10_000)]
    pub from: Option<Vec<f64>>,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreTable>,
}

impl Wind {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let read = object.choice::<fn(&mut Object) -> Option<Self>>(
            "type",
            &[
                ("constant", |object| ConstantWind::read(object).map(Self::Constant)),
                ("table", |object| TableWind::read(object).map(Self::Table)),
            ],
        )?;
        read(object)
    }

    pub(super) fn to_core(&self) -> CoreWind {
        match self {
            Self::Constant(ConstantWind { east, north, .. }) => CoreWind::Constant { east: *east, north: *north },
            Self::Table(table) => CoreWind::Table(Arc::clone(&table.core)),
        }
    }

    /// Its `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Constant(ConstantWind { kind, .. }) | Self::Table(TableWind { kind, .. }) => kind,
        }
    }

    /// Whether the air moves at all.
    pub fn blows(&self) -> bool {
        let any = |components: &[f64]| components.iter().any(|component| *component != 0.0);
        match self {
            Self::Constant(ConstantWind { east, north, .. }) => any(&[*east, *north]),
            Self::Table(TableWind { east, north, .. }) => any(east) || any(north),
        }
    }
}

impl ConstantWind {
    fn read(object: &mut Object) -> Option<Self> {
        match Way::of(object)? {
            Way::Components => {
                let east = object.number("east", Bound::WIND);
                let north = object.number("north", Bound::WIND);
                Some(Self { kind: "constant", east: east?, north: north?, speed: None, from: None })
            }
            Way::SpeedAndDirection => {
                let speed = object.number("speed", Bound::WIND_SPEED);
                let from = object.angle("from", Bound::TURN);
                let (speed, from, unit) = (speed?, from?, object.unit()?);
                let [east, north] = components(speed, unit.to_radians(from));
                Some(Self { kind: "constant", east, north, speed: Some(speed), from: Some(from) })
            }
        }
    }
}

impl TableWind {
    fn read(object: &mut Object) -> Option<Self> {
        let altitude = object.entries("altitude", Bound::DISTANCE, [1, MOST_ENTRIES]);
        let altitude = altitude.filter(|altitude| object.ascending("altitude", "", altitude));
        let (east, north, speed, from) = match Way::of(object)? {
            Way::Components => {
                let east = object.entries("east", Bound::WIND, [1, MOST_ENTRIES]);
                let north = object.entries("north", Bound::WIND, [1, MOST_ENTRIES]);
                if !object.equally_long("altitude", &["east", "north"]) {
                    return None;
                }
                (east?, north?, None, None)
            }
            Way::SpeedAndDirection => {
                let speed = object.entries("speed", Bound::WIND_SPEED, [1, MOST_ENTRIES]);
                let from = object.angles("from", Bound::TURN, MOST_ENTRIES);
                if !object.equally_long("altitude", &["speed", "from"]) {
                    return None;
                }
                let (speed, from, unit) = (speed?, from?, object.unit()?);
                let both = speed.iter().zip(&from).map(|(speed, from)| components(*speed, unit.to_radians(*from)));
                let (east, north) = both.map(|[east, north]| (east, north)).unzip();
                (east, north, Some(speed), Some(from))
            }
        };
        let altitude = altitude?;
        let core = Arc::new(object.sound(CoreTable::new(&altitude, &east, &north))?);
        Some(Self { kind: "table", altitude, east, north, speed, from, core })
    }
}

/// How a wind is given.
#[derive(Clone, Copy)]
enum Way {
    Components,
    SpeedAndDirection,
}

impl Way {
    /// That of a wind, by the fields that it has; of none of them, the components are asked for.
    fn of(object: &mut Object) -> Option<Self> {
        let [components, other] =
            [["east", "north"], ["speed", "from"]].map(|names| names.map(|name| object.has(name)).contains(&true));
        match (components, other) {
            (true, true) => object.fault("must have east and north, or speed and from, got some of both"),
            (false, true) => Some(Self::SpeedAndDirection),
            (_, false) => Some(Self::Components),
        }
    }
}

/// The components to the east and to the north of a wind from a direction, rad.
fn components(speed: f64, from: f64) -> [f64; 2] {
    [-speed * from.sin(), -speed * from.cos()]
}
