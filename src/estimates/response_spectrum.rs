//! Response spectrum of an acceleration: S_a(T, ζ), the largest absolute acceleration of an oscillator under it.
//!
//! ```text
//! ü + 2 ζ ω u̇ + ω² u = −a,        S_a = max |ü + a| = max |2 ζ ω u̇ + ω² u|,        ω = 2π/T
//! ```
//!
//! S_a is the absolute acceleration, not the pseudo-acceleration ω² max|u|. Eqs 2 and 20 contain ü + a_g, which includes the force
//! of the damper, and S_a bounds it in Eqs 4 and 22. Both accelerations are close at small damping, but
//! ζ_u = ζ_fc c_ratio/√(1−χ) of a slender structure need not be small.
//!
//! The acceleration is a polynomial Σ a_k σᵏ over each stretch of time h: of degree 1 between two samples of a record, and on a floor as
//! the engine expands the motion. The motion of the oscillator u = h² Σ y_k σᵏ and its absolute acceleration Σ A_k σᵏ follow:
//!
//! ```text
//! A_k = W² y_k + 2 ζ W (k+1) y_{k+1},        (k+1) (k+2) y_{k+2} = −(a_k + A_k),        W = ω h
//! ```
//!
//! Nothing is sampled: a bound of Σ A_k σᵏ tells most of the time that no peak is within the stretch, and otherwise its extremes are found.

use crate::Output;
use crate::engine::piece::{Piece, Watch};
use crate::mechanics::arc::stretch;
use crate::mechanics::lateral::Coordinates;
use crate::run::ground_motion::Segment;
use crate::run::record::Record;
use crate::run::{End, Run, RunError, Runs};
use crate::series::extremes::{self, OFF_CHORD};
use crate::series::taylor::{Series, ZERO, each_order, series};
use crate::structure::quantity::{Quantity, Refused};
use std::array;
use std::f64::consts::{PI, TAU};

/// Ranges of an oscillator: those of a structure's f_fc and zeta_fc.
pub(crate) const PERIOD: Quantity<f64> = Quantity::limit("period", "s", [1e-4, 1e3], "period of an oscillator");
pub(crate) const ZETA: Quantity<f64> = Quantity::limit("zeta", "1", [0.0, 10.0], "damping ratio of an oscillator");

/// The most oscillators that move side by side.
pub(crate) const LANES: usize = 16;

/// The longest stretch of time in one series, as ω h max(1, 2ζ). Longer ones are divided.
const LONGEST: f64 = 2.1;

/// Stretches up to these lengths need terms up to these orders: those beyond are below 1e-17 of the motion.
const ORDERS: [(f64, usize); 7] = [(0.028, 7), (0.09, 9), (0.2, 11), (0.36, 13), (0.85, 17), (1.5, 21), (LONGEST, 24)];

/// −1/((k+1) (k+2)) for each order k.
const SHARES: Series = each_order!(k from 0: -1.0 / ((k + 1) * (k + 2)) as f64);

/// Oscillators under the same acceleration, from rest.
#[derive(Clone, Debug)]
struct Oscillators<const N: usize = LANES> {
    groups: Vec<Group<N>>,
    /// The place of each among all lanes.
    places: Vec<usize>,
    room: Box<Room<N>>,
}

/// Oscillators side by side. Copies of the last one fill a group.
#[derive(Clone, Copy, Debug)]
struct Group<const N: usize> {
    /// How many are no copies.
    count: usize,
    omega: [f64; N],
    zeta: [f64; N],
    u: [f64; N],
    u_dot: [f64; N],
    /// The largest |ü + a| so far.
    peak: [f64; N],
    /// The largest ω max(1, 2ζ).
    rate: f64,
}

