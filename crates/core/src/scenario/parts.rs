//! What is wrong with the parts of a case, with what events do to them, and with the bodies that they become.

use std::borrow::Cow;

use super::bounds::out_of_bounds;
use super::{Bound, Case, Equations, Fault};
use crate::event::Event;
use crate::part::{Engine, ThrustProfile};

impl Case {
    /// What is wrong with the parts, and with what events do to them.
    pub(super) fn part_faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (index, part) in self.parts.iter().enumerate() {
            let place = format!("vehicle.parts.{index}");
            if part.engine.is_none() && part.propellant > 0.0 {
                faults.push(Fault::PropellantWithoutEngine { field: format!("{place}.propellant") });
            }
            if part.mass() <= 0.0 {
                faults.push(Fault::PartWithoutMass { field: format!("{place}.dry_mass") });
            }
            let Some(Engine { thrust, exit_area, .. }) = &part.engine else { continue };
            if *exit_area > 0.0 && !self.atmosphere.has_pressure() {
                faults.push(Fault::NoPressure { field: format!("{place}.engine.exit_area") });
            }
            if let ThrustProfile::Table(entries) = thrust {
                let ascends = entries.windows(2).all(|pair| pair[0].time < pair[1].time);
                let starts_at_0 = entries.first().is_some_and(|first| first.time == 0.0);
                if entries.len() < 2 || !ascends || !starts_at_0 {
                    faults.push(Fault::ThrustTimes { field: format!("{place}.engine.thrust.time") });
                }
            }
        }
        if !self.parts.is_empty() && self.solver.equations == Equations::Spherical {
            faults.push(Fault::SphericalParts);
        }
        faults.extend(self.faults_of_effects_on_parts());
        faults
    }

    /// What is wrong with what events do to the parts.
    fn faults_of_effects_on_parts(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let [mut separated, mut lit] = [vec![None; self.parts.len()], vec![None; self.parts.len()]];
        let is_shut_down = |part: usize| self.events.iter().any(|event| event.then.shut_down.contains(&part));
        for (index, Event { then, .. }) in self.events.iter().enumerate() {
            let place = format!("events.{index}.then");
            if !self.parts.is_empty() {
                let said = [("mass", then.mass.is_some()), ("thrust", then.thrust.is_some())];
                let said = said.into_iter().filter(|(_, is_said)| *is_said);
                faults.extend(said.map(|(name, _)| Fault::SaidByParts { field: format!("{place}.{name}") }));
            }
            let throttled = then.throttle.iter().map(|throttle| throttle.part).enumerate();
            let throttled = throttled.map(|(at, part)| (format!("{place}.throttle.{at}"), part));
            let shut_down = then.shut_down.iter().copied().enumerate();
            let shut_down = shut_down.map(|(at, part)| (format!("{place}.shut_down.{at}"), part));
            let ignited = then.ignite.iter().copied().enumerate();
            let ignited = ignited.map(|(at, part)| (format!("{place}.ignite.{at}"), part));
            let has_engine = |part: usize| self.parts.get(part).is_some_and(|part| part.engine.is_some());
            let unknown = throttled.chain(shut_down).chain(ignited.clone()).filter(|(_, part)| !has_engine(*part));
            faults.extend(unknown.map(|(field, _)| Fault::NoSuchEngine { field }));
            for (field, part) in ignited.filter(|(_, part)| has_engine(*part)) {
                match lit[part].replace(index) {
                    Some(event) if !is_shut_down(part) => faults.push(Fault::LitTwice { field, event }),
                    _ => {}
                }
            }
            for (at, separation) in then.separate.iter().enumerate() {
                for (of_body, part) in separation.parts.iter().enumerate() {
                    let field = format!("{place}.separate.{at}.parts.{of_body}");
                    match separated.get_mut(*part).map(|separated| separated.replace(index)) {
                        None => faults.push(Fault::NoSuchPart { field }),
                        Some(Some(event)) => faults.push(Fault::SeparatedTwice { field, event }),
                        Some(None) if separated.iter().all(Option::is_some) => {
                            faults.push(Fault::NothingRemains { field: format!("{place}.separate.{at}.parts") });
                        }
                        Some(None) => {}
                    }
                }
                let Some(body) = self.bodies.get(separation.body) else {
                    let field = format!("{place}.separate.{at}.body").into();
                    faults.push(count_fault(field, separation.body, [0, self.bodies.len().saturating_sub(1)]));
                    continue;
                };
                let count = body.case.parts.len();
                if count != separation.parts.len() {
                    let field = format!("{place}.separate.{at}.parts").into();
                    faults.push(count_fault(field, separation.parts.len(), [count; 2]));
                }
                let of_body = |fault| Fault::OfBody { field: format!("{place}.separate.{at}"), fault: Box::new(fault) };
                faults.extend(body.case.faults_of_body().into_iter().map(of_body));
            }
        }
        faults
    }

    /// What is wrong with the case of a body, whose state is not known yet.
    fn faults_of_body(&self) -> Vec<Fault> {
        let mut faults = out_of_bounds(self);
        faults.extend(self.mach_faults());
        faults.extend(self.condition_faults());
        faults.extend(self.effect_faults());
        faults.extend(self.part_faults());
        faults
    }

    /// How many bodies it may set free, those of bodies included.
    pub fn count_of_bodies(&self) -> usize {
        self.bodies.iter().map(|body| 1 + body.case.count_of_bodies()).sum()
    }
}

/// A count or a place in a list that is not one of those that it may be.
#[expect(clippy::cast_precision_loss, reason = "lists are short")]
fn count_fault(field: Cow<'static, str>, got: usize, [least, most]: [usize; 2]) -> Fault {
    let bound = Bound { minimum: least as f64, exclusive: false, maximum: most as f64 };
    Fault::OutOfBounds { field, value: got as f64, bound }
}
