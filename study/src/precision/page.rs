//! `docs/evidence/accuracy.md`: the curves as pictures, as numbers, and in sentences made from these.

use super::{Curve, Diagram, Family, PERTURBATION, Point};
use crate::chart::colour::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION};
use crate::chart::{Axis, Figure, Marker, Panel, Style, power_of_ten, scientific};
use crate::response::Errors;
use anyhow::{Context, Result};
use minijinja::{Value, context};
use plotters::style::RGBColor;
use std::path::Path;

/// Errors in θ at which costs are compared.
const ERRORS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// Errors beyond this have no meaning and are drawn here; failed runs are drawn above, below the end of the axis.
const MEANINGLESS: f64 = 10.0;
const FAILED: f64 = 20.0;
const TOP: f64 = 40.0;

const PANELS: [(&str, &[Family]); 4] = [
    (
        "textbook methods, fixed step; dashed: transitions at step ends",
        &[Family::Ours, Family::Located, Family::AtStepEnds],
    ),
    ("solvers of other libraries", &[Family::Ours, Family::Library]),
    ("this project's levels of detail", &[Family::Ours, Family::Level]),
    ("the record, and its samples held over communication steps", &[Family::Ours, Family::Host]),
];

/// How the curve `k` of a family is drawn.
fn style(family: Family, k: usize) -> Style {
    const COLOURS: [RGBColor; 6] = [ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE];
    const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond];
    match family {
        Family::Ours => Style::marked(BLACK, 3, Marker::Circle),
        _ => Style { dashed: family == Family::AtStepEnds, ..Style::marked(COLOURS[k % 6], 2, MARKERS[k % 4]) },
    }
}

impl Point {
    fn theta(&self) -> Option<f64> {
        Some(self.errors.as_ref().ok()?.theta)
    }
}

