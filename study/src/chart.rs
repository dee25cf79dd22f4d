//! Charts: panels with linear or logarithmic axes, names beside the curves or the panel, colours that the colour-blind can tell apart.

use anyhow::{Context, Result};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::Path;

/// The colours of Okabe and Ito, where they are too light darkened: all have a contrast of 3 to 1 on white and on the pale grey.
#[allow(missing_docs)] // they are called what they are
pub mod colour {
    use plotters::style::RGBColor;

    pub const BLACK: RGBColor = RGBColor(0, 0, 0);
    pub const WHITE: RGBColor = RGBColor(255, 255, 255);
    pub const ORANGE: RGBColor = RGBColor(160, 110, 0);
    pub const SKY: RGBColor = RGBColor(28, 120, 180);
    pub const GREEN: RGBColor = RGBColor(0, 145, 105);
    pub const BLUE: RGBColor = RGBColor(0, 90, 150);
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
    pub const PURPLE: RGBColor = RGBColor(180, 80, 140);
    pub const GREY: RGBColor = RGBColor(100, 100, 100);
    pub const BROWN: RGBColor = RGBColor(125, 60, 20);
    pub const PALE: RGBColor = RGBColor(228, 228, 228);
}

/// How a series of points is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    pub colour: RGBColor,
    pub width: u32, // width of the line; 0 for points alone
    pub dashed: bool,
    pub marker: Marker, // at each point
}

/// A mark at a point, hollow but for the circle: of marks at one place all are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    None,
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross, // failed
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
    pub name: String,              // none if empty
    pub points: Vec<(f64, f64)>,   // in data units
    pub named: Option<(f64, f64)>, // where the name begins; None: at the right of the panel, at the height of the last point on both axes
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

    /// Place of `value` on the axis: its decimal logarithm on a logarithmic axis.
    fn place(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }

    fn range(&self) -> Range<f64> {
        self.place(self.low)..self.place(self.high)
    }

    /// Place of `value` on the axis, if the axis covers it up to rounding.
    fn visible(&self, value: f64) -> Option<f64> {
        let Range { start, end } = self.range();
        let rounding = 1e-9 * (end - start);
        Some(self.place(value)).filter(|place| (start - rounding..=end + rounding).contains(place))
    }

    /// How many numbers it has at most: few enough for those of a logarithmic axis to be at decades.
    fn numbers(&self) -> usize {
        let Range { start, end } = self.range();
        if self.logarithmic { (end.floor() - start.ceil() + 1.0).min(10.0) as usize } else { 7 }
    }

    fn number(&self, place: f64) -> String {
        if self.logarithmic {
            return power_of_ten(place.round() as i64);
        }
        ((1e9 * place).round() / 1e9).to_string().replace('-', "−")
    }
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
    let raise = |c: char| {
        c.to_digit(10).map_or('⁻', |digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize])
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

/// One pair of axes with what is drawn on it.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,                              // above it
    pub x: Axis,                                    // across
    pub y: Axis,                                    // up
    pub areas: Vec<[(f64, f64); 2]>,                // pale rectangles with a rim behind the data, from corner to corner
    pub series: Vec<Series>,                        // the data, the first on top
    pub notes: Vec<((f64, f64), String, RGBColor)>, // words that begin at a point, on top of the data
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
        self.series.push(Series { name: name.into(), points: points.into_iter().collect(), named: None, style });
        self
    }

    /// With the name of the newest points at a point, and not at the right of the panel.
    pub fn named(mut self, at: (f64, f64)) -> Panel {
        self.series.last_mut().expect("there are points").named = Some(at);
        self
    }

    /// With these words, which begin at a point.
    pub fn note(mut self, at: (f64, f64), text: impl Into<String>, colour: RGBColor) -> Panel {
        self.notes.push((at, text.into(), colour));
        self
    }

    /// With a pale rectangle behind the data.
    pub fn area(mut self, from: (f64, f64), to: (f64, f64)) -> Panel {
        self.areas.push([from, to]);
        self
    }
}

/// Panels in rows.
pub struct Figure {
    pub title: String,       // on top: what it finds
    pub description: String, // what it shows, for those who do not see it
    pub columns: usize,      // panels in a row
    pub panels: Vec<Panel>,  // row by row
}

