//! The picture of a run: ground, rotation, displacements and acceleration over time, marks at the transitions.
use crate::picture::{
    Area, Picture, SMALL, TITLE, axes, chart, colour, dashed, line, px, rounded, stroke, titled, words, words_before,
};
use plotters::prelude::*;
use rocking::Structure;
use rocking::digits::short;
use rocking::mechanics::shown::{Legend, Place};
use rocking::run::{Ending, RunError};
use rocking::{TransitionKind, run::peaks::Peak};
use rocking_report::page::{Sizes, sizes};
use rocking_report::quantities::in_readable_unit;
use rocking_report::run::{MotionCurve, RunReport, RunSetup};
use rocking_report::summary::instant;

/// Part of a peak by which a line may miss the motion: less than its width, or than three times its width if the run takes too many
/// points.
const PARTS: [f64; 2] = [1e-3, 1e-2];

const WIDTH: u32 = 860;

/// Height of a panel, of the marks of one kind, and of the numbers and the name of the axis of time, pixels.
const PANEL: u32 = 148;
const LANE: u32 = 17;
const BELOW: u32 = 46;

/// Height of the axis of a panel, which leaves its numbers to that of the marks.
const NO_NUMBERS: f64 = 6.0;

/// Name of a mark, its colour, and the test for the transitions that it marks.
type Mark = (&'static str, RGBColor, fn(&TransitionKind) -> bool);

/// The marks below the panels, a kind to a lane.
const MARKS: [Mark; 4] = [
    ("uplift", colour::GREEN, |kind| matches!(kind, TransitionKind::Uplift(_))),
    ("impact", colour::VERMILLION, |kind| matches!(kind, TransitionKind::Impact(_))),
    ("landing", colour::INK, |kind| matches!(kind, TransitionKind::Landing | TransitionKind::Settling)),
    ("overturning", colour::PURPLE, |kind| matches!(kind, TransitionKind::Overturning(_))),
];

struct Panel {
    name: String,
    colour: RGBColor,
    /// Time (s) and value.
    points: Vec<(f64, f64)>,
    /// Instant and value to be marked by a dot, and the words beside it.
    peak: Option<(f64, f64, String)>,
}

/// Runs `run` once more and draws it with its peaks.
pub fn draw(picture: Picture, run: &RunSetup) -> anyhow::Result<()> {
    let curve = match run.curve(PARTS[0]) {
        Err(RunError::TooManyPoints { .. }) => run.curve(PARTS[1])?,
        curve => curve?,
    };
    let (found, panels) = (&curve.found, panels(run, &curve));
    let height = TITLE + PANEL * panels.len() as u32 + LANE * MARKS.len() as u32 + BELOW;
    picture.draw((WIDTH, height), |area| {
        let mut rest = titled(area, run.ground.title(), &about(&run.structure, found))?;
        for panel in &panels {
            let (upper, lower) = rest.split_vertically(px(f64::from(PANEL)));
            panel.draw(&upper, found)?;
            rest = lower;
        }
        draw_marks(&rest, found)
    })
}

/// Ground acceleration, rotation, displacements and acceleration; of many masses those of the top floor.
fn panels(run: &RunSetup, curve: &MotionCurve) -> Vec<Panel> {
    let is_one = run.structure.is_one_mass();
    let peak = |name: &str| curve.found.peak(name).unwrap_or_default();
    let uplift = || format!(", uplift {} mm", rounded(1e3 * peak("uplift").magnitude));
    let V_t = || format!(", V_t {}", in_readable_unit(peak("V_t").magnitude, "N", rounded));
    let panel = |(name, Legend { label, symbol, .. }, (per_unit, unit)): (String, Legend, (f64, &str))| {
        let (_, values) = curve.columns.iter().find(|(of, _)| *of == name)?;
        let points: Vec<_> = curve.times.iter().zip(values).map(|(time, value)| (*time, value / per_unit)).collect();
        let Peak { magnitude, time } = peak(&name);
        let after = curve.times.partition_point(|before| *before < time);
        let beside = points[after.saturating_sub(1)..points.len().min(after + 2)].iter();
        // of the points beside the peak the largest has its sign
        let sign = beside.map(|point| point.1).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0).signum();
        let more = match &*name {
            "theta" if is_one => uplift(),
            "a_t" => V_t(),
            _ => String::new(),
        };
        let words = format!("{} {unit}{more}", rounded(magnitude / per_unit));
        let peak = (magnitude > 0.0).then_some((time, sign * magnitude / per_unit, words));
        let colour = if name == "a_g" { colour::GREY } else { colour::BLUE };
        let label = match name.find('[') {
            Some(number) => format!("{symbol}{}", &name[number..]), // what fits
            None => format!("{label} {symbol}"),
        };
        Some(Panel { name: format!("{label} ({unit})"), colour, points, peak })
    };
    let place = if is_one { Place::OneMass } else { Place::Histories };
    run.histories(place).into_iter().filter_map(panel).collect()
}

