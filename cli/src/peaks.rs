//! The largest magnitudes of a motion, also between the instants at which it is looked at.
use rocking::{Motion, Outputs, Phase, State, Structure, Transition, TransitionKind};

/// A motion is to be looked at so often: instants at most this part of the vibration period 2π/ω_u apart.
pub const PART_OF_PERIOD: f64 = 1.0 / 12.0;

/// Peaks so far of theta, u and a_t, which depend on the state alone but for the rigid limit's a_t.
///
/// Between two instants of one phase each is taken as the cubic with their values and rates at both ends.
pub struct Peaks {
    structure: Structure,
    phase: Phase,
    last: Instant,
    largest: [f64; 3],
}

/// theta, u and a_t at an instant, and their rates.
struct Instant {
    time: f64,
    values: [f64; 3],
    rates: [f64; 3],
}

impl Peaks {
    /// Of `structure` from `motion` on, whose rates are those under its own ground acceleration.
    pub fn from(structure: Structure, motion: &Motion) -> Peaks {
        let last = Instant::of(&structure, motion.time, motion.phase, &motion.state, motion.a_g);
        Peaks { structure, phase: motion.phase, largest: last.values.map(f64::abs), last }
    }

    /// Takes in the motion up to `time` (s) and `state` in `phase`, without a transition on the way.
    pub fn reach(&mut self, time: f64, phase: Phase, state: &State, a_g: f64) {
        let instant = Instant::of(&self.structure, time, phase, state, a_g);
        for (i, largest) in self.largest.iter_mut().enumerate() {
            let (from, to) = (&self.last, &instant);
            let peak = cubic_peak([from.values[i], to.values[i]], [from.rates[i], to.rates[i]], to.time - from.time);
            *largest = largest.max(peak);
        }
        self.last = instant;
    }

    /// Takes in the motion up to the transition `at`, and goes on after it.
    pub fn pass(&mut self, at: &Transition, a_g: f64) {
        self.reach(at.time, self.phase, &at.before, a_g);
        self.phase = match at.kind {
            TransitionKind::Uplift(side) | TransitionKind::Impact(side) => Phase::Rocking(side),
            TransitionKind::Landing | TransitionKind::Settling => Phase::FullContact,
            TransitionKind::Overturning(side) => Phase::Overturned(side),
        };
        self.last = Instant::of(&self.structure, at.time, self.phase, &at.after, a_g);
    }

    /// The peaks of theta, u and a_t.
    pub fn largest(&self) -> [f64; 3] {
        self.largest
    }
}

impl Instant {
    fn of(structure: &Structure, time: f64, phase: Phase, state: &State, a_g: f64) -> Instant {
        let of_interest = |outputs: Outputs| [outputs.theta, outputs.u, outputs.a_t];
        Instant {
            time,
            values: of_interest(Outputs::of(structure, phase, state, 0.0)),
            rates: of_interest(Outputs::rates(structure, phase, state, a_g)),
        }
    }
}

/// The largest magnitude of the cubic with these values and rates at the ends of `duration`.
fn cubic_peak(values: [f64; 2], rates: [f64; 2], duration: f64) -> f64 {
    let [start, end] = values;
    let [from, to] = rates.map(|rate| rate * duration);
    let ends = start.abs().max(end.abs());
    if from * to >= 0.0 {
        return ends;
    }
    // Rate along the unit interval: a s² + b s + c, which changes sign once.
    let rise = end - start;
    let (a, b, c) = (3.0 * (from + to - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * from - to), from);
    let q = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
    let turns = [q / a, c / q].into_iter().find(|s| (0.0..=1.0).contains(s));
    turns.map_or(ends, |s| ends.max((start + s * (c + s * (b / 2.0 + s * a / 3.0))).abs()))
}

#[cfg(test)]
mod tests {
    use super::cubic_peak;
    use approx::assert_relative_eq;

    /// p(t) = t³ − 3t on [−2, 1.5] turns at −1 and 1, where |p| = 2.
    #[test]
    fn the_peak_of_a_cubic_is_where_it_turns() {
        let p = |t: f64| t * t * t - 3.0 * t;
        let rate = |t: f64| 3.0 * t * t - 3.0;
        let peak = |from: f64, to: f64| cubic_peak([p(from), p(to)], [rate(from), rate(to)], to - from);
        assert_relative_eq!(peak(-1.3, 0.2), 2.0, max_relative = 1e-14);
        assert_relative_eq!(peak(-0.2, 1.4), 2.0, max_relative = 1e-14);
        assert_eq!(peak(-0.5, 0.7), p(0.7).abs());
        assert_eq!(peak(1.2, 3.0), p(3.0));
        assert_eq!(peak(1.0, 1.0), 2.0);
    }

    #[test]
    fn a_parabola_and_a_line_are_cubics_too() {
        assert_eq!(cubic_peak([0.0, 0.0], [4.0, -4.0], 1.0), 1.0);
        assert_eq!(cubic_peak([0.0, 0.0], [2.0, -2.0], 2.0), 1.0);
        assert_eq!(cubic_peak([1.0, -3.0], [-2.0, -2.0], 2.0), 3.0);
        assert_eq!(cubic_peak([0.0, 0.0], [0.0, 0.0], 0.1), 0.0);
    }

    /// Twelve instants per period, as [`PART_OF_PERIOD`] has them at least.
    #[test]
    fn a_vibration_peaks_between_the_instants() {
        let step = std::f64::consts::TAU / 12.0;
        let from = std::f64::consts::FRAC_PI_2 - 0.3 * step;
        let to = from + step;
        let peak = cubic_peak([from.sin(), to.sin()], [from.cos(), to.cos()], step);
        assert!((peak - 1.0).abs() < 2e-4, "{peak}");
    }
}
