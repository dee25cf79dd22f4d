//! The outputs of the structure at an instant: accelerations, forces, displacements (Eqs 2, 3, 23–27).
//!
//! ```text
//! a_t = ü + H θ̈ + θ̇² (sB − u) + a_g cos θ          (full contact: ü + a_g)                       (27)
//! ```
//!
//! By (5) this is g sin θ − (c_u u̇ + k u)/m + (F_t/m) cos θ, and by (1) −(c_fc u̇ + k u)/m + F_t/m in full contact. The outputs
//! therefore depend on the state and on F_t only. The levels with linear equations use Eq 5, too, instead of their own ü and θ̈.
//! The rigid limit is the exception: its u is 0 whatever the forces, so that it uses (27) with the ground acceleration.
//!
//! To add an output, write its formula in [`formulas`] and its row in the table below. The row gives it a field, a column, a
//! rate and, if its peak is searched, an exact peak.

use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::Lateral;
use crate::mechanics::load::Load;
use crate::numbers::Number;
use crate::{Phase, State, Structure};
use serde::{Deserialize, Serialize};

/// The way to the peak of an output.
#[derive(Clone, Copy, Debug)]
pub enum PeakRule {
    /// The output has no peak that is shown.
    None,
    /// The peak is searched between the ends of pieces, too. It is shown at this place among all peaks.
    Searched(usize),
    /// The peak comes with the peak of another output, whose magnitude gives it. It is shown at this place among all peaks.
    With(usize, Measure, fn(&Sizes, f64) -> f64),
}

/// Top mass m (kg), its height H (m) and half the width of the base B (m): enough for a peak that comes with another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)] // the paper's letters
pub struct Sizes {
    pub m: f64,
    pub H: f64,
    pub B: f64,
}

/// A row of the table of outputs.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Symbol.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Symbol and unit as the heading of a column.
    pub heading: &'static str,
    /// The output itself.
    pub measure: Measure,
    /// The way to its peak.
    pub peak: PeakRule,
}

