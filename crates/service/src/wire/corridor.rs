//! The request and the answer of `/corridor`: the values of one number with which flights keep limits.

use reentry::scenario::Bound;
use reentry::solve::corridor::{Corridor, Edge, Sample};
use reentry::solve::flight::Extent;
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

use super::AngleUnit;
use super::description::{self, Object};
use super::numbers::Numbers;
use super::reader::Fault;
use super::requirements::{MOST_LIMITS, RequestedRequirement, WantedEnd, WantedNumber, limit};
use super::scenario::{SimulateRequest, case};
use super::schema::names;
use super::search::{CaseOfSearch, FlightSummary, FlightsOfSearch, without_analyses};
use super::vary::{MovingCase, VariedNumber, Vary, bound, vary};
use super::warning::{Purpose, Warning};

/// The part of the range to which the ends of bands are located, where the request does not say.
const RESOLUTION: f64 = 1e-9;

/// What a corridor is asked for, beside the case.
#[derive(Clone, Debug)]
pub(super) struct AskedCorridor {
    vary: Vary,
    limits: Vec<AskedLimit>,
    resolution: Option<f64>,
}

#[derive(Clone, Debug)]
struct AskedLimit {
    requirement: RequestedRequirement,
    /// The numbers with which it is flown.
    with: Vec<(String, f64)>,
}

/// A request of `/corridor`.
pub(super) fn corridor_request(object: &mut Object) -> Option<(SimulateRequest, AskedCorridor)> {
    object.named(
        "CorridorRequest",
        "Case to simulate, as for `/simulate`, the number of it that varies, and the limits that flights must keep.",
    );
    let case = case(object);
    without_analyses(object);
    let vary = object.field("vary", "Varied number").doc("Number that varies.").object(vary);
    let limits = object
        .field("limits", "Limits")
        .doc("Limits, of which a value of the corridor keeps all.")
        .objects([1, MOST_LIMITS], corridor_limit);
    let resolution = object
        .field("resolution", "Resolution")
        .doc(
            "Accuracy of the ends of the bands, in the unit of the varied number; the default is 1e-9 of the width of its \
             range.",
        )
        .optional()
        .number(Bound::POSITIVE);
    Some((case?, AskedCorridor { vary: vary?, limits: limits?, resolution }))
}

fn corridor_limit(object: &mut Object) -> Option<AskedLimit> {
    object.named(
        "CorridorLimit",
        "Limit on a flight: on a `quantity` at a moment, on the distance of the end point from a `site`, or on the \
         `termination`. `with` has numbers of the case with which this limit is flown.",
    );
    let requirement = limit(object);
    let with = object
        .field("with", "Flown with")
        .doc(
            "Numbers of the case, by their JSON pointers, with which this limit is flown: the steep end of a corridor, for \
             example, with the lift up. Without it, the limit is flown with the case as it is.",
        )
        .optional()
        .numbers_by_name(Bound::FINITE);
    Some(AskedLimit { requirement: requirement?, with: with.unwrap_or_default() })
}

/// A sound request.
#[derive(Debug)]
pub struct CorridorRequest {
    /// The case.
    pub request: SimulateRequest,
    /// The number that varies.
    pub varied: VariedNumber,
    /// The cases that are flown with every value, of which the limits are.
    pub groups: Vec<LimitGroup>,
    /// How many limits there are.
    pub limits: usize,
    /// The accuracy of the ends of bands.
    pub resolution: f64,
    /// The request with every default filled in, if it asks for it.
    pub echo: Option<Value>,
}

/// The limits that are flown together.
#[derive(Debug)]
pub struct LimitGroup {
    /// The case with the numbers of these limits.
    pub case: MovingCase,
    /// What its flights must keep.
    pub extent: Extent,
    /// The limits, with their places in the request.
    pub limits: Vec<(usize, Limit)>,
}

/// A limit on a flight.
#[derive(Debug)]
pub enum Limit {
    /// On a number.
    Number(WantedNumber),
    /// On how it ends.
    Ends(WantedEnd),
}

