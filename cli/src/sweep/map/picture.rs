//! The picture of maps: classes as cells, lines of equal rotation, and beside them, where it is known, the condition.
use super::Spectrum;
use crate::picture::{Area, Picture, SMALL, TEXT, TITLE, axes, chart, colour, px, stroke, titled, words, words_about};
use contour::ContourBuilder;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use rocking::run::map::{Axis, Class, Map, Place, Point, finest_step, nearest};

/// Sizes in pixels: of a panel with its axes, of a panel's name, of a line of the legend.
const PANEL: (u32, u32) = (560, 440);
const NAME: f64 = 20.0;
const LEGEND_LINE: f64 = 19.0;

/// Where the axes of a panel begin, pixels.
const LEFT: f64 = 78.0;

/// θ_max/α_cg on the lines.
const LINES: [f64; 4] = [0.1, 0.25, 0.5, 0.75];

/// A cell reaches this much below those that are drawn after it, pixels, so that nothing shines through between them.
const OVERLAP: f64 = 0.5;

/// A colour, and what it stands for.
type Swatch = (RGBColor, &'static str);

const CLASSES: [Swatch; 9] = [
    (RGBColor(240, 240, 240), "no uplift"),
    (RGBColor(214, 234, 248), "rocks and stands, less than 10 impacts"),
    (RGBColor(169, 211, 240), "rocks and stands, 10 to 99 impacts"),
    (RGBColor(120, 178, 222), "rocks and stands, 100 impacts and more"),
    (colour::VERMILLION, "overturns without impact"),
    (colour::ORANGE, "overturns after one impact"),
    (colour::PURPLE, "overturns after more"),
    (colour::GREEN, "still rocking: not decided"),
    (colour::INK, "failed: not decided"),
];

const CONDITIONS: [Swatch; 6] = [
    (RGBColor(240, 240, 240), "amplifies 1e-12 less than 10 times"),
    (RGBColor(214, 234, 248), "10 to 1e3 times"),
    (RGBColor(120, 178, 222), "1e3 to 1e6 times"),
    (colour::ORANGE, "1e6 to 1e10 times"),
    (colour::VERMILLION, "more: 1e-12 moves the answer by more than 1 %"),
    (colour::INK, "1e-12 changes the class"),
];

/// What the colours of a picture stand for.
#[derive(Clone, Copy)]
struct Key {
    /// The number of a point's swatch.
    of: fn(&Point) -> usize,
    swatches: &'static [Swatch],
    /// Whether lines of equal rotation are drawn.
    has_lines: bool,
}

const OF_CLASS: Key = Key { of: class_of, swatches: &CLASSES, has_lines: true };
const OF_CONDITION: Key = Key { of: condition_of, swatches: &CONDITIONS, has_lines: false };

/// What the axes of a picture of `map` are called.
pub fn axis_names(map: &Map) -> [&'static str; 2] {
    if map.is_dimensionless { ["omega/p_l", "a_p/(g tan alpha_cg)"] } else { ["frequency (Hz)", "amplitude a_p (g)"] }
}

fn class_of(point: &Point) -> usize {
    match (point.class(), point.impacts) {
        (Class::NoUplift, _) => 0,
        (Class::Stands, ..10) => 1,
        (Class::Stands, 10..100) => 2,
        (Class::Stands, _) => 3,
        (Class::OverturnsAtOnce, _) => 4,
        (Class::OverturnsAfterOne, _) => 5,
        (Class::OverturnsAfterMore, _) => 6,
        (Class::StillRocking, _) => 7,
        (Class::Failed, _) => 8,
    }
}

fn condition_of(point: &Point) -> usize {
    match point.condition {
        Some(f64::INFINITY) => 5,
        Some(1e10..) => 4,
        Some(1e6..) => 3,
        Some(1e3..) => 2,
        Some(10.0..) => 1,
        _ => 0,
    }
}

/// Draws `spectra`, refined so many times, one below the other.
pub fn draw(picture: Picture, spectra: &[Spectrum], refinements: u32) -> anyhow::Result<()> {
    let Some(Spectrum { map, .. }) = spectra.first() else { return Ok(()) };
    let has_condition = map.finds_condition;
    let columns = if has_condition { 2 } else { 1 };
    let seen = |key: Key| {
        let is_there = |i: usize| spectra.iter().flat_map(|one| one.points.values()).any(|point| (key.of)(point) == i);
        (0..key.swatches.len()).filter(|i| is_there(*i)).map(|i| &key.swatches[i]).collect::<Vec<_>>()
    };
    let (classes, conditions) = (seen(OF_CLASS), seen(OF_CONDITION));
    let legend = (LEGEND_LINE * (classes.len().max(conditions.len()) as f64 + 1.0)) as u32;
    let size = (columns * PANEL.0, TITLE + spectra.len() as u32 * (PANEL.1 + NAME as u32) + legend);
    let title = format!("Overturning spectrum: {}", map.pulse.shape.name().replace('_', " "));
    let about =
        format!("level of detail {}, tolerance {:e}; lines: theta_max/alpha_cg", map.detail.name(), map.tolerance);
    picture.draw(size, |area| {
        let mut rest = titled(area, &title, &about)?;
        for spectrum in spectra {
            let (heading, below) = rest.split_vertically(px(NAME));
            let (row, below) = below.split_vertically(px(f64::from(PANEL.1)));
            let name = |x, name: String| heading.draw(&Text::new(name, (px(x), px(10.0)), words(TEXT, colour::INK)));
            name(LEFT, spectrum.name.clone())?;
            if has_condition {
                name(LEFT + f64::from(PANEL.0), format!("{}: condition", spectrum.name))?;
            }
            let (left, right) = row.split_horizontally(px(f64::from(PANEL.0)));
            panel((area, &left), spectrum, refinements, OF_CLASS)?;
            if has_condition {
                panel((area, &right), spectrum, refinements, OF_CONDITION)?;
            }
            rest = below;
        }
        draw_legend(&rest, LEFT, &classes)?;
        if has_condition {
            draw_legend(&rest, LEFT + f64::from(PANEL.0), &conditions)?;
        }
        Ok(())
    })
}

fn draw_legend(area: &Area, x: f64, swatches: &[&Swatch]) -> anyhow::Result<()> {
    for (i, (colour, name)) in swatches.iter().enumerate() {
        let y = LEGEND_LINE * (i as f64 + 0.8);
        let swatch = [(px(x), px(y - 6.0)), (px(x + 18.0), px(y + 6.0))];
        area.draw(&Rectangle::new(swatch, colour.filled()))?;
        area.draw(&Rectangle::new(swatch, stroke(colour::GREY, 0.5)))?;
        area.draw(&Text::new(*name, (px(x + 26.0), px(y)), words(SMALL, colour::INK)))?;
    }
    Ok(())
}

/// An axis as it is shown: amplitudes in g.
pub struct Shown<'a> {
    axis: &'a Axis,
    unit: f64,
}

