//! `GeoJSON` (RFC 7946): for every body a feature for its track, one for every point.

use std::io::Write;

use geojson::{Feature, FeatureCollection, Geometry};
use reentry::elementary::{atan2, hypot, sin_cos};
use serde::Serialize;
use serde_json::{Value, json};

use super::{BodyTrack, Track, Vertex};

/// Where longitudes jump, degrees.
const ANTIMERIDIAN: f64 = 180.0;

impl Track<'_> {
    /// A feature collection: the tracks, with the time of every vertex in the shape of its coordinates, and the points.
    ///
    /// A line of `GeoJSON` is straight on a map of longitude and latitude. The track is therefore cut at the antimeridian, and led
    /// over a pole by way of it.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_geojson(&self, out: &mut impl Write) -> Result<(), serde_json::Error> {
        let mut features = Vec::new();
        for track in &self.tracks {
            features.extend(track.vertices.as_ref().map(|vertices| self.line(track, vertices)).transpose()?);
            for point in &track.points {
                features.push(feature(Geometry::new_point(point.place.position()), point)?);
            }
        }
        serde_json::to_writer(out, &FeatureCollection::new(features))
    }

    fn line(&self, track: &BodyTrack, vertices: &[Vertex]) -> Result<Feature, serde_json::Error> {
        let parts = cut(&by_way_of_poles(vertices));
        let mut properties = json!({
            "name": track.name,
            "kind": "track",
            "termination": track.told.report.termination,
            "models": self.answer.models,
            "warnings": track.told.warnings,
            "times": in_shape(&parts, |vertex| json!(vertex.time)),
        });
        if self.epoch.is_some() {
            properties["times_utc"] = in_shape(&parts, |vertex| json!(self.utc(vertex.time)));
        }
        if let Some(body) = track.told.body {
            properties["body"] = json!(body);
        }
        let lines = parts.iter().map(|part| part.iter().map(Vertex::position));
        let geometry = match &parts[..] {
            [part] => Geometry::new_line_string(part.iter().map(Vertex::position)),
            _ => Geometry::new_multi_line_string(lines),
        };
        feature(geometry, properties)
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
    let [(sin_one, cos_one), (sin_other, cos_other)] = [one, other].map(|vertex| sin_cos(vertex.latitude.to_radians()));
    let (sin_turn, cos_turn) = sin_cos(turn.to_radians());
    let x = -sin_one * cos_other * sin_turn;
    let y = sin_one * cos_other * cos_turn - cos_one * sin_other;
    let z = cos_one * cos_other * sin_turn;
    let nearest = atan2(z, hypot(x, y)).to_degrees();
    let line = 0.5 * (from_pole(one) + from_pole(other));
    nearest < line - nearest
}

/// Degrees from the nearer pole.
fn from_pole(vertex: &Vertex) -> f64 {
    90.0 - vertex.latitude.abs()
}

/// The parts of a line on the map, given by longitudes and latitudes in degrees: cut at the antimeridian, and led over poles by way of them.
pub(in crate::wire) fn line_parts(places: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let vertex = |[longitude, latitude]: [f64; 2]| Vertex { time: 0.0, longitude, latitude, altitude: 0.0 };
    let vertices: Vec<_> = places.map(vertex).collect();
    let parts = cut(&by_way_of_poles(&vertices));
    let place = |vertex: &Vertex| [vertex.longitude, vertex.latitude];
    parts.iter().map(|part| part.iter().map(place).collect()).collect()
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

#[cfg(test)]
mod tests {
    use super::{Vertex, by_way_of_poles, cut};

    /// Vertices at these longitudes and latitudes, a second apart.
    fn vertices(places: &[(f64, f64)]) -> Vec<Vertex> {
        let vertex = |(time, &(longitude, latitude))| Vertex { time, longitude, latitude, altitude: 100.0 };
        (0..).map(f64::from).zip(places).map(vertex).collect()
    }

    fn places(vertices: &[Vertex]) -> Vec<(f64, f64)> {
        vertices.iter().map(|vertex| (vertex.longitude, vertex.latitude)).collect()
    }

    #[test]
    fn lines_are_cut_where_they_cross_the_antimeridian() {
        for (track, expected) in [
            (
                vec![(170.0, 0.0), (-170.0, 10.0)],
                vec![vec![(170.0, 0.0), (180.0, 5.0)], vec![(-180.0, 5.0), (-170.0, 10.0)]],
            ),
            (
                vec![(-170.0, 0.0), (160.0, 9.0)],
                vec![vec![(-170.0, 0.0), (-180.0, 3.0)], vec![(180.0, 3.0), (160.0, 9.0)]],
            ),
            // On it, the side is that of the neighbour.
            (
                vec![(170.0, 1.0), (180.0, 2.0), (-170.0, 3.0)],
                vec![vec![(170.0, 1.0), (180.0, 2.0)], vec![(-180.0, 2.0), (-170.0, 3.0)]],
            ),
            (vec![(-179.0, 1.0), (180.0, 2.0), (-179.0, 3.0)], vec![vec![(-179.0, 1.0), (-180.0, 2.0), (-179.0, 3.0)]]),
            (vec![(-179.0, 1.0), (180.0, 2.0), (180.0, 3.0)], vec![vec![(-179.0, 1.0), (-180.0, 2.0), (-180.0, 3.0)]]),
            (vec![(180.0, 1.0), (-179.0, 2.0)], vec![vec![(-180.0, 1.0), (-179.0, 2.0)]]),
            (vec![(180.0, 1.0), (179.0, 2.0)], vec![vec![(180.0, 1.0), (179.0, 2.0)]]),
            // The other edge of the map is not it.
            (vec![(-80.0, 1.0), (80.0, 2.0)], vec![vec![(-80.0, 1.0), (80.0, 2.0)]]),
            (vec![(1.0, 1.0)], vec![]),
        ] {
            let parts: Vec<_> = cut(&vertices(&track)).iter().map(|part| places(part)).collect();
            assert_eq!(parts, expected, "{track:?}");
        }
    }

    #[test]
    fn lines_go_by_way_of_the_pole_that_they_pass() {
        let over = by_way_of_poles(&vertices(&[(10.0, 80.0), (-170.0, 89.0)]));
        assert_eq!(places(&over), [(10.0, 80.0), (10.0, 90.0), (-170.0, 90.0), (-170.0, 89.0)]);
        assert!((over[1].time - 10.0 / 11.0).abs() < 1e-15 && over[1].altitude.to_bits() == 100.0_f64.to_bits());
        let over = by_way_of_poles(&vertices(&[(-100.0, -85.0), (85.0, -80.0)]));
        assert_eq!(places(&over)[1..3], [(-100.0, -90.0), (85.0, -90.0)]);
        for aside in [
            // A quarter of a turn about the pole, half the equator, a line that passes the other pole.
            [(0.0, 80.0), (90.0, 80.0)],
            [(0.0, 5.0), (150.0, 5.0)],
            [(0.0, 10.0), (100.0, -84.0)],
            [(30.0, 90.0), (-150.0, 90.0)],
        ] {
            assert_eq!(places(&by_way_of_poles(&vertices(&aside))), aside);
        }
    }
}
