//! The levels of detail on one scene, their errors and their cost, and the level that is advised.

use crate::estimate::Estimate;
use crate::quantities::{PrintedNumber, of_motion};
use crate::run::{NamedPeak, RunSetup, symbol};
use rocking::Detail;
use rocking::digits::{short, significant};
use rocking::engine::{DEFAULT_TOLERANCE, motion::Work};
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::run::levels::{self, Choice, Criterion, LevelResult, REFERENCE_TOLERANCE, RULE, Verdict};
use rocking::run::{LONGEST_REST, RunError, Runs, validity::Limits};
use rocking_sweep::with_run;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// The levels of detail on one run, and the level that is advised.
pub struct Advice {
    /// The error that is allowed, and the criteria to which it applies.
    allowed: (f64, Vec<Criterion>),
    /// Eqs 1, 5, 6 to [`REFERENCE_TOLERANCE`].
    reference: LevelAdvice,
    /// The simplest first.
    pub levels: Vec<LevelAdvice>,
    /// The level `auto` without the vertical ground acceleration, if the run has one.
    without_vertical: Option<Result<LevelAdvice, RunError>>,
    /// Levels that cannot do the run, and why.
    pub refused: Vec<(Choice, RunError)>,
    /// The cheapest level with errors that are allowed.
    pub advised: Option<Choice>,
}

/// A level of detail on a run, beside the reference; for programs, errors are ratios and peaks in SI units.
#[derive(Serialize)]
pub struct LevelAdvice {
    level: &'static str,
    /// Modes that are kept, of a structure of many masses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep: Option<usize>,
    /// Relative errors, in the order of [`Criterion::ALL`].
    #[serde(flatten, serialize_with = "by_criterion")]
    pub errors: [f64; Criterion::ALL.len()],
    /// Whether the structure overturns; None if it still rocks at the end.
    pub overturned: Option<bool>,
    /// Whether it overturns, or not, as in the reference; None if the structure still rocks at the end of the reference.
    is_right_about_overturning: Option<bool>,
    #[serde(flatten)]
    pub work: Work,
    /// The cost as a multiple of the cost of `auto`; None if `auto` cannot do the run.
    #[serde(rename = "cost_of_auto")]
    pub cost: Option<f64>,
    advised: bool,
    #[serde(flatten, serialize_with = "by_name")]
    peaks: Vec<NamedPeak>,
    /// The level, and how many modes it keeps.
    #[serde(skip)]
    pub choice: Choice,
    #[serde(skip)]
    pub transitions: u64,
    #[serde(skip)]
    is_allowed: bool,
}

/// All levels of detail on `run`, each beside the reference.
fn compare<Q: Runs>(run: &rocking::Run<Q>, (within, criteria): (f64, &[Criterion])) -> Result<Advice, RunError> {
    let all = run.compare()?;
    let advised = all.recommended(within, criteria).map(|verdict| verdict.response.choice);
    let level = |level, response: &LevelResult, errors, is_right_about_overturning, is_allowed| LevelAdvice {
        level,
        keep: response.choice.modes.map(|[kept, _]| kept),
        errors,
        overturned: response.ending.overturned(),
        is_right_about_overturning,
        work: response.work,
        cost: all.cost_over_auto(response),
        advised: false,
        peaks: NamedPeak::all(&run.structure, &response.peaks),
        choice: response.choice,
        transitions: response.transitions,
        is_allowed,
    };
    let beside = |name, of: &Verdict| {
        level(name, &of.response, of.errors, of.is_right_about_overturning, of.is_within(within, criteria))
    };
    let of = |verdict: &Verdict| {
        let choice = verdict.response.choice;
        LevelAdvice { advised: advised == Some(choice), ..beside(choice.detail.name(), verdict) }
    };
    let is_right = all.reference.ending.overturned().map(|_| true);
    let without_vertical = all.without_vertical.as_ref().map(Result::as_ref);
    Ok(Advice {
        allowed: (within, criteria.into()),
        reference: level("reference", &all.reference, [0.0; Criterion::ALL.len()], is_right, true),
        levels: all.verdicts.iter().map(of).collect(),
        advised,
        without_vertical: without_vertical
            .map(|of| of.map(|of| beside("auto without a_v", of)).map_err(RunError::clone)),
        refused: all.refused,
    })
}

impl RunSetup {
    /// Follows the motion at every level of detail, and advises the cheapest level whose errors of `criteria` stay `within` a part.
    pub fn advice(&self, within: f64, criteria: &[Criterion]) -> Result<Advice, RunError> {
        with_run!(self.conditions, self.structure, &self.ground, run => compare(&run, (within, criteria)))?
    }