/// The structure and what became of it, in a line.
fn about(structure: &Structure, found: &RunReport) -> String {
    let Sizes { m, H, B, f_fc, floors, .. } = sizes(structure);
    let [kg, t, H, base, f_fc] = [m, 1e-3 * m, H, 2.0 * B, f_fc].map(short);
    let masses = match floors {
        None => format!("{kg} kg at {H} m"),
        Some(floors) => format!("{} floors, {t} t", floors.len()),
    };
    let end = match (found.ending, found.fall) {
        (_, Some(fall)) => format!(", falls from {} s on, peaks until then", instant(fall)),
        (Ending::Overturned, None) => ", overturned".into(),
        (Ending::StillRocking, None) => ", still rocking".into(),
        (Ending::AtRest | Ending::AtTime, None) => String::new(),
    };
    format!("{masses} on a base {base} m wide, {f_fc} Hz in full contact; {} transitions{end}", found.transitions)
}

impl Panel {
    /// Draws the history on `area`, its peak, and a dashed line at the instant from which the structure falls.
    fn draw(&self, area: &Area, &RunReport { start, end, fall, .. }: &RunReport) -> anyhow::Result<()> {
        let Panel { name, colour, points, peak } = self;
        let values = points.iter().map(|point| point.1).chain(peak.iter().map(|(_, value, _)| *value));
        let largest = values.map(f64::abs).fold(0.0, f64::max);
        let up = if largest > 0.0 { 1.3 * largest } else { 1.0 };
        let mut chart = chart(area, NO_NUMBERS).build_cartesian_2d(start..end, -up..up)?;
        axes(&mut chart, ["", name], [10, 5])?;
        chart.draw_series([PathElement::new(points.clone(), line(*colour))])?;
        if let Some(fall) = fall {
            dashed(&mut chart, &[(fall, -up), (fall, up)], colour::PURPLE)?;
        }
        if let Some((time, value, peak)) = peak {
            chart.draw_series([Circle::new((*time, *value), px(3.0), colour::INK.filled())])?;
            let is_late = *time > start + 0.85 * (end - start);
            let (style, aside) =
                if is_late { (words_before(SMALL, colour::INK), -7.0) } else { (words(SMALL, colour::INK), 7.0) };
            let above = if *value < 0.0 { 7.5 } else { -8.0 };
            let label = EmptyElement::at((*time, *value)) + Text::new(peak.clone(), (px(aside), px(above)), style);
            chart.draw_series([label])?;
        }
        Ok(())
    }
}

/// A lane of ticks for each kind of mark, its name before it.
fn draw_marks(area: &Area, RunReport { start, end, events, .. }: &RunReport) -> anyhow::Result<()> {
    let lanes = MARKS.len() as f64;
    let mut chart = chart(area, f64::from(BELOW)).margin_top(0).build_cartesian_2d(*start..*end, lanes..0.0)?;
    axes(&mut chart, ["time (s)", ""], [10, 0])?;
    for (i, (name, colour, is_meant)) in MARKS.iter().enumerate() {
        let lane = i as f64;
        let marked = events.iter().filter(|event| is_meant(&event.kind)).map(|event| event.time);
        let tick = |time| PathElement::new([(time, lane + 0.18), (time, lane + 0.82)], stroke(*colour, 1.2));
        chart.draw_series(marked.map(tick))?;
        let before = Text::new(*name, (px(-8.0), 0), words_before(SMALL, *colour));
        chart.draw_series([EmptyElement::at((*start, lane + 0.5)) + before])?;
    }
    Ok(())
}
