//! The summary of a run.
use crate::quantities::readable;
use crate::shown::{Named, OF_FLOOR, Shown};
use crate::validity;
use rocking::digits::significant;
use rocking::mechanics::restraint::Dissipators;
use rocking::run::{Ending, Finish, LONGEST_REST, fall::Found, peaks::Peak};
use rocking::structure::Ties;
use rocking::{Motion, Phase, Side, Transition, TransitionKind};
use serde::Serialize;
use std::fmt::{self, Write};

/// First transitions of a run.
pub struct Summary<'a, Q: Shown> {
    structure: &'a Q::Structure,
    first_uplift: Option<f64>,
    first_impact: Option<f64>,
}

/// A peak, for programs.
#[derive(Serialize)]
struct NamedPeak {
    name: String,
    peak: f64,
    unit: &'static str,
    /// Its instant, s.
    time: f64,
}

/// The summary for programs; instants in s.
#[derive(Serialize)]
pub struct Whole<'a, Cause> {
    #[serde(flatten)]
    cause: &'a Cause,
    start: f64,
    end: f64,
    ending: Ending,
    /// None if the structure still rocks at the end.
    overturned: Option<bool>,
    /// Start of the fall, s; the peaks are those before it.
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

/// Work of the dissipators until the end of a run.
#[derive(Clone, Copy, Serialize)]
struct Taken {
    /// Energy, J.
    E_viscous: f64,
    /// J.
    E_hysteretic: f64,
    /// Rotation that is left, rad.
    theta_end: f64,
}

impl<'s, Q: Shown> Summary<'s, Q> {
    /// Of a run of `structure` with these `transitions`.
    pub fn new(structure: &'s Q::Structure, transitions: &[Transition<Q>]) -> Summary<'s, Q> {
        let first = |is_meant: fn(&TransitionKind) -> bool| {
            transitions.iter().find(|transition| is_meant(&transition.kind)).map(|transition| transition.time)
        };
        let first_uplift = first(|kind| matches!(kind, TransitionKind::Uplift(_)));
        let first_impact = first(|kind| {
            matches!(kind, TransitionKind::Impact(_) | TransitionKind::Landing | TransitionKind::Settling)
        });
        Summary { structure, first_uplift, first_impact }
    }

    /// The summary for programs, with the `cause` of the run, the results `found`, and the validity.
    pub fn whole<'a, C>(&self, cause: &'a C, found: &Found<Q>, validity: Vec<validity::Beyond>) -> Whole<'a, C> {
        let &Found { fall, start, finish: Finish { ending, motion }, .. } = found;
        let row = |((name, unit), Peak { magnitude: peak, time })| NamedPeak { name, peak, unit, time };
        Whole {
            cause,
            start,
            end: motion.time,
            ending,
            overturned: ending.overturned(),
            fall,
            peaks: self.peaks(found).into_iter().map(row).collect(),
            taken: self.taken(&motion),
            first_uplift: self.first_uplift,
            first_impact: self.first_impact,
            transitions: motion.transitions,
            steps: motion.work.steps,
            evaluations: motion.work.evaluations,
            validity,
        }
    }

    /// All peaks, the peak of the ground first.
    pub fn peaks(&self, found: &Found<Q>) -> Vec<(Named, Peak)> {
        let of_structure = Q::peaks(self.structure, &found.peaks);
        [(("a_g".to_owned(), "m/s2"), found.ground)].into_iter().chain(of_structure).collect()
    }

    /// Work of the dissipators until the end, in `motion`; None without dissipators.
    fn taken(&self, motion: &Motion<Q>) -> Option<Taken> {
        let Ties { c_d, k_d, .. } = Q::base(self.structure).ties;
        let Dissipators { viscous: E_viscous, hysteretic: E_hysteretic, .. } = motion.dissipators;
        (c_d > 0.0 || k_d > 0.0).then_some(Taken { E_viscous, E_hysteretic, theta_end: motion.state.theta })
    }

    /// The summary in lines for people.
    pub fn text(&self, found: &Found<Q>) -> Result<String, fmt::Error> {
        let &Found { ref peaks, fall, finish: Finish { ending, motion }, .. } = found;
        let mut out = String::new();
        let base = Q::base(self.structure);
        let read = |magnitude: f64, unit| match unit {
            "m" => (1e-3, "mm"),
            "m/s2" => (base.g, "g"),
            unit => readable(magnitude, unit),
        };
        for ((name, unit), peak) in self.peaks(found).into_iter().filter(|((name, _), _)| !name.ends_with(']')) {
            let (per_unit, unit) = read(peak.magnitude, unit);
            let (magnitude, time) = (significant(peak.magnitude / per_unit), instant(peak.time));
            writeln!(out, "{:<14} {magnitude:>12} {unit:<4} at {time} s", format!("peak |{name}|"))?;
        }
        let floors = if Q::HAS_FLOORS { Q::floors(self.structure, peaks) } else { Vec::new() };
        if !floors.is_empty() {
            let largest = |i: usize| floors.iter().fold(0.0_f64, |most, floor| most.max(floor[i]));
            let columns = OF_FLOOR.iter().enumerate().map(|(i, (name, unit))| match i {
                0 => (name, 1.0, *unit),
                i => {
                    let (per_unit, unit) = read(largest(i), unit);
                    (name, per_unit, unit)
                }
            });
            let columns = Vec::from_iter(columns);
            write!(out, "floor")?;
            columns.iter().try_for_each(|(name, _, unit)| write!(out, " {:>12}", format!("{name} ({unit})")))?;
            for (number, floor) in (1..).zip(&floors) {
                write!(out, "\n{number:<5}")?;
                let row = columns.iter().zip(floor);
                row.into_iter().try_for_each(|((_, per, _), peak)| write!(out, " {:>12}", significant(peak / per)))?;
            }
            writeln!(out)?;
        }
        if let Some(fall) = fall {
            let angle = if base.is_restrained() { "the angle of no return" } else { "alpha_cg" };
            let start = instant(fall);
            writeln!(out, "fall           starts at {start} s, beyond {angle}; peaks are those before the fall")?;
        }
        if let Some(Taken { E_viscous, E_hysteretic, theta_end }) = self.taken(&motion) {
            let [E_viscous, E_hysteretic, theta_end] = [E_viscous, E_hysteretic, theta_end].map(significant);
            writeln!(out, "dissipated     {E_viscous} J viscous, {E_hysteretic} J elastoplastic")?;
            writeln!(out, "theta at end   {theta_end} rad")?;
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
                    let limit = significant(LONGEST_REST / base.p_l);
                    format!("not known: it still rocks {limit} s after the record; see --duration")
                }
                Ending::AtTime => "not by the end of the run".into(),
                Ending::AtRest | Ending::Overturned => "no".into(),
            },
        };
        writeln!(out, "overturned     {overturned}")?;
        let of_peaks = Q::evaluations(peaks).map_or(String::new(), |more| format!("; {more} more for peaks"));
        writeln!(out, "work           {} steps, {} evaluations{of_peaks}", motion.work.steps, motion.work.evaluations)?;
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