    /// The table and the `advice` on this run under the ground motion that `title` names, for people.
    pub fn advice_text(&self, title: &str, advice: &Advice, limits: &Limits) -> anyhow::Result<String> {
        let mut out = String::new();
        writeln!(out, "Ground motion: {title}")?;
        self.print_reference(&mut out, &advice.reference)?;
        advice.print_levels(&mut out)?;
        if let Some(structure) = self.structure.one() {
            write!(out, "  {:<10} ", "estimate")?;
            match Estimate::new(structure, Some(&self.ground), INSTANT_TRANSITION) {
                Ok(Estimate { demand, .. }) => {
                    let a_t = largest(&advice.reference.peaks, "a_t").map_or(0.0, |peak| peak.magnitude);
                    let error = percent(levels::relative(((demand.a_t - a_t).abs(), a_t)));
                    writeln!(out, "{:>8} {:>8} {error:>13}", "-", "-")?;
                }
                Err(error) => writeln!(out, "not possible here: {error}")?,
            }
        }
        for (choice, error) in &advice.refused {
            writeln!(out, "  {choice:<10} not possible here: {error:#}")?;
        }
        advice.print_advice(&mut out)?;
        writeln!(out)?;
        for line in self.section(&self.validity(*limits, &mut ())?, limits) {
            writeln!(out, "{line}")?;
        }
        Ok(out)
    }

    fn print_reference(&self, out: &mut impl Write, reference: &LevelAdvice) -> fmt::Result {
        let (base, of_many) = (self.structure.base(), reference.choice.modes.is_some());
        let peaks = ["theta", "u", "a_t", "V_t", "M_t"].iter().filter_map(|symbol| largest(&reference.peaks, symbol));
        let shown = |NamedPeak { name, magnitude, unit, .. }: &NamedPeak| {
            let (per_unit, unit) = of_motion(*magnitude, unit, base.g);
            format!("{name} {} {unit}", significant(magnitude / per_unit))
        };
        let shown: Vec<_> = peaks.map(shown).collect();
        let level = if of_many { reference.choice.to_string() + " modes" } else { "nonlinear".into() };
        let transitions = reference.transitions;
        writeln!(out, "Reference: {level}, tolerance {REFERENCE_TOLERANCE:e}, {transitions} transitions")?;
        let [rest, ..] = self.structure.rest();
        if rest > 0.0 {
            let rigid = percent(rest / self.structure.body().m_s);
            writeln!(out, "  {rigid} % of m_s turns rigidly with the base, also in the reference")?;
        }
        if reference.overturned.is_none() {
            let limit = significant(LONGEST_REST / base.p_l);
            writeln!(
                out,
                "  it still rocks {limit} s after the record: whether it overturns is not known; see --duration"
            )?;
        }
        writeln!(out, "  peaks: {}", shown.join(", "))?;
        if reference.overturned == Some(true) {
            return writeln!(out, "  the structure overturns\n");
        }
        let theta = largest(&reference.peaks, "theta").map_or(0.0, |peak| peak.magnitude);
        if theta == 0.0 {
            let estimate = if self.structure.one().is_none() { "" } else { "; the estimate assumes that it does" };
            return writeln!(out, "  the base never lifts off{estimate}\n");
        }
        if let Some(structure) = self.structure.one()
            && let Ok(f_r) = effective_frequency(structure, theta)
        {
            writeln!(out, "  effective frequency of rocking at that theta: {} Hz (Eq 14)", significant(f_r))?;
        }
        writeln!(out)
    }
}

/// The largest of the `peaks` of all floors of a quantity.
fn largest<'a>(peaks: &'a [NamedPeak], of: &str) -> Option<&'a NamedPeak> {
    let of_symbol = peaks.iter().filter(|peak| symbol(&peak.name) == of);
    of_symbol.max_by(|a, b| a.magnitude.total_cmp(&b.magnitude))
}

fn by_criterion<S: Serializer>(errors: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let named =
        Criterion::ALL.iter().zip(errors).map(|(of, error)| (format!("error_{}", of.name()), PrintedNumber(*error)));
    serializer.collect_map(BTreeMap::from_iter(named))
}

fn by_name<S: Serializer>(peaks: &[NamedPeak], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(BTreeMap::from_iter(peaks.iter().map(|peak| (&peak.name, peak.magnitude))))
}

impl Advice {
    /// The reference, then the levels, for programs.
    pub fn rows(&self) -> Vec<&LevelAdvice> {
        [&self.reference].into_iter().chain(&self.levels).chain(self.without_vertical.iter().flatten()).collect()
    }

