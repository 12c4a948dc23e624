//! CZML 1.0 (the CZML Guide of `CesiumJS`): a packet for every flight, one for every point.

use std::io::Write;

use serde_json::{Value, json};

use super::{BodyTrack, Epoch, NamedPoint, Track, Vertex, name};

impl Track<'_> {
    /// A list of packets: the document with its clock, and of every body the flight with its path, and the points.
    ///
    /// CZML cannot do without a date: a flight without an epoch starts at noon of 2000 January 1, UTC.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_czml(&self, out: &mut impl Write) -> Result<(), serde_json::Error> {
        let epoch = self.epoch.unwrap_or_else(Epoch::noon_2000);
        let instant = |time: f64| epoch.utc(time).map(|instant| instant.to_string()).unwrap_or_default();
        let interval = |[start, end]: [f64; 2]| format!("{}/{}", instant(start), instant(end));
        let end = self.tracks.iter().filter_map(BodyTrack::span).map(|[_, end]| end).fold(0.0, f64::max);
        let mut packets = vec![json!({
            "id": "document",
            "name": name(self.answer),
            "version": "1.0",
            "clock": {"interval": interval([0.0, end]), "currentTime": instant(0.0), "multiplier": 1, "range": "CLAMPED"},
        })];
        for (place, track) in self.tracks.iter().enumerate() {
            // The ids of the vehicle are those of an answer without bodies.
            let [id, points] = match place.checked_sub(1) {
                None => ["flight".to_owned(), "point".to_owned()],
                Some(body) => [format!("body {body}"), format!("body {body} point")],
            };
            packets.extend(track.vertices.as_ref().zip(track.span()).map(|(vertices, span)| {
                let mut notes = track.notes();
                if self.epoch.is_none() {
                    notes.push_str("; without an epoch, the flight starts at noon of 2000 January 1, UTC");
                }
                json!({
                    "id": id,
                    "name": track.name,
                    "description": notes,
                    "availability": interval(span),
                    "position": {"epoch": instant(0.0), "cartographicDegrees": samples(vertices)},
                    "path": {"width": 2},
                    "point": {"pixelSize": 10},
                })
            }));
            packets.extend(
                track.points.iter().enumerate().map(|(index, point)| packet(&format!("{points} {index}"), point)),
            );
        }
        serde_json::to_writer(out, &packets)
    }
}

impl BodyTrack<'_> {
    /// The times of the first and the last vertex.
    fn span(&self) -> Option<[f64; 2]> {
        let vertices = self.vertices.as_ref()?;
        Some([vertices.first()?, vertices.last()?].map(|vertex| vertex.time))
    }
}

/// Time, longitude, latitude and altitude of every vertex.
fn samples(vertices: &[Vertex]) -> Vec<f64> {
    let sample = |vertex: &Vertex| {
        let [longitude, latitude, altitude] = vertex.position();
        [vertex.time, longitude, latitude, altitude]
    };
    vertices.iter().flat_map(sample).collect()
}

fn packet(id: &str, point: &NamedPoint) -> Value {
    json!({
        "id": id,
        "name": point.name,
        "description": point.description(),
        "properties": point,
        "position": {"cartographicDegrees": point.place.position()},
        "point": {"pixelSize": 6},
        "label": {"text": point.name, "font": "14px sans-serif", "pixelOffset": {"cartesian2": [0, -16]}},
    })
}
