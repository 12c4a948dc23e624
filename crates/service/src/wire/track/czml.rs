//! CZML 1.0 (the CZML Guide of `CesiumJS`): a packet for the flight, one for every point.

use std::io::Write;

use serde_json::{Value, json};

use super::{Epoch, NamedPoint, Track, Vertex};

impl Track<'_> {
    /// A list of packets: the document with its clock, the flight with its path, and the points.
    ///
    /// CZML cannot do without a date: a flight without an epoch starts at noon of 2000 January 1, UTC.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_czml(&self, out: &mut impl Write) -> Result<(), serde_json::Error> {
        let epoch = self.epoch.unwrap_or_else(Epoch::noon_2000);
        let end = self.vertices.last().map_or(0.0, |vertex| vertex.time);
        let [start, end] =
            [0.0, end].map(|time| epoch.utc(time).map(|instant| instant.to_string()).unwrap_or_default());
        let interval = format!("{start}/{end}");
        let samples = |vertex: &Vertex| {
            let [longitude, latitude, altitude] = vertex.position();
            [vertex.time, longitude, latitude, altitude]
        };
        let samples: Vec<f64> = self.vertices.iter().flat_map(samples).collect();
        let mut notes = self.notes();
        if self.epoch.is_none() {
            notes.push_str("; without an epoch, the flight starts at noon of 2000 January 1, UTC");
        }
        let document = json!({
            "id": "document",
            "name": self.name(),
            "version": "1.0",
            "clock": {"interval": interval, "currentTime": start, "multiplier": 1, "range": "CLAMPED"},
        });
        let flight = json!({
            "id": "flight",
            "name": self.name(),
            "description": notes,
            "availability": interval,
            "position": {"epoch": start, "cartographicDegrees": samples},
            "path": {"width": 2},
            "point": {"pixelSize": 10},
        });
        let points = self.points.iter().enumerate().map(|(index, point)| packet(index, point));
        serde_json::to_writer(out, &[document, flight].into_iter().chain(points).collect::<Value>())
    }
}

fn packet(index: usize, point: &NamedPoint) -> Value {
    json!({
        "id": format!("point {index}"),
        "name": point.name,
        "description": point.description(),
        "properties": point,
        "position": {"cartographicDegrees": point.place.position()},
        "point": {"pixelSize": 6},
        "label": {"text": point.name, "font": "14px sans-serif", "pixelOffset": {"cartesian2": [0, -16]}},
    })
}
