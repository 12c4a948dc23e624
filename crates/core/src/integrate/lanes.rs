//! Trial steps of several integrators at once, in the vector registers of the processor.

use std::sync::atomic::{AtomicBool, Ordering};

use super::{IntegrationError, Integrator, Step, StepBounds, System, step};
use crate::scalar::Lanes;

/// A trial step of each of `L` integrators, computed at once by a system in lanes: to the last digit what each would try alone.
///
/// In turn, every integrator is [loaded](Self::load), all steps are [tried](Self::attempt), and every integrator [judges](Self::judge) its own.
/// Lanes without an integrator repeat what was in them.
#[derive(Debug)]
pub struct LaneSteps<const N: usize, const L: usize> {
    instructions: isa::InstructionSet,
    time: Lanes<L>,
    length: Lanes<L>,
    end_time: Lanes<L>,
    state: [Lanes<L>; N],
    derivative: [Lanes<L>; N],
    trial: step::Trial<Lanes<L>, N>,
    end_derivative: [Lanes<L>; N],
}

impl<const N: usize, const L: usize> LaneSteps<N, L> {
    /// Lanes without integrators; none where the processor has no vectors of four numbers, and flights are faster one by one, and where lanes are
    /// [turned off](use_lanes).
    pub fn new() -> Option<Self> {
        let none = Lanes([0.0; L]);
        Some(Self {
            instructions: widest()?,
            time: none,
            length: none,
            end_time: none,
            state: [none; N],
            derivative: [none; N],
            trial: step::Trial::none(),
            end_derivative: [none; N],
        })
    }

    /// Loads the next explicit step of an integrator with its own system into a lane; it ends at `end` at the latest.
    ///
    /// # Errors
    /// Those of [`Integrator::advance`].
    pub fn load<F: StepBounds<N>>(
        &mut self,
        lane: usize,
        integrator: &mut Integrator<'_, N>,
        system: &F,
        end: f64,
    ) -> Result<(), IntegrationError> {
        self.end_time.0[lane] = integrator.prepare(system, end)?;
        self.time.0[lane] = integrator.control.time;
        self.length.0[lane] = integrator.control.length;
        for i in 0..N {
            self.state[i].0[lane] = integrator.state[i];
            self.derivative[i].0[lane] = integrator.derivative[i];
        }
        Ok(())
    }

    /// Tries the steps of all lanes.
    pub fn attempt<M: System<Lanes<L>, N>>(&mut self, system: &M) {
        self.instructions.attempt(self, system);
    }

    /// Lets the integrator of a lane take its step, if that is exact enough; otherwise its next one will be shorter.
    pub fn judge<F: StepBounds<N>>(
        &self,
        lane: usize,
        integrator: &mut Integrator<'_, N>,
        system: &F,
    ) -> Option<Step<N>> {
        let rest = |_: &[f64; N]| (step::of_lane(&self.end_derivative, lane), self.trial.kept_slopes_of(lane));
        integrator.judge(system, &self.trial.outcome_of(lane), self.end_time.0[lane], rest)
    }

    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "there are no lanes"))]
    #[inline(always)]
    fn attempt_here<M: System<Lanes<L>, N>>(&mut self, system: &M) {
        let times = [self.time, self.end_time];
        (self.trial, self.end_derivative) =
            step::attempt_in_lanes(system, times, &self.state, &self.derivative, self.length);
    }
}

/// Whether there are to be no lanes.
static ARE_OFF: AtomicBool = AtomicBool::new(false);

/// Turns lanes on or off for the whole program. Without them flights are flown one by one, to the same digits.
pub fn use_lanes(are_on: bool) {
    ARE_OFF.store(!are_on, Ordering::Relaxed);
}

/// The instructions by which lanes are computed; none where there are no [`LaneSteps`].
pub fn lane_instructions() -> Option<&'static str> {
    widest().map(isa::InstructionSet::name)
}

fn widest() -> Option<isa::InstructionSet> {
    if ARE_OFF.load(Ordering::Relaxed) { None } else { isa::widest() }
}

/// The instruction sets among which the processor decides when the program runs.
#[cfg(target_arch = "x86_64")]
mod isa {
    use std::sync::LazyLock;

    use super::{LaneSteps, Lanes, System};

    #[derive(Clone, Copy, Debug)]
    pub(super) enum InstructionSet {
        Avx512,
        Avx2,
    }

    static WIDEST: LazyLock<Option<InstructionSet>> = LazyLock::new(|| {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512bw")
        {
            Some(InstructionSet::Avx512)
        } else if is_x86_feature_detected!("avx2") {
            Some(InstructionSet::Avx2)
        } else {
            None
        }
    });

    /// The widest that the processor has. There is no other way to come by one.
    pub(super) fn widest() -> Option<InstructionSet> {
        *WIDEST
    }

    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
    fn by_avx512<M: System<Lanes<L>, N>, const N: usize, const L: usize>(steps: &mut LaneSteps<N, L>, system: &M) {
        steps.attempt_here(system);
    }

    #[target_feature(enable = "avx2")]
    fn by_avx2<M: System<Lanes<L>, N>, const N: usize, const L: usize>(steps: &mut LaneSteps<N, L>, system: &M) {
        steps.attempt_here(system);
    }

    impl InstructionSet {
        pub(super) fn name(self) -> &'static str {
            match self {
                Self::Avx512 => "avx512",
                Self::Avx2 => "avx2",
            }
        }

        pub(super) fn attempt<M: System<Lanes<L>, N>, const N: usize, const L: usize>(
            self,
            steps: &mut LaneSteps<N, L>,
            system: &M,
        ) {
            // The one place where the program is not safe by its types alone: functions of wider instructions may be called where the processor
            // has them, which is asked above and nowhere else.
            #[expect(unsafe_code, reason = "the compiler does not know on which processor the program will run")]
            match self {
                // SAFETY: the processor has these instructions.
                Self::Avx512 => unsafe { by_avx512(steps, system) },
                // SAFETY: the processor has these instructions.
                Self::Avx2 => unsafe { by_avx2(steps, system) },
            }
        }
    }
}

/// Other processors have vectors of two numbers at least, in which lanes gain little.
#[cfg(not(target_arch = "x86_64"))]
mod isa {
    use super::{LaneSteps, Lanes, System};

    #[derive(Clone, Copy, Debug)]
    pub(super) enum InstructionSet {}

    pub(super) fn widest() -> Option<InstructionSet> {
        None
    }

    impl InstructionSet {
        pub(super) fn name(self) -> &'static str {
            match self {}
        }

        pub(super) fn attempt<M: System<Lanes<L>, N>, const N: usize, const L: usize>(
            self,
            _: &mut LaneSteps<N, L>,
            _: &M,
        ) {
            match self {}
        }
    }
}