impl<const N: usize> Oscillators<N> {
    /// Oscillators of these periods (s) and damping ratios.
    fn new(of: &[(f64, f64)]) -> Oscillators<N> {
        let rate = |(T, zeta): (f64, f64)| TAU / T * f64::max(1.0, 2.0 * zeta);
        let mut order = Vec::from_iter(0..of.len());
        order.sort_by(|i, j| rate(of[*j]).total_cmp(&rate(of[*i])));
        let group = |order: &[usize]| {
            let [omega, zeta] = [|of: (f64, f64)| TAU / of.0, |of: (f64, f64)| of.1]
                .map(|number| array::from_fn(|i| number(of[order[i.min(order.len() - 1)]])));
            let none = [0.0; N];
            Group { count: order.len(), omega, zeta, u: none, u_dot: none, peak: none, rate: rate(of[order[0]]) }
        };
        let groups = order.chunks(N).map(group).collect();
        let mut places = vec![0; of.len()];
        order.iter().enumerate().for_each(|(place, i)| places[*i] = place);
        Oscillators { groups, places, room: Box::new([[0.0; N]; ZERO.len()]) }
    }

    /// Goes on for `duration` (s), over which the acceleration (m/s²) is this polynomial from 0 to 1.
    fn see(&mut self, acceleration: &[f64], duration: f64) {
        if duration < 1e-100 {
            return; // its square underflows
        }
        self.groups.iter_mut().for_each(|group| group.see(acceleration, [duration; N], &mut self.room));
    }

    /// The largest |ü + a| of each, in m/s². The oscillators swing freely for half a period more. Their extremes after that are no larger.
    fn end(mut self) -> Vec<f64> {
        self.groups.iter_mut().for_each(|group| group.see(&[0.0], group.omega.map(|omega| PI / omega), &mut self.room));
        self.places.iter().map(|place| self.groups[place / N].peak[place % N]).collect()
    }
}

impl<const N: usize> Group<N> {
    /// Goes on for these durations (s).
    fn see(&mut self, acceleration: &[f64], durations: [f64; N], room: &mut Room<N>) {
        let length = self.rate * durations.iter().fold(0.0, |most: f64, of| most.max(*of));
        if length <= LONGEST {
            return self.step(acceleration, durations, length, room);
        }
        let parts = (length / LONGEST).ceil();
        for i in 0..parts as u64 {
            let (mut part, count) = (series(acceleration), acceleration.len());
            stretch(&mut part[..count], i as f64 / parts, parts.recip());
            self.step(&part[..count], durations.map(|of| of / parts), length / parts, room);
        }
    }

    /// Goes on by one series.
    fn step(&mut self, acceleration: &[f64], durations: [f64; N], length: f64, room: &mut Room<N>) {
        let order = ORDERS.iter().find(|(longest, _)| length <= *longest).map_or(ZERO.len(), |(_, order)| *order);
        let order = order.max(acceleration.len() + 1).min(ZERO.len() - 1);
        let step = GroupStep { group: self, acceleration, durations, room: &mut room[..=order] };
        #[cfg(feature = "lanes")]
        pulp::Arch::new().dispatch(step);
        #[cfg(not(feature = "lanes"))]
        step.take();
    }
}

/// The coefficients of the absolute acceleration of each oscillator of a group.
type Room<const N: usize> = [[f64; N]; ZERO.len()];

/// A step of a group by one series.
struct GroupStep<'a, const N: usize> {
    group: &'a mut Group<N>,
    acceleration: &'a [f64],
    /// In s.
    durations: [f64; N],
    /// As many terms as are needed.
    room: &'a mut [[f64; N]],
}

#[cfg(feature = "lanes")]
impl<const N: usize> pulp::WithSimd for GroupStep<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.take(); // in the widest registers of the processor, with the same bits in all
    }
}

