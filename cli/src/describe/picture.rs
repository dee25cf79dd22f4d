//! The picture of a structure, true to scale: as it stands, and tilted so far that its weight stands above the edge.
use crate::picture::{
    Area, Picture, Plot, SMALL, TITLE, axes, chart, colour, dashed, dot, line, px, rounded, stroke, titled, words,
    words_about, words_before,
};
use crate::significant::significant;
use plotters::prelude::*;
use rocking::structure::parameters::PARAMETERS;
use rocking::{Parameters, Quantity, Structure, structure::DERIVED, structure::Derived};
use std::ops::Range;

/// Of the drawing and of the words beside it, pixels.
const WIDTHS: [f64; 2] = [600.0, 300.0];
const HEIGHT: u32 = 560;

/// What the chart keeps for its numbers, pixels: to the left and right, above and below.
const AROUND: [f64; 2] = [106.0, 56.0];
const BELOW: f64 = 46.0;

/// Height of the slab that stands for the foundation, in parts of H.
const SLAB: f64 = 0.03;

/// Derived quantities beside the drawing.
const SHOWN: [&str; 8] = ["period_fc", "weight", "weight0", "width", "alpha_cg", "p_l", "u_cr", "f_u"];

/// Draws `structure`.
pub fn draw(picture: Picture, structure: &Structure) -> anyhow::Result<()> {
    let [drawing, words] = WIDTHS;
    picture.draw(((drawing + words) as u32, TITLE + HEIGHT), |area| {
        let about = "true to scale; grey: about to overturn, the centre of gravity above the right edge";
        let (left, right) = titled(area, "Structure", about)?.split_horizontally(px(drawing));
        let [x, y] = ranges(structure);
        let mut plot = chart(&left, BELOW).build_cartesian_2d(x, y)?;
        axes(&mut plot, ["across (m)", "height (m)"], [6, 8])?;
        draw_structure(&mut plot, structure)?;
        draw_numbers(&right, structure)
    })
}

/// A point of the structure at (`x`, `y`) when the base is turned by `theta` about its right edge.
fn turned(structure: &Structure, theta: f64, (x, y): (f64, f64)) -> (f64, f64) {
    let &Parameters { B, .. } = structure.parameters();
    let (sin, cos) = theta.sin_cos();
    (B + (x - B) * cos + y * sin, y * cos - (x - B) * sin)
}

/// What is shown across and upwards, m: both positions and room for dimensions, at the same scale.
fn ranges(structure: &Structure) -> [Range<f64>; 2] {
    let &Parameters { H, B, .. } = structure.parameters();
    let alpha_cg = structure.tan_alpha_cg.atan();
    let tilted = [(0.0, H), (-B, 0.0), (B, 0.0), (-B, SLAB * H)].map(|point| turned(structure, alpha_cg, point));
    let outermost = |of: fn(&(f64, f64)) -> f64, own: f64| tilted.iter().map(of).fold(own, f64::max);
    let (x, y) = ([-B, outermost(|point| point.0, B)], [0.0, outermost(|point| point.1, H)]);
    let [wide, high] = [x[1] - x[0], y[1] - y[0]];
    let room = 0.12 * wide.max(high);
    let [around_x, around_y] = AROUND;
    let plot = [WIDTHS[0] - around_x, f64::from(HEIGHT) - around_y];
    let per_pixel = ((wide + 2.0 * room) / plot[0]).max((high + 2.0 * room) / plot[1]);
    let middle = (x[0] + x[1]) / 2.0;
    let half = per_pixel * plot[0] / 2.0;
    [middle - half..middle + half, -room..per_pixel * plot[1] - room]
}

