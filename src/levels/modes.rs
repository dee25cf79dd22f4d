//! Structures of many masses: exact modes in full contact, nonlinear rocking on a base that carries the modes.
//!
//! Each mode has μ, h and Γ, and takes the part S = Γ/μ in a translation. With w = sB S − u and e = (c u̇ + k u)/μ, (M8) and (M9) are
//!
//! ```text
//! ü + h θ̈ = −e − w θ̇² + S g sin θ − a cos θ                    a = S a_g − φᵀF/μ of each mode
//! d/dt [D θ̇] = Σ μ h (e + w θ̇²) − X (g cos θ + a_g sin θ) + Σ φᵀF w sin θ − ties
//! D = J0 + m0 B² + Σ μ w²,      X = s m0 B + Σ Γ w
//! ```
//!
//! The angular momentum D θ̇ has no Coriolis term. An order takes five products and one more for each mode. g is g + a_v.

use crate::levels::level::{Level, Now, Rates, Subject, way};
use crate::levels::oscillator::{Flow, Kept, Oscillator, Swing};
use crate::levels::ties::TieSeries;
use crate::mechanics::instant::Second;
use crate::mechanics::lateral::{Coordinates, Lateral, MOST_MODES, Modes};
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{self, Angles, Dissipators};
use crate::mechanics::uplift::LEAST_EXCESS;
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::{Arc, LONGEST_SPAN, MAX_ORDER, Series, Start, Truncation, ZERO, product};
use crate::structure::frame::Frame;
use crate::structure::{Base, Mode};
use crate::{Phase, Side, State};
use std::cell::RefCell;

/// Part of its inertia at u = 0 that a structure must keep about its pivot.
const LEAST_INERTIA: f64 = 1e-6;

/// Part of the acceleration of gravity by which a motion is as good as none.
const NEGLIGIBLE: f64 = 1e-30;

/// Nonlinear motion of a structure of many masses.
#[derive(Clone, Debug)]
pub(crate) struct Nonlinear {
    subject: Subject<Modes>,
    /// The oscillators of full contact, if their exact flow is used.
    contact: Option<Vec<(Oscillator, Kept<Flow>)>>,
    /// The mass of all modes, kg.
    mass: f64,
    /// Radius of their inertia about the base, m.
    height: f64,
    /// J_P over the inertia about a pivot that the modes leave: how much faster the structure vibrates while rocking, squared.
    quickening: f64,
    /// The longest span of a series while rocking, s.
    longest_span: f64,
    scratch: RefCell<Box<Scratch>>,
}

/// Room for the series of one step.
#[derive(Clone, Debug)]
struct Scratch {
    /// w of each mode.
    lever: Series<Modes>,
    /// μ w of each mode.
    moment: Series<Modes>,
    /// D.
    inertia: Series,
    /// X.
    offset: Series,
    sin: Series,
    cos: Series,
    /// g cos θ + a_g sin θ.
    weight: Series,
    /// θ̇².
    square: Series,
    /// Σ φᵀF w.
    push: Series,
}

/// Inertia D (kg·m²) about the pivot of `side`.
fn inertia(frame: &Frame, side: Side, u: &Modes) -> f64 {
    let &Base { m0, J0, B, .. } = Modes::base(frame);
    let lever = |j: usize, mode: &Mode| side.sign() * B * mode.share - u.of(j);
    J0 + m0 * B * B + Modes::sum(frame, |j, mode| mode.mass * lever(j, mode) * lever(j, mode))
}

/// The moment that holds the base down about `side` under the vertical acceleration `a_v`, N·m: the right side of (M3).
fn hold(base: &Base, side: Side, a_v: f64, dissipators: &Dissipators) -> f64 {
    let [tendon, pair @ ..] = restraint::ties(base, side, dissipators);
    let residual: f64 = pair.iter().map(|tie| tie.lever * tie.force).sum();
    base.m_t * (base.g + a_v) * base.B + tendon.force * base.B + side.sign() * residual
}

