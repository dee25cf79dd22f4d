//! `docs/evidence/accuracy.md`: the curves as pictures, and in sentences made from their numbers.

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
    ("textbook methods, transitions at step ends", &[Family::AtStepEnds]),
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
        match self.setting.as_str() {
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
        let bottom = decade(errors.fold(conditioning, f64::min).max(conditioning / 100.0));
        let least = decade(1e6 * points().map(|point| point.cost).fold(f64::INFINITY, f64::min));
        let most = 10.0 * decade(1e6 * points().map(|point| point.cost).fold(0.0, f64::max));
        let x = Axis::logarithmic("computing time per sample of the record, µs", least, most);
        let y = Axis::logarithmic("largest error of θ over its peak", bottom, TOP);
        let mut panel = Panel::new(title, x, y)
            .area((least, bottom), (most, conditioning))
            .area((least, MEANINGLESS), (most, TOP))
            .note((most, FAILED), "× fails", BLACK);
        for family in [&[Family::Ours], families].concat() {
            for (k, curve) in self.family(family).enumerate() {
                let style = style(family, k);
                let good = curve.distinct().into_iter().map(|(x, error)| (x, error.clamp(bottom, MEANINGLESS)));
                let failed =
                    curve.points.iter().filter(|point| point.errors.is_err()).map(|point| (1e6 * point.cost, FAILED));
                let always = if curve.points.iter().all(|point| point.errors.is_err()) { curve.label() } else { "" };
                panel = panel.with(curve.label(), good, style);
                panel = panel.with(always, failed, Style::marked(style.colour, 0, Marker::Cross));
            }
        }
        panel
    }

    /// Finding of the picture.
    fn finding(&self) -> Result<String> {
        let (name, _, ratio) = self.nearest(SIX_DIGITS)?;
        Ok(format!("{}: the cheapest other method with six digits, {name}, takes {ratio:.1} times as long", self.title))
    }

    /// The smallest error below 1 at which another method is cheaper than `auto`; infinite if there is none.
    fn undercut(&self) -> Result<f64> {
        let auto = self.family(Family::Ours).next().context("auto is measured")?;
        let of_peers = self.curves.iter().filter(|curve| PEERS.contains(&curve.family)).flat_map(|curve| &curve.points);
        let cheaper = of_peers.filter_map(|point| {
            let error = point.theta()?;
            (error < 1.0 && point.cost < auto.cheapest(error)?.cost).then_some(error)
        });
        Ok(cheaper.fold(f64::INFINITY, f64::min))
    }

    /// The error of `auto` if the record is held over one sample; None if that is no more than the conditioning: the ground is at rest.
    fn held(&self) -> Option<f64> {
        let error = self.family(Family::Host).next()?.points.first()?.theta()?;
        Some(error).filter(|error| *error > self.conditioning.theta)
    }

    /// The scene's part of the page.
    fn scene(&self) -> Result<Value> {
        let Errors { theta, u, a_t } = self.conditioning;
        Ok(context! {
            key => self.key,
            title => self.title,
            finding => self.finding()?,
            dt => significant(1e3 * self.dt),
            transitions => self.transitions,
            conditioning => [theta, u, a_t].map(scientific).to_vec(),
        })
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
        let is_shown = curve.family != Family::Host && costs.iter().any(Option::is_some);
        let costs: Vec<_> = costs.into_iter().map(|cost| cost.unwrap_or("–".into())).collect();
        is_shown.then(|| context! { method => curve.name.clone(), costs, is_ours })
    };
    let linear = |diagram: &Diagram| diagram.ours(Detail::Linear, f64::INFINITY).map(|cost| significant(1e6 * cost));
    let linear: Vec<_> = diagrams.iter().map(|diagram| linear(diagram).unwrap_or("overturns".into())).collect();
    let linear = context! { method => "this project, linear, any error", costs => linear, is_ours => false };
    curves.iter().filter_map(row).chain([linear]).collect()
}

/// Writes the page with its pictures; `made` is its last line.
pub fn write(diagrams: &[Diagram], docs: &Path, made: &str) -> Result<()> {
    for diagram in diagrams {
        let panels = PANELS.map(|(title, families)| diagram.panel(title, families)).into();
        let description = "Error of θ against computing time per sample, one curve a method, one mark a run.".into();
        let figure = Figure { title: diagram.finding()?, description, columns: 2, panels };
        figure.save(&docs.join(format!("accuracy-{}.svg", diagram.key)))?;
    }
    let scenes = diagrams.iter().map(Diagram::scene).collect::<Result<Vec<_>>>()?;
    let nearest = diagrams.iter().map(|diagram| diagram.nearest(SIX_DIGITS)).collect::<Result<Vec<_>>>()?;
    let undercut = diagrams.iter().map(Diagram::undercut).collect::<Result<Vec<_>>>()?;
    let undercut = undercut.into_iter().fold(f64::INFINITY, f64::min);
    let values = context! {
        ratios => range(nearest.iter().map(|(.., ratio)| *ratio), |ratio| format!("{ratio:.1}")),
        times => range(nearest.iter().map(|(_, cost, ratio)| 1e6 * cost / ratio), significant),
        held => range(diagrams.iter().filter_map(Diagram::held), scientific),
        perturbation => decade(PERTURBATION),
        rows => rows(diagrams),
        undercut => undercut.is_finite().then(|| scientific(undercut)),
        scenes,
    };
    crate::page::write_as(docs, "accuracy", include_str!("../../pages/accuracy.md"), &values, made)
}
