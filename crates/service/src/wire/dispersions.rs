//! Dispersions: numbers of a case that scatter, and the linear covariance of where the flight ends.

use std::f64::consts::TAU;

use reentry::Interrupt;
use reentry::scenario::Bound;
use reentry::sensitivity::{Moment, Slopes};
use reentry::solve::dispersions::{Ellipse as CoreEllipse, Group, least_eigenvalue};
use reentry::trajectory::Trajectory;
use serde::Serialize;
use serde_json::{Map, Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::columns::{AvailableQuantities, Column};
use super::description::{Object, variant};
use super::numbers::{Change, MOST_VARIED, Numbers, Varied, immovable};
use super::outputs::{At, FlightOutput, ground_point};
use super::reader::Fault;
use super::sensitivities::finite;

/// Numbers of a case that scatter together.
#[derive(Clone, Debug)]
pub struct Dispersion {
    /// The numbers: one pointer, or one for each variable of a multivariate distribution.
    pointers: Vec<String>,
    change: Change,
    distribution: Normal,
}

/// A normal distribution of one or several variables.
#[derive(Clone, Debug)]
struct Normal {
    mean: Option<Vec<f64>>,
    covariance: Vec<Vec<f64>>,
}

/// A dispersion of a request.
pub(super) fn dispersion(object: &mut Object) -> Option<Dispersion> {
    object.named(
        "Dispersion",
        "Uncertain number of the case: a random variable is added to it (`offset`) or multiplies it (`factor`). The \
         numbers of a list vary together.",
    );
    let pointers = object
        .field("pointer", "Parameter")
        .doc(
            "JSON pointer of a number of the case, or of a list of numbers, which vary together. A multivariate \
             distribution takes one pointer per variable.",
        )
        .text_or_texts(MOST_VARIED);
    let offset = |object: &mut Object| {
        let field = object
            .field("offset", "Offset")
            .doc("Distribution of the variable that is added, in the unit of the number.");
        Some((Change::Offset, field.object(distribution)?))
    };
    let factor = |object: &mut Object| {
        let field = object.field("factor", "Factor").doc("Distribution of the factor.");
        Some((Change::Factor, field.object(distribution)?))
    };
    let changed = object.alternatives(&[("offset", &offset), ("factor", &factor)]);
    let (pointers, (change, distribution)) = (pointers?, changed?);
    let name = if change == Change::Offset { "offset" } else { "factor" };
    let (got, needed) = (pointers.len(), distribution.covariance.len());
    if got != needed {
        object.fault_of("pointer", format!("must have as many pointers as {name} has variables, {needed}, got {got}"));
        return None;
    }
    Some(Dispersion { pointers, change, distribution })
}

fn distribution(object: &mut Object) -> Option<Normal> {
    object.named("NormalDistribution", "Normal distribution of one or several variables.");
    object.variants(
        "Kind of distribution.",
        &[
            variant("normal", "Normal", "Normal distribution of one variable.", &normal),
            variant(
                "multivariate_normal",
                "Multivariate normal",
                "Normal distribution of several variables.",
                &multivariate_normal,
            ),
        ],
    )
}

fn normal(object: &mut Object) -> Option<Normal> {
    object.named("Normal", "Normal distribution of one variable.");
    let mean = object
        .field("mean", "Mean")
        .doc("Mean; the default is 0 for an offset and 1 for a factor.")
        .optional()
        .number(Bound::MEAN);
    let deviation = object
        .field("standard_deviation", "Standard deviation")
        .doc("Standard deviation, in the unit of the variable.")
        .number(Bound::STANDARD_DEVIATION)?;
    Some(Normal { mean: mean.map(|mean| vec![mean]), covariance: vec![vec![deviation * deviation]] })
}

fn multivariate_normal(object: &mut Object) -> Option<Normal> {
    object.named("MultivariateNormal", "Normal distribution of several variables, one per pointer.");
    let mean = object
        .field("mean", "Means")
        .doc("Means; the default is 0 for offsets and 1 for factors.")
        .optional()
        .numbers(Bound::MEAN, [1, MOST_VARIED]);
    let covariance = object
        .field("covariance", "Covariance")
        .doc("Covariance matrix, row by row; symmetric, without negative eigenvalues.")
        .matrix(Bound::COVARIANCE, "covariance");
    let covariance = covariance?;
    let count = covariance.len();
    for (row, column) in (0..count).flat_map(|row| (0..row).map(move |column| (row, column))) {
        let [here, there] = [covariance[row][column], covariance[column][row]];
        if (here - there).abs() > ROUNDING * (here.abs() + there.abs()) {
            let detail = format!(
                "must equal the element in row {column} and column {row}, {there}: a covariance is symmetric; got \
                 {here}"
            );
            object.fault_of(&format!("covariance/{row}/{column}"), detail);
            return None;
        }
    }
    let least = least_eigenvalue(&covariance);
    if least.is_nan() || least < -ROUNDING {
        let detail =
            format!("must have no negative eigenvalue: the least eigenvalue of its correlation matrix is {least:.3e}");
        object.fault_of("covariance", detail);
        return None;
    }
    if let Some(mean) = mean.as_ref().filter(|mean| mean.len() != count) {
        object.fault_of(
            "mean",
            format!("must have as many numbers as the covariance has rows, {count}, got {}", mean.len()),
        );
        return None;
    }
    Some(Normal { mean, covariance })
}

/// An eigenvalue of correlations that is as little below zero is so by rounding, and so are elements that differ as little.
const ROUNDING: f64 = 1e-12;

impl Dispersion {
    /// The pointers of its numbers.
    pub(super) fn pointers(&self) -> impl Iterator<Item = &str> {
        self.pointers.iter().map(String::as_str)
    }

    /// What is wrong with the pointers of dispersions.
    pub(super) fn faults(dispersions: &[Self], numbers: &Numbers) -> Vec<Fault> {
        let places = dispersions.iter().enumerate().flat_map(|(index, dispersion)| dispersion.places(index));
        numbers.faults(places).1
    }

    /// The pointers of the dispersion at `index` of a request, each with where it stands there.
    fn places(&self, index: usize) -> impl Iterator<Item = (String, &String)> {
        self.pointers.iter().enumerate().map(move |(place, pointer)| match self.pointers.len() {
            1 => (format!("/dispersions/{index}/pointer"), pointer),
            _ => (format!("/dispersions/{index}/pointer/{place}"), pointer),
        })
    }

    /// The variables of dispersions, in their order, each as a variation with what is known where it is moved; not all of them once
    /// `interrupt` is raised.
    ///
    /// # Errors
    /// With the number that cannot be moved.
    pub fn variations(
        dispersions: &[Self],
        numbers: &Numbers,
        interrupt: &dyn Interrupt,
    ) -> Result<Vec<Varied>, Fault> {
        let mut variations = Vec::new();
        for (index, dispersion) in dispersions.iter().enumerate() {
            for (at, pointer) in dispersion.places(index) {
                if interrupt.is_raised() {
                    break;
                }
                let fields = numbers.at(pointer).unwrap_or_default();
                let immovable = || Fault::new(at, immovable(pointer));
                variations.push(numbers.variation(&fields, dispersion.change).ok_or_else(immovable)?);
            }
        }
        Ok(variations)
    }

    /// The outputs of which the slopes are needed: those of the site of the end, and the final columns.
    pub fn outputs(known: AvailableQuantities, flight: &Trajectory) -> Vec<FlightOutput> {
        let site = FlightOutput::Site { site: ground_point(&flight.last()), is_listed: false };
        let end = |column| FlightOutput::Quantity { column, at: At::Moment(Moment::End) };
        std::iter::once(site).chain(Self::columns(known).map(end)).collect()
    }

    /// The columns that are given: the numbers that the case has unasked.
    fn columns(known: AvailableQuantities) -> impl Iterator<Item = &'static Column> {
        Column::all(known).filter(|column| column.is_number())
    }
}