impl<const N: usize> GroupStep<'_, N> {
    #[inline(always)]
    fn take(self) {
        let GroupStep { group: Group { count, omega, zeta, u, u_dot, peak, .. }, acceleration, durations, room } = self;
        let reach: [f64; N] = array::from_fn(|i| omega[i] * durations[i]);
        let stiffness = reach.map(|reach| reach * reach);
        let damping: [f64; N] = array::from_fn(|i| 2.0 * zeta[i] * reach[i]);
        let mut y: [f64; N] = array::from_fn(|i| u[i] / (durations[i] * durations[i]));
        let mut next: [f64; N] = array::from_fn(|i| u_dot[i] / durations[i]);
        let [mut end, mut slope, mut off] = [[0.0; N]; 3];
        for (k, absolute) in room.iter_mut().enumerate() {
            let (a, share, following) = (acceleration.get(k).copied().unwrap_or(0.0), SHARES[k], (k + 1) as f64);
            for i in 0..N {
                let (spring, damper) = (stiffness[i] * y[i], damping[i] * following * next[i]);
                absolute[i] = spring + damper;
                off[i] += OFF_CHORD[k] * absolute[i].abs();
                end[i] += y[i];
                slope[i] += following * next[i];
                (y[i], next[i]) = (next[i], (a + spring + damper) * share);
            }
        }
        let first = room[0];
        for i in 0..N {
            let last = stiffness[i] * end[i] + damping[i] * slope[i];
            (u[i], u_dot[i]) = (end[i] * durations[i] * durations[i], slope[i] * durations[i]);
            peak[i] = peak[i].max(last.abs());
            off[i] += first[i].abs().max(last.abs());
        }
        for i in 0..*count {
            if off[i] <= peak[i] {
                continue;
            }
            let mut of_one = ZERO;
            of_one.iter_mut().zip(&*room).for_each(|(of, lanes)| *of = lanes[i]);
            let of_one = &of_one[..room.len()];
            peak[i] = peak[i].max(extremes::largest(of_one, 1.0));
        }
    }
}

/// The accelerations of floors, as oscillators on them see them.
struct Floors {
    outputs: Vec<Output>,
    spectra: Vec<Oscillators>,
}

impl<Q: Coordinates> Watch<Q> for Floors {
    fn piece(&mut self, piece: &Piece<Q>) {
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            expansion.series(&self.outputs, &mut |part, floors| {
                for (oscillators, floor) in self.spectra.iter_mut().zip(floors) {
                    let (mut acceleration, count) = (series(floor.used()), floor.used().len());
                    stretch(&mut acceleration[..count], 0.0, part.arc.reach);
                    oscillators.see(&acceleration[..count], part.arc.duration());
                }
            });
        }
    }
}

/// An oscillator on a floor, such as what the floor contains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorContents {
    /// Number of the floor, from 0.
    pub floor: usize,
    /// Period, s.
    pub T: f64,
    /// Damping ratio.
    pub zeta: f64,
}

/// S_a of each of the `contents` of the structure of `run`, at rest at the start of the run, until `end` (s), m/s².
pub fn floor_spectra<Q: Runs>(
    run: &Run<Q>,
    end: f64,
    contents: &[FloorContents],
    watch: &mut dyn Watch<Q>,
) -> Result<Vec<f64>, RunError> {
    let mut floors = Vec::from_iter(contents.iter().map(|of| of.floor));
    floors.sort_unstable();
    floors.dedup();
    let on_floor = |floor: &usize| {
        let on_it = contents.iter().filter(|of| of.floor == *floor).map(|of| checked((of.T, of.zeta)));
        Ok(Oscillators::new(&on_it.collect::<Result<Vec<_>, _>>()?))
    };
    let spectra = floors.iter().map(on_floor).collect::<Result<_, Refused>>()?;
    let mut of_floors = Floors { outputs: floors.iter().map(|floor| Output::a_t(*floor)).collect(), spectra };
    if end > run.ground.start() {
        Run { end: End::At(end), ..run.clone() }.follow(&mut (watch, &mut of_floors))?;
    }
    let mut found = Vec::from_iter(of_floors.spectra.into_iter().map(|of| of.end().into_iter()));
    let place = |of: &FloorContents| floors.binary_search(&of.floor).expect("it is one of the floors");
    Ok(contents.iter().filter_map(|of| found[place(of)].next()).collect())
}

