//! A map of the surface on a plane that keeps areas.

use std::f64::consts::PI;

use crate::coordinates::Site;
use crate::elementary::{asin, atan, atan2, atanh, hypot, sin, sin_cos};
use crate::planet::Shape;

/// A point of the plane, m.
pub type Point = [f64; 2];

/// Lambert's azimuthal equal-area map of an ellipsoid of revolution, by way of the sphere of the same area: at its centre x is to the east and
/// y to the north. The opposite of the centre is a circle.
///
/// # Reference
/// Snyder, Map Projections: A Working Manual, USGS Professional Paper 1395 (1987): equations 3-11 to 3-13, 24-2 to 24-4, 20-14 and 20-15.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    longitude: f64,
    sin_latitude: f64,
    cos_latitude: f64,
    /// Of the sphere with the area of the ellipsoid, m.
    radius: f64,
    authalic: Authalic,
}

/// The latitudes of the sphere whose zones have the areas of those of the ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Authalic {
    /// e² = 1 - (b/a)², below 0 where the poles are farther from the centre than the equator.
    eccentricity_squared: f64,
    /// q at the pole.
    at_pole: f64,
}

impl Authalic {
    fn new(eccentricity_squared: f64) -> Self {
        let mut authalic = Self { eccentricity_squared, at_pole: 1.0 };
        authalic.at_pole = authalic.zone(1.0);
        authalic
    }

    /// q: twice the area between the equator and a geodetic latitude, given by its sine, in parts of 2πa².
    fn zone(&self, sine: f64) -> f64 {
        let squared = self.eccentricity_squared;
        let eccentricity = squared.abs().sqrt();
        let inverse = if eccentricity < 1e-6 {
            // The next term of the series is lost in rounding.
            sine * (1.0 + squared * sine * sine / 3.0)
        } else if squared > 0.0 {
            atanh(eccentricity * sine) / eccentricity
        } else {
            atan(eccentricity * sine) / eccentricity
        };
        (1.0 - squared) * (sine / (1.0 - squared * sine * sine) + inverse)
    }

    /// The sine of the authalic latitude.
    fn sine(&self, geodetic_latitude: f64) -> f64 {
        (self.zone(sin(geodetic_latitude)) / self.at_pole).clamp(-1.0, 1.0)
    }

    /// The geodetic latitude, by Newton's method on its sine.
    fn geodetic(&self, sine: f64) -> f64 {
        let squared = self.eccentricity_squared;
        let mut geodetic = sine;
        for _ in 0..8 {
            let slope = 2.0 * (1.0 - squared) / (1.0 - squared * geodetic * geodetic).powi(2);
            geodetic = (geodetic + (sine * self.at_pole - self.zone(geodetic)) / slope).clamp(-1.0, 1.0);
        }
        asin(geodetic)
    }
}

impl Plane {
    /// The map about a place.
    pub fn about(centre: &Site, shape: &Shape) -> Self {
        let (equatorial, polar) = shape.semi_axes();
        let authalic = Authalic::new(1.0 - (polar / equatorial).powi(2));
        let sin_latitude = authalic.sine(centre.geodetic_latitude);
        Self {
            longitude: centre.longitude,
            sin_latitude,
            cos_latitude: (1.0 - sin_latitude * sin_latitude).sqrt(),
            radius: equatorial * (0.5 * authalic.at_pole).sqrt(),
            authalic,
        }
    }

    /// Where a place is on the map.
    ///
    /// # Examples
    /// ```
    /// use reentry::coordinates::Site;
    /// use reentry::planet::Planet;
    /// use reentry::solve::footprint::Plane;
    ///
    /// let [here, there] = [0.5, 0.5 + 1e-4].map(|geodetic_latitude| Site { longitude: 3.1, geodetic_latitude });
    /// let [x, y] = Plane::about(&here, &Planet::EARTH_WGS84.shape).point(&there);
    /// assert!(x.abs() < 1e-6 && (y - 635.0).abs() < 2.0);
    /// ```
    pub fn point(&self, site: &Site) -> Point {
        let sine = self.authalic.sine(site.geodetic_latitude);
        let cosine = (1.0 - sine * sine).sqrt();
        let (sin_east, cos_east) = sin_cos(site.longitude - self.longitude);
        let to_centre = self.sin_latitude * sine + self.cos_latitude * cosine * cos_east;
        let scale = self.radius * (2.0 / (1.0 + to_centre).max(f64::MIN_POSITIVE)).sqrt();
        let north = self.cos_latitude * sine - self.sin_latitude * cosine * cos_east;
        // The opposite of the centre is taken to the south.
        let limit = 2.0 * self.radius;
        let [x, y] = [scale * cosine * sin_east, scale * north];
        if hypot(x, y) <= limit { [x, y] } else { [0.0, -limit] }
    }

