//! Charts: panels with linear or logarithmic axes, a legend beside the data, colours that the colour-blind can tell
//! apart.

use anyhow::{Result, anyhow};
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fs;
use std::ops::Range;
use std::path::Path;

/// The colours of Okabe and Ito, the yellow left out for want of contrast.
#[allow(missing_docs)] // they are called what they are
pub mod colour {
    use plotters::style::RGBColor;

    pub const BLACK: RGBColor = RGBColor(0, 0, 0);
    pub const WHITE: RGBColor = RGBColor(255, 255, 255);
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
    pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
    pub const GREY: RGBColor = RGBColor(120, 120, 120);
    pub const PALE: RGBColor = RGBColor(228, 228, 228);
}

/// How a series of points is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    pub colour: RGBColor,
    pub width: u32, // width of the line, pixels; 0 for points alone
    pub dashed: bool,
    pub marker: Marker, // at each point
}

/// A mark at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    None,
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross, // A cross: failed
}

impl Style {
    /// A plain line.
    pub const fn line(colour: RGBColor, width: u32) -> Style {
        Style { colour, width, dashed: false, marker: Marker::None }
    }

    /// A dashed line.
    pub const fn dashed(colour: RGBColor, width: u32) -> Style {
        Style { dashed: true, ..Style::line(colour, width) }
    }

    /// A line with marks.
    pub const fn marked(colour: RGBColor, width: u32, marker: Marker) -> Style {
        Style { marker, ..Style::line(colour, width) }
    }
}

/// Points and how they are drawn.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub points: Vec<(f64, f64)>, // in data units
    pub style: Style,
}

/// One axis.
#[derive(Clone, Debug)]
pub struct Axis {
    pub label: String, // what it shows, with its unit
    pub low: f64,      // from, in data units
    pub high: f64,
    pub logarithmic: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>, low: f64, high: f64) -> Axis {
        Axis { label: label.into(), low, high, logarithmic: false }
    }

    /// A logarithmic axis.
    pub fn logarithmic(label: impl Into<String>, low: f64, high: f64) -> Axis {
        Axis { label: label.into(), low, high, logarithmic: true }
    }

    /// Data units → parts of the axis, from 0 at its low end to 1.
    fn part(&self, value: f64) -> f64 {
        let (low, high) = (self.scale(self.low), self.scale(self.high));
        // What a logarithm cannot show is far below the axis.
        let at = if self.logarithmic && value <= 0.0 { low - 100.0 } else { self.scale(value) };
        (at - low) / (high - low)
    }

    fn scale(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }

    fn coordinate(&self) -> Ticked {
        Ticked { range: self.scale(self.low)..self.scale(self.high), ticks: self.ticks() }
    }

    /// Where there are numbers, in axis units: at decades, or at 1, 2 or 5 times a power of ten.
    fn ticks(&self) -> Vec<f64> {
        let (low, high) = (self.scale(self.low), self.scale(self.high));
        let step = if self.logarithmic { ((high - low) / 9.0).ceil().max(1.0) } else { nice((high - low) / 6.0) };
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        (first..=last).map(|k| k as f64 * step).collect()
    }

    fn number(&self, tick: f64) -> String {
        if self.logarithmic {
            return power_of_ten(tick.round() as i64);
        }
        let step = nice((self.high - self.low) / 6.0);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        let tick = if tick.abs() < 1e-9 * step { 0.0 } else { tick };
        format!("{tick:.digits$}").replace('-', "−")
    }
}

/// An axis of plotters that has its ticks where it is told.
struct Ticked {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let part = (value - self.range.start) / (self.range.end - self.range.start);
        first + (part * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
fn nice(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|nice| *nice >= step * (1.0 - 1e-9))
        .unwrap_or(step)
}

/// 10 with its exponent raised; 1, 10 and 100 as they are.
pub fn power_of_ten(exponent: i64) -> String {
    match exponent {
        0 => "1".into(),
        1 => "10".into(),
        2 => "100".into(),
        _ => format!("10{}", raised(exponent)),
    }
}

fn raised(exponent: i64) -> String {
    let raise = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
    };
    exponent.to_string().chars().map(raise).collect()
}

/// `value` to two digits, as 1.5·10⁻⁷.
pub fn scientific(value: f64) -> String {
    let text = format!("{value:.1e}");
    match text.split_once('e') {
        Some((digits, "0")) => digits.into(),
        Some((digits, exponent)) => format!("{digits}·10{}", raised(exponent.parse().unwrap_or(0))),
        None => text,
    }
}

/// A filled rectangle behind the data.
#[derive(Clone, Copy, Debug)]
pub struct Area {
    pub x: (f64, f64), // from and to, in data units
    pub y: (f64, f64), // from and to, in data units
    pub colour: RGBColor,
}

