//! Fragility curve: the probability that a ground motion of intensity x exceeds a limit. The curve is a lognormal
//! distribution function, fitted to counted exceedances by maximum likelihood, with its uncertainty.
//!
//! ```text
//! P(x) = Φ(ln(x/x_m)/β)                               x_m median, β dispersion, Φ standard normal distribution
//! L    = Π P(x_i)^z_i (1 − P(x_i))^(n_i − z_i)        z_i exceedances in n_i runs at intensity x_i; → maximum
//! ```
//!
//! (J. W. Baker, Efficient analytical fragility function fitting using dynamic structural analysis, Earthquake Spectra 31,
//! 2015.) With P(x) = Φ(a + b ln x), ln L is concave in a and b. ln L has one maximum if intensities with and without
//! exceedances overlap. Otherwise L grows without end as β → 0, and there is no curve.
//!
//! Runs under one record at many scale factors depend on each other, those under different records do not. With the
//! contributions s_j = ∂ln L_j/∂(a, b) of the G independent groups of runs and the information I = −E[∂²ln L/∂(a, b)²],
//!
//! ```text
//! V = G/(G − 1) · I⁻¹ (Σ_j s_j s_jᵀ) I⁻¹              covariance of a, b
//! P(x) between Φ(a + b ln x ± t √V_z),   V_z = (1, ln x) V (1, ln x)ᵀ,   t Student's with G − 1 degrees of freedom
//! ```
//!
//! (K.-Y. Liang, S. L. Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73, 1986.)

use crate::{Refused, ensure};
use libm::erfc;
use nalgebra::{Matrix2, RowVector2, Vector2};
use rocking::digits::short;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::iter;

/// Smallest number of independent groups that gives an uncertainty.
pub const FEWEST_GROUPS: usize = 5;

const NOT_GROWING: &str = "exceedances do not grow with the intensity";

/// Runs of one group at one intensity, counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trials {
    /// The group: runs of different groups do not depend on each other.
    pub group: usize,
    /// Intensity x_i > 0 of the ground motion, in any one unit.
    pub intensity: f64,
    /// Runs n_i.
    pub runs: usize,
    /// Number of these runs that exceed the limit, z_i.
    pub exceedances: usize,
}

/// A lognormal fragility curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragilityCurve {
    /// Intensity at which the limit is exceeded with probability ½, x_m, in the unit of the trials.
    pub median: f64,
    /// Standard deviation of ln x, β.
    pub dispersion: f64,
    /// Uncertainty, if there are at least [`FEWEST_GROUPS`] independent groups of runs.
    pub certainty: Option<Certainty>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty {
    /// Covariance of a and b in P = Φ(a + b ln(x/x_m)).
    pub covariance: Matrix2<f64>,
    /// Half a 95 % interval over the standard deviation.
    pub half_width: f64,
}