/// The moments that lift the base, to the right, N·m: of the springs (M3), and of all that gives D θ̈ at θ = θ̇ = 0 (M2).
fn lifting(frame: &Frame, u: &Modes, u_dot: &Modes, weight: f64) -> [f64; 2] {
    let &Base { c_ratio, .. } = Modes::base(frame);
    let springs = Modes::sum(frame, |j, mode| mode.height * mode.stiffness * u.of(j));
    let others = Modes::sum(frame, |j, mode| {
        mode.height * (c_ratio * mode.damping) * u_dot.of(j) + mode.gamma * weight * u.of(j)
    });
    [springs, springs + others]
}

impl Nonlinear {
    /// The level of the structure of `subject`, in full contact by exact flow or by series.
    pub(crate) fn new(subject: Subject<Modes>, is_exact: bool) -> Nonlinear {
        let frame = &subject.structure;
        let base = Modes::base(frame);
        let mass = Modes::sum(frame, |_, mode| mode.gamma * mode.share);
        let of_modes = Modes::sum(frame, |_, mode| mode.mass * mode.height * mode.height);
        let oscillator = |mode: &Mode| {
            let omega = (mode.stiffness / mode.mass).sqrt();
            (Oscillator { omega, zeta: mode.damping / (2.0 * mode.mass * omega) }, Kept::new(Flow::NONE))
        };
        let left = base.J_P - of_modes;
        let ties = restraint::sum(&restraint::ties(base, Side::Right, &Dissipators::NEW), |tie| tie.lever);
        let [_, highest] = Modes::vibration(frame).rocking;
        let fastest = (highest * highest + ties.stiffness / left).sqrt().max(base.p_l).max(ties.damping / left);
        Nonlinear {
            contact: is_exact.then(|| frame.modes().iter().map(oscillator).collect()),
            mass,
            height: (of_modes / mass).sqrt(),
            quickening: base.J_P / left,
            longest_span: LONGEST_SPAN / fastest,
            scratch: RefCell::new(Box::new(Scratch {
                lever: [Modes::ZERO; MAX_ORDER + 2],
                moment: [Modes::ZERO; MAX_ORDER + 2],
                inertia: ZERO,
                offset: ZERO,
                sin: ZERO,
                cos: ZERO,
                weight: ZERO,
                square: ZERO,
                push: ZERO,
            })),
            subject,
        }
    }

    /// The root of the mean square of a velocity or an acceleration over the masses, by `of` each mode.
    fn size(&self, of: impl Fn(usize, &Mode) -> f64) -> f64 {
        let square = Modes::sum(&self.subject.structure, |j, mode| mode.mass * of(j, mode) * of(j, mode));
        (square / self.mass).sqrt()
    }

    /// The truncation that `start` requires over a step of `span` s, while rocking or not.
    fn truncation(&self, start: &Start<Modes>, span: f64, is_rocking: bool) -> Truncation<Modes> {
        let &Start { state, a_top, local_error, .. } = start;
        let frame = &self.subject.structure;
        let &Base { g, tan_alpha_cg, .. } = Modes::base(frame);
        let vibration = Modes::vibration(frame);
        let elastic = self.size(|j, mode| mode.stiffness / mode.mass * state.u.of(j));
        let load = self.size(|j, _| a_top.value.of(j)) + span * self.size(|j, _| a_top.slope.of(j));
        let (time, elastic, load) = match is_rocking {
            true => (1.0 / vibration.rocking[0], self.quickening * elastic, load + g * tan_alpha_cg),
            false => (1.0 / vibration.contact, elastic, load.max(NEGLIGIBLE * g)),
        };
        let velocity = self.size(|j, _| state.u_dot.of(j)) + span.min(time) * (elastic + load);
        let theta_dot = state.theta_dot.abs() + velocity / self.height;
        Truncation {
            u_dot: Modes::each(frame, |_, mode| local_error * velocity * (self.mass / mode.mass).sqrt()),
            theta_dot: if is_rocking { local_error * theta_dot } else { 0.0 },
        }
    }

