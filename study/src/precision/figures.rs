//! The diagrams as pictures and as numbers.

use super::{Curve, Diagram, Family, Point};
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
    fn panel(
        &self,
        title: &str,
        families: &[Family],
        (x_label, cost): (&str, fn(&Point) -> f64),
        (y_label, error): (&str, fn(&Errors) -> f64),
    ) -> Panel {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let errors = || points().filter_map(|point| point.errors.as_ref().ok()).map(error);
        let decade = |value: f64| 10f64.powf(value.log10().floor());
        let conditioning = error(&self.conditioning);
        let lowest = errors().filter(|error| *error > 0.0).fold(conditioning, f64::min);
        let bottom = decade(lowest.max(conditioning / 100.0));
        // The exact levels evaluate nothing; they are drawn at the left edge.
        let least = decade(points().map(cost).filter(|cost| *cost > 0.0).fold(f64::INFINITY, f64::min));
        let most = 10.0 * decade(points().map(cost).fold(0.0, f64::max));
        let x = Axis::logarithmic(x_label, least, most);
        let y = Axis::logarithmic(y_label, bottom, TOP);
        let mut panel = Panel::new(title, x, y)
            .area((least, most), (bottom, conditioning), PALE)
            .area((least, most), (MEANINGLESS, TOP), PALE)
            .label((least, FAILED), "fails", BLACK)
            .note((least, (conditioning * bottom).sqrt()), "below the conditioning floor", GREY);
        for (curve, style) in families.iter().rev().flat_map(|family| self.styled(*family)) {
            let good = curve.points.iter().filter_map(|point| Some((cost(point), error(point.errors.as_ref().ok()?))));
            panel = panel.with(&curve.name, good.map(|(x, error)| (x, error.clamp(bottom, MEANINGLESS))), style);
            let failed = curve.points.iter().filter(|point| point.errors.is_err()).map(|point| (cost(point), FAILED));
            panel = panel.with(&curve.name, failed, Style::marked(style.colour, 0, Marker::Cross));
        }
        panel
    }
}

const COST: (&str, fn(&Point) -> f64) = ("time per sample / floor", |point| point.cost);
const EVALUATIONS: (&str, fn(&Point) -> f64) = ("right-hand-side evaluations per sample", |point| point.evaluations);
const THETA: (&str, fn(&Errors) -> f64) = ("max|Δθ| / max|θ|", |errors| errors.theta);
const U: (&str, fn(&Errors) -> f64) = ("max|Δu| / max|u|", |errors| errors.u);
const A_T: (&str, fn(&Errors) -> f64) = ("max|Δa_t| / max|a_t|", |errors| errors.a_t);

const BY_HAND: &[Family] = &[Family::Ours, Family::Located, Family::AtStepEnds];
const LIBRARIES: &[Family] = &[Family::Ours, Family::Library];
const LEVELS: &[Family] = &[Family::Ours, Family::Level];
const FMU: &[Family] = &[Family::Ours, Family::Fmu];

/// What a legend explains: everything, or what is compared with the engine alone.
const ALL: [Family; 5] = [Family::Ours, Family::Level, Family::Located, Family::Fmu, Family::Library];
const COMPARED: [Family; 3] = [Family::Ours, Family::Located, Family::Library];

/// Writes the pictures and the numbers of one scene.
pub fn save(diagram: &Diagram, docs: &Path) -> Result<()> {
    let figure = |panels: Vec<Panel>, families: &[Family]| Figure {
        title: diagram.title.into(),
        panel: (600, 440),
        columns: 2,
        panels,
        legend_columns: 3,
        legend: legend(diagram, families),
    };
    let first = [
        diagram.panel("textbook methods, fixed step", BY_HAND, COST, THETA),
        diagram.panel("solvers of other libraries", LIBRARIES, COST, THETA),
        diagram.panel("this project's levels of detail", LEVELS, COST, THETA),
        diagram.panel("the FMU, over its communication steps", FMU, COST, THETA),
    ];
    figure(first.into(), &ALL).save(&docs.join(format!("accuracy-{}.svg", diagram.key)))?;
    let more = [(EVALUATIONS, THETA), (COST, U), (COST, A_T)].map(|(x, y)| {
        [
            diagram.panel("textbook methods, fixed step", BY_HAND, x, y),
            diagram.panel("solvers of other libraries", LIBRARIES, x, y),
        ]
    });
    figure(more.concat(), &COMPARED).save(&docs.join(format!("accuracy-{}-more.svg", diagram.key)))?;
    save_numbers(diagram, &docs.join(format!("accuracy-{}.csv", diagram.key)))
}

/// One column for this project and what lines mean, one for the textbook and the FMU, one for libraries; of these
/// `families`.
fn legend(diagram: &Diagram, families: &[Family]) -> Vec<Entry> {
    let of = |wanted: &[Family]| {
        let wanted: Vec<_> = wanted.iter().copied().filter(|family| families.contains(family)).collect();
        diagram.legend(&wanted)
    };
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
