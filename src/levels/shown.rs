//! The motion of a level as the numbers in which the formulas are evaluated: values, rates, bounds and power series.
//!
//! The series tell the instant at which an output is largest; its value there comes from the state. At the rigid level a_t
//! follows from θ̈ (Eq 27).

use crate::levels::detail::AnyLevel;
use crate::levels::level::{Bounds, Now};
use crate::mechanics::instant::{Instant, Second, Strut};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::outputs::{Measure, Outputs, composed, searched};
use crate::mechanics::reactions::forces;
use crate::numbers::bend::Bend;
use crate::numbers::dual::Dual;
use crate::numbers::linear::{Leaf, Linear};
use crate::numbers::most::Most;
use crate::numbers::{Angle, Number, Turn};
use crate::series::extremes::{self, Bound, Range};
use crate::series::taylor::{Arc, Series};
use crate::series::terms::Terms;
use crate::{Phase, State, Structure};

/// One number for each output whose peak is searched.
pub(crate) type Searched<T> = [T; Measure::SEARCHED.len()];

impl AnyLevel {
    /// The strut in `phase`, given θ̈.
    fn strut<N>(&self, phase: Phase, theta_ddot: impl FnOnce() -> N) -> Strut<N> {
        if self.has_strut() {
            Strut::Elastic(self.structure().base().damping(phase))
        } else {
            Strut::Rigid(theta_ddot())
        }
    }

    /// The outputs in `phase`.
    #[inline]
    pub(crate) fn outputs(&self, phase: Phase, now: &Now) -> Outputs {
        let strut = self.strut(phase, || self.accelerations(phase, now).theta_ddot);
        Outputs::at(&Instant { strut, ..Instant::of(self.structure(), phase, now.state, now.load) })
    }

    /// Time derivatives of the outputs under `load`, given (ü, θ̈) and (u⃛, θ⃛).
    pub(crate) fn output_rates(
        &self,
        phase: Phase,
        state: &State,
        [accelerations, jerks]: [Second<f64>; 2],
        load: LinearLoad,
    ) -> Outputs {
        let strut = self.strut(phase, || Dual { value: accelerations.theta_ddot, rate: jerks.theta_ddot });
        let x = Instant { strut, ..Instant::moving(self.structure(), phase, state, &accelerations, load) };
        Outputs::at(&x).map(|output| output.rate)
    }

    /// The motion over `arc` under `load` as power series.
    pub(crate) fn terms(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Instant<'_, Terms> {
        let of = |series: &Series| Terms::of(series, arc.order);
        let ramp = |value: f64, slope: f64| Terms::ramp(value, slope * arc.span);
        let (theta, theta_dot, turn) = match phase {
            Phase::FullContact => (Terms::constant(0.0), Terms::constant(0.0), Turn::none()),
            Phase::Rocking(_) | Phase::Overturned(_) => {
                let theta = of(&arc.theta);
                (theta, of(&arc.theta_dot), theta.turn())
            }
        };
        let strut = self.strut(phase, || theta_dot.slope(arc.span));
        let LinearLoad { value, slope } = load;
        Instant {
            structure: self.structure(),
            s: phase.side().sign(),
            strut,
            u: of(&arc.u),
            u_dot: of(&arc.u_dot),
            theta,
            theta_dot,
            turn,
            a_g: ramp(value.a_g, slope.a_g),
            F_t: ramp(value.F_t, slope.F_t),
            a_v: ramp(value.a_v, slope.a_v),
        }
    }

