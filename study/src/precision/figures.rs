//! The diagrams as pictures and as numbers.

use super::{Curve, Diagram, Family};
use crate::chart::colour::{BLACK, BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, VERMILLION};
use crate::chart::{Axis, Entry, Figure, Marker, Panel, Style};
use crate::response::Errors;
use anyhow::Result;
use std::path::Path;

/// Errors beyond this have no meaning and are drawn here.
const MEANINGLESS: f64 = 10.0;

/// Where the marks of failed runs are drawn, above everything else.
const FAILED: f64 = 20.0;

/// The upper end of the axis of errors.
const TOP: f64 = 40.0;

const HELD: Style = Style { dashed: true, ..Style::marked(PURPLE, 2, Marker::Diamond) };

/// The FMU with the record inside.
const INSIDE: Style = Style::marked(GREEN, 2, Marker::Triangle);

/// Colours and marks of the textbook methods, in the order of [`crate::fixed_step::TEXTBOOK`].
const TEXTBOOK_STYLES: [Style; 6] = [
    Style::marked(ORANGE, 2, Marker::Circle),
    Style::marked(SKY, 2, Marker::Square),
    Style::marked(GREEN, 2, Marker::Triangle),
    Style::marked(BLUE, 2, Marker::Circle),
    Style::marked(VERMILLION, 2, Marker::Square),
    Style::marked(PURPLE, 2, Marker::Triangle),
];

/// Colours and marks of the libraries, in the order in which they are measured.
const LIBRARY_STYLES: [Style; 6] = [
    Style::marked(ORANGE, 2, Marker::Circle),
    Style::marked(BLUE, 2, Marker::Circle),
    Style::marked(GREEN, 2, Marker::Square),
    Style::marked(SKY, 2, Marker::Square),
    Style { dashed: true, ..Style::marked(VERMILLION, 2, Marker::Triangle) },
    Style::marked(VERMILLION, 2, Marker::Triangle),
];

/// This project, by default.
const OURS: Style = Style::marked(BLACK, 3, Marker::Circle);

/// Its other levels of detail, in the order of the library.
const LEVEL_STYLES: [Style; 5] = [
    Style { dashed: true, ..Style::marked(GREY, 2, Marker::Square) },
    Style::marked(BLUE, 2, Marker::Circle),
    Style::marked(VERMILLION, 2, Marker::Triangle),
    Style::marked(GREEN, 2, Marker::Square),
    Style::marked(PURPLE, 2, Marker::Diamond),
];

impl Diagram {
    /// The curves of `family` with how they are drawn.
    fn styled(&self, family: Family) -> impl Iterator<Item = (&Curve, Style)> {
        let styles: Vec<Style> = match family {
            Family::Ours => vec![OURS],
            Family::Level => LEVEL_STYLES.to_vec(),
            Family::Located => TEXTBOOK_STYLES.to_vec(),
            Family::AtStepEnds => TEXTBOOK_STYLES.iter().map(|style| Style { dashed: true, ..*style }).collect(),
            Family::Library => LIBRARY_STYLES.to_vec(),
            Family::Fmu => vec![HELD, Style { dashed: false, ..HELD }, INSIDE],
        };
        self.curves.iter().filter(move |curve| curve.family == family).zip(styles.into_iter().cycle())
    }

    fn legend(&self, families: &[Family]) -> Vec<Entry> {
        let entry = |(curve, style): (&Curve, Style)| Entry::new(curve.name.clone(), style);
        families.iter().flat_map(|family| self.styled(*family).map(entry).collect::<Vec<_>>()).collect()
    }

