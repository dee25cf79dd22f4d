//! The gallery of failures: each with a picture, its cause and the remedy that this project uses.

pub mod chatter;
pub mod double_crossing;
pub mod energy_gain;
pub mod fall;
pub mod grazing;
pub mod history;
pub mod overturning;
pub mod zeno;

use crate::chart::{Figure, Style, colour};
use crate::scene::Scene;
use anyhow::Result;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// What is right is drawn so.
const RIGHT: Style = Style::line(colour::BLACK, 3);

/// What is wrong is drawn so.
const WRONG: Style = Style::line(colour::VERMILLION, 2);

/// One failure.
pub struct Exhibit {
    /// Name in file names.
    pub key: &'static str,
    /// Its name.
    pub title: &'static str,
    /// Why it happens, in two sentences.
    pub cause: String,
    /// What this project does about it.
    pub remedy: String,
    /// What the picture shows.
    pub caption: String,
    /// The picture.
    pub figure: Figure,
}

/// The failures, each as a function of the scenes under Pacoima Dam and El Centro.
type Show = fn(&Scenes) -> Result<Exhibit>;

/// The scenes in which some of the failures happen.
pub struct Scenes {
    /// McManus's specimen under Pacoima Dam.
    pub pacoima: Scene,
    /// McManus's specimen under El Centro.
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

/// The page.
#[derive(Serialize)]
struct Page {
    entries: Vec<Entry>,
}

/// An exhibit as the page shows it.
#[derive(Serialize)]
struct Entry {
    key: &'static str,
    title: &'static str,
    cause: String,
    remedy: String,
    caption: String,
}

/// Writes `docs/failures.md` with its pictures and numbers.
pub fn write(scenes: &Scenes, docs: &Path, progress: &ProgressBar) -> Result<()> {
    progress.inc_length(EXHIBITS.len() as u64);
    let entries = EXHIBITS
        .par_iter()
        .map(|show| {
            let exhibit = show(scenes)?;
            progress.set_message(exhibit.title);
            exhibit.figure.save(&docs.join(format!("failure-{}.svg", exhibit.key)))?;
            exhibit.figure.save_numbers(&docs.join(format!("failure-{}.csv", exhibit.key)))?;
            progress.inc(1);
            let Exhibit { key, title, cause, remedy, caption, .. } = exhibit;
            Ok(Entry { key, title, cause, remedy, caption })
        })
        .collect::<Result<Vec<_>>>()?;
    crate::page::write(docs, "failures", &Page { entries })
}
