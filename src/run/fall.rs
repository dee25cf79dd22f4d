//! The fall of a structure that overturns: it begins when |θ| passes the angle of no return for the last time. The peaks of
//! such a structure are those before the fall.

use super::course::{Finish, Run, RunError, Starts};
use super::peak_watch::PeakWatch;
use super::peaks::{Peak, Peaks};
use crate::engine::piece::Expansion;
use crate::engine::sample::Sample;
use crate::mechanics::arc::{Arc, stretch};
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::run::ground_motion::GroundMotion;
use crate::series::bisection::last_where;
use crate::series::first_crossing::{Crossing, Gap, first_time_closed_from};
use crate::series::taylor::sum_of_magnitudes;
use crate::{Base, Detail, Piece, Side, Structure, Transition, TransitionKind, Watch};
use std::f64::consts::FRAC_PI_2;

/// Result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult<Q: Coordinates = f64> {
    /// Peak of the ground acceleration until the run ended, m/s².
    pub ground: Peak,
    /// Peaks of the structure; if it overturns, those before it falls.
    pub peaks: Peaks,
    /// Start of the fall of a structure that overturns, s.
    pub fall: Option<f64>,
    /// Start of the run, s.
    pub start: f64,
    /// End of the run.
    pub finish: Finish<Q>,
}

/// Exact peaks of a motion that may end in a fall: those of all the motion, and those before the fall.
#[derive(Clone, Debug, PartialEq)]
pub struct FallPeaks<All = Peaks> {
    pub(super) all: All,
    /// Angle of no return, rad; none below π/2 if the tendon turns the structure back from everywhere.
    pub(super) no_return: Option<f64>,
    /// The last passing of the angle of no return, while |θ| is beyond: its instant (s), and the peaks until then.
    pub(super) fall: Option<(f64, Peaks)>,
    pub(super) has_overturned: bool,
    /// How often a watcher has seen the base come down.
    pub impacts: u64,
}

/// What changes of [`FallPeaks`] with the motion: all peaks, instant and peaks of a fall, and whether the structure has overturned.
pub type FallNumbers = (Vec<Peak>, Option<(f64, Vec<Peak>)>, bool);

/// Rotation beyond which nothing turns the structure on `base` back, rad: α_cg without ties. With ties the static moment of weight,
/// tendon and dissipators vanishes at this rotation, the dissipators moved there slowly from rest. None if the ties turn the
/// structure back up to π/2.
///
/// The moment vanishes once: while an elastic tie makes it grow it is positive, and it falls from there on.
pub fn angle_of_no_return(base: &Base) -> Option<f64> {
    if !base.is_restrained() {
        return Some(libm::atan(base.tan_alpha_cg));
    }
    let restores = |theta| {
        let dissipators = Dissipators::NEW.moved(base, Side::Right, theta);
        Restraint::about(base, Side::Right, &dissipators).restoring_moment(theta) > 0.0
    };
    (!restores(FRAC_PI_2)).then(|| last_where(0.0, FRAC_PI_2, restores))
}

impl FallPeaks {
    /// Peaks of `structure` at the level `detail` from `time` (s) on, before any motion.
    pub fn since(time: f64, structure: &Structure, detail: Detail) -> FallPeaks {
        let (all, no_return) = (Peaks::since(time, structure, detail), angle_of_no_return(structure.base()));
        FallPeaks { all, no_return, fall: None, has_overturned: false, impacts: 0 }
    }

    /// The numbers alone.
    pub fn numbers(&self) -> FallNumbers {
        let fall = self.fall.as_ref().map(|(instant, before)| (*instant, before.numbers()));
        (self.all.numbers(), fall, self.has_overturned)
    }

    /// The same with other [`FallPeaks::numbers`]; none if they are not of as many peaks.
    pub fn with_numbers(&self, (all, fall, has_overturned): FallNumbers) -> Option<FallPeaks> {
        let before = |(instant, before): (f64, Vec<_>)| Some((instant, self.all.with_numbers(&before)?));
        let fall = if let Some(fall) = fall { Some(before(fall)?) } else { None };
        Some(FallPeaks { all: self.all.with_numbers(&all)?, fall, has_overturned, ..*self })
    }

    /// Peaks of all the motion, including a fall.
    pub fn all(&self) -> &Peaks {
        &self.all
    }

