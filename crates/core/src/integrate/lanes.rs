//! Trial steps of several integrators at once, in the vector registers of the processor.

use std::sync::atomic::{AtomicU8, Ordering};

use super::step::Inside;
use super::step_control::{Tolerances, TrialError};
use super::{IntegrationError, Integrator, Step, StepBounds, System, step};
use crate::scalar::{DualLanes, Lanes};

/// What a system in lanes says about the length of its steps.
pub trait LaneBounds<const N: usize, const L: usize>: System<Lanes<L>, N> {
    /// The [longest step](StepBounds::longest_step) that may start in the state of each lane, to the last digit; none where each system has to be
    /// asked itself.
    fn longest_step(&self, time: Lanes<L>, state: &[Lanes<L>; N]) -> Option<Lanes<L>>;
}

/// A trial step of each of `L` integrators, computed at once by a system in lanes: to the last digit what each would try alone.
///
/// In turn, every integrator is [loaded](Self::load), all steps are [tried](Self::attempt), and every integrator [judges](Self::judge) its own,
/// of which the [step](Self::step) is there until the next ones are tried. Lanes without an integrator repeat what was in them.
#[derive(Debug)]
pub struct LaneSteps<const N: usize, const L: usize> {
    instructions: isa::InstructionSet,
    time: Lanes<L>,
    length: Lanes<L>,
    end_time: Lanes<L>,
    state: [Lanes<L>; N],
    derivative: [Lanes<L>; N],
    tolerances: Tolerances<Lanes<L>, N>,
    trial: step::Trial<Lanes<L>, N>,
    error: TrialError<Lanes<L>>,
    end_derivative: [Lanes<L>; N],
    longest_step: Option<Lanes<L>>,
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
            tolerances: Tolerances::none(),
            trial: step::Trial::none(),
            error: TrialError::none(),
            end_derivative: [none; N],
            longest_step: None,
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
        self.tolerances.put(lane, &integrator.control);
        for i in 0..N {
            self.state[i].0[lane] = integrator.state[i];
            self.derivative[i].0[lane] = integrator.derivative[i];
        }
        Ok(())
    }

    /// Tries the steps of all lanes.
    pub fn attempt<M: LaneBounds<N, L>>(&mut self, system: &M) {
        self.instructions.run(Attempt { steps: self, system });
    }

    /// The times at which the steps end, s, and the states then, moving along their rates of change.
    pub fn ends(&self) -> (DualLanes<L>, [DualLanes<L>; N]) {
        let end = |i: usize| DualLanes::new(self.trial.outcome.end[i], self.end_derivative[i]);
        (DualLanes::new(self.end_time, Lanes::from(1.0)), std::array::from_fn(end))
    }

    /// Runs a job in lanes.
    pub fn run<J: LaneJob>(&self, job: J) -> J::Output {
        self.instructions.run(job)
    }

    /// Lets the integrator of a lane go to the end of its step, if that is exact enough; otherwise its next one will be shorter.
    pub fn judge<F: StepBounds<N>>(&self, lane: usize, integrator: &mut Integrator<'_, N>, system: &F) -> bool {
        let is_accepted = integrator.accepts(system, self.error.of_lane(lane));
        if is_accepted {
            let (time, state) = (self.end_time.0[lane], step::of_lane(&self.trial.outcome.end, lane));
            let in_lanes = self.longest_step.map(|longest_step| longest_step.0[lane]);
            let longest_step = in_lanes.unwrap_or_else(|| system.longest_step(time, &state));
            integrator.go_to(system, time, state, step::of_lane(&self.end_derivative, lane), longest_step);
        }
        is_accepted
    }

    /// The step of a lane.
    pub fn step(&self, lane: usize) -> Step<N> {
        Step {
            start_time: self.time.0[lane],
            end_time: self.end_time.0[lane],
            start: step::of_lane(&self.state, lane),
            end: step::of_lane(&self.trial.outcome.end, lane),
            start_derivative: step::of_lane(&self.derivative, lane),
            end_derivative: step::of_lane(&self.end_derivative, lane),
            inside: Inside::Explicit(self.trial.kept_slopes_of(lane)),
        }
    }

    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "there are no lanes"))]
    #[inline(always)]
    fn attempt_here<M: LaneBounds<N, L>>(&mut self, system: &M) {
        let Self { time, end_time, state, derivative, length, trial, .. } = self;
        self.end_derivative = step::attempt_in_lanes(system, [*time, *end_time], state, derivative, *length, trial);
        self.error = self.tolerances.error(self.length, &self.state, &self.trial.outcome);
        self.longest_step = system.longest_step(self.end_time, &self.trial.outcome.end);
    }
}

/// What is computed with the instructions for lanes, as far as it is in line: a closure or a function of its own is without them.
pub trait LaneJob {
    /// What is found.
    type Output;

    /// Computes it; always in line.
    fn run(self) -> Self::Output;
}

/// Trial steps of a system.
struct Attempt<'a, M, const N: usize, const L: usize> {
    steps: &'a mut LaneSteps<N, L>,
    system: &'a M,
}

impl<M: LaneBounds<N, L>, const N: usize, const L: usize> LaneJob for Attempt<'_, M, N, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.steps.attempt_here(self.system);
    }
}

/// By which instructions lanes may be computed. The digits are the same by all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum LaneInstructions {
    /// The widest that the processor has.
    Widest,
    /// None wider than AVX2.
    Avx2,
    /// None: flights are flown one by one.
    None,
}

/// The [`LaneInstructions`] of the program.
static ALLOWED: AtomicU8 = AtomicU8::new(LaneInstructions::Widest as u8);

