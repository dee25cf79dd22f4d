//! The command line: write the FMU, simulate a record without a host, show what follows from a structure's parameters.

mod advise;
mod cause;
mod describe;
mod estimate;
mod export;
mod limit_args;
mod options;
mod picture;
mod pulse;
mod pushover;
mod record;
mod record_args;
mod results;
mod scene_args;
mod simulate;
mod structure_args;
mod sweep;
mod talk;
mod view;

use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use fmu_export::Platform;
use rocking_report::message;
use std::env::consts::{ARCH, OS};
use std::{env, io, process::ExitCode, sync::atomic::Ordering};

/// A flexible structure that rocks on its foundation: FMU exporter and simulator.
///
/// A structure is a specimen of the paper (--preset), a file (--parameters), or numbers that determine all of it.
/// Single numbers such as --f-fc 8 replace those of --preset or --parameters. Without any of these the structure is the
/// McManus specimen. Units are SI, angles in rad.
///
/// Results go to standard output, messages to standard error. The text "inf" stands for an infinite number if --format is json.
/// Exit codes: 0 success, also if the reader of the output stops early; 1 failure, with the reason on standard error;
/// 2 wrong use of options.
#[derive(Parser)]
#[command(name = "rocking-fmu", version, long_version = long_version())]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
    /// Print only warnings and errors on standard error
    #[arg(long, global = true, display_order = 1000)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Write the FMU (FMI 2.0 or 3.0)
    #[command(after_help = "Examples:
  rocking-fmu export
  rocking-fmu export --preset evison -o Evison.fmu
  rocking-fmu export --fmi 3
  rocking-fmu export --record RSN77_SFERN_PUL164.AT2 RSN6_IMPVALL.I_I-ELC180.AT2
  rocking-fmu export --record column.txt --dt 0.005 --unit gal
  rocking-fmu export --parameters pier.toml --name Pier1")]
    Export(export::ExportArgs),
    /// Simulate the response to a ground motion record, or free vibration
    ///
    /// Prints the peaks of the response. The option -o writes the response as CSV. The ground acceleration is linear
    /// between samples; the structure starts at rest unless initial values are given. Overturning ends the run.
    #[command(after_help = "Examples:
  rocking-fmu simulate --record RSN77_SFERN_PUL164.AT2 --time-scale 0.2 --scale 1.45
  rocking-fmu simulate --parameters pier.toml --record table.csv --unit g --interval 0.001 -o pier.csv
  rocking-fmu simulate --record column.txt --dt 0.005 --unit gal --format json
  rocking-fmu simulate --record array.csv --column E-W
  rocking-fmu pulse sine --amplitude 0.6 --period 0.5 -o - | rocking-fmu simulate --record -
  rocking-fmu simulate --preset evison --duration 2 --theta-0 0.04 --events impacts.csv --picture wall.svg
  rocking-fmu simulate --parameters building.toml --record RSN77_SFERN_PUL164.AT2 --profile building.svg
  rocking-fmu simulate --record RSN77_SFERN_PUL164.AT2 --time-scale 0.2 --scale 1.45 --detail modal")]
    Simulate(simulate::SimulateArgs),
    /// Write a page that shows the structure in motion, with its histories below
    ///
    /// Writes one HTML file for any browser. The page needs no network. Lengths are true to scale. The page shows the scale of the
    /// motion, and you can change it there.
    #[command(after_help = "Examples:
  rocking-fmu view --record RSN77_SFERN_PUL164.AT2 --time-scale 0.2 --scale 1.45
  rocking-fmu view --preset evison --duration 2 --theta-0 0.04 -o wall.html")]
    View(view::ViewArgs),
    /// Compare the levels of detail on a ground motion record, or free vibration, and recommend one
    ///
    /// Runs every level and shows its error against `nonlinear` at the tolerance 1e-12 and its cost. Names the cheapest
    /// level whose errors stay within --within, or the simplest of equally cheap levels. Shows the demand equations,
    /// which need no time history, in a row of their own.
    #[command(after_help = "Examples:
  rocking-fmu advise --record RSN77_SFERN_PUL164.AT2 --time-scale 0.2 --scale 1.45
  rocking-fmu advise --record RSN77_SFERN_PUL164.AT2 --within 10% --of theta,a_t
  rocking-fmu advise --preset evison --duration 2 --theta-0 0.04 --within 0.1%")]
    Advise(advise::AdviseArgs),
    /// Show the parameters and the derived quantities
    #[command(after_help = "Examples:
  rocking-fmu describe
  rocking-fmu describe --preset evison --f-fc 8 --r 0.9
  rocking-fmu describe --weight 5e5 --weight0 0 --width 3 --alpha-cg 0.25 --period-fc 0.4 --zeta-fc 0.02 --r 0.95
  rocking-fmu describe --template > pier.toml
  rocking-fmu describe --parameters pier.toml")]
    Describe(describe::DescribeArgs),
    /// Estimate demands and frequency without a time history (Eqs 14, 21 to 24)
    ///
    /// The demand of a ground motion comes from its response spectrum; without a record the ground is at rest.
    #[command(after_help = "Examples:
  rocking-fmu estimate --record RSN77_SFERN_PUL164.AT2 --time-scale 0.2 --scale 1.45
  rocking-fmu estimate --preset evison --amplification 1.4 --amplitudes 0.1,0.2,0.3
  rocking-fmu estimate --parameters pier.toml --record table.csv --unit g --format json")]
    Estimate(estimate::EstimateArgs),
    /// Push the structure over slowly: force and moment against displacement, to overturning
    #[command(after_help = "Examples:
  rocking-fmu pushover
  rocking-fmu pushover --preset evison --points 500 -o evison.csv")]
    Pushover(pushover::PushoverArgs),
    /// Run records x scale factors x structures for fragility curves, or pulses for overturning spectra
    ///
    /// A file with records gives probabilities of overturning and fragility curves. A file with pulses gives a map of each
    /// structure over frequency and amplitude. The map shows whether the structure lifts off, stands or overturns, and
    /// after how many impacts.
    ///
    /// Appends a row per run to the CSV file as the runs end. The same command continues a sweep that was stopped. Once
    /// all runs are done, the command only shows the results.
    #[command(after_help = "Examples:
  rocking-fmu sweep fragility.toml
  rocking-fmu sweep fragility.toml -o runs.csv --threads 2
  rocking-fmu sweep spectrum.toml --picture spectrum.svg

