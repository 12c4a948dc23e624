//! The request and the answer of `/footprint`: the ground that flights reach when numbers of a case vary.

use std::io::Write;

use geojson::{Feature, FeatureCollection, Geometry};
use reentry::Interrupt;
use reentry::coordinates::Site;
use reentry::scenario::Bound;
use reentry::sensitivity::Moment;
use reentry::simulate::SimulationError;
use reentry::solve::flight::{Extent, SearchFlight};
use reentry::solve::footprint::{Footprint, Landing, MapPolygon, Options, Outcome, SurveyFlight, on_map};
use reentry::solve::target::Number;
use reentry::trajectory::Termination as CoreTermination;
use serde::Serialize;
use serde_json::{Map, Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::columns::AvailableQuantities;
use super::description::{self, Object};
use super::outputs::ground_point;
use super::reader::Fault;
use super::requirements::{MOST_LIMITS, RequestedRequirement, WantedEnd, WantedNumber, limit};
use super::scenario::{SimulateRequest, case};
use super::schema::names;
use super::search::{CaseOfSearch, FlightsOfSearch, classes, without_analyses};
use super::track::geojson::line_parts;
use super::trajectory::Termination;
use super::vary::{MOST_IN_SEARCH, MovingCase, VariedNumber, Vary, vary};
use super::warning::{Purpose, Warning};

const MOST_FLIGHTS: usize = 100_000;

/// What a footprint is asked for, beside the case.
#[derive(Clone, Debug)]
pub(super) struct AskedFootprint {
    vary: Vec<Vary>,
    limits: Vec<RequestedRequirement>,
    options: Options,
}

/// A request of `/footprint`.
pub(super) fn footprint_request(object: &mut Object) -> Option<(SimulateRequest, AskedFootprint)> {
    object.named(
        "FootprintRequest",
        "Case to simulate, as for `/simulate`, the numbers of it that vary, and the limits that flights must keep.",
    );
    let case = case(object);
    without_analyses(object);
    let vary =
        object.field("vary", "Varied numbers").doc("Numbers that vary, at most 8.").objects([1, MOST_IN_SEARCH], vary);
    let limits = object
        .field("limits", "Limits")
        .doc("Limits that flights must keep for their landings to be in the footprint.")
        .default(json!([]))
        .objects([0, MOST_LIMITS], footprint_limit);
    let resolution = object
        .field("resolution", "Resolution")
        .doc("Accuracy of the boundary, m; the default is a thousandth of the extent of the first landings.")
        .unit("m")
        .optional()
        .number(Bound::POSITIVE);
    let flights = object.field("search", "Search").doc("Extent of the search.").default(json!({})).object(|object| {
        object.named("FootprintOptions", "Extent of the search.");
        object
            .field("flights", "Flights")
            .doc("Flights at most; beyond them the boundary is returned as far as it is known.")
            .default(20_000)
            .whole_number([1, MOST_FLIGHTS])
    });
    let options = Options { resolution, flights: flights? };
    Some((case?, AskedFootprint { vary: vary?, limits: limits?, options }))
}

fn footprint_limit(object: &mut Object) -> Option<RequestedRequirement> {
    object.named(
        "FootprintLimit",
        "Limit on a flight: on a `quantity` at a moment, on the distance of the end point from a `site`, or on the \
         `termination`.",
    );
    limit(object)
}

/// A sound request.
#[derive(Debug)]
pub struct FootprintRequest {
    /// The case.
    pub request: SimulateRequest,
    /// The case with its numbers.
    pub case: MovingCase,
    /// What flights must keep.
    pub extent: Extent,
    /// The limits on numbers.
    numbers: Vec<WantedNumber>,
    /// The limits on how flights end.
    ends: Vec<WantedEnd>,
    /// The extent of the search.
    pub options: Options,
    /// The request with every default filled in, if it asks for it.
    pub echo: Option<Value>,
}

impl FootprintRequest {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let ((request, asked), fields) = description::read_with_numbers(&mut tree, footprint_request)?;
        let others = ["vary", "limits", "resolution", "search"];
        let CaseOfSearch { tree: case, varied, mut faults, .. } =
            CaseOfSearch::of_list(&request, (&tree, fields), &others, &asked.vary);
        let known = request.known();
        let of_limits = asked.limits.iter().enumerate();
        faults.extend(
            of_limits.filter_map(|(index, requirement)| {
                requirement.fault(&format!("/limits/{index}"), known, &request.events)
            }),
        );
        if !faults.is_empty() {
            return Err(faults);
        }
        let numbers = |requirement: &RequestedRequirement| {
            requirement.numbers(request.angle_unit, &request.events, &request.planet.core)
        };
        let numbers: Vec<_> = asked.limits.iter().flat_map(numbers).collect();
        let ends: Vec<_> = asked.limits.iter().filter_map(|requirement| requirement.end(&request.events)).collect();
        let extents = numbers.iter().map(WantedNumber::extent).chain(ends.iter().map(WantedEnd::extent));
        Ok(Self {
            case: MovingCase::new(case, varied),
            extent: extents.max().unwrap_or(Extent::Ends),
            numbers,
            ends,
            options: asked.options,
            echo: request.echo.then_some(tree),
            request,
        })
    }

    /// The numbers that vary.
    pub fn numbers(&self) -> Vec<Number> {
        self.case.varied().iter().map(VariedNumber::number).collect()
    }

    /// What a flight gives. `near`: the downrange of the case's own landing, m, within half a turn of which that of the flight is taken.
    ///
    /// # Errors
    /// When the flag is raised.
    pub fn outcome(
        &self,
        flown: &SearchFlight,
        known: &AvailableQuantities,
        near: f64,
        interrupt: &dyn Interrupt,
    ) -> Result<Outcome, SimulationError> {
        let mut margin = f64::INFINITY;
        for number in &self.numbers {
            let reading = number.reading(flown, known, interrupt)?;
            margin = margin.min(reading.searched.map_or(f64::NEG_INFINITY, |value| number.searched().margin(value)));
        }
        if !self.ends.iter().all(|end| end.is_met(flown)) {
            margin = f64::NEG_INFINITY;
        }
        let flown = flown.vehicle();
        let end = flown.termination();
        let is_down = !matches!(end, CoreTermination::TimeLimit | CoreTermination::AtmosphereExit);
        let point = if is_down { flown.point(Moment::End, &|_| None, interrupt)? } else { None };
        let turn = std::f64::consts::TAU * known.planet.equatorial_radius();
        let range = flown.range_of_end();
        let landing = point.map(|point| Landing {
            site: ground_point(&point),
            downrange: range.map(|[along, _]| along + turn * ((near - along) / turn).round()),
            crossrange: range.map(|[_, across]| across),
        });
        Ok(Outcome { end: Some(end), landing, margin })
    }
}

