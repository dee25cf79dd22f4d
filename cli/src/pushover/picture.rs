//! The picture of a pushover, as Fig 1: force and moment against displacement, its corners marked.
use crate::picture::{Area, Picture, SMALL, TITLE, TEXT, axes, chart, colour, dot, line, px, range, rounded, titled, words, words_before};
use plotters::prelude::*;
use rocking::{Parameters, Structure, pushover::Equilibrium};

const SIZE: (u32, u32) = (760, TITLE + 2 * PANEL + BELOW);
const PANEL: u32 = 230;
const BELOW: u32 = 46;

/// Draws the equilibria of `curve`, branch by branch, and its named `corners`.
pub fn draw(
    picture: &Picture,
    structure: &Structure,
    curve: &[Equilibrium],
    corners: &[(&str, Equilibrium)],
) -> anyhow::Result<()> {
    let &Parameters { m, m0, H, B, .. } = structure.parameters();
    let [m, m0, H, base, u_cr] = [m, m0, H, 2.0 * B, 1e3 * structure.u_cr].map(rounded);
    let about = format!("masses {m} and {m0} kg, height {H} m, base {base} m wide; uplift at {u_cr} mm");
    picture.draw(SIZE, |area| {
        let below = titled(area, "Static pushover", &about)?;
        let (upper, lower) = below.split_vertically(px(f64::from(PANEL)));
        draw_panel(&upper, 6.0, ["", "force P (kN)"], curve, corners, |at| at.force)?;
        draw_panel(&lower, f64::from(BELOW), ["displacement of the top mass (mm)", "moment M (kN m)"], curve, corners, |at| at.moment)
    })
}

fn draw_panel(
    area: &Area,
    below: f64,
    names: [&str; 2],
    curve: &[Equilibrium],
    corners: &[(&str, Equilibrium)],
    value: fn(&Equilibrium) -> f64,
) -> anyhow::Result<()> {
    let point = |at: &Equilibrium| (1e3 * at.delta_t, 1e-3 * value(at));
    let all = || curve.iter().map(point);
    let end = all().fold(0.0, |most: f64, (x, _)| most.max(x));
    let mut chart = chart(area, below).build_cartesian_2d(0.0..1.04 * end, range(all().map(|(_, y)| y)))?;
    axes(&mut chart, names, [8, 6])?;
    let branches = curve.chunk_by(|a, b| a.phase == b.phase).map(|branch| PathElement::new(branch.iter().map(point).collect::<Vec<_>>(), line(colour::BLUE)));
    chart.draw_series(branches)?;
    for (name, corner) in corners {
        let (x, y) = point(corner);
        let (style, aside) = if x > 0.5 * end { (words_before(SMALL, colour::INK), -8.0) } else { (words(SMALL, colour::INK), 8.0) };
        let label = EmptyElement::at((x, y)) + dot((0, 0), 3.0, colour::INK) + Text::new((*name).to_owned(), (px(aside), px(-TEXT)), style);
        chart.draw_series([label])?;
    }
    Ok(())
}