    /// The place at a point of the map: the longitude is within half a turn of the centre's.
    pub fn site(&self, [x, y]: Point) -> Site {
        let distance = hypot(x, y);
        if distance == 0.0 {
            return Site { longitude: self.longitude, geodetic_latitude: self.authalic.geodetic(self.sin_latitude) };
        }
        let angle = 2.0 * asin((0.5 * distance / self.radius).min(1.0));
        let (sine, cosine) = sin_cos(angle);
        let north = y / distance;
        let latitude = (cosine * self.sin_latitude + north * sine * self.cos_latitude).clamp(-1.0, 1.0);
        let east = atan2(x / distance * sine, self.cos_latitude * cosine - north * self.sin_latitude * sine);
        let longitude = self.longitude + east;
        let turns = (longitude / (2.0 * PI)).round();
        Site { longitude: longitude - turns * 2.0 * PI, geodetic_latitude: self.authalic.geodetic(latitude) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::Plane;
    use crate::coordinates::Site;
    use crate::planet::{Planet, Shape};

    const SHAPES: [Shape; 3] = [
        Planet::EARTH_WGS84.shape,
        Shape::Sphere { radius: 3.4e6 },
        Shape::Ellipsoid { equatorial_radius: 6.0e6, polar_radius: 6.5e6 },
    ];

    fn sites() -> impl Iterator<Item = Site> {
        let place = |index: u32| Site {
            longitude: f64::from(index % 12) * 0.5 - 3.0,
            geodetic_latitude: f64::from(index / 12) * 0.4 - 1.5,
        };
        (0..96).map(place)
    }

    #[test]
    fn points_are_led_back_to_their_places() {
        for shape in SHAPES {
            for centre in sites() {
                let plane = Plane::about(&centre, &shape);
                for site in sites() {
                    let back = plane.site(plane.point(&site));
                    let east = (back.longitude - site.longitude) * site.geodetic_latitude.cos();
                    let north = back.geodetic_latitude - site.geodetic_latitude;
                    assert!(east.hypot(north) < 1e-7, "{site:?} about {centre:?}: {back:?}");
                }
            }
        }
    }

    /// A ring of small quadrilaterals from pole to pole has the area of the surface, which is known in closed form.
    #[test]
    fn areas_are_those_of_the_surface() {
        for shape in SHAPES {
            let (a, b) = shape.semi_axes();
            let squared = 1.0 - (b / a).powi(2);
            let e = squared.abs().sqrt();
            let expected = match squared {
                0.0 => 4.0 * PI * a * a,
                oblate if oblate > 0.0 => 2.0 * PI * (a * a + b * b / e * e.atanh()),
                _ => {
                    let e = (1.0 - (a / b).powi(2)).sqrt();
                    2.0 * PI * a * a * (1.0 + b / a / e * e.asin())
                }
            };
            let plane = Plane::about(&Site { longitude: 0.3, geodetic_latitude: 0.9 }, &shape);
            let width = 1e-3;
            let steps = 2000;
            let mut ring = 0.0;
            for index in 0..steps {
                let latitude = |index: u32| f64::from(index) / f64::from(steps) * PI - FRAC_PI_2;
                let at = |east: f64, index: u32| {
                    plane.point(&Site { longitude: 0.7 + east, geodetic_latitude: latitude(index) })
                };
                let corners = [at(0.0, index), at(width, index), at(width, index + 1), at(0.0, index + 1)];
                let [p, q, r, s] = corners;
                ring += 0.5 * ((r[0] - p[0]) * (s[1] - q[1]) - (s[0] - q[0]) * (r[1] - p[1]));
            }
            let whole = ring * 2.0 * PI / width;
            assert!((whole / expected - 1.0).abs() < 2e-6, "{whole} is not {expected}");
        }
    }
}
