//! Results on standard output: for people, or for programs as JSON, where a number reads back to the same bits.

use crate::cause::Cause;
use crate::talk::say;
use anyhow::ensure;
use clap::ValueEnum;
use rocking_report::quantities::{NamedValue, columns};
use rocking_report::{input, output_files::OutputFile};
use serde::Serialize;
use std::path::Path;

#[derive(clap::Args, Clone, Copy)]
pub struct FormatArgs {
    /// How the results are printed
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = ResultFormat::Text, display_order = 999)]
    format: ResultFormat,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ResultFormat {
    /// Tables to read, six digits
    Text,
    /// JSON in SI units, all digits
    Json,
}

impl FormatArgs {
    pub fn print(self, text: impl FnOnce() -> anyhow::Result<String>, result: &impl Serialize) -> anyhow::Result<()> {
        self.print_beside(None, text, result)
    }

    /// Refuses JSON where standard output has the table that is written to `output`.
    pub fn check_beside(self, output: Option<&Path>) -> anyhow::Result<()> {
        let is_taken = output.is_some_and(input::is_standard);
        ensure!(!(is_taken && self.format == ResultFormat::Json), "-o - and --format json: both go to standard output");
        Ok(())
    }

    /// The same, but on standard error where standard output has the table that is written to `output`.
    pub fn print_beside(
        self,
        output: Option<&Path>,
        text: impl FnOnce() -> anyhow::Result<String>,
        result: &impl Serialize,
    ) -> anyhow::Result<()> {
        let printed = match self.format {
            ResultFormat::Text => text()?,
            ResultFormat::Json => serde_json::to_string_pretty(result)? + "\n",
        };
        if !output.is_some_and(input::is_standard) {
            return print(&printed);
        }
        say!("{}", printed.trim_end());
        Ok(())
    }

    /// Prints `lines` under a `title`, accelerations also in multiples of `g` (m/s²), or with their `cause` as JSON; on
    /// standard error where standard output has the table that is written to `output`.
    pub fn print_table(
        self,
        output: Option<&Path>,
        (title, g): (&str, f64),
        cause: &Cause,
        lines: &[NamedValue],
    ) -> anyhow::Result<()> {
        let text = || Ok(format!("{title}\n{}", columns(lines, g)));
        self.print_beside(output, text, &Traced { cause, rows: lines })
    }
}

/// `lines` under `headings` as CSV; a number reads back to the same bits.
pub fn csv(headings: impl Serialize, lines: impl Iterator<Item = impl Serialize>) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.serialize(headings)?;
    for line in lines {
        writer.serialize(line)?;
    }
    Ok(writer.into_inner()?)
}

#[derive(Serialize)]
pub struct Traced<'a, R> {
    #[serde(flatten)]
    pub cause: &'a Cause,
    pub rows: &'a [R],
}

/// Prints `text`; that it cannot be printed is an error, as in a file.
pub fn print(text: &str) -> anyhow::Result<()> {
    OutputFile::standard_output().write(text.as_bytes())
}
