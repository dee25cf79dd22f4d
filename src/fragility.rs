//! Fragility curve: the probability that a limit is exceeded under a ground motion of intensity x, as a lognormal
//! distribution function fitted to counted exceedances by maximum likelihood.
//!
//! ```text
//! P(x) = Φ(ln(x/x_m)/β)                               x_m median, β dispersion, Φ standard normal distribution
//! L    = Π P(x_i)^z_i (1 − P(x_i))^(n_i − z_i)        z_i exceedances in n_i runs at intensity x_i; → maximum
//! ```
//!
//! (J. W. Baker, Efficient analytical fragility function fitting using dynamic structural analysis, Earthquake Spectra
//! 31, 2015.) With P(x) = Φ(a + b ln x), ln L is concave in a and b: it has one maximum, provided that intensities with
//! and without exceedances overlap. Where they do not, L grows without end as β → 0 and there is no curve.

use libm::erfc;
use nalgebra::{Matrix2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::iter;

/// Runs at one intensity, counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trials {
    /// Intensity x_i > 0 of the ground motion, in any one unit.
    pub intensity: f64,
    /// Runs n_i.
    pub runs: usize,
    /// Those among them that exceed the limit, z_i.
    pub exceedances: usize,
}

/// A lognormal fragility curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragilityCurve {
    /// Intensity at which the limit is exceeded with probability ½, x_m, in the unit of the trials.
    pub median: f64,
    /// Standard deviation of ln x, β.
    pub dispersion: f64,
}

/// Why there is no curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// An intensity has no logarithm.
    #[error("the intensity {0} must be a finite number greater than 0")]
    Intensity(f64),
    /// No run.
    #[error("no run is counted")]
    NothingCounted,
    /// No exceedance.
    #[error("never exceeded: raise the intensity")]
    NeverExceeded,
    /// Nothing but exceedances.
    #[error("always exceeded: lower the intensity")]
    AlwaysExceeded,
    /// Exceedances begin no lower than non-exceedances end: the most likely dispersion is 0.
    #[error(
        "always exceeded above {highest_without} and never below {lowest_with}: for a dispersion, add intensities in \
         between, records or structures"
    )]
    NoOverlap {
        /// Largest intensity with a run that stays within the limit.
        highest_without: f64,
        /// Smallest intensity with a run that exceeds it.
        lowest_with: f64,
    },
    /// Exceedances become fewer as the intensity grows.
    #[error("exceedances do not grow with the intensity")]
    NotGrowing,
}

impl Trials {
    /// Counts runs, each given by its intensity and whether the limit was exceeded, if that is known, by intensity.
    pub fn count(runs: impl IntoIterator<Item = (f64, Option<bool>)>) -> Vec<Trials> {
        let mut trials = BTreeMap::new();
        for (intensity, has_exceeded) in runs {
            if let Some(has_exceeded) = has_exceeded {
                let of_none = Trials { intensity, runs: 0, exceedances: 0 };
                let at: &mut Trials = trials.entry(intensity.to_bits()).or_insert(of_none);
                at.runs += 1;
                at.exceedances += usize::from(has_exceeded);
            }
        }
        trials.into_values().collect()
    }
}

impl FragilityCurve {
    /// P(x): the probability that the limit is exceeded at `intensity` > 0.
    pub fn probability(&self, intensity: f64) -> f64 {
        normal_distribution((intensity / self.median).ln() / self.dispersion)
    }

    /// The curve of greatest likelihood L.
    pub fn fit(trials: &[Trials]) -> Result<FragilityCurve, FitError> {
        if let Some(refused) = trials.iter().find(|at| !(at.intensity > 0.0 && at.intensity.is_finite())) {
            return Err(FitError::Intensity(refused.intensity));
        }
        if trials.is_empty() {
            return Err(FitError::NothingCounted);
        }
        check_overlap(trials)?;
        // Logarithms from their mean, so that a and b stay apart whatever the unit.
        let origin = trials.iter().map(|at| at.intensity.ln()).sum::<f64>() / trials.len() as f64;
        let [a, b] = most_likely(trials, origin).into();
        if b > 0.0 {
            Ok(FragilityCurve { median: (origin - a / b).exp(), dispersion: b.recip() })
        } else {
            Err(FitError::NotGrowing)
        }
    }
}

