//! Files that are compiled into the program, each sent in the coding that its client likes best, as it was compressed beforehand.

use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use axum::response::{IntoResponse, Response};

/// A file.
#[derive(Clone, Copy, Debug)]
pub struct File {
    /// Where the service has it.
    pub path: &'static str,
    /// A hash of what is in it.
    pub hash: &'static str,
    /// What is in it.
    pub plain: &'static [u8],
    /// The same by Brotli.
    pub brotli: Option<&'static [u8]>,
    /// The same by gzip.
    pub gzip: Option<&'static [u8]>,
}

impl File {
    /// The answer to a request with these headers: the file, or that the client has it.
    pub fn answer(&self, request: &HeaderMap) -> Response {
        let (coding, bytes) = self.representation(request);
        let tag = format!("\"{}-{coding}\"", self.hash);
        let both = [(header::ETAG, tag.as_str()), (header::VARY, "accept-encoding")];
        if is_known(request, &tag) {
            return (StatusCode::NOT_MODIFIED, both).into_response();
        }
        let file = (both, [(header::CONTENT_TYPE, media_type(self.path))], bytes);
        match coding {
            "identity" => file.into_response(),
            coding => ([(header::CONTENT_ENCODING, coding)], file.into_response()).into_response(),
        }
    }

    /// The coding of the greatest quality in `Accept-Encoding` (RFC 9110, section 12.5.3), the shorter one of two that are alike; a
    /// client that accepts none gets the file as it is.
    pub fn representation(&self, request: &HeaderMap) -> (&'static str, &'static [u8]) {
        let accepted = lines(request, header::ACCEPT_ENCODING).join(",");
        let mut best = (0.0, "identity", self.plain);
        for (coding, bytes) in [("br", self.brotli), ("gzip", self.gzip), ("identity", Some(self.plain))] {
            let quality = quality(&accepted, coding);
            if let Some(bytes) = bytes
                && quality > best.0
            {
                best = (quality, coding, bytes);
            }
        }
        (best.1, best.2)
    }
}

/// The quality that `Accept-Encoding` gives to a coding: what is said of it, or else of all that are not named.
fn quality(accepted: &str, coding: &str) -> f64 {
    let of = |wanted: &str| {
        accepted.split(',').find_map(|item| {
            let mut parameters = item.split(';').map(str::trim);
            if !parameters.next().is_some_and(|name| name.eq_ignore_ascii_case(wanted)) {
                return None;
            }
            let weight = parameters.find_map(|text| text.strip_prefix("q=").or(text.strip_prefix("Q=")));
            Some(weight.map_or(1.0, |weight| weight.parse().unwrap_or(0.0)))
        })
    };
    of(coding).or_else(|| of("*")).unwrap_or(0.0)
}

/// Whether `If-None-Match` has the tag (RFC 9110, section 13.1.2).
fn is_known(request: &HeaderMap, tag: &str) -> bool {
    let known = lines(request, header::IF_NONE_MATCH);
    known == ["*"]
        || known.iter().flat_map(|line| line.split(',')).any(|known| known.trim().trim_start_matches("W/") == tag)
}

/// The lines of a header.
fn lines(request: &HeaderMap, name: HeaderName) -> Vec<&str> {
    request.get_all(name).iter().filter_map(|line| line.to_str().ok()).collect()
}

/// The media type, by the end of a name.
fn media_type(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("json") => "application/json",
        Some("woff2") => "font/woff2",
        _ => "application/octet-stream",
    }
}
