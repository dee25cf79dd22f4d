//! Panels over one axis of time, and marks at the instants of transitions.

use super::{Area, SMALL, axes, chart, colour, dot, line, px, range, rounded, stroke, words, words_before};
use plotters::prelude::*;
use rocking::{TransitionKind, run::peaks::Peak};
use std::ops::Range;

/// Height of a panel, pixels.
const PANEL: u32 = 148;

/// Height of the marks of one kind, pixels.
const LANE: u32 = 17;

/// Height of the numbers and the name of the axis of time, pixels.
const BELOW: u32 = 46;

/// Height of the axis of a panel that leaves its numbers to the one below.
const NO_NUMBERS: f64 = 6.0;

/// Parts of a pixel within which a line is drawn by its first, least, largest and last point.
const COLUMN: f64 = 0.5;

/// The name of the axis.
const TIME: &str = "time (s)";

/// Points that are joined.
pub type Points = Vec<(f64, f64)>;

/// One line of a panel, in pieces where it is broken.
pub struct Line {
    /// What stands for it in the corner of the panel, if that needs it.
    pub name: &'static str,
    /// Its colour.
    pub colour: RGBColor,
    /// Time (s) and value.
    pub parts: Vec<Points>,
}

/// One panel.
pub struct Panel {
    /// What it shows, with its unit.
    pub name: String,
    /// The last on top.
    pub lines: Vec<Line>,
    /// Instant and value to be marked by a dot, and the words beside it.
    pub peak: Option<(f64, f64, String)>,
    /// From and to.
    pub range: Range<f64>,
}

/// Marks below the panels, one at each instant.
pub struct Marks {
    /// What they mean.
    pub name: &'static str,
    /// Their colour.
    pub colour: RGBColor,
    /// When, s.
    pub times: Vec<f64>,
}

/// Panels over the same time.
pub struct Histories {
    /// From the top.
    pub panels: Vec<Panel>,
    /// Below them, if there are any.
    pub marks: Vec<Marks>,
    /// From and to, s.
    pub time: Range<f64>,
}

impl Panel {
    /// A panel of one line, with its peak marked if there is one; `unit` is how many SI units its own has, and what it is
    /// called.
    pub fn of(name: &str, (per_unit, unit): (f64, &str), colour: RGBColor, points: Points, peak: Peak) -> Panel {
        let points: Points = points.into_iter().map(|(time, value)| (time, value / per_unit)).collect();
        let magnitude = peak.magnitude / per_unit;
        let after = points.partition_point(|(time, _)| *time < peak.time);
        let beside = points[after.saturating_sub(1)..points.len().min(after + 2)].iter();
        // of the points beside the peak the largest has its sign
        let sign = beside.map(|point| point.1).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0).signum();
        let words = format!("{} {unit}", rounded(magnitude));
        Panel {
            name: format!("{name} ({unit})"),
            range: range(points.iter().map(|point| point.1).chain([sign * magnitude])),
            lines: vec![Line { name: "", colour, parts: vec![points] }],
            peak: (magnitude > 0.0).then_some((peak.time, sign * magnitude, words)),
        }
    }

    /// This panel with `more` beside its peak.
    pub fn with(mut self, more: String) -> Panel {
        if let Some((_, _, words)) = &mut self.peak {
            *words += &format!(", {more}");
        }
        self
    }
}

