//! The maps as pictures and as numbers.

use super::limits::{Limit, THEORY};
use super::{Cell, Grid, MOST_CHI, MOST_ZETA};
use crate::chart::{Area, Axis, Entry, Figure, Marker, Panel, Style, colour};
use crate::fixed_step::TEXTBOOK;
use anyhow::Result;
use plotters::style::RGBColor;
use rocking::{Parameters, Structure};
use std::f64::consts::TAU;
use std::path::Path;

/// The methods that have a limit, with how they are drawn.
const LIMITED: [(usize, Style); 4] = [
    (0, Style::marked(colour::ORANGE, 0, Marker::Circle)),
    (1, Style::marked(colour::SKY, 0, Marker::Square)),
    (2, Style::marked(colour::GREEN, 0, Marker::Triangle)),
    (3, Style::marked(colour::BLUE, 0, Marker::Diamond)),
];

/// Classes of the largest stable step, in periods of the structure with both pivots down: upper edges and colours.
const CLASSES: [(f64, RGBColor); 8] = [
    (0.01, RGBColor(68, 1, 84)),
    (0.02, RGBColor(70, 50, 126)),
    (0.05, RGBColor(54, 92, 141)),
    (0.10, RGBColor(39, 127, 142)),
    (0.15, RGBColor(31, 161, 135)),
    (0.20, RGBColor(74, 193, 109)),
    (0.30, RGBColor(160, 218, 57)),
    (0.50, RGBColor(253, 231, 37)),
];

/// Half a cell and a little more, so that no seam shows between two.
const OVERLAP: f64 = 0.54;

/// Writes pictures and numbers of the measurements.
pub fn save(cells: &[Cell], grid: Grid, docs: &Path) -> Result<()> {
    against_theory(cells).save(&docs.join("stability-theory.svg"))?;
    maps(cells, grid).save(&docs.join("stability-map.svg"))?;
    save_numbers(cells, &docs.join("stability.csv"))
}

/// Measured limits of all cells over ζ_u, on the curves of the theory.
fn against_theory(cells: &[Cell]) -> Figure {
    const MOST: f64 = 1.4;
    let x = Axis::linear("damping ratio of the vibration while rocking, ζ_u", 0.0, MOST);
    let mut panel = Panel::new("", x, Axis::linear("largest stable ω_u h", 0.0, 3.2));
    let mut legend = Vec::new();
    for (method, style) in LIMITED {
        let theory = (0..=280).map(|k| f64::from(k) * MOST / 280.0);
        let theory = theory.filter_map(|zeta| Some((zeta, THEORY[method](zeta)?)));
        panel = panel.with(format!("{}, theory", TEXTBOOK[method].name), theory, Style::line(style.colour, 2));
        // Points nearer to each other than this on the chart say the same.
        let mut last = f64::NEG_INFINITY;
        let mut measured: Vec<_> = cells.iter().filter(|cell| cell.method == method).collect();
        measured.sort_by(|a, b| a.vibration.zeta_u().total_cmp(&b.vibration.zeta_u()));
        measured.retain(|cell| {
            let keep = cell.vibration.zeta_u() > last + MOST / 60.0;
            if keep {
                last = cell.vibration.zeta_u();
            }
            keep
        });
        let points = measured.into_iter().map(|cell| {
            let limit = if let Limit::At(limit) = cell.measured { limit } else { 0.0 };
            (cell.vibration.zeta_u(), limit)
        });
        panel = panel.with(format!("{}, measured", TEXTBOOK[method].name), points, style);
        legend.push(Entry::new(TEXTBOOK[method].name, Style { width: 2, ..style }));
    }
    Figure {
        title: "Largest stable step: theory (lines) and measurement (marks)".into(),
        panel: (900, 460),
        columns: 1,
        panels: vec![panel],
        legend_columns: 4,
        legend,
    }
}

/// The largest stable step in fixed-base periods over χ and ζ_fc, for each method that has one.
fn maps(cells: &[Cell], grid: Grid) -> Figure {
    let (width, height) = (MOST_CHI / grid.columns as f64, MOST_ZETA / grid.rows as f64);
    let panels = LIMITED.map(|(method, _)| {
        // The first map is dark where the specimens are.
        let ink = if method == LIMITED[0].0 { colour::WHITE } else { colour::BLACK };
        let specimen = Style::marked(ink, 0, Marker::Circle);
        let x = Axis::linear("modal participation χ (0: both pivots down)", 0.0, MOST_CHI);
        let y = Axis::linear("damping ratio in full contact, ζ_fc", 0.0, MOST_ZETA);
        let mut panel = Panel::new(TEXTBOOK[method].name, x, y);
        for cell in cells.iter().filter(|cell| cell.method == method && cell.vibration.zeta_fc > 0.0) {
            let (chi, zeta) = (cell.vibration.chi, cell.vibration.zeta_fc);
            let (left, right) = (chi - OVERLAP * width, (chi + OVERLAP * width).min(MOST_CHI));
            let y = (zeta - OVERLAP * height, (zeta + OVERLAP * height).min(MOST_ZETA));
            let colour = class(periods(cell));
            match panel.areas.last_mut() {
                // a neighbour of the same class
                Some(area) if area.y == y && area.colour == colour => area.x.1 = right,
                _ => panel.areas.push(Area { x: (left, right), y, colour }),
            }
        }
        for (name, parameters) in [("Evison", Parameters::EVISON), ("McManus", Parameters::MCMANUS)] {
            let chi = Structure::new(parameters).expect("the specimens are in range").chi;
            panel = panel.with(name, [(chi, parameters.zeta_fc)], specimen).label(
                (chi, parameters.zeta_fc + if name == "Evison" { -0.006 } else { 0.009 }),
                name,
                ink,
            );
        }
        panel
    });
    let mut low = 0.0;
    let legend = CLASSES.map(|(high, colour)| {
        let entry = Entry::new(format!("{low:.2} to {high:.2} T_fc"), Style::marked(colour, 10, Marker::None));
        low = high;
        entry
    });
    Figure {
        title: "Largest stable step while rocking, in periods T_fc of the structure with both pivots down".into(),
        panel: (600, 420),
        columns: 2,
        panels: panels.into(),
        legend_columns: 4,
        legend: legend.into(),
    }
}

/// The measured limit in periods 2π/ω_fc.
fn periods(cell: &Cell) -> f64 {
    let limit = if let Limit::At(limit) = cell.measured { limit } else { 0.0 };
    limit * (1.0 - cell.vibration.chi).sqrt() / TAU
}

fn class(periods: f64) -> RGBColor {
    let last = CLASSES[CLASSES.len() - 1];
    CLASSES.into_iter().find(|(high, _)| periods < *high).unwrap_or(last).1
}

fn save_numbers(cells: &[Cell], path: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record(["method", "chi", "zeta_fc", "zeta_u", "measured_omega_u_h", "theory_omega_u_h"])?;
    for Cell { method, vibration, measured, theory } in cells {
        let measured = match measured {
            Limit::Never => "0".into(),
            Limit::At(limit) => format!("{limit:.5}"),
            Limit::Unbounded => "inf".into(),
        };
        csv.write_record([
            TEXTBOOK[*method].name.into(),
            format!("{:.4}", vibration.chi),
            format!("{:.5}", vibration.zeta_fc),
            format!("{:.5}", vibration.zeta_u()),
            measured,
            theory.map_or("inf".into(), |limit| format!("{limit:.5}")),
        ])?;
    }
    Ok(csv.flush()?)
}