/// Decides for the whole program by which instructions lanes are computed from now on.
pub fn use_lanes(allowed: LaneInstructions) {
    ALLOWED.store(allowed as u8, Ordering::Relaxed);
}

/// The instructions by which lanes are computed; none where there are no [`LaneSteps`].
pub fn lane_instructions() -> Option<&'static str> {
    widest().map(isa::InstructionSet::name)
}

fn widest() -> Option<isa::InstructionSet> {
    let allowed = ALLOWED.load(Ordering::Relaxed);
    if allowed == LaneInstructions::None as u8 {
        None
    } else if allowed == LaneInstructions::Avx2 as u8 {
        isa::avx2()
    } else {
        isa::widest()
    }
}

/// The instruction sets among which the processor decides when the program runs.
#[cfg(target_arch = "x86_64")]
mod isa {
    use std::sync::LazyLock;

    use super::LaneJob;

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
        } else {
            avx2()
        }
    });

    /// The widest that the processor has. Of this and the next one alone there are instruction sets.
    pub(super) fn widest() -> Option<InstructionSet> {
        *WIDEST
    }

    /// AVX2, if the processor has it.
    pub(super) fn avx2() -> Option<InstructionSet> {
        is_x86_feature_detected!("avx2").then_some(InstructionSet::Avx2)
    }

    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
    fn by_avx512<J: LaneJob>(job: J) -> J::Output {
        job.run()
    }

    #[target_feature(enable = "avx2")]
    fn by_avx2<J: LaneJob>(job: J) -> J::Output {
        job.run()
    }

    impl InstructionSet {
        pub(super) fn name(self) -> &'static str {
            match self {
                Self::Avx512 => "avx512",
                Self::Avx2 => "avx2",
            }
        }

        pub(super) fn run<J: LaneJob>(self, job: J) -> J::Output {
            // The one place where the program is not safe by its types alone: functions of wider instructions may be called where the processor
            // has them, which is asked above and nowhere else.
            #[expect(unsafe_code, reason = "the compiler does not know on which processor the program will run")]
            match self {
                // SAFETY: the processor has these instructions.
                Self::Avx512 => unsafe { by_avx512(job) },
                // SAFETY: the processor has these instructions.
                Self::Avx2 => unsafe { by_avx2(job) },
            }
        }
    }
}

/// Other processors have vectors of two numbers at least, in which lanes gain little.
#[cfg(not(target_arch = "x86_64"))]
mod isa {
    use super::LaneJob;

    #[derive(Clone, Copy, Debug)]
    pub(super) enum InstructionSet {}

    pub(super) fn widest() -> Option<InstructionSet> {
        None
    }

    pub(super) fn avx2() -> Option<InstructionSet> {
        None
    }

    impl InstructionSet {
        pub(super) fn name(self) -> &'static str {
            match self {}
        }

        pub(super) fn run<J: LaneJob>(self, _: J) -> J::Output {
            match self {}
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::{LaneBounds, LaneInstructions, LaneSteps, use_lanes};
    use crate::integrate::{Integrator, Limits, StepBounds, System};
    use crate::scalar::{Lanes, Scalar};

    static NEVER: AtomicBool = AtomicBool::new(false);

    /// A swing that time slows down.
    struct Swing;

    impl<S: Scalar> System<S, 2> for Swing {
        #[inline(always)]
        fn derivative(&self, time: S, [place, speed]: &[S; 2]) -> [S; 2] {
            [*speed, -*place * (-time).exp()]
        }
    }

    impl StepBounds<2> for Swing {
        fn magnitudes(&self) -> [f64; 2] {
            [1.0; 2]
        }
    }

    impl LaneBounds<2, 8> for Swing {
        fn longest_step(&self, _: Lanes<8>, _: &[Lanes<8>; 2]) -> Option<Lanes<8>> {
            None
        }
    }

    fn integrators() -> Vec<Integrator<'static, 2>> {
        let limits = Limits { relative_tolerance: 1e-9, steps: 100, interrupt: &NEVER };
        (0..8_u32).map(|lane| Integrator::new(&Swing, 0.0, [1.0, f64::from(lane)], limits)).collect()
    }

    /// Small enough for an interpreter that finds undefined behaviour, as where the processor did not have the instructions.
    #[test]
    fn lanes_take_the_steps_that_each_takes_alone() {
        let mut alone = integrators();
        for integrator in &mut alone {
            while integrator.time() < 2.0 {
                integrator.advance(&Swing, 2.0).unwrap_or_else(|error| panic!("{error}"));
            }
        }
        for instructions in [LaneInstructions::Widest, LaneInstructions::Avx2] {
            use_lanes(instructions);
            let Some(mut steps) = LaneSteps::<2, 8>::new() else { continue };
            let mut flying = integrators();
            while flying.iter().any(|integrator| integrator.time() < 2.0) {
                for (lane, integrator) in flying.iter_mut().enumerate().filter(|(_, one)| one.time() < 2.0) {
                    steps.load(lane, integrator, &Swing, 2.0).unwrap_or_else(|error| panic!("{error}"));
                }
                steps.attempt(&Swing);
                for (lane, integrator) in flying.iter_mut().enumerate().filter(|(_, one)| one.time() < 2.0) {
                    if steps.judge(lane, integrator, &Swing) {
                        assert_eq!(steps.step(lane).end.map(f64::to_bits), integrator.state().map(f64::to_bits));
                    }
                }
            }
            let ends = |integrators: &[Integrator<2>]| -> Vec<_> {
                integrators.iter().map(|one| (one.state().map(f64::to_bits), one.statistics())).collect()
            };
            assert_eq!(ends(&flying), ends(&alone));
        }
        use_lanes(LaneInstructions::Widest);
    }
}
