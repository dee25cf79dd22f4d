//! Pulses: the motions by which the field compares structures that rock, as their papers define them.
//!
//! a_p is the amplitude, ω = 2π f the circular frequency, T = 1/f, t = 0 the pulse's start or, where it says so, its middle.
//!
//! [`Shape::definition`] has the ground acceleration of each. Mavroeidis and Papageorgiou define the velocity and its
//! amplitude A. Here a_p is ω A, and the peak of the acceleration is 0.87 to 1 times a_p, depending on γ and ν. `cycles` is n
//! or γ, `phase` is φ or ν. A Ricker wavelet has no end: what is below 1e-9 of a_p is cut.
//!
//! # Straight lines
//!
//! A chord over a step h leaves the curve by up to h²/8 abs(a″), always to the same side. The corners are therefore moved
//! outside the curve by h²/12 abs(a″). Then each line has the impulse of the curve to O(h⁴), and stays within h²/8 abs(a″) of
//! the curve. To O(h³) the line is between −h²/12 and h²/24 times abs(a″) from the curve. The step h is the largest that
//! divides the pulse evenly with h²/8 abs(a″) ≤ `error` a_p. The ends, where a sine has its kinks, are corners. A pulse that
//! begins or ends off 0 gives a record that begins or ends off 0.

use crate::{Refused, ensure};
use rocking::Base;
use rocking::digits::short;
use rocking::run::record::{MAX_SAMPLES, Record};
use rocking::structure::quantity::{Quantity, quantity};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, SQRT_2, TAU};

/// A pulse. [`PULSE`] says what its numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pulse {
    pub shape: Shape,
    pub amplitude: f64,
    pub frequency: f64,
    /// n or γ: [`Shape::cycles`] where the shape leaves no choice.
    pub cycles: f64,
    /// φ or ν: 0 where the shape leaves no choice.
    pub phase: f64,
    pub error: f64,
}

pub const PULSE: [Quantity<Pulse>; 5] = [
    quantity!(amplitude ["m/s2"] 1e-9, 1e9, "amplitude of the ground acceleration"),
    quantity!(frequency ["Hz"] 1e-6, 1e6, "frequency of the pulse"),
    quantity!(cycles ["1"] 1e-2, 1e4, "periods of the pulse"),
    quantity!(phase["rad"] - TAU, TAU, "phase of the pulse"),
    quantity!(error ["1"] 1e-12, 1e-2, "distance of the straight lines from the curve over the amplitude"),
];

/// The default of [`Pulse::error`]: some 220 lines to a period, and 1e-8 of a structure's peaks.
pub const DEFAULT_ERROR: f64 = 1e-4;

/// A wavelet less than this part of its amplitude has ended, and a pulse that begins or ends with less begins or ends at 0.
const NOTHING: f64 = 1e-9;

/// Value of x beyond which both wavelets are less than [`NOTHING`].
const RICKER_END: f64 = 7.5;

/// The largest magnitude of (x³ − 3x) e^(−x²/2), at x² = 3 − √6.
fn beta() -> f64 {
    let x2 = 3.0 - 6.0_f64.sqrt();
    6.0_f64.sqrt() * x2.sqrt() * libm::exp(-0.5 * x2)
}

/// Makes [`Shape`] of rows: the name in files and on the command line, the usual number of periods, whether cycles and phase can be
/// chosen, and the ground acceleration with its source.
macro_rules! shapes {
    ($($shape:ident $name:literal $cycles:literal $has_choice:literal $definition:literal;)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Shape {$(
            #[doc = $definition]
            #[serde(rename = $name)]
            $shape,
        )*}

        impl Shape {
            pub const ALL: [Shape; 6] = [$(Shape::$shape),*];

            pub const fn name(self) -> &'static str {
                match self { $(Shape::$shape => $name),* }
            }

            pub const fn definition(self) -> &'static str {
                match self { $(Shape::$shape => $definition),* }
            }

            pub const fn cycles(self) -> f64 {
                match self { $(Shape::$shape => $cycles),* }
            }

            pub const fn has_choice(self) -> bool {
                match self { $(Shape::$shape => $has_choice),* }
            }
        }
    };
}