impl CorridorRequest {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let ((request, asked), fields) = description::read_with_numbers(&mut tree, corridor_request)?;
        let of_limits = asked.limits.iter().flat_map(|limit| limit.with.iter().map(|(pointer, _)| pointer.as_str()));
        let CaseOfSearch { tree: case, numbers, varied, mut faults } = CaseOfSearch::new(
            &request,
            (&tree, fields),
            &["vary", "limits", "resolution"],
            &[("/vary".to_owned(), &asked.vary)],
            &of_limits.collect::<Vec<_>>(),
        );
        if varied.len() > 1 {
            let detail = format!("must point to one number, got {}", varied.len());
            faults.push(Fault::new("/vary/pointer", detail));
        }
        for (index, limit) in asked.limits.iter().enumerate() {
            faults.extend(limit.faults(index, &request, &numbers, &varied));
        }
        let (true, [varied]) = (faults.is_empty(), &varied[..]) else { return Err(faults) };
        let moving = MovingCase::new(case, vec![varied.clone()]);
        let width = varied.between[1] - varied.between[0];
        Ok(Self {
            groups: groups(&asked.limits, &request, &numbers, &moving),
            varied: varied.clone(),
            limits: asked.limits.len(),
            resolution: asked.resolution.unwrap_or(RESOLUTION * width),
            echo: request.echo.then_some(tree),
            request,
        })
    }
}

/// The limits by the numbers with which they are flown.
fn groups(limits: &[AskedLimit], request: &SimulateRequest, numbers: &Numbers, moving: &MovingCase) -> Vec<LimitGroup> {
    let mut groups: Vec<(Vec<(String, f64)>, LimitGroup)> = Vec::new();
    for (index, limit) in limits.iter().enumerate() {
        let with = limit.numbers(numbers);
        let place = groups.iter().position(|(of_group, _)| *of_group == with).unwrap_or_else(|| {
            let group = LimitGroup { case: moving.with(&with), extent: Extent::Ends, limits: Vec::new() };
            groups.push((with, group));
            groups.len() - 1
        });
        let group = &mut groups[place].1;
        let of_requirement = limit.requirement.numbers(request.angle_unit, &request.events, &request.planet.core);
        match of_requirement.into_iter().next() {
            Some(number) => {
                group.extent = group.extent.max(number.extent());
                group.limits.push((index, Limit::Number(number)));
            }
            None => {
                if let Some(end) = limit.requirement.end(&request.events) {
                    group.extent = group.extent.max(end.extent());
                    group.limits.push((index, Limit::Ends(end)));
                }
            }
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

impl AskedLimit {
    /// What is wrong with it.
    fn faults(
        &self,
        index: usize,
        request: &SimulateRequest,
        numbers: &Numbers,
        varied: &[VariedNumber],
    ) -> Vec<Fault> {
        let place = format!("/limits/{index}");
        let mut faults: Vec<_> = self.requirement.fault(&place, request.known(), &request.events).into_iter().collect();
        for (pointer, value) in &self.with {
            let at = format!("{place}/with/{}", pointer.replace('~', "~0").replace('/', "~1"));
            match numbers.at(pointer) {
                Err(detail) => faults.push(Fault::new(at, detail)),
                Ok(fields) => faults.extend(fields.into_iter().find_map(|field| {
                    let bound = bound(field, request.angle_unit);
                    let is_varied = varied.iter().any(|number| number.moves(&field.pointer));
                    let detail = if is_varied {
                        format!("must not be the number that varies, {}", field.pointer)
                    } else if bound.admits(*value) {
                        return None;
                    } else {
                        bound.refusal(*value)
                    };
                    Some(Fault::new(at.clone(), detail))
                })),
            }
        }
        faults
    }

    /// The numbers with which it is flown, one by one, in the order of their pointers.
    fn numbers(&self, numbers: &Numbers) -> Vec<(String, f64)> {
        let fields = |(pointer, value): &(String, f64)| {
            let fields = numbers.at(pointer).unwrap_or_default();
            fields.into_iter().map(|field| (field.pointer.clone(), *value)).collect::<Vec<_>>()
        };
        let mut with: Vec<_> = self.with.iter().flat_map(fields).collect();
        with.sort_by(|one, other| one.0.cmp(&other.0));
        with
    }
}

/// Limit beyond an end of a band.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum LimitOrBound {
    /// Index of the limit in `limits`, from 0.
    Limit(usize),
    /// End of the range.
    Bound(EndOfRange),
}

/// `bound`: the band ends with the range of the varied number.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EndOfRange {
    /// The band ends with the range of the varied number.
    Bound,
}

/// Range of values with which all limits are kept.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct CorridorBand {
    /// Least value.
    pub from: f64,
    /// Greatest value.
    pub to: f64,
    /// Width of the band.
    pub width: f64,
    /// What ends the band below.
    pub from_limit: LimitOrBound,
    /// What ends the band above.
    pub to_limit: LimitOrBound,
    /// Flights with the least value, one for each distinct `with`.
    pub from_flights: Vec<CorridorFlight>,
    /// Flights with the greatest value, one for each distinct `with`.
    pub to_flights: Vec<CorridorFlight>,
}