impl Curve {
    /// Its cheapest point with an error in θ of at most `error`.
    fn cheapest(&self, error: f64) -> Option<&Point> {
        let good = self.points.iter().filter(|point| point.theta().is_some_and(|theta| theta <= error));
        good.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn setting(&self, point: &Point) -> String {
        match self.setting {
            "tolerance" => decade(point.setting),
            _ => format!("{} ms", significant(1e3 * point.setting)),
        }
    }

    /// At how many settings it fails, and why at the last of them.
    fn failure(&self) -> Option<String> {
        let failed: Vec<_> = self.points.iter().filter_map(|point| point.errors.as_ref().err()).collect();
        let reason = failed.last()?;
        Some(format!("{} ({} of {} settings): {reason}", self.name, failed.len(), self.points.len()))
    }
}

/// A power of ten.
fn decade(value: f64) -> String {
    power_of_ten(value.log10().round() as i64)
}

/// Two significant digits.
fn significant(value: f64) -> String {
    let digits = (1.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}

impl Diagram {
    fn family(&self, family: Family) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(move |curve| curve.family == family)
    }

    /// Error over cost for some families of curves.
    fn panel(&self, title: &str, families: &[Family]) -> Panel {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let decade = |value: f64| 10f64.powf(value.log10().floor());
        let conditioning = self.conditioning.theta;
        let errors = points().filter_map(Point::theta).filter(|error| *error > 0.0);
        let bottom = decade(errors.fold(conditioning, f64::min).max(conditioning / 100.0));
        let least = decade(points().map(|point| point.cost).fold(f64::INFINITY, f64::min));
        let most = 10.0 * decade(points().map(|point| point.cost).fold(0.0, f64::max));
        let x = Axis::logarithmic("time per sample / floor", least, most);
        let y = Axis::logarithmic("max|Δθ| / max|θ|", bottom, TOP);
        let mut panel = Panel::new(title, x, y)
            .area((least, bottom), (most, conditioning))
            .area((least, MEANINGLESS), (most, TOP))
            .note((least, FAILED), "fails", BLACK)
            .note((least, (conditioning * bottom).sqrt()), "below the conditioning floor", GREY);
        for family in families {
            for (k, curve) in self.family(*family).enumerate() {
                let style = style(*family, k);
                let good = curve.points.iter().filter_map(|point| Some((point.cost, point.theta()?)));
                panel = panel.with(&curve.name, good.map(|(x, error)| (x, error.clamp(bottom, MEANINGLESS))), style);
                let failed =
                    curve.points.iter().filter(|point| point.errors.is_err()).map(|point| (point.cost, FAILED));
                panel = panel.with("", failed, Style::marked(style.colour, 0, Marker::Cross));
            }
        }
        panel
    }

    /// A row for each curve: what the errors cost.
    fn rows(&self) -> Vec<Value> {
        let cost = |curve: &Curve, error: f64| match curve.cheapest(error) {
            Some(point) => format!("{} ({})", significant(point.cost), curve.setting(point)),
            None => "–".into(),
        };
        let row = |curve: &Curve| {
            let costs: Vec<_> = ERRORS.iter().map(|error| cost(curve, *error)).collect();
            context! { method => curve.name.clone(), costs, is_ours => curve.family == Family::Ours }
        };
        self.curves.iter().map(row).collect()
    }

    /// The methods that are cheaper than `auto` at an error below 1, each with the smallest such error.
    fn undercut(&self) -> Result<Vec<(f64, Value)>> {
        let auto = self.family(Family::Ours).next().context("auto is measured")?;
        let of_method = |curve: &Curve| {
            let cheaper = curve.points.iter().filter_map(|point| {
                let error = point.theta()?;
                let ours = auto.cheapest(error)?.cost;
                (error < 1.0 && point.cost < ours).then_some((error, point.cost, ours))
            });
            let (error, cost, ours) = cheaper.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let (shown, cost, ours) = (scientific(error), significant(cost), significant(ours));
            Some((error, context! { method => curve.name.clone(), shown, cost, ours }))
        };
        let others = [Family::Located, Family::AtStepEnds, Family::Library];
        Ok(self.curves.iter().filter(|curve| others.contains(&curve.family)).filter_map(of_method).collect())
    }

    /// The scene's part of the page, and the smallest error at which another method is cheaper than `auto`.
    fn scene(&self) -> Result<(Value, f64)> {
        let held = self.family(Family::Host).flat_map(|curve| &curve.points).filter_map(Point::theta);
        let held: Vec<_> = held.map(scientific).collect();
        let undercut = self.undercut()?;
        let least = undercut.iter().map(|(error, _)| *error).fold(f64::INFINITY, f64::min);
        let Errors { theta, u, a_t } = self.conditioning;
        let scene = context! {
            key => self.key,
            title => self.title,
            dt => significant(1e3 * self.dt),
            transitions => self.transitions,
            floor => significant(1e9 * self.floor),
            conditioning => [theta, u, a_t].map(scientific).to_vec(),
            rows => self.rows(),
            held => [held.first(), held.last()].map(|error| error.cloned()).to_vec(),
            undercut => undercut.into_iter().map(|(_, shown)| shown).collect::<Vec<_>>(),
            failures => self.curves.iter().filter_map(Curve::failure).collect::<Vec<_>>(),
        };
        Ok((scene, least))
    }

    fn save_numbers(&self, path: &Path) -> Result<()> {
        let mut csv = csv::Writer::from_path(path)?;
        csv.write_record([
            "method",
            "setting",
            "value",
            "cost_over_floor",
            "microseconds_per_sample",
            "evaluations_per_sample",
            "transitions",
            "error_theta",
            "error_u",
            "error_a_t",
            "failure",
        ])?;
        for (curve, point) in self.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)))
        {
            let error =
                |get: fn(&Errors) -> f64| point.errors.as_ref().map_or(String::new(), |e| format!("{:.3e}", get(e)));
            csv.write_record([
                curve.name.clone(),
                curve.setting.into(),
                format!("{:.6e}", point.setting),
                format!("{:.2}", point.cost),
                format!("{:.4}", 1e6 * point.cost * self.floor),
                format!("{:.3}", point.evaluations),
                point.transitions.to_string(),
                error(|e| e.theta),
                error(|e| e.u),
                error(|e| e.a_t),
                point.errors.as_ref().err().map_or(String::new(), ToString::to_string),
            ])?;
        }
        Ok(csv.flush()?)
    }
}

/// Writes the page with its pictures and numbers.
pub fn write(diagrams: &[Diagram], docs: &Path) -> Result<()> {
    for diagram in diagrams {
        let panels = PANELS.map(|(title, families)| diagram.panel(title, families)).into();
        let figure = Figure { title: diagram.title.into(), columns: 2, panels };
        figure.save(&docs.join(format!("accuracy-{}.svg", diagram.key)))?;
        diagram.save_numbers(&docs.join(format!("accuracy-{}.csv", diagram.key)))?;
    }
    let (scenes, least): (Vec<_>, Vec<_>) =
        diagrams.iter().map(Diagram::scene).collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let least = least.into_iter().fold(f64::INFINITY, f64::min);
    let values = context! {
        perturbation => decade(PERTURBATION),
        errors => ERRORS.map(decade).to_vec(),
        undercut => least.is_finite().then(|| scientific(least)),
        scenes,
    };
    crate::page::write(docs, "accuracy", include_str!("../../pages/accuracy.md"), values)
}