impl Trials {
    /// Counts runs by group and intensity. Each is given by its group, its intensity and whether the limit was exceeded,
    /// if that is known.
    pub fn count(runs: impl IntoIterator<Item = (usize, f64, Option<bool>)>) -> Vec<Trials> {
        let mut trials = BTreeMap::new();
        for (group, intensity, has_exceeded) in runs {
            if let Some(has_exceeded) = has_exceeded {
                let of_none = Trials { group, intensity, runs: 0, exceedances: 0 };
                let at: &mut Trials = trials.entry((group, intensity.to_bits())).or_insert(of_none);
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

    /// The curve of greatest likelihood L; refused where the trials have none.
    pub fn fit(trials: &[Trials]) -> Result<FragilityCurve, Refused> {
        ensure(!trials.is_empty(), || "no run is counted".into())?;
        trials.iter().map(|at| at.intensity).try_for_each(|at| {
            ensure(at > 0.0 && at.is_finite(), || format!("the intensity {at} must be a finite number greater than 0"))
        })?;
        check_overlap(trials)?;
        // Logarithms from their mean, so that a and b stay apart whatever the unit.
        let origin = trials.iter().map(|at| at.intensity.ln()).sum::<f64>() / trials.len() as f64;
        let [a, b] = most_likely(trials, origin).into();
        ensure(b > 0.0, || NOT_GROWING.into())?;
        let center = origin - a / b;
        let certainty = Certainty::of(trials, center, Vector2::new(0.0, b));
        Ok(FragilityCurve { median: center.exp(), dispersion: b.recip(), certainty })
    }

    /// The 95 % confidence interval of P(x) at `intensity` > 0.
    pub fn band(&self, intensity: f64) -> Option<(f64, f64)> {
        let Certainty { covariance, half_width } = self.certainty?;
        let from_median = (intensity / self.median).ln();
        let row = RowVector2::new(1.0, from_median);
        let deviation = half_width * (row * covariance * row.transpose()).x.sqrt();
        let z = from_median / self.dispersion;
        Some((normal_distribution(z - deviation), normal_distribution(z + deviation)))
    }

    /// The 95 % confidence interval of the median, two intensities: x_m exp(± t β √V_aa).
    pub fn median_range(&self) -> Option<(f64, f64)> {
        let Certainty { covariance, half_width } = self.certainty?;
        let factor = (half_width * self.dispersion * covariance.m11.sqrt()).exp();
        Some((self.median / factor, self.median * factor))
    }
}

impl Certainty {
    /// Of the most likely (a, b), `at`, if there are groups enough.
    fn of(trials: &[Trials], origin: f64, at: Vector2<f64>) -> Option<Certainty> {
        let mut by_group: BTreeMap<usize, Vec<Trials>> = BTreeMap::new();
        trials.iter().for_each(|of| by_group.entry(of.group).or_default().push(*of));
        let groups = by_group.len();
        if groups < FEWEST_GROUPS {
            return None;
        }
        let scores = by_group.values().map(|of| derivatives(of, origin, at).0);
        let scatter: Matrix2<f64> = scores.map(|score| score * score.transpose()).sum();
        let inverse = derivatives(trials, origin, at).1.try_inverse()?;
        let few = groups as f64 / (groups - 1) as f64;
        Some(Certainty { covariance: inverse * scatter * inverse * few, half_width: student(groups - 1) })
    }
}

/// The 97.5 % point of Student's distribution, to 1e-3 from 4 `degrees` of freedom on (Abramowitz and Stegun 26.7.5).
fn student(degrees: usize) -> f64 {
    const Z: f64 = 1.959_963_984_540_054; // of the normal distribution
    let polynomial = |coefficients: &[f64]| coefficients.iter().rev().fold(0.0, |sum, c| sum * Z * Z + c) * Z;
    let terms = [
        1.0,
        polynomial(&[1.0, 1.0]) / 4.0 / Z,
        polynomial(&[3.0, 16.0, 5.0]) / 96.0 / Z,
        polynomial(&[-15.0, 17.0, 19.0, 3.0]) / 384.0 / Z,
        polynomial(&[-945.0, -1920.0, 1482.0, 776.0, 79.0]) / 92160.0 / Z,
    ];
    Z * terms.iter().rev().fold(0.0, |sum, term| sum / degrees as f64 + term)
}

/// Whether a finite maximum of L exists.
fn check_overlap(trials: &[Trials]) -> Result<(), Refused> {
    let range = |has: fn(&Trials) -> bool| {
        let intensities = || trials.iter().filter(|at| has(at)).map(|at| at.intensity);
        intensities().reduce(f64::min).zip(intensities().reduce(f64::max))
    };
    let with = range(|at| at.exceedances > 0).ok_or(Refused::by("never exceeded: raise the intensity"))?;
    let without = range(|at| at.exceedances < at.runs).ok_or(Refused::by("always exceeded: lower the intensity"))?;
    ensure(without.1 > with.0, || {
        let [highest_without, lowest_with] = [without.1, with.0].map(short);
        format!(
            "dispersion unknown: runs within the limit end at {highest_without}, runs beyond it start at {lowest_with}; \
             add intensities in between, records or structures"
        )
    })?;
    ensure(with.1 > without.0, || NOT_GROWING.into())
}

/// (a, b) that maximise ln L for P(x) = Φ(a + b (ln x − origin)): Newton's method with the expected second derivatives,
/// and a shorter step where the full one would lower L.
fn most_likely(trials: &[Trials], origin: f64) -> Vector2<f64> {
    const MAX_ITERATIONS: usize = 100;
    const ACCURACY: f64 = 1e-12;
    let mut at = Vector2::zeros();
    for _ in 0..MAX_ITERATIONS {
        let (gradient, information) = derivatives(trials, origin, at);
        let Some(full) = information.lu().solve(&gradient) else { break };
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

/// The gradient of ln L and the information I, its expected second derivatives with the sign changed.
fn derivatives(trials: &[Trials], origin: f64, at: Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
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
    (gradient, information)
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
        counts.iter().map(|&(intensity, runs, exceedances)| Trials { group: 0, intensity, runs, exceedances }).collect()
    }

    #[test]
    fn counts_without_a_curve_are_refused_with_the_reason() {
        for (counts, reason) in [
            (&[][..], "no run is counted"),
            (&[(1.0, 5, 0), (2.0, 5, 0)], "never exceeded: raise the intensity"),
            (&[(1.0, 5, 5), (2.0, 5, 5)], "always exceeded: lower the intensity"),
            (&[(1.0, 5, 0), (2.0, 5, 3), (3.0, 5, 5)], "dispersion unknown: runs within the limit end at 2, "),
            (&[(1.0, 5, 5), (2.0, 5, 3), (3.0, 5, 0)], NOT_GROWING),
            (&[(1.0, 5, 4), (2.0, 5, 3), (3.0, 5, 2)], NOT_GROWING),
            (&[(1.0, 5, 4), (0.0, 5, 3)], "the intensity 0 must be a finite number greater than 0"),
        ] {
            let refused = FragilityCurve::fit(&trials(counts)).unwrap_err().to_string();
            assert!(refused.starts_with(reason), "{refused}");
        }
    }

    #[test]
    fn few_records_have_no_band() {
        let fit = |groups: usize| {
            let alike = |group| {
                trials(&[(0.5, 5, 1), (1.0, 5, 2), (2.0, 5, 4)]).into_iter().map(move |of| Trials { group, ..of })
            };
            FragilityCurve::fit(&(0..groups).flat_map(alike).collect::<Vec<_>>()).unwrap()
        };
        let few = fit(FEWEST_GROUPS - 1);
        assert_eq!((few.band(1.0), few.median_range()), (None, None));
        assert!(fit(FEWEST_GROUPS).band(1.0).is_some());
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
            if let Ok(curve) = FragilityCurve::fit(&trials(&counts)) {
                let FragilityCurve { median, dispersion, .. } = curve;
                prop_assume!(dispersion < 5.0); // beyond, counts without a trend: rounding decides
                // Φ(−1)
                assert_relative_eq!(curve.probability(median * (-dispersion).exp()), 0.158_655_253_931_457, max_relative = 1e-9);
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
