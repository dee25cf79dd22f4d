//! How often the structures of a sweep overturn or exceed its limits, scale factor by scale factor, and fragility
//! curves.
use super::{
    outcome::{MEASURES, Outcome},
    plan::{Limit, Plan, Run},
};
use crate::significant::significant;
use rocking::fragility::{FitError, FragilityCurve, Trials};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Structures that are counted together, and how they fared.
pub struct Population {
    /// Its name.
    pub name: String,
    /// In the order of the scale factors.
    pub stripes: Vec<Stripe>,
    /// Of overturning, then of the limits.
    pub fragilities: Vec<Fragility>,
}

/// The runs at one scale factor.
pub struct Stripe {
    scale: f64,
    runs: usize,
    /// Geometric mean of the records' peak ground accelerations, g.
    pub pga: f64,
}

/// How often one limit is exceeded.
pub struct Fragility {
    /// The limit in words.
    pub limit: String,
    /// The part of the runs that exceed it, stripe by stripe.
    pub probabilities: Vec<f64>,
    /// Against the peak ground acceleration of the single run, g.
    pub curve: Result<FragilityCurve, FitError>,
}

/// Counts the `outcomes` of all runs of `plan`.
pub fn count(plan: &Plan, outcomes: &[Outcome]) -> Vec<Population> {
    let population = |(index, name): (usize, &String)| {
        let mut by_scale: Vec<Vec<(Run, &Outcome)>> = plan.scales.iter().map(|_| Vec::new()).collect();
        for (run, outcome) in plan.runs().zip(outcomes).filter(|(run, _)| run.point.population == index) {
            by_scale[run.scale_index].push((run, outcome));
        }
        let limits = [None].into_iter().chain(plan.limits.iter().map(Some));
        Population {
            name: name.clone(),
            stripes: by_scale.iter().map(|runs| stripe(runs)).collect(),
            fragilities: limits.map(|limit| fragility(limit, &by_scale)).collect(),
        }
    };
    plan.populations.iter().enumerate().map(population).collect()
}

fn stripe(runs: &[(Run, &Outcome)]) -> Stripe {
    let logarithms: f64 = runs.iter().map(|(run, _)| run.pga().ln()).sum();
    Stripe { scale: runs[0].0.scale, runs: runs.len(), pga: (logarithms / runs.len() as f64).exp() }
}

/// How often `limit` is exceeded, or the structure overturned without one.
fn fragility(limit: Option<&Limit>, by_scale: &[Vec<(Run, &Outcome)>]) -> Fragility {
    let exceeds = |outcome: &Outcome| limit.map_or(outcome.overturned, |limit| outcome.exceeds(limit));
    let mut trials = BTreeMap::new();
    for (run, outcome) in by_scale.iter().flatten() {
        let intensity = run.pga();
        let of_none = Trials { intensity, runs: 0, exceedances: 0 };
        let at: &mut Trials = trials.entry(intensity.to_bits()).or_insert(of_none);
        at.runs += 1;
        at.exceedances += usize::from(exceeds(outcome));
    }
    let part = |runs: &Vec<(Run, &Outcome)>| {
        runs.iter().filter(|(_, outcome)| exceeds(outcome)).count() as f64 / runs.len() as f64
    };
    Fragility {
        limit: limit.map_or("overturned".into(), in_words),
        probabilities: by_scale.iter().map(part).collect(),
        curve: FragilityCurve::fit(&trials.into_values().collect::<Vec<_>>()),
    }
}

fn in_words(limit: &Limit) -> String {
    match MEASURES[limit.measure] {
        (name, "1") => format!("{name} >= {}", limit.value),
        (name, unit) => format!("{name} >= {} {unit}", limit.value),
    }
}

impl Population {
    /// Prints the probabilities and, under them, the curves' medians and dispersions.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "{}", self.name)?;
        let mut line = |cells: [&str; 3], of_limit: &dyn Fn(&Fragility) -> String| {
            write!(out, "{:>10} {:>12} {:>6}", cells[0], cells[1], cells[2])?;
            for fragility in &self.fragilities {
                let width = fragility.limit.len().max(10);
                write!(out, "  {:>width$}", of_limit(fragility))?;
            }
            writeln!(out)
        };
        line(["scale", "PGA (g)", "runs"], &|fragility| fragility.limit.clone())?;
        for (i, Stripe { scale, runs, pga }) in self.stripes.iter().enumerate() {
            let cells = [significant(*scale), significant(*pga), runs.to_string()];
            line(cells.each_ref().map(String::as_str), &|fragility| format!("{:.4}", fragility.probabilities[i]))?;
        }
        let of_curve = |fragility: &Fragility, value: fn(&FragilityCurve) -> f64| {
            fragility.curve.as_ref().map_or("none".into(), |curve| significant(value(curve)))
        };
        line(["median", "PGA (g)", ""], &|fragility| of_curve(fragility, |curve| curve.median))?;
        line(["dispersion", "", ""], &|fragility| of_curve(fragility, |curve| curve.dispersion))?;
        for Fragility { limit, curve, .. } in &self.fragilities {
            if let Err(reason) = curve {
                writeln!(out, "{limit}: no curve: {reason}")?;
            }
        }
        writeln!(out)
    }
}