shapes! {
    HalfSine "half_sine" 0.5 false "a_p sin(w t), 0 <= t <= T/2 (Housner 1963)";
    Sine "sine" 1.0 true "a_p sin(w t + phi), 0 <= t <= n T; n = 1, phi = 0: type A of Zhang and Makris (2001); n = k + 1/2 - phi/pi: \
        type C_k of Makris and Roussos (2000), whose phi leaves no velocity at the end";
    Cosine "cosine" 1.0 true "a_p cos(w t + phi), 0 <= t <= n T; n = 1, phi = 0: type B of Zhang and Makris (2001)";
    Ricker "ricker" 1.0 false "a_p (1 - x^2) exp(-x^2/2), x = w t/sqrt(2), t = 0 in the middle; f is where its spectrum is largest \
        (Ricker 1943; Vassiliou and Makris 2011)";
    AntisymmetricRicker "antisymmetric_ricker" 1.0 false "a_p (x^3 - 3 x) exp(-x^2/2)/beta, x = w t/sqrt(3), t = 0 in the middle, \
        beta = 1.3801: the peak is a_p; f as above (Vassiliou and Makris 2011)";
    MavroeidisPapageorgiou "mavroeidis_papageorgiou" 2.0 true "d/dt of A/2 (1 + cos(w t/gamma)) cos(w t + nu), |t| <= gamma T/2, \
        a_p = w A: its peak is 0.87 to 1 times a_p (Mavroeidis and Papageorgiou 2003)";
}

/// Units of pulses for a structure: g tan α_cg (m/s²), below which a rigid structure does not lift off, and p_l/2π (Hz).
pub fn units_of(&Base { g, tan_alpha_cg, p_l, .. }: &Base) -> (f64, f64) {
    (g * tan_alpha_cg, p_l / TAU)
}

impl Pulse {
    /// The pulse of this `amplitude` (m/s²) and `frequency` (Hz).
    pub fn new(shape: Shape, amplitude: f64, frequency: f64) -> Pulse {
        let cycles = shape.cycles();
        Pulse { shape, amplitude, frequency, cycles, phase: 0.0, error: DEFAULT_ERROR }
    }

    /// Name of the pulse: its shape, with cycles and phase if the shape has them.
    pub fn name(&self) -> String {
        let &Pulse { shape, .. } = self;
        let [cycles, phase] = [self.cycles, self.phase].map(short);
        let name = shape.name().replace('_', " ");
        match shape {
            Shape::MavroeidisPapageorgiou => format!("{name}, gamma {cycles}, nu {phase} rad"),
            _ if self.cycles == shape.cycles() && self.phase == 0.0 => name,
            _ => format!("{name}, {cycles} cycles, phase {phase} rad"),
        }
    }

    pub fn check(&self) -> Result<(), Refused> {
        let &Pulse { shape, cycles, phase, error, .. } = self;
        PULSE.iter().try_for_each(|quantity| quantity.check((quantity.get)(self))).map_err(Refused::by)?;
        for (name, value, own) in [("cycles", cycles, shape.cycles()), ("phase", phase, 0.0)] {
            ensure(value == own || shape.has_choice(), || {
                format!("{name} = {value} is not possible: {} has {own}", shape.name())
            })?;
        }
        // γ ≤ 1 leaves no pulse between the ends of its bell
        ensure(shape != Shape::MavroeidisPapageorgiou || cycles > 1.0, || {
            format!("cycles = {cycles} is out of range: mavroeidis_papageorgiou needs more than 1 (its gamma)")
        })?;
        let samples = self.lines();
        ensure(samples < MAX_SAMPLES as f64, || {
            format!("error = {error} takes {samples:.0} samples: {MAX_SAMPLES} are possible; allow a larger error")
        })
    }

    /// How long the pulse itself lasts, s.
    pub fn duration(&self) -> f64 {
        match self.shape {
            Shape::Ricker => 2.0 * RICKER_END * SQRT_2 / (TAU * self.frequency),
            Shape::AntisymmetricRicker => 2.0 * RICKER_END * 3.0_f64.sqrt() / (TAU * self.frequency),
            _ => self.cycles / self.frequency,
        }
    }

