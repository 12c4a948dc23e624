//! KML 2.2 (OGC 07-147r2), with the `gx:Track` of Google's extension: a placemark for the track, one for every point.

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use serde_json::{Map, Value};

use super::{BodyTrack, NamedPoint, Track, Vertex};

type Xml<'a> = Writer<&'a mut dyn Write>;

/// The bodies of which viewers have a globe beside the Earth's: `hint="target=mars"` of the root selects it, as Google Earth reads it.
pub(super) const GLOBES: [&str; 2] = ["mars", "moon"];

impl Track<'_> {
    /// A document: with an epoch a track with an instant a vertex, without one a line; then the points. Each body that left has a folder of
    /// these.
    ///
    /// Altitudes are absolute: above the sea, as KML has it, where the case's are above the ellipsoid. Characters that XML cannot hold
    /// come as U+FFFD.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_kml(&self, out: &mut dyn Write) -> Result<(), serde_json::Error> {
        self.write(&mut Writer::new(out)).map_err(serde_json::Error::io)
    }

    fn write(&self, xml: &mut Xml) -> io::Result<()> {
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let mut root = xml.create_element("kml").with_attributes([
            ("xmlns", "http://www.opengis.net/kml/2.2"),
            ("xmlns:gx", "http://www.google.com/kml/ext/2.2"),
        ]);
        if let Some(globe) = GLOBES.iter().find(|globe| **globe == self.answer.models.planet) {
            root = root.with_attribute(("hint", format!("target={globe}").as_str()));
        }
        root.write_inner_content(|xml| {
            element(xml, "Document", |xml| {
                self.tracks.iter().try_for_each(|track| match track.told.body {
                    None => self.body(xml, track),
                    Some(_) => element(xml, "Folder", |xml| self.body(xml, track)),
                })
            })
        })?;
        Ok(())
    }

    fn body(&self, xml: &mut Xml, track: &BodyTrack) -> io::Result<()> {
        text(xml, "name", track.name)?;
        text(xml, "description", &track.notes())?;
        if let Some(vertices) = &track.vertices {
            element(xml, "Placemark", |xml| {
                text(xml, "name", track.name)?;
                if self.epoch.is_some() { self.track(xml, vertices) } else { line(xml, vertices) }
            })?;
        }
        track.points.iter().try_for_each(|point| placemark(xml, point))
    }

    fn track(&self, xml: &mut Xml, vertices: &[Vertex]) -> io::Result<()> {
        element(xml, "gx:Track", |xml| {
            text(xml, "altitudeMode", "absolute")?;
            for instant in vertices.iter().filter_map(|vertex| self.utc(vertex.time)) {
                text(xml, "when", &instant.to_string())?;
            }
            vertices.iter().try_for_each(|vertex| text(xml, "gx:coord", &coordinates(vertex, " ")))
        })
    }
}

fn line(xml: &mut Xml, vertices: &[Vertex]) -> io::Result<()> {
    let vertices: Vec<_> = vertices.iter().map(|vertex| coordinates(vertex, ",")).collect();
    geometry(xml, "LineString", &vertices.join(" "))
}

fn placemark(xml: &mut Xml, point: &NamedPoint) -> io::Result<()> {
    let properties: Map<String, Value> = serde_json::from_value(serde_json::to_value(point)?)?;
    element(xml, "Placemark", |xml| {
        text(xml, "name", &point.name)?;
        text(xml, "description", &point.description())?;
        element(xml, "ExtendedData", |xml| {
            for (name, value) in properties.iter().filter(|(name, _)| *name != "name") {
                let data = xml.create_element("Data").with_attribute(("name", name.as_str()));
                let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                data.write_inner_content(|xml| text(xml, "value", &value))?;
            }
            Ok(())
        })?;
        geometry(xml, "Point", &coordinates(&point.place, ","))
    })
}

/// A line or a point, tied to the ground.
fn geometry(xml: &mut Xml, kind: &str, coordinates: &str) -> io::Result<()> {
    element(xml, kind, |xml| {
        text(xml, "extrude", "1")?;
        text(xml, "altitudeMode", "absolute")?;
        text(xml, "coordinates", coordinates)
    })
}

fn coordinates(vertex: &Vertex, separator: &str) -> String {
    vertex.position().map(|coordinate| coordinate.to_string()).join(separator)
}

fn element(xml: &mut Xml, name: &str, inside: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<()> {
    xml.create_element(name).write_inner_content(inside).map(drop)
}

fn text(xml: &mut Xml, name: &str, content: &str) -> io::Result<()> {
    let content = content.replace(|character| !is_xml(character), "\u{fffd}");
    xml.create_element(name).write_text_content(BytesText::new(&content)).map(drop)
}

/// Whether XML 1.0 can hold a character (section 2.2).
fn is_xml(character: char) -> bool {
    matches!(character, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..)
}