/// Flight at an end of a band.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct CorridorFlight {
    /// Indices of the limits that are flown with it, from 0.
    pub limits: Vec<usize>,
    /// Its end, events and peaks.
    #[serde(flatten)]
    pub flight: FlightSummary,
}

/// Range of values with which a limit is broken.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct CorridorGap {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Indices of the limits that are broken in it, from 0.
    pub broken: Vec<usize>,
}

/// Value with which the limits are kept best.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct NearestValue {
    /// Value of the varied number.
    pub value: f64,
    /// Worst of the margins with it.
    pub margin: f64,
}

/// Values that were flown, in ascending order: the picture of the corridor.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct CorridorSamples {
    /// Values of the varied number.
    pub value: Vec<f64>,
    /// What flights with them say of each limit.
    pub limits: Vec<LimitSamples>,
}

/// Samples of a limit, one for each value.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct LimitSamples {
    /// Quantity that is limited, in its unit; null for a termination, and where the flight has none.
    pub value: Vec<Option<f64>>,
    /// By how much the limit is kept, in parts of the limit: (12 - value)/12 for `"at_most": 12`, and by half the width
    /// of a range; of a termination 1. Negative: the limit is broken. Null: the flight failed or has no such quantity.
    pub margin: Vec<Option<f64>>,
}

/// Bands of a number with which flights keep limits.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct CorridorResponse {
    /// Name of the case in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Unit of every angle in the response.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Version of the service.
    pub version: &'static str,
    /// Ranges of values with which all limits are kept, in ascending order.
    pub bands: Vec<CorridorBand>,
    /// Ranges of values with which a limit is broken, in ascending order.
    pub gaps: Vec<CorridorGap>,
    /// Value with which the worst margin is best; null if there is a band.
    #[schema(required = true)]
    pub nearest: Option<NearestValue>,
    /// Values that were flown, except those that locate the ends of bands; at a relative tolerance of 1e-6, or the case's where that is coarser.
    pub samples: CorridorSamples,
    /// Greatest distance of neighbouring samples in the gaps: a narrower band may have been missed.
    pub narrowest: f64,
    /// Flights of the search.
    pub search: FlightsOfSearch,
    /// Warnings about the request.
    pub warnings: Vec<Warning>,
    /// Request with all defaults filled in, which can be sent again; present with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::CorridorRequest)]
    pub case: Option<Value>,
}

impl CorridorResponse {
    /// The answer to a request, with the flights at both ends of every band.
    pub fn new(
        asked: CorridorRequest,
        corridor: Corridor,
        ends: Vec<[Vec<CorridorFlight>; 2]>,
        search: FlightsOfSearch,
    ) -> Self {
        let beyond = |edge: &Edge| edge.limit.map_or(LimitOrBound::Bound(EndOfRange::Bound), LimitOrBound::Limit);
        let Corridor { bands, gaps, samples, nearest, narrowest } = corridor;
        let bands = bands.iter().zip(ends).map(|(band, [from_flights, to_flights])| CorridorBand {
            from: band.from.value,
            to: band.to.value,
            width: band.to.value - band.from.value,
            from_limit: beyond(&band.from),
            to_limit: beyond(&band.to),
            from_flights,
            to_flights,
        });
        let gaps = gaps.into_iter().map(|gap| CorridorGap { from: gap.from, to: gap.to, broken: gap.broken });
        let of_limit = |limit: usize| LimitSamples {
            value: samples.iter().map(|sample| sample.numbers[limit]).collect(),
            margin: samples.iter().map(|sample: &Sample| sample.margins[limit]).collect(),
        };
        Self {
            name: asked.request.name.clone(),
            angle_unit: asked.request.angle_unit,
            version: env!("CARGO_PKG_VERSION"),
            bands: bands.collect(),
            gaps: gaps.collect(),
            nearest: nearest.map(|(value, margin)| NearestValue { value, margin }),
            samples: CorridorSamples {
                value: samples.iter().map(|sample| sample.value).collect(),
                limits: (0..asked.limits).map(of_limit).collect(),
            },
            narrowest,
            search,
            warnings: Warning::of_request(&asked.request, Purpose::Flight),
            case: asked.echo,
        }
    }
}
