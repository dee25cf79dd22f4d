//! `estimate`: demands without a time history (Eqs 21–24) and the effective frequency of rocking (Eq 14).

use crate::{cause::Cause, record_args::RecordArgs, results::FormatArgs, structure_args::StructureArgs};
use anyhow::bail;
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking_report::{estimate::Estimate, quantities::NamedValue};

#[derive(clap::Args)]
pub struct EstimateArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    ground: RecordArgs,
    /// Dynamic amplification C at a transition between rocking phases, 0 to 2; 2 for an instant one
    #[arg(long, value_name = "C", default_value_t = INSTANT_TRANSITION, allow_hyphen_values = true)]
    amplification: f64,
    /// Amplitudes theta/tan(alpha_cg) at which to show the effective frequency
    #[arg(
        long,
        value_name = "LIST",
        num_args = 1..,
        value_delimiter = ',',
        allow_hyphen_values = true,
        default_values_t = [0.1, 0.25, 0.5, 0.75, 0.9]
    )]
    amplitudes: Vec<f64>,
    #[command(flatten)]
    results: FormatArgs,
}

pub fn run(args: &EstimateArgs) -> anyhow::Result<()> {
    if let Some(part) = args.amplitudes.iter().find(|part| !(**part > 0.0 && **part < 1.0)) {
        bail!("amplitudes = {part} is out of range: parts above 0 and below 1 are needed");
    }
    let structure = *args.structure.load_any()?.one_mass("estimate")?;
    let record = args.ground.load(structure.parameters().g)?.map(|understood| understood.record);
    let Estimate { terms: mut lines, .. } = Estimate::new(&structure, record.as_ref(), args.amplification)?;
    for part in &args.amplitudes {
        lines.push(NamedValue {
            name: format!("f_r({part})"),
            value: effective_frequency(&structure, part * structure.base().tan_alpha_cg)?,
            unit: "Hz",
            equation: "Eq 14",
            description: format!("effective frequency of rocking at theta = {part} tan(alpha_cg)"),
        });
    }
    let (cause, g) = (Cause::new(structure), structure.parameters().g);
    match &record {
        Some(record) => args.results.print_table(None, (record.title(), g), &cause.under(&args.ground, record), &lines),
        None => args.results.print_table(None, ("ground at rest", g), &cause, &lines),
    }
}
