//! The results of the study as tables (CSV). `python -m evidence` draws them and fills the pages with their numbers.

use anyhow::Result;
use std::path::Path;

/// A curve: its name, and its points.
pub type ChartLine = (String, Vec<(f64, f64)>);

pub fn series(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> ChartLine {
    (name.into(), points.into_iter().collect())
}

/// Values of a page's words, by their names.
pub type PageValues = Vec<(&'static str, String)>;

/// The values of this name each.
pub fn values<const N: usize>(all: [(&'static str, &dyn ToString); N]) -> PageValues {
    all.map(|(name, value)| (name, value.to_string())).into()
}

pub fn save_series(path: &Path, all: &[ChartLine]) -> Result<()> {
    let rows = all.iter().flat_map(|(name, points)| points.iter().map(move |(x, y)| (name, x, y)));
    save(path, "series,x,y", rows.map(|(name, x, y)| [name.clone(), format!("{x:.6e}"), format!("{y:.6e}")]))
}

/// Writes a table with these columns, which commas separate.
pub fn save<R: IntoIterator<Item = String>>(
    path: &Path,
    columns: &str,
    rows: impl IntoIterator<Item = R>,
) -> Result<()> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record(columns.split(','))?;
    for row in rows {
        csv.write_record(row)?;
    }
    Ok(csv.flush()?)
}
