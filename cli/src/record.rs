//! `record`: what is understood of a record, and the same as a table that is read without options.
use crate::cause::Cause;
use crate::options::on_command_line;
use crate::record_args::{RecordArgs, RecordOptions, VerticalArgs, help_of_record, say_understood};
use crate::results::FormatArgs;
use crate::talk::write_as;
use rocking::Parameters;
use rocking::estimates::intensity::{arias_intensity, peak_velocity, significant_duration};
use rocking::run::record::Record;
use rocking_report::{output_files::OutputFiles, quantities::NamedValue};
use std::path::PathBuf;

/// Gravity of a record whose unit is g, m/s².
const G: f64 = Parameters::MCMANUS.g;

#[derive(clap::Args)]
pub struct RecordCommand {
    #[arg(value_name = "FILE", help = help_of_record())]
    record: PathBuf,
    #[command(flatten)]
    options: RecordOptions,
    /// The record as CSV of time (s) and acceleration in the unit of its file, scaled, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    #[command(flatten)]
    results: FormatArgs,
}

pub fn run(args: &RecordCommand) -> anyhow::Result<()> {
    args.results.check_beside(args.output.as_deref())?;
    let understood = args.options.understand(&args.record, G, on_command_line)?;
    say_understood("record         ", &understood);
    if let Some(output) = &args.output {
        let file = OutputFiles::of_inputs([args.record.as_path()]).create(output)?;
        write_as(file, "written", understood.tables()?.0.as_bytes())?;
    }
    let (record, output) = (&understood.record, args.output.as_deref());
    let options = RecordOptions { unit: Some(understood.units[0]), ..args.options.clone() };
    let asked = RecordArgs { record: Some(args.record.clone()), vertical: VerticalArgs::default(), options };
    let cause = Cause::of_program().under(&asked, record);
    args.results.print_table(output, (record.title(), G), &cause, &amounts(record))
}

fn amounts(record: &Record) -> Vec<NamedValue> {
    let [velocity, displacement] = record.velocities_and_displacements().last().expect("a record has samples");
    let steps = || record.times().windows(2).map(|pair| pair[1] - pair[0]);
    let [from, until] = significant_duration(record);
    let line = |name, value, unit, description| NamedValue::new(name, value, unit, "", description);
    vec![
        line("samples", record.times().len() as f64, "1", "samples"),
        line("step_min", steps().fold(f64::INFINITY, f64::min), "s", "shortest time between two samples"),
        line("step_max", steps().fold(0.0, f64::max), "s", "longest time between two samples"),
        line("t_start", record.start(), "s", "instant of the first sample"),
        line("t_end", record.end(), "s", "instant of the last sample"),
        line("PGA", record.pga(), "m/s2", "peak ground acceleration"),
        line("PGV", peak_velocity(record), "m/s", "peak ground velocity, at rest before the first sample"),
        line("I_A", arias_intensity(record, G), "m/s", "Arias intensity, pi/(2 g) times the integral of a_g^2"),
        line("D_5-95", until - from, "s", "significant duration: from 5 % to 95 % of the Arias intensity"),
        line("t_5", from, "s", "start of the significant duration"),
        line("v_end", velocity, "m/s", "velocity at the end, a drift unless it is 0"),
        line("d_end", displacement, "m", "displacement at the end"),
    ]
}
