//! A place on the surface of a planet, and how far from it a flight ends.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::{Geodetic, LocalHorizon};
use crate::elementary::atan2;
use crate::planet::Shape;

/// A place on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// East positive, rad.
    pub longitude: f64,
    /// The angle of the surface's normal above the equatorial plane, rad.
    pub geodetic_latitude: f64,
}

impl Site {
    /// How far another place lies to the east and to the north, m: the chord between both, in the level plane of this one. It is
    /// smooth everywhere, over poles and the date line too, and near the site the distance on the ground.
    ///
    /// # Examples
    /// ```
    /// use reentry::coordinates::Site;
    /// use reentry::planet::Planet;
    ///
    /// let [site, other] = [0.5, 0.5 + 1e-4].map(|geodetic_latitude| Site { longitude: 3.1, geodetic_latitude });
    /// let [east, north] = site.offset_to(&other, &Planet::EARTH_WGS84.shape);
    /// // The radius of curvature of the meridian there is 6351 km.
    /// assert!(east.abs() < 1e-9 && (north - 635.1).abs() < 0.1);
    /// ```
    pub fn offset_to(&self, other: &Self, shape: &Shape) -> [f64; 2] {
        let chord = other.position(shape) - self.position(shape);
        let horizon = LocalHorizon::new(self.longitude, self.geodetic_latitude);
        [chord.dot(&horizon.east), chord.dot(&horizon.north)]
    }

    /// How far another place is, m, along the great circle of the sphere with the equatorial radius, and its azimuth from here, clockwise from
    /// north, in [0, 2π), rad; 0 where both are one place.
    pub fn distance_and_azimuth_to(&self, other: &Self, shape: &Shape) -> [f64; 2] {
        let [here, there] = [self, other].map(|site| site.position(shape));
        let (radius, _) = shape.semi_axes();
        let [east, north] = self.offset_to(other, shape);
        let turn = atan2(east, north);
        let azimuth = if turn < 0.0 { turn + TAU } else { turn };
        [atan2(here.cross(&there).norm(), here.dot(&there)) * radius, if azimuth < TAU { azimuth } else { 0.0 }]
    }

    /// Planet-fixed, m.
    fn position(&self, shape: &Shape) -> Vector3<f64> {
        let Self { longitude, geodetic_latitude } = *self;
        let at_rest = Geodetic {
            geodetic_altitude: 0.0,
            longitude,
            geodetic_latitude,
            speed: 0.0,
            flight_path_angle: 0.0,
            azimuth: 0.0,
        };
        at_rest.to_planet_fixed(shape).position
    }
}
