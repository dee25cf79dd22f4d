//! The levels of detail on one scene, their errors and their cost, and the level that is advised.

use crate::estimate::Estimate;
use crate::quantities::{Number, in_readable_unit};
use crate::significant::{short, significant};
use crate::validity;
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::run::record::Record;
use rocking::{
    Detail, Structure,
    engine::DEFAULT_TOLERANCE,
    run::{
        LONGEST_REST, Run,
        levels::{self, Comparison, Criterion, REFERENCE_TOLERANCE, RULE, Response, Verdict},
        peaks::PEAKS,
        validity::Limits,
    },
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// The table and the advice on `run` under the ground motion that `title` names, for people. `allowed` is an error and the
/// criteria to which it applies.
pub fn text(
    title: &str,
    run: &Run,
    comparison: &Comparison,
    allowed: (f64, &[Criterion]),
    limits: Limits,
) -> anyhow::Result<String> {
    let (structure, ground) = (&run.structure, run.ground);
    let advised = comparison.recommended(allowed.0, allowed.1);
    let mut out = String::new();
    writeln!(out, "Ground motion: {title}")?;
    print_reference(&mut out, structure, comparison)?;
    print_levels(&mut out, comparison, advised)?;
    print_estimate(&mut out, structure, ground, comparison)?;
    for (detail, error) in &comparison.refused {
        writeln!(out, "  {:<10} not possible here: {error:#}", detail.name())?;
    }
    print_advice(&mut out, comparison, advised, allowed)?;
    match &comparison.without_vertical {
        Some(Ok(level)) => print_vertical(&mut out, level, allowed)?,
        Some(Err(error)) => writeln!(out, "without the vertical component the run is not possible: {error}")?,
        None => (),
    }
    let (found, _) = run.validity(limits)?;
    writeln!(out)?;
    for line in validity::section::<f64>(structure, run.detail, &found, &limits) {
        writeln!(out, "{line}")?;
    }
    Ok(out)
}

fn print_reference(out: &mut impl Write, structure: &Structure, comparison: &Comparison) -> fmt::Result {
    let reference = &comparison.reference;
    let (peaks, g) = (&reference.peaks, structure.parameters().g);
    let theta = peaks.theta().magnitude;
    let [u, a_t] = [1e3 * peaks.u().magnitude, peaks.a_t().magnitude / g].map(significant);
    let [V_t, M_t] = [(peaks.V_t(), "N"), (peaks.M_t(), "N.m")]
        .map(|(peak, unit)| in_readable_unit(peak.magnitude, unit, significant));
    writeln!(out, "Reference: nonlinear, tolerance {REFERENCE_TOLERANCE:e}, {} transitions", reference.transitions)?;
    if reference.ending.overturned().is_none() {
        let limit = significant(LONGEST_REST / structure.p_l);
        writeln!(
            out,
            "  it still rocks {limit} s after the record: whether it overturns is not known; see --duration"
        )?;
    }
    writeln!(out, "  peaks: theta {} rad, u {u} mm, a_t {a_t} g, V_t {V_t}, M_t {M_t}", significant(theta))?;
    if reference.ending.overturned() == Some(true) {
        return writeln!(out, "  the structure overturns\n");
    }
    if theta == 0.0 {
        return writeln!(out, "  the base never lifts off; the estimate is that of a base that does\n");
    }
    let Ok(f_r) = effective_frequency(structure, theta).map(significant) else { return writeln!(out) };
    writeln!(out, "  effective frequency of rocking at that theta: {f_r} Hz (Eq 14)\n")
}

fn print_levels(out: &mut impl Write, comparison: &Comparison, advised: Option<&Verdict>) -> fmt::Result {
    const WIDTHS: [usize; 10] = [8, 8, 13, 8, 8, 8, 10, 8, 11, 7];
    let mut row = |mark: char, level: &str, cells: &[String]| {
        write!(out, "{mark} {level:<10}")?;
        cells.iter().zip(WIDTHS).try_for_each(|(cell, width)| write!(out, " {cell:>width$}"))?;
        writeln!(out)
    };
    let over = ["error of peaks, %", "of histories, %", "", "cost"];
    row(' ', "", &[format!("{:^31} {:^26} {:>10} {:^28}", over[0], over[1], over[2], over[3])])?;
    let headings = ["theta", "u", "a_t, V_t, M_t", "theta", "u", "a_t", "overturns", "steps", "evaluations", "of auto"];
    row(' ', "level", &headings.map(str::to_owned))?;
    for Verdict { response, errors, is_right_about_overturning } in &comparison.verdicts {
        let mark = if advised.is_some_and(|advised| advised.response.detail == response.detail) { '>' } else { ' ' };
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
        row(mark, response.detail.name(), &[&errors.map(percent)[..], &[overturns], &counts, &[ratio]].concat())?;
    }
    Ok(())
}

/// A level, or the reference, for programs: errors as ratios, peaks in SI units.
#[derive(Serialize)]
pub struct Level {
    level: &'static str,
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
    peaks: BTreeMap<&'static str, f64>,
}

/// The reference, then the levels.
pub fn rows(comparison: &Comparison, advised: Option<&Verdict>) -> Vec<Level> {
    let row = |level, response: &Response, errors: [f64; 6], is_right_about_overturning, advised| {
        let of_criterion = |(of, error): (&Criterion, f64)| (format!("error_{}", of.name()), Number(error));
        Level {
            level,
            errors: Criterion::ALL.iter().zip(errors).map(of_criterion).collect(),
            overturned: response.ending.overturned(),
            is_right_about_overturning,
            steps: response.work.steps,
            evaluations: response.work.evaluations,
            cost_of_auto: comparison.cost_over_auto(response).map(Number),
            advised,
            peaks: PEAKS.iter().map(|of| (of.name, of.of(&response.peaks).magnitude)).collect(),
        }
    };
    let of_verdict = |level, Verdict { response, errors, is_right_about_overturning }: &Verdict| {
        let is_advised = advised.is_some_and(|advised| level == advised.response.detail.name());
        row(level, response, *errors, *is_right_about_overturning, is_advised)
    };
    let reference = &comparison.reference;
    let reference = row("reference", reference, [0.0; 6], reference.ending.overturned().map(|_| true), false);
    let levels = comparison.verdicts.iter().map(|verdict| of_verdict(verdict.response.detail.name(), verdict));
    let without_vertical =
        comparison.without_vertical.iter().flatten().map(|verdict| of_verdict("auto without a_v", verdict));
    [reference].into_iter().chain(levels).chain(without_vertical).collect()
}

/// The demand of the whole record without a time history (Eqs 21 to 24) as one more row.
fn print_estimate(
    out: &mut impl Write,
    structure: &Structure,
    ground: &Record,
    comparison: &Comparison,
) -> anyhow::Result<()> {
    let demand = match Estimate::new(structure, Some(ground), INSTANT_TRANSITION) {
        Ok(estimate) => estimate.demand,
        Err(error) => return Ok(writeln!(out, "  {:<10} not possible here: {error}", "estimate")?),
    };
    let a_t = comparison.reference.peaks.a_t().magnitude;
    let error = percent(levels::relative(((demand.a_t - a_t).abs(), a_t)));
    writeln!(out, "  {:<10} {:>8} {:>8} {error:>13}", "estimate", "-", "-")?;
    Ok(())
}

fn print_advice(
    out: &mut impl Write,
    comparison: &Comparison,
    advised: Option<&Verdict>,
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
    write!(out, "\nuse detail = {}: {RULE} {limit}", response.detail.name())?;
    match comparison.cost_over_auto(response) {
        Some(cost) if response.detail != Detail::Auto => writeln!(out, ", at {cost:.2} times the cost of auto"),
        _ => writeln!(out),
    }
}

/// Effect of the vertical component: the differences of the motion on `level` ground.
fn print_vertical(out: &mut impl Write, level: &Verdict, (within, criteria): (f64, &[Criterion])) -> fmt::Result {
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
