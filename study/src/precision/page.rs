//! `docs/evidence/accuracy.md` and `speed.md`: the curves as pictures, as numbers, and in sentences made from these.

use super::{Curve, Diagram, Family, PERTURBATION, Point};
use crate::chart::colour::{BLACK, BLUE, BROWN, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION};
use crate::chart::{Axis, Figure, Marker, Panel, Style, power_of_ten, scientific};
use crate::response::Errors;
use anyhow::{Context, Result};
use minijinja::{Value, context};
use plotters::style::RGBColor;
use rocking::Detail;
use std::path::Path;

/// Error in θ at which engine and peers are compared.
const SIX_DIGITS: f64 = 1e-6;

/// Methods that are not this project's.
const PEERS: [Family; 3] = [Family::Located, Family::AtStepEnds, Family::Library];

/// Errors beyond this have no meaning and are drawn here; failed runs are drawn above, below the end of the axis.
const MEANINGLESS: f64 = 10.0;
const FAILED: f64 = 20.0;
const TOP: f64 = 40.0;

const PANELS: [(&str, &[Family]); 4] = [
    ("textbook methods, transitions at the ends of steps", &[Family::AtStepEnds]),
    ("textbook methods, transitions located", &[Family::Located]),
    ("solvers of other libraries", &[Family::Library]),
    ("this engine's other levels, and its input held", &[Family::Level, Family::Host]),
];

/// How the curve `k` of a family is drawn.
fn style(family: Family, k: usize) -> Style {
    const COLOURS: [RGBColor; 8] = [ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE, BROWN, GREY];
    const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond];
    match family {
        Family::Ours => Style::marked(BLACK, 0, Marker::Circle),
        Family::Host => Style::marked(GREY, 2, Marker::Circle),
        _ => Style::marked(COLOURS[k % 8], 2, MARKERS[k % 4]),
    }
}

impl Point {
    fn theta(&self) -> Option<f64> {
        Some(self.errors.as_ref().ok()?.theta)
    }
}

impl Curve {
    /// Its name in a panel, whose title says the rest.
    fn label(&self) -> &str {
        match self.family {
            Family::Ours => "this engine",
            _ => self.name.trim_start_matches("this project, ").trim_end_matches(", transitions at step ends"),
        }
    }

    /// Cost in µs and error of its runs; neighbours that are the same run are one, at the least cost.
    fn distinct(&self) -> Vec<(f64, f64)> {
        let mut points: Vec<_> = self.points.iter().filter_map(|p| Some((1e6 * p.cost, p.theta()?))).collect();
        points.dedup_by(|next, kept| {
            let is_same = next.1 == kept.1;
            kept.0 = if is_same { kept.0.min(next.0) } else { kept.0 };
            is_same
        });
        points
    }

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

    /// The cheapest peer with an error in θ of at most `error`, its cost in s, and how many times that of `auto` it is.
    fn nearest(&self, error: f64) -> Result<(&str, f64, f64)> {
        let of_peers = self.curves.iter().filter(|curve| PEERS.contains(&curve.family));
        let good = of_peers.filter_map(|curve| Some((curve.name.as_str(), curve.cheapest(error)?.cost)));
        let (name, cost) = good.min_by(|a, b| a.1.total_cmp(&b.1)).context("a peer is exact enough")?;
        Ok((name, cost, cost / self.ours(Detail::Auto, error).context("the engine is exact enough")?))
    }

    /// Time per sample, s, of the engine at `detail`, with an error in θ of at most `error`; None if it has no such run.
    fn ours(&self, detail: Detail, error: f64) -> Option<f64> {
        let name = format!("this project, {}", detail.name());
        Some(self.curves.iter().find(|curve| curve.name == name)?.cheapest(error)?.cost)
    }

    /// Error over cost for some families of curves, and of the engine.
    fn panel(&self, title: &str, families: &[Family]) -> Panel {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let decade = |value: f64| 10f64.powf(value.log10().floor());
        let conditioning = self.conditioning.theta;
        let errors = points().filter_map(Point::theta).filter(|error| *error > 0.0);
        let bottom = 0.1 * decade(errors.fold(conditioning, f64::min).max(conditioning / 100.0)); // a decade for names
        let least = decade(1e6 * points().map(|point| point.cost).fold(f64::INFINITY, f64::min));
        let most = 10.0 * decade(1e6 * points().map(|point| point.cost).fold(0.0, f64::max));
        let x = Axis::logarithmic("computing time per sample of the record, µs", least, most);
        let y = Axis::logarithmic("largest error of θ over its peak", bottom, TOP);
        let mut panel = Panel::new(title, x, y)
            .area((least, bottom), (most, conditioning))
            .area((least, MEANINGLESS), (most, TOP))
            .note((most, FAILED), "fails", BLACK);
        for family in [&[Family::Ours], families].concat() {
            for (k, curve) in self.family(family).enumerate() {
                let style = style(family, k);
                let good = curve.distinct().into_iter().map(|(x, error)| (x, error.clamp(bottom, MEANINGLESS)));
                panel = panel.with(curve.label(), good, style);
                let failed =
                    curve.points.iter().filter(|point| point.errors.is_err()).map(|point| (1e6 * point.cost, FAILED));
                panel = panel.with("", failed, Style::marked(style.colour, 0, Marker::Cross));
            }
        }
        panel
    }

