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
    #[schema(minimum = -1e4, maximum = 1e4)]
    pub east: f64,
    /// Towards the north, m/s.
    #[schema(minimum = -1e4, maximum = 1e4)]
    pub north: f64,
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
    #[schema(min_items = 1, max_items = 10_000)]
    pub east: Vec<f64>,
    /// Towards the north, m/s.
    #[schema(min_items = 1, max_items = 10_000)]
    pub north: Vec<f64>,
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
        let east = object.number("east", Bound::WIND);
        let north = object.number("north", Bound::WIND);
        Some(Self { kind: "constant", east: east?, north: north? })
    }
}

impl TableWind {
    fn read(object: &mut Object) -> Option<Self> {
        let altitude = object.entries("altitude", Bound::DISTANCE, [1, MOST_ENTRIES]);
        let altitude = altitude.filter(|altitude| object.ascending("altitude", "", altitude));
        let east = object.entries("east", Bound::WIND, [1, MOST_ENTRIES]);
        let north = object.entries("north", Bound::WIND, [1, MOST_ENTRIES]);
        let sound = object.equally_long("altitude", &["east", "north"]);
        let (altitude, east, north) = (altitude?, east?, north?);
        if !sound {
            return None;
        }
        let core = Arc::new(object.sound(CoreTable::new(&altitude, &east, &north))?);
        Some(Self { kind: "table", altitude, east, north, core })
    }
}