/// Scatter of the end of the flight caused by `dispersions`, to first order.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Covariance {
    /// Scatter of the end point on the ground.
    pub landing: Landing,
    /// Standard deviations of the columns of the final state, in their units; null where a derivative is undefined, and
    /// for an angle that wraps where it exceeds that of a uniform distribution, 104°.
    #[schema(value_type = std::collections::BTreeMap<String, Option<f64>>)]
    pub standard_deviations: Map<String, Value>,
    /// Contributions of the dispersions, in the order of the request.
    pub dispersions: Vec<Contribution>,
}

/// Scatter of the end point on the ground, relative to the end point without dispersions.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Landing {
    /// Semi-major axis of the 1σ ellipse, m. The ellipse contains 39 % of the flights; 2.45 times its axes contain 95
    /// %, 3.44 times 99.73 %. Null where a derivative is undefined.
    #[schema(required = true)]
    pub semi_major_axis: Option<f64>,
    /// Semi-minor axis of the 1σ ellipse, m; null where a derivative is undefined.
    #[schema(required = true)]
    pub semi_minor_axis: Option<f64>,
    /// Direction of the major axis, clockwise from north, in [0, π); null where a derivative is undefined.
    #[schema(required = true)]
    pub azimuth: Option<f64>,
    /// Covariance matrix of the east and north coordinates of the end point, row by row, m².
    pub covariance: Vec<Vec<Option<f64>>>,
    /// Shift of the end point caused by the means of the dispersions, east and north, m.
    pub shift: Vec<Option<f64>>,
}