    /// The pulse in straight lines, from 0 s on.
    pub fn record(&self) -> Result<Record, Refused> {
        self.check()?;
        let &Pulse { amplitude, frequency, .. } = self;
        let (duration, lines) = (self.duration(), self.lines());
        let outside = (duration / lines).powi(2) / 12.0;
        let corner = |i: usize| {
            let time = duration * (i as f64 / lines);
            let [a_g, curvature] = self.curve(time);
            let a_g = a_g - outside * curvature;
            (time, if a_g.abs() < NOTHING * amplitude { 0.0 } else { a_g })
        };
        let (times, acceleration) = (0..=lines as usize).map(corner).unzip();
        let [of, at] = [amplitude, frequency].map(short);
        let title = format!("{}, {of} m/s2, {at} Hz", self.name());
        Record::from_samples(title, times, acceleration).map_err(Refused::by)
    }

    /// How many straight lines keep to the error.
    fn lines(&self) -> f64 {
        (self.duration() * (self.largest_curvature() / (8.0 * self.error)).sqrt()).ceil()
    }

    /// Largest magnitude of the second derivative of a_g over a_p, or a bound on it, 1/s².
    fn largest_curvature(&self) -> f64 {
        // of (x³ − 3x) e^(−x²/2): it has it at the first zero of the Hermite polynomial He₆
        const OF_ANTISYMMETRIC: f64 = 5.7834;
        let of_x = match self.shape {
            Shape::HalfSine | Shape::Sine | Shape::Cosine => 1.0,
            Shape::Ricker => 3.0 / 2.0,
            Shape::AntisymmetricRicker => OF_ANTISYMMETRIC / (3.0 * beta()),
            // that of its three sines together
            Shape::MavroeidisPapageorgiou => 1.0 + 1.5 / self.cycles.powi(2),
        };
        of_x * (TAU * self.frequency).powi(2)
    }

