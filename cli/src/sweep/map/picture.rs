//! The picture of maps: classes and rotations as cells, and beside them, where it is known, the condition.
use crate::picture::{
    Area, Picture, SMALL, TEXT, TITLE, axes, chart, colour, log_axis, px, shortened, stroke, titled, words,
};
use plotters::prelude::*;
use rocking_sweep::map::{Axis, Fate, GridPlace, Map, MapPoint, PARTS, nearest};
use std::{collections::HashMap, ops::Range};

pub struct PulseSpectrum {
    pub name: String,
    pub map: Map,
    pub points: HashMap<GridPlace, MapPoint>,
}

/// Sizes in pixels: of a panel with its axes, of a panel's name, of a line of the legend.
const PANEL: (u32, u32) = (440, 400);
const NAME: f64 = 20.0;
const LEGEND_LINE: f64 = 19.0;

/// Distance of the axes from the left edge of a panel, pixels.
const LEFT: f64 = 78.0;

/// Characters of a name that fit above a panel.
const LONGEST_NAME: usize = 50;

/// Length by which a cell reaches below the cells that are drawn after it, pixels. The pixel at the edge is then covered
/// whole, and nothing shines through between cells.
const OVERLAP: f64 = 1.0;

type Swatch = (RGBColor, &'static str);

const CLASSES: [Swatch; 10] = [
    (RGBColor(240, 240, 240), "no uplift"),
    (RGBColor(214, 234, 248), "rocks and stands, θ_max less than α_cg/4"),
    (RGBColor(169, 211, 240), "rocks and stands, α_cg/4 to α_cg/2"),
    (RGBColor(120, 178, 222), "rocks and stands, α_cg/2 to 3 α_cg/4"),
    (RGBColor(70, 140, 196), "rocks and stands, more"),
    (colour::VERMILLION, "overturns without impact"),
    (colour::ORANGE, "overturns after one impact"),
    (colour::PURPLE, "overturns after more impacts"),
    (colour::GREEN, "still rocking: not decided"),
    (colour::INK, "failed: not decided"),
];

const CONDITIONS: [Swatch; 6] = [
    (RGBColor(240, 240, 240), "amplifies 1e-12 less than 10 times"),
    (RGBColor(214, 234, 248), "10 to 1e3 times"),
    (RGBColor(120, 178, 222), "1e3 to 1e6 times"),
    (colour::ORANGE, "1e6 to 1e10 times"),
    (colour::VERMILLION, "more than 1e10 times"),
    (colour::INK, "1e-12 changes the class"),
];

#[derive(Clone, Copy)]
struct Key {
    /// The number of a point's swatch.
    of: fn(&MapPoint) -> usize,
    swatches: &'static [Swatch],
    /// Title of the picture, after the structure's name.
    suffix: &'static str,
}

const OF_CLASS: Key = Key { of: class_of, swatches: &CLASSES, suffix: "" };
const OF_CONDITION: Key = Key { of: condition_of, swatches: &CONDITIONS, suffix: ": condition" };

pub fn axis_names(map: &Map) -> [&'static str; 2] {
    if map.is_dimensionless { ["omega/p_l", "a_p/(g tan alpha_cg)"] } else { ["frequency (Hz)", "amplitude a_p (g)"] }
}

fn class_of(point: &MapPoint) -> usize {
    match (point.fate, point.impacts) {
        (Fate::NoUplift, _) => 0,
        (Fate::Stands, _) => 1 + (4.0 * point.theta).clamp(0.0, 3.0) as usize,
        (Fate::Overturns, 0) => 5,
        (Fate::Overturns, 1) => 6,
        (Fate::Overturns, _) => 7,
        (Fate::StillRocking, _) => 8,
        (Fate::Failed, _) => 9,
    }
}

fn condition_of(point: &MapPoint) -> usize {
    match point.condition {
        Some(f64::INFINITY) => 5,
        Some(1e10..) => 4,
        Some(1e6..) => 3,
        Some(1e3..) => 2,
        Some(10.0..) => 1,
        _ => 0,
    }
}

/// Draws `spectra`, refined so many times: each with its condition beside it, or about as many across as down.
pub fn draw(picture: Picture, spectra: &[PulseSpectrum], refinements: u32) -> anyhow::Result<()> {
    let Some(PulseSpectrum { map, .. }) = spectra.first() else { return Ok(()) };
    let (width, height) = (PANEL.0, PANEL.1 + NAME as u32);
    let across = (spectra.len() as f64 * f64::from(height) / f64::from(width)).sqrt().ceil() as usize;
    let (keys, across) =
        if map.finds_condition { (&[OF_CLASS, OF_CONDITION][..], 2) } else { (&[OF_CLASS][..], across) };
    let panels: Vec<_> = spectra.iter().flat_map(|spectrum| keys.iter().map(move |key| (spectrum, *key))).collect();
    let seen = |key: &Key| {
        let is_there = |i: usize| spectra.iter().flat_map(|one| one.points.values()).any(|point| (key.of)(point) == i);
        (0..key.swatches.len()).filter(|i| is_there(*i)).map(|i| &key.swatches[i]).collect::<Vec<_>>()
    };
    let legends: Vec<_> = keys.iter().map(seen).collect();
    let legend = LEGEND_LINE * (legends.iter().map(Vec::len).max().unwrap_or(0) as f64 + 1.0);
    let down = panels.len().div_ceil(across) as u32;
    let size = (across as u32 * width, TITLE + down * height + legend as u32);
    let title = format!("Overturning spectrum: {}", map.pulse.name());
    let about = format!("level of detail {}, tolerance {:e}", map.detail.name(), map.tolerance);
    picture.draw(size, |area| {
        let mut rest = titled(area, &title, &about)?;
        for panels in panels.chunks(across) {
            let (mut row, below) = rest.split_vertically(px(f64::from(height)));
            for &(spectrum, key) in panels {
                let (tile, right) = row.split_horizontally(px(f64::from(width)));
                let (heading, tile) = tile.split_vertically(px(NAME));
                let name = shortened(&spectrum.name, LONGEST_NAME) + key.suffix;
                heading.draw(&Text::new(name, (px(LEFT), px(10.0)), words(TEXT, colour::INK)))?;
                panel((area, &tile), spectrum, refinements, key)?;
                row = right;
            }
            rest = below;
        }
        for (i, legend) in legends.iter().enumerate() {
            draw_legend(&rest, LEFT + i as f64 * f64::from(width), legend, map)?;
        }
        Ok(())
    })
}

fn draw_legend(area: &Area, x: f64, swatches: &[&Swatch], map: &Map) -> anyhow::Result<()> {
    for (i, (colour, name)) in swatches.iter().enumerate() {
        let y = LEGEND_LINE * (i as f64 + 0.8);
        let swatch = [(px(x), px(y - 6.0)), (px(x + 18.0), px(y + 6.0))];
        area.draw(&Rectangle::new(swatch, colour.filled()))?;
        area.draw(&Rectangle::new(swatch, stroke(colour::GREY, 0.5)))?;
        area.draw(&Text::new(map.named(name), (px(x + 26.0), px(y)), words(SMALL, colour::INK)))?;
    }
    Ok(())
}

/// Frequency and amplitude of `map` as they are shown: amplitudes in g.
pub fn shown(map: &Map) -> [Axis; 2] {
    let g = if map.is_dimensionless { 1.0 } else { map.structure.parameters().g };
    let in_unit = |axis: &Axis, unit: f64| Axis { values: axis.values.iter().map(|at| at / unit).collect(), ..*axis };
    [in_unit(&map.frequency, 1.0), in_unit(&map.amplitude, g)]
}

pub fn range(axis: &Axis) -> Range<f64> {
    axis.values[0]..axis.values[axis.values.len() - 1]
}

/// A map in the colours of `key` on an area of the whole picture.
fn panel((whole, area): (&Area, &Area), spectrum: &PulseSpectrum, refinements: u32, key: Key) -> anyhow::Result<()> {
    let map = &spectrum.map;
    let [x, y] = shown(map);
    let mut builder = chart(area, 46.0);
    macro_rules! paint {
        ($x:expr, $y:expr) => {{
            let mut chart = builder.build_cartesian_2d($x, $y)?;
            let names = axis_names(map).map(|name| name.replace("omega", "ω").replace("alpha", "α"));
            axes(&mut chart, names.each_ref().map(String::as_str), [8, 8])?;
            cells(whole, &|at| chart.backend_coord(&at), [&x, &y], spectrum, refinements, key)?;
        }};
    }
    match (x.is_log, y.is_log) {
        (false, false) => paint!(range(&x), range(&y)),
        (true, false) => paint!(log_axis(range(&x)), range(&y)),
        (false, true) => paint!(range(&x), log_axis(range(&y))),
        (true, true) => paint!(log_axis(range(&x)), log_axis(range(&y))),
    }
    Ok(())
}

/// A cell about each point of the finest grid, neighbours of one colour drawn as one; `at` maps values of the axes to the picture.
fn cells(
    whole: &Area,
    at: &dyn Fn((f64, f64)) -> (i32, i32),
    [x, y]: [&Axis; 2],
    spectrum: &PulseSpectrum,
    refinements: u32,
    key: Key,
) -> anyhow::Result<()> {
    let (step, parts) = (PARTS >> refinements, 1 << refinements);
    let [columns, rows] = [x, y].map(|axis| (axis.values.len() - 1) * parts + 1);
    // the edge before cell i, in steps of the grid
    let edge = |i: usize| (i as f64 - 0.5) / parts as f64;
    let swatch = |column: usize, row: usize| {
        let place = GridPlace { frequency: column as u32 * step, amplitude: row as u32 * step };
        nearest(&spectrum.points, place, refinements).map(key.of)
    };
    let runs = |row: usize| {
        let colours: Vec<_> = (0..columns).map(|column| swatch(column, row)).collect();
        let mut from = 0;
        let run = |run: &[Option<usize>]| {
            let start = from;
            from += run.len();
            (start, from, run[0])
        };
        colours.chunk_by(|a, b| a == b).map(run).collect::<Vec<_>>()
    };
    let overlap = px(OVERLAP);
    let draw = |(from, to, swatch): (usize, usize, Option<usize>), below: usize, above: usize| {
        let Some(swatch) = swatch else { return Ok(()) };
        let (left, bottom) = at((x.at(edge(from)), y.at(edge(below))));
        let (right, top) = at((x.at(edge(to)), y.at(edge(above))));
        let right = if to == columns { right } else { right + overlap };
        let top = if above == rows { top } else { top - overlap };
        whole.draw(&Rectangle::new([(left, bottom), (right, top)], key.swatches[swatch].0.filled()))
    };
    // a row that is the same as the one below is drawn with it
    let (mut start, mut last) = (0, runs(0));
    for row in 1..=rows {
        let next = if row < rows { runs(row) } else { Vec::new() };
        if next != last {
            last.iter().try_for_each(|run| draw(*run, start, row))?;
            (start, last) = (row, next);
        }
    }
    Ok(())
}
