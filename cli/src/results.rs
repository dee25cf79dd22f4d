//! Results on standard output: for people, or for programs as JSON or CSV, where a number reads back to the same bits.

use crate::cause::Cause;
use crate::output_files::{OutputFile, OutputFiles};
use crate::talk::say;
use clap::ValueEnum;
use serde::{Serialize, Serializer};
use std::path::Path;

/// How results are printed.
#[derive(clap::Args, Clone, Copy)]
pub struct FormatArgs {
    /// How the results are printed
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = Format::Text, display_order = 999)]
    pub format: Format,
}

impl FormatArgs {
    /// The files of a command that reads `inputs` and prints its results so.
    pub fn files<'a>(&self, inputs: impl IntoIterator<Item = &'a Path>) -> OutputFiles {
        let mut files = OutputFiles::of_inputs(inputs);
        if self.format != Format::Text {
            files.reserve_standard_output("what --format asks for");
        }
        files
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

/// A number that may be infinite, for which JSON has no number: it is the text "inf" there, as in a table.
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Number(value) = *self;
        if value.is_finite() { serializer.serialize_f64(value) } else { serializer.collect_str(&value) }
    }
}

/// Rows and what they come from.
#[derive(Serialize)]
struct Traced<'a, R> {
    #[serde(flatten)]
    cause: &'a Cause,
    rows: &'a [R],
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
    print(&String::from_utf8(csv(rows)?)?)
}

/// Prints `rows` with their `cause`: around them in JSON, behind each of them in CSV.
pub fn print_traced(format: Format, cause: &Cause, rows: &[impl Serialize]) -> anyhow::Result<()> {
    if format == Format::Json {
        return print_json(&Traced { cause, rows });
    }
    let rows = csv(rows)?;
    let (headings, values): (Vec<_>, Vec<_>) = cause.columns().into_iter().unzip();
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (i, line) in csv::ReaderBuilder::new().has_headers(false).from_reader(rows.as_slice()).records().enumerate() {
        let line = line?;
        let of_cause = if i == 0 { &headings } else { &values };
        writer.write_record(line.iter().chain(of_cause.iter().map(String::as_str)))?;
    }
    print(&String::from_utf8(writer.into_inner()?)?)
}

fn csv(rows: &[impl Serialize]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| writer.serialize(row))?;
    Ok(writer.into_inner()?)
}

/// Prints `text`, or says it where standard output has the table that is written to `output`.
pub fn print_beside(output: Option<&Path>, text: &str) -> anyhow::Result<()> {
    if output != Some(Path::new("-")) {
        return print(text);
    }
    say!("{}", text.trim_end());
    Ok(())
}

/// Prints `text`; that it cannot be printed is an error, as in a file.
pub fn print(text: &str) -> anyhow::Result<()> {
    OutputFile::standard_output().write(text.as_bytes())
}
