//! The wind of a request.

use std::sync::Arc;

use reentry::elementary::{cos, sin};
use reentry::scenario::Bound;
use reentry::wind::{Wind as CoreWind, WindTable};

use super::description::{Object, variant};
use super::reader::MOST_ENTRIES;

/// The wind of a request.
#[derive(Clone, Debug)]
pub struct Wind {
    /// The velocity of the air.
    pub core: CoreWind,
    /// Whether the air moves at all.
    pub blows: bool,
}

impl Wind {
    /// The air turns with the planet.
    pub const STILL: Self = Self { core: CoreWind::Still, blows: false };

    /// Its `type`; `still` where there is none.
    pub fn kind(&self) -> &'static str {
        match self.core {
            CoreWind::Still => "still",
            CoreWind::Constant { .. } => "constant",
            CoreWind::Table(_) => "table",
        }
    }
}

/// The wind.
pub(super) fn wind(object: &mut Object) -> Option<Wind> {
    object.named(
        "Wind",
        "Velocity of the air relative to the rotating planet: east and north components in the plane normal to the \
         radius.",
    );
    object.variants(
        "Kind of wind.",
        &[
            variant("constant", "Uniform", "The same wind everywhere.", &constant),
            variant("table", "Altitude table", "Wind by altitude.", &table),
        ],
    )
}

/// The fields of a wind by its components, and those of one by its speed and direction.
const WAYS: [[&str; 2]; 2] = [["east", "north"], ["speed", "from"]];

fn constant(object: &mut Object) -> Option<Wind> {
    object.named("ConstantWind", "The same wind everywhere.");
    let [east, north] =
        object.one_set(
            WAYS,
            |object| {
                let east = object
                    .field("east", "East component")
                    .doc("Wind component towards the east, m/s.")
                    .unit("m/s")
                    .number(Bound::WIND);
                let north = object
                    .field("north", "North component")
                    .doc("Wind component towards the north, m/s.")
                    .unit("m/s")
                    .number(Bound::WIND);
                Some([east?, north?])
            },
            |object| {
                let speed = object
                    .field("speed", "Speed")
                    .doc("Wind speed, m/s. It requires `from`; both replace `east` and `north`.")
                    .unit("m/s")
                    .number(Bound::WIND_SPEED);
                let from = object
                .field("from", "Direction (from)")
                .doc("Direction from which the wind blows, clockwise from north: 0 is a north wind, 270° a west wind. \
                      Within ±2π (±360°).")
                .angle(Bound::TURN);
                Some(components(speed?, from?))
            },
        )?;
    Some(Wind { core: CoreWind::Constant { east, north }, blows: east != 0.0 || north != 0.0 })
}

fn table(object: &mut Object) -> Option<Wind> {
    object.named(
        "TableWind",
        "Wind by altitude, interpolated smoothly; outside the table, the wind at its ends is used. All lists must \
         have the same length.",
    );
    let altitude = object
        .field("altitude", "Altitude")
        .doc("Altitudes along the radius vector, ascending, m.")
        .unit("m")
        .ascending()
        .numbers(Bound::DISTANCE, [1, MOST_ENTRIES]);
    let [east, north] = object.one_set(
        WAYS,
        |object| {
            let east = object
                .field("east", "East")
                .doc("Wind component towards the east, m/s.")
                .unit("m/s")
                .numbers(Bound::WIND, [1, MOST_ENTRIES]);
            let north = object
                .field("north", "North")
                .doc("Wind component towards the north, m/s.")
                .unit("m/s")
                .numbers(Bound::WIND, [1, MOST_ENTRIES]);
            let sound = object.equally_long("altitude", &["east", "north"]);
            sound.then_some([east?, north?])
        },
        |object| {
            let speed = object
                .field("speed", "Speed")
                .doc(
                    "Wind speeds, m/s. They require `from`; both replace `east` and `north`. The east and north \
                     components are interpolated.",
                )
                .unit("m/s")
                .numbers(Bound::WIND_SPEED, [1, MOST_ENTRIES]);
            let from = object
                .field("from", "Direction (from)")
                .doc("Directions from which the wind blows, clockwise from north, within ±2π (±360°).")
                .angles(Bound::TURN, MOST_ENTRIES);
            let sound = object.equally_long("altitude", &["speed", "from"]);
            let (speed, from) = (speed?, from?);
            let both = speed.iter().zip(&from).map(|(speed, from)| components(*speed, *from));
            let (east, north) = both.map(|[east, north]| (east, north)).unzip();
            sound.then_some([east, north])
        },
    )?;
    let blows = east.iter().chain(&north).any(|component| *component != 0.0);
    let table = object.sound(WindTable::new(&altitude?, &east, &north))?;
    Some(Wind { core: CoreWind::Table(Arc::new(table)), blows })
}

/// The components to the east and to the north of a wind from a direction, rad.
fn components(speed: f64, from: f64) -> [f64; 2] {
    [-speed * sin(from), -speed * cos(from)]
}
