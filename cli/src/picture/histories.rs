//! Panels over one axis of time, and marks at the instants of transitions.

use super::{Area, SMALL, axes, chart, colour, dashed, dot, line, px, rounded, stroke, words, words_before};
use plotters::prelude::*;
use rocking::{TransitionKind, run::peaks::Peak};
use std::ops::Range;

/// Height of a panel, pixels.
const PANEL: u32 = 148;

/// Height of the marks of one kind, pixels.
const LANE: u32 = 17;

/// Height of the numbers and the name of the axis of time, pixels.
const BELOW: u32 = 46;

/// Height of the axis of a panel, which leaves its numbers to that of the marks.
const NO_NUMBERS: f64 = 6.0;

/// Points that are joined: time (s) and value.
pub type Points = Vec<(f64, f64)>;

/// One panel.
pub struct Panel {
    /// Name and unit of the history.
    name: String,
    colour: RGBColor,
    points: Points,
    /// Instant and value to be marked by a dot, and the words beside it.
    peak: Option<(f64, f64, String)>,
}

/// Name of a mark, its colour, and the test for the transitions that it marks.
type Mark = (&'static str, RGBColor, fn(&TransitionKind) -> bool);

/// The marks below the panels, a kind to a lane.
const MARKS: [Mark; 4] = [
    ("uplift", colour::GREEN, |kind| matches!(kind, TransitionKind::Uplift(_))),
    ("impact", colour::VERMILLION, |kind| matches!(kind, TransitionKind::Impact(_))),
    ("landing", colour::INK, |kind| matches!(kind, TransitionKind::Landing | TransitionKind::Settling)),
    ("overturning", colour::PURPLE, |kind| matches!(kind, TransitionKind::Overturning(_))),
];

/// Panels over the same time.
pub struct Histories {
    /// From the top.
    pub panels: Vec<Panel>,
    /// Transitions to mark below the panels, with their instants (s).
    pub transitions: Vec<(f64, TransitionKind)>,
    /// From and to, s.
    pub time: Range<f64>,
    /// Instant (s) from which the structure falls: a dashed line.
    pub fall: Option<f64>,
}

impl Panel {
    /// A panel with its peak marked if there is one; `unit` is how many SI units its own has, and what it is called.
    pub fn of(name: &str, (per_unit, unit): (f64, &str), colour: RGBColor, points: Points, peak: Peak) -> Panel {
        let points: Points = points.into_iter().map(|(time, value)| (time, value / per_unit)).collect();
        let magnitude = peak.magnitude / per_unit;
        let after = points.partition_point(|(time, _)| *time < peak.time);
        let beside = points[after.saturating_sub(1)..points.len().min(after + 2)].iter();
        // of the points beside the peak the largest has its sign
        let sign = beside.map(|point| point.1).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0).signum();
        let words = format!("{} {unit}", rounded(magnitude));
        let peak = (magnitude > 0.0).then_some((peak.time, sign * magnitude, words));
        Panel { name: format!("{name} ({unit})"), colour, points, peak }
    }

    /// This panel with `more` beside its peak.
    pub fn with(mut self, more: String) -> Panel {
        if let Some((_, _, words)) = &mut self.peak {
            *words += &format!(", {more}");
        }
        self
    }
}

impl Histories {
    /// Its height, pixels.
    pub fn height(&self) -> u32 {
        PANEL * self.panels.len() as u32 + LANE * MARKS.len() as u32 + BELOW
    }

    /// Draws it on an area of its height.
    pub fn draw(&self, area: &Area) -> anyhow::Result<()> {
        let mut rest = area.clone();
        for panel in &self.panels {
            let (upper, lower) = rest.split_vertically(px(f64::from(PANEL)));
            self.draw_panel(panel, &upper)?;
            rest = lower;
        }
        self.draw_marks(&rest)
    }

    fn draw_panel(&self, panel: &Panel, area: &Area) -> anyhow::Result<()> {
        let Panel { name, colour, points, peak } = panel;
        let values = points.iter().map(|point| point.1).chain(peak.iter().map(|(_, value, _)| *value));
        let largest = values.map(f64::abs).fold(0.0, f64::max);
        let end = if largest > 0.0 { 1.3 * largest } else { 1.0 };
        let mut chart = chart(area, NO_NUMBERS).build_cartesian_2d(self.time.clone(), -end..end)?;
        axes(&mut chart, ["", name], [10, 5])?;
        chart.draw_series([PathElement::new(points.clone(), line(*colour))])?;
        if let Some(fall) = self.fall {
            dashed(&mut chart, &[(fall, -end), (fall, end)], colour::PURPLE)?;
        }
        if let Some((time, value, peak)) = peak {
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
        let lanes = MARKS.len() as f64;
        let mut chart =
            chart(area, f64::from(BELOW)).margin_top(0).build_cartesian_2d(self.time.clone(), lanes..0.0)?;
        axes(&mut chart, ["time (s)", ""], [10, 0])?;
        for (i, (name, colour, is_meant)) in MARKS.iter().enumerate() {
            let lane = i as f64;
            let marked = self.transitions.iter().filter(|(_, kind)| is_meant(kind));
            let tick =
                |(time, _): &_| PathElement::new([(*time, lane + 0.18), (*time, lane + 0.82)], stroke(*colour, 1.2));
            chart.draw_series(marked.map(tick))?;
            let before = Text::new(*name, (px(-8.0), 0), words_before(SMALL, *colour));
            chart.draw_series([EmptyElement::at((self.time.start, lane + 0.5)) + before])?;
        }
        Ok(())
    }
}