impl Shown<'_> {
    /// Frequency and amplitude of `map`.
    pub fn axes(map: &Map) -> [Shown<'_>; 2] {
        let g = if map.is_dimensionless { 1.0 } else { map.structure.parameters().g };
        [Shown { axis: &map.frequency, unit: 1.0 }, Shown { axis: &map.amplitude, unit: g }]
    }

    fn at(&self, steps: f64) -> f64 {
        self.axis.at(steps) / self.unit
    }

    /// How many steps its grid has.
    pub fn steps(&self) -> usize {
        self.axis.values().len() - 1
    }

    /// From its first to its last value.
    pub fn range(&self) -> std::ops::Range<f64> {
        self.at(0.0)..self.at(self.steps() as f64)
    }
}

/// A map in the colours of `key` on an area of the whole picture.
fn panel((whole, area): (&Area, &Area), spectrum: &Spectrum, refinements: u32, key: Key) -> anyhow::Result<()> {
    let map = &spectrum.map;
    let [x, y] = Shown::axes(map);
    let mut builder = chart(area, 46.0);
    macro_rules! paint {
        ($x:expr, $y:expr) => {{
            let mut chart = builder.build_cartesian_2d($x, $y)?;
            axes(&mut chart, axis_names(map), [8, 8])?;
            cells(whole, &chart, [&x, &y], spectrum, refinements, key)?;
            if key.has_lines {
                lines(&mut chart, [&x, &y], spectrum)?;
            }
        }};
    }
    match (x.axis.is_log(), y.axis.is_log()) {
        (false, false) => paint!(x.range(), y.range()),
        (true, false) => paint!(x.range().log_scale(), y.range()),
        (false, true) => paint!(x.range(), y.range().log_scale()),
        (true, true) => paint!(x.range().log_scale(), y.range().log_scale()),
    }
    Ok(())
}

