//! `advise`: every level of detail on the user's own scene, its errors and its cost, and the cheapest that will do.

mod level;

use crate::{
    scene_args::{GroundArgs, InitialArgs},
    significant::significant,
    structure_args::StructureArgs,
};
use anyhow::Context;
use clap::{ValueEnum, builder::PossibleValue};
use level::{Response, Scene};
use rocking::{
    Detail, Engine, Parameters, Structure,
    demand::{Demand, INSTANT_TRANSITION},
    effective_frequency::effective_frequency,
    engine::{DEFAULT_TOLERANCE, Work},
    record::Record,
    response_spectrum::spectral_acceleration,
};
use std::f64::consts::TAU;
use std::io::{self, Write, stdout};

/// What to compare, and what is allowed.
#[derive(clap::Args)]
pub struct AdviseArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    ground: GroundArgs,
    #[command(flatten)]
    initial: InitialArgs,
    #[command(flatten)]
    allowed: AllowedArgs,
}

#[derive(clap::Args)]
#[command(next_help_heading = "What is allowed")]
struct AllowedArgs {
    /// Largest relative error allowed, such as 5% or 0.05
    #[arg(long, value_name = "ERROR", default_value = "5%", value_parser = relative_error)]
    within: f64,
    /// What must stay within it; overturning must always be predicted right
    #[arg(long, value_name = "LIST", value_enum, value_delimiter = ',', default_values_t = Measure::value_variants().to_vec())]
    of: Vec<Measure>,
}

/// What a level's error is measured by.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Measure {
    /// Peak rotation
    Theta,
    /// Peak elastic displacement
    U,
    /// Peak acceleration of the top mass, and with it V_t = m a_t and M_t = m H a_t
    #[value(name = "a_t", aliases = ["V_t", "M_t"])]
    At,
    /// Rotation over time: largest difference over the largest rotation
    History,
}

fn relative_error(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let value = match text.strip_suffix('%') {
        Some(percent) => number(percent).map(|percent| percent / 100.0),
        None => number(text),
    };
    value.filter(|value| *value > 0.0 && *value < 1.0).ok_or_else(|| {
        "more than 0 and less than 100 % is needed, with a percent sign or as a ratio: 5% or 0.05".into()
    })
}

/// The levels that are compared, the one of the fewest equations first.
const SIMPLEST_FIRST: [Detail; 6] =
    [Detail::FixedBase, Detail::Rigid, Detail::Modal, Detail::Linear, Detail::Auto, Detail::Nonlinear];

/// Tolerance of the run that all others are measured by.
const REFERENCE_TOLERANCE: f64 = 1e-12;

/// Costs within this factor of the least count as the same: the equations then decide, not what the clock shows.
const SAME_COST: f64 = 2.0;

/// Timed runs per level, of which the fastest counts: whatever else the machine does only slows a run down.
const TIMED_RUNS: usize = 7;

/// How a level did.
struct Verdict {
    detail: Detail,
    /// Relative errors, in the order of [`Measure`].
    errors: [f64; 4],
    overturned: bool,
    is_right_about_overturning: bool,
    seconds_per_sample: f64,
    work: Work,
}

impl Verdict {
    /// Of the level's `response`, its cost not known yet.
    fn of(detail: Detail, response: &Response, reference: &Response) -> Verdict {
        Verdict {
            detail,
            errors: response.errors(reference),
            overturned: response.overturned,
            is_right_about_overturning: response.overturned == reference.overturned,
            seconds_per_sample: f64::INFINITY,
            work: Work::default(),
        }
    }

    fn is_within(&self, allowed: &AllowedArgs) -> bool {
        let error = |measure: &Measure| self.errors[*measure as usize];
        self.is_right_about_overturning && allowed.of.iter().map(error).all(|error| error <= allowed.within)
    }
}

/// The cheapest of `verdicts`, which come in the order of [`SIMPLEST_FIRST`], that stays within what is allowed; of
/// those of the same cost the simplest.
fn recommended<'a>(verdicts: &'a [Verdict], allowed: &AllowedArgs) -> Option<&'a Verdict> {
    let admitted = || verdicts.iter().filter(|verdict| verdict.is_within(allowed));
    let least = admitted().map(|verdict| verdict.seconds_per_sample).fold(f64::INFINITY, f64::min);
    admitted().find(|verdict| verdict.seconds_per_sample <= SAME_COST * least)
}

