//! The representation of an answer, chosen by `?format=` or, without it, by `Accept`.

use axum::extract::Query;
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::error::ApiError;

/// A representation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Complete response, application/json
    Json,
    /// Trajectory as a table, text/csv
    Csv,
    /// Track on a map, application/geo+json
    Geojson,
    /// Track for Google Earth, application/vnd.google-earth.kml+xml
    Kml,
    /// Track for Cesium, application/czml+json
    Czml,
    /// States for orbit software, text/vnd.ccsds.oem
    Oem,
    /// A line of JSON for each case of a batch, application/x-ndjson
    #[value(skip)]
    Ndjson,
    /// Text to read, text/plain
    #[value(skip)]
    Text,
}

impl Format {
    /// Those of a flight.
    pub const OF_FLIGHTS: [Self; 6] = [Self::Json, Self::Csv, Self::Geojson, Self::Kml, Self::Czml, Self::Oem];
    /// Those of a theory beside a flight.
    pub const OF_THEORIES: [Self; 2] = [Self::Json, Self::Csv];

    /// Those of a footprint.
    pub const OF_FOOTPRINTS: [Self; 2] = [Self::Json, Self::Geojson];

    /// The name in `?format=`.
    fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Csv => "csv",
            Self::Geojson => "geojson",
            Self::Kml => "kml",
            Self::Czml => "czml",
            Self::Oem => "oem",
            Self::Ndjson => "ndjson",
            Self::Text => "text",
        }
    }

    /// Those of a command, for its flag.
    pub fn offered(formats: &[Self]) -> impl TypedValueParser<Value = Self> + use<> {
        let names: Vec<_> = formats.iter().filter_map(Self::to_possible_value).collect();
        PossibleValuesParser::new(names).try_map(|name| Self::from_str(&name, false))
    }

    /// The media type.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::Geojson => "application/geo+json",
            Self::Kml => "application/vnd.google-earth.kml+xml",
            Self::Czml => "application/czml+json",
            Self::Oem => OEM,
            Self::Ndjson => "application/x-ndjson",
            Self::Text => "text/plain; charset=utf-8",
        }
    }

    /// The one of the offered formats that the request asks for; the first where it does not care.
    ///
    /// # Errors
    /// When the request accepts none of them, or its query string has anything but `format`.
    pub fn negotiate(parts: &Parts, offered: &[Self]) -> Result<Self, ApiError> {
        let Query(query) = Query::<Vec<(String, String)>>::try_from_uri(&parts.uri)
            .map_err(|rejection| ApiError::BadQuery(rejection.body_text()))?;
        Self::negotiate_beside(parts, offered, &query)
    }

    /// The same, with the query string as far as the endpoint has no parameter of the name.
    ///
    /// # Errors
    /// When the request accepts none of them, or the query has anything but `format`.
    pub fn negotiate_beside(parts: &Parts, offered: &[Self], query: &[(String, String)]) -> Result<Self, ApiError> {
        let not_acceptable = |asked: &str| ApiError::NotAcceptable {
            offered: offered.iter().map(|format| format.name()).collect::<Vec<_>>().join(" or "),
            asked: asked.to_owned(),
        };
        match query {
            [] => accepted(&parts.headers, offered).ok_or_else(|| {
                let accept = parts.headers.get(header::ACCEPT).and_then(|value| value.to_str().ok());
                not_acceptable(accept.unwrap_or("something unreadable"))
            }),
            [(name, value)] if name == "format" => {
                offered.iter().copied().find(|format| format.name() == value).ok_or_else(|| not_acceptable(value))
            }
            _ => Err(ApiError::BadQuery("the query string may contain only one parameter, format".to_owned())),
        }
    }
}

/// CCSDS has registered no media type for the notation of keywords and values. It is lines of ASCII for people and programs, hence `text`,
/// in the name of those whose standard it is.
const OEM: &str = "text/vnd.ccsds.oem; charset=us-ascii";

/// Whether a client asks for HTML by name, and for JSON less: as browsers do, and tools do not.
pub fn prefers_html(headers: &HeaderMap) -> bool {
    let accept: Vec<_> = headers.get_all(header::ACCEPT).iter().filter_map(|value| value.to_str().ok()).collect();
    let accept = accept.join(",");
    accept.contains("text/html") && quality(&accept, "text/html") >= quality(&accept, "application/json")
}

/// The offered format of the greatest quality in `Accept` (RFC 9110, section 12.5.1).
fn accepted(headers: &HeaderMap, offered: &[Format]) -> Option<Format> {
    let accept: Vec<_> = headers.get_all(header::ACCEPT).iter().map(|value| value.to_str().unwrap_or("")).collect();
    let accept = accept.join(",");
    if accept.trim().is_empty() {
        return offered.first().copied();
    }
    let mut best = None;
    for format in offered {
        let quality = quality(&accept, format.media_type());
        if quality > best.map_or(0.0, |(greatest, _)| greatest) {
            best = Some((quality, *format));
        }
    }
    best.map(|(_, format)| format)
}

/// The quality that `Accept` gives to a media type: that of its most specific range.
fn quality(accept: &str, media_type: &str) -> f64 {
    let essence = media_type.split(';').next().unwrap_or_default();
    let family = essence.split('/').next().unwrap_or_default();
    let mut found = (0, 0.0);
    for range in accept.split(',') {
        let mut parameters = range.split(';').map(str::trim);
        let specificity = match parameters.next().unwrap_or_default().to_ascii_lowercase() {
            range if range == essence => 3,
            range if range.strip_suffix("/*") == Some(family) => 2,
            range if range == "*/*" => 1,
            _ => continue,
        };
        let weight = parameters.find_map(|parameter| parameter.strip_prefix("q=").or(parameter.strip_prefix("Q=")));
        let quality = weight.map_or(1.0, |weight| weight.parse().unwrap_or(0.0));
        if specificity > found.0 {
            found = (specificity, quality);
        }
    }
    found.1
}
