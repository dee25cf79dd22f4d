//! `advise`: errors and cost of each level of detail on the user's own scene, and the cheapest level that is good enough.

use crate::cause::Cause;
use crate::limit_args::LimitArgs;
use crate::options::one_of;
use crate::results::{FormatArgs, Traced};
use crate::scene_args::MotionArgs;
use anyhow::Context;
use rocking::run::levels::Criterion;
use rocking_sweep::plan::Conditions;

#[derive(clap::Args)]
pub struct AdviseArgs {
    #[command(flatten)]
    motion: MotionArgs,
    /// Largest relative error allowed, such as 5% or 0.05
    #[arg(long, help_heading = "What is allowed", value_name = "ERROR", default_value = "5%", value_parser = relative_error)]
    within: f64,
    /// Results whose errors must not exceed --within. `theta`, `u` and `a_t` are the peaks of rotation, elastic displacement
    /// and acceleration of the top mass, or of the floor where the error is largest; a_t includes the peaks of V_t and M_t. The error of a history is
    /// the largest difference as a fraction of the largest value. Overturning must be predicted right in any case
    #[arg(long, help_heading = "What is allowed", value_name = "LIST", value_parser = one_of(Criterion::ALL.map(|of| (of.name(), of))), num_args = 1.., value_delimiter = ',', default_values = Criterion::ALL.map(Criterion::name))]
    of: Vec<Criterion>,
    #[command(flatten)]
    limits: LimitArgs,
    #[command(flatten)]
    results: FormatArgs,
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

pub fn run(args: &AdviseArgs) -> anyhow::Result<()> {
    let limits = args.limits.limits()?;
    let run = args.motion.load(Conditions::default())?;
    let cause = Cause::of(&args.motion, &run).with_initial(&run.conditions.initial);
    let advice = run.advice(args.within, &args.of).context("detail = nonlinear")?;
    let text = || run.advice_text(&args.motion.ground.title(&run.ground), &advice, &limits);
    args.results.print(text, &Traced { cause: &cause, rows: &advice.rows() })
}