/// Runs the levels and prints the table and the advice.
pub fn run(args: &AdviseArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let ground = args.ground.load(structure.parameters().g)?;
    let initial = args.initial.state();
    let (start, end) = args.ground.span(&ground);
    let scene = Scene::new(&structure, &ground, end, args.ground.free_vibration_interval());
    let engine = |detail, tolerance| Engine::with_detail(structure, initial, start, tolerance, detail);
    let reference = scene.response(engine(Detail::Nonlinear, REFERENCE_TOLERANCE)?).context("detail = nonlinear")?;

    let mut verdicts = Vec::new();
    let mut refusals = Vec::new();
    for detail in SIMPLEST_FIRST {
        let judge =
            || anyhow::Ok(Verdict::of(detail, &scene.response(engine(detail, DEFAULT_TOLERANCE)?)?, &reference));
        match judge() {
            Ok(verdict) => verdicts.push(verdict),
            Err(error) => refusals.push((detail, error)),
        }
    }
    for _ in 0..TIMED_RUNS {
        for verdict in &mut verdicts {
            let (seconds_per_sample, work) = scene.cost(engine(verdict.detail, DEFAULT_TOLERANCE)?)?;
            verdict.seconds_per_sample = verdict.seconds_per_sample.min(seconds_per_sample);
            verdict.work = work;
        }
    }

    let mut out = stdout().lock();
    let [start, end] = [start, end].map(significant);
    writeln!(out, "Ground motion: {}, {start} to {end} s, {} samples", ground.title(), scene.samples())?;
    print_reference(&mut out, &structure, &reference)?;
    let advised = recommended(&verdicts, &args.allowed);
    print_levels(&mut out, &verdicts, advised)?;
    print_estimate(&mut out, &structure, &ground, &reference)?;
    for (detail, error) in refusals {
        writeln!(out, "  {:<10} not possible here: {error:#}", detail.name())?;
    }
    print_advice(&mut out, &verdicts, advised, &args.allowed)?;
    Ok(())
}

fn print_reference(out: &mut impl Write, structure: &Structure, reference: &Response) -> io::Result<()> {
    let &Parameters { m, H, g, .. } = structure.parameters();
    let [theta, u, a_t] = reference.peaks;
    let shown = [theta, 1e3 * u, a_t / g, m * a_t, m * H * a_t].map(significant);
    let [theta_shown, u, a_t, V_t, M_t] = shown;
    writeln!(out, "Reference: nonlinear, tolerance {REFERENCE_TOLERANCE:e}, {} transitions", reference.transitions)?;
    writeln!(out, "  peaks: theta {theta_shown} rad, u {u} mm, a_t {a_t} g, V_t {V_t} N, M_t {M_t} N.m")?;
    if theta == 0.0 {
        return writeln!(out, "  the base never lifts off; the estimate is that of a base that does\n");
    }
    let f_r = significant(effective_frequency(structure, theta));
    writeln!(out, "  effective frequency of rocking at that theta: {f_r} Hz (Eq 14)\n")
}

fn print_levels(out: &mut impl Write, verdicts: &[Verdict], advised: Option<&Verdict>) -> io::Result<()> {
    writeln!(out, "  {:<10} {:^39} {:>10} {:>17}", "", "error, % of the reference", "", "cost")?;
    writeln!(
        out,
        "  {:<10} {:>8} {:>8} {:>13} {:>8} {:>10} {:>10} {:>7} {:>11}",
        "level", "theta", "u", "a_t, V_t, M_t", "history", "overturns", "us/sample", "of auto", "evaluations"
    )?;
    let auto = verdicts.iter().find(|verdict| verdict.detail == Detail::Auto);
    for verdict in verdicts {
        let mark = if advised.is_some_and(|advised| advised.detail == verdict.detail) { '>' } else { ' ' };
        let [theta, u, a_t, history] = verdict.errors.map(percent);
        let overturned = if verdict.overturned { "yes" } else { "no" };
        let overturns =
            if verdict.is_right_about_overturning { overturned.into() } else { format!("{overturned}, wrong") };
        let ratio =
            auto.map_or("-".into(), |auto| format!("{:.2}", verdict.seconds_per_sample / auto.seconds_per_sample));
        writeln!(
            out,
            "{mark} {:<10} {theta:>8} {u:>8} {a_t:>13} {history:>8} {overturns:>10} {:>10.3} {ratio:>7} {:>11}",
            verdict.detail.name(),
            1e6 * verdict.seconds_per_sample,
            verdict.work.evaluations
        )?;
    }
    Ok(())
}

/// The demand of the whole record without a time history (Eqs 21 to 24) as one more row.
fn print_estimate(
    out: &mut impl Write,
    structure: &Structure,
    ground: &Record,
    reference: &Response,
) -> anyhow::Result<()> {
    let S_a = spectral_acceleration(ground, TAU / structure.omega_u, structure.zeta_u);
    let demand = Demand::new(structure, S_a, INSTANT_TRANSITION)?;
    let [_, _, a_t] = reference.peaks;
    let error = percent(level::relative_error(demand.a_t, a_t));
    writeln!(
        out,
        "  {:<10} {:>8} {:>8} {error:>13} {:>8} {:>10} {:>10} {:>7} {:>11}",
        "estimate", "-", "-", "-", "-", "-", "-", "-"
    )?;
    Ok(())
}

