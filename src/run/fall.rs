//! Where a structure that overturns begins to fall: when |θ| passes α_cg, beyond which its weight pulls it over, for the last
//! time.

use super::peaks::Peaks;
use super::{End, Run, RunError};
use crate::series::bisection::last_where;
use crate::{Load, Piece, Structure, Watch};

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
        Fall { alpha_cg: structure.tan_alpha_cg.atan(), instant: None }
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
        } else if self.instant.is_none() {
            self.instant = Some(self.passing(piece));
        }
    }
}

impl Fall {
    /// When |θ| passes α_cg in `piece`, at whose end it is beyond, s.
    fn passing(&self, piece: &Piece) -> f64 {
        let start = piece.before.time;
        if piece.before.state.theta.abs() >= self.alpha_cg {
            return start;
        }
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let (passed, reach, span) = (expansion.from, expansion.arc.reach, expansion.arc.span);
            let is_before = |sigma: f64| expansion.outputs(sigma).theta.abs() < self.alpha_cg;
            if !is_before(reach) {
                return start + passed + last_where(0.0, reach, is_before) * span;
            }
        }
        start + piece.duration // by rounding
    }
}

impl Run<'_> {
    /// The exact peaks until `instant` (s), which may be the first sample's.
    pub fn peaks_until(&self, instant: f64) -> Result<Peaks, RunError> {
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