A file of records, fragility.toml:
  records = ['records/*.AT2', { file = 'array.csv', column = 'E-W', scale = 0.5 }]  # as the options of `record`
  scale = { from = 0.2, to = 2, count = 10 }
  condition = false           # true: how many digits of each run are sure, by a second run at 1 + 1e-12 times the record
  [limits]
  'theta/alpha_cg' = [0.1, 0.5]
  [[structures]]
  name = 'piers'
  preset = 'mcmanus'
  vary.f_fc = [2, 4, 8]

A file of pulses, spectrum.toml, a map of each structure:
  refine = 1                  # number of times to halve the steps along the boundaries
  condition = false           # true: run each point again at an amplitude larger by the factor 1 + 1e-12
  [pulses]
  shape = 'sine'              # see `pulse --help`; cycles = 1, phase = 0, error = 1e-4
  frequency = { from = 0.5, to = 10, count = 40, log = true }
  amplitude = { from = 0.5, to = 12, count = 40 }
  dimensionless = true        # in units of p_l and g tan(alpha_cg); false: Hz and g
  [[structures]]
  name = 'pier'
  parameters = { m = 1000, m0 = 300, H = 4, B = 0.6, f_fc = 3, zeta_fc = 0.02, r = 0.95 }")]
    Sweep(sweep::SweepArgs),
    /// Find the value of a number at which limits hold in a share of the runs: the least prestress, the largest height
    ///
    /// Runs the structure with values of one number under every record, refines where the limits begin or cease to hold,
    /// and prints the value and the curve over the range. If they begin or cease more than once, all crossings are given.
    #[command(after_help = "Examples:
  rocking-fmu design tendon.toml
  rocking-fmu design tendon.toml -o curve.csv --picture curve.svg