    /// a_g and its second derivative at `time` (s) after the start of the pulse, m/s² and m/s⁴.
    fn curve(&self, time: f64) -> [f64; 2] {
        let &Pulse { shape, amplitude, frequency, cycles, phase, .. } = self;
        let omega = TAU * frequency;
        let sine = |phase: f64| {
            let a_g = amplitude * libm::sin(omega * time + phase);
            [a_g, -omega * omega * a_g]
        };
        let middle = time - 0.5 * self.duration();
        match shape {
            Shape::HalfSine | Shape::Sine => sine(phase),
            Shape::Cosine => sine(phase + FRAC_PI_2),
            Shape::Ricker => {
                let x = omega * middle / SQRT_2;
                let (x2, bell) = (x * x, amplitude * libm::exp(-0.5 * x * x));
                [(1.0 - x2) * bell, -0.5 * omega * omega * ((x2 - 6.0) * x2 + 3.0) * bell]
            }
            Shape::AntisymmetricRicker => {
                let x = omega * middle / 3.0_f64.sqrt();
                let (x2, bell) = (x * x, amplitude / beta() * libm::exp(-0.5 * x * x));
                [(x2 - 3.0) * x * bell, omega * omega / 3.0 * ((x2 - 10.0) * x2 + 15.0) * x * bell]
            }
            Shape::MavroeidisPapageorgiou => {
                // its velocity is a sum of three cosines: ½ A (cos(ωt + ν) + ½ Σ cos((1 ± 1/γ) ωt + ν))
                let mut sum = [0.0; 2];
                for (part, of_omega) in [(0.5, 1.0), (0.25, 1.0 + 1.0 / cycles), (0.25, 1.0 - 1.0 / cycles)] {
                    let omega_k = of_omega * omega;
                    let a_g = -amplitude * part * of_omega * libm::sin(omega_k * middle + phase);
                    sum = [sum[0] + a_g, sum[1] - omega_k * omega_k * a_g];
                }
                sum
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use rocking::estimates::intensity::peak_velocity;
    use std::f64::consts::PI;

    const AMPLITUDE: f64 = 3.0;
    const FREQUENCY: f64 = 2.5;
    const OMEGA: f64 = TAU * FREQUENCY;

    fn pulse(shape: Shape) -> Pulse {
        Pulse { error: 1e-6, ..Pulse::new(shape, AMPLITUDE, FREQUENCY) }
    }

    /// Velocity and displacement at the end of `record`.
    fn end_of(record: &Record) -> [f64; 2] {
        record.velocities_and_displacements().last().unwrap()
    }

    /// Of (x³ − 3x) e^(−x²/2), looked for between 0 and 2.
    fn largest_of_third_hermite() -> f64 {
        let values = (0..20_000).map(|i| 1e-4 * f64::from(i)).map(|x| (3.0 * x - x.powi(3)) * (-0.5 * x * x).exp());
        values.fold(0.0, f64::max)
    }

    /// The integrals of the papers' formulas by hand: largest velocity, velocity and displacement at the end.
    #[test]
    fn velocities_and_displacements_have_their_closed_forms() {
        let unit = AMPLITUDE / OMEGA;
        let gamma = 3.0;
        let with = |shape, cycles, phase| Pulse { cycles, phase, ..pulse(shape) };
        for (pulse, largest, velocity, displacement) in [
            (pulse(Shape::HalfSine), 2.0 * unit, 2.0 * unit, PI * unit / OMEGA),
            (pulse(Shape::Sine), 2.0 * unit, 0.0, TAU * unit / OMEGA),
            (with(Shape::Sine, 1.5, 0.0), 2.0 * unit, 2.0 * unit, 3.0 * PI * unit / OMEGA),
            (with(Shape::Sine, 2.0, PI), 2.0 * unit, 0.0, -2.0 * TAU * unit / OMEGA),
            (pulse(Shape::Cosine), unit, 0.0, 0.0),
            (with(Shape::Cosine, 3.0, -FRAC_PI_2), 2.0 * unit, 0.0, 3.0 * TAU * unit / OMEGA),
            (pulse(Shape::Ricker), unit * 2.0_f64.sqrt() * (-0.5_f64).exp(), 0.0, 0.0),
            (pulse(Shape::AntisymmetricRicker), unit * 3.0_f64.sqrt() / largest_of_third_hermite(), 0.0, 0.0),
            // ν = 0: the velocity is A at the middle; ∫ of it is that of three cosines over γT
            (
                with(Shape::MavroeidisPapageorgiou, gamma, 0.0),
                unit,
                0.0,
                unit * [(1.0, 2.0), (1.0 + 1.0 / gamma, 1.0), (1.0 - 1.0 / gamma, 1.0)]
                    .map(|(part, weight): (f64, f64)| 0.5 * weight * (part * gamma * PI).sin() / (part * OMEGA))
                    .iter()
                    .sum::<f64>(),
            ),
            (with(Shape::MavroeidisPapageorgiou, 2.5, FRAC_PI_2), f64::NAN, 0.0, 0.0),
        ] {
            let record = pulse.record().unwrap();
            if !largest.is_nan() {
                assert_relative_eq!(peak_velocity(&record), largest, max_relative = 1e-6);
            }
            let [v, d] = end_of(&record);
            assert_abs_diff_eq!(v, velocity, epsilon = 1e-8 * unit);
            assert_abs_diff_eq!(d, displacement, epsilon = 1e-7 * unit / OMEGA);
        }
    }

    /// Lines stay within the error of the curve at a hundred points each, and are not much better than that: no more of them
    /// than it takes. Lines with the curve's impulse leave the curve to both sides.
    #[test]
    fn straight_lines_keep_to_the_error() {
        for shape in Shape::ALL {
            for error in [1e-2, 1e-4, 1e-5] {
                let pulse = Pulse { error, ..pulse(shape) };
                let record = pulse.record().unwrap();
                let mut off = [0.0_f64; 2];
                for (t, a) in record.times().windows(2).zip(record.acceleration().windows(2)) {
                    for part in (0..=100).map(|i| f64::from(i) / 100.0) {
                        let line = a[0] + part * (a[1] - a[0]);
                        let time = (t[0] + part * (t[1] - t[0])).min(pulse.duration());
                        let excess = (line - pulse.curve(time)[0]) / AMPLITUDE;
                        off = [off[0].min(excess), off[1].max(excess)];
                    }
                }
                let most = off[1].max(-off[0]);
                assert!((0.3 * error..=error).contains(&most), "{shape:?}, {error}: {off:?}");
            }
        }
    }

    #[test]
    fn refusals_name_the_number_its_value_and_the_limit() {
        let refused = |pulse: Pulse| pulse.record().unwrap_err().to_string();
        let one = pulse(Shape::Sine);
        let gamma = refused(Pulse { cycles: 1.0, ..pulse(Shape::MavroeidisPapageorgiou) });
        assert_eq!(gamma, "cycles = 1 is out of range: mavroeidis_papageorgiou needs more than 1 (its gamma)");
        let samples = refused(Pulse { cycles: 1e4, error: 1e-12, ..one });
        assert!(samples.starts_with("error = 0.000000000001 takes 2221"), "{samples}");
    }
}