/// Whether a finite maximum of L exists.
fn check_overlap(trials: &[Trials]) -> Result<(), FitError> {
    let range = |has: fn(&Trials) -> bool| {
        let intensities = || trials.iter().filter(|at| has(at)).map(|at| at.intensity);
        intensities().reduce(f64::min).zip(intensities().reduce(f64::max))
    };
    let (lowest_with, highest_with) = range(|at| at.exceedances > 0).ok_or(FitError::NeverExceeded)?;
    let (lowest_without, highest_without) = range(|at| at.exceedances < at.runs).ok_or(FitError::AlwaysExceeded)?;
    if highest_without <= lowest_with {
        Err(FitError::NoOverlap { highest_without, lowest_with })
    } else if highest_with <= lowest_without {
        Err(FitError::NotGrowing)
    } else {
        Ok(())
    }
}

/// (a, b) that maximise ln L for P(x) = Φ(a + b (ln x − origin)): Newton's method with the expected second derivatives,
/// and a shorter step where the full one would lower L.
fn most_likely(trials: &[Trials], origin: f64) -> Vector2<f64> {
    const MAX_ITERATIONS: usize = 100;
    const ACCURACY: f64 = 1e-12;
    let mut at = Vector2::zeros();
    for _ in 0..MAX_ITERATIONS {
        let Some(full) = newton_step(trials, origin, at) else { break };
        if full.norm() <= ACCURACY * (1.0 + at.norm()) {
            break;
        }
        let likelihood = log_likelihood(trials, origin, at);
        let rounding = ACCURACY * likelihood.abs();
        let mut shorter = iter::successors(Some(full), |step| Some(step / 2.0));
        let step = shorter.find(|step| log_likelihood(trials, origin, at + step) >= likelihood - rounding);
        at += step.expect("a step of length 0 leaves L as it is");
    }
    at
}

/// ln L.
fn log_likelihood(trials: &[Trials], origin: f64, at: Vector2<f64>) -> f64 {
    let log = |count: usize, probability: f64| if count == 0 { 0.0 } else { count as f64 * probability.ln() };
    let term = |of: &Trials| {
        let z = regressor(of, origin).dot(&at);
        log(of.exceedances, normal_distribution(z)) + log(of.runs - of.exceedances, normal_distribution(-z))
    };
    trials.iter().map(term).sum()
}

/// The gradient of ln L over its expected second derivatives.
fn newton_step(trials: &[Trials], origin: f64, at: Vector2<f64>) -> Option<Vector2<f64>> {
    let (mut gradient, mut information) = (Vector2::zeros(), Matrix2::zeros());
    for of in trials {
        let row = regressor(of, origin);
        let z = row.dot(&at);
        let density = (-0.5 * z * z).exp() / TAU.sqrt();
        let (p, q) = (normal_distribution(z), normal_distribution(-z));
        let runs = of.runs as f64;
        if p * q > 0.0 {
            gradient += row * (density * (of.exceedances as f64 - runs * p) / (p * q));
            information += row * row.transpose() * (runs * density * density / (p * q));
        }
    }
    information.lu().solve(&gradient)
}

/// 1 and ln x, which a and b multiply.
fn regressor(of: &Trials, origin: f64) -> Vector2<f64> {
    Vector2::new(1.0, of.intensity.ln() - origin)
}

