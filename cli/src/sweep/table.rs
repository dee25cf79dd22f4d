//! The table of a population: how often its structures exceed a limit, by intensity, and the curves.
use rocking::digits::significant;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::run::LONGEST_REST;
use rocking_report::quantities::PrintedNumber;
use rocking_sweep::exceedances::{Bin, Exceedances, Fragility, Tally};
use rocking_sweep::fragility::{FEWEST_GROUPS, FragilityCurve};
use serde::Serialize;
use std::fmt::{self, Write};

/// Columns of a limit are this wide, or as wide as its name.
const WIDTH: usize = 18;

pub const BEYOND_THE_RUNS: &str = "beyond the runs";

/// Whether the median of `fragility` is weaker or stronger than the ground motion of every run `of` its population.
pub fn is_beyond_the_runs(of: &Exceedances, fragility: &Fragility) -> bool {
    let lowest = of.bins.iter().map(|bin| bin.lowest).fold(f64::INFINITY, f64::min);
    let highest = of.bins.iter().map(|bin| bin.highest).fold(0.0, f64::max);
    fragility.curve.as_ref().is_ok_and(|curve| !(lowest..=highest).contains(&curve.median))
}

pub fn write(out: &mut impl Write, of: &Exceedances, measure: IntensityMeasure) -> fmt::Result {
    let Exceedances { population, bins, fragilities, failed, still_rocking } = of;
    let (name, unit) = (measure.name(), measure.unit());
    writeln!(out, "{population}")?;
    let mut line = |cells: [&str; 4], of_limit: &dyn Fn(&Fragility) -> String| {
        write!(out, "{:>12} {:>12} {:>12} {:>7}", cells[0], cells[1], cells[2], cells[3])?;
        for fragility in fragilities {
            let width = fragility.limit.to_string().len().max(WIDTH);
            write!(out, "  {:>width$}", of_limit(fragility))?;
        }
        writeln!(out)
    };
    line([&format!("{name}: from"), "mean", &format!("to ({unit})"), "runs"], &|fragility| {
        fragility.limit.to_string()
    })?;
    for (i, Bin { lowest, mean, highest, runs }) in bins.iter().enumerate() {
        let [lowest, mean, highest] = [lowest, mean, highest].map(|intensity| significant(*intensity));
        line([&lowest, &mean, &highest, &runs.to_string()], &|fragility| part(&fragility.tallies[i]))?;
    }
    let of_curve = |fragility: &Fragility, text: &dyn Fn(&FragilityCurve) -> Option<String>| {
        fragility.curve.as_ref().ok().and_then(text).unwrap_or("none".into())
    };
    line(["median", "", &format!("({unit})"), ""], &|of| of_curve(of, &|curve| Some(significant(curve.median))))?;
    let is_beyond = |fragility: &Fragility| is_beyond_the_runs(of, fragility);
    if fragilities.iter().any(is_beyond) {
        line(["", "", "", ""], &|fragility| {
            if is_beyond(fragility) { BEYOND_THE_RUNS.into() } else { String::new() }
        })?;
    }
    for (heading, end) in [("from", 0), ("to", 1)] {
        line(["", "95 %", heading, ""], &|of| {
            of_curve(of, &|curve| curve.median_range().map(|(low, high)| significant([low, high][end])))
        })?;
    }
    line(["dispersion", "", "", ""], &|of| of_curve(of, &|curve| Some(significant(curve.dispersion))))?;
    for Fragility { limit, curve, .. } in fragilities {
        match curve {
            Err(reason) => writeln!(out, "{limit}: no curve: {reason}")?,
            Ok(curve) if curve.certainty.is_none() => writeln!(
                out,
                "{limit}: no 95 % band: it needs {FEWEST_GROUPS} independent records, or structures if there is one record"
            )?,
            Ok(_) => {}
        }
    }
    if fragilities.len() > 1 {
        writeln!(out, "a run that overturns exceeds every limit")?;
    }
    if *failed > 0 {
        writeln!(out, "{failed} failed and are not counted")?;
    }
    if *still_rocking > 0 {
        writeln!(
            out,
            "{still_rocking} still rocked {LONGEST_REST}/p_l after the record: a limit counts them only if they have \
             exceeded it"
        )?;
    }
    writeln!(out)
}

/// A fragility curve with the bins of its runs, for programs.
#[derive(Serialize)]
pub struct Fitted {
    structures: String,
    limit: String,
    measure: String,
    unit: &'static str,
    median: Option<PrintedNumber>,
    median_is_beyond_the_runs: Option<bool>,
    median_from: Option<PrintedNumber>,
    median_to: Option<PrintedNumber>,
    dispersion: Option<PrintedNumber>,
    reason: Option<String>,
    bins: Vec<CountedBin>,
}

#[derive(Serialize)]
struct CountedBin {
    #[serde(flatten)]
    bin: Bin,
    #[serde(flatten)]
    tally: Tally,
}

pub fn curves(populations: &[Exceedances], measure: IntensityMeasure) -> Vec<Fitted> {
    let all = populations.iter().flat_map(|of| of.fragilities.iter().map(move |fragility| (of, fragility)));
    all.map(|(of, fragility)| {
        let Fragility { limit, curve, tallies, .. } = fragility;
        let fitted = curve.as_ref().ok();
        let range = fitted.and_then(FragilityCurve::median_range);
        let bins = of.bins.iter().zip(tallies).map(|(&bin, &tally)| CountedBin { bin, tally });
        Fitted {
            structures: of.population.clone(),
            limit: limit.to_string(),
            measure: measure.name().into(),
            unit: measure.unit(),
            median: fitted.map(|curve| PrintedNumber(curve.median)),
            median_is_beyond_the_runs: fitted.map(|_| is_beyond_the_runs(of, fragility)),
            median_from: range.map(|(from, _)| PrintedNumber(from)),
            median_to: range.map(|(_, to)| PrintedNumber(to)),
            dispersion: fitted.map(|curve| PrintedNumber(curve.dispersion)),
            reason: curve.as_ref().err().map(ToString::to_string),
            bins: bins.collect(),
        }
    })
    .collect()
}

/// The part that exceeds a limit, and of how many.
fn part(tally: &Tally) -> String {
    let Tally { known, exceedances } = tally;
    tally.part().map_or("none".into(), |part| format!("{part:.4} {exceedances:>5}/{known}"))
}
