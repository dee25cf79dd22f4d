//! The motion of a level as the numbers in which the formulas are evaluated: values, rates, bounds and power series.
//!
//! The series tell the instant at which an output is largest; its value there comes from the state. At the rigid level a_t
//! follows from θ̈ (Eq 27).

use crate::levels::detail::{Detail, Model};
use crate::levels::level::{Now, Rates};
use crate::mechanics::instant::{Instant, Strut, damping};
use crate::mechanics::load::LinearLoad;
use crate::mechanics::outputs::{Measure, Outputs, searched};
use crate::numbers::bend::Bend;
use crate::numbers::dual::Dual;
use crate::numbers::linear::{Leaf, Linear};
use crate::numbers::most::Most;
use crate::numbers::{Number, Turn};
use crate::series::extremes::{self, Bound, Range};
use crate::series::taylor::{Arc, Series};
use crate::series::terms::Terms;
use crate::{Phase, State, Structure};

/// One number for each output whose peak is searched.
pub(crate) type Searched<T> = [T; Measure::SEARCHED.len()];

impl Model {
    pub(crate) fn is_rigid(&self) -> bool {
        self.detail == Detail::Rigid
    }

    /// The outputs in `phase`.
    #[inline]
    pub(crate) fn outputs(&self, phase: Phase, now: &Now) -> Outputs {
        let mut x = Instant::of(&self.structure, phase, now.state, now.load);
        if self.is_rigid() {
            let [_, theta_ddot] = self.level.accelerations(&self.structure, phase, now);
            x.strut = Strut::Rigid(theta_ddot);
        }
        Outputs::at(&x)
    }

    /// Time derivatives of the outputs under `load`, given (ü, θ̈) and (u⃛, θ⃛).
    pub(crate) fn output_rates(
        &self,
        phase: Phase,
        state: &State,
        [accelerations, jerks]: [[f64; 2]; 2],
        load: LinearLoad,
    ) -> Outputs {
        let mut x = Instant::moving(&self.structure, phase, state, accelerations, load);
        if self.is_rigid() {
            x.strut = Strut::Rigid(Dual { value: accelerations[1], rate: jerks[1] });
        }
        Outputs::at(&x).map(|output| output.rate)
    }

    /// The motion over `arc` under `load` as power series.
    pub(crate) fn terms(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Instant<'_, Terms> {
        terms(&self.structure, phase, load, arc, self.is_rigid())
    }

    /// Bounds of the searched outputs over a piece under `load` that lasts `duration` (s), given bounds of the components of
    /// the state. The elastic strut is assumed: the rigid limit has no bound of a_t from these.
    #[inline]
    pub(crate) fn most(&self, phase: Phase, load: LinearLoad, duration: f64, state: &State) -> Searched<f64> {
        let last = load.at(duration);
        let most = |from: f64, to: f64| Most(from.abs().max(to.abs()));
        let theta = Most(state.theta);
        let x = Instant {
            structure: &self.structure,
            s: phase.side().sign(),
            strut: Strut::Elastic(damping(&self.structure, phase)),
            u: Most(state.u),
            u_dot: Most(state.u_dot),
            theta,
            theta_dot: Most(state.theta_dot),
            turn: theta.turn(),
            a_g: most(load.value.a_g, last.a_g),
            F_t: most(load.value.F_t, last.F_t),
            a_v: most(load.value.a_v, last.a_v),
        };
        searched(&x).map(|Most(most)| most)
    }

    /// Bounds of the searched outputs, their rates and second derivatives over a leap under `load` that lasts `duration` (s).
    pub(crate) fn bends(&self, phase: Phase, load: LinearLoad, duration: f64, rates: &Rates) -> Searched<Bend> {
        let &Rates { u, u_dot, u_ddot, u_dddot, theta, theta_dot, theta_ddot } = rates;
        let last = load.at(duration);
        let bend = |value, rate, bend| Bend { value, rate, bend };
        let ramp = |from: f64, to: f64, slope: f64| bend(from.abs().max(to.abs()), slope.abs(), 0.0);
        let turning = bend(theta, theta_dot, theta_ddot);
        let x = Instant {
            structure: &self.structure,
            s: phase.side().sign(),
            strut: Strut::Elastic(damping(&self.structure, phase)),
            u: bend(u, u_dot, u_ddot),
            u_dot: bend(u_dot, u_ddot, u_dddot),
            theta: turning,
            theta_dot: bend(theta_dot, theta_ddot, if theta_ddot == 0.0 { 0.0 } else { f64::INFINITY }),
            turn: turning.turn(),
            a_g: ramp(load.value.a_g, last.a_g, load.slope.a_g),
            F_t: ramp(load.value.F_t, last.F_t, load.slope.F_t),
            a_v: ramp(load.value.a_v, last.a_v, load.slope.a_v),
        };
        searched(&x)
    }

    /// Rates of the searched outputs in `phase` and `state` under `load`, given (ü, θ̈), with an elastic strut.
    pub(crate) fn searched_rates(
        &self,
        phase: Phase,
        state: &State,
        accelerations: [f64; 2],
        load: LinearLoad,
    ) -> Searched<f64> {
        searched(&Instant::moving(&self.structure, phase, state, accelerations, load)).map(|output| output.rate)
    }