    /// Finding of the picture.
    fn finding(&self) -> Result<String> {
        let (name, _, ratio) = self.nearest(SIX_DIGITS)?;
        Ok(format!("{}: the cheapest other method with six digits, {name}, takes {ratio:.1} times as long", self.title))
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
            let (shown, cost, ours) = (scientific(error), significant(1e6 * cost), significant(1e6 * ours));
            Some((error, context! { method => curve.name.clone(), shown, cost, ours }))
        };
        Ok(self.curves.iter().filter(|curve| PEERS.contains(&curve.family)).filter_map(of_method).collect())
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
            finding => self.finding()?,
            dt => significant(1e3 * self.dt),
            transitions => self.transitions,
            conditioning => [theta, u, a_t].map(scientific).to_vec(),
            held => [held.first(), held.last()].map(|error| error.cloned()).to_vec(),
            undercut => undercut.into_iter().map(|(_, shown)| shown).collect::<Vec<_>>(),
        };
        Ok((scene, least))
    }

    fn save_numbers(&self, path: &Path) -> Result<()> {
        let mut csv = csv::Writer::from_path(path)?;
        csv.write_record([
            "method",
            "setting",
            "value",
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
                format!("{:.4}", 1e6 * point.cost),
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

/// The least and the largest of `values`, as they are shown.
fn range(values: impl Iterator<Item = f64>, show: impl Fn(f64) -> String) -> String {
    let values: Vec<_> = values.collect();
    let [least, most] = [f64::min, f64::max].map(|choose: fn(f64, f64) -> f64| values.iter().copied().reduce(choose));
    [least, most].into_iter().flatten().map(show).collect::<Vec<_>>().join(" to ")
}

/// Cost of six digits of the methods that reach them, scene by scene.
fn rows(diagrams: &[Diagram]) -> Vec<Value> {
    let cost = |curve: &Curve| {
        let point = curve.cheapest(SIX_DIGITS)?;
        Some(format!("{} ({})", significant(1e6 * point.cost), curve.setting(point)))
    };
    let curves = diagrams.first().map_or(&[][..], |diagram| &diagram.curves);
    let row = |curve: &Curve| {
        let of_method = |diagram: &Diagram| diagram.curves.iter().find(|other| other.name == curve.name).and_then(cost);
        let costs: Vec<Option<String>> = diagrams.iter().map(of_method).collect();
        let is_ours = curve.family == Family::Ours;
        let is_shown = costs.iter().any(Option::is_some);
        let costs: Vec<_> = costs.into_iter().map(|cost| cost.unwrap_or("–".into())).collect();
        is_shown.then(|| context! { method => curve.name.clone(), costs, is_ours })
    };
    curves.iter().filter_map(row).collect()
}

/// Cost of six digits for the engine and the cheapest other method, scene by scene.
fn speed(diagrams: &[Diagram]) -> Result<Value> {
    let microseconds = |time: f64| significant(1e6 * time);
    let rows = diagrams.iter().map(|diagram| {
        let (name, cost, ratio) = diagram.nearest(SIX_DIGITS)?;
        Ok((diagram, cost / ratio, (name, cost, ratio)))
    });
    let rows = rows.collect::<Result<Vec<_>>>()?;
    let shown = rows.iter().map(|(diagram, auto, (name, cost, ratio))| {
        let [auto, cost] = [auto, cost].map(|time| microseconds(*time));
        let linear = diagram.ours(Detail::Linear, f64::INFINITY).map_or("overturns".into(), microseconds);
        context! { title => diagram.title, name => *name, ratio => format!("{ratio:.1}"), auto, linear, cost }
    });
    Ok(context! {
        rows => shown.collect::<Vec<_>>(),
        ratios => range(rows.iter().map(|(.., (_, _, ratio))| *ratio), |ratio| format!("{ratio:.1}")),
        times => range(rows.iter().map(|(_, auto, ..)| *auto), microseconds),
    })
}

/// Writes the page with its pictures and numbers.
pub fn write(diagrams: &[Diagram], docs: &Path) -> Result<()> {
    for diagram in diagrams {
        let panels = PANELS.map(|(title, families)| diagram.panel(title, families)).into();
        let description = "Error of θ against computing time per sample, one curve a method, one mark a run.".into();
        let figure = Figure { title: diagram.finding()?, description, columns: 2, panels };
        figure.save(&docs.join(format!("accuracy-{}.svg", diagram.key)))?;
        diagram.save_numbers(&docs.join(format!("accuracy-{}.csv", diagram.key)))?;
    }
    let (scenes, least): (Vec<_>, Vec<_>) =
        diagrams.iter().map(Diagram::scene).collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let least = least.into_iter().fold(f64::INFINITY, f64::min);
    let speed = speed(diagrams)?;
    let values = context! {
        speed => speed.clone(),
        perturbation => decade(PERTURBATION),
        rows => rows(diagrams),
        undercut => least.is_finite().then(|| scientific(least)),
        scenes,
    };
    crate::page::write(docs, "speed", include_str!("../../pages/speed.md"), &speed, "precision")?;
    crate::page::write(docs, "accuracy", include_str!("../../pages/accuracy.md"), &values, "precision")
}
