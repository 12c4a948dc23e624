//! The sites that a case may name by their slugs.

use std::sync::LazyLock;

use reentry::coordinates::Site;
use reentry::planet::Shape;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::shown::shown;

/// Launch, landing or recovery site.
#[derive(Clone, Debug, Deserialize, Serialize, ToSchema)]
pub struct ListedSite {
    /// Name in cases.
    pub slug: String,
    /// Name for people.
    pub name: String,
    /// Country, by its code of ISO 3166-1; absent at sea.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub country: Option<String>,
    /// Use of the site.
    pub kind: SiteKind,
    /// Geodetic latitude, degrees.
    pub geodetic_latitude: f64,
    /// Longitude, degrees.
    pub longitude: f64,
    /// Geodetic altitude, m.
    pub geodetic_altitude: f64,
    /// Source of the altitude; `estimate` without a source.
    pub altitude_source: String,
    /// Source of latitude and longitude, with their error where it tells one.
    pub source: String,
    /// Remark.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub note: Option<String>,
}

/// Use of a site.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum SiteKind {
    /// Launches.
    Launch,
    /// Landings on a runway.
    Landing,
    /// Recovery of capsules.
    Recovery,
}

impl SiteKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Launch, Self::Landing, Self::Recovery];

    /// As requests write it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Launch => "launch",
            Self::Landing => "landing",
            Self::Recovery => "recovery",
        }
    }
}

/// All sites, with their sources; none where the file is not what the tests hold it to.
pub static SITES: LazyLock<Vec<ListedSite>> =
    LazyLock::new(|| serde_json::from_str(include_str!("sites.json")).unwrap_or_default());

/// Site that is nearest to the end of a flight.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct NearestSite {
    /// Slug of the site in `GET /sites`.
    pub slug: &'static str,
    /// Distance of the end point from the site, m, along the great circle of the sphere with the equatorial radius.
    pub distance: f64,
    /// Azimuth of the end point as seen from the site, from north towards east, in [0, 2π).
    pub azimuth: f64,
}

impl NearestSite {
    /// The one that is nearest to a place on a planet of a shape.
    pub fn to(place: &Site, shape: &Shape, unit: AngleUnit) -> Option<Self> {
        let from = |site: &'static ListedSite| {
            let [distance, azimuth] = site.place().distance_and_azimuth_to(place, shape);
            Self { slug: &site.slug, distance, azimuth: unit.turn_from_radians(azimuth) }
        };
        SITES.iter().map(from).min_by(|one, other| one.distance.total_cmp(&other.distance))
    }
}

impl ListedSite {
    /// Its place on the surface.
    pub fn place(&self) -> Site {
        Site { longitude: self.longitude.to_radians(), geodetic_latitude: self.geodetic_latitude.to_radians() }
    }

    /// Reads a slug.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(slug: &str) -> Result<&'static Self, String> {
        SITES.iter().find(|site| site.slug == slug).ok_or_else(|| {
            let given = shown(&Value::from(slug));
            match nearest(slug) {
                Some(near) => format!("must be the slug of a site of GET /sites, such as \"{near}\", got {given}"),
                None => format!("must be the slug of a site of GET /sites, got {given}"),
            }
        })
    }
}

/// The slug that shares most of its beginning with what was given, if any does.
fn nearest(given: &str) -> Option<&'static str> {
    let given = given.to_lowercase().replace([' ', '-'], "_");
    let shared = |slug: &str| slug.bytes().zip(given.bytes()).take_while(|(a, b)| a == b).count();
    let best = SITES.iter().max_by_key(|site| shared(&site.slug))?;
    (shared(&best.slug) >= 3).then_some(best.slug.as_str())
}

/// The schema of a slug.
pub fn slug_schema() -> Value {
    let slugs: Vec<_> = SITES.iter().map(|site| site.slug.as_str()).collect();
    json!({"type": "string", "enum": slugs, "description": "Slug of a site that `GET /sites` lists."})
}