/// Geographic position, in the unit of angles.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct LandingSite {
    /// Longitude, east positive.
    pub longitude: f64,
    /// Geodetic latitude, north positive.
    pub geodetic_latitude: f64,
}

/// Where a flight lands.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct FootprintLanding {
    /// Landing site.
    pub site: LandingSite,
    /// Distance along the great circle of the initial heading, m, as the column; null as there.
    #[schema(required = true)]
    pub downrange: Option<f64>,
    /// Distance to the right of it, m, as the column; null as there.
    #[schema(required = true)]
    pub crossrange: Option<f64>,
}

/// Landing that is farthest in one direction.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FootprintExtreme {
    /// Downrange or crossrange, m.
    pub value: f64,
    /// Values of the varied numbers, in the order of `vary`.
    pub values: Vec<f64>,
    /// Landing site.
    pub site: LandingSite,
}

/// Least and greatest downrange and crossrange of landings that keep all limits.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FootprintExtent {
    /// Least and greatest downrange; null if there is none.
    pub downrange: [Option<FootprintExtreme>; 2],
    /// Least and greatest crossrange: farthest to the left and to the right; null if there is none.
    pub crossrange: [Option<FootprintExtreme>; 2],
}

/// Kind of the geometry.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub enum MultiPolygonKind {
    /// Polygons.
    MultiPolygon,
}

/// Polygons as in `GeoJSON`, with longitudes and geodetic latitudes in degrees: a list of polygons, each a list of rings. The
/// first ring is the outer one, the others are holes. Polygons are cut at the antimeridian.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MultiPolygon {
    /// Kind of the geometry.
    #[serde(rename = "type")]
    pub kind: MultiPolygonKind,
    /// Polygons, rings, points: longitude and geodetic latitude, degrees.
    pub coordinates: Vec<Vec<Vec<[f64; 2]>>>,
}

/// Kind of the geometry.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub enum MultiLineKind {
    /// Lines.
    MultiLineString,
}

/// Lines as in `GeoJSON`, with longitudes and geodetic latitudes in degrees, cut at the antimeridian.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MultiLine {
    /// Kind of the geometry.
    #[serde(rename = "type")]
    pub kind: MultiLineKind,
    /// Lines and their points: longitude and geodetic latitude, degrees.
    pub coordinates: Vec<Vec<[f64; 2]>>,
}