    /// Peaks before the fall, if the structure has overturned, otherwise of all the motion.
    pub fn peaks(&self) -> &Peaks {
        self.passing().map_or(&self.all, |(_, before)| before)
    }

    /// Start of the fall, s, if the structure has overturned.
    pub fn fall(&self) -> Option<f64> {
        self.passing().map(|(instant, _)| *instant)
    }

    fn passing(&self) -> Option<&(f64, Peaks)> {
        self.fall.as_ref().filter(|_| self.has_overturned)
    }

    /// Adds the values of `sample`, which need not be in a piece.
    pub fn see_instant<Q: Coordinates>(&mut self, sample: &Sample<Q>) {
        self.all.see(&sample.shown(), sample.motion.time);
    }

    /// The watcher that looks for peaks in the pieces of a motion; [`FallWatch::end`] gives the peaks back.
    pub fn watch<Q: Coordinates>(self) -> FallWatch<Q> {
        let FallPeaks { all, no_return, fall, has_overturned, impacts } = self;
        FallPeaks { all: all.watch(), no_return, fall, has_overturned, impacts }
    }
}

/// Looks for the peaks of a motion that may end in a fall.
pub type FallWatch<Q = f64> = FallPeaks<PeakWatch<Q>>;

impl<Q: Coordinates> Watch<Q> for FallWatch<Q> {
    fn piece(&mut self, piece: &Piece<Q>) {
        match self.no_return {
            Some(angle) if piece.end.theta.abs() >= angle => self.beyond(piece, angle),
            _ => self.fall = None,
        }
        self.all.piece(piece);
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self.impacts += u64::from(transition.kind.is_impact());
        if let TransitionKind::Overturning(_) = transition.kind {
            self.has_overturned = true;
            let all = &mut self.all;
            self.fall.get_or_insert_with(|| (transition.time, all.so_far().clone()));
        }
        self.all.transition(transition);
    }
}

impl<Q: Coordinates> FallWatch<Q> {
    /// The peaks, once the motion has been watched.
    pub fn end(self) -> FallPeaks {
        let FallPeaks { all, no_return, fall, has_overturned, impacts } = self;
        FallPeaks { all: all.end(), no_return, fall, has_overturned, impacts }
    }

    /// Keeps the peaks up to the last passing of `angle` (rad) in a `piece` that ends beyond.
    #[cold]
    fn beyond(&mut self, piece: &Piece<Q>, angle: f64) {
        let Some((instant, tau)) = start_of_fall(piece, angle, self.fall.is_some()) else { return };
        let mut before = self.all.so_far().clone();
        let arc = piece.arc.map(|arc| Arc { reach: tau / arc.span, ..arc.clone() });
        let until = Piece { duration: tau, end: piece.state_at(tau), arc: arc.as_ref(), ..*piece };
        if tau > 0.0 {
            let mut watch = before.watch();
            watch.piece(&until);
            before = watch.end();
        } else {
            before.see(&piece.shown(0.0, &piece.before.state), instant);
        }
        self.fall = Some((instant, before));
    }
}

/// The last passing of `angle` (rad) in a `piece` that ends beyond: the instant, and seconds from the start of the piece. A motion that
/// starts beyond, and not `falls` already, falls from its start.
fn start_of_fall<Q: Coordinates>(piece: &Piece<Q>, angle: f64, falls: bool) -> Option<(f64, f64)> {
    // most pieces of a fall stay beyond
    if falls
        && let Some(arc) = piece.arc
        && sum_of_magnitudes(&arc.theta[1..=arc.order]) < arc.theta[0].abs() - angle
    {
        return None;
    }
    let mut passing = None;
    let mut arcs = piece.arcs();
    while let Some(expansion) = arcs.next() {
        passing = last_passing(angle, piece.end.theta.signum(), &expansion).or(passing);
    }
    passing.or((!falls).then_some((piece.before.time, 0.0)))
}