/// Makes the table: [`Outputs`], [`Measure`] and [`OUTPUTS`] from its rows.
macro_rules! outputs {
    ($($(#[doc = $doc:literal])+ $name:ident [$unit:literal] $peak:expr;)+) => {
        /// The outputs at one instant; from [`Engine::rates`](crate::Engine::rates), their time derivatives in the same fields.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Outputs<N = f64> {
            $($(#[doc = $doc])+ pub $name: N,)+
        }

        /// The name of an output.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(non_camel_case_types)] // the names of the fields
        pub enum Measure {
            $($(#[doc = $doc])+ $name,)+
        }

        /// All outputs, in the order of their columns.
        pub const OUTPUTS: [Output; [$(Measure::$name),+].len()] = [$(Output {
            name: stringify!($name),
            unit: $unit,
            heading: concat!(stringify!($name), "[", $unit, "]"),
            measure: Measure::$name,
            peak: $peak,
        }),+];

        impl<N> Outputs<N> {
            /// The outputs with `f` applied to each.
            pub fn map<M>(self, f: impl Fn(N) -> M) -> Outputs<M> {
                Outputs { $($name: f(self.$name)),+ }
            }

            /// The outputs in the order of [`OUTPUTS`].
            pub fn values(self) -> [N; OUTPUTS.len()] {
                [$(self.$name),+]
            }
        }

        impl<N: Number> Outputs<N> {
            /// The outputs at the instant `x`.
            #[inline]
            pub(crate) fn at(x: &Instant<N>) -> Outputs<N> {
                Outputs { $($name: formulas::$name(x)),+ }
            }
        }

        impl Measure {
            /// The output at the instant `x`.
            #[inline]
            pub(crate) fn at<N: Number>(self, x: &Instant<N>) -> N {
                match self {
                    $(Measure::$name => formulas::$name(x),)+
                }
            }

            /// This output among `outputs`.
            #[inline]
            pub fn of(self, outputs: &Outputs) -> f64 {
                match self {
                    $(Measure::$name => outputs.$name,)+
                }
            }
        }

        /// The outputs at the instant `x` whose peaks are searched, in the order of [`Measure::SEARCHED`].
        #[inline(always)]
        pub(crate) fn searched<N: Number>(x: &Instant<N>) -> [N; Measure::SEARCHED.len()] {
            let (mut found, mut count) = ([N::constant(0.0); Measure::SEARCHED.len()], 0);
            $(if const { Measure::$name.is_searched() } {
                found[count] = formulas::$name(x);
                count += 1;
            })+
            debug_assert_eq!(count, found.len());
            found
        }

        /// The searched outputs without the components of the motion, in the same order.
        #[inline(always)]
        pub(crate) fn composed<N: Number>(x: &Instant<N>) -> [N; Measure::COMPOSED] {
            let (mut found, mut count) = ([N::constant(0.0); Measure::COMPOSED], 0);
            $(if const { Measure::$name.is_searched() && !Measure::$name.is_component() } {
                found[count] = formulas::$name(x);
                count += 1;
            })+
            debug_assert_eq!(count, found.len());
            found
        }
    };
}

outputs! {
    /// Rotation of the base θ, rad.
    theta["rad"] PeakRule::Searched(0);
    /// Elastic displacement u, m.
    u["m"] PeakRule::Searched(1);
    /// Acceleration of the top mass in the direction of u, a_t, m/s² (Eq 27).
    a_t["m/s2"] PeakRule::Searched(4);
    /// Base shear V_t = m a_t, N (Eqs 2, 23).
    V_t["N"] PeakRule::With(5, Measure::a_t, |&Sizes { m, .. }, a_t| base_shear(m, a_t));
    /// Overturning moment M_t = m H a_t, N·m (Eqs 3, 24).
    M_t["N.m"] PeakRule::With(6, Measure::a_t, |&Sizes { m, H, .. }, a_t| overturning_moment(m, H, a_t));
    /// Angular velocity θ̇, rad/s.
    theta_dot["rad/s"] PeakRule::None;
    /// Elastic velocity u̇, m/s.
    u_dot["m/s"] PeakRule::None;
    /// Uplift of the free edge of the base δ_u = 2 B sin|θ|, m (Eq 25).
    uplift["m"] PeakRule::With(3, Measure::theta, |&Sizes { B, .. }, theta| 2.0 * B * libm::sin(theta));
    /// Lateral displacement of the top mass δ_t = sB (1 − cos θ) + u cos θ + H sin θ, m (Eq 26).
    delta_t["m"] PeakRule::Searched(2);
    /// Lateral velocity of the top mass relative to the ground, the rate of δ_t: u̇ cos θ + [(sB − u) sin θ + H cos θ] θ̇, m/s.
    v_t["m/s"] PeakRule::None;
}

/// The formula of each output, by its name.
mod formulas {
    use crate::Floor;
    use crate::mechanics::instant::{self, Instant, Place, Strut};
    use crate::numbers::Number;

    #[inline(always)]
    pub fn theta<N: Number>(x: &Instant<N>) -> N {
        x.theta
    }

    #[inline(always)]
    pub fn theta_dot<N: Number>(x: &Instant<N>) -> N {
        x.theta_dot
    }

    #[inline(always)]
    pub fn u<N: Number>(x: &Instant<N>) -> N {
        x.u
    }

    #[inline(always)]
    pub fn u_dot<N: Number>(x: &Instant<N>) -> N {
        x.u_dot
    }

    /// Eq 27 by (5), and at the rigid level as it stands; of a_v it has −a_v sin θ, which (5) cancels.
    #[inline(always)]
    pub fn a_t<N: Number>(x: &Instant<N>) -> N {
        match x.strut {
            Strut::Elastic(damping) => super::acceleration(x, damping, |_, part| part),
            Strut::Rigid(theta_ddot) => {
                theta_ddot * x.structure.floors()[0].height + x.theta_dot * x.theta_dot * x.pivot() + x.a_g * x.turn.cos
                    - x.a_v * x.turn.sin
            }
        }
    }

    #[inline(always)]
    pub fn V_t<N: Number>(x: &Instant<N>) -> N {
        super::base_shear(x.structure.floors()[0].mass, a_t(x))
    }

    #[inline(always)]
    pub fn M_t<N: Number>(x: &Instant<N>) -> N {
        let &Floor { mass, height, .. } = &x.structure.floors()[0];
        super::overturning_moment(mass, height, a_t(x))
    }

    #[inline(always)]
    pub fn uplift<N: Number>(x: &Instant<N>) -> N {
        instant::uplift(x.pivot(), &x.turn)
    }

    #[inline(always)]
    pub fn delta_t<N: Number>(x: &Instant<N>) -> N {
        top(x).right(x.pivot(), &x.turn)
    }

    #[inline(always)]
    pub fn v_t<N: Number>(x: &Instant<N>) -> N {
        top(x).rate_of_right(x.pivot(), &x.turn, [x.u_dot, x.theta_dot])
    }

    /// The place of the top mass.
    #[inline(always)]
    fn top<N: Number>(x: &Instant<N>) -> Place<N> {
        Place { share: 1.0, height: x.structure.floors()[0].height, u: x.u }
    }
}

/// Base shear m a_t (Eqs 2, 23), N, of the acceleration `a_t` (m/s²) of the mass `m` (kg).
#[inline(always)]
pub(crate) fn base_shear<N: Number>(m: f64, a_t: N) -> N {
    a_t * m
}

/// Overturning moment m H a_t (Eqs 3, 24), N·m, of the acceleration `a_t` (m/s²) of the mass `m` (kg) at the height `H` (m).
#[inline(always)]
pub(crate) fn overturning_moment<N: Number>(m: f64, H: f64, a_t: N) -> N {
    a_t * (m * H)
}

/// Acceleration of a mass by (5), g sin θ + Σ φ (F cos θ − c u̇ − k u)/μ, m/s². The function `at` weighs the part of a mode by its
/// shape φ at the mass.
#[inline(always)]
pub(crate) fn acceleration<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>, damping: f64, at: impl Fn(usize, N) -> N) -> N {
    let of_modes = x.sum(|j, mode| {
        let force = x.F_t.of(j) * x.turn.cos - x.u_dot.of(j) * (mode.damping * damping) - x.u.of(j) * mode.stiffness;
        at(j, force / mode.mass)
    });
    x.turn.sin * x.base().g + of_modes
}

impl Outputs {
    /// The outputs of `structure` in `phase` and `state` with the force `F_t` (N) on the top mass.
    pub fn of(structure: &Structure, phase: Phase, state: &State, F_t: f64) -> Outputs {
        Outputs::at(&Instant::of(structure, phase, state, Load { F_t, ..Load::default() }))
    }
}

impl Measure {
    /// The number of outputs before `end` whose peaks are searched, with the components of the motion or without.
    const fn count(end: usize, with_components: bool) -> usize {
        let (mut count, mut i) = (0, 0);
        while i < end {
            let measure = OUTPUTS[i].measure;
            count += (measure.is_searched() && (with_components || !measure.is_component())) as usize;
            i += 1;
        }
        count
    }

    /// The outputs whose peaks are searched.
    pub const SEARCHED: [Measure; Measure::count(OUTPUTS.len(), true)] = {
        let mut searched = [Measure::theta; Measure::count(OUTPUTS.len(), true)];
        let mut i = 0;
        while i < OUTPUTS.len() {
            let measure = OUTPUTS[i].measure;
            if measure.is_searched() {
                searched[measure.place()] = measure;
            }
            i += 1;
        }
        searched
    };

    /// The number of outputs in [`composed`].
    pub(crate) const COMPOSED: usize = Measure::count(OUTPUTS.len(), false);

    /// The place of this output in [`Measure::SEARCHED`].
    #[inline]
    pub(crate) const fn place(self) -> usize {
        const PLACES: [usize; OUTPUTS.len()] = {
            let mut places = [0; OUTPUTS.len()];
            let mut i = 0;
            while i < OUTPUTS.len() {
                places[i] = Measure::count(i, true);
                i += 1;
            }
            places
        };
        PLACES[self as usize]
    }

    const fn is_searched(self) -> bool {
        matches!(OUTPUTS[self as usize].peak, PeakRule::Searched(_))
    }

    /// Whether the output is a component of the motion, whose polynomial is known without a formula.
    const fn is_component(self) -> bool {
        matches!(self, Measure::theta | Measure::theta_dot | Measure::u | Measure::u_dot)
    }

    /// The row of this output.
    pub fn row(self) -> &'static Output {
        const { &OUTPUTS }.get(self as usize).expect("each output has a row")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OneMass;
    use crate::levels::detail::Detail;
    use crate::levels::full_contact;
    use crate::levels::nonlinear;
    use crate::mechanics::load::LinearLoad;
    use crate::mechanics::restraint::Dissipators;
    use crate::{Engine, Parameters, Reactions, Side};
    use approx::assert_relative_eq;

    /// Eq 27 with ü and θ̈ from Eqs 5 and 6, or from Eq 1 in full contact, agrees with a_t from the state.
    #[test]
    fn the_acceleration_is_that_of_equation_27() {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let &Parameters { H, B, .. } = structure.parameters();
        let state = State { u: 3e-3, u_dot: -0.2, theta: -0.08, theta_dot: 0.6 };
        let load = Load { a_g: 7.0, F_t: 300.0, a_v: -3.0 };
        let accelerations = nonlinear::accelerations(&structure, Side::Left, &state, load, &Dissipators::NEW).unwrap();
        let expected = accelerations[0]
            + H * accelerations[1]
            + state.theta_dot.powi(2) * (-B - state.u)
            + load.a_g * libm::cos(state.theta)
            - load.a_v * libm::sin(state.theta);
        let outputs = Outputs::of(&structure.into(), Phase::Rocking(Side::Left), &state, load.F_t);
        assert_relative_eq!(outputs.a_t, expected, max_relative = 1e-12);

        let down = State { theta: 0.0, theta_dot: 0.0, ..state };
        let outputs = Outputs::of(&structure.into(), Phase::FullContact, &down, load.F_t);
        assert_relative_eq!(
            outputs.a_t,
            full_contact::acceleration(&structure, &down, load) + load.a_g,
            max_relative = 1e-12
        );
    }

    /// The rates are the slopes of the outputs along the motion, at every level.
    #[test]
    fn the_rates_are_the_slopes_of_the_outputs() {
        let structure = OneMass::new(Parameters::EVISON).unwrap();
        let down = State { u: 2e-4, u_dot: 0.01, ..State::default() };
        let rocking = State { u: 1e-3, u_dot: -0.1, theta: 0.05, theta_dot: 0.4 };
        let rigid = State { u: 0.0, u_dot: 0.0, ..rocking };
        let scenes = [
            (Detail::Auto, down),
            (Detail::Auto, rocking),
            (Detail::Linear, rocking),
            (Detail::Modal, rocking),
            (Detail::Rigid, State::default()),
            (Detail::Rigid, rigid),
            (Detail::FixedBase, down),
        ];
        for (detail, initial) in scenes {
            let start = LinearLoad {
                value: Load { a_g: 1.2, F_t: 90.0, a_v: 0.0 },
                slope: Load { a_g: 40.0, F_t: -700.0, a_v: 0.0 },
            };
            let h = 1e-5;
            let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-11, detail).unwrap();
            let mut show = |until: f64| {
                let here = |time: f64| LinearLoad { value: start.at(time), ..start };
                let now = engine.motion().time;
                engine.advance(until - now, here(now), &mut ()).unwrap();
                let load = here(until);
                ((engine.outputs(load.value), engine.reactions(load.value)), engine.rates(load))
            };
            let (before, _) = show(1e-3 - h);
            let (_, rates) = show(1e-3);
            let (after, _) = show(1e-3 + h);
            let slope = |get: fn(&Outputs) -> f64| (get(&after.0) - get(&before.0)) / (2.0 * h);
            for get in [
                |o: &Outputs| o.theta,
                |o: &Outputs| o.u,
                |o: &Outputs| o.a_t,
                |o: &Outputs| o.V_t,
                |o: &Outputs| o.M_t,
                |o: &Outputs| o.theta_dot,
                |o: &Outputs| o.u_dot,
                |o: &Outputs| o.uplift,
                |o: &Outputs| o.delta_t,
                |o: &Outputs| o.v_t,
            ] {
                assert_relative_eq!(get(&rates.0), slope(get), max_relative = 1e-4, epsilon = 1e-9);
            }
            for get in [|r: &Reactions| r.R_h, |r: &Reactions| r.R_v, |r: &Reactions| r.R_m] {
                let slope = (get(&after.1) - get(&before.1)) / (2.0 * h);
                assert_relative_eq!(get(&rates.1), slope, max_relative = 1e-4, epsilon = 1e-5);
            }
        }
    }
}