/// An oscillator whose period (s) and damping ratio are within their ranges.
fn checked(of: (f64, f64)) -> Result<(f64, f64), Refused> {
    PERIOD.check(of.0)?;
    ZETA.check(of.1)?;
    Ok(of)
}

/// The spectrum of `record`: S_a of each of the `oscillators`, given by periods (s) and damping ratios, m/s².
pub fn spectrum(record: &Record, oscillators: impl IntoIterator<Item = (f64, f64)>) -> Result<Vec<f64>, Refused> {
    let (mut oscillators, mut found) = (oscillators.into_iter().map(checked).peekable(), Vec::new());
    while oscillators.peek().is_some() {
        let some = oscillators.by_ref().take(LANES).collect::<Result<Vec<_>, _>>()?;
        found.extend(of_record::<LANES>(record, &some));
    }
    Ok(found)
}

/// S_a of `record` at the period `T` (s) and the damping ratio `zeta` of a structure, m/s². The oscillator starts at rest.
pub fn spectral_acceleration(record: &Record, T: f64, zeta: f64) -> f64 {
    of_record::<1>(record, &[(T, zeta)])[0]
}

/// S_a of `record` for these oscillators, m/s².
pub(crate) fn of_record<const N: usize>(record: &Record, oscillators: &[(f64, f64)]) -> Vec<f64> {
    let mut oscillators = Oscillators::<N>::new(oscillators);
    for Segment { duration, ground, .. } in record.segments(record.end() - record.start()) {
        let a_g = ground.on_foundation();
        oscillators.see(&[a_g.value, a_g.slope * duration], duration);
    }
    oscillators.end()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Detail, OneMass, Parameters};
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// The ground acceleration is 1 from the start. The peak is 1 + exp(−ζ (π − 2 asin ζ)/√(1−ζ²)) for ζ < 1, and 1 + e^{−2}
    /// for ζ = 1.
    #[test]
    fn a_step_has_its_closed_form_however_it_is_cut() {
        for zeta in [0.0, 0.02, 0.5, 0.9, 1.0] {
            let exact = if zeta < 1.0 {
                let quality = f64::sqrt(1.0 - zeta * zeta);
                1.0 + libm::exp(-zeta * (PI - 2.0 * libm::asin(zeta)) / quality)
            } else {
                1.0 + libm::exp(-2.0)
            };
            for cuts in [1, 7, 1000] {
                let times: Vec<_> = (0..=cuts).map(|i| 3.0 * f64::from(i) / f64::from(cuts)).collect();
                let ground = Record::from_samples("", times.clone(), vec![1.0; times.len()]).unwrap();
                let peak = spectral_acceleration(&ground, 1.3, zeta);
                assert_relative_eq!(peak, exact, max_relative = 1e-13);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Against series of a structure with this oscillator (Eq 1), whose base is too wide to lift off.
        #[test]
        fn the_peak_is_that_of_a_structure_in_full_contact(
            a_g in prop::collection::vec(-10.0..10.0f64, 3..12),
            steps in prop::collection::vec(1e-3..0.3f64, 12),
            f_fc in 0.3..40.0f64,
            zeta_fc in 0.0..0.99f64,
        ) {
            let structure = OneMass::new(Parameters { f_fc, zeta_fc, B: 1e4, ..Parameters::EVISON }).unwrap();
            let times: Vec<f64> = (0..a_g.len()).map(|i| steps[..i].iter().sum()).collect();
            let record = Record::from_samples("", times, a_g).unwrap();
            let (detail, end) = (Detail::Nonlinear, End::At(record.end() + f_fc.recip()));
            let run = Run { detail, tolerance: 1e-12, end, ..Run::new(structure, &record) };
            let (peaks, finish) = run.peaks().unwrap();
            let (found, expected) = (spectral_acceleration(&record, f_fc.recip(), zeta_fc), peaks.of(Output::a_t(0)).unwrap());
            prop_assert!((found - expected.magnitude).abs() <= 1e-11 * found, "{found} {expected:?}");
            prop_assert_eq!(finish.motion.transitions, 0);
        }
    }
}