    /// Writes the motion in full contact into `arc` (M1).
    fn resting(&self, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let &Start { state, a_top, interval, .. } = start;
        let frame = &self.subject.structure;
        let span = interval.min(LONGEST_SPAN / Modes::vibration(frame).rocking[1]);
        arc.expand(&state, span, self.truncation(start, span, false), |arc, k, per| {
            let (u, u_dot, load) = (&arc.u[k - 1], &arc.u_dot[k - 1], a_top.coefficient(k - 1, span));
            let rate = Modes::each(frame, |j, mode| {
                -load.of(j) - (mode.damping * u_dot.of(j) + mode.stiffness * u.of(j)) / mode.mass
            });
            (rate.times(per), 0.0)
        });
    }

    /// Writes the motion while rocking about `side` into `arc` (M8, M9).
    fn rocking(&self, side: Side, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let &Start { state, a_g, a_top, a_v, .. } = start;
        let frame = &self.subject.structure;
        let &Base { m0, J0, B, g, c_ratio, .. } = Modes::base(frame);
        let span = start.interval.min(self.longest_span);
        let mut ties = self.subject.is_tied.then(|| {
            let ties = restraint::sum(&restraint::ties(Modes::base(frame), side, start.dissipators), |tie| tie.lever);
            TieSeries::new(ties, Angles::Any, state.theta)
        });
        let pivot = side.sign() * B;
        let (g, lift) = (g + a_v.value, a_v.slope * span);
        let (ground, ground_slope) = (a_g.value, a_g.slope * span);
        // forces of the modes, over their masses
        let force = |a: &Modes, a_g: f64| Modes::each(frame, |j, mode| mode.share * a_g - a.of(j));
        let (pushed, push_slope) = (force(&a_top.value, a_g.value), force(&a_top.slope, a_g.slope).times(span));
        let is_pushed = !(pushed.is_within(&Modes::ZERO) && push_slope.is_within(&Modes::ZERO));
        let Scratch { lever, moment: heavy, inertia, offset, sin, cos, weight, square, push } =
            &mut **self.scratch.borrow_mut();
        lever[0] = Modes::each(frame, |j, mode| pivot * mode.share - state.u.of(j));
        (sin[0], cos[0]) = libm::sincos(state.theta);
        inertia[0] = J0 + m0 * B * B + Modes::sum(frame, |j, mode| mode.mass * lever[0].of(j) * lever[0].of(j));
        offset[0] = pivot * m0 + Modes::sum(frame, |j, mode| mode.gamma * lever[0].of(j));
        let (modes, mut elastic) = (frame.modes().len(), [[0.0; 2]; MOST_MODES]);
        elastic.iter_mut().zip(frame.modes()).for_each(|(elastic, mode)| {
            *elastic = [mode.stiffness / mode.mass, c_ratio * mode.damping / mode.mass];
        });
        heavy[0] = Modes::each(frame, |j, mode| mode.mass * lever[0].of(j));
        let shares = Modes::each(frame, |_, mode| mode.share);
        let arms = Modes::each(frame, |_, mode| mode.mass * mode.height);
        let per_inertia = 1.0 / inertia[0];
        arc.expand(&state, span, self.truncation(start, span, true), |arc, k, per| {
            let n = k - 1;
            let before = |series: &Series| if n > 0 { series[n - 1] } else { 0.0 };
            let (sin_before, cos_before) = (before(sin), before(cos));
            // g sin θ, a_g cos θ and g cos θ + a_g sin θ of order n
            let fall = g * sin[n] + lift * sin_before - (ground * cos[n] + ground_slope * cos_before);
            weight[n] = g * cos[n] + lift * cos_before + ground * sin[n] + ground_slope * sin_before;
            square[n] = product(&arc.theta_dot, &arc.theta_dot, n);
            let mut turning = Modes::ZERO; // w θ̇²
            for i in 0..=n {
                turning.add(&lever[i], square[n - i]);
            }
            let (u, u_dot) = (&arc.u[n], &arc.u_dot[n]);
            // e + w θ̇²
            let mut held = turning;
            for (j, [stiffness, damping]) in elastic.iter().enumerate().take(modes) {
                held.set(j, held.of(j) + (stiffness * u.of(j) + damping * u_dot.of(j)));
            }
            let mut moment = arms.dot(&held) - product(offset, weight, n);
            if is_pushed {
                let lever_before = if n > 0 { lever[n - 1] } else { Modes::ZERO };
                push[n] = Modes::sum(frame, |j, mode| {
                    mode.mass * (pushed.of(j) * lever[n].of(j) + push_slope.of(j) * lever_before.of(j))
                });
                moment += product(push, sin, n);
            }
            if let Some(ties) = &mut ties {
                moment -= ties.next(&arc.theta_dot, n, per);
            }
            // what the orders before leave of D θ̇
            lever[k] = arc.u[k].times(-1.0);
            heavy[k] = Modes::each(frame, |j, mode| mode.mass * lever[k].of(j));
            let (mut of_inertia, half) = (0.0, k.div_ceil(2));
            for i in 0..half {
                of_inertia += 2.0 * lever[i].dot(&heavy[k - i]);
            }
            if k % 2 == 0 {
                of_inertia += lever[half].dot(&heavy[half]);
            }
            inertia[k] = of_inertia;
            offset[k] = shares.dot(&heavy[k]);
            let known: f64 = (1..=k).map(|i| inertia[i] * arc.theta_dot[k - i]).sum();
            let theta_dot = per_inertia * (moment * per - known);
            let u_dot = Modes::each(frame, |j, mode| {
                let mut along = mode.share * fall - held.of(j);
                if is_pushed {
                    along += pushed.of(j) * cos[n] + push_slope.of(j) * cos_before;
                }
                along * per - mode.height * theta_dot
            });
            let [sin_next, cos_next] = [product(cos, &arc.theta_dot, n) * per, -product(sin, &arc.theta_dot, n) * per];
            (sin[k], cos[k]) = (sin_next, cos_next);
            (u_dot, theta_dot)
        });
    }

