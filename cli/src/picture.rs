//! The one style of all pictures, and the SVG files that they go into.

use crate::talk::write_as;
use anyhow::bail;
use plotters::coord::combinators::WithKeyPoints;
use plotters::coord::{Shift, ranged1d::ValueFormatter, types::RangedCoordf64};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rocking::digits::short;
use rocking_report::output_files::{OutputFile, OutputFiles};
use std::{ops::Range, path::Path};

/// Colours that all eyes tell apart (Okabe and Ito, their purple darker), and those of what is no data.
pub mod colour {
    use plotters::style::RGBColor;

    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    pub const PURPLE: RGBColor = RGBColor(168, 72, 127);
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    pub const INK: RGBColor = RGBColor(34, 34, 34);
    pub const GREY: RGBColor = RGBColor(110, 110, 110);
    pub const RULE: RGBColor = RGBColor(226, 226, 226);
}

/// Drawing units to a pixel: coordinates of plotters are whole numbers.
const UNITS: i32 = 8;

const FONT: &str = "sans-serif";

/// Width of a line that shows data, pixels.
const LINE: f64 = 1.3;

/// Sizes of words, pixels: titles, names of axes, numbers.
const LARGE: f64 = 14.0;
pub const TEXT: f64 = 11.5;
pub const SMALL: f64 = 11.0;

/// Characters of a title, and of the line below it, that fit.
const LONGEST_TITLE: usize = 90;
const LONGEST_ABOUT: usize = 140;

/// Height of a title, pixels.
pub const TITLE: u32 = 52;

pub fn px(pixels: f64) -> i32 {
    (pixels * f64::from(UNITS)).round() as i32
}

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub struct Picture(OutputFile);

impl Picture {
    /// Begins the picture at `path`, whose extension is `svg`.
    pub fn create(path: &Path, files: &mut OutputFiles) -> anyhow::Result<Picture> {
        match path.extension() {
            Some(extension) if extension == "svg" => Ok(Picture(files.create(path)?)),
            _ => bail!("{}: a picture's name ends in .svg; the Python package draws PNG, too", path.display()),
        }
    }

    /// Writes what `draw` draws on an area of `size`, in pixels.
    pub fn draw(self, size: (u32, u32), draw: impl FnOnce(&Area) -> anyhow::Result<()>) -> anyhow::Result<()> {
        let (mut svg, drawn) = (String::new(), (size.0 * UNITS as u32, size.1 * UNITS as u32));
        {
            let area = SVGBackend::with_string(&mut svg, drawn).into_drawing_area();
            area.fill(&WHITE)?;
            draw(&area)?;
            area.present()?;
        }
        // characters that XML cannot hold, from the name of a record
        svg.retain(|c| !(c < ' ' && c != '\n' || matches!(c, '\u{fffe}' | '\u{ffff}')));
        // the size to show it at; the view box stays in drawing units
        let [drawn, shown] = [drawn, size].map(|(x, y)| format!("width=\"{x}\" height=\"{y}\""));
        write_as(self.0, "picture", svg.replacen(&drawn, &shown, 1).as_bytes())
    }
}

pub fn line(colour: RGBColor) -> ShapeStyle {
    stroke(colour, LINE)
}

pub fn stroke(colour: RGBColor, pixels: f64) -> ShapeStyle {
    colour.stroke_width(px(pixels) as u32)
}

pub type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

pub fn dashed(plot: &mut Plot, points: &[(f64, f64)], colour: RGBColor) -> anyhow::Result<()> {
    let [length, gap] = [5.0, 4.0].map(|pixels| px(pixels) as u32);
    plot.draw_series(DashedLineSeries::new(points.iter().copied(), length, gap, line(colour)))?;
    Ok(())
}

/// Height in pixels of what plotters calls a font of one pixel.
const FONT_HEIGHT: f64 = 1.24;

/// Words of this size in pixels.
pub fn words(size: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, px(size * FONT_HEIGHT)).into_font().color(&colour).pos(Pos::new(HPos::Left, VPos::Center))
}

/// Words that end where they are put.
pub fn words_before(size: f64, colour: RGBColor) -> TextStyle<'static> {
    words(size, colour).pos(Pos::new(HPos::Right, VPos::Center))
}

