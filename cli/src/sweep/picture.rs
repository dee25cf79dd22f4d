//! The picture of a sweep: the parts of the runs that exceed a limit as dots, fragility curves as lines in their bands,
//! both against the intensity of the single run.
use super::table::{BEYOND_THE_RUNS, is_beyond_the_runs};
use crate::picture::{
    Area, Picture, Plot, SMALL, TITLE, axes, chart, colour, dashed, line, px, rounded, titled, words, words_before,
};
use plotters::prelude::*;
use rocking::estimates::intensity::IntensityMeasure;
use rocking_sweep::exceedances::{Exceedances, Fragility};
use rocking_sweep::fragility::FragilityCurve;

const WIDTH: u32 = 860;
const PLOT: u32 = 440;

/// Height of a line of the legend, and room around all of it, pixels.
const LEGEND_LINE: f64 = 20.0;
const LEGEND_MARGIN: f64 = 14.0;

/// Positions of the columns of the legend, pixels: line and dot, name, and the ends of median, its range, dispersion.
const COLUMNS: [f64; 5] = [40.0, 84.0, 560.0, 700.0, 800.0];

/// A median that is not much further away than the strongest ground motion is shown.
const BEYOND: f64 = 3.0;

const POINTS_OF_A_CURVE: u32 = 300;

/// Radius of the dot of the bin with the most runs, pixels; areas are in proportion to their numbers.
const LARGEST_DOT: f64 = 5.0;

const COLORS: [RGBColor; 7] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::SKY, colour::INK];

pub fn draw(picture: Picture, populations: &[Exceedances], measure: IntensityMeasure) -> anyhow::Result<()> {
    let all = || populations.iter().flat_map(|of| of.fragilities.iter().map(move |fragility| (of, fragility)));
    let legend = 2.0 * LEGEND_MARGIN + LEGEND_LINE * (all().count() + 3) as f64;
    let runs = || populations.iter().flat_map(|of| &of.bins).map(|bin| bin.runs);
    let (least, most) = (runs().min().unwrap_or(0), runs().max().unwrap_or(0));
    let about = "dots: fraction of the runs of about the same intensity; lines: lognormal curves fitted to all runs";
    picture.draw((WIDTH, TITLE + PLOT + legend as u32), |area| {
        let area = titled(area, "Fragility", about)?;
        let (upper, lower) = area.split_vertically(px(f64::from(PLOT)));
        let strongest = populations.iter().flat_map(|of| &of.bins).fold(0.0, |most: f64, bin| most.max(bin.highest));
        let medians = all().filter_map(|(_, fragility)| Some(fragility.curve.as_ref().ok()?.median));
        let end = medians.filter(|median| *median < BEYOND * strongest).fold(strongest, f64::max);
        let mut plot = chart(&upper, 46.0).build_cartesian_2d(0.0..1.02 * end, 0.0..1.0)?;
        let x = format!("{} ({})", measure.description(), measure.unit());
        axes(&mut plot, [&x, "fraction of the runs, probability"], [8, 6])?;
        for (i, (_, fragility)) in all().enumerate() {
            if let Ok(curve) = &fragility.curve {
                draw_curve(&mut plot, curve, strongest, 1.02 * end, colour_of(i))?;
            }
        }
        for (i, (of, fragility)) in all().enumerate() {
            let dots = of.bins.iter().zip(&fragility.tallies).filter_map(|(bin, tally)| {
                let radius = LARGEST_DOT * (tally.known as f64 / most as f64).sqrt();
                Some(Circle::new((bin.mean, tally.part()?), px(radius.max(1.5)), colour_of(i).mix(0.85).filled()))
            });
            plot.draw_series(dots)?;
        }
        draw_legend(&lower, all(), measure, (least, most))
    })
}

fn colour_of(i: usize) -> RGBColor {
    COLORS[i % COLORS.len()]
}

