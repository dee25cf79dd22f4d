//! What `simulate` prints at the end of a run.
use crate::cause::Cause;
use crate::quantities::readable;
use crate::validity;
use fmu_export::significant::significant;
use rocking::mechanics::restraint::Dissipators;
use rocking::run::{
    Ending, Finish, LONGEST_REST,
    fall::Found,
    peaks::{self, Peak},
};
use rocking::{Motion, Parameters, Phase, Side, Structure, Transition, TransitionKind};
use serde::Serialize;
use std::fmt::{self, Write};

/// First transitions of a run.
pub struct Summary {
    structure: Structure,
    first_uplift: Option<f64>,
    first_impact: Option<f64>,
}

/// A peak, for programs.
#[derive(Serialize)]
struct NamedPeak {
    name: &'static str,
    peak: f64,
    unit: &'static str,
    /// Its instant, s.
    time: f64,
}

/// All of it, for programs; instants in s.
#[derive(Serialize)]
pub struct Whole<'a> {
    #[serde(flatten)]
    cause: &'a Cause,
    start: f64,
    end: f64,
    ending: Ending,
    /// None if it still rocks.
    overturned: Option<bool>,
    /// Since when it falls: the peaks are those before.
    fall: Option<f64>,
    peaks: Vec<NamedPeak>,
    /// Of a structure with dissipators.
    #[serde(flatten)]
    taken: Option<Taken>,
    first_uplift: Option<f64>,
    first_impact: Option<f64>,
    transitions: u64,
    steps: u64,
    evaluations: u64,
    validity: Vec<validity::Beyond>,
}

/// What dissipators have done by the end of a run.
#[derive(Clone, Copy, Serialize)]
struct Taken {
    /// Energy, J.
    E_viscous: f64,
    /// J.
    E_hysteretic: f64,
    /// Rotation that is left, rad.
    theta_end: f64,
}

impl Summary {
    /// Of a run of `structure` with these `transitions`.
    pub fn new(structure: &Structure, transitions: &[Transition]) -> Summary {
        let first = |is_meant: fn(&TransitionKind) -> bool| {
            transitions.iter().find(|transition| is_meant(&transition.kind)).map(|transition| transition.time)
        };
        let first_uplift = first(|kind| matches!(kind, TransitionKind::Uplift(_)));
        let first_impact = first(|kind| {
            matches!(kind, TransitionKind::Impact(_) | TransitionKind::Landing | TransitionKind::Settling)
        });
        Summary { structure: *structure, first_uplift, first_impact }
    }

    /// All of it for programs, with the `cause` of the run, what was `found` in it and what the model leaves out.
    pub fn whole<'a>(&self, cause: &'a Cause, found: &Found, validity: Vec<validity::Beyond>) -> Whole<'a> {
        let &Found { ground, ref peaks, fall, start, finish: Finish { ending, motion } } = found;
        let row = |name, unit, Peak { magnitude: peak, time }| NamedPeak { name, peak, unit, time };
        let of_structure = peaks::of(&self.structure).map(|peak| row(peak.name, peak.unit, (peak.of)(peaks)));
        let overturned = match ending {
            Ending::StillRocking => None,
            ending => Some(ending == Ending::Overturned),
        };
        Whole {
            cause,
            start,
            end: motion.time,
            ending,
            overturned,
            fall,
            peaks: [row("a_g", "m/s2", ground)].into_iter().chain(of_structure).collect(),
            taken: self.taken(motion),
            first_uplift: self.first_uplift,
            first_impact: self.first_impact,
            transitions: motion.transitions,
            steps: motion.work.steps,
            evaluations: motion.work.evaluations,
            validity,
        }
    }

    /// What dissipators have done by the end, in `motion`; none without them.
    fn taken(&self, motion: Motion) -> Option<Taken> {
        let &Parameters { c_d, k_d, .. } = self.structure.parameters();
        let Dissipators { viscous: E_viscous, hysteretic: E_hysteretic, .. } = motion.dissipators;
        (c_d > 0.0 || k_d > 0.0).then_some(Taken { E_viscous, E_hysteretic, theta_end: motion.state.theta })
    }

    /// The summary in lines for people.
    pub fn text(&self, found: &Found) -> Result<String, fmt::Error> {
        let &Found { ground, ref peaks, fall, finish: Finish { ending, motion }, .. } = found;
        let mut out = String::new();
        let &Parameters { g, .. } = self.structure.parameters();
        let of_structure = peaks::of(&self.structure).map(|of| (of.name, (of.of)(peaks), of.unit));
        for (name, peak, unit) in [("a_g", ground, "m/s2")].into_iter().chain(of_structure) {
            let (per_unit, unit) = match unit {
                "m" => (1e-3, "mm"),
                "m/s2" => (g, "g"),
                unit => readable(peak.magnitude, unit),
            };
            let (magnitude, time) = (significant(peak.magnitude / per_unit), instant(peak.time));
            writeln!(out, "{:<14} {magnitude:>12} {unit:<4} at {time} s", format!("peak |{name}|"))?;
        }
        if let Some(fall) = fall {
            let angle = if self.structure.is_restrained() { "its angle of no return" } else { "alpha_cg" };
            writeln!(out, "fall           from {} s on, beyond {angle}: the peaks are those before", instant(fall))?;
        }
        if let Some(Taken { E_viscous, E_hysteretic, theta_end }) = self.taken(motion) {
            let [E_viscous, E_hysteretic, theta_end] = [E_viscous, E_hysteretic, theta_end].map(significant);
            writeln!(out, "dissipated     {E_viscous} J viscous, {E_hysteretic} J elastoplastic")?;
            writeln!(out, "left at end    theta = {theta_end} rad")?;
        }
        let first = |time: Option<f64>| time.map_or("none".into(), |time| format!("at {} s", instant(time)));
        writeln!(out, "first uplift   {}", first(self.first_uplift))?;
        writeln!(out, "first impact   {}", first(self.first_impact))?;
        writeln!(out, "transitions    {}", motion.transitions)?;
        let overturned = match motion.phase {
            Phase::Overturned(Side::Left) => format!("to the left at {} s", instant(motion.time)),
            Phase::Overturned(Side::Right) => format!("to the right at {} s", instant(motion.time)),
            Phase::FullContact | Phase::Rocking(_) => match ending {
                Ending::StillRocking => {
                    let limit = significant(LONGEST_REST / self.structure.p_l);
                    format!("not known: it still rocks {limit} s after the record; see --duration")
                }
                Ending::AtTime => "not by then".into(),
                Ending::AtRest | Ending::Overturned => "no".into(),
            },
        };
        writeln!(out, "overturned     {overturned}")?;
        let (work, of_peaks) = (motion.work, peaks.evaluations());
        writeln!(
            out,
            "work           {} steps, {} evaluations; {of_peaks} more for peaks",
            work.steps, work.evaluations
        )?;
        Ok(out)
    }
}

/// An instant (s) to six digits or to 10 us, whichever is finer.
pub fn instant(time: f64) -> String {
    if time.abs() < 10.0 { significant(time) } else { format!("{time:.5}") }
}

#[cfg(test)]
mod tests {
    use super::instant;

    #[test]
    fn late_instants_have_their_decimals() {
        let shown = [0.168487319, 1.334952, 41.7182818, 3600.123456, -12.5].map(instant);
        assert_eq!(shown, ["0.168487", "1.33495", "41.71828", "3600.12346", "-12.50000"]);
    }
}
