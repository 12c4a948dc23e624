//! `GET /sites`: the launch, landing and recovery sites that a case may name.

use axum::extract::Query;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use geojson::{Feature, FeatureCollection, Geometry, JsonObject};
use serde::Serialize;
use utoipa::ToSchema;

use crate::error::ApiError;
use crate::format::Format;
use crate::wire::sites::{ListedSite, SITES, SiteKind};

/// Sites that a case may name.
#[derive(Debug, Serialize, ToSchema)]
pub struct Sites {
    /// The sites.
    sites: Vec<&'static ListedSite>,
}

/// The columns of the table.
const COLUMNS: [&str; 10] = [
    "slug",
    "name",
    "country",
    "kind",
    "geodetic_latitude",
    "longitude",
    "geodetic_altitude",
    "altitude_source",
    "source",
    "note",
];

/// List the sites that a case may name.
///
/// Launch, landing and recovery sites with their places and sources, in degrees. Altitudes without a source are estimates, and say so.
#[utoipa::path(
    get,
    path = "/sites",
    tag = "reentry",
    params(
        ("format" = Option<String>, Query, description = "`json`, `csv` or `geojson`; takes precedence over `Accept`."),
        ("kind" = Option<SiteKind>, Query, description = "Only sites of this kind."),
        ("country" = Option<String>, Query, description = "Only sites in this country, by its code of ISO 3166-1, such as `FR`."),
    ),
    responses((status = 200, description = "The sites.", content(
        (Sites = "application/json"),
        (String = "text/csv"),
        (Object = "application/geo+json"),
    ))),
)]
pub async fn sites(parts: Parts) -> Result<Response, ApiError> {
    let (asked, query) = Asked::read(&parts)?;
    let format = Format::negotiate_beside(&parts, &[Format::Json, Format::Csv, Format::Geojson], &query)?;
    let sites: Vec<_> = SITES.iter().filter(|site| asked.is_met_by(site)).collect();
    let body = match format {
        Format::Csv => as_csv(&sites).map_err(|_| ApiError::Internal)?,
        Format::Geojson => serde_json::to_vec(&as_geojson(&sites)?).map_err(|_| ApiError::Internal)?,
        _ => serde_json::to_vec(&Sites { sites }).map_err(|_| ApiError::Internal)?,
    };
    Ok(([(header::CONTENT_TYPE, format.media_type()), (header::VARY, "accept")], body).into_response())
}

/// Which sites a request asks for.
#[derive(Default)]
struct Asked {
    kind: Option<SiteKind>,
    country: Option<String>,
}

impl Asked {
    /// Reads the query string; what it has beyond kind and country is of the format.
    fn read(parts: &Parts) -> Result<(Self, Vec<(String, String)>), ApiError> {
        let Query(query) = Query::<Vec<(String, String)>>::try_from_uri(&parts.uri)
            .map_err(|rejection| ApiError::BadQuery(rejection.body_text()))?;
        let mut asked = Self::default();
        let mut rest = Vec::new();
        for (name, value) in query {
            match name.as_str() {
                "kind" if asked.kind.is_none() => {
                    let kind = SiteKind::ALL.into_iter().find(|kind| kind.word() == value);
                    let words = SiteKind::ALL.map(SiteKind::word).join(", ");
                    let wrong = || ApiError::BadQuery(format!("kind must be one of {words}"));
                    asked.kind = Some(kind.ok_or_else(wrong)?);
                }
                "country" if asked.country.is_none() => asked.country = Some(value.to_uppercase()),
                _ => rest.push((name, value)),
            }
        }
        Ok((asked, rest))
    }

    fn is_met_by(&self, site: &ListedSite) -> bool {
        self.kind.is_none_or(|kind| site.kind == kind)
            && self.country.as_ref().is_none_or(|country| site.country.as_ref() == Some(country))
    }
}

fn as_csv(sites: &[&ListedSite]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(COLUMNS)?;
    for site in sites {
        let ListedSite { slug, name, country, kind, altitude_source, source, note, .. } = site;
        let numbers = [site.geodetic_latitude, site.longitude, site.geodetic_altitude].map(|number| number.to_string());
        let [latitude, longitude, altitude] = &numbers;
        let optional = |text: &'_ Option<String>| text.clone().unwrap_or_default();
        table.write_record([
            slug.as_str(),
            name,
            &optional(country),
            kind.word(),
            latitude,
            longitude,
            altitude,
            altitude_source,
            source,
            &optional(note),
        ])?;
    }
    table.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

fn as_geojson(sites: &[&ListedSite]) -> Result<FeatureCollection, ApiError> {
    let feature = |site: &&ListedSite| -> Result<Feature, ApiError> {
        let properties: Option<JsonObject> =
            serde_json::to_value(site).ok().and_then(|value| value.as_object().cloned());
        let position = [site.longitude, site.geodetic_latitude, site.geodetic_altitude];
        let properties = properties.ok_or(ApiError::Internal)?;
        Ok(Feature {
            geometry: Some(Geometry::new_point(position)),
            properties: Some(properties),
            ..Feature::default()
        })
    };
    Ok(FeatureCollection::new(sites.iter().map(feature).collect::<Result<Vec<_>, _>>()?))
}
