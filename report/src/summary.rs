//! The summary of a run.
use crate::quantities::{NamedValue, of_motion};
use crate::run::{Dissipated, NamedPeak, OF_FLOOR, RunReport, RunSetup, SureDigits};
use crate::validity;
use rocking::digits::significant;
use rocking::run::peaks::Peak;
use rocking::run::validity::Limits;
use rocking::run::{Ending, LONGEST_REST};
use rocking::{Phase, Side};
use serde::Serialize;
use std::fmt::{self, Write};

#[derive(Serialize)]
pub struct ProgramSummary<'a, Cause> {
    #[serde(flatten)]
    cause: &'a Cause,
    #[serde(flatten)]
    found: &'a RunReport,
    validity: Vec<validity::Beyond>,
}

impl RunReport {
    /// The results for programs, with the `cause` of the run, and the validity within `limits`.
    pub fn whole<'a, C>(&'a self, cause: &'a C, limits: &Limits) -> ProgramSummary<'a, C> {
        let rows = self.findings.iter().flat_map(|findings| validity::rows(findings, limits));
        ProgramSummary { cause, found: self, validity: rows.collect() }
    }
}

impl RunSetup {
    /// The summary in lines for people, then the limits of the model, if `found` has findings.
    pub fn text(&self, found: &RunReport, limits: &Limits) -> Result<String, fmt::Error> {
        let mut out = String::new();
        let base = self.structure.base();
        for NamedPeak { name, magnitude, unit, time, .. } in found.peaks.iter().filter(|peak| !peak.name.ends_with(']'))
        {
            let (per_unit, unit) = of_motion(*magnitude, unit, base.g);
            let (magnitude, time) = (significant(magnitude / per_unit), instant(*time));
            writeln!(out, "{:<14} {magnitude:>12} {unit:<4} at {time} s", format!("peak |{name}|"))?;
        }
        let floors = if self.structure.is_one_mass() { Vec::new() } else { self.floors(found) };
        if !floors.is_empty() {
            let largest = |i: usize| floors.iter().fold(0.0_f64, |most, floor| most.max(floor[i]));
            let columns = OF_FLOOR.iter().enumerate().map(|(i, (name, unit))| match i {
                0 => (name, 1.0, *unit),
                i => {
                    let (per_unit, unit) = of_motion(largest(i), unit, base.g);
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
        if let Some(fall) = found.fall {
            let angle = if base.is_restrained() { "the angle of no return" } else { "alpha_cg" };
            let start = instant(fall);
            writeln!(out, "fall           starts at {start} s, beyond {angle}; peaks are those before the fall")?;
        }
        if let Some(Dissipated { E_viscous, E_hysteretic, theta_end }) = found.taken {
            let [E_viscous, E_hysteretic, theta_end] = [E_viscous, E_hysteretic, theta_end].map(significant);
            writeln!(out, "dissipated     {E_viscous} J viscous, {E_hysteretic} J elastoplastic")?;
            writeln!(out, "theta at end   {theta_end} rad")?;
        }
        for NamedValue { name, value, unit, description, .. } in &found.residuals {
            let (per_unit, unit) = of_motion(*value, unit, base.g);
            writeln!(out, "{name:<14} {:>12} {unit:<4} {description}", significant(value / per_unit))?;
        }
        let slid = found.peak("x").filter(|x| base.is_restrained() && x.magnitude > LEANING * base.B);
        if let Some(Peak { magnitude, .. }) = slid {
            let slid = significant(magnitude);
            writeln!(
                out,
                "ties           stay vertical in the model: the base slides by {slid} m, and their pull sideways is left out"
            )?;
        }
        let first = |time: Option<f64>| time.map_or("none".into(), |time| format!("at {} s", instant(time)));
        writeln!(out, "first uplift   {}", first(found.first_uplift))?;
        let impact = if self.structure.foundation().is_some() { "touch " } else { "impact" };
        writeln!(out, "first {impact}   {}", first(found.first_impact))?;
        writeln!(out, "transitions    {}", found.transitions)?;
        let overturned = match (found.phase, found.ending) {
            (Phase::Overturned(Side::Left), _) => format!("to the left at {} s", instant(found.end)),
            (Phase::Overturned(Side::Right), _) => format!("to the right at {} s", instant(found.end)),
            (_, Ending::StillRocking) => {
                let limit = significant(LONGEST_REST / base.p_l);
                format!("not known: it still rocks {limit} s after the record; see --duration")
            }
            (_, Ending::AtTime) => "not by the end of the run".into(),
            (_, Ending::AtRest | Ending::Overturned) => "no".into(),
        };
        writeln!(out, "overturned     {overturned}")?;
        found.sure.iter().try_for_each(|sure| writeln!(out, "sure digits    {}", sentence(found, sure)))?;
        let of_peaks = found.for_peaks.map_or(String::new(), |more| format!("; {more} more for peaks"));
        writeln!(out, "work           {} steps, {} evaluations{of_peaks}", found.work.steps, found.work.evaluations)?;
        if let Some(findings) = &found.findings {
            out += &self.section(findings, limits).join("\n");
        }
        Ok(out)
    }
}

/// Way of the base over B beyond which a tie leans.
const LEANING: f64 = 0.01;

/// The sure digits of the run, of its least sure peak and of the outcome, in a sentence.
fn sentence(found: &RunReport, &SureDigits { digits, overturning_digits, overturning_change }: &SureDigits) -> String {
    let of_run = if found.ending == Ending::Overturned { "the instant of overturning" } else { "theta" };
    let least = found.peaks.iter().filter_map(|peak| peak.digits).min().unwrap_or(0);
    let decides = match overturning_change {
        None => "or more: no change of the input tried, up to 1 %, decides otherwise".into(),
        Some(change) => format!("because the input times (1{change:+e}) decides otherwise"),
    };
    let what = if found.overturned.is_some() { "whether it overturns" } else { "that it still rocks" };
    format!("{of_run} {digits}, each peak at least {least}; {what} {overturning_digits} {decides}")
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