/// Contribution of one dispersion.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Contribution {
    /// JSON pointers of its numbers.
    pub pointers: Vec<String>,
    /// Fraction of the variance of the end point, east and north together, from 0 to 1; null where undefined.
    #[schema(required = true)]
    pub share: Option<f64>,
    /// Fraction of the variance of each column of the final state that scatters, from 0 to 1.
    #[schema(value_type = std::collections::BTreeMap<String, f64>)]
    pub shares: Map<String, Value>,
}

impl Covariance {
    /// The covariance, from the slopes of the outputs that [`Dispersion::outputs`] names by the variables.
    pub fn new(dispersions: &[Dispersion], unit: AngleUnit, known: AvailableQuantities, slopes: &[Slopes]) -> Self {
        let rows: Vec<Vec<f64>> = slopes.iter().map(|row| row.slopes.clone()).collect();
        let mut first = 0;
        let mut groups = Vec::new();
        let mut shift = [0.0; 2];
        for Dispersion { pointers, change, distribution } in dispersions {
            let variables: Vec<usize> = (first..first + pointers.len()).collect();
            first += pointers.len();
            let neutral = if *change == Change::Factor { 1.0 } else { 0.0 };
            for (variable, mean) in variables.iter().zip(distribution.mean.iter().flatten()) {
                let moved = mean - neutral;
                shift.iter_mut().zip(&rows).for_each(|(shift, row)| *shift += moved * row[*variable]);
            }
            groups.push(Group { variables, covariance: distribution.covariance.clone() });
        }
        let parts: Vec<_> = groups.iter().map(|group| group.contribution(&rows)).collect();
        let variance = |row: usize, column: usize| parts.iter().map(|part| part[row][column]).sum::<f64>();
        let landing = [0, 1].map(|row| [0, 1].map(|column| variance(row, column)));
        let is_defined = landing.as_flattened().iter().all(|number| number.is_finite());
        let ellipse = is_defined.then(|| CoreEllipse::of(landing));
        let trace = landing[0][0] + landing[1][1];
        let share = |part: f64, whole: f64| finite(part / whole);
        let columns: Vec<_> = Dispersion::columns(known).zip(2..).collect();
        let contribution = |(dispersion, part): (&Dispersion, &Vec<Vec<f64>>)| Contribution {
            pointers: dispersion.pointers.clone(),
            share: share(part[0][0] + part[1][1], trace),
            shares: columns
                .iter()
                .filter(|(column, row)| variance(*row, *row).sqrt() > rounding(column.name, slopes[*row].value))
                .filter_map(|(column, row)| {
                    Some((column.name.to_owned(), json!(share(part[*row][*row], variance(*row, *row))?)))
                })
                .collect(),
        };
        // Beyond that of a direction of which nothing is known, an angle that goes around has none to first order.
        let greatest =
            |column: &Column| if column.turns() { unit.from_radians(TAU) / 12_f64.sqrt() } else { f64::INFINITY };
        let deviation = |column: &Column, row: usize| {
            finite(variance(row, row).sqrt()).filter(|deviation| *deviation <= greatest(column))
        };
        Self {
            landing: Landing {
                semi_major_axis: ellipse.map(|ellipse| ellipse.semi_major_axis),
                semi_minor_axis: ellipse.map(|ellipse| ellipse.semi_minor_axis),
                azimuth: ellipse.map(|ellipse| unit.from_radians(ellipse.azimuth)),
                covariance: landing.iter().map(|row| row.iter().map(|number| finite(*number)).collect()).collect(),
                shift: shift.iter().map(|number| finite(*number)).collect(),
            },
            standard_deviations: columns
                .iter()
                .map(|(column, row)| (column.name.to_owned(), json!(deviation(column, *row))))
                .collect(),
            dispersions: dispersions.iter().zip(&parts).map(contribution).collect(),
        }
    }
}

/// A standard deviation of a column that is no more than rounding: of a condition that ends the flight, as its altitude.
fn rounding(column: &str, value: Option<f64>) -> f64 {
    // An altitude is a difference of radii.
    let least = if column.ends_with("altitude") { 1e3 } else { 0.0 };
    1e-8 * value.unwrap_or_default().abs().max(least)
}