    /// The first instant of `arc`, a motion in full contact, at which both conditions of uplift about `side` hold.
    fn first_about(&self, side: Side, start: &Start<Modes>, arc: &Arc<Modes>) -> Crossing {
        let frame = &self.subject.structure;
        let base = Modes::base(frame);
        let s = side.sign();
        let [a_v, a_v_change] = [0, 1].map(|k| start.a_v.coefficient(k, arc.span));
        let held = hold(base, side, a_v, start.dissipators);
        let change = hold(base, side, a_v + a_v_change, start.dissipators) - held;
        let is_held = held.min(held + change) > 0.0;
        let [mut springs, mut all] = [ZERO; 2];
        for k in 0..=arc.order {
            [springs[k], all[k]] = lifting(frame, &arc.u[k], &arc.u_dot[k], base.g + a_v);
            if k > 0 {
                all[k] += a_v_change * Modes::sum(frame, |j, mode| mode.gamma * arc.u[k - 1].of(j));
            }
        }
        springs[1] -= s * change;
        all[1] -= s * change;
        let rule = Gap::new(arc.used(&springs), -s, held);
        if is_held && rule.is_open_throughout(arc.reach) {
            return Crossing::None;
        }
        let excess = LEAST_EXCESS * (base.m_t * base.g + base.ties.P_0) * base.B;
        let turns = Gap::new(arc.used(&all), -s, held + excess);
        let far = first_time_all_closed([rule, turns], arc.reach);
        if is_held {
            return far;
        }
        // nothing holds the base while the right side of (M3) is not above 0
        let limit = [held, change];
        let loose = first_time_all_closed([Gap::new(&limit, 1.0, 0.0), turns], arc.reach);
        if far.sigma() <= loose.sigma() { far } else { loose }
    }

    /// The moment that the base's hold has at least over the interval of `start`, N·m.
    fn least_hold(&self, start: &Start<Modes>) -> f64 {
        let base = Modes::base(&self.subject.structure);
        let least = start.a_v.value.min(start.a_v.at(start.interval));
        [Side::Right, Side::Left]
            .map(|side| hold(base, side, least, start.dissipators))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }
}

impl Level<Modes> for Nonlinear {
    #[inline(always)]
    fn subject(&self) -> &Subject<Modes> {
        &self.subject
    }

