//! The forces on several vehicles side by side.

use std::cell::OnceCell;

use num_dual::Dual64;

use super::{Burn, Forces, Loads, LookupCache, Parameters, State, Switch};
use crate::heating::HeatFlux;
use crate::parachute::{Canopies, Filling};
use crate::scalar::{DualLanes, Lanes, apart};

/// What is read at the end of a step, with its rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndReadings<S = Dual64> {
    /// m.
    pub(crate) altitude: S,
    /// The quantities of the switches, where there are any.
    pub(crate) switches: Option<[S; Switch::ALL.len()]>,
    /// Where somebody asks for them, with cos²γ of the velocity relative to the air.
    pub(crate) loads: Option<(Loads<S>, S)>,
}

impl<const L: usize> EndReadings<DualLanes<L>> {
    /// Those of one lane.
    pub(crate) fn of_lane(&self, lane: usize) -> EndReadings {
        let of_lane = |number: DualLanes<L>| number.of_lane(lane);
        let loads = self.loads.as_ref().map(|(loads, cos_squared_gamma)| {
            let loads = Loads {
                altitude: of_lane(loads.altitude),
                density: of_lane(loads.density),
                speed: of_lane(loads.speed),
                air_speed: of_lane(loads.air_speed),
                mach: loads.mach.map(of_lane),
                dynamic_pressure: of_lane(loads.dynamic_pressure),
                deceleration: of_lane(loads.deceleration),
                load_factor: of_lane(loads.load_factor),
                heat_flux: loads.heat_flux.map(|HeatFlux { convective, radiative }| HeatFlux {
                    convective: of_lane(convective),
                    radiative: of_lane(radiative),
                }),
            };
            (loads, of_lane(*cos_squared_gamma))
        });
        EndReadings {
            altitude: of_lane(self.altitude),
            switches: self.switches.map(|switches| switches.map(of_lane)),
            loads,
        }
    }
}

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
    /// What is read at the ends of steps, lane by lane to the digits that each has alone.
    #[inline(always)]
    pub(crate) fn end_readings(
        &self,
        time: DualLanes<L>,
        state: &State<DualLanes<L>>,
        with_loads: bool,
    ) -> EndReadings<DualLanes<L>> {
        if !with_loads && !self.has_switches() {
            let altitude = self.models.planet.shape.altitude(&state.position);
            return EndReadings { altitude, switches: None, loads: None };
        }
        // In line, with all models and for each instruction set, it would double the time to compile the core.
        apart(|| {
            let flow = self.flow_with_mach(time, state);
            let altitude = flow.arguments.altitude;
            let loads = with_loads.then(|| (self.loads_in(time, state, &flow), flow.cos_squared_gamma()));
            let switches = self.has_switches().then(|| self.readings_with(time, state, &OnceCell::from(flow)));
            EndReadings { altitude, switches, loads }
        })
    }

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