/// The last time at which |θ| passes `angle` (rad) on a polynomial that ends beyond on this `side`: the instant, and seconds from
/// the start of the piece. The search goes back from the end of the polynomial.
fn last_passing<Q: Coordinates>(angle: f64, side: f64, expansion: &Expansion<Q>) -> Option<(f64, f64)> {
    let arc = expansion.arc;
    let mut theta = arc.theta;
    let back = &mut theta[..=arc.order];
    stretch(back, arc.reach, -arc.reach);
    let beyond = Gap::new(back, side, -angle);
    let mut sigma = 0.0;
    loop {
        match first_time_closed_from(beyond, sigma, 1.0) {
            Crossing::None => return None,
            Crossing::NoneUntil(until) if until - sigma > f64::EPSILON => sigma = until,
            Crossing::At(last) | Crossing::NoneUntil(last) => {
                let passed = (1.0 - last) * arc.duration();
                return Some((expansion.time(0.0) + passed, expansion.from + passed));
            }
        }
    }
}

impl<Q: Coordinates> Run<'_, Q> {
    /// The watcher of the peaks of the run, before any motion.
    pub(super) fn watch_falling(&self) -> FallWatch<Q> {
        FallPeaks::since(self.ground.start(), &self.structure, self.detail).watch()
    }

    /// Result of the run with these `peaks`, the start of the `fall` and the `finish`.
    pub(super) fn found_of(&self, peaks: Peaks, fall: Option<f64>, finish: Finish<Q>) -> RunResult<Q> {
        let ground = self.peak_of_ground(finish.motion.time);
        RunResult { ground, peaks, fall, start: self.ground.start(), finish }
    }

    /// Peak of the ground acceleration until the time `until` (s), m/s².
    fn peak_of_ground(&self, until: f64) -> Peak {
        let (times, acceleration) = (self.ground.times(), self.ground.acceleration());
        let next = times.partition_point(|time| *time <= until);
        let cut = (next < times.len()).then(|| {
            let from = times[next - 1];
            (until, GroundMotion::from(self.ground).ramp(next).at(until - from).a_g)
        });
        let samples = &acceleration[..next.min(acceleration.len())];
        let (fours, rest) = samples.as_chunks::<4>();
        // four side by side: a comparison waits for the one before it
        let most =
            fours.iter().fold([0.0; 4], |most: [f64; 4], four| std::array::from_fn(|i| most[i].max(four[i].abs())));
        let magnitude = most.into_iter().chain(rest.iter().map(|a_g| a_g.abs())).fold(0.0, f64::max);
        let first = samples.iter().position(|a_g| a_g.abs() == magnitude && magnitude > 0.0);
        let time = first.map_or_else(|| self.ground.start(), |first| times[first]);
        match cut {
            Some((time, a_g)) if a_g.abs() > magnitude => Peak { magnitude: a_g.abs(), time },
            _ => Peak { magnitude, time },
        }
    }
}