    /// The exact flow of every mode, if the moment of the springs certainly stays below what holds the base.
    fn leap(&self, phase: Phase, start: &Start<Modes>) -> Option<State<Modes>> {
        let (Phase::FullContact, Some(contact)) = (phase, &self.contact) else { return None };
        let &Start { state, a_top, interval, .. } = start;
        let frame = &self.subject.structure;
        let (mut end, mut farthest, mut bend) = (State { theta: 0.0, theta_dot: 0.0, ..state }, 0.0, 0.0);
        let mut springs = [0.0; 2];
        for (j, (mode, (oscillator, flows))) in frame.modes().iter().zip(contact).enumerate() {
            let (from, value, slope) = ([state.u.of(j), state.u_dot.of(j)], a_top.value.of(j), a_top.slope.of(j));
            let to = flows.over(interval, || oscillator.flow(interval)).driven(from, value, slope);
            let swing: Swing = oscillator.swing(from, value, slope, interval);
            let moment = (mode.height * mode.stiffness).abs();
            farthest += moment * swing.farthest();
            bend += moment * oscillator.rates(&swing, slope)[1];
            springs[0] += mode.height * mode.stiffness * from[0];
            springs[1] += mode.height * mode.stiffness * to[0];
            end.u.set(j, to[0]);
            end.u_dot.set(j, to[1]);
        }
        let held = self.least_hold(start);
        let near = springs[0].abs().max(springs[1].abs()) + bend * interval * interval / 8.0;
        (farthest < held || near < held).then_some(end)
    }

    fn rates(&self, _phase: Phase, _start: &Start<Modes>, _end: &State<Modes>) -> Rates {
        Rates::NONE
    }

    fn series(&self, phase: Phase, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        match phase {
            Phase::Rocking(side) => self.rocking(side, start, arc),
            Phase::FullContact | Phase::Overturned(_) => self.resting(start, arc),
        }
    }

    fn is_singular(&self, phase: Phase, state: &State<Modes>) -> bool {
        let frame = &self.subject.structure;
        let &Base { m_t, J0, B, .. } = Modes::base(frame);
        matches!(phase, Phase::Rocking(side) if inertia(frame, side, &state.u) < LEAST_INERTIA * (J0 + m_t * B * B))
    }

    fn first_uplift(&self, start: &Start<Modes>, arc: &Arc<Modes>) -> (Crossing, Side) {
        let [right, left] = [Side::Right, Side::Left].map(|side| self.first_about(side, start, arc));
        if right.sigma() == left.sigma() && right.sigma() < f64::INFINITY {
            let at = right.sigma() * arc.span;
            let load = Load { a_g: start.a_g.at(at), F_t: Modes::ZERO, a_v: start.a_v.at(at) };
            let now = Now { state: &arc.at(right.sigma()), load, dissipators: start.dissipators };
            return (right, self.uplift_margin(&now).1);
        }
        if right.sigma() <= left.sigma() { (right, Side::Right) } else { (left, Side::Left) }
    }

    fn holds(&self, start: &Start<Modes>) -> bool {
        let &Start { state, interval, .. } = start;
        let most = |j: usize| state.u.of(j).abs() + way(interval, state.u_dot.of(j));
        let springs = Modes::sum(&self.subject.structure, |j, mode| (mode.height * mode.stiffness).abs() * most(j));
        springs < self.least_hold(start)
    }

    fn stays_down(&self, state: &State<Modes>, dissipators: &Dissipators) -> bool {
        let springs = Modes::sum(&self.subject.structure, |j, mode| {
            let omega = (mode.stiffness / mode.mass).sqrt();
            (mode.height * mode.stiffness).abs() * libm::hypot(state.u.of(j), state.u_dot.of(j) / omega)
        });
        springs < self.least_hold(&Start { dissipators, ..Start::default() })
    }