    /// Bounds of the searched outputs over `arc` under `load`.
    pub(crate) fn bounds(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Searched<Bound> {
        if self.is_rigid() { self.bounds_of_rigid(phase, load, arc) } else { self.bounds_of_elastic(phase, load, arc) }
    }

    /// Leaves: θ, u, u̇, time.
    fn bounds_of_elastic(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Searched<Bound> {
        let leaves = |k: usize| [arc.theta[k], arc.u[k], arc.u_dot[k]];
        let [theta, u, u_dot] = extremes::ranges(leaves, arc.order, arc.reach).map(leaf);
        let x = Instant {
            strut: Strut::Elastic(damping(&self.structure, phase)),
            u: Linear::leaf(1, 1.0, u),
            u_dot: Linear::leaf(2, 1.0, u_dot),
            theta_dot: loose(arc, &arc.theta_dot),
            ..over::<4>(&self.structure, phase, load, arc, theta)
        };
        let searched = searched(&x);
        let courses = courses(&searched, |k| [arc.theta[k], arc.u[k], arc.u_dot[k], time(k)], arc);
        std::array::from_fn(|i| courses[i].and(searched[i].rest, searched[i].rest_rate))
    }

    /// Leaves: θ, θ̇, θ̈, time.
    fn bounds_of_rigid(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> Searched<Bound> {
        let leaves = |k: usize| [arc.theta[k], arc.theta_dot[k], arc.slope(&arc.theta_dot, k)];
        let [theta, theta_dot, theta_ddot] = extremes::ranges(leaves, arc.order, arc.reach).map(leaf);
        let x = Instant {
            strut: Strut::Rigid(Linear::leaf(2, 1.0, theta_ddot)),
            theta_dot: Linear::leaf(1, 1.0, theta_dot),
            ..over::<4>(&self.structure, phase, load, arc, theta)
        };
        let searched = searched(&x);
        let with_time = |k: usize| {
            let [theta, theta_dot, theta_ddot] = leaves(k);
            [theta, theta_dot, theta_ddot, time(k)]
        };
        let courses = courses(&searched, with_time, arc);
        std::array::from_fn(|i| courses[i].and(searched[i].rest, searched[i].rest_rate))
    }
}

/// Coefficient `k` of time, the last leaf.
#[inline]
pub(crate) fn time(k: usize) -> f64 {
    if k == 1 { 1.0 } else { 0.0 }
}

#[inline]
pub(crate) fn leaf(range: Range) -> Leaf {
    Leaf { start: range.start, change: range.change(), rate: range.rate() }
}

/// A component of `arc` that is no leaf.
#[inline]
fn loose<const L: usize>(arc: &Arc, series: &Series) -> Linear<L> {
    let [range] = extremes::ranges(|k| [series[k]], arc.order, arc.reach);
    Linear::loose(leaf(range))
}

/// The instant over `arc` whose first leaf is θ and whose last leaf is time. The components u, u̇ and θ̇ are left at 0.
#[inline]
pub(crate) fn over<'a, const L: usize>(
    structure: &'a Structure,
    phase: Phase,
    load: LinearLoad,
    arc: &Arc,
    theta: Leaf,
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
        strut: Strut::Elastic(0.0),
        u: none,
        u_dot: none,
        theta: Linear::leaf(0, 1.0, theta),
        theta_dot: none,
        turn: Linear::turn(0, theta, libm::sincos(theta.start)),
        a_g: ramp(value.a_g, slope.a_g),
        F_t: ramp(value.F_t, slope.F_t),
        a_v: ramp(value.a_v, slope.a_v),
    }
}

/// The courses of the linear parts of `quantities` over `arc`, whose leaves have the coefficients `leaves`.
#[inline]
pub(crate) fn courses<const L: usize, const N: usize>(
    quantities: &[Linear<L>; N],
    leaves: impl Fn(usize) -> [f64; L],
    arc: &Arc,
) -> [Range; N] {
    let row = |k: usize| {
        if k == 0 {
            return std::array::from_fn(|i| quantities[i].start);
        }
        let leaves = leaves(k);
        std::array::from_fn(|i| (0..L).map(|leaf| quantities[i].slopes[leaf] * leaves[leaf]).sum())
    };
    extremes::ranges(row, arc.order, arc.reach)
}

/// The motion over `arc` under `load` as power series.
fn terms<'a>(
    structure: &'a Structure,
    phase: Phase,
    load: LinearLoad,
    arc: &Arc,
    is_rigid: bool,
) -> Instant<'a, Terms> {
    let of = |series: &Series| Terms::of(series, arc.order);
    let ramp = |value: f64, slope: f64| Terms::ramp(value, slope * arc.span);
    let (theta, theta_dot, turn) = match phase {
        Phase::FullContact => (Terms::constant(0.0), Terms::constant(0.0), Turn::none()),
        Phase::Rocking(_) | Phase::Overturned(_) => {
            let theta = of(&arc.theta);
            (theta, of(&arc.theta_dot), theta.turn())
        }
    };
    let strut = match is_rigid {
        true => Strut::Rigid(theta_dot.slope(arc.span)),
        false => Strut::Elastic(damping(structure, phase)),
    };
    let LinearLoad { value, slope } = load;
    Instant {
        structure,
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