/// A cell about each point of the finest grid, neighbours of one colour drawn as one.
fn cells<X, Y>(
    whole: &Area,
    chart: &ChartContext<SVGBackend, Cartesian2d<X, Y>>,
    [x, y]: [&Shown; 2],
    spectrum: &Spectrum,
    refinements: u32,
    key: Key,
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let (step, parts) = (finest_step(refinements), 1 << refinements);
    let [columns, rows] = [x.steps() * parts + 1, y.steps() * parts + 1];
    // the edge before cell i, in steps of the grid
    let edge = |i: usize| (i as f64 - 0.5) / parts as f64;
    let swatch = |column: usize, row: usize| {
        let place = Place { frequency: column as u32 * step, amplitude: row as u32 * step };
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
    let draw = |(from, to, swatch): (usize, usize, Option<usize>), rows: std::ops::Range<usize>| {
        let Some(swatch) = swatch else { return Ok(()) };
        let (left, bottom) = chart.backend_coord(&(x.at(edge(from)), y.at(edge(rows.start))));
        let (right, top) = chart.backend_coord(&(x.at(edge(to)), y.at(edge(rows.end))));
        let right = if to == columns { right } else { right + overlap };
        let top = if rows.end == y.steps() * parts + 1 { top } else { top - overlap };
        whole.draw(&Rectangle::new([(left, bottom), (right, top)], key.swatches[swatch].0.filled()))
    };
    // a row that is the same as the one below is drawn with it
    let (mut start, mut last) = (0, runs(0));
    for row in 1..=rows {
        let next = if row < rows { runs(row) } else { Vec::new() };
        if next != last {
            last.iter().try_for_each(|run| draw(*run, start..row))?;
            (start, last) = (row, next);
        }
    }
    Ok(())
}

/// Lines of equal θ_max/α_cg through the points of the grid.
fn lines<X, Y>(
    chart: &mut ChartContext<SVGBackend, Cartesian2d<X, Y>>,
    [x, y]: [&Shown; 2],
    spectrum: &Spectrum,
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let thetas: Vec<_> = spectrum.map.grid().map(|place| spectrum.points[&place].theta).collect();
    let [last_x, last_y] = [x, y].map(|axis| axis.steps() as f64);
    let contours = ContourBuilder::new(x.steps() + 1, y.steps() + 1, true).x_origin(-0.5).y_origin(-0.5);
    for (number, line) in (1..).zip(contours.lines(&thetas, &LINES)?) {
        let mut longest: &[(f64, f64)] = &[];
        // rings close along the edges of the map, where there is nothing to be drawn
        let on_edge = |(x, y): (f64, f64)| x <= 0.0 || x >= last_x || y <= 0.0 || y >= last_y;
        let rings: Vec<Vec<_>> = (line.geometry().0.iter())
            .map(|ring| ring.0.iter().map(|at| (at.x.clamp(0.0, last_x), at.y.clamp(0.0, last_y))).collect())
            .collect();
        for ring in &rings {
            for part in ring.chunk_by(|a, b| !(on_edge(*a) && on_edge(*b))).filter(|part| part.len() > 1) {
                let points: Vec<_> = part.iter().map(|(i, j)| (x.at(*i), y.at(*j))).collect();
                chart.draw_series([PathElement::new(points, stroke(colour::INK, 0.7))])?;
                longest = if part.len() > longest.len() { part } else { longest };
            }
        }
        // names stand apart: each further along its line
        if let Some((i, j)) = longest.get(longest.len() * number / (LINES.len() + 1)) {
            let name = Text::new(line.threshold().to_string(), (0, px(-6.0)), words_about(SMALL, colour::INK));
            chart.draw_series([EmptyElement::at((x.at(*i), y.at(*j))) + name])?;
        }
    }
    Ok(())
}
