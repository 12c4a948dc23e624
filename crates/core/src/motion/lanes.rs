//! The forces on several vehicles side by side.

use super::{Burn, Forces, LookupCache, Parameters};
use crate::parachute::{Canopies, Filling};
use crate::scalar::Lanes;

impl Forces {
    /// Whether these forces and others differ in numbers alone that lanes hold: their models, their mode, and what burns and is open.
    pub(crate) fn are_alike(&self, other: &Self) -> bool {
        let burns = match (&self.burn, &other.burn) {
            (None, None) => true,
            (Some(one), Some(other)) => {
                one.direction == other.direction
                    && one.exit_area_over_mass.is_some() == other.exit_area_over_mass.is_some()
                    && one.load_limit.is_some() == other.load_limit.is_some()
            }
            _ => false,
        };
        let canopies = |forces: &Self| forces.canopies.as_ref().map(|canopies| canopies.filling.len());
        self.mode == other.mode
            && self.held == other.held
            && burns
            && canopies(self) == canopies(other)
            && self.models == other.models
    }

    /// The same forces in all lanes.
    pub(crate) fn in_lanes<const L: usize>(&self) -> Forces<Lanes<L>> {
        let Self {
            models,
            parameters,
            burn,
            canopies,
            held,
            mode,
            switches,
            of_thesis,
            by_mach,
            by_axis,
            by_energy,
            ..
        } = self;
        let burn = burn.map(|burn| Burn {
            direction: burn.direction,
            since: burn.since.into(),
            acceleration: burn.acceleration.into(),
            acceleration_rate: burn.acceleration_rate.into(),
            mass_flow: burn.mass_flow.into(),
            mass_flow_rate: burn.mass_flow_rate.into(),
            exit_area_over_mass: burn.exit_area_over_mass.map(Lanes::from),
            load_limit: burn.load_limit.map(Lanes::from),
        });
        let filling = |filling: &Filling<f64>| Filling {
            full: filling.full.into(),
            since: filling.since.into(),
            over_inflation_time: filling.over_inflation_time.into(),
        };
        Forces {
            models: models.clone(),
            parameters: Parameters {
                mass: parameters.mass.into(),
                reference_area: parameters.reference_area.into(),
                lift_coefficient: parameters.lift_coefficient.into(),
                drag_coefficient: parameters.drag_coefficient.into(),
                density: parameters.density.into(),
                bank_angle: parameters.bank_angle.into(),
            },
            area_over_mass: self.area_over_mass.into(),
            mass: self.mass.into(),
            sin_cos_bank: (self.sin_cos_bank.0.into(), self.sin_cos_bank.1.into()),
            burn,
            canopies: canopies.as_ref().map(|canopies| Canopies {
                full: canopies.full.into(),
                filling: canopies.filling.iter().map(filling).collect(),
            }),
            held: *held,
            lags: self.lags.map(Lanes::from),
            mode: *mode,
            switches: *switches,
            of_thesis: *of_thesis,
            by_mach: *by_mach,
            by_axis: *by_axis,
            by_energy: *by_energy,
            cache: LookupCache::default(),
        }
    }
}

impl<const L: usize> Forces<Lanes<L>> {
    /// Puts the numbers of forces that [are alike](Forces::are_alike) into a lane.
    pub(crate) fn put(&mut self, lane: usize, one: &Forces) {
        let put = |lanes: &mut Lanes<L>, number: f64| lanes.0[lane] = number;
        let Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle } =
            &mut self.parameters;
        put(mass, one.parameters.mass);
        put(reference_area, one.parameters.reference_area);
        put(lift_coefficient, one.parameters.lift_coefficient);
        put(drag_coefficient, one.parameters.drag_coefficient);
        put(density, one.parameters.density);
        put(bank_angle, one.parameters.bank_angle);
        put(&mut self.area_over_mass, one.area_over_mass);
        put(&mut self.mass, one.mass);
        put(&mut self.sin_cos_bank.0, one.sin_cos_bank.0);
        put(&mut self.sin_cos_bank.1, one.sin_cos_bank.1);
        for (lanes, lag) in self.lags.iter_mut().zip(one.lags) {
            put(lanes, lag);
        }
        if let (Some(lanes), Some(one)) = (&mut self.burn, &one.burn) {
            put(&mut lanes.since, one.since);
            put(&mut lanes.acceleration, one.acceleration);
            put(&mut lanes.acceleration_rate, one.acceleration_rate);
            put(&mut lanes.mass_flow, one.mass_flow);
            put(&mut lanes.mass_flow_rate, one.mass_flow_rate);
            for (lanes, one) in
                [(&mut lanes.exit_area_over_mass, one.exit_area_over_mass), (&mut lanes.load_limit, one.load_limit)]
            {
                if let (Some(lanes), Some(one)) = (lanes, one) {
                    put(lanes, one);
                }
            }
        }
        if let (Some(lanes), Some(one)) = (&mut self.canopies, &one.canopies) {
            put(&mut lanes.full, one.full);
            for (lanes, one) in lanes.filling.iter_mut().zip(&one.filling) {
                put(&mut lanes.full, one.full);
                put(&mut lanes.since, one.since);
                put(&mut lanes.over_inflation_time, one.over_inflation_time);
            }
        }
    }
}