The file, tendon.toml:
  records = ['records/*.AT2']             # records, unit, scale, duration, ... as in a file of `sweep`
  [design]
  vary = 'P_0'                            # any number, such as f_v of ground, k[1] of a storey, slenderness
  between = [0, 2e7]
  limit = ['theta <= 0.5 %', 'a_t <= 0.4 g']  # all must hold; 'stands': it does not overturn
  share = 0.84                            # of the runs
  count = 25                              # values of the first pass; log = true spaces them evenly in their logarithms
  refine = 3                              # times that the step is divided by 8 at each crossing
  [[structures]]
  name = 'pier'
  file = 'pier.toml'")]
    Design(sweep::design::DesignArgs),
    /// Write a pulse as a record: half sine, sine, cosine, Ricker, Mavroeidis and Papageorgiou
    ///
    /// The standard pulses as their papers define them. Straight lines replace the curve within --error, each with the
    /// impulse of the curve. Amplitude and frequency may be in units of g tan(alpha_cg) and p_l of a structure.
    #[command(after_help = "Examples:
  rocking-fmu pulse sine --amplitude 0.6 --period 0.5
  rocking-fmu pulse cosine --amplitude-ratio 2.5 --frequency-ratio 4 --preset evison -o cosine.csv
  rocking-fmu pulse mavroeidis_papageorgiou --amplitude 0.4 --period 1.2 --cycles 2.5 --phase 1.5708
  rocking-fmu pulse ricker --amplitude 0.5 --frequency 1 -o ricker.csv && rocking-fmu simulate --record ricker.csv")]
    Pulse(pulse::PulseArgs),
    /// Show how a record is read, and write it as a table that needs no options
    ///
    /// Prints the samples and their step, the peaks, the duration of shaking, and the velocity and displacement of the
    /// ground at the end. An offset, a wrong column or a wrong unit leaves a velocity or displacement far from 0.
    #[command(after_help = "Examples:
  rocking-fmu record RSN77_SFERN_PUL164.AT2
  rocking-fmu record column.txt --dt 0.005 --unit gal -o record.csv
  rocking-fmu record array.csv --column E-W --format json
  unzip -p records.zip E-W.txt | rocking-fmu record - --dt 0.01 --unit mg")]
    Record(record::RecordCommand),
    /// Print completions for a shell
    #[command(after_help = "Examples:
  rocking-fmu completions bash > ~/.local/share/bash-completion/completions/rocking-fmu
  rocking-fmu completions zsh > ~/.zfunc/_rocking-fmu")]
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: Shell,
    },
}

/// Version, build, and the platforms that an FMU can be for.
fn long_version() -> String {
    let [version, build] = [env!("CARGO_PKG_VERSION"), FlexibleRocking::BUILD];
    let platforms = Platform::ALL.map(Platform::tuple).join(", ");
    format!("{version}\nbuild {build}\nfor {OS} on {ARCH}; packs libraries for {platforms}, as far as they are there")
}

fn main() -> ExitCode {
    let CommandLine { command, quiet } = CommandLine::parse();
    talk::IS_QUIET.store(quiet, Ordering::Relaxed);
    let result = match command {
        Command::Export(args) => export::run(&args, &env::current_exe().unwrap_or_default()),
        Command::Simulate(args) => simulate::run(&args),
        Command::View(args) => view::run(&args),
        Command::Advise(args) => advise::run(&args),
        Command::Describe(args) => describe::run(&args),
        Command::Estimate(args) => estimate::run(&args),
        Command::Pushover(args) => pushover::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Design(args) => sweep::design::run(&args),
        Command::Pulse(args) => pulse::run(&args),
        Command::Record(args) => record::run(&args),
        Command::Completions { shell } => completions(shell),
    };
    match result {
        Err(error) if !is_closed_pipe(&error) => {
            talk::write_line(format_args!("error: {}", message(&error)));
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}

fn completions(shell: Shell) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "rocking-fmu", &mut script);
    // clap_complete's script for bash looks for the commands of a program with a dash under another name than it gives them
    results::print(&String::from_utf8(script)?.replace("rocking__subcmd__fmu", "rocking__fmu"))
}

/// Whether the reader of the output has seen enough, as `head` has.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let is_it = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    };
    error.chain().any(is_it)
}
