//! Files that are compiled into the program, each sent in the coding that its client likes best, as it was compressed beforehand.

use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::coding::Coding;

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
        let tag = format!("\"{}-{}\"", self.hash, coding.name());
        let both = [(header::ETAG, tag.as_str()), (header::VARY, "accept-encoding")];
        if is_known(request, &tag) {
            return (StatusCode::NOT_MODIFIED, both).into_response();
        }
        let file = (both, [(header::CONTENT_TYPE, media_type(self.path))], bytes);
        match coding {
            Coding::Identity => file.into_response(),
            coding => ([(header::CONTENT_ENCODING, coding.name())], file.into_response()).into_response(),
        }
    }

    /// The coding that the client likes best, the shorter one of two that are alike, and the bytes in it.
    pub fn representation(&self, request: &HeaderMap) -> (Coding, &'static [u8]) {
        let there_is = |(coding, bytes): (Coding, Option<&'static [u8]>)| Some((coding, bytes?));
        let offered = [(Coding::Brotli, self.brotli), (Coding::Gzip, self.gzip), (Coding::Identity, Some(self.plain))];
        let offered: Vec<_> = offered.into_iter().filter_map(there_is).collect();
        let codings: Vec<_> = offered.iter().map(|(coding, _)| *coding).collect();
        let best = Coding::negotiate(request, &codings);
        offered.into_iter().find(|(coding, _)| *coding == best).unwrap_or((Coding::Identity, self.plain))
    }
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
pub fn media_type(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("png") => "image/png",
        Some("svg") => "image/svg+xml",
        Some("json") => "application/json",
        Some("woff2") => "font/woff2",
        _ => "application/octet-stream",
    }
}
