//! `estimate`: demands without a time history (Eqs 21–24) and the effective frequency of rocking (Eq 14).

use crate::{
    cause::Cause, quantities::NamedValue, record_args::RecordArgs, results::FormatArgs, structure_args::StructureArgs,
};
use anyhow::bail;
use rocking::Structure;
use rocking::estimates::demand::{Demand, INSTANT_TRANSITION};
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::run::record::Record;
use std::f64::consts::TAU;

/// What to estimate.
#[derive(clap::Args)]
pub struct EstimateArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    ground: RecordArgs,
    /// Dynamic amplification C at a transition between rocking phases, 0 to 2; 2 for an instant one
    #[arg(long, value_name = "C", default_value_t = INSTANT_TRANSITION, allow_negative_numbers = true)]
    amplification: f64,
    /// Amplitudes theta/tan(alpha_cg) at which to show the effective frequency
    #[arg(
        long,
        value_name = "LIST",
        num_args = 1..,
        value_delimiter = ',',
        allow_negative_numbers = true,
        default_values_t = [0.1, 0.25, 0.5, 0.75, 0.9]
    )]
    amplitudes: Vec<f64>,
    #[command(flatten)]
    results: FormatArgs,
}

/// Prints the demands, term by term, and the effective frequencies.
pub fn run(args: &EstimateArgs) -> anyhow::Result<()> {
    if let Some(part) = args.amplitudes.iter().find(|part| !(**part > 0.0 && **part < 1.0)) {
        bail!("amplitudes = {part} is out of range: parts above 0 and below 1 are needed");
    }
    let structure = args.structure.load()?;
    let record = args.ground.load(structure.parameters().g)?;
    let Estimate { fixed_base, rocking, .. } = Estimate::new(&structure, record.as_ref(), args.amplification)?;
    let mut lines: Vec<_> = fixed_base.into_iter().chain(rocking).collect();
    for part in &args.amplitudes {
        lines.push(NamedValue {
            name: format!("f_r({part})"),
            value: effective_frequency(&structure, part * structure.tan_alpha_cg)?,
            unit: "Hz",
            equation: "Eq 14",
            description: format!("effective frequency of rocking at theta = {part} tan(alpha_cg)"),
        });
    }
    let (cause, g) = (Cause::new(&structure), structure.parameters().g);
    match &record {
        Some(record) => args.results.print_table(None, (record.title(), g), &cause.under(&args.ground, record), &lines),
        None => args.results.print_table(None, ("ground at rest", g), &cause, &lines),
    }
}

/// What a ground motion asks of a structure without a time history.
pub struct Estimate {
    /// Of the structure on a fixed base (Eq 4); empty without a ground motion.
    pub fixed_base: Vec<NamedValue>,
    /// Of the structure that rocks (Eqs 21 to 24).
    pub demand: Demand,
    /// That term by term, with what it comes from.
    pub rocking: Vec<NamedValue>,
}

impl Estimate {
    /// Of `structure` under `record`, or on ground at rest, with the dynamic amplification `C`, 0 to 2.
    pub fn new(structure: &Structure, record: Option<&Record>, C: f64) -> anyhow::Result<Estimate> {
        let spectral = |record| spectral_acceleration(record, TAU / structure.omega_u, structure.zeta_u);
        let S_a = record.map_or(0.0, spectral);
        let demand = Demand::new(structure, S_a, C)?;
        let fixed_base = record.map_or(Vec::new(), |record| on_fixed_base(structure, record));
        Ok(Estimate { fixed_base, rocking: while_rocking(structure, S_a, C, &demand), demand })
    }
}

/// The ground motion, and what it asks of the structure on a fixed base.
fn on_fixed_base(structure: &Structure, record: &Record) -> Vec<NamedValue> {
    let S_a = spectral_acceleration(record, TAU / structure.omega_fc, structure.parameters().zeta_fc);
    vec![
        NamedValue::new("PGA", record.pga(), "m/s2", "", "peak ground acceleration"),
        NamedValue::new("S_a(T_fc, zeta_fc)", S_a, "m/s2", "Eq 4", "lateral acceleration on a fixed base"),
        NamedValue::new("V_fc", structure.parameters().m * S_a, "N", "Eq 4", "base shear on a fixed base"),
    ]
}

/// The demand while rocking, term by term, and what it comes from.
fn while_rocking(structure: &Structure, S_a: f64, C: f64, demand: &Demand) -> Vec<NamedValue> {
    let &Demand { u_ddot_gr, ground, rocking, impact, a_t, V_t, M_t } = demand;
    vec![
        NamedValue::new(
            "T_u",
            TAU / structure.omega_u,
            "s",
            "before Eq 18",
            "period of the vibration mode while rocking",
        ),
        NamedValue::new("zeta_u", structure.zeta_u, "1", "before Eq 18", "its damping ratio"),
        NamedValue::new("S_a(T_u, zeta_u)", S_a, "m/s2", "after Eq 20", "its absolute spectral acceleration"),
        NamedValue::new("C", C, "1", "Eq 21", "dynamic amplification at a transition between rocking phases"),
        NamedValue::new("u_ddot_gr", u_ddot_gr, "m/s2", "Eq 21", "elastic acceleration as the weight changes sides"),
        NamedValue::new("(1-chi) S_a", ground, "m/s2", "Eq 22", "vibration that the ground excites"),
        NamedValue::new("chi g tan", rocking, "m/s2", "Eq 22", "rocking mode, chi g tan(alpha_cg)"),
        NamedValue::new("C chi g tan", impact, "m/s2", "Eq 22", "vibration that the change of sides excites"),
        NamedValue::new("a_t", a_t, "m/s2", "Eq 22", "lateral acceleration, the sum of these three"),
        NamedValue::new("V_t", V_t, "N", "Eq 23", "base shear m a_t"),
        NamedValue::new("M_t", M_t, "N.m", "Eq 24", "overturning moment m H a_t"),
    ]
}
