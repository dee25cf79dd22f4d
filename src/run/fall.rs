//! Where a structure that overturns begins to fall: when |θ| passes α_cg, beyond which its weight pulls it over, for
//! the last time. Its peaks are those before.

use super::ground_motion::GroundMotion;
use super::peaks::{Peak, Peaks};
use super::{End, Ending, Finish, Run, RunError};
use crate::engine::piece::Expansion;
use crate::series::first_crossing::{Crossing, Guard, first_time_closed_from};
use crate::series::taylor;
use crate::{Load, Piece, Structure, Watch};

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Of the ground acceleration (m/s²), as far as the record is asked for: past an overturning, too.
    pub ground: Peak,
    /// Of the structure: of one that overturns, before it falls.
    pub peaks: Peaks,
    /// Since when it falls, s.
    pub fall: Option<f64>,
    /// When the run began, s.
    pub start: f64,
    /// How it ended.
    pub finish: Finish,
}

/// Watches a motion for the instant.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// α_cg, rad.
    alpha_cg: f64,
    instant: Option<f64>,
}

impl Fall {
    /// Of `structure`, nothing seen yet.
    pub fn new(structure: &Structure) -> Fall {
        Fall { alpha_cg: libm::atan(structure.tan_alpha_cg), instant: None }
    }

    /// Since when |θ| ≥ α_cg (s); none if it is not.
    pub fn instant(&self) -> Option<f64> {
        self.instant
    }
}

impl Watch for Fall {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        if piece.end.theta.abs() < self.alpha_cg {
            self.instant = None;
            return;
        }
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let passing = self.last_passing(piece.end.theta.signum(), &expansion);
            self.instant = passing.or(self.instant).or(Some(expansion.time(0.0)));
        }
    }
}

impl Fall {
    /// When |θ| passes α_cg for the last time on a polynomial, at whose end it is beyond on this `side`, s: the first time
    /// going back from its end.
    fn last_passing(&self, side: f64, expansion: &Expansion) -> Option<f64> {
        let arc = expansion.arc;
        let mut theta = arc.theta;
        let back = &mut theta[..=arc.order];
        taylor::stretch(back, arc.reach, -arc.reach);
        let beyond = Guard::new(back, side, -self.alpha_cg);
        let mut sigma = 0.0;
        loop {
            match first_time_closed_from(beyond, sigma, 1.0) {
                Crossing::None => return None,
                Crossing::NoneUntil(until) if until - sigma > f64::EPSILON => sigma = until,
                Crossing::At(last) | Crossing::NoneUntil(last) => {
                    return Some(expansion.time(0.0) + (1.0 - last) * arc.duration());
                }
            }
        }
    }

    /// Of the peaks of `all` of `run`, which has ended so, those before the fall, and since when it falls (s).
    pub(super) fn peaks_before(
        &self,
        run: &Run,
        ending: Ending,
        all: &Peaks,
    ) -> Result<(Peaks, Option<f64>), RunError> {
        let fall = self.instant.filter(|_| ending == Ending::Overturned);
        Ok((fall.map_or(Ok(*all), |fall| run.peaks_until(fall))?, fall))
    }
}

