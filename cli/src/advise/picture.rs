//! The picture of a comparison: the errors of every level on one axis, what is allowed, and what each level costs.
use crate::picture::{Area, Picture, SMALL, TITLE, colour, dot, px, stroke, titled, words, words_about, words_before};
use plotters::prelude::*;
use rocking::run::levels::{Comparison, Criterion, Verdict};

const WIDTH: u32 = 860;
const LANE: u32 = 44;
const LEGEND: u32 = 30;
const BELOW: u32 = 50;

/// Errors (%) that the axis shows; what lies beyond stands at its end.
const LEAST: f64 = 1e-4;
const MOST: f64 = 1e3;

/// Where the lanes begin and end, pixels.
const NAMES: f64 = 104.0;
const COSTS: f64 = 118.0;

const DOT: f64 = 4.5;

/// What is drawn of a criterion: its symbol, its colour, and whether it is of a history instead of a peak.
fn look(criterion: Criterion) -> (&'static str, RGBColor, bool) {
    match criterion {
        Criterion::Theta => ("peak of θ", colour::BLUE, false),
        Criterion::U => ("of u", colour::GREEN, false),
        Criterion::At => ("of a_t", colour::VERMILLION, false),
        Criterion::ThetaHistory => ("history of θ", colour::BLUE, true),
        Criterion::UHistory => ("of u", colour::GREEN, true),
        Criterion::AtHistory => ("of a_t", colour::VERMILLION, true),
    }
}

/// Draws the errors by `criteria` of every level beside what is allowed, `within`; `advised` is the level to use.
pub fn draw(
    picture: Picture,
    comparison: &Comparison,
    (within, criteria): (f64, &[Criterion]),
    advised: Option<&Verdict>,
    title: &str,
) -> anyhow::Result<()> {
    let lanes = comparison.verdicts.len() as u32;
    let about = advised.map_or("no level is within what is allowed".into(), |advised| {
        format!(
            "use detail = {}: of the cheapest levels within what is allowed the simplest",
            advised.response.detail.name()
        )
    });
    picture.draw((WIDTH, TITLE + LEGEND + lanes * LANE + BELOW), |area| {
        let (legend, rest) = titled(area, title, &about)?.split_vertically(px(f64::from(LEGEND)));
        draw_legend(&legend, criteria)?;
        draw_lanes(&rest, comparison, within, criteria, advised)
    })
}

fn draw_legend(area: &Area, criteria: &[Criterion]) -> anyhow::Result<()> {
    let mut x = px(NAMES);
    for criterion in criteria {
        let (name, colour, is_history) = look(*criterion);
        mark(area, (x + px(DOT), px(12.0)), colour, is_history)?;
        area.draw(&Text::new(name, (x + px(14.0), px(12.0)), words(SMALL, colour::INK)))?;
        x += px(34.0 + 6.4 * name.len() as f64);
    }
    Ok(())
}

/// A dot for a peak, a ring for a history.
fn mark(area: &Area, at: (i32, i32), colour: RGBColor, is_history: bool) -> anyhow::Result<()> {
    if is_history {
        area.draw(&Circle::new(at, px(DOT), stroke(colour, 1.6)))?;
    } else {
        area.draw(&dot(at, 0.7 * DOT, colour))?;
    }
    Ok(())
}

fn draw_lanes(
    area: &Area,
    comparison: &Comparison,
    within: f64,
    criteria: &[Criterion],
    advised: Option<&Verdict>,
) -> anyhow::Result<()> {
    let (left, right) = (px(NAMES), px(f64::from(WIDTH) - COSTS));
    let across = |error: f64| {
        let part = (error.clamp(LEAST, MOST) / LEAST).log10() / (MOST / LEAST).log10();
        left + (part * f64::from(right - left)).round() as i32
    };
    let lanes = px(f64::from(LANE)) * comparison.verdicts.len() as i32;
    for (i, verdict) in comparison.verdicts.iter().enumerate() {
        let response = &verdict.response;
        let top = px(f64::from(LANE)) * i as i32;
        if advised.is_some_and(|advised| advised.response.detail == response.detail) {
            let band = [(px(18.0), top), (px(f64::from(WIDTH) - 18.0), top + px(f64::from(LANE)))];
            area.draw(&Rectangle::new(band, colour::BLUE.mix(0.09).filled()))?;
        }
        let middle = top + px(0.5 * f64::from(LANE));
        area.draw(&PathElement::new([(left, middle), (right, middle)], stroke(colour::RULE, 1.0)))?;
    }
    for decade in -4..=3 {
        let error = 10f64.powi(decade);
        let x = across(error);
        area.draw(&PathElement::new([(x, 0), (x, lanes)], stroke(colour::RULE, 1.0)))?;
        let name = match decade {
            -4 => format!("≤ {error} %"),
            3 => format!("≥ {error} %"),
            _ => format!("{error} %"),
        };
        area.draw(&Text::new(name, (x, lanes + px(14.0)), words_about(SMALL, colour::INK)))?;
    }
    let allowed = across(100.0 * within);
    area.draw(&PathElement::new([(allowed, 0), (allowed, lanes + px(24.0))], stroke(colour::INK, 1.4)))?;
    area.draw(&Text::new("allowed", (allowed, lanes + px(33.0)), words_about(SMALL, colour::INK)))?;
    let auto = comparison.cost_of_auto();
    for (i, verdict) in comparison.verdicts.iter().enumerate() {
        let y = px(f64::from(LANE)) * i as i32 + px(0.5 * f64::from(LANE));
        let name = verdict.response.detail.name();
        area.draw(&Text::new(name, (left - px(14.0), y), words_before(SMALL, colour::INK)))?;
        if let Some(auto) = auto {
            let cost = format!("{:.2} × auto", verdict.response.cost() as f64 / auto);
            area.draw(&Text::new(cost, (px(f64::from(WIDTH) - 28.0), y), words_before(SMALL, colour::INK)))?;
        }
        let about_overturning = match (verdict.is_right_about_overturning, verdict.response.overturns()) {
            (Some(false), _) => Some(("wrong about overturning", colour::VERMILLION)),
            (None, Some(_)) => Some(("unsure about overturning", colour::GREY)),
            _ => None,
        };
        if let Some((text, colour)) = about_overturning {
            area.draw(&Text::new(text, (left + px(12.0), y - px(11.0)), words(SMALL, colour)))?;
        }
        for criterion in criteria {
            let (_, colour, is_history) = look(*criterion);
            // what is of one quantity is at one height: dots at the same error are both seen
            let aside = match criterion {
                Criterion::Theta | Criterion::ThetaHistory => -9.0,
                Criterion::U | Criterion::UHistory => 0.0,
                Criterion::At | Criterion::AtHistory => 9.0,
            };
            mark(area, (across(100.0 * verdict.errors[*criterion as usize]), y + px(aside)), colour, is_history)?;
        }
    }
    let cost = Text::new("cost", (px(f64::from(WIDTH) - 28.0), lanes + px(14.0)), words_before(SMALL, colour::GREY));
    Ok(area.draw(&cost)?)
}
