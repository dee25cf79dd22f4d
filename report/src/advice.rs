//! The levels of detail on one scene, their errors and their cost, and the level that is advised.

use crate::estimate::Estimate;
use crate::quantities::{Number, in_readable_unit};
use crate::shown::{Named, Shown};
use crate::validity;
use rocking::digits::{short, significant};
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::{
    Detail, Frame, Modes, Structure, Watch,
    engine::DEFAULT_TOLERANCE,
    run::{
        LONGEST_REST, Run,
        levels::{self, Choice, Compared, Comparison, Criterion, REFERENCE_TOLERANCE, RULE, Response, Verdict},
        validity::{Limits, Validity},
    },
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// Structures whose levels of detail are shown.
pub trait Advised: Shown + Compared {
    /// The effective frequency of rocking at an angle (Eq 14), Hz.
    fn effective_frequency(_: &Self::Structure, _theta: f64) -> Option<f64> {
        None
    }

    /// Part of the mass above the foundation that no mode of the reference carries.
    fn rigid_share(_: &Self::Structure) -> f64 {
        0.0
    }

    /// Prints what is known without a time history as one more row.
    fn print_estimate(_: &mut String, _: &Run<Self>, _: &Comparison<Self>) -> fmt::Result {
        Ok(())
    }
}

impl Advised for f64 {
    fn effective_frequency(structure: &Structure, theta: f64) -> Option<f64> {
        effective_frequency(structure, theta).ok()
    }

    /// The demand of the whole record (Eqs 21 to 24).
    fn print_estimate(out: &mut String, run: &Run, comparison: &Comparison) -> fmt::Result {
        let demand = match Estimate::new(&run.structure, Some(run.ground), INSTANT_TRANSITION) {
            Ok(estimate) => estimate.demand,
            Err(error) => return writeln!(out, "  {:<10} not possible here: {error}", "estimate"),
        };
        let a_t = comparison.reference.peaks.a_t().magnitude;
        let error = percent(levels::relative(((demand.a_t - a_t).abs(), a_t)));
        writeln!(out, "  {:<10} {:>8} {:>8} {error:>13}", "estimate", "-", "-")
    }
}

impl Advised for Modes {
    fn rigid_share(frame: &Frame) -> f64 {
        frame.rest()[0] / frame.body().m_s
    }
}

/// The peaks of the reference that people read, of several floors the largest.
fn largest<Q: Advised>(run: &Run<Q>, peaks: &Q::Peaks) -> Vec<(Named, f64)> {
    let all = Q::peaks(&run.structure, peaks);
    let largest = |symbol: &&str| {
        let of_symbol = all.iter().filter(|((name, _), _)| name.split('[').next() == Some(symbol));
        let (named, peak) = of_symbol.max_by(|(_, a), (_, b)| a.magnitude.total_cmp(&b.magnitude))?;
        Some((named.clone(), peak.magnitude))
    };
    ["theta", "u", "a_t", "V_t", "M_t"].iter().filter_map(largest).collect()
}

/// The table and the advice on `run` under the ground motion that `title` names, for people. `allowed` is an error and the
/// criteria to which it applies.
pub fn text<Q: Advised>(
    title: &str,
    run: &Run<Q>,
    comparison: &Comparison<Q>,
    allowed: (f64, &[Criterion]),
    limits: Limits,
) -> anyhow::Result<String>
where
    Validity<Q>: Watch<Q>,
{
    let advised = comparison.recommended(allowed.0, allowed.1);
    let mut out = String::new();
    writeln!(out, "Ground motion: {title}")?;
    print_reference(&mut out, run, comparison)?;
    print_levels(&mut out, comparison, advised)?;
    Q::print_estimate(&mut out, run, comparison)?;
    for (choice, error) in &comparison.refused {
        writeln!(out, "  {choice:<10} not possible here: {error:#}")?;
    }
    print_advice(&mut out, comparison, advised, allowed)?;
    match &comparison.without_vertical {
        Some(Ok(level)) => print_vertical(&mut out, level, allowed)?,
        Some(Err(error)) => writeln!(out, "without the vertical component the run is not possible: {error}")?,
        None => (),
    }
    let (found, _) = run.validity(limits)?;
    writeln!(out)?;
    for line in validity::section::<Q>(&run.structure, run.detail, &found, &limits) {
        writeln!(out, "{line}")?;
    }
    Ok(out)
}

fn print_reference<Q: Advised>(out: &mut impl Write, run: &Run<Q>, comparison: &Comparison<Q>) -> fmt::Result {
    let (reference, base) = (&comparison.reference, Q::base(&run.structure));
    let peaks = largest(run, &reference.peaks);
    let shown = |((name, unit), magnitude): &(Named, f64)| match *unit {
        "m" => format!("{name} {} mm", significant(1e3 * magnitude)),
        "m/s2" => format!("{name} {} g", significant(magnitude / base.g)),
        unit => format!("{name} {}", in_readable_unit(*magnitude, unit, significant)),
    };
    let shown: Vec<_> = peaks.iter().map(shown).collect();
    let level =
        if reference.choice.modes.is_some() { reference.choice.to_string() + " modes" } else { "nonlinear".into() };
    writeln!(out, "Reference: {level}, tolerance {REFERENCE_TOLERANCE:e}, {} transitions", reference.transitions)?;
    let rigid = Q::rigid_share(&run.structure);
    if rigid > 0.0 {
        writeln!(out, "  {} % of m_s turns rigidly with the base, also in the reference", percent(rigid))?;
    }
    if reference.ending.overturned().is_none() {
        let limit = significant(LONGEST_REST / base.p_l);
        writeln!(
            out,
            "  it still rocks {limit} s after the record: whether it overturns is not known; see --duration"
        )?;
    }
    writeln!(out, "  peaks: {}", shown.join(", "))?;
    if reference.ending.overturned() == Some(true) {
        return writeln!(out, "  the structure overturns\n");
    }
    let theta = peaks[0].1;
    if theta == 0.0 {
        let estimate = if reference.choice.modes.is_none() { "; the estimate assumes that it does" } else { "" };
        return writeln!(out, "  the base never lifts off{estimate}\n");
    }
    let Some(f_r) = Q::effective_frequency(&run.structure, theta) else { return writeln!(out) };
    writeln!(out, "  effective frequency of rocking at that theta: {} Hz (Eq 14)\n", significant(f_r))
}

fn print_levels<Q: Advised>(
    out: &mut impl Write,
    comparison: &Comparison<Q>,
    advised: Option<&Verdict<Q>>,
) -> fmt::Result {
    const WIDTHS: [usize; 10] = [8, 8, 13, 8, 8, 8, 10, 8, 11, 7];
    let names = comparison.verdicts.iter().map(|verdict| verdict.response.choice.to_string().len());
    let longest = names.max().unwrap_or(0).max("fixed_base".len());
    let mut row = |mark: char, level: &str, cells: &[String]| {
        write!(out, "{mark} {level:<longest$}")?;
        cells.iter().zip(WIDTHS).try_for_each(|(cell, width)| write!(out, " {cell:>width$}"))?;
        writeln!(out)
    };
    let over = ["error of peaks, %", "of histories, %", "", "cost"];
    row(' ', "", &[format!("{:^31} {:^26} {:>10} {:^28}", over[0], over[1], over[2], over[3])])?;
    let headings = ["theta", "u", "a_t, V_t, M_t", "theta", "u", "a_t", "overturns", "steps", "evaluations", "of auto"];
    row(' ', "level", &headings.map(str::to_owned))?;
    for Verdict { response, errors, is_right_about_overturning } in &comparison.verdicts {
        let mark = if advised.is_some_and(|advised| advised.response.choice == response.choice) { '>' } else { ' ' };
        let overturned = match response.ending.overturned() {
            Some(true) => "yes",
            Some(false) => "no",
            None => "unknown",
        };
        let overturns = match (is_right_about_overturning, response.ending.overturned()) {
            (Some(false), _) => format!("{overturned}, wrong"),
            (None, Some(_)) => format!("{overturned} (?)"),
            _ => overturned.into(),
        };
        let counts = [response.work.steps, response.work.evaluations].map(|count| count.to_string());
        let ratio = comparison.cost_over_auto(response).map_or("-".into(), |cost| format!("{cost:.2}"));
        row(mark, &response.choice.to_string(), &[&errors.map(percent)[..], &[overturns], &counts, &[ratio]].concat())?;
    }
    Ok(())
}

/// A level, or the reference, for programs: errors as ratios, peaks in SI units.
#[derive(Serialize)]
pub struct Level {
    level: &'static str,
    /// Modes that are kept, of a structure of many masses.
    #[serde(skip_serializing_if = "Option::is_none")]
    modes: Option<usize>,
    #[serde(flatten)]
    errors: BTreeMap<String, Number>,
    /// None if the structure still rocks at the end.
    overturned: Option<bool>,
    /// None if the structure still rocks at the end of the reference.
    is_right_about_overturning: Option<bool>,
    steps: u64,
    evaluations: u64,
    cost_of_auto: Option<Number>,
    advised: bool,
    #[serde(flatten)]
    peaks: BTreeMap<String, f64>,
}

/// The reference, then the levels.
pub fn rows<Q: Advised>(
    structure: &Q::Structure,
    comparison: &Comparison<Q>,
    advised: Option<&Verdict<Q>>,
) -> Vec<Level> {
    let row = |level, response: &Response<Q>, errors: [f64; 6], is_right_about_overturning, advised| {
        let of_criterion = |(of, error): (&Criterion, f64)| (format!("error_{}", of.name()), Number(error));
        Level {
            level,
            modes: response.choice.modes.map(|[kept, _]| kept),
            errors: Criterion::ALL.iter().zip(errors).map(of_criterion).collect(),
            overturned: response.ending.overturned(),
            is_right_about_overturning,
            steps: response.work.steps,
            evaluations: response.work.evaluations,
            cost_of_auto: comparison.cost_over_auto(response).map(Number),
            advised,
            peaks: Q::peaks(structure, &response.peaks)
                .into_iter()
                .map(|((name, _), of)| (name, of.magnitude))
                .collect(),
        }
    };
    let of_verdict = |level, Verdict { response, errors, is_right_about_overturning }: &Verdict<Q>, is_advised| {
        row(level, response, *errors, *is_right_about_overturning, is_advised)
    };
    let reference = &comparison.reference;
    let reference = row("reference", reference, [0.0; 6], reference.ending.overturned().map(|_| true), false);
    let levels = comparison.verdicts.iter().map(|verdict| {
        let choice = verdict.response.choice;
        let is_advised = advised.is_some_and(|advised| advised.response.choice == choice);
        of_verdict(choice.detail.name(), verdict, is_advised)
    });
    let without_vertical = comparison.without_vertical.iter().flatten();
    let without_vertical = without_vertical.map(|verdict| of_verdict("auto without a_v", verdict, false));
    [reference].into_iter().chain(levels).chain(without_vertical).collect()
}

fn print_advice<Q: Advised>(
    out: &mut impl Write,
    comparison: &Comparison<Q>,
    advised: Option<&Verdict<Q>>,
    (within, criteria): (f64, &[Criterion]),
) -> fmt::Result {
    let names: Vec<_> = criteria.iter().map(|of| of.name()).collect();
    let limit = format!("within {} % in {}", short(100.0 * within), names.join(", "));
    let Some(Verdict { response, .. }) = advised else {
        return writeln!(
            out,
            "\nno level stays {limit}: use detail = nonlinear with a tolerance below {DEFAULT_TOLERANCE:e}"
        );
    };
    let choice = response.choice;
    let modes = match choice.modes {
        Some([kept, all]) if kept < all => format!(" and keep = {kept} of {all} modes"),
        Some([_, 1]) => " with its one mode".to_owned(),
        Some([_, all]) => format!(" with all {all} modes"),
        None => String::new(),
    };
    write!(out, "\nuse detail = {}{modes}: {RULE} {limit}", choice.detail.name())?;
    let auto = Choice { detail: Detail::Auto, ..comparison.reference.choice };
    match comparison.cost_over_auto(response) {
        Some(cost) if choice != auto => writeln!(out, ", at {cost:.2} times the cost of auto"),
        _ => writeln!(out),
    }
}

/// Effect of the vertical component: the differences of the motion on `level` ground.
fn print_vertical<Q: Advised>(
    out: &mut impl Write,
    level: &Verdict<Q>,
    (within, criteria): (f64, &[Criterion]),
) -> fmt::Result {
    let changes: Vec<_> =
        criteria.iter().map(|of| format!("{} by {} %", of.name(), percent(level.errors[*of as usize]))).collect();
    let overturning = match level.is_right_about_overturning {
        Some(false) => ", and whether it overturns",
        _ => "",
    };
    let advice = if level.is_within(within, criteria) { "leave it out" } else { "keep it" };
    writeln!(out, "the vertical component changes {}{overturning}: {advice}", changes.join(", "))
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