/// Flights that landed, the case with its own numbers first if it does.
#[derive(Clone, Debug, Default, Serialize, ToSchema)]
pub struct FootprintPoints {
    /// Longitudes of the landings.
    pub longitude: Vec<f64>,
    /// Geodetic latitudes of the landings.
    pub geodetic_latitude: Vec<f64>,
    /// Downranges, m.
    pub downrange: Vec<Option<f64>>,
    /// Crossranges, m.
    pub crossrange: Vec<Option<f64>>,
    /// Values of the varied numbers: a list for each number.
    pub values: Vec<Vec<f64>>,
    /// Whether the flight keeps all limits.
    pub within_limits: Vec<bool>,
}

/// Ground that flights reach when numbers of a case vary.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FootprintResponse {
    /// Name of the case in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Unit of every angle in the response, except in `boundary`, `hull` and `curve`, which are in degrees.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Version of the service.
    pub version: &'static str,
    /// Area within the boundary on the planet's ellipsoid, m²; 0 if one number varies, unless its curve is closed.
    pub area: f64,
    /// Number of separate pieces of the footprint.
    pub pieces: usize,
    /// Boundary of the footprint, which is what flights reach that keep all limits. Pieces and holes of less than the square of the
    /// resolution are left out. If three or more numbers vary, it is the farthest that was found in each direction from a point within.
    pub boundary: MultiPolygon,
    /// Convex hull of the landings that keep all limits, on an equal-area map about the landing of the case.
    pub hull: MultiPolygon,
    /// Landings if one number varies, a line for each range of its values; null otherwise.
    #[schema(required = true)]
    pub curve: Option<MultiLine>,
    /// Landings that are farthest.
    pub extent: FootprintExtent,
    /// Landing of the case with its own numbers; null if it does not land.
    #[schema(required = true)]
    pub landing: Option<FootprintLanding>,
    /// Flights that landed.
    pub points: FootprintPoints,
    /// Part of the ranges with which flights land, by the first scan: 0 to 1.
    pub landed: f64,
    /// Part of the ranges with which flights land and keep all limits, by the first scan: 0 to 1.
    pub within_limits: f64,
    /// How flights ended.
    pub classes: Vec<Termination>,
    /// Accuracy of the boundary that was aimed at, m.
    pub resolution: f64,
    /// How far the boundary may be off between the landings that locate it, m; null if that is not known.
    #[schema(required = true)]
    pub error: Option<f64>,
    /// Whether the boundary is as accurate as `resolution`.
    pub complete: bool,
    /// Flights of the search.
    pub search: FlightsOfSearch,
    /// Warnings about the request and the footprint.
    pub warnings: Vec<Warning>,
    /// Request with all defaults filled in, which can be sent again; present with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::FootprintRequest)]
    pub case: Option<Value>,
}

impl MultiPolygon {
    fn new(polygons: Vec<MapPolygon>) -> Self {
        let ring = |ring: Vec<[f64; 2]>| {
            let closed = ring.iter().chain(ring.first());
            closed.map(|place| place.map(f64::to_degrees)).collect::<Vec<_>>()
        };
        let polygon = |polygon: MapPolygon| polygon.into_iter().map(ring).collect::<Vec<_>>();
        Self { kind: MultiPolygonKind::MultiPolygon, coordinates: polygons.into_iter().map(polygon).collect() }
    }

    fn geometry(&self) -> Geometry {
        Geometry::new_multi_polygon(self.coordinates.iter().cloned())
    }
}

impl LandingSite {
    fn new(site: &Site, unit: AngleUnit) -> Self {
        Self {
            longitude: unit.from_radians(site.longitude),
            geodetic_latitude: unit.from_radians(site.geodetic_latitude),
        }
    }
}

impl FootprintPoints {
    fn new(flights: &[SurveyFlight], unit: AngleUnit) -> Self {
        let mut points = Self::default();
        if let Some(first) = flights.first() {
            points.values.resize(first.values.len(), Vec::new());
        }
        for SurveyFlight { values, outcome } in flights {
            let Some(landing) = outcome.landing else { continue };
            let LandingSite { longitude, geodetic_latitude } = LandingSite::new(&landing.site, unit);
            points.longitude.push(longitude);
            points.geodetic_latitude.push(geodetic_latitude);
            points.downrange.push(landing.downrange);
            points.crossrange.push(landing.crossrange);
            points.within_limits.push(outcome.margin >= 0.0);
            for (column, value) in points.values.iter_mut().zip(values) {
                column.push(*value);
            }
        }
        points
    }
}

