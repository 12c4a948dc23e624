//! `GeoJSON` (RFC 7946): a feature for the track, one for every point.

use geojson::{Feature, FeatureCollection, Geometry};
use serde::Serialize;
use serde_json::{Value, json};

use super::{Track, Vertex};

/// Where longitudes jump, degrees.
const ANTIMERIDIAN: f64 = 180.0;

impl Track<'_> {
    /// A feature collection: the track, with the time of every vertex in the shape of its coordinates, and the points.
    ///
    /// A line of `GeoJSON` is straight on a map of longitude and latitude. The track is therefore cut at the antimeridian, and led
    /// over a pole by way of it.
    ///
    /// # Errors
    /// Never: there are no keys but strings, and memory can always be written.
    pub fn to_geojson(&self) -> Result<Vec<u8>, serde_json::Error> {
        let parts = cut(&by_way_of_poles(&self.vertices));
        let mut properties = json!({
            "name": self.name(),
            "kind": "track",
            "termination": self.answer.termination,
            "models": self.answer.models,
            "warnings": self.answer.warnings,
            "time": in_shape(&parts, |vertex| json!(vertex.time)),
        });
        if self.epoch.is_some() {
            properties["utc"] = in_shape(&parts, |vertex| json!(self.utc(vertex.time)));
        }
        let lines = parts.iter().map(|part| part.iter().map(Vertex::position));
        let geometry = match &parts[..] {
            [part] => Geometry::new_line_string(part.iter().map(Vertex::position)),
            _ => Geometry::new_multi_line_string(lines),
        };
        let mut features = vec![feature(geometry, properties)?];
        for point in &self.points {
            features.push(feature(Geometry::new_point(point.place.position()), point)?);
        }
        serde_json::to_vec(&FeatureCollection::new(features))
    }
}

fn feature(geometry: Geometry, properties: impl Serialize) -> Result<Feature, serde_json::Error> {
    let properties = serde_json::from_value(serde_json::to_value(properties)?)?;
    Ok(Feature { geometry: Some(geometry), properties, ..Feature::default() })
}

/// A value a vertex, nested as the coordinates of the track are.
fn in_shape(parts: &[Vec<Vertex>], value: impl Fn(&Vertex) -> Value) -> Value {
    let of_part = |part: &Vec<Vertex>| part.iter().map(&value).collect();
    match parts {
        [part] => of_part(part),
        _ => parts.iter().map(of_part).collect(),
    }
}

/// The vertices and, where the great circle between two of them passes nearer to a pole than to the line between them on the map,
/// the pole at the longitude of either.
fn by_way_of_poles(vertices: &[Vertex]) -> Vec<Vertex> {
    let mut way: Vec<Vertex> = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        if let Some(last) = way.last().copied()
            && passes_pole(&last, vertex)
        {
            let [before, after] = [&last, vertex].map(from_pole);
            let over = last.towards(vertex, before / (before + after));
            let pole = Vertex { latitude: 90_f64.copysign(last.latitude), ..over };
            way.push(Vertex { longitude: last.longitude, ..pole });
            way.push(Vertex { longitude: vertex.longitude, ..pole });
        }
        way.push(*vertex);
    }
    way
}

/// Whether the great circle between two vertices passes nearer to a pole than to the line between them on the map.
fn passes_pole(one: &Vertex, other: &Vertex) -> bool {
    let turn = (other.longitude - one.longitude).abs();
    let turn = turn.min(360.0 - turn);
    if turn <= 90.0 || one.latitude * other.latitude <= 0.0 {
        return false;
    }
    // The normal of the plane of the great circle, with one vertex in longitude 0.
    let [(sin_one, cos_one), (sin_other, cos_other)] =
        [one, other].map(|vertex| vertex.latitude.to_radians().sin_cos());
    let (sin_turn, cos_turn) = turn.to_radians().sin_cos();
    let x = -sin_one * cos_other * sin_turn;
    let y = sin_one * cos_other * cos_turn - cos_one * sin_other;
    let z = cos_one * cos_other * sin_turn;
    let nearest = z.atan2(x.hypot(y)).to_degrees();
    let line = 0.5 * (from_pole(one) + from_pole(other));
    nearest < line - nearest
}

/// Degrees from the nearer pole.
fn from_pole(vertex: &Vertex) -> f64 {
    90.0 - vertex.latitude.abs()
}

/// The parts between the crossings of the antimeridian, the shorter way around; each begins and ends on it where it was cut.
///
/// A flight that ends where it starts is no line, and has none.
fn cut(vertices: &[Vertex]) -> Vec<Vec<Vertex>> {
    let mut parts = Vec::new();
    let mut part: Vec<Vertex> = Vec::new();
    for vertex in vertices {
        let mut vertex = *vertex;
        if let Some(last) = part.last().copied() {
            let edge = ANTIMERIDIAN.copysign(last.longitude);
            if vertex.longitude.abs() >= ANTIMERIDIAN {
                // It has either sign: that of the side from which the track comes.
                vertex.longitude = edge;
            }
            if (vertex.longitude - last.longitude).abs() > ANTIMERIDIAN {
                let beyond = vertex.longitude + 2.0 * edge;
                let there = last.towards(&vertex, (edge - last.longitude) / (beyond - last.longitude));
                if last.longitude.abs() < ANTIMERIDIAN {
                    part.push(Vertex { longitude: edge, ..there });
                }
                parts.push(std::mem::take(&mut part));
                part.push(Vertex { longitude: -edge, ..there });
            }
        }
        part.push(vertex);
    }
    parts.push(part);
    parts.retain(|part| part.len() > 1);
    parts
}

impl Vertex {
    /// The place and instant that is so large a part of the way to another on, on a straight line.
    fn towards(&self, other: &Self, part: f64) -> Self {
        let between = |from: f64, to: f64| from + part * (to - from);
        Self {
            time: between(self.time, other.time),
            longitude: between(self.longitude, other.longitude),
            latitude: between(self.latitude, other.latitude),
            altitude: between(self.altitude, other.altitude),
        }
    }
}