/// The curve as far as `end`, dashed beyond the `strongest` ground motion, on its band.
fn draw_curve(
    plot: &mut Plot,
    curve: &FragilityCurve,
    strongest: f64,
    end: f64,
    colour: RGBColor,
) -> anyhow::Result<()> {
    let at = |j: u32| end * f64::from(j) / f64::from(POINTS_OF_A_CURVE);
    let intensities = || (1..=POINTS_OF_A_CURVE).map(at);
    let edges = intensities().filter_map(|x| curve.band(x).map(|(low, high)| ((x, low), (x, high))));
    let (lower, upper): (Vec<_>, Vec<_>) = edges.unzip();
    if !lower.is_empty() {
        let around = lower.iter().chain(upper.iter().rev()).copied().collect::<Vec<_>>();
        plot.draw_series([Polygon::new(around, colour.mix(0.1))])?;
        let edge = colour.mix(0.5).stroke_width(px(0.6) as u32);
        plot.draw_series([lower, upper].map(|points| PathElement::new(points, edge)))?;
    }
    let points =
        || [0.0].into_iter().chain(intensities()).map(|x| (x, if x > 0.0 { curve.probability(x) } else { 0.0 }));
    let (seen, beyond): (Vec<_>, Vec<_>) = points().partition(|(x, _)| *x <= strongest);
    let joint = seen.last().copied();
    plot.draw_series([PathElement::new(seen, line(colour))])?;
    dashed(plot, &joint.into_iter().chain(beyond).collect::<Vec<_>>(), colour)
}

/// A line for each curve below the plot: what it is of, median and dispersion.
fn draw_legend<'a>(
    area: &Area,
    all: impl Iterator<Item = (&'a Exceedances, &'a Fragility)>,
    measure: IntensityMeasure,
    (least, most): (usize, usize),
) -> anyhow::Result<()> {
    let height = |i: usize| px(LEGEND_MARGIN + LEGEND_LINE * (i as f64 + 0.5));
    let [swatch, name, median, range, dispersion] = COLUMNS.map(px);
    let cell = |x, y, text: String, colour| area.draw(&Text::new(text, (x, y), words_before(SMALL, colour)));
    let unit = measure.unit();
    for (x, heading) in
        [(median, format!("median ({unit})")), (range, "95 % range".into()), (dispersion, "dispersion".into())]
    {
        cell(x, height(0), heading, colour::GREY)?;
    }
    let mut lines = 1; // the headings
    for (i, (of, fragility)) in all.enumerate() {
        let (Exceedances { population, .. }, Fragility { limit, curve, .. }) = (of, fragility);
        let (y, colour) = (height(lines), colour_of(i));
        area.draw(&PathElement::new([(swatch - px(14.0), y), (swatch + px(14.0), y)], line(colour)))?;
        area.draw(&Circle::new((swatch, y), px(4.0), colour.filled()))?;
        area.draw(&Text::new(format!("{population}: {limit}"), (name, y), words(SMALL, colour::INK)))?;
        match curve {
            Ok(curve) => {
                let ends = curve.median_range().map(|(low, high)| format!("{} to {}", rounded(low), rounded(high)));
                let beyond =
                    if is_beyond_the_runs(of, fragility) { format!("{BEYOND_THE_RUNS}: ") } else { String::new() };
                cell(median, y, format!("{beyond}{}", rounded(curve.median)), colour::INK)?;
                cell(range, y, ends.unwrap_or("–".into()), colour::INK)?;
                cell(dispersion, y, rounded(curve.dispersion), colour::INK)?;
            }
            Err(_) => cell(dispersion, y, "no curve: see the table".into(), colour::GREY)?,
        }
        lines += 1;
    }
    let dots = match least == most {
        true => format!("A dot stands for {most} runs"),
        false => format!("A dot's area is the number of its runs, {least} to {most}"),
    };
    let notes = [
        format!("{dots}; one that overturns exceeds every limit."),
        "Bands and ranges: 95 % for the curves, not for the dots; records are independent (under one record: structures).".into(),
    ];
    for (i, note) in notes.into_iter().enumerate() {
        area.draw(&Text::new(note, (swatch - px(14.0), height(lines + i)), words(SMALL, colour::GREY)))?;
    }
    Ok(())
}
