//! How often the structures of a sweep overturn or exceed its limits, scale factor by scale factor, and fragility
//! curves.
use crate::significant::significant;
use rocking::fragility::{FitError, FragilityCurve, Trials};
use rocking::run::{
    Ending, LONGEST_REST,
    outcome::{Limit, Outcome},
    plan::Plan,
};
use std::io::{self, Write};

/// Structures that are counted together, and how they fared.
pub struct Population {
    /// Its name.
    pub name: String,
    /// In the order of the scale factors.
    pub stripes: Vec<Stripe>,
    /// Of overturning, then of the limits.
    pub fragilities: Vec<Fragility>,
    failed: usize,
    still_rocking: usize,
}

/// The runs at one scale factor.
pub struct Stripe {
    scale: f64,
    /// Those that count: what became of the structure is known.
    counted: usize,
    /// Geometric mean of the records' peak ground accelerations, g.
    pub pga: f64,
}

/// How often one limit is exceeded.
pub struct Fragility {
    /// The limit.
    pub limit: Limit,
    /// The part of the runs that exceed it, of those of which that is known, stripe by stripe.
    pub probabilities: Vec<Option<f64>>,
    /// Against the peak ground acceleration of the single run, g.
    pub curve: Result<FragilityCurve, FitError>,
}

/// A run's peak ground acceleration, g, and what it came to.
type Counted<'a> = (f64, &'a Outcome);

/// Counts the `outcomes` of all runs of `plan`.
pub fn count(plan: &Plan, limits: &[Limit], outcomes: &[Outcome]) -> Vec<Population> {
    let mut by_scale: Vec<Vec<Vec<Counted>>> = vec![vec![Vec::new(); plan.scales().len()]; plan.populations().len()];
    for (index, (case, outcome)) in plan.cases().zip(outcomes).enumerate() {
        let is_its = |population: &rocking::run::plan::Population| population.name() == case.population.name();
        let population = plan.populations().iter().position(is_its).expect("a case is of a population");
        by_scale[population][index % plan.scales().len()].push((case.intensity(), outcome));
    }
    let population = |(population, by_scale): (&rocking::run::plan::Population, Vec<Vec<Counted>>)| {
        let outcomes = || by_scale.iter().flatten().map(|(_, outcome)| outcome);
        let is_still_rocking =
            |outcome: &Outcome| matches!(outcome, Outcome::Ended(summary) if summary.ending == Ending::StillRocking);
        Population {
            name: population.name().into(),
            stripes: plan.scales().iter().zip(&by_scale).map(|(scale, runs)| stripe(*scale, runs)).collect(),
            fragilities: [&Limit::Overturning]
                .into_iter()
                .chain(limits)
                .map(|limit| fragility(*limit, &by_scale))
                .collect(),
            failed: outcomes().filter(|outcome| matches!(outcome, Outcome::Failed(_))).count(),
            still_rocking: outcomes().filter(|outcome| is_still_rocking(outcome)).count(),
        }
    };
    plan.populations().iter().zip(by_scale).map(population).collect()
}

fn stripe(scale: f64, runs: &[Counted]) -> Stripe {
    let logarithms: f64 = runs.iter().map(|(pga, _)| pga.ln()).sum();
    let counted = runs.iter().filter(|(_, outcome)| outcome.exceeds(&Limit::Overturning).is_some()).count();
    Stripe { scale, counted, pga: (logarithms / runs.len() as f64).exp() }
}

fn fragility(limit: Limit, by_scale: &[Vec<Counted>]) -> Fragility {
    let exceeds = |&(pga, outcome): &Counted| (pga, outcome.exceeds(&limit));
    let part = |runs: &Vec<Counted>| {
        let known: Vec<_> = runs.iter().filter_map(|run| exceeds(run).1).collect();
        let exceedances = known.iter().filter(|exceeds| **exceeds).count();
        (!known.is_empty()).then(|| exceedances as f64 / known.len() as f64)
    };
    Fragility {
        limit,
        probabilities: by_scale.iter().map(part).collect(),
        curve: FragilityCurve::fit(&Trials::count(by_scale.iter().flatten().map(exceeds))),
    }
}

impl Population {
    /// Prints the probabilities and, under them, the curves' medians and dispersions.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "{}", self.name)?;
        let mut line = |cells: [&str; 3], of_limit: &dyn Fn(&Fragility) -> String| {
            write!(out, "{:>10} {:>12} {:>7}", cells[0], cells[1], cells[2])?;
            for fragility in &self.fragilities {
                let width = fragility.limit.to_string().len().max(10);
                write!(out, "  {:>width$}", of_limit(fragility))?;
            }
            writeln!(out)
        };
        line(["scale", "PGA (g)", "counted"], &|fragility| fragility.limit.to_string())?;
        for (i, Stripe { scale, counted, pga }) in self.stripes.iter().enumerate() {
            let cells = [significant(*scale), significant(*pga), counted.to_string()];
            let part = |of: &Fragility| of.probabilities[i].map_or("none".into(), |part| format!("{part:.4}"));
            line(cells.each_ref().map(String::as_str), &part)?;
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
        if self.failed > 0 {
            writeln!(out, "{} failed and are not counted", self.failed)?;
        }
        if self.still_rocking > 0 {
            let still_rocking = self.still_rocking;
            writeln!(
                out,
                "{still_rocking} still rocked {LONGEST_REST}/p_l after the record: counted where a limit was exceeded, \
                 and else not"
            )?;
        }
        writeln!(out)
    }
}