/// Size of one panel; all lengths here are in the picture's own units, an eighth of a pixel on the page, so that curves are smooth.
const PANEL: (u32, u32) = (4400, 3200);
const TITLE_HEIGHT: u32 = 340;
const TITLES: u32 = 136; // size of the title and of the panels' titles
const MARGIN: u32 = 96;
const NAMES: u32 = 1720; // at the right of a panel, for the names of its series
const WORDS: u32 = 116; // size of names, notes and numbers
const BESIDE: i32 = 100; // from a point to its name
const FONT: &str = "sans-serif";

type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Figure {
    /// Writes it as SVG, with title and description, and letters that stand out from the lines below them.
    pub fn save(&self, path: &Path) -> Result<()> {
        let mut svg = String::new();
        self.draw(&mut svg).with_context(|| path.display().to_string())?;
        let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
        let (title, description) = (escaped(&self.title), escaped(&self.description));
        let style = "text{paint-order:stroke;stroke:#fff;stroke-width:24px;stroke-linejoin:round}";
        let head =
            format!(" role=\"img\">\n<title>{title}</title>\n<desc>{description}</desc>\n<style>{style}</style>");
        let (width, height) = self.size();
        let in_units = format!("width=\"{width}\" height=\"{height}\"");
        let in_pixels = format!("width=\"{}\" height=\"{}\"", width / 8, height / 8);
        Ok(std::fs::write(path, svg.replacen(&in_units, &in_pixels, 1).replacen('>', &head, 1))?)
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

    /// Width and height.
    fn size(&self) -> (u32, u32) {
        (PANEL.0 * self.columns as u32, TITLE_HEIGHT + PANEL.1 * self.rows() as u32)
    }

    fn draw(&self, svg: &mut String) -> Result<()> {
        let root = SVGBackend::with_string(svg, self.size()).into_drawing_area();
        root.fill(&WHITE)?;
        let bold = TextStyle::from((FONT, TITLES, FontStyle::Bold)).pos(Pos::new(HPos::Center, VPos::Center));
        root.draw(&Text::new(self.title.as_str(), (self.size().0 as i32 / 2, TITLE_HEIGHT as i32 / 2), bold))?;
        let area = root.split_vertically(TITLE_HEIGHT).1;
        for (panel, area) in self.panels.iter().zip(area.split_evenly((self.rows(), self.columns))) {
            panel.draw(&area)?;
        }
        Ok(root.present()?)
    }
}

impl Panel {
    fn draw(&self, area: &Drawing) -> Result<()> {
        let mut chart = ChartBuilder::on(area)
            .margin(MARGIN)
            .margin_right(if self.series.iter().all(|series| series.name.is_empty() || series.named.is_some()) {
                2 * MARGIN
            } else {
                NAMES
            })
            .caption(&self.title, (FONT, TITLES))
            .x_label_area_size(400)
            .y_label_area_size(580)
            .build_cartesian_2d(self.x.range(), self.y.range())?;
        let place = |point: &(f64, f64)| (self.x.place(point.0), self.y.place(point.1));
        for corners in &self.areas {
            let corners = [0, 1].map(|k| place(&corners[k]));
            let rim = colour::GREY.stroke_width(8);
            chart.draw_series([colour::PALE.filled(), rim].map(|style| Rectangle::new(corners, style)))?;
        }
        chart
            .configure_mesh()
            .bold_line_style(BLACK.mix(0.12).stroke_width(8))
            .light_line_style(TRANSPARENT)
            .axis_style(BLACK.mix(0.6).stroke_width(8))
            .x_labels(self.x.numbers())
            .y_labels(self.y.numbers())
            .x_label_formatter(&|x| self.x.number(*x))
            .y_label_formatter(&|y| self.y.number(*y))
            .label_style((FONT, WORDS))
            .axis_desc_style((FONT, WORDS))
            .set_all_tick_mark_size(20)
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .draw()?;
        let (left, top) = area.get_base_pixel();
        let (across, down) = chart.plotting_area().get_pixel_range();
        let aside = across.end - left + 2 * BESIDE; // of the names at the right
        let pixel = |point| {
            let (x, y) = chart.backend_coord(&point);
            (x - left, y - top)
        };
        let mut names = Vec::new();
        for Series { name, points, named, style } in self.series.iter().rev() {
            // A line ends at the last point that is on both axes.
            let pixels: Vec<_> =
                points.iter().map(|(x, y)| Some(pixel((self.x.visible(*x)?, self.y.visible(*y)?)))).collect();
            for line in pixels.split(Option::is_none) {
                draw_line(area, &line.iter().copied().flatten().collect::<Vec<_>>(), *style)?;
            }
            for at in pixels.iter().flatten() {
                draw_marker(area, *at, *style)?;
            }
            let end = pixels.into_iter().flatten().next_back().filter(|_| !name.is_empty());
            names.extend(end.map(|(_, y)| match named {
                Some(at) => Name { at: pixel(place(at)), text: name, style: Style { marker: Marker::None, ..*style } },
                None => Name { at: (aside, y), text: name, style: *style },
            }));
        }
        names.extend(self.notes.iter().map(|(at, text, colour)| Name {
            at: pixel(place(at)),
            text,
            style: Style::line(*colour, 0),
        }));
        names.sort_by_key(|name| (name.at.1, name.at.0));
        draw_names(area, down.start - top..down.end - top, names)
    }
}

/// Words that begin right of a point, after the mark of their style.
struct Name<'a> {
    at: (i32, i32),
    text: &'a str,
    style: Style,
}