/// Writes the title of a picture, and what it is about in a line below; returns what is left below them.
pub fn titled<'a>(area: &Area<'a>, title: &str, about: &str) -> anyhow::Result<Area<'a>> {
    let bold = words(LARGE, colour::INK);
    let bold = TextStyle { font: bold.font.style(FontStyle::Bold), ..bold };
    area.draw(&Text::new(shortened(title, LONGEST_TITLE), (px(18.0), px(18.0)), bold))?;
    let about = shortened(about, LONGEST_ABOUT);
    area.draw(&Text::new(about, (px(18.0), px(38.0)), words(TEXT, colour::GREY)))?;
    Ok(area.split_vertically(px(f64::from(TITLE))).1)
}

pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.into(),
    }
}

/// Room around the axes, pixels.
const EDGE: f64 = 16.0;
const NUMBERS: f64 = 62.0;
const RIGHT: f64 = 28.0;
const TOP: f64 = 10.0;

/// A chart on `area` between the margins that all charts have; `below` (pixels) is for the numbers and the name of its
/// horizontal axis.
pub fn chart<'a, 'b>(area: &'b Area<'a>, below: f64) -> ChartBuilder<'b, 'b, SVGBackend<'a>>
where
    'a: 'b,
{
    let mut builder = ChartBuilder::on(area);
    builder
        .margin_top(px(TOP))
        .margin_right(px(RIGHT))
        .margin_left(px(EDGE))
        .set_label_area_size(LabelAreaPosition::Left, px(NUMBERS))
        .set_label_area_size(LabelAreaPosition::Bottom, px(below));
    builder
}

/// Draws the axes of a chart, about as many numbers on each as `numbers` says; one without a name has no numbers.
pub fn axes<X, Y>(
    chart: &mut ChartContext<SVGBackend, Cartesian2d<X, Y>>,
    names: [&str; 2],
    numbers: [usize; 2],
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let (across, up) = (chart.as_coord_spec().get_x_range(), chart.as_coord_spec().get_y_range());
    let x_number = |x: &f64| if names[0].is_empty() { String::new() } else { number(*x, &across) };
    chart
        .configure_mesh()
        .bold_line_style(stroke(colour::RULE, 1.0))
        .light_line_style(TRANSPARENT)
        .axis_style(stroke(colour::GREY, 1.0))
        .set_all_tick_mark_size(px(4.0))
        .x_labels(numbers[0])
        .y_labels(numbers[1])
        .x_label_formatter(&x_number)
        .y_label_formatter(&|y| number(*y, &up))
        .label_style(words(SMALL, colour::INK))
        .axis_desc_style(words(TEXT, colour::INK))
        .x_desc(names[0])
        .y_desc(names[1])
        .draw()?;
    Ok(())
}

/// A logarithmic axis, with numbers at 1, 2, 5, 10, …
pub fn log_axis(range: Range<f64>) -> WithKeyPoints<LogCoord<f64>> {
    let decades = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let numbers = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * 10.0_f64.powi(decade)));
    let inside = numbers.filter(|number| (range.start..=range.end).contains(number)).collect();
    range.log_scale().with_key_points(inside)
}

/// A number beside an axis that has this range: what rounding has left of a round number is no part of it.
fn number(value: f64, range: &Range<f64>) -> String {
    if value.abs() < 1e-9 * (range.end - range.start).abs() {
        return "0".into();
    }
    short(value).replace('-', "−")
}

/// A number in a picture: three digits.
pub fn rounded(value: f64) -> String {
    let decimals = if value == 0.0 { 0.0 } else { 2.0 - value.abs().log10().floor() };
    let is_long = !(-6.0..=9.0).contains(&decimals);
    let number =
        if is_long { format!("{value:.2e}") } else { format!("{value:.*}", decimals.clamp(0.0, 6.0) as usize) };
    number.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beside_an_axis_are_round() {
        let shown = [-0.4, 5.551115123125783e-17, 0.2, 0.30000000000000004, 1.2000000000000002]
            .map(|value| number(value, &(-0.5..0.5)));
        assert_eq!(shown, ["−0.4", "0", "0.2", "0.3", "1.2"]);
        assert_eq!([2e-5, 4e7, 200_000.0].map(|value| number(value, &(0.0..1e-4))), ["2e−5", "4e7", "200000"]);
    }
}