    /// Bounds of the searched outputs between two instants with these `loads`, given bounds of the components of the state. The
    /// strut is taken as elastic: the rigid limit has no bound of a_t from these.
    #[inline]
    pub(crate) fn most(&self, phase: Phase, loads: [Load; 2], state: &State) -> Searched<f64> {
        let most = |of: fn(&Load) -> f64| Most(of(&loads[0]).abs().max(of(&loads[1]).abs()));
        let theta = Most(state.theta);
        let x = Instant {
            structure: self.structure(),
            s: phase.side().sign(),
            strut: Strut::Elastic(self.structure().base().damping(phase)),
            u: Most(state.u),
            u_dot: Most(state.u_dot),
            theta,
            theta_dot: Most(state.theta_dot),
            turn: theta.turn(),
            a_g: most(|load| load.a_g),
            F_t: most(|load| load.F_t),
            a_v: most(|load| load.a_v),
        };
        searched(&x).map(|Most(most)| most)
    }

    /// Bounds of the searched outputs, their rates and second derivatives over a leap under `load` that lasts `duration` (s).
    #[inline]
    pub(crate) fn bends(&self, phase: Phase, load: LinearLoad, duration: f64, bounds: &Bounds) -> Searched<Bend> {
        searched(&self.bending(phase, load, duration, bounds))
    }

    /// Bounds of R_h and R_v likewise, given the accelerations.
    #[inline]
    pub(crate) fn bends_of_forces(
        &self,
        phase: Phase,
        load: LinearLoad,
        duration: f64,
        bounds: &Bounds,
        second: &Second<Bend>,
    ) -> [Bend; 2] {
        let x = self.bending(phase, load, duration, bounds);
        let theta_dot = Bend { bend: second.theta_ddot.rate, ..x.theta_dot };
        forces(&Instant { theta_dot, ..x }, second)
    }

    /// Bounds of the motion over such a leap. The second derivative of θ̇ is not known.
    #[inline]
    fn bending(&self, phase: Phase, load: LinearLoad, duration: f64, bounds: &Bounds) -> Instant<'_, Bend> {
        let &Bounds { u, u_dot, u_ddot, u_dddot, theta, theta_dot, theta_ddot } = bounds;
        let last = load.at(duration);
        let bend = |value, rate, bend| Bend { value, rate, bend };
        let ramp = |from: f64, to: f64, slope: f64| bend(from.abs().max(to.abs()), slope.abs(), 0.0);
        let turning = bend(theta, theta_dot, theta_ddot);
        Instant {
            structure: self.structure(),
            s: phase.side().sign(),
            strut: Strut::Elastic(self.structure().base().damping(phase)),
            u: bend(u, u_dot, u_ddot),
            u_dot: bend(u_dot, u_ddot, u_dddot),
            theta: turning,
            theta_dot: bend(theta_dot, theta_ddot, if theta_ddot == 0.0 { 0.0 } else { f64::INFINITY }),
            turn: turning.turn(),
            a_g: ramp(load.value.a_g, last.a_g, load.slope.a_g),
            F_t: ramp(load.value.F_t, last.F_t, load.slope.F_t),
            a_v: ramp(load.value.a_v, last.a_v, load.slope.a_v),
        }
    }

    /// Rates of the searched outputs in `phase` and `state` under `load`, given (ü, θ̈), with an elastic strut.
    #[inline]
    pub(crate) fn searched_rates(
        &self,
        phase: Phase,
        state: &State,
        accelerations: &Second<f64>,
        load: LinearLoad,
    ) -> Searched<f64> {
        searched(&Instant::moving(self.structure(), phase, state, accelerations, load)).map(|output| output.rate)
    }

    /// Bounds of the searched outputs over `arc` under `load`.
    pub(crate) fn bounds(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Searched<Bound> {
        let range = |series: &Series| extremes::ranges(|k| [series[k]], arc.order, arc.reach)[0];
        let (theta, u) = (range(&arc.theta), range(&arc.u));
        let leaf = |of: &Range| Leaf { start: of.start, change: of.change(), rate: of.rate() };
        let turn = turning::<4>(leaf(&theta));
        let mut composed = if !self.has_strut() {
            let x = Instant {
                strut: Strut::Rigid(Linear::leaf(2, 1.0 / arc.span, Leaf::of_slope(arc.used(&arc.theta_dot)))),
                theta_dot: Linear::leaf(1, 1.0, Leaf::of(arc.used(&arc.theta_dot))),
                ..over(self.structure(), phase, load, arc, turn)
            };
            courses(&composed(&x), |k| [arc.theta[k], arc.theta_dot[k], arc.slope(&arc.theta_dot, k)], arc)
        } else {
            let x = Instant {
                u: Linear::leaf(1, 1.0, leaf(&u)),
                u_dot: Linear::leaf(2, 1.0, Leaf::of(arc.used(&arc.u_dot))),
                theta_dot: Linear::loose(Leaf::of(arc.used(&arc.theta_dot))),
                ..over(self.structure(), phase, load, arc, turn)
            };
            courses(&composed(&x), |k| [arc.theta[k], arc.u[k], arc.u_dot[k]], arc)
        }
        .into_iter();
        Measure::SEARCHED.map(|measure| match measure {
            Measure::theta => theta.and(0.0, 0.0),
            Measure::u => u.and(0.0, 0.0),
            Measure::theta_dot => range(&arc.theta_dot).and(0.0, 0.0),
            Measure::u_dot => range(&arc.u_dot).and(0.0, 0.0),
            _ => composed.next().unwrap_or_default(),
        })
    }
}