    /// Error over cost for some families of curves.
    fn panel(&self, title: &str, families: &[Family]) -> Panel {
        let error = |errors: &Errors| errors.theta;
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let errors = || points().filter_map(|point| point.errors.as_ref().ok()).map(error);
        let decade = |value: f64| 10f64.powf(value.log10().floor());
        let conditioning = error(&self.conditioning);
        let lowest = errors().filter(|error| *error > 0.0).fold(conditioning, f64::min);
        let bottom = decade(lowest.max(conditioning / 100.0));
        let least = decade(points().map(|point| point.cost).fold(f64::INFINITY, f64::min));
        let most = 10.0 * decade(points().map(|point| point.cost).fold(0.0, f64::max));
        let x = Axis::logarithmic("time per sample / floor", least, most);
        let y = Axis::logarithmic("max|Δθ| / max|θ|", bottom, TOP);
        let mut panel = Panel::new(title, x, y)
            .area((least, most), (bottom, conditioning), PALE)
            .area((least, most), (MEANINGLESS, TOP), PALE)
            .label((least, FAILED), "fails", BLACK)
            .note((least, (conditioning * bottom).sqrt()), "below the conditioning floor", GREY);
        for (curve, style) in families.iter().rev().flat_map(|family| self.styled(*family)) {
            let good = curve.points.iter().filter_map(|point| Some((point.cost, error(point.errors.as_ref().ok()?))));
            panel = panel.with(&curve.name, good.map(|(x, error)| (x, error.clamp(bottom, MEANINGLESS))), style);
            let failed = curve.points.iter().filter(|point| point.errors.is_err()).map(|point| (point.cost, FAILED));
            panel = panel.with(&curve.name, failed, Style::marked(style.colour, 0, Marker::Cross));
        }
        panel
    }
}

const BY_HAND: &[Family] = &[Family::Ours, Family::Located, Family::AtStepEnds];
const LIBRARIES: &[Family] = &[Family::Ours, Family::Library];
const LEVELS: &[Family] = &[Family::Ours, Family::Level];
const FMU: &[Family] = &[Family::Ours, Family::Fmu];

/// Writes the pictures and the numbers of one scene.
pub fn save(diagram: &Diagram, docs: &Path) -> Result<()> {
    let figure = Figure {
        title: diagram.title.into(),
        panel: (600, 440),
        columns: 2,
        panels: vec![
            diagram.panel("textbook methods, fixed step", BY_HAND),
            diagram.panel("solvers of other libraries", LIBRARIES),
            diagram.panel("this project's levels of detail", LEVELS),
            diagram.panel("the FMU, over its communication steps", FMU),
        ],
        legend_columns: 3,
        legend: legend(diagram),
    };
    figure.save(&docs.join(format!("accuracy-{}.svg", diagram.key)))?;
    save_numbers(diagram, &docs.join(format!("accuracy-{}.csv", diagram.key)))
}

/// One column for this project and what lines mean, one for the textbook and the FMU, one for libraries.
fn legend(diagram: &Diagram) -> Vec<Entry> {
    let of = |families: &[Family]| diagram.legend(families);
    let meanings = [
        Entry::new("textbook: transitions located", Style::line(GREY, 2)),
        Entry::new("textbook: transitions at step ends", Style::dashed(GREY, 2)),
        Entry::new("fails; its colour tells which", Style::marked(GREY, 0, Marker::Cross)),
    ];
    let columns = [
        of(&[Family::Ours, Family::Level]).into_iter().chain(meanings).collect(),
        of(&[Family::Located, Family::Fmu]),
        of(&[Family::Library]),
    ];
    let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
    let blank = Entry::new("", Style::line(GREY, 0));
    columns
        .into_iter()
        .flat_map(|mut column| {
            column.resize(rows, blank.clone());
            column
        })
        .collect()
}

fn save_numbers(diagram: &Diagram, path: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record([
        "method",
        "transitions_taken",
        "setting",
        "value",
        "cost_over_floor",
        "microseconds_per_sample",
        "evaluations_per_sample",
        "transitions",
        "error_theta",
        "error_u",
        "error_a_t",
        "failure",
    ])?;
    for curve in &diagram.curves {
        let taken = match curve.family {
            Family::AtStepEnds => "at step ends",
            _ => "located",
        };
        for point in &curve.points {
            let error =
                |get: fn(&Errors) -> f64| point.errors.as_ref().map_or(String::new(), |e| format!("{:.3e}", get(e)));
            csv.write_record([
                curve.name.clone(),
                taken.into(),
                curve.setting.into(),
                format!("{:.6e}", point.setting),
                format!("{:.2}", point.cost),
                format!("{:.4}", 1e6 * point.cost * diagram.floor),
                format!("{:.3}", point.evaluations),
                point.transitions.to_string(),
                error(|e| e.theta),
                error(|e| e.u),
                error(|e| e.a_t),
                point.errors.as_ref().err().map_or(String::new(), ToString::to_string),
            ])?;
        }
    }
    Ok(csv.flush()?)
}