impl Run<'_> {
    /// Follows the motion to the end, which `watch` sees, too, and finds its exact peaks.
    pub fn found(&self, watch: &mut impl Watch) -> Result<Found, RunError> {
        Ok(self.found_and_all(watch)?.0)
    }

    /// What the run came to, and the peaks of all of its motion, a fall included.
    pub(super) fn found_and_all(&self, watch: &mut impl Watch) -> Result<(Found, Peaks), RunError> {
        let start = self.ground.start();
        let (mut all, mut fall) = (Peaks::since(start, &self.structure), Fall::new(&self.structure));
        let finish = self.follow(&mut (&mut all.watch(), &mut (&mut fall, watch)))?;
        let (peaks, fall) = fall.peaks_before(self, finish.ending, &all)?;
        Ok((Found { ground: self.peak_of_ground(), peaks, fall, start, finish }, all))
    }

    /// The largest ground acceleration (m/s²) until the run is asked to end, whatever becomes of the structure.
    fn peak_of_ground(&self) -> Peak {
        let (times, acceleration) = (self.ground.times(), self.ground.acceleration());
        let until = if let End::At(end) = self.end { end } else { self.ground.end() };
        let next = times.partition_point(|time| *time <= until);
        let cut = (next < times.len()).then(|| {
            let from = times[next - 1];
            (until, GroundMotion::from(self.ground).ramp(next).at(until - from).a_g)
        });
        let samples = times[..next].iter().copied().zip(acceleration[..next].iter().copied());
        let most = |most: Peak, (time, a_g): (f64, f64)| {
            if a_g.abs() > most.magnitude { Peak { magnitude: a_g.abs(), time } } else { most }
        };
        samples.chain(cut).fold(Peak { magnitude: 0.0, time: self.ground.start() }, most)
    }

    /// The exact peaks until `instant` (s), which may be the first sample's.
    fn peaks_until(&self, instant: f64) -> Result<Peaks, RunError> {
        let start = self.ground.start();
        if instant > start {
            return Ok(Run { end: End::At(instant), ..self.clone() }.peaks()?.0);
        }
        let mut peaks = Peaks::since(start, &self.structure);
        let a_g = self.ground.acceleration()[0];
        peaks.see_instant(start, &self.start()?.outputs(Load::ground(a_g)));
        Ok(peaks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Ending;
    use crate::run::record::Record;
    use crate::{Detail, Outputs, Parameters, State};
    use std::f64::consts::TAU;

    /// Against dense samples: below α_cg before it, beyond from then on, and no peak is of later.
    #[test]
    fn the_fall_begins_where_the_rotation_passes_alpha_cg_for_the_last_time() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let alpha_cg = structure.tan_alpha_cg.atan();
        let times: Vec<_> = (0..=50).map(|i| f64::from(i) * 0.01).collect();
        let acceleration = times.iter().map(|time| 0.9 * 9.81 * (TAU * time / 0.5).sin()).collect();
        let ground = Record::from_samples("", times, acceleration).unwrap();
        for detail in [Detail::Auto, Detail::Linear, Detail::Rigid] {
            let run = Run { detail, ..Run::new(structure, &ground) };
            let mut fall = Fall::new(&structure);
            let mut seen: Vec<(f64, Outputs)> = Vec::new();
            let dense = (0..40_000).map(|i| f64::from(i) * 1e-4);
            let finish = run.sample(dense, |at| seen.push((at.motion.time, at.outputs())), &mut fall).unwrap();
            assert_eq!(finish.ending, Ending::Overturned);
            let instant = fall.instant().unwrap();
            let last = seen.iter().rposition(|(_, outputs)| outputs.theta.abs() < alpha_cg).unwrap();
            assert!(seen[last].0 <= instant && instant <= seen[last + 1].0, "{detail:?}: {instant}");

            let peaks = run.peaks_until(instant).unwrap();
            assert!((peaks.theta().magnitude - alpha_cg).abs() < 1e-9);
            for (peak, of) in [
                (peaks.u(), (|at| at.u) as fn(&Outputs) -> f64),
                (peaks.delta_t(), |at| at.delta_t),
                (peaks.a_t(), |at| at.a_t),
            ] {
                let most = seen[..=last].iter().fold(0.0_f64, |most, (_, at)| most.max(of(at).abs()));
                assert!(most <= peak.magnitude * (1.0 + 1e-9) && peak.time <= instant, "{detail:?}: {most} {peak:?}");
                assert!(most >= peak.magnitude * 0.99, "{detail:?}: {most} {peak:?}");
            }
        }
    }

    /// Released at rest about α_cg, near which the structure turns back, or falls after it has been back: against
    /// samples of its way.
    #[test]
    fn a_fall_after_a_return_is_found_exactly() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let alpha_cg = structure.tan_alpha_cg.atan();
        let (ground, mut returned) = (Record::at_rest(60.0), 0);
        for detail in [Detail::Auto, Detail::Linear, Detail::Modal, Detail::Rigid] {
            for beyond in (0..40).map(|i| 1e-4 * f64::from(i)) {
                let initial = State { theta: -alpha_cg * (1.0 + beyond), ..State::default() };
                let run = Run { detail, initial, ..Run::new(structure, &ground) };
                let (mut fall, mut seen) = (Fall::new(&structure), Vec::new());
                let times = (0..100_000).map(|i| f64::from(i) * 2e-4);
                let show = |at: &crate::engine::piece::Sample| seen.push((at.motion.time, at.motion.state.theta.abs()));
                if run.sample(times, show, &mut fall).unwrap().ending != Ending::Overturned {
                    continue;
                }
                let instant = fall.instant().unwrap();
                let Some(last) = seen.iter().rposition(|(_, theta)| *theta < alpha_cg) else {
                    assert_eq!(instant, 0.0, "{detail:?} {beyond}");
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

    #[test]
    fn what_falls_from_the_start_has_the_peaks_of_the_start() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let ground = Record::at_rest(1.0);
        let initial = State { theta: -0.3, ..State::default() };
        let run = Run { initial, ..Run::new(structure, &ground) };
        let mut fall = Fall::new(&structure);
        assert_eq!(run.follow(&mut fall).unwrap().ending, Ending::Overturned);
        assert_eq!(fall.instant(), Some(0.0));
        assert_eq!(run.peaks_until(0.0).unwrap().theta().magnitude, 0.3);
        let fallen_back = Run { initial: State { theta: 0.1, ..initial }, ..run };
        assert_ne!(fallen_back.follow(&mut fall).unwrap().ending, Ending::Overturned);
        assert_eq!(fall.instant(), None);
    }
}
