//! The limits as a picture and as numbers.

use super::Cell;
use super::limits::{Limit, THEORY};
use crate::chart::{Axis, Entry, Figure, Marker, Panel, Style, colour};
use crate::fixed_step::TEXTBOOK;
use anyhow::Result;
use std::path::Path;

/// The methods that have a limit, with how they are drawn.
const LIMITED: [(usize, Style); 4] = [
    (0, Style::marked(colour::ORANGE, 0, Marker::Circle)),
    (1, Style::marked(colour::SKY, 0, Marker::Square)),
    (2, Style::marked(colour::GREEN, 0, Marker::Triangle)),
    (3, Style::marked(colour::BLUE, 0, Marker::Diamond)),
];

/// Writes picture and numbers of the measurements.
pub fn save(cells: &[Cell], docs: &Path) -> Result<()> {
    against_theory(cells).save(&docs.join("stability-theory.svg"))?;
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