/// Words at a point.
#[derive(Clone, Debug)]
pub struct Note {
    pub at: (f64, f64), // in data units
    pub text: String,
    pub colour: RGBColor,
    pub ends_there: bool, // whether they end at the point instead of beginning there
}

/// One pair of axes with what is drawn on it.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,       // above it
    pub x: Axis,             // across
    pub y: Axis,             // up
    pub areas: Vec<Area>,    // behind everything
    pub series: Vec<Series>, // the data, the last on top
    pub notes: Vec<Note>,    // on top of the data
}

impl Panel {
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Panel {
        Panel { title: title.into(), x, y, areas: Vec::new(), series: Vec::new(), notes: Vec::new() }
    }

    /// With these points, called `name`.
    pub fn with(
        mut self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
        style: Style,
    ) -> Panel {
        self.series.push(Series { name: name.into(), points: points.into_iter().collect(), style });
        self
    }

    /// With these words, which begin at a point.
    pub fn note(mut self, at: (f64, f64), text: impl Into<String>, colour: RGBColor) -> Panel {
        self.notes.push(Note { at, text: text.into(), colour, ends_there: false });
        self
    }

    /// With these words, which end at a point.
    pub fn label(mut self, at: (f64, f64), text: impl Into<String>, colour: RGBColor) -> Panel {
        self.notes.push(Note { at, text: text.into(), colour, ends_there: true });
        self
    }

    /// With a rectangle behind the data.
    pub fn area(mut self, x: (f64, f64), y: (f64, f64), colour: RGBColor) -> Panel {
        self.areas.push(Area { x, y, colour });
        self
    }
}

/// What a line means.
#[derive(Clone, Debug)]
pub struct Entry {
    pub text: String,
    pub style: Style,
}

impl Entry {
    pub fn new(text: impl Into<String>, style: Style) -> Entry {
        Entry { text: text.into(), style }
    }
}

/// Panels in rows, a legend below them.
pub struct Figure {
    pub title: String,         // on top
    pub panel: (u32, u32),     // size of one panel, pixels
    pub columns: usize,        // panels in a row
    pub panels: Vec<Panel>,    // row by row
    pub legend_columns: usize, // columns of the legend
    pub legend: Vec<Entry>,    // the legend, column by column
}

/// Drawing units to a pixel: coordinates are whole numbers.
const SCALE: u32 = 4;

const FONT: &str = "sans-serif";
const TITLE_HEIGHT: u32 = 44 * SCALE;
const LEGEND_ROW: u32 = 24 * SCALE;
const MARGIN: u32 = 12 * SCALE;

/// `pixels` in drawing units.
const fn units(pixels: i32) -> i32 {
    pixels * SCALE as i32
}