impl FootprintResponse {
    /// The answer to a request.
    pub fn new(asked: FootprintRequest, found: &Footprint, search: FlightsOfSearch) -> Self {
        let unit = asked.request.angle_unit;
        let map = |polygons: &[_]| found.plane.map(|plane| on_map(polygons, &plane)).unwrap_or_default();
        let extreme = |is_across: bool, flight: Option<usize>| {
            let SurveyFlight { values, outcome } = &found.flights[flight?];
            let landing = outcome.landing?;
            let value = if is_across { landing.crossrange? } else { landing.downrange? };
            Some(FootprintExtreme { value, values: values.clone(), site: LandingSite::new(&landing.site, unit) })
        };
        let own = found.flights.first().and_then(|flight| flight.outcome.landing);
        let is_complete = !found.is_out_of_budget && found.error.is_some_and(|error| error <= found.resolution);
        let mut warnings = Warning::of_request(&asked.request, Purpose::Flight);
        warnings.extend(Warning::of_footprint(found.landed, is_complete));
        let [downrange, crossrange] = found.extremes;
        Self {
            name: asked.request.name.clone(),
            angle_unit: unit,
            version: env!("CARGO_PKG_VERSION"),
            area: found.area,
            pieces: found.outline.len(),
            boundary: MultiPolygon::new(map(&found.outline)),
            hull: MultiPolygon::new(map(&found.hull.iter().map(|ring| vec![ring.clone()]).collect::<Vec<_>>())),
            curve: (asked.case.varied().len() == 1).then(|| curve(found)),
            extent: FootprintExtent {
                downrange: downrange.map(|flight| extreme(false, flight)),
                crossrange: crossrange.map(|flight| extreme(true, flight)),
            },
            landing: own.map(|landing| FootprintLanding {
                site: LandingSite::new(&landing.site, unit),
                downrange: landing.downrange,
                crossrange: landing.crossrange,
            }),
            points: FootprintPoints::new(&found.flights, unit),
            landed: found.landed,
            within_limits: found.within_limits,
            classes: classes(&found.ends),
            resolution: found.resolution,
            error: found.error,
            complete: is_complete,
            search,
            warnings,
            case: asked.echo,
        }
    }

    /// A feature collection: boundary, hull and curve, and as points the landing of the case and those that are farthest.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_geojson(&self, out: &mut impl Write) -> Result<(), serde_json::Error> {
        let mut features = vec![
            feature(
                self.boundary.geometry(),
                json!({
                    "name": self.name, "kind": "boundary", "area": self.area, "pieces": self.pieces, "error": self.error,
                    "complete": self.complete, "landed": self.landed, "within_limits": self.within_limits, "warnings": self.warnings,
                }),
            ),
            feature(self.hull.geometry(), json!({"name": self.name, "kind": "hull"})),
        ];
        if let Some(curve) = &self.curve {
            let lines = curve.coordinates.iter().cloned();
            features.push(feature(Geometry::new_multi_line_string(lines), json!({"name": self.name, "kind": "curve"})));
        }
        let degrees = |angle: f64| self.angle_unit.to_radians(angle).to_degrees();
        let point =
            |site: &LandingSite| Geometry::new_point([degrees(site.longitude), degrees(site.geodetic_latitude)]);
        if let Some(FootprintLanding { site, downrange, crossrange }) = &self.landing {
            let properties = json!({"kind": "landing", "downrange": downrange, "crossrange": crossrange});
            features.push(feature(point(site), properties));
        }
        let of_extent = [("downrange", &self.extent.downrange), ("crossrange", &self.extent.crossrange)];
        for (quantity, ends) in of_extent {
            for (end, extreme) in ["least", "greatest"].into_iter().zip(ends) {
                let Some(FootprintExtreme { value, values, site }) = extreme else { continue };
                let properties = json!({"kind": format!("{end} {quantity}"), "value": value, "values": values});
                features.push(feature(point(site), properties));
            }
        }
        serde_json::to_writer(out, &FeatureCollection::new(features))
    }
}

fn feature(geometry: Geometry, properties: Value) -> Feature {
    let properties: Option<Map<String, Value>> = match properties {
        Value::Object(properties) => Some(properties),
        _ => None,
    };
    Feature { geometry: Some(geometry), properties, ..Feature::default() }
}

/// The curve on the map.
fn curve(found: &Footprint) -> MultiLine {
    let line = |line: &Vec<[f64; 2]>| {
        let site = |point: &[f64; 2]| found.plane.map(|plane| plane.site(*point));
        let places = line.iter().filter_map(site);
        line_parts(places.map(|site| [site.longitude.to_degrees(), site.geodetic_latitude.to_degrees()]))
    };
    MultiLine { kind: MultiLineKind::MultiLineString, coordinates: found.curve.iter().flat_map(line).collect() }
}