fn print_advice(
    out: &mut impl Write,
    verdicts: &[Verdict],
    advised: Option<&Verdict>,
    allowed: &AllowedArgs,
) -> io::Result<()> {
    let named: Vec<_> = allowed.of.iter().filter_map(ValueEnum::to_possible_value).collect();
    let names: Vec<_> = named.iter().map(PossibleValue::get_name).collect();
    let limit = format!("within {} % in {}", shortest_percent(allowed.within), names.join(", "));
    let Some(Verdict { detail, seconds_per_sample, .. }) = advised else {
        return writeln!(
            out,
            "\nno level stays {limit}: use detail = nonlinear with a tolerance below {DEFAULT_TOLERANCE:e}"
        );
    };
    write!(out, "\nuse detail = {}: of the cheapest levels {limit} the simplest", detail.name())?;
    match verdicts.iter().find(|verdict| verdict.detail == Detail::Auto) {
        Some(auto) if *detail != Detail::Auto => {
            writeln!(out, ", at {:.2} times the cost of auto", seconds_per_sample / auto.seconds_per_sample)
        }
        _ => writeln!(out),
    }
}

/// A ratio in percent, as it was most likely written.
fn shortest_percent(ratio: f64) -> f64 {
    format!("{:.12e}", 100.0 * ratio).parse().expect("a number in Rust's own notation")
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
    use super::*;

    fn verdict(detail: Detail, errors: [f64; 4], cost: f64) -> Verdict {
        Verdict {
            detail,
            errors,
            overturned: false,
            is_right_about_overturning: true,
            seconds_per_sample: cost,
            work: Work::default(),
        }
    }

    fn advice(verdicts: &[Verdict], within: f64, of: &[Measure]) -> Option<Detail> {
        recommended(verdicts, &AllowedArgs { within, of: of.into() }).map(|verdict| verdict.detail)
    }

    #[test]
    fn the_cheapest_level_within_the_limit_is_advised_and_of_equals_the_simplest() {
        let all = Measure::value_variants();
        let mut verdicts = [
            verdict(Detail::FixedBase, [1.0, 0.5, 0.5, 1.0], 1.0),
            verdict(Detail::Rigid, [0.01, 1.0, 0.2, 0.01], 9.0),
            verdict(Detail::Modal, [0.04, 0.03, 0.03, 0.06], 2.9),
            verdict(Detail::Linear, [0.02, 0.01, 0.01, 0.03], 2.0),
            verdict(Detail::Auto, [0.0; 4], 8.0),
        ];
        assert_eq!(advice(&verdicts, 0.1, all), Some(Detail::Modal), "1.45 times the least cost counts as the same");
        assert_eq!(advice(&verdicts, 0.05, all), Some(Detail::Linear), "the history of modal is off by 6 %");
        assert_eq!(advice(&verdicts, 0.05, &[Measure::Theta, Measure::At]), Some(Detail::Modal));
        assert_eq!(advice(&verdicts, 0.015, &[Measure::Theta]), Some(Detail::Rigid));
        assert_eq!(advice(&verdicts, 0.001, all), Some(Detail::Auto));
        verdicts[3].is_right_about_overturning = false;
        assert_eq!(advice(&verdicts, 0.05, all), Some(Detail::Auto));
        assert_eq!(advice(&verdicts[..4], 0.001, all), None);
    }

    #[test]
    fn a_percent_sign_or_a_ratio() {
        assert_eq!(relative_error("5%"), Ok(0.05));
        assert_eq!(relative_error("0.05"), Ok(0.05));
        assert_eq!(relative_error("0.1 %"), Ok(0.001));
        for nonsense in ["5", "100%", "0", "0%", "-5%", "nan", "inf%", "five", "%", ""] {
            assert!(relative_error(nonsense).is_err(), "{nonsense}");
        }
    }

    #[test]
    fn nothing_is_not_a_number() {
        assert_eq!(level::relative_error(0.0, 0.0), 0.0);
        assert_eq!(level::relative_error(0.1, 0.0), f64::INFINITY);
        assert_eq!([0.0, 3e-14, 2.4e-5, 0.0354, f64::INFINITY].map(percent), ["0", "<1e-9", "2e-3", "3.54", "inf"]);
        assert_eq!(
            [0.07, 0.05, 1e-7, 1e-3].map(|ratio| shortest_percent(ratio).to_string()),
            ["7", "5", "0.00001", "0.1"]
        );
    }
}
