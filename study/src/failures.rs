//! The gallery of failures: each with a picture, its cause and the remedy that this project uses.

pub mod chatter;
pub mod double_crossing;
pub mod energy_gain;
pub mod fall;
pub mod grazing;
pub mod history;
pub mod overturning;
pub mod zeno;

use crate::chart::{Entry, Figure, Panel, Style, colour};
use crate::scene::Scene;
use anyhow::Result;
use indicatif::ProgressBar;
use minijinja::Value;
use rayon::prelude::*;
use std::path::Path;

/// What is right is drawn so.
const RIGHT: Style = Style::line(colour::BLACK, 3);

/// What is wrong is drawn so.
const WRONG: Style = Style::line(colour::VERMILLION, 2);

/// One failure.
pub struct Exhibit {
    pub key: &'static str, // name in file names
    pub title: &'static str,
    pub values: Value, // of the page's words
    pub panels: Vec<Panel>,
    pub legend_columns: usize,
    pub legend: Vec<Entry>,
}

/// The failures, each as a function of the scenes under Pacoima Dam and El Centro.
type Show = fn(&Scenes) -> Result<Exhibit>;

/// The scenes in which some of the failures happen.
pub struct Scenes {
    pub pacoima: Scene,
    pub el_centro: Scene,
}

const EXHIBITS: [Show; 7] = [
    |scenes| fall::show(&scenes.pacoima),
    |_| double_crossing::show(),
    |scenes| chatter::show(&scenes.el_centro),
    |_| zeno::show(),
    |_| grazing::show(),
    |_| overturning::show(),
    |_| energy_gain::show(),
];

/// Writes `docs/explain/failures.md` with its pictures and numbers.
pub fn write(scenes: &Scenes, docs: &Path, progress: &ProgressBar) -> Result<()> {
    progress.inc_length(EXHIBITS.len() as u64);
    let entries = EXHIBITS
        .par_iter()
        .map(|show| {
            let Exhibit { key, title, values, panels, legend_columns, legend } = show(scenes)?;
            progress.set_message(title);
            let figure = Figure { title: title.into(), panel: (600, 380), columns: 2, panels, legend_columns, legend };
            figure.save(&docs.join(format!("failure-{key}.svg")))?;
            figure.save_numbers(&docs.join(format!("failure-{key}.csv")))?;
            progress.inc(1);
            Ok((key.replace('-', "_"), values))
        })
        .collect::<Result<Vec<_>>>()?;
    crate::page::write(docs, "failures", include_str!("../pages/failures.md"), Value::from_pairs(entries))
}