/// Φ(z).
fn normal_distribution(z: f64) -> f64 {
    0.5 * erfc(-z * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn trials(counts: &[(f64, usize, usize)]) -> Vec<Trials> {
        counts.iter().map(|&(intensity, runs, exceedances)| Trials { intensity, runs, exceedances }).collect()
    }

    #[test]
    fn runs_are_counted_by_intensity() {
        let runs =
            [(2.0, Some(true)), (0.5, Some(false)), (2.0, Some(false)), (0.5, None), (4.0, None), (2.0, Some(true))];
        assert_eq!(Trials::count(runs), trials(&[(0.5, 1, 0), (2.0, 3, 2)]));
    }

    /// Two intensities, two unknowns: the most likely curve goes through both fractions.
    #[test]
    fn two_intensities_are_met_exactly() {
        let curve = FragilityCurve::fit(&trials(&[(0.4, 1000, 23), (2.5, 40, 37)])).unwrap();
        assert_relative_eq!(curve.probability(0.4), 23.0 / 1000.0, max_relative = 1e-10);
        assert_relative_eq!(curve.probability(2.5), 37.0 / 40.0, max_relative = 1e-10);
        assert_relative_eq!(curve.probability(curve.median), 0.5);
        // 0.158655... = Φ(−1), 0.977249... = Φ(2)
        assert_relative_eq!(curve.probability(curve.median * (-curve.dispersion).exp()), 0.158_655_253_931_457_05);
        assert_relative_eq!(curve.probability(curve.median * (2.0 * curve.dispersion).exp()), 0.977_249_868_051_820_8);
    }

    /// Symmetric counts about ln x = 0, run by run.
    #[test]
    fn symmetric_counts_have_their_median_in_the_middle() {
        let runs = [(0.25, 0), (0.5, 0), (0.5, 1), (1.0, 0), (1.0, 1), (2.0, 0), (2.0, 1), (4.0, 1)];
        let curve = FragilityCurve::fit(&runs.map(|(x, z)| Trials { intensity: x, runs: 1, exceedances: z })).unwrap();
        assert_relative_eq!(curve.median, 1.0, max_relative = 1e-10);
    }

    #[test]
    fn counts_without_a_curve_are_refused_with_the_reason() {
        let refused = |counts: &[(f64, usize, usize)]| FragilityCurve::fit(&trials(counts)).unwrap_err();
        assert_eq!(refused(&[]), FitError::NothingCounted);
        assert_eq!(refused(&[(1.0, 5, 0), (2.0, 5, 0)]), FitError::NeverExceeded);
        assert_eq!(refused(&[(1.0, 5, 5), (2.0, 5, 5)]), FitError::AlwaysExceeded);
        let steep = FitError::NoOverlap { highest_without: 2.0, lowest_with: 2.0 };
        assert_eq!(refused(&[(1.0, 5, 0), (2.0, 5, 3), (3.0, 5, 5)]), steep);
        assert_eq!(
            refused(&[(1.0, 5, 0), (2.0, 5, 5)]).to_string(),
            "always exceeded above 1 and never below 2: for a dispersion, add intensities in between, records or structures"
        );
        assert_eq!(refused(&[(1.0, 5, 5), (2.0, 5, 3), (3.0, 5, 0)]), FitError::NotGrowing);
        assert_eq!(refused(&[(1.0, 5, 4), (2.0, 5, 3), (3.0, 5, 2)]), FitError::NotGrowing);
        assert_eq!(refused(&[(1.0, 5, 4), (0.0, 5, 3)]), FitError::Intensity(0.0));
    }

    proptest! {
        /// L of the formula, written out, is lower beside the fit in every direction.
        #[test]
        fn the_fit_is_a_maximum(
            counts in prop::collection::vec((0.01..10.0_f64, 1..50_usize, 0.0..=1.0_f64), 2..20),
            unit in 1e-6..1e6_f64,
        ) {
            let counts: Vec<_> = counts.iter().map(|&(x, n, part)| (unit * x, n, (n as f64 * part) as usize)).collect();
            let log_likelihood = |median: f64, dispersion: f64| -> f64 {
                let term = |&(x, n, z): &(f64, usize, usize)| {
                    let p = 0.5 * erfc(-(x / median).ln() / dispersion / 2_f64.sqrt());
                    let q = 0.5 * erfc((x / median).ln() / dispersion / 2_f64.sqrt());
                    (if z > 0 { z as f64 * p.ln() } else { 0.0 }) + (if z < n { (n - z) as f64 * q.ln() } else { 0.0 })
                };
                counts.iter().map(term).sum()
            };
            if let Ok(FragilityCurve { median, dispersion }) = FragilityCurve::fit(&trials(&counts)) {
                prop_assume!(dispersion < 5.0); // beyond, counts without a trend: rounding decides
                let most = log_likelihood(median, dispersion);
                let most = most + 1e-12 * most.abs(); // a flat maximum is one to rounding
                for beside in [0.99, 1.01] {
                    prop_assert!(log_likelihood(median * (dispersion * (beside - 1.0)).exp(), dispersion) <= most);
                    prop_assert!(log_likelihood(median, dispersion * beside) <= most);
                }
            }
        }
    }
}
