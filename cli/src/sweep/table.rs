//! What a sweep prints of a population: how often its structures exceed a limit, by intensity, and the curves.
use crate::significant::significant;
use rocking::{
    fragility::{FEWEST_GROUPS, FragilityCurve},
    intensity::IntensityMeasure,
    run::LONGEST_REST,
    run::exceedances::{Bin, Exceedances, Fragility, Tally},
};
use std::io::{self, Write};

/// Columns of a limit are this wide, or as wide as its name.
const WIDTH: usize = 18;

/// Prints one population, its intensities in `measure`.
pub fn print(out: &mut impl Write, of: &Exceedances, measure: IntensityMeasure) -> io::Result<()> {
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
                "{limit}: no 95 % band: it takes {FEWEST_GROUPS} records that do not depend on each other, or structures \
                 where there is one record"
            )?,
            Ok(_) => {}
        }
    }
    if *failed > 0 {
        writeln!(out, "{failed} failed and are not counted")?;
    }
    if *still_rocking > 0 {
        writeln!(
            out,
            "{still_rocking} still rocked {LONGEST_REST}/p_l after the record: counted where a limit was exceeded, and \
             else not"
        )?;
    }
    writeln!(out)
}

/// The part that exceeds a limit, and of how many.
fn part(tally: &Tally) -> String {
    let Tally { known, exceedances } = tally;
    tally.part().map_or("none".into(), |part| format!("{part:.4} {exceedances:>5}/{known}"))
}