    fn print_levels(&self, out: &mut impl Write) -> fmt::Result {
        const WIDTHS: [usize; 10] = [8, 8, 13, 8, 8, 8, 10, 8, 11, 7];
        let longest = self.levels.iter().map(|level| level.choice.to_string().len()).max();
        let longest = longest.unwrap_or(0).max("fixed_base".len());
        let mut row = |mark: char, level: &str, cells: &[String]| {
            write!(out, "{mark} {level:<longest$}")?;
            cells.iter().zip(WIDTHS).try_for_each(|(cell, width)| write!(out, " {cell:>width$}"))?;
            writeln!(out)
        };
        let over = ["error of peaks, %", "of histories, %", "", "cost"];
        row(' ', "", &[format!("{:^31} {:^26} {:>10} {:^28}", over[0], over[1], over[2], over[3])])?;
        let headings =
            ["theta", "u", "a_t, V_t, M_t", "theta", "u", "a_t", "overturns", "steps", "evaluations", "of auto"];
        row(' ', "level", &headings.map(str::to_owned))?;
        for LevelAdvice { choice, errors, overturned, is_right_about_overturning, work, cost, .. } in &self.levels {
            let mark = if self.advised == Some(*choice) { '>' } else { ' ' };
            let name = match overturned {
                Some(true) => "yes",
                Some(false) => "no",
                None => "unknown",
            };
            let overturns = match (is_right_about_overturning, overturned) {
                (Some(false), _) => format!("{name}, wrong"),
                (None, Some(_)) => format!("{name} (?)"),
                _ => name.into(),
            };
            let counts = [work.steps, work.evaluations].map(|count| count.to_string());
            let ratio = cost.map_or("-".into(), |cost| format!("{cost:.2}"));
            row(mark, &choice.to_string(), &[&errors.map(percent)[..], &[overturns], &counts, &[ratio]].concat())?;
        }
        Ok(())
    }

    /// The advised level, and the effect of the vertical component: the differences of the motion on level ground.
    fn print_advice(&self, out: &mut impl Write) -> fmt::Result {
        let (within, criteria) = &self.allowed;
        let names: Vec<_> = criteria.iter().map(|of| of.name()).collect();
        let limit = format!("within {} % in {}", short(100.0 * within), names.join(", "));
        match self.levels.iter().find(|level| self.advised == Some(level.choice)) {
            None => writeln!(
                out,
                "\nno level stays {limit}: use detail = nonlinear with a tolerance below {DEFAULT_TOLERANCE:e}"
            )?,
            Some(&LevelAdvice { choice, cost, .. }) => {
                let modes = match choice.modes {
                    Some([kept, all]) if kept < all => format!(" and keep = {kept} of {all} modes"),
                    Some([_, 1]) => " with its one mode".to_owned(),
                    Some([_, all]) => format!(" with all {all} modes"),
                    None => String::new(),
                };
                write!(out, "\nuse detail = {}{modes}: {RULE} {limit}", choice.detail.name())?;
                let auto = Choice { detail: Detail::Auto, ..self.reference.choice };
                match cost.filter(|_| choice != auto) {
                    Some(cost) => writeln!(out, ", at {cost:.2} times the cost of auto")?,
                    None => writeln!(out)?,
                }
            }
        }
        match &self.without_vertical {
            Some(Ok(level)) => {
                let change = |of: &Criterion| format!("{} by {} %", of.name(), percent(level.errors[*of as usize]));
                let changes: Vec<_> = criteria.iter().map(change).collect();
                let is_wrong = level.is_right_about_overturning == Some(false);
                let overturning = if is_wrong { ", and whether it overturns" } else { "" };
                let advice = if level.is_allowed { "leave it out" } else { "keep it" };
                writeln!(out, "the vertical component changes {}{overturning}: {advice}", changes.join(", "))
            }
            Some(Err(error)) => writeln!(out, "without the vertical component the run is not possible: {error}"),
            None => Ok(()),
        }
    }
}

/// A ratio in percent, for a column.
fn percent(ratio: f64) -> String {
    match 100.0 * ratio {
        0.0 => "0".into(),
        ..1e-9 => "<1e-9".into(),
        percent if percent < 0.01 => format!("{percent:.0e}"),
        percent if percent < 1e4 => format!("{percent:.2}"),
        percent => format!("{percent:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn percentages_fit_their_column() {
        assert_eq!([0.0, 3e-14, 2.4e-5, 0.0354, f64::INFINITY].map(percent), ["0", "<1e-9", "2e-3", "3.54", "inf"]);
    }
}