/// Result of `run`, which `watch` sees, and the peaks of all its motion, including a fall.
pub(super) fn find<Q: Starts>(run: &Run<Q>, watch: &mut dyn Watch<Q>) -> Result<(RunResult<Q>, Peaks), RunError> {
    let (course, mut own) = (run.course()?, run.watch_falling());
    let (ending, engine) = match watch.sees_pieces() {
        true => course.finish(&mut (&mut own, watch))?,
        false => course.finish(&mut (&mut own, &mut |transition: &Transition<Q>| watch.transition(transition)))?,
    };
    let peaks = own.end();
    let finish = Finish { ending, motion: *engine.motion() };
    Ok((run.found_of(peaks.peaks().clone(), peaks.fall(), finish), peaks.all))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::course::{End, Ending};
    use crate::run::record::Record;
    use crate::{OneMass, Output, Parameters, State};
    use std::f64::consts::TAU;

    /// Against dense samples: below α_cg before it, beyond from then on, and no peak is of later.
    #[test]
    fn the_fall_begins_where_the_rotation_passes_alpha_cg_for_the_last_time() {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let alpha_cg = structure.base().tan_alpha_cg.atan();
        let times: Vec<_> = (0..=50).map(|i| f64::from(i) * 0.01).collect();
        let acceleration = times.iter().map(|time| 0.9 * 9.81 * (TAU * time / 0.5).sin()).collect();
        let ground = Record::from_samples("", times, acceleration).unwrap();
        for detail in [Detail::Auto, Detail::Linear, Detail::Rigid] {
            let run = Run { detail, ..Run::new(structure, &ground) };
            let shown = [Output::theta, Output::u(0), Output::delta_t(0), Output::a_t(0)];
            let mut seen = Vec::new();
            let dense = (0..40_000).map(|i| f64::from(i) * 1e-4);
            let mut watch = FallPeaks::since(0.0, &structure.into(), Detail::Auto).watch();
            run.sample(dense, |at| seen.push((at.motion.time, shown.map(at.outputs()))), &mut watch).unwrap();
            let watched = watch.end();
            let instant = watched.fall().unwrap();
            let last = seen.iter().rposition(|(_, outputs)| outputs[0].abs() < alpha_cg).unwrap();
            assert!(seen[last].0 <= instant && instant <= seen[last + 1].0, "{detail:?}: {instant}");

            let peaks = watched.peaks();
            assert!((peaks.theta().magnitude - alpha_cg).abs() < 1e-9);
            for (i, of) in (1..).zip(&shown[1..]) {
                let peak = peaks.of(*of).unwrap();
                let most = seen[..=last].iter().fold(0.0_f64, |most, (_, at)| most.max(at[i].abs()));
                assert!(most <= peak.magnitude * (1.0 + 1e-9) && peak.time <= instant, "{detail:?}: {most} {peak:?}");
                assert!(most >= peak.magnitude * 0.99, "{detail:?}: {most} {peak:?}");
            }
            assert!(watched.all().theta().magnitude > 1.57);

            // a run that ends at the start of the fall
            let until = Run { end: End::At(instant), ..run.clone() }.peaks().unwrap().0;
            for output in Output::PEAKS_OF_ONE {
                let [expected, one_pass] = [&until, peaks].map(|peaks| peaks.of(output).unwrap().magnitude);
                assert!((one_pass - expected).abs() <= 1e-12 * expected, "{detail:?} {}", output.symbol());
            }
        }
    }

    /// Released at rest about α_cg, near which the structure turns back, or falls after it has been back: against
    /// samples of its way.
    #[test]
    fn a_fall_after_a_return_is_found_exactly() {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let alpha_cg = structure.base().tan_alpha_cg.atan();
        let (ground, mut returned) = (Record::at_rest(60.0), 0);
        for detail in [Detail::Auto, Detail::Linear, Detail::Modal, Detail::Rigid] {
            for beyond in (0..40).map(|i| 1e-4 * f64::from(i)) {
                let initial = State { theta: -alpha_cg * (1.0 + beyond), ..State::default() };
                let run = Run { detail, initial, ..Run::new(structure, &ground) };
                let (mut watch, mut seen) =
                    (FallPeaks::since(0.0, &structure.into(), Detail::Auto).watch(), Vec::new());
                let times = (0..100_000).map(|i| f64::from(i) * 2e-4);
                let show = |at: &Sample| seen.push((at.motion.time, at.motion.state.theta.abs()));
                let (ending, watched) = (run.sample(times, show, &mut watch).unwrap().ending, watch.end());
                assert_eq!(watched.fall().is_some(), ending == Ending::Overturned);
                let Some(instant) = watched.fall() else { continue };
                let Some(last) = seen.iter().rposition(|(_, theta)| *theta < alpha_cg) else {
                    let peak = watched.peaks().theta().magnitude;
                    assert_eq!((instant, peak), (0.0, -initial.theta), "{detail:?} {beyond}");
                    continue;
                };
                assert!(seen[last].0 <= instant && instant <= seen[last + 1].0, "{detail:?} {beyond}: {instant}");
                let mut there = Vec::new();
                run.sample([instant], |at| there.push(at.motion.state.theta.abs()), &mut ()).unwrap();
                assert!((there[0] - alpha_cg).abs() < 1e-13, "{detail:?} {beyond}: {there:?}");
                returned += 1;
            }
        }
        assert!(returned > 30, "{returned}");
    }

    /// Overturning ends a run, and with it what its ground has done.
    #[test]
    fn the_peak_of_the_ground_is_that_until_the_run_ended() {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let times: Vec<f64> = (0..=100).map(f64::from).collect();
        let acceleration = times.iter().map(|time| 9.0 * (time / 100.0)).collect();
        let ground = Record::from_samples("", times, acceleration).unwrap();
        let found = Run::new(structure, &ground).found(&mut ()).unwrap();
        let end = found.finish.motion.time;
        assert!(found.finish.ending == Ending::Overturned && end < 60.0);
        assert_eq!(found.ground.time, end);
        assert!((found.ground.magnitude - 0.09 * end).abs() < 1e-12);
    }
}
