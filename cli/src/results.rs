//! Results on standard output: for people, or for programs as JSON or CSV, where a number reads back to the same bits.

use crate::output_files::{OutputFile, OutputFiles};
use clap::ValueEnum;
use serde::Serialize;
use std::io::{Write, stdout};
use std::path::Path;

/// How results are printed.
#[derive(clap::Args, Clone, Copy)]
pub struct FormatArgs {
    /// How the results are printed
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = Format::Text, display_order = 999)]
    pub format: Format,
}

impl FormatArgs {
    /// Keeps a table from standard output where results for a program go there.
    pub fn reserve(&self, files: &mut OutputFiles) {
        if self.format != Format::Text {
            files.reserve_standard_output("what --format asks for");
        }
    }
}

/// For whom results are printed.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Tables to read, six digits
    Text,
    /// JSON in SI units, all digits
    Json,
    /// CSV in SI units, all digits
    Csv,
}

/// Prints `result` as JSON.
pub fn print_json(result: &impl Serialize) -> anyhow::Result<()> {
    print(&format!("{}\n", serde_json::to_string_pretty(result)?))
}

/// Prints `rows` as JSON, or as CSV under the names of their fields.
pub fn print_rows(format: Format, rows: &[impl Serialize]) -> anyhow::Result<()> {
    if format == Format::Json {
        return print_json(&rows);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| writer.serialize(row))?;
    print(&String::from_utf8(writer.into_inner()?)?)
}

/// Prints `text`; that it cannot be printed is an error, as in a file.
pub fn print(text: &str) -> anyhow::Result<()> {
    let mut out = stdout().lock();
    OutputFile::named(Path::new("-"), out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}
