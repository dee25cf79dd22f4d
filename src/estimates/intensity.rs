//! Intensity measures of a ground motion: how strong it is, in one number.
//!
//! f_fc and ζ_fc are those of the lowest mode of many masses. All are exact for a record that is linear between its samples.

use crate::digits::short;
use crate::estimates::response_spectrum::{LANES, PERIOD, ZETA, of_record};
use crate::run::record::Record;
use crate::series::bisection::last_where;
use std::borrow::Cow;
use std::f64::consts::FRAC_PI_2;

/// An intensity measure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum IntensityMeasure {
    /// Peak ground acceleration PGA, max |a_g|, g.
    #[default]
    Pga,
    /// Peak ground velocity PGV, max |∫ a_g dt|, at rest before the first sample, m/s.
    Pgv,
    /// Spectral acceleration of the fixed base S_a(1/f_fc, ζ_fc) (see [`crate::estimates::response_spectrum`]), g.
    Sa,
    /// Cumulative absolute velocity CAV, ∫ |a_g| dt, m/s.
    Cav,
    /// Arias intensity I_A, π/(2 g) ∫ a_g² dt, m/s.
    Arias,
    /// Significant duration D_5_95, from 5 % to 95 % of the Arias intensity, s.
    Duration,
    /// Average spectral acceleration of the fixed base S_a_avg: geometric mean at ten periods, evenly spaced from 0.2/f_fc to 3/f_fc, g.
    AverageSa,
    /// Spectral acceleration at this period (s) with this damping ratio, whatever the structure has, as S_a(1 s, 2 %), g.
    SaAt(f64, f64),
}

use IntensityMeasure::{Arias, AverageSa, Cav, Duration, Pga, Pgv, Sa, SaAt};

/// The damping ratio of S_a(1 s).
const USUAL_ZETA: f64 = 0.05;

impl IntensityMeasure {
    /// All intensity measures.
    pub const ALL: [IntensityMeasure; 7] = [Pga, Pgv, Sa, Cav, Arias, Duration, AverageSa];

    /// The measures that every row of a sweep has: all but the average, which takes as long as many a run.
    pub const COLUMNS: [IntensityMeasure; 6] = *IntensityMeasure::ALL.first_chunk().expect("there are seven");

    /// The measure called `name`, such as PGA, S_a(1 s) or S_a(1 s, 2 %).
    pub fn read(name: &str) -> Option<IntensityMeasure> {
        let at = || {
            let (period, zeta) =
                name.strip_prefix("S_a(")?.strip_suffix(')').map(|of| of.split_once(',').unwrap_or((of, "")))?;
            let number = |text: &str, unit| text.trim().strip_suffix(unit)?.trim().parse::<f64>().ok();
            let zeta = if zeta.is_empty() { USUAL_ZETA } else { number(zeta, '%')? / 100.0 };
            let period = number(period, 's').filter(|period| PERIOD.check(*period).is_ok())?;
            ZETA.check(zeta).is_ok().then_some(SaAt(period, zeta))
        };
        IntensityMeasure::ALL.into_iter().find(|measure| measure.name() == name).or_else(at)
    }

    /// The name, the unit and the description, which the name follows for S_a at a given period.
    const fn told(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Pga => ("PGA", "g", "peak ground acceleration PGA"),
            Pgv => ("PGV", "m/s", "peak ground velocity PGV"),
            Sa => ("S_a", "g", "spectral acceleration of the fixed base S_a(1/f_fc, zeta_fc)"),
            Cav => ("CAV", "m/s", "cumulative absolute velocity CAV"),
            Arias => ("I_A", "m/s", "Arias intensity I_A"),
            Duration => ("D_5_95", "s", "significant duration D_5_95"),
            AverageSa => ("S_a_avg", "g", "average spectral acceleration of the fixed base from 0.2/f_fc to 3/f_fc"),
            SaAt(..) => ("S_a", "g", "spectral acceleration"),
        }
    }

    /// Its name in files and tables.
    pub fn name(self) -> Cow<'static, str> {
        match self {
            SaAt(T, USUAL_ZETA) => format!("S_a({T} s)").into(),
            SaAt(T, zeta) => format!("S_a({T} s, {} %)", short(100.0 * zeta)).into(),
            _ => self.told().0.into(),
        }
    }

    /// Its unit.
    pub const fn unit(self) -> &'static str {
        self.told().1
    }

    /// Description.
    pub fn description(self) -> Cow<'static, str> {
        match (self, self.told().2) {
            (SaAt(..), description) => format!("{description} {}", self.name()).into(),
            (_, description) => description.into(),
        }
    }
}

/// Peak ground velocity of `record`, m/s: at rest before its first sample. The velocity is largest at a sample or where
/// the acceleration passes 0.
pub fn peak_velocity(record: &Record) -> f64 {
    let (mut velocity, mut peak) = (0.0, 0.0_f64);
    for (t, a) in record.times().windows(2).zip(record.acceleration().windows(2)) {
        let step = t[1] - t[0];
        if a[0] * a[1] < 0.0 {
            let until_zero = step * (a[0] / (a[0] - a[1]));
            peak = peak.max(f64::abs(velocity + 0.5 * until_zero * a[0]));
        }
        velocity += 0.5 * step * (a[0] + a[1]);
        peak = peak.max(velocity.abs());
    }
    peak
}

/// Arias intensity π/(2 g) ∫ a_g² dt of `record`, m/s; `g` in m/s².
pub fn arias_intensity(record: &Record, g: f64) -> f64 {
    FRAC_PI_2 / g * squares(record).sum::<f64>()
}

