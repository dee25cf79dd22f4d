//! Lines of equal rotation on a map: through all of its points, where the structure rocks and stands all about.
use super::{Spectrum, picture::Shown};
use crate::picture::{SMALL, colour, px, stroke, words_about};
use contour::ContourBuilder;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use rocking_sweep::map::{Class, Place, Point, finest_step};
use std::collections::HashMap;

/// θ_max/α_cg on the lines.
const LINES: [f64; 4] = [0.1, 0.25, 0.5, 0.75];

/// Steps along an axis that a picture can show: a finer grid is not gone into.
const FINEST: usize = 1000;

/// Names of lines stand this far apart, pixels.
const APART: (f64, f64) = (34.0, 15.0);

/// Draws the lines of `spectrum`, which is refined so many times. They end in the squares of the grid, as fine as it is there,
/// at whose corners the base stays down or the structure overturns: between these θ_max has no values in between.
pub fn lines<X, Y>(
    chart: &mut ChartContext<SVGBackend, Cartesian2d<X, Y>>,
    [x, y]: [&Shown; 2],
    spectrum: &Spectrum,
    refinements: u32,
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let is_shown = |level: &u32| x.steps().max(y.steps()) << level <= FINEST;
    let level = (0..=refinements).rev().find(is_shown).unwrap_or(0);
    let (step, parts) = (finest_step(level), 1 << level);
    let [columns, rows] = [x, y].map(|axis| axis.steps() * parts + 1);
    let at = |i: usize| Place { frequency: (i % columns) as u32 * step, amplitude: (i / columns) as u32 * step };
    let thetas: Vec<_> = (0..rows * columns).map(|i| theta_at(&spectrum.points, at(i), level)).collect();
    let rocks_about = |(i, j): (f64, f64)| {
        let (i, j) = ((i as usize).min(columns - 2), (j as usize).min(rows - 2));
        [0, 1, columns, columns + 1].iter().all(|corner| thetas[j * columns + i + corner].is_some())
    };
    let values: Vec<_> = thetas.iter().map(|theta| theta.unwrap_or(0.0)).collect();
    let [last_x, last_y] = [columns, rows].map(|points| (points - 1) as f64);
    let place = |(i, j): (f64, f64)| (x.at(i / parts as f64), y.at(j / parts as f64));
    let mut names: Vec<(i32, i32)> = Vec::new();
    for line in ContourBuilder::new(columns, rows, true).x_origin(-0.5).y_origin(-0.5).lines(&values, &LINES)? {
        let mut longest: Vec<(f64, f64)> = Vec::new();
        for ring in &line.geometry().0 {
            let ring: Vec<_> = ring.0.iter().map(|at| (at.x.clamp(0.0, last_x), at.y.clamp(0.0, last_y))).collect();
            // rings close along the edges of the map, where there is nothing to be drawn
            let edges = |(x, y): (f64, f64)| [x <= 0.0, x >= last_x, y <= 0.0, y >= last_y];
            let is_drawn = |a: &(f64, f64), b: &(f64, f64)| {
                let is_along_edge = edges(*a).iter().zip(edges(*b)).any(|(a, b)| *a && b);
                !is_along_edge && rocks_about((0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)))
            };
            for part in ring.chunk_by(is_drawn).filter(|part| part.len() > 1) {
                let points: Vec<_> = part.iter().map(|at| place(*at)).collect();
                chart.draw_series([PathElement::new(points, stroke(colour::INK, 0.7))])?;
                longest = if part.len() > longest.len() { part.to_vec() } else { longest };
            }
        }
        // a name stands on its line where no other stands, or nowhere
        let free = |at: &(f64, f64)| {
            let (x, y) = chart.backend_coord(&place(*at));
            names.iter().all(|name| (name.0 - x).abs() > px(APART.0) || (name.1 - y).abs() > px(APART.1))
        };
        let middle_first = (1..8).flat_map(|parts| (1..=parts).map(move |part| (part, parts + 1)));
        let mut on_line = middle_first.filter_map(|(part, parts)| longest.get(longest.len() * part / parts));
        if let Some(at) = on_line.find(|at| free(at)).copied() {
            names.push(chart.backend_coord(&place(at)));
            let name = Text::new(line.threshold().to_string(), (0, px(-6.0)), words_about(SMALL, colour::INK));
            chart.draw_series([EmptyElement::at(place(at)) + name])?;
        }
    }
    Ok(())
}

/// θ_max/α_cg at `place` of a map refined `levels` times, if the structure rocks and stands there: a point's own, or
/// between the corners of the smallest square about it that are known.
fn theta_at(known: &HashMap<Place, Point>, place: Place, levels: u32) -> Option<f64> {
    let corners = |level: u32| {
        let step = finest_step(level);
        let (i, j) = (place.frequency % step, place.amplitude % step);
        let [right, up] = [i, j].map(|part| f64::from(part) / f64::from(step));
        let at = |of_i, of_j| Place { frequency: place.frequency - i + of_i, amplitude: place.amplitude - j + of_j };
        let weighted = [
            (at(0, 0), (1.0 - right) * (1.0 - up)),
            (at(step, 0), right * (1.0 - up)),
            (at(0, step), (1.0 - right) * up),
            (at(step, step), right * up),
        ];
        let known = weighted
            .into_iter()
            .filter(|(_, weight)| *weight > 0.0)
            .map(|(at, weight)| Some((known.get(&at)?, weight)));
        known.collect::<Option<Vec<_>>>()
    };
    let corners = (0..=levels).rev().find_map(corners)?;
    let stand = corners.iter().all(|(point, _)| point.class() == Class::Stands);
    stand.then(|| corners.iter().map(|(point, weight)| weight * point.theta).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_sweep::map::Fate;

    fn point(fate: Fate, theta: f64) -> Point {
        Point { fate, impacts: 2, theta, transitions: 3, end: 1.0, condition: None, reason: String::new() }
    }

    /// A square of the grid, refined in its left half: known points are themselves, others linear between the corners of
    /// the smallest square that is whole; where one of them overturns there is none.
    #[test]
    fn rotations_are_those_of_the_smallest_square() {
        let half = finest_step(1);
        let at = |i: u32, j: u32| Place { frequency: i * half, amplitude: j * half };
        let stands = |theta| point(Fate::Stands, theta);
        let mut known: HashMap<_, _> =
            [(0, 0, 0.1), (2, 0, 0.3), (0, 2, 0.5), (2, 2, 0.9)].map(|(i, j, theta)| (at(i, j), stands(theta))).into();
        let close = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-15, "{found:?}");
        close(theta_at(&known, at(1, 0), 1), 0.2);
        close(theta_at(&known, at(2, 1), 1), 0.6);
        close(theta_at(&known, at(1, 1), 1), 0.45);
        known.insert(at(1, 1), stands(0.4));
        close(theta_at(&known, at(1, 1), 1), 0.4);
        known.insert(at(2, 2), point(Fate::Overturns, 6.0));
        assert_eq!(theta_at(&known, at(2, 1), 1), None);
        close(theta_at(&known, at(1, 0), 1), 0.2);
        assert_eq!(theta_at(&known, at(3, 0), 1), None);
    }
}
