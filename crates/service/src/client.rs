//! Who asks: the address of the connection or, by the word of a proxy that is trusted, of the client behind it.

use std::net::{IpAddr, Ipv6Addr, SocketAddr};

use axum::http::{Extensions, HeaderMap, HeaderName, header};
use ipnet::IpNet;

use crate::config::{Config, ForwardedHeader};

/// The other end of the connection on which a request came.
#[derive(Clone, Copy, Debug)]
pub struct Peer(pub SocketAddr);

const X_FORWARDED_FOR: HeaderName = HeaderName::from_static("x-forwarded-for");

/// A client, as the limits tell clients apart; those whose address is not known are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Client(Option<IpAddr>);

impl From<IpAddr> for Client {
    fn from(address: IpAddr) -> Self {
        Self(Some(address))
    }
}

impl Client {
    /// The client of a request that [`client`] has put into its extensions.
    pub fn of(extensions: &Extensions) -> Self {
        extensions.get().copied().unwrap_or_default()
    }

    /// Its address.
    pub fn address(self) -> Option<IpAddr> {
        self.0
    }

    /// Its network: the /64 of an address of IPv6, in which a client has as many addresses as it likes; an address of IPv4 is one client.
    #[must_use]
    pub fn network(self) -> Self {
        self.within(64)
    }

    /// Its site: the /48 of an address of IPv6, in which a site has 65 536 networks.
    #[must_use]
    pub fn site(self) -> Self {
        self.within(48)
    }

    /// The network with a prefix of so many bits, where the address is one of IPv6.
    fn within(self, prefix: u32) -> Self {
        Self(self.0.map(|address| match address {
            IpAddr::V4(_) => address,
            IpAddr::V6(address) => Ipv6Addr::from_bits(address.to_bits() & (u128::MAX << (128 - prefix))).into(),
        }))
    }
}

/// The client of a request, whose address is not known where it came on no connection.
///
/// Each proxy adds the address from which it was asked to the end of the header. The addresses are read from there as long as it is a
/// trusted proxy that has written them: what a client writes itself is never believed.
pub fn client(extensions: &Extensions, headers: &HeaderMap, config: &Config) -> Client {
    let Some(Peer(peer)) = extensions.get() else { return Client::default() };
    let is_trusted = |address: &IpAddr| config.trusted_proxies.iter().any(|network: &IpNet| network.contains(address));
    let mut client = peer.ip().to_canonical();
    let forwarded = match config.forwarded_header {
        ForwardedHeader::XForwardedFor => items(headers, &X_FORWARDED_FOR, address),
        ForwardedHeader::Forwarded => items(headers, &header::FORWARDED, forwarded_for),
    };
    for address in forwarded.into_iter().rev() {
        match address {
            Some(address) if is_trusted(&client) => client = address.to_canonical(),
            // Nobody that is trusted has written it, or it is no address.
            _ => break,
        }
    }
    Client(Some(client))
}

/// The items of a list in a header, which may have several lines.
fn items<T>(headers: &HeaderMap, name: &HeaderName, item: impl Fn(&str) -> T) -> Vec<T> {
    let lines = headers.get_all(name).iter().map(|line| line.to_str().unwrap_or(""));
    lines.flat_map(|line| line.split(',')).map(|text| item(text.trim())).collect()
}

/// An address, with a port or without.
fn address(text: &str) -> Option<IpAddr> {
    let bare = text.strip_prefix('[').and_then(|text| text.strip_suffix(']')).unwrap_or(text);
    bare.parse().ok().or_else(|| text.parse().map(|address: SocketAddr| address.ip()).ok())
}

/// The `for` of an element of `Forwarded` (RFC 7239, section 4).
fn forwarded_for(element: &str) -> Option<IpAddr> {
    let pairs = element.split(';').filter_map(|pair| pair.split_once('='));
    let mut values = pairs.filter(|(name, _)| name.trim().eq_ignore_ascii_case("for")).map(|(_, value)| value.trim());
    address(values.next()?.trim_matches('"'))
}

#[cfg(test)]
mod tests {
    use std::net::{IpAddr, SocketAddr};

    use axum::http::{Extensions, HeaderMap, HeaderName, HeaderValue};

    use super::{Peer, client};
    use crate::config::{Config, ForwardedHeader};

    fn seen(header: ForwardedHeader, peer: &str, lines: &[(&'static str, &'static str)]) -> IpAddr {
        let config = Config {
            trusted_proxies: vec!["10.0.0.0/8".parse().unwrap(), "2001:db8::/32".parse().unwrap()],
            forwarded_header: header,
            ..Config::default()
        };
        let mut extensions = Extensions::new();
        extensions.insert(Peer(SocketAddr::new(peer.parse().unwrap(), 4000)));
        let mut headers = HeaderMap::new();
        for (name, value) in lines {
            headers.append(HeaderName::from_static(name), HeaderValue::from_static(value));
        }
        client(&extensions, &headers, &config).address().unwrap()
    }

    #[test]
    fn the_client_is_the_last_address_that_a_trusted_proxy_was_asked_from() {
        let by = |peer: &str, lines: &[_]| seen(ForwardedHeader::XForwardedFor, peer, lines).to_string();
        let header = "x-forwarded-for";
        assert_eq!(by("192.0.2.1", &[]), "192.0.2.1");
        // A client that is no proxy may write what it likes.
        assert_eq!(by("192.0.2.1", &[(header, "198.51.100.7")]), "192.0.2.1");
        assert_eq!(by("10.0.0.1", &[(header, "198.51.100.7")]), "198.51.100.7");
        // What stands before that is the client's own word.
        assert_eq!(by("10.0.0.1", &[(header, "203.0.113.9, 198.51.100.7")]), "198.51.100.7");
        assert_eq!(by("10.0.0.1", &[(header, "203.0.113.9, 198.51.100.7, 10.1.1.1")]), "198.51.100.7");
        assert_eq!(by("10.0.0.1", &[(header, "203.0.113.9"), (header, "198.51.100.7")]), "198.51.100.7");
        assert_eq!(by("10.0.0.1", &[(header, "198.51.100.7:1234")]), "198.51.100.7");
        assert_eq!(by("::ffff:10.0.0.1", &[(header, "[2001:db9::1]:80")]), "2001:db9::1");
        // No address: the proxy itself, and whoever else it does not name.
        assert_eq!(by("10.0.0.1", &[(header, "198.51.100.7, unknown")]), "10.0.0.1");
        assert_eq!(by("10.0.0.1", &[("forwarded", "for=198.51.100.7")]), "10.0.0.1");
    }

    #[test]
    fn the_header_of_rfc_7239_is_read_where_it_is_chosen() {
        let by = |lines: &[_]| seen(ForwardedHeader::Forwarded, "2001:db8::5", lines).to_string();
        assert_eq!(
            by(&[("forwarded", "for=203.0.113.9, proto=https;For=\"[2001:db9::1]:4711\";by=10.0.0.1")]),
            "2001:db9::1"
        );
        assert_eq!(by(&[("forwarded", "for=\"198.51.100.7:80\"")]), "198.51.100.7");
        assert_eq!(by(&[("forwarded", "for=_hidden")]), "2001:db8::5");
        assert_eq!(by(&[("x-forwarded-for", "198.51.100.7")]), "2001:db8::5");
    }
}