fn draw_structure(plot: &mut Plot, structure: &Structure) -> anyhow::Result<()> {
    let &Parameters { H, B, .. } = structure.parameters();
    let alpha_cg = structure.tan_alpha_cg.atan();
    let (across, upwards) = (plot.x_range(), plot.y_range());
    plot.draw_series([Rectangle::new(
        [(across.start, upwards.start), (across.end, 0.0)],
        colour::RULE.mix(0.7).filled(),
    )])?;
    plot.draw_series([PathElement::new([(across.start, 0.0), (across.end, 0.0)], stroke(colour::GREY, 1.5))])?;
    for (theta, ink) in [(alpha_cg, colour::GREY.mix(0.35)), (0.0, colour::INK.mix(1.0))] {
        let at = |x, y| turned(structure, theta, (x, y));
        let slab = [at(-B, 0.0), at(B, 0.0), at(B, SLAB * H), at(-B, SLAB * H)];
        plot.draw_series([Polygon::new(slab, ink)])?;
        plot.draw_series([PathElement::new([at(0.0, 0.0), at(0.0, H)], ink.stroke_width(px(4.0) as u32))])?;
        plot.draw_series([Circle::new(at(0.0, H), px(9.0), ink.filled())])?;
    }
    // the slenderness: from the edge to the centre of gravity, against the vertical
    let center = H / structure.gamma;
    let radius = center.hypot(B);
    dashed(plot, &[(B, 0.0), (0.0, center)], colour::BLUE)?;
    dashed(plot, &[(B, 0.0), (B, radius)], colour::BLUE)?;
    let arc =
        (0..=20).map(|i| alpha_cg * f64::from(i) / 20.0).map(|a| (B - 0.6 * radius * a.sin(), 0.6 * radius * a.cos()));
    plot.draw_series([PathElement::new(arc.collect::<Vec<_>>(), line(colour::BLUE))])?;
    plot.draw_series([dot((0.0, center), 4.0, colour::BLUE)])?;
    let degrees = format!("α_cg = {}°", rounded(alpha_cg.to_degrees()));
    let beside_arc = Text::new(degrees, (px(6.0), 0), words(SMALL, colour::BLUE));
    plot.draw_series([EmptyElement::at((B, 0.6 * radius)) + beside_arc])?;
    // dimensions
    let room = -upwards.start;
    let (below, beside) = (-0.4 * room, -B - 0.45 * room);
    let rule = line(colour::VERMILLION);
    for ends in [[(-B, below), (B, below)], [(beside, 0.0), (beside, H)]] {
        plot.draw_series([PathElement::new(ends, rule)])?;
        plot.draw_series(ends.map(|end| dot(end, 2.5, colour::VERMILLION)))?;
    }
    let width = format!("2 B = {} m", rounded(2.0 * B));
    plot.draw_series([Text::new(width, (0.0, -0.75 * room), words_about(SMALL, colour::VERMILLION))])?;
    let height = format!("H = {} m", rounded(H));
    let above = Text::new(height, (0, px(-12.0)), words_about(SMALL, colour::VERMILLION));
    plot.draw_series([EmptyElement::at((beside, H)) + above])?;
    Ok(())
}

/// Parameters, and what engineers know them by.
fn draw_numbers(area: &Area, structure: &Structure) -> anyhow::Result<()> {
    const LINE: f64 = 20.0;
    let of_parameter =
        |&Quantity { name, unit, get, .. }: &Quantity<Parameters>| (name, get(structure.parameters()), unit);
    let derived = SHOWN.iter().filter_map(|shown| DERIVED.iter().find(|derived| derived.name == *shown));
    let derived = derived.map(|&Derived { name, unit, value, .. }| (name, value(structure), unit));
    for (i, (name, value, unit)) in PARAMETERS.iter().map(of_parameter).chain(derived).enumerate() {
        let gap = if i < PARAMETERS.len() { 0.0 } else { 12.0 };
        let y = px(24.0 + LINE * i as f64 + gap);
        let unit = if unit == "1" { "" } else { unit };
        area.draw(&Text::new(name, (px(10.0), y), words(SMALL, colour::GREY)))?;
        area.draw(&Text::new(significant(value), (px(190.0), y), words_before(SMALL, colour::INK)))?;
        area.draw(&Text::new(unit, (px(200.0), y), words(SMALL, colour::INK)))?;
    }
    Ok(())
}