impl Marks {
    /// Marks at transitions of the same kind: uplift, impact, landing and overturning.
    pub fn of(transitions: &[(f64, TransitionKind)]) -> Vec<Marks> {
        let of = |name, colour, is: fn(&TransitionKind) -> bool| {
            let times: Vec<_> = transitions.iter().filter(|(_, kind)| is(kind)).map(|(time, _)| *time).collect();
            (!times.is_empty()).then_some(Marks { name, colour, times })
        };
        [
            of("uplift", colour::GREEN, |kind| matches!(kind, TransitionKind::Uplift(_))),
            of("impact", colour::VERMILLION, |kind| matches!(kind, TransitionKind::Impact(_))),
            of("landing", colour::INK, |kind| matches!(kind, TransitionKind::Landing | TransitionKind::Settling)),
            of("overturning", colour::PURPLE, |kind| matches!(kind, TransitionKind::Overturning(_))),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl Histories {
    /// Its height, pixels.
    pub fn height(&self) -> u32 {
        PANEL * self.panels.len() as u32 + LANE * self.marks.len() as u32 + BELOW
    }

    /// Draws it on an area of its height.
    pub fn draw(&self, area: &Area) -> anyhow::Result<()> {
        let mut rest = area.clone();
        for (i, panel) in self.panels.iter().enumerate() {
            let is_lowest = i + 1 == self.panels.len() && self.marks.is_empty();
            let (below, name) = if is_lowest { (f64::from(BELOW), TIME) } else { (NO_NUMBERS, "") };
            let height = f64::from(PANEL) + if is_lowest { below } else { 0.0 };
            let (upper, lower) = rest.split_vertically(px(height));
            self.draw_panel(panel, &upper, below, name)?;
            rest = lower;
        }
        if self.marks.is_empty() { Ok(()) } else { self.draw_marks(&rest) }
    }

    fn draw_panel(&self, panel: &Panel, area: &Area, below: f64, time: &str) -> anyhow::Result<()> {
        let mut chart = chart(area, below).build_cartesian_2d(self.time.clone(), panel.range.clone())?;
        axes(&mut chart, [time, &panel.name], [10, 5])?;
        let (columns, _) = chart.plotting_area().get_pixel_range();
        let column = (self.time.end - self.time.start) / f64::from(columns.end - columns.start) * f64::from(px(COLUMN));
        for Line { colour, parts, .. } in &panel.lines {
            let parts = parts.iter().map(|points| thinned(points, column));
            chart.draw_series(parts.map(|points| PathElement::new(points, line(*colour))))?;
        }
        let (right, top) = (self.time.end, panel.range.end);
        for (i, Line { name, colour, .. }) in panel.lines.iter().filter(|line| !line.name.is_empty()).enumerate() {
            let at = (px(-4.0), px(8.0 + 15.0 * i as f64));
            let words = Text::new(name.to_owned(), at, words_before(SMALL, *colour));
            chart.draw_series([EmptyElement::at((right, top)) + words])?;
        }
        if let Some((time, value, peak)) = &panel.peak {
            chart.draw_series([dot((*time, *value), 3.0, colour::INK)])?;
            let is_late = *time > self.time.start + 0.85 * (self.time.end - self.time.start);
            let (style, aside) =
                if is_late { (words_before(SMALL, colour::INK), -7.0) } else { (words(SMALL, colour::INK), 7.0) };
            let above = if *value < 0.0 { 7.5 } else { -8.0 };
            let label = EmptyElement::at((*time, *value)) + Text::new(peak.clone(), (px(aside), px(above)), style);
            chart.draw_series([label])?;
        }
        Ok(())
    }

    /// A lane of ticks for each kind of mark, its name before it.
    fn draw_marks(&self, area: &Area) -> anyhow::Result<()> {
        let lanes = self.marks.len();
        let mut chart =
            chart(area, f64::from(BELOW)).margin_top(0).build_cartesian_2d(self.time.clone(), lanes as f64..0.0)?;
        axes(&mut chart, [TIME, ""], [10, 0])?;
        for (i, Marks { name, colour, times }) in self.marks.iter().enumerate() {
            let lane = i as f64;
            let tick =
                |time: &f64| PathElement::new([(*time, lane + 0.18), (*time, lane + 0.82)], stroke(*colour, 1.2));
            chart.draw_series(times.iter().map(tick))?;
            let before = Text::new(name.to_owned(), (px(-8.0), 0), words_before(SMALL, *colour));
            chart.draw_series([EmptyElement::at((self.time.start, lane + 0.5)) + before])?;
        }
        Ok(())
    }
}

/// Of the points of each column in time (s) the first, the least, the largest and the last, in their order: what a line
/// through all of them would cover.
fn thinned(points: &[(f64, f64)], column: f64) -> Points {
    let of_column = |column: &[(f64, f64)]| {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let extremes = [column.iter().min_by(by_value), column.iter().max_by(by_value)]
            .map(|at| *at.expect("of one point at least"));
        let mut kept = [column[0], extremes[0], extremes[1], column[column.len() - 1]].to_vec();
        kept.sort_by(|a, b| a.0.total_cmp(&b.0));
        kept.dedup();
        kept
    };
    points.chunk_by(|a, b| (a.0 / column).floor() == (b.0 / column).floor()).flat_map(of_column).collect()
}
