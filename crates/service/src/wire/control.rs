//! How the vehicle of a request is flown.

use reentry::control::Control;

use super::commands::{CommandRequest, command};
use super::description::Object;
use super::names::EventNames;
use super::reader::Fault;
use super::steering::{Steering, steering};

/// How a vehicle is flown.
#[derive(Clone, Debug)]
pub struct ControlRequest {
    /// Bank angle.
    pub bank_angle: CommandRequest,
    /// Angle of attack.
    pub angle_of_attack: CommandRequest,
    /// Where the axis of a vehicle with parts points; none where nothing is said.
    pub steering: Option<Steering>,
}

impl ControlRequest {
    /// The core's control, but for the steering.
    pub(super) fn to_core(&self, events: &EventNames) -> Control {
        let Self { bank_angle, angle_of_attack, .. } = self;
        Control { bank_angle: bank_angle.to_core(events), angle_of_attack: angle_of_attack.to_core(events) }
    }

    /// Whether the axis of the vehicle has a direction that stays in the inertial frame.
    pub(super) fn is_inertial(&self) -> bool {
        self.steering.as_ref().is_some_and(Steering::is_inertial)
    }

    /// Names of events that are not those of one event alone.
    pub(super) fn name_faults(&self, events: &EventNames) -> Vec<Fault> {
        let Self { bank_angle, angle_of_attack, steering } = self;
        let of_steering = steering.iter().flat_map(|it| it.name_faults("/control/steering", events));
        let named = [("bank_angle", bank_angle), ("angle_of_attack", angle_of_attack)];
        let faults = named.map(|(field, command)| command.name_fault(&format!("/control/{field}"), events));
        faults.into_iter().flatten().chain(of_steering).collect()
    }
}

/// How the vehicle is flown.
pub(super) fn control(object: &mut Object) -> Option<ControlRequest> {
    object.named(
        "Control",
        "Bank angle, angle of attack and steering during the flight; each angle is a constant or a schedule.",
    );
    let bank_angle = command(object.field("bank_angle", "Bank angle").doc(
        "Bank angle. At 0, lift points upward in the plane of radius and velocity; a positive angle tilts it to the \
         left of the flight direction.",
    ));
    let angle_of_attack = command(
        object
            .field("angle_of_attack", "Angle of attack")
            .doc("Angle of attack. Only the coefficients of an `alpha_mach_table` depend on it."),
    );
    let steering = object
        .field("steering", "Steering")
        .doc(
            "Direction of the vehicle's axis, along which its engines push. It requires `vehicle.parts`. Default: \
             `velocity`.",
        )
        .optional()
        .object(steering);
    Some(ControlRequest { bank_angle: bank_angle?, angle_of_attack: angle_of_attack?, steering })
}