impl Figure {
    /// Writes it as SVG.
    pub fn save(&self, path: &Path) -> Result<()> {
        let (width, height) = self.size();
        let mut svg = String::new();
        self.draw(&mut svg).map_err(|error| anyhow!("{}: {error}", path.display()))?;
        // The size to show it at; the view box stays in drawing units.
        let drawn = format!(r#"width="{width}" height="{height}""#);
        let shown = format!(r#"width="{}" height="{}""#, width / SCALE, height / SCALE);
        fs::write(path, svg.replacen(&drawn, &shown, 1))?;
        Ok(())
    }

    /// Writes the points of all its series as CSV.
    pub fn save_numbers(&self, path: &Path) -> Result<()> {
        let mut csv = csv::Writer::from_path(path)?;
        csv.write_record(["panel", "series", "x", "y"])?;
        for panel in &self.panels {
            for Series { name, points, .. } in &panel.series {
                for (x, y) in points {
                    csv.write_record([&panel.title, name, &format!("{x:.6e}"), &format!("{y:.6e}")])?;
                }
            }
        }
        Ok(csv.flush()?)
    }

    fn rows(&self) -> usize {
        self.panels.len().div_ceil(self.columns)
    }

    fn legend_rows(&self) -> u32 {
        self.legend.len().div_ceil(self.legend_columns.max(1)) as u32
    }

    /// Width and height, drawing units.
    fn size(&self) -> (u32, u32) {
        let panels = SCALE * self.panel.1 * self.rows() as u32;
        (SCALE * self.panel.0 * self.columns as u32, TITLE_HEIGHT + panels + LEGEND_ROW * self.legend_rows() + MARGIN)
    }

    fn draw(&self, svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let (rows, (width, height)) = (self.rows(), self.size());
        let root = SVGBackend::with_string(svg, (width, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let bold = TextStyle::from((FONT, units(20), FontStyle::Bold)).pos(Pos::new(HPos::Center, VPos::Center));
        root.draw(&Text::new(self.title.clone(), (width as i32 / 2, TITLE_HEIGHT as i32 / 2), bold))?;
        let (_, below) = root.split_vertically(TITLE_HEIGHT);
        let (panels, legend) = below.split_vertically(SCALE * self.panel.1 * rows as u32);
        for (panel, area) in self.panels.iter().zip(panels.split_evenly((rows, self.columns))) {
            panel.draw(&area)?;
        }
        self.draw_legend(&legend)?;
        root.present()?;
        Ok(())
    }

    fn draw_legend(&self, area: &Drawing) -> Result<(), Box<dyn std::error::Error>> {
        let rows = self.legend_rows();
        let column_width = (self.size().0 - 2 * MARGIN) as usize / self.legend_columns.max(1);
        for (k, entry) in self.legend.iter().enumerate() {
            let (column, row) = (k / rows as usize, k % rows as usize);
            let x = units(52) + (column * column_width) as i32;
            let y = (row as u32 * LEGEND_ROW + LEGEND_ROW / 2) as i32;
            draw_line(area, &[(x, y), (x + units(44), y)], entry.style)?;
            draw_marker(area, (x + units(22), y), entry.style)?;
            let style = TextStyle::from((FONT, units(15))).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(entry.text.clone(), (x + units(54), y), style))?;
        }
        Ok(())
    }
}

type Drawing<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

impl Panel {
    fn draw(&self, area: &Drawing) -> Result<(), Box<dyn std::error::Error>> {
        let mut chart = ChartBuilder::on(area)
            .margin(MARGIN)
            .margin_top(units(36))
            .margin_right(units(26))
            .x_label_area_size(units(48))
            .y_label_area_size(units(70))
            .build_cartesian_2d(self.x.coordinate(), self.y.coordinate())?;
        let (columns, rows) = chart.plotting_area().get_pixel_range();
        let (left, top) = area.get_base_pixel();
        let pixel = |part: (f64, f64)| {
            let x = f64::from(columns.start) + part.0 * f64::from(columns.end - columns.start);
            let y = f64::from(rows.end) - part.1 * f64::from(rows.end - rows.start);
            (x.round() as i32 - left, y.round() as i32 - top)
        };
        let part = |point: (f64, f64)| (self.x.part(point.0), self.y.part(point.1));
        for Area { x, y, colour } in &self.areas {
            let corners = [pixel(part((x.0, y.0))), pixel(part((x.1, y.1)))];
            area.draw(&Rectangle::new(corners, colour.filled()))?;
        }
        chart
            .configure_mesh()
            .bold_line_style(BLACK.mix(0.12).stroke_width(SCALE))
            .light_line_style(TRANSPARENT)
            .axis_style(BLACK.mix(0.6).stroke_width(SCALE))
            .set_all_tick_mark_size(units(5))
            .x_label_formatter(&|x| self.x.number(*x))
            .y_label_formatter(&|y| self.y.number(*y))
            .label_style((FONT, units(14)))
            .axis_desc_style((FONT, units(15)))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .draw()?;
        let style = TextStyle::from((FONT, units(17))).pos(Pos::new(HPos::Center, VPos::Center));
        let middle = (columns.start + columns.end) / 2 - left;
        area.draw(&Text::new(self.title.clone(), (middle, units(20)), style))?;
        for series in &self.series {
            let parts: Vec<_> = series.points.iter().map(|point| part(*point)).collect();
            for piece in visible(&parts) {
                draw_line(area, &piece.into_iter().map(pixel).collect::<Vec<_>>(), series.style)?;
            }
            for at in parts.into_iter().filter(|at| is_visible(*at)) {
                draw_marker(area, pixel(at), series.style)?;
            }
        }
        for Note { at, text, colour, ends_there } in &self.notes {
            let (h, shift) = if *ends_there { (HPos::Right, units(-6)) } else { (HPos::Left, units(6)) };
            let style = TextStyle::from((FONT, units(14))).color(colour).pos(Pos::new(h, VPos::Center));
            let (x, y) = pixel(part(*at));
            area.draw(&Text::new(text.clone(), (x + shift, y), style))?;
        }
        Ok(())
    }
}

/// Rounding that still counts as on the axis.
const EDGE: f64 = 1e-9;

fn is_visible(part: (f64, f64)) -> bool {
    let on_axis = |part: f64| (-EDGE..=1.0 + EDGE).contains(&part);
    on_axis(part.0) && on_axis(part.1)
}

/// The pieces of a polyline that lie within both axes.
fn visible(parts: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut is_open = false;
    for pair in parts.windows(2) {
        let Some((from, to)) = clip(pair[0], pair[1]) else {
            is_open = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if is_open => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        is_open = to == pair[1];
    }
    pieces
}

/// A point on a panel, in parts of its axes.
type Part = (f64, f64);

/// The part of a segment that lies within both axes.
fn clip(from: Part, to: Part) -> Option<(Part, Part)> {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for (start, end) in [(from.0, to.0), (from.1, to.1)] {
        for (distance, slope) in [(start + EDGE, end - start), (1.0 + EDGE - start, start - end)] {
            if slope == 0.0 && distance < 0.0 {
                return None;
            } else if slope > 0.0 {
                first = first.max(-distance / slope);
            } else if slope < 0.0 {
                last = last.min(-distance / slope);
            }
        }
    }
    let at = |s: f64| (from.0 + s * (to.0 - from.0), from.1 + s * (to.1 - from.1));
    (first <= last).then(|| (if first > 0.0 { at(first) } else { from }, if last < 1.0 { at(last) } else { to }))
}

/// Lengths of dash and gap.
const DASH: (f64, f64) = (7.0 * SCALE as f64, 5.0 * SCALE as f64);

fn draw_line(area: &Drawing, points: &[(i32, i32)], style: Style) -> Result<(), Box<dyn std::error::Error>> {
    let line = style.colour.stroke_width(style.width * SCALE);
    let draw = |points: Vec<(i32, i32)>| area.draw(&PathElement::new(points, line)).map_err(|e| e.to_string());
    if style.width == 0 || points.len() < 2 {
        return Ok(());
    }
    if !style.dashed {
        return Ok(draw(points.to_vec())?);
    }
    let mut travelled = 0.0;
    let (dash, period) = (DASH.0, DASH.0 + DASH.1);
    for pair in points.windows(2) {
        let (from, to) = ((f64::from(pair[0].0), f64::from(pair[0].1)), (f64::from(pair[1].0), f64::from(pair[1].1)));
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let at = |s: f64| {
            let part = if length > 0.0 { ((s - travelled) / length).clamp(0.0, 1.0) } else { 0.0 };
            ((from.0 + part * (to.0 - from.0)).round() as i32, (from.1 + part * (to.1 - from.1)).round() as i32)
        };
        let mut start = (travelled / period).floor() * period;
        while start < travelled + length {
            if start + dash > travelled {
                draw(vec![at(start), at(start + dash)])?;
            }
            start += period;
        }
        travelled += length;
    }
    Ok(())
}

fn draw_marker(area: &Drawing, (x, y): (i32, i32), style: Style) -> Result<(), Box<dyn std::error::Error>> {
    let polygon = |corners: &[(i32, i32)]| {
        let corners: Vec<_> = corners.iter().map(|(dx, dy)| (x + units(*dx), y + units(*dy))).collect();
        area.draw(&Polygon::new(corners, style.colour.filled()))
    };
    let drawn = match style.marker {
        Marker::None => Ok(()),
        Marker::Circle => area.draw(&Circle::new((x, y), units(4), style.colour.filled())),
        Marker::Square => polygon(&[(-4, -4), (4, -4), (4, 4), (-4, 4)]),
        Marker::Triangle => polygon(&[(-5, 4), (5, 4), (0, -5)]),
        Marker::Diamond => polygon(&[(-5, 0), (0, -5), (5, 0), (0, 5)]),
        Marker::Cross => area.draw(&Cross::new((x, y), units(5), style.colour.stroke_width(2 * SCALE))),
    };
    Ok(drawn.map_err(|error| error.to_string())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_have_their_numbers() {
        let axis = Axis::linear("", -1.2, 0.4);
        let numbers: Vec<_> = axis.ticks().into_iter().map(|tick| axis.number(tick)).collect();
        assert_eq!(numbers, ["−1.0", "−0.5", "0.0"]);
        let axis = Axis::logarithmic("", 1e-12, 100.0);
        let numbers: Vec<_> = axis.ticks().into_iter().map(|tick| axis.number(tick)).collect();
        assert_eq!(numbers, ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "1", "100"]);
    }

    #[test]
    fn numbers_are_written_with_two_digits() {
        assert_eq!(scientific(1.234e-7), "1.2·10⁻⁷");
        assert_eq!(scientific(2.0), "2.0");
        assert_eq!(scientific(34_500.0), "3.4·10⁴");
    }

    #[test]
    fn lines_end_at_the_axes() {
        let pieces = visible(&[(-1.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.75, 2.0), (0.75, 0.0)]);
        assert_eq!(pieces.len(), 2);
        let near = |a: Part, b: Part| (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-6;
        let expected = [vec![(0.0, 0.5), (0.5, 0.5), (0.5, 1.0)], vec![(0.75, 1.0), (0.75, 0.0)]];
        for (piece, expected) in pieces.iter().zip(&expected) {
            assert!(
                piece.len() == expected.len() && piece.iter().zip(expected).all(|(a, b)| near(*a, *b)),
                "{piece:?}"
            );
        }
    }
}
