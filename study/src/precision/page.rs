//! `docs/evidence/accuracy.md`: what the curves say, in tables and sentences made from their own numbers.

use super::{Curve, Diagram, Family, PERTURBATION, Point};
use crate::chart::{power_of_ten, scientific};
use crate::response::Errors;
use anyhow::{Context, Result};
use minijinja::{Value, context};
use std::path::Path;

/// Errors in θ at which costs are compared.
const ERRORS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// Steps per sample at which the two ways to take transitions are compared.
const COMPARED_STEPS: f64 = 64.0;

/// A method that is cheaper than `auto`.
struct Undercut {
    error: f64, // the smallest error in θ at which it is
    shown: Value,
}

impl Point {
    fn theta(&self) -> Option<f64> {
        Some(self.errors.as_ref().ok()?.theta)
    }
}

impl Curve {
    /// Its name, with what tells it from another of the same name.
    fn full_name(&self) -> String {
        match self.family {
            Family::Located => format!("{}, transitions located", self.name),
            Family::AtStepEnds => format!("{}, transitions at step ends", self.name),
            _ => self.name.clone(),
        }
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
    fn curve(&self, family: Family, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.family == family && curve.name == name)
    }

    fn family(&self, family: Family) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(move |curve| curve.family == family)
    }

    fn rows(&self) -> Vec<Value> {
        let cost = |curve: &Curve, error: f64| match curve.cheapest(error) {
            Some(point) => format!("{} ({})", significant(point.cost), curve.setting(point)),
            None => "–".into(),
        };
        let row = |curve: &Curve| {
            let costs: Vec<_> = ERRORS.iter().map(|error| cost(curve, *error)).collect();
            context! { method => curve.full_name(), costs, is_ours => curve.family == Family::Ours }
        };
        self.curves.iter().map(row).collect()
    }

    fn step_ends(&self) -> Vec<Value> {
        let error = |curve: &Curve| {
            let h = self.dt / COMPARED_STEPS;
            let point = curve.points.iter().find(|point| (point.setting / h - 1.0).abs() < 1e-6)?;
            Some(point.theta().map_or("fails".into(), scientific))
        };
        let pair = |located: &Curve| {
            let at_step_ends = self.curve(Family::AtStepEnds, &located.name)?;
            let (at_step_ends, method) = (error(at_step_ends)?, located.name.clone());
            Some(context! { method, located => error(located)?, at_step_ends })
        };
        self.family(Family::Located).filter_map(pair).collect()
    }

    /// The methods that are cheaper than `auto` at an error below 1.
    fn undercut(&self) -> Result<Vec<Undercut>> {
        let auto = self.family(Family::Ours).next().context("auto is measured")?;
        let others = [Family::Located, Family::AtStepEnds, Family::Library];
        let of_method = |curve: &Curve| {
            let cheaper = curve.points.iter().filter_map(|point| {
                let error = point.theta()?;
                let ours = auto.cheapest(error)?.cost;
                (error < 1.0 && point.cost < ours).then_some((error, point.cost, ours))
            });
            let (error, cost, ours) = cheaper.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let (method, shown, cost, ours) =
                (curve.full_name(), scientific(error), significant(cost), significant(ours));
            Some(Undercut { error, shown: context! { method, shown, cost, ours } })
        };
        Ok(others
            .into_iter()
            .flat_map(|family| self.family(family).filter_map(of_method).collect::<Vec<_>>())
            .collect())
    }

    /// Every method that fails, at which settings and why.
    fn failures(&self) -> Vec<String> {
        let of_method = |curve: &Curve| {
            let failed: Vec<_> = curve.points.iter().filter(|point| point.errors.is_err()).collect();
            let (first, last) = (failed.first()?, failed.last()?);
            let reason = last.errors.as_ref().err()?;
            let settings = match failed.len() {
                1 => curve.setting(first),
                _ => format!(
                    "{} of {} settings, {} to {}",
                    failed.len(),
                    curve.points.len(),
                    curve.setting(first),
                    curve.setting(last)
                ),
            };
            Some(format!("{} ({settings}): {reason}", curve.full_name()))
        };
        self.curves.iter().filter_map(of_method).collect()
    }

    /// The scene's part of the page, and the smallest error at which another method is cheaper than `auto`.
    fn scene(&self) -> Result<(Value, f64)> {
        let fmu = |name: &str| self.curve(Family::Fmu, name).context("the FMU is measured");
        let [held, slope, inside] =
            [fmu("FMU, input held")?, fmu("FMU, input with slope")?, fmu("FMU, record inside")?];
        let error = |point: Option<&Point>| point.and_then(Point::theta).map_or("fails".into(), scientific);
        let undercut = self.undercut()?;
        let least = undercut.iter().map(|undercut| undercut.error).fold(f64::INFINITY, f64::min);
        let Errors { theta, u, a_t } = self.conditioning;
        let scene = context! {
            key => self.key,
            title => self.title,
            dt => significant(1e3 * self.dt),
            transitions => self.transitions,
            floor => significant(1e9 * self.floor),
            conditioning => [theta, u, a_t].map(scientific).to_vec(),
            rows => self.rows(),
            step_ends => self.step_ends(),
            held => vec![error(held.points.first()), error(held.points.last())],
            slope => error(slope.points.first()),
            inside => error(inside.points.first()),
            undercut => undercut.into_iter().map(|undercut| undercut.shown).collect::<Vec<_>>(),
            failures => self.failures(),
        };
        Ok((scene, least))
    }
}

/// Writes the page.
pub fn write(diagrams: &[Diagram], docs: &Path) -> Result<()> {
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
