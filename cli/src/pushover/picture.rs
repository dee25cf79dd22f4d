//! The picture of a pushover, as Fig 1: force and moment against displacement, all of it and the first part of it.
use crate::picture::{
    Area, Picture, SMALL, TITLE, axes, chart, colour, dot, line, mass, px, range, rounded, titled, words,
};
use crate::quantities::readable;
use plotters::prelude::*;
use rocking::estimates::pushover::Equilibrium;
use rocking::{Parameters, Structure};
use std::ops::Range;

const SIZE: (u32, u32) = (900, TITLE + 2 * PANEL + BELOW);
const PANEL: u32 = 230;
const BELOW: u32 = 46;

/// Width of the panels that show the first part, pixels.
const FIRST_PART: f64 = 360.0;

/// How far that goes, in parts of u_cr.
const BEYOND_UPLIFT: f64 = 4.0;

const DISPLACEMENT: &str = "displacement δ_t (mm)";

/// Draws the equilibria of `curve`, branch by branch, and its corners: uplift, the start of rocking, overturning.
pub fn draw(
    picture: Picture,
    structure: &Structure,
    curve: &[Equilibrium],
    corners: [Equilibrium; 3],
) -> anyhow::Result<()> {
    let &Parameters { m, m0, H, B, .. } = structure.parameters();
    let ([m, m0], [H, base, u_cr]) = ([m, m0].map(mass), [H, 2.0 * B, 1e3 * structure.u_cr].map(rounded));
    let about = format!("masses {m} and {m0}, height {H} m, base {base} m wide; uplift at {u_cr} mm");
    picture.draw(SIZE, |area| {
        let below = titled(area, "Static pushover", &about)?;
        let (upper, lower) = below.split_vertically(px(f64::from(PANEL)));
        let rows = [
            (upper, 6.0, "", ("force P", "N"), (|at| at.force) as fn(&Equilibrium) -> f64),
            (lower, f64::from(BELOW), DISPLACEMENT, ("moment M", "N.m"), |at| at.moment),
        ];
        for (row, below, x, (name, unit), value) in rows {
            let (per_unit, unit) = readable(curve.iter().map(value).fold(0.0, f64::max), unit);
            let y = &format!("{name} ({unit})");
            let (first, all) = row.split_horizontally(px(FIRST_PART));
            let points = |at: &Equilibrium| (1e3 * at.delta_t, value(at) / per_unit);
            let [uplift, rocking, overturning] = corners.each_ref().map(points);
            let start = 0.0..BEYOND_UPLIFT * uplift.0;
            let corners = [("uplift", uplift, Beside::Above), ("start of rocking", rocking, Beside::Below)];
            draw_panel(&first, (below, [x, y]), start, curve, points, &corners)?;
            let corners = [("uplift", uplift, Beside::Above), ("overturning", overturning, Beside::Above)];
            draw_panel(&all, (below, [x, y]), 0.0..1.2 * overturning.0, curve, points, &corners)?;
        }
        Ok(())
    })
}

/// Where the name of a corner stands.
enum Beside {
    Above,
    Below,
}

fn draw_panel(
    area: &Area,
    (below, names): (f64, [&str; 2]),
    displacement: Range<f64>,
    curve: &[Equilibrium],
    point: impl Fn(&Equilibrium) -> (f64, f64),
    corners: &[(&str, (f64, f64), Beside)],
) -> anyhow::Result<()> {
    let highest = range(curve.iter().map(|at| point(at).1));
    let mut chart = chart(area, below).build_cartesian_2d(displacement.clone(), highest)?;
    axes(&mut chart, names, [6, 6])?;
    for branch in curve.chunk_by(|a, b| a.phase == b.phase) {
        let points: Vec<_> = branch.iter().map(&point).collect();
        chart.draw_series([PathElement::new(up_to(&points, displacement.end), line(colour::BLUE))])?;
    }
    for (name, at, beside) in corners {
        let height = match beside {
            Beside::Above => px(-10.0),
            Beside::Below => px(12.0),
        };
        let name = Text::new((*name).to_owned(), (px(7.0), height), words(SMALL, colour::INK));
        chart.draw_series([EmptyElement::at(*at) + dot((0, 0), 3.0, colour::INK) + name])?;
    }
    Ok(())
}

/// The line through `points` as far as `end`.
fn up_to(points: &[(f64, f64)], end: f64) -> Vec<(f64, f64)> {
    let inside = points.partition_point(|point| point.0 <= end);
    let mut line = points[..inside].to_vec();
    if let (Some(&(x0, y0)), Some(&(x1, y1))) = (line.last(), points.get(inside)) {
        line.push((end, y0 + (y1 - y0) * (end - x0) / (x1 - x0)));
    }
    line
}