/// Names in turn: each as near below its point as there is room within the frame, whose top and bottom are
/// given, or else above it.
fn draw_names(area: &Drawing, frame: Range<i32>, names: Vec<Name>) -> Result<()> {
    let line_height = WORDS as i32 + 8;
    let mut drawn: Vec<(Range<i32>, Range<i32>)> = Vec::new(); // from left to right, from top to bottom
    for Name { at: (x, y), text, style } in names {
        let lines = broken(text);
        let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let across = x..x + BESIDE + longest as i32 * WORDS as i32 * 3 / 5;
        let down = |y: i32| y - line_height / 2..y - line_height / 2 + lines.len() as i32 * line_height;
        let meet = |a: &Range<i32>, b: &Range<i32>| a.start < b.end && b.start < a.end;
        let is_free = |y: &i32| {
            let down = down(*y);
            let is_within = frame.start <= down.start && down.end <= frame.end;
            is_within && !drawn.iter().any(|other| meet(&other.0, &across) && meet(&other.1, &down))
        };
        let mut places = (y..frame.end).chain((frame.start..y).rev());
        let y = places.find(is_free).with_context(|| format!("no room for {text:?}"))?;
        draw_marker(area, (x, y), style)?;
        for (line, y) in lines.iter().zip((y..).step_by(line_height as usize)) {
            let style = TextStyle { color: style.colour.to_backend_color(), ..TextStyle::from((FONT, WORDS)) };
            area.draw(&Text::new(line.as_str(), (x + BESIDE, y), style.pos(Pos::new(HPos::Left, VPos::Center))))?;
        }
        drawn.push((across, down(y)));
    }
    Ok(())
}

/// The lines of a name: a line ends at a comma, and before it would be too long for [`NAMES`].
fn broken(name: &str) -> Vec<String> {
    const LONGEST: usize = 26; // letters
    let mut lines: Vec<String> = Vec::new();
    for word in name.split(' ') {
        match lines
            .last_mut()
            .filter(|line| !line.ends_with(',') && line.chars().count() + word.chars().count() < LONGEST)
        {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.into()),
        }
    }
    lines
}

fn draw_line(area: &Drawing, points: &[(i32, i32)], style: Style) -> Result<()> {
    let line = style.colour.stroke_width(8 * style.width);
    if style.width == 0 || points.len() < 2 {
        return Ok(());
    }
    match style.dashed {
        true => area.draw(&DashedPathElement::new(points.iter().copied(), 56, 40, line))?,
        false => area.draw(&PathElement::new(points, line))?,
    }
    Ok(())
}

fn draw_marker(area: &Drawing, (x, y): (i32, i32), style: Style) -> Result<()> {
    let line = style.colour.stroke_width(14);
    let outline = |points: &[(i32, i32)]| {
        let corners = points.iter().cycle().take(points.len() + 1).map(|(dx, dy)| (x + dx, y + dy));
        area.draw(&PathElement::new(corners.collect::<Vec<_>>(), line))
    };
    match style.marker {
        Marker::None => (),
        Marker::Circle => area.draw(&Circle::new((x, y), 34, style.colour.filled()))?,
        Marker::Square => outline(&[(-34, -34), (34, -34), (34, 34), (-34, 34)])?,
        Marker::Triangle => outline(&[(-42, 30), (0, -46), (42, 30)])?,
        Marker::Diamond => outline(&[(-46, 0), (0, -46), (46, 0), (0, 46)])?,
        Marker::Cross => area.draw(&Cross::new((x, y), 38, line))?,
    }
    Ok(())
}
