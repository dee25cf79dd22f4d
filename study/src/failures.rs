//! The gallery of failures: each with a picture, its cause and the remedy that this project uses.

pub mod chatter;
pub mod double_crossing;
pub mod energy_gain;
pub mod fall;
pub mod grazing;
pub mod history;
pub mod overturning;
pub mod zeno;

use crate::chart::{Figure, Panel, Style, colour};
use crate::scene::Scene;
use anyhow::Result;
use minijinja::Value;
use rayon::prelude::*;
use std::path::Path;

/// Style of correct responses.
const RIGHT: Style = Style::line(colour::BLACK, 3);

/// Style of wrong responses.
const WRONG: Style = Style::line(colour::VERMILLION, 2);

/// Style of guide lines.
const GUIDE: Style = Style::dashed(colour::GREY, 1);

/// One failure.
pub struct Exhibit {
    pub key: &'static str,   // name in file names
    pub values: Value,       // of the page's words
    pub shows: &'static str, // description of the picture
    pub panel: Panel,
}

/// Writes `docs/explain/failures.md` with its pictures and numbers; some failures happen under Pacoima Dam and El Centro.
pub fn write(pacoima: &Scene, el_centro: &Scene, docs: &Path) -> Result<()> {
    let exhibits: [&(dyn Fn() -> Result<Exhibit> + Sync); 7] = [
        &|| fall::show(pacoima),
        &double_crossing::show,
        &|| chatter::show(el_centro),
        &zeno::show,
        &grazing::show,
        &overturning::show,
        &energy_gain::show,
    ];
    let entries = exhibits.into_par_iter().map(|show| {
        let Exhibit { key, values, shows, mut panel } = show()?;
        let title = std::mem::take(&mut panel.title);
        let figure = Figure { title, description: shows.into(), columns: 1, panels: vec![panel] };
        figure.save(&docs.join(format!("failure-{key}.svg")))?;
        figure.save_numbers(&docs.join(format!("failure-{key}.csv")))?;
        Ok((key.replace('-', "_"), values))
    });
    let entries = entries.collect::<Result<Vec<_>>>()?;
    crate::page::write(docs, "failures", include_str!("../pages/failures.md"), &Value::from_pairs(entries), "failures")
}
