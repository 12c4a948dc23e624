//! The vehicle of a request.

use reentry::scenario::Bound;
use reentry::vehicle::{Aerodynamics, Vehicle};

use super::aerodynamics::aerodynamics;
use super::description::Object;
use super::parts::{MOST_PARTS, NamedPart, part};

/// The vehicle and its parts.
pub(super) fn vehicle(object: &mut Object) -> Option<(Vehicle, Vec<NamedPart>)> {
    object.named("Vehicle", "Vehicle: a point mass with lift and drag.");
    let mass = object
        .field("mass", "Mass")
        .doc("Mass of the vehicle, kg. Exactly one of `mass` and `parts` must be given.")
        .unit("kg")
        .optional()
        .number(Bound::POSITIVE);
    let parts = object
        .field("parts", "Parts")
        .doc("Parts of the vehicle, such as stages, boosters, fairing and payload. Their masses are that of the vehicle.")
        .optional()
        .objects([1, MOST_PARTS], part);
    object.exactly_one(&["mass", "parts"]);
    let reference_area = object.only_unless("aerodynamics/type", "ballistic", |object| {
        object
            .field("reference_area", "Reference area")
            .doc(
                "Reference area of the coefficients, m². Required, except with `ballistic` aerodynamics, which do not \
                 accept it.",
            )
            .unit("m²")
            .number(Bound::NON_NEGATIVE)
    });
    let aerodynamics =
        object.field("aerodynamics", "Aerodynamics").doc("Lift and drag coefficients.").object(aerodynamics);
    let nose_radius = object
        .field("nose_radius", "Nose radius")
        .doc("Nose radius at the stagnation point, m. Required with `heating`.")
        .unit("m")
        .optional()
        .number(Bound::POSITIVE);
    let aerodynamics = aerodynamics?;
    // Ratios refer to no area: any does.
    let any_area = matches!(aerodynamics, Aerodynamics::Ballistic { .. }).then_some(1.0);
    let of_parts = parts.as_ref().map(|parts| parts.iter().map(|part| part.core.mass()).sum::<f64>());
    if of_parts.is_some_and(|mass| !mass.is_finite()) {
        object.fault_of("parts", "must have a total mass that is a finite number");
        return None;
    }
    let mass = mass.or(of_parts)?;
    let vehicle = Vehicle { mass, reference_area: reference_area.or(any_area)?, aerodynamics, nose_radius };
    Some((vehicle, parts.unwrap_or_default()))
}