    fn uplift_margin(&self, &Now { state, load, dissipators }: &Now<Modes>) -> (f64, Side) {
        let frame = &self.subject.structure;
        let base = Modes::base(frame);
        let weight = (base.m_t * base.g + base.ties.P_0) * base.B;
        let [springs, all] = lifting(frame, &state.u, &state.u_dot, base.g + load.a_v).map(|moment| moment / weight);
        let about = |side: Side| {
            let (s, held) = (side.sign(), hold(base, side, load.a_v, dissipators) / weight);
            let turns = held + LEAST_EXCESS - s * all;
            ((held - s * springs).min(held).max(turns), turns / inertia(frame, side, &state.u))
        };
        let (right, left) = (about(Side::Right), about(Side::Left));
        let is_right = if right.0 <= 0.0 && left.0 <= 0.0 { right.1 <= left.1 } else { right.0 <= left.0 };
        if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
    }

    /// (M1), or (M8) and (M9) as they stand.
    fn accelerations(&self, phase: Phase, now: &Now<Modes>) -> Second<f64, Modes> {
        let frame = &self.subject.structure;
        let &Now { state, load, dissipators } = now;
        let &State { u, u_dot, theta, theta_dot } = state;
        let base = Modes::base(frame);
        let &Base { m0, B, .. } = base;
        let a_top = load.on_modes(frame);
        let elastic = |j: usize, mode: &Mode, damping: f64| {
            (damping * mode.damping * u_dot.of(j) + mode.stiffness * u.of(j)) / mode.mass
        };
        let Phase::Rocking(side) = phase else {
            let u_ddot = Modes::each(frame, |j, mode| -a_top.of(j) - elastic(j, mode, 1.0));
            return Second { u_ddot, theta_ddot: 0.0 };
        };
        let (g, pivot, (sin, cos)) = (base.g + load.a_v, side.sign() * B, libm::sincos(theta));
        let lever = |j: usize, mode: &Mode| pivot * mode.share - u.of(j);
        let held = |j: usize, mode: &Mode| elastic(j, mode, base.c_ratio) + lever(j, mode) * theta_dot * theta_dot;
        let moment = Modes::sum(frame, |j, mode| {
            let weight = mode.share * g * cos + a_top.of(j) * sin;
            mode.mass * (mode.height * held(j, mode) + lever(j, mode) * (2.0 * theta_dot * u_dot.of(j) - weight))
        });
        let back = restraint::sum(&restraint::ties(base, side, dissipators), |tie| tie.lever);
        let back = back.moment(&Angles::Any.chord(theta, theta_dot));
        let moment = moment - pivot * m0 * (g * cos + load.a_g * sin) - back;
        let theta_ddot = moment / inertia(frame, side, &u);
        let along = |j: usize, mode: &Mode| mode.share * g * sin - a_top.of(j) * cos - held(j, mode);
        Second { u_ddot: Modes::each(frame, |j, mode| along(j, mode) - mode.height * theta_ddot), theta_ddot }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::load::LinearLoad;
    use crate::structure::frame::Body;
    use crate::{Parameters, Structure};
    use approx::assert_relative_eq;

    /// A restrained structure whose modes have these shares.
    fn frame(shares: &[f64]) -> (Structure, Frame) {
        let restrained =
            Parameters { P_0: 200.0, k_t: 3e4, xi_d: 0.1, c_d: 40.0, k_d: 1e5, F_y: 400.0, ..Parameters::MCMANUS };
        let structure = Structure::new(Parameters { zeta_fc: 0.1, c_ratio: 1.3, ..restrained }).unwrap();
        let mode = |(j, share): (usize, &f64)| {
            let Mode { mass, height, stiffness, damping, .. } = structure.mode;
            let (mass, stiffer) = (mass / shares.len() as f64 / (share * share), (1 + j) as f64);
            Mode {
                mass,
                gamma: mass * share,
                share: *share,
                height: height * share / stiffer,
                stiffness: mass * stiffer * stiffness / structure.mode.mass,
                damping: mass * damping / structure.mode.mass,
            }
        };
        let modes: Vec<_> = shares.iter().enumerate().map(mode).collect();
        let Parameters { m0, J0, B, r, g, c_ratio, .. } = *structure.parameters();
        let of = |part: fn(&Mode) -> f64| modes.iter().map(part).sum();
        let (m_s, S_1) = (of(|mode| mode.gamma * mode.share), of(|mode| mode.gamma * mode.height));
        let (I_2, ties) = (of(|mode| mode.mass * mode.height * mode.height), structure.base.ties);
        let body = Body { m0, J0, m_s, S_1, I_2, B, r: Some(r), g, c_ratio, ties };
        (structure, Frame::new(body, &modes, &[]).unwrap())
    }

    fn level(frame: &Frame) -> Nonlinear {
        Nonlinear::new(
            Subject { structure: frame.clone(), local_error: 1e-16, is_tied: true, angles: Angles::Any },
            false,
        )
    }

    /// One mode of any scale, under all loads and with all ties, against Eqs 5 and 6.
    #[test]
    fn one_mode_has_the_accelerations_of_equations_5_and_6() {
        let (scale, dissipators) = (1.7, Dissipators { plastic: [2e-3, -1e-3], yields: [0, 1], ..Dissipators::NEW });
        let (structure, frame) = frame(&[1.0 / scale]);
        for side in [Side::Right, Side::Left] {
            let theta = 0.1 * side.sign();
            let one = State { u: 0.02, u_dot: -0.7, theta, theta_dot: 0.6 };
            let load = Load { a_g: 3.0, F_t: 250.0, a_v: -1.5 };
            let expected = accelerations(&structure, side, &one, load, &dissipators).unwrap();
            let of = |number: f64| Modes::new(&[number]);
            let state = State { u: of(one.u / scale), u_dot: of(one.u_dot / scale), theta, theta_dot: one.theta_dot };
            let load = Load { a_g: load.a_g, F_t: of(load.F_t * scale), a_v: load.a_v };
            let now = Now { state: &state, load, dissipators: &dissipators };
            let found = level(&frame).accelerations(Phase::Rocking(side), &now);
            assert_relative_eq!(scale * found.u_ddot.of(0), expected[0], max_relative = 1e-12);
            assert_relative_eq!(found.theta_ddot, expected[1], max_relative = 1e-12);
        }
    }

    /// The derivatives of the series are the accelerations along it, under all loads and with all ties.
    #[test]
    fn the_series_satisfies_the_equations_of_many_masses() {
        let (_, frame) = frame(&[1.3, -0.6, 0.4]);
        let level = level(&frame);
        let dissipators = Dissipators { plastic: [2e-3, -1e-3], ..Dissipators::NEW };
        let modes = |numbers: [f64; 3]| Modes::new(&numbers);
        let state =
            State { u: modes([0.01, -0.02, 0.005]), u_dot: modes([0.3, 0.1, -0.2]), theta: -0.2, theta_dot: 0.5 };
        let load = LinearLoad {
            value: Load { a_g: 3.0, F_t: modes([100.0, -200.0, 50.0]), a_v: -1.5 },
            slope: Load { a_g: 200.0, F_t: modes([-3e3, 1e4, 2e4]), a_v: 80.0 },
        };
        for phase in [Phase::Rocking(Side::Left), Phase::FullContact] {
            let start = level.subject().start(level.admissible(phase, state), &dissipators, load, 3e-3);
            let mut arc = Arc::default();
            level.series(phase, &start, &mut arc);
            assert_eq!(arc.reach, 1.0);
            for sigma in [0.0, 0.3, 1.0] {
                let now = Now { state: &arc.at(sigma), load: load.at(sigma * arc.span), dissipators: &dissipators };
                let Second { u_ddot, theta_ddot } = level.accelerations(phase, &now);
                let slope = |coefficient: &dyn Fn(usize) -> f64| -> f64 {
                    (1..=arc.order).map(|k| k as f64 * coefficient(k) * sigma.powi(k as i32 - 1)).sum::<f64>()
                        / arc.span
                };
                assert_relative_eq!(slope(&|k| arc.theta_dot[k]), theta_ddot, epsilon = 1e-9);
                for j in 0..3 {
                    assert_relative_eq!(slope(&|k| arc.u_dot[k].of(j)), u_ddot.of(j), epsilon = 1e-9);
                }
            }
        }
    }
}
