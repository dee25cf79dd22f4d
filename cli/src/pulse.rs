//! `pulse`: one of the field's standard ground motions as a CSV file that every other command reads.
use crate::talk::{warning, write_as};
use crate::{cause::Cause, options::one_of, results::FormatArgs, structure_args::StructureArgs};
use clap::{ArgGroup, builder::PossibleValue};
use rocking::Base;
use rocking::estimates::intensity::peak_velocity;
use rocking::run::record::Record;
use rocking_records::{Unit, csv_in, doubt_of_peak};
use rocking_report::{output_files::OutputFiles, quantities::NamedValue};
use rocking_sweep::pulse::{DEFAULT_ERROR, Pulse, Shape, units_of};
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(group(ArgGroup::new("how strong").args(["amplitude", "amplitude_ratio"]).required(true)))]
#[command(group(ArgGroup::new("how fast").args(["frequency", "period", "frequency_ratio"]).required(true)))]
pub struct PulseArgs {
    #[command(flatten)]
    of: OfPulse,
    #[command(flatten)]
    structure: StructureArgs,
    /// Pulse as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv", default_value = "pulse.csv")]
    output: PathBuf,
    #[command(flatten)]
    results: FormatArgs,
}

#[derive(clap::Args)]
#[command(next_help_heading = "Pulse")]
struct OfPulse {
    /// Its shape, with a_p the amplitude, w = 2 pi f, T = 1/f, n and gamma the cycles, phi and nu the phase
    #[arg(value_name = "SHAPE", value_parser = one_of(Shape::ALL.map(|of| (PossibleValue::new(of.name()).help(of.definition()), of))))]
    shape: Shape,
    /// Amplitude a_p of the ground acceleration
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    amplitude: Option<f64>,
    /// Amplitude in units of g tan(alpha_cg) of the structure
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true)]
    amplitude_ratio: Option<f64>,
    /// Frequency
    #[arg(long, value_name = "HZ", allow_hyphen_values = true)]
    frequency: Option<f64>,
    /// Period, 1/frequency: of a half sine too, which lasts half of it
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    period: Option<f64>,
    /// Circular frequency in units of p_l of the structure
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true)]
    frequency_ratio: Option<f64>,
    /// Periods of a sine or cosine [default: 1]; gamma of mavroeidis_papageorgiou [default: 2]
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    cycles: Option<f64>,
    /// Phase of a sine or cosine; nu of mavroeidis_papageorgiou
    #[arg(long, value_name = "RAD", default_value_t = 0.0, allow_hyphen_values = true)]
    phase: f64,
    /// How far the straight lines between samples may be off the curve, in parts of the amplitude
    #[arg(long, value_name = "PART", default_value_t = DEFAULT_ERROR, allow_hyphen_values = true)]
    error: f64,
}

impl OfPulse {
    /// The pulse. Its ratios are to the units that follow from the `base`.
    fn pulse(&self, base: &Base) -> Pulse {
        let &OfPulse { shape, phase, error, .. } = self;
        let (of_amplitude, of_frequency) = units_of(base);
        let ratio = |ratio: Option<f64>, unit| ratio.map(|ratio| ratio * unit);
        let amplitude = ratio(self.amplitude, base.g).or(ratio(self.amplitude_ratio, of_amplitude));
        let frequency = self.frequency.or(self.period.map(f64::recip)).or(ratio(self.frequency_ratio, of_frequency));
        let asked = "clap asks for one of them";
        let pulse = Pulse::new(shape, amplitude.expect(asked), frequency.expect(asked));
        Pulse { cycles: self.cycles.unwrap_or(pulse.cycles), phase, error, ..pulse }
    }
}

pub fn run(args: &PulseArgs) -> anyhow::Result<()> {
    args.results.check_beside(Some(&args.output))?;
    let structure = args.structure.load_any()?;
    let pulse = args.of.pulse(structure.base());
    let record = pulse.record()?;
    doubt_of_peak(&record, structure.base().g).iter().for_each(|doubt| warning!("{}: {doubt}", record.title()));
    let file = OutputFiles::of_inputs(args.structure.input()).create(&args.output)?;
    write_as(file, "pulse", csv_in(&record, [Unit::MetrePerSecondSquared; 2]).0.as_bytes())?;
    let (title, cause) = ((record.title(), structure.base().g), Cause::new(structure.clone()));
    args.results.print_table(Some(&args.output), title, &cause, &amounts(&pulse, &record, structure.base()))
}

/// Measures of the pulse, alone and in the units that follow from the `base`.
fn amounts(pulse: &Pulse, record: &Record, base: &Base) -> Vec<NamedValue> {
    let (of_amplitude, of_frequency) = units_of(base);
    let [velocity, displacement] = record.velocities_and_displacements().last().expect("a record has samples");
    let line = |name, value, unit, description| NamedValue::new(name, value, unit, "", description);
    vec![
        line("samples", record.times().len() as f64, "1", "samples"),
        line("a_p", pulse.amplitude, "m/s2", "amplitude"),
        line("PGA", record.pga(), "m/s2", "peak ground acceleration of the straight lines"),
        line("PGV", peak_velocity(record), "m/s", "peak ground velocity"),
        line("v_end", velocity, "m/s", "velocity at the end"),
        line("d_end", displacement, "m", "displacement at the end"),
        line("f", pulse.frequency, "Hz", "frequency"),
        line("T", 1.0 / pulse.frequency, "s", "period"),
        line("duration", pulse.duration(), "s", "of the pulse itself"),
        line("a_p/(g tan)", pulse.amplitude / of_amplitude, "1", "amplitude over g tan(alpha_cg) of the structure"),
        line("omega/p_l", pulse.frequency / of_frequency, "1", "circular frequency over p_l of the structure"),
    ]
}