/// θ as the first leaf, with its turn.
#[inline(always)]
pub(crate) fn turning<const L: usize>(theta: Leaf) -> (Linear<L>, Turn<Linear<L>>) {
    (Linear::leaf(0, 1.0, theta), Linear::turn(0, theta, libm::sincos(theta.start)))
}

/// The instant over `arc` whose last leaf is time. The components u, u̇ and θ̇ are left at 0.
#[inline(always)]
pub(crate) fn over<'a, const L: usize>(
    structure: &'a Structure,
    phase: Phase,
    load: LinearLoad,
    arc: &Arc,
    (theta, turn): (Linear<L>, Turn<Linear<L>>),
) -> Instant<'a, Linear<L>> {
    let ramp = |value: f64, slope: f64| {
        let passes = Leaf { start: 0.0, change: arc.reach, rate: arc.reach };
        Linear::leaf(L - 1, slope * arc.span, passes) + Linear::constant(value)
    };
    let none = Linear::constant(0.0);
    let LinearLoad { value, slope } = load;
    Instant {
        structure,
        s: phase.side().sign(),
        strut: Strut::Elastic(structure.base().damping(phase)),
        u: none,
        u_dot: none,
        theta,
        theta_dot: none,
        turn,
        a_g: ramp(value.a_g, slope.a_g),
        F_t: ramp(value.F_t, slope.F_t),
        a_v: ramp(value.a_v, slope.a_v),
    }
}

/// Bounds of `quantities` over `arc`. Their leaves have the coefficients `leaves`, in order, and the last leaf is time.
#[inline(always)]
fn courses<const L: usize, const N: usize, const M: usize>(
    quantities: &[Linear<L>; N],
    leaves: impl Fn(usize) -> [f64; M],
    arc: &Arc,
) -> [Bound; N] {
    let ranges = linear_parts(quantities, leaves, arc);
    std::array::from_fn(|i| ranges[i].and(quantities[i].rest, quantities[i].rest_rate))
}

/// The courses of the linear parts of `quantities` over `arc`, as in [`courses`].
#[inline(always)]
pub(crate) fn linear_parts<const L: usize, const N: usize, const M: usize>(
    quantities: &[Linear<L>; N],
    leaves: impl Fn(usize) -> [f64; M],
    arc: &Arc,
) -> [Range; N] {
    let row = |k: usize| {
        let leaves = leaves(k);
        std::array::from_fn(|i| quantities[i].coefficient(k, &leaves))
    };
    extremes::ranges(row, arc.order, arc.reach)
}