/// Cumulative absolute velocity ∫ |a_g| dt of `record`, m/s.
pub fn cumulative_absolute_velocity(record: &Record) -> f64 {
    let area = |(t, a): (&[f64], &[f64])| match a[0] * a[1] < 0.0 {
        true => 0.5 * (t[1] - t[0]) * (a[0] * a[0] + a[1] * a[1]) / (a[0] - a[1]).abs(),
        false => 0.5 * (t[1] - t[0]) * (a[0] + a[1]).abs(),
    };
    record.times().windows(2).zip(record.acceleration().windows(2)).map(area).sum()
}

/// Average spectral acceleration of `record` about the period `T` (s) at the damping ratio `zeta`, m/s²: the geometric mean of
/// S_a at ten periods, evenly spaced from 0.2 T to 3 T.
pub fn average_spectral_acceleration(record: &Record, T: f64, zeta: f64) -> f64 {
    const PERIODS: u32 = 10;
    let period = |i: u32| T * (0.2 + 2.8 * f64::from(i) / f64::from(PERIODS - 1));
    let spectrum = of_record::<LANES>(record, &Vec::from_iter((0..PERIODS).map(|i| (period(i), zeta))));
    libm::exp(spectrum.into_iter().map(libm::log).sum::<f64>() / f64::from(PERIODS))
}

/// The instants at which 5 % and 95 % of the Arias intensity of `record` are reached, s. The significant duration D_5–95 is between
/// them. If the ground is at rest, both are the start of the record.
pub fn significant_duration(record: &Record) -> [f64; 2] {
    let total: f64 = squares(record).sum();
    [0.05, 0.95].map(|part| {
        let (mut before, wanted) = (0.0, part * total);
        for (i, square) in squares(record).enumerate() {
            if before + square >= wanted && square > 0.0 {
                let (step, a) = (record.times()[i + 1] - record.times()[i], &record.acceleration()[i..]);
                let until = |tau: f64| square_of(tau, a[0], a[0] + (a[1] - a[0]) * tau / step);
                return record.times()[i] + last_where(0.0, step, |tau| before + until(tau) <= wanted);
            }
            before += square;
        }
        record.start()
    })
}

/// ∫ a_g² dt between each two samples, m²/s³.
fn squares(record: &Record) -> impl Iterator<Item = f64> {
    let samples = record.times().windows(2).zip(record.acceleration().windows(2));
    samples.map(|(t, a)| square_of(t[1] - t[0], a[0], a[1]))
}

/// ∫ a² dt of an acceleration that changes linearly from `first` to `last` over `duration`.
fn square_of(duration: f64, first: f64, last: f64) -> f64 {
    duration / 3.0 * (first * first + first * last + last * last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimates::response_spectrum::spectral_acceleration;
    use approx::assert_relative_eq;

    fn peak(times: &[f64], acceleration: &[f64]) -> f64 {
        peak_velocity(&Record::from_samples("", times.into(), acceleration.into()).unwrap())
    }

    /// Areas of triangles, by hand.
    #[test]
    fn the_velocity_peaks_where_the_acceleration_passes_zero() {
        assert_relative_eq!(peak(&[0.0, 1.0, 4.0], &[0.0, 2.0, -4.0]), 2.0, max_relative = 1e-15); // falls through 0 at 2
        assert_relative_eq!(peak(&[5.0, 6.0, 7.0], &[0.0, -3.0, 0.0]), 3.0, max_relative = 1e-15);
        assert_relative_eq!(peak(&[0.0, 1.0], &[1.0, -3.0]), 1.0, max_relative = 1e-15); // ends at -1, was 1/8
        assert_relative_eq!(peak(&[0.0, 0.5, 2.0], &[4.0, -4.0, -4.0]), 6.0, max_relative = 1e-15);
    }

    /// Areas of triangles, by hand; S_a at ten periods is that of the spectrum.
    #[test]
    fn the_absolute_velocity_adds_up_and_the_average_is_over_ten_periods() {
        let record = Record::from_samples("", vec![0.0, 1.0, 4.0, 6.0], vec![0.0, 2.0, -4.0, -4.0]).unwrap();
        assert_relative_eq!(cumulative_absolute_velocity(&record), 1.0 + 1.0 + 4.0 + 8.0, max_relative = 1e-15);
        let periods = [0.1, 0.255_555_6, 0.411_111_1, 0.566_666_7, 0.722_222_2, 0.877_777_8, 1.033_333_3, 1.188_888_9];
        let product: f64 =
            periods.iter().chain(&[1.344_444_4, 1.5]).map(|T| spectral_acceleration(&record, *T, 0.03)).product();
        assert_relative_eq!(average_spectral_acceleration(&record, 0.5, 0.03), product.powf(0.1), max_relative = 1e-6);
    }

    /// Of a_g = t over 1 s: ∫ t² = 1/3, of which a part comes until its cube root; then of a rest, which adds nothing.
    #[test]
    fn the_arias_intensity_of_a_ramp_has_its_closed_form() {
        for times in [vec![2.0, 3.0, 3.0 + 1e-9, 9.0], vec![2.0, 2.5, 3.0, 3.0 + 1e-9, 9.0]] {
            let a = times.iter().map(|t| if *t <= 3.0 { t - 2.0 } else { 0.0 }).collect();
            let record = Record::from_samples("", times, a).unwrap();
            assert_relative_eq!(arias_intensity(&record, 10.0), FRAC_PI_2 / 30.0, max_relative = 1e-8);
            let [first, last] = significant_duration(&record);
            assert_relative_eq!(first, 2.0 + 0.05_f64.cbrt(), max_relative = 1e-8);
            assert_relative_eq!(last, 2.0 + 0.95_f64.cbrt(), max_relative = 1e-8);
        }
        assert_eq!(significant_duration(&Record::at_rest(3.0)), [0.0, 0.0]);
    }
}
