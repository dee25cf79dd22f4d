//! Structures of many masses: exact modes in full contact, and a rocking base that carries the modes, nonlinear or linear.
//!
//! Each mode has μ, h and Γ, and takes the part S = Γ/μ in a translation. With w = sB S − u and e = (c u̇ + k u)/μ, (M8) and (M9) are
//!
//! ```text
//! ü + h θ̈ = −e − w θ̇² + S g sin θ − a cos θ                    a = S a_g − φᵀF/μ of each mode
//! d/dt [D θ̇] = Σ μ h (e + w θ̇²) − X (g cos θ + a_g sin θ) + S_res (g sin θ − a_g cos θ)
//!              + (Σ φᵀF w + sB F_res) sin θ + N_res cos θ − ties
//! D = J0 + m0 B² + Σ μ w²,      X = s m0 B + Σ Γ w
//! ```
//!
//! The angular momentum D θ̇ has no Coriolis term. An order takes five products and one more for each mode. g is g + a_v. m0 and J0
//! include the mass that no mode carries, and S_res is the first moment of this mass. F_res and N_res are the force on it and the
//! moment of this force ([`Frame::load`]). A structure without modes is a rigid block, with the end of bouncing of [`rigid`].
//!
//! [`rigid`]: crate::levels::rigid

use crate::levels::detail::Detail;
use crate::levels::first_uplift::Liftable;
use crate::levels::level::{Level, Now, Rates, Subject};
use crate::levels::nonlinear::{Factors, LEAST_INERTIA, NO_ROW, products, row};
use crate::levels::oscillator::{Flow, Kept, Oscillator, Swing};
use crate::levels::rigid as block;
use crate::levels::rules::ChatterLimit;
use crate::levels::ties::TieSeries;
use crate::mechanics::impact;
use crate::mechanics::instant::Second;
use crate::mechanics::lateral::{Coordinates, Lateral, Modes};
use crate::mechanics::restraint::{self, Angles, Dissipators};
use crate::mechanics::uplift::inertia;
use crate::series::taylor::{Arc, LONGEST_SPAN, MAX_ORDER, Start, Truncation};
use crate::structure::{Base, Mode};
use crate::{Phase, Side, State};
use std::cell::RefCell;
use wide::f64x4;

/// Part of the acceleration of gravity by which a motion is as good as none.
const NEGLIGIBLE: f64 = 1e-30;

/// Motion of a structure of many masses.
#[derive(Clone, Debug)]
pub(crate) struct ManyModes {
    subject: Subject<Modes>,
    detail: Detail,
    /// The oscillators of full contact, if their exact flow is used.
    contact: Option<Vec<(Oscillator, Kept<Flow>)>>,
    /// Radius of gyration about a pivot √(J_P/m_t), m.
    radius: f64,
    /// Inertia about a pivot that the modes leave, kg·m².
    left: f64,
    /// J_P over this inertia: how much faster the structure vibrates while rocking, squared.
    quickening: f64,
    /// The longest span of a series while rocking, s.
    longest_span: f64,
    scratch: RefCell<Box<Scratch>>,
}

/// Room for the series of one step.
#[derive(Clone, Debug)]
struct Scratch {
    fours: Vec<Four>,
    /// Row i of the left factors, and of the right ones counted from their end, of six products of order i ("next": of order i + 1):
    ///
    /// ```text
    /// left:   θ̇       θ̇       θ̇    D, next   X        Σ φᵀF w
    /// right:  cos θ   sin θ   θ̇    θ̇         weight   sin θ
    /// ```
    factors: [Factors; 2],
    /// θ̇² for the modes of a four, from the end.
    square: FourSeries,
}

/// Coefficients for four modes.
type FourSeries = [f64x4; MAX_ORDER + 1];

/// Four modes side by side; modes that are none have no mass and stay at rest.
#[derive(Clone, Debug, Default)]
struct Four {
    /// The number of the first mode.
    first: usize,
    mass: f64x4,
    share: f64x4,
    height: f64x4,
    /// μ h.
    arm: f64x4,
    /// k/μ.
    stiffness: f64x4,
    /// c/μ in full contact.
    damping: f64x4,
    /// The newest coefficients of u and u̇.
    motion: [f64x4; 2],
    /// Force over mass, and its change over the span.
    push: [f64x4; 2],
    /// e + w θ̇² of the newest order.
    held: f64x4,
    /// w.
    lever: FourSeries,
    /// μ w, from the end.
    heavy: FourSeries,
}

impl Four {
    fn new((place, modes): (usize, &[Mode])) -> Four {
        let both = |of: fn(&Mode) -> f64| f64x4::new([0, 1, 2, 3].map(|i| modes.get(i).map_or(0.0, of)));
        Four {
            first: 4 * place,
            mass: both(|mode| mode.mass),
            share: both(|mode| mode.share),
            height: both(|mode| mode.height),
            arm: both(|mode| mode.mass * mode.height),
            stiffness: both(|mode| mode.stiffness / mode.mass),
            damping: both(|mode| mode.damping / mode.mass),
            ..Four::default()
        }
    }

    /// Σ a_i b_{k−i} over the first terms of `a`, with b kept from its end.
    #[inline(always)]
    fn product(a: &[f64x4], b: &[f64x4]) -> f64x4 {
        let mut sum = f64x4::ZERO;
        a.iter().zip(b).for_each(|(a, b)| sum += a * b);
        sum
    }

    /// Puts w in order 0.
    #[inline(always)]
    fn start(&mut self, lever: f64x4) -> f64x4 {
        let heavy = self.mass * lever;
        (self.lever[0], self.heavy[MAX_ORDER]) = (lever, heavy);
        heavy
    }

    /// Puts −u in order `k` of w, and returns that order of μ w² and μ w.
    #[inline(always)]
    fn next(&mut self, k: usize, per: f64) -> [f64x4; 2] {
        let Four { lever, heavy, .. } = self;
        lever[k] = self.motion[1] * -per;
        heavy[MAX_ORDER - k] = self.mass * lever[k];
        // both halves of Σ w_i μ w_{k−i} are the same
        let half = k.div_ceil(2);
        let mut square = Four::product(&lever[..half], &heavy[MAX_ORDER - k..]);
        square += square;
        if k.is_multiple_of(2) {
            square += lever[half] * heavy[MAX_ORDER - half];
        }
        [square, heavy[MAX_ORDER - k]]
    }
}

impl ManyModes {
    /// The level of this `detail` of the structure of `subject`: `auto`, `nonlinear`, `linear` or `fixed_base`.
    pub(crate) fn new(subject: Subject<Modes>, detail: Detail) -> ManyModes {
        let frame = &subject.structure;
        let base = Modes::base(frame);
        let of_modes = Modes::sum(frame, |_, mode| mode.mass * mode.height * mode.height);
        let oscillator = |mode: &Mode| {
            let omega = mode.omega();
            (Oscillator { omega, zeta: mode.damping / (2.0 * mode.mass * omega) }, Kept::new(Flow::NONE))
        };
        let left = base.J_P - of_modes;
        let ties = restraint::sum(&restraint::ties(base, Side::Right, &Dissipators::NEW), |tie| tie.lever);
        let [_, highest] = Modes::vibration(frame).rocking;
        let fastest = (highest * highest + ties.stiffness / left).sqrt().max(base.p_l).max(ties.damping / left);
        ManyModes {
            contact: (detail != Detail::Nonlinear).then(|| frame.modes().iter().map(oscillator).collect()),
            radius: (base.J_P / base.m_t).sqrt(),
            left,
            quickening: base.J_P / left,
            longest_span: LONGEST_SPAN / fastest,
            scratch: RefCell::new(Box::new(Scratch {
                fours: frame.modes().chunks(4).enumerate().map(Four::new).collect(),
                factors: [[NO_ROW; MAX_ORDER + 1]; 2],
                square: [f64x4::ZERO; MAX_ORDER + 1],
            })),
            detail,
            subject,
        }
    }

    /// The root of the mean square of a velocity or an acceleration over all mass, by `of` each mode.
    fn size(&self, of: impl Fn(usize, &Mode) -> f64) -> f64 {
        let frame = &self.subject.structure;
        (Modes::sum(frame, |j, mode| mode.mass * of(j, mode) * of(j, mode)) / frame.base.m_t).sqrt()
    }

    /// The truncation that `start` requires over a step of `span` s, while rocking or not.
    fn truncation(&self, start: &Start<Modes>, span: f64, is_rocking: bool) -> Truncation<Modes> {
        let &Start { state, a_g, a_top, local_error, .. } = start;
        let frame = &self.subject.structure;
        let &Base { m_t, g, tan_alpha_cg, .. } = Modes::base(frame);
        let vibration = Modes::vibration(frame);
        let elastic = self.size(|j, mode| mode.stiffness / mode.mass * state.u.of(j));
        let load = self.size(|j, _| a_top.value.of(j)) + span * self.size(|j, _| a_top.slope.of(j));
        let (time, elastic, load) = match is_rocking {
            true => {
                let ground = a_g.value.abs() + span * a_g.slope.abs();
                (1.0 / vibration.rocking[0], self.quickening * elastic, load.max(ground) + g * tan_alpha_cg)
            }
            false => (1.0 / vibration.contact, elastic, load.max(NEGLIGIBLE * g)),
        };
        let velocity = self.size(|j, _| state.u_dot.of(j)) + span.min(time) * (elastic + load);
        let theta_dot = state.theta_dot.abs() + velocity / self.radius;
        Truncation {
            u_dot: Modes::each(frame, |_, mode| local_error * velocity * (m_t / mode.mass).sqrt()),
            theta_dot: if is_rocking { local_error * theta_dot } else { 0.0 },
        }
    }

    /// Writes the motion in full contact into `arc` (M1).
    fn resting(&self, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let Start { state, a_top, interval, .. } = start;
        let span = interval.min(LONGEST_SPAN / Modes::vibration(&self.subject.structure).rocking[1]);
        let fours = &mut self.scratch.borrow_mut().fours;
        for four in fours.iter_mut() {
            let j = four.first;
            four.motion = [state.u.four(j), state.u_dot.four(j)];
            four.push = [a_top.value.four(j), a_top.slope.four(j) * span];
        }
        let truncation = self.truncation(start, span, false);
        arc.expand_in_place(state, span, &truncation, |arc, k, per| {
            arc.u_dot[k].count_as(&state.u_dot);
            for four in fours.iter_mut() {
                let j = four.first;
                let [u, u_dot] = four.motion;
                let mut rate = four.damping * u_dot + four.stiffness * u;
                if let Some(load) = four.push.get(k - 1) {
                    rate += *load;
                }
                four.motion = [u_dot * per, rate * -per];
                arc.u_dot[k].set_four(j, four.motion[1]);
            }
            0.0
        });
    }

    /// Writes the motion while rocking about `side` into `arc` (M8, M9).
    fn rocking(&self, side: Side, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let Start { state, a_g, a_top, a_v, .. } = start;
        let &Base { m0, J0, S_res, B, g, c_ratio, .. } = Modes::base(&self.subject.structure);
        let span = start.interval.min(self.longest_span);
        let mut ties = self.subject.is_tied.then(|| {
            let base = Modes::base(&self.subject.structure);
            let ties = restraint::sum(&restraint::ties(base, side, start.dissipators), |tie| tie.lever);
            TieSeries::new(ties, Angles::Any, state.theta)
        });
        let pivot = side.sign() * B;
        let (g, lift) = (g + a_v.value, a_v.slope * span);
        let (ground, ground_slope) = (a_g.value, a_g.slope * span);
        let Scratch { fours, factors: [left, right], square } = &mut **self.scratch.borrow_mut();
        let (mut inertia, mut offset, mut is_pushed) = (f64x4::ZERO, f64x4::ZERO, false);
        for four in fours.iter_mut() {
            let j = four.first;
            let lever = four.share * pivot - state.u.four(j);
            let heavy = four.start(lever);
            inertia += lever * heavy;
            offset += four.share * heavy;
            four.motion = [state.u.four(j), state.u_dot.four(j)];
            let parts = [a_top.value.four(j), a_top.slope.four(j)];
            four.push = [four.share * a_g.value - parts[0], (four.share * a_g.slope - parts[1]) * span];
            is_pushed |= four.push != [f64x4::ZERO; 2];
        }
        let per_inertia = 1.0 / (J0 + m0 * B * B + inertia.reduce_add());
        let (mut offset, mut theta_dot) = (pivot * m0 + offset.reduce_add(), state.theta_dot);
        let ((mut sin, mut cos), [mut sin_before, mut cos_before]) = (libm::sincos(state.theta), [0.0; 2]);
        let [on_rest, rest_slope] = [a_top.value, a_top.slope].map(|forces| forces.rest().unwrap_or_default());
        is_pushed |= [on_rest, rest_slope] != [[0.0; 2]; 2];
        // Σ φᵀF w + sB F_res
        let pushes = |fours: &[Four], k: usize| {
            let mut sum = f64x4::ZERO;
            for Four { mass, push, lever, .. } in fours {
                sum += mass * (push[0] * lever[k] + if k > 0 { push[1] * lever[k - 1] } else { f64x4::ZERO });
            }
            sum.reduce_add() + pivot * [on_rest[0], rest_slope[0] * span].get(k).unwrap_or(&0.0)
        };
        let truncation = self.truncation(start, span, true);
        arc.expand_in_place(state, span, &truncation, |arc, k, per| {
            let n = k - 1;
            let [mut inertia, mut next_offset] = [f64x4::ZERO; 2];
            for four in fours.iter_mut() {
                let [square, heavy] = four.next(k, per);
                inertia += square;
                next_offset += four.share * heavy;
            }
            // g sin θ − a_g cos θ, and g cos θ + a_g sin θ
            let fall = g * sin + lift * sin_before - (ground * cos + ground_slope * cos_before);
            let weight = g * cos + lift * cos_before + ground * sin + ground_slope * sin_before;
            let push = if is_pushed { pushes(fours, n) } else { 0.0 };
            let newest_left = row([theta_dot, theta_dot, theta_dot, inertia.reduce_add(), offset, push]);
            let newest_right = row([cos, sin, theta_dot, theta_dot, weight, sin]);
            (left[n], right[MAX_ORDER - n]) = (newest_left, newest_right);
            let [sin_rate, minus_cos_rate, turning, known, weight_moment, push_moment] =
                products(left, right, &newest_left, &newest_right, n);
            square[MAX_ORDER - n] = f64x4::splat(turning);
            let mut moment = f64x4::ZERO;
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                let elastic = four.stiffness * u + four.damping * c_ratio * u_dot;
                four.held = Four::product(&four.lever[..k], &square[MAX_ORDER - n..]) + elastic;
                moment += four.arm * four.held;
            }
            let mut moment = moment.reduce_add() - weight_moment + push_moment + S_res * fall;
            if is_pushed {
                moment += on_rest[1] * cos + rest_slope[1] * span * cos_before;
            }
            if let Some(ties) = &mut ties {
                moment -= ties.next(&arc.theta_dot, n, per);
            }
            theta_dot = per_inertia * (moment * per - known);
            arc.u_dot[k].count_as(&state.u_dot);
            for four in fours.iter_mut() {
                let j = four.first;
                let mut along = four.share * fall - four.held;
                if is_pushed {
                    along += four.push[0] * cos + four.push[1] * cos_before;
                }
                four.motion = [four.motion[1] * per, along * per - four.height * theta_dot];
                arc.u_dot[k].set_four(j, four.motion[1]);
            }
            offset = next_offset.reduce_add();
            (sin_before, cos_before) = (sin, cos);
            (sin, cos) = (sin_rate * per, -minus_cos_rate * per);
            theta_dot
        });
    }

    /// Writes the motion while rocking about `side` by small angles into `arc`. From (M10) and (M11), with e = (c u̇ + k u)/μ,
    ///
    /// ```text
    /// ü + h θ̈ = −e + S g θ − a,      (J_P − Σ μ h²) θ̈ = Σ (μ h e + Γ g u) − s m_t g B + S_res (g θ − a_g) − ties
    /// ```
    fn rocking_little(&self, side: Side, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let Start { state, a_g, a_top, a_v, .. } = start;
        let base = Modes::base(&self.subject.structure);
        let &Base { m_t, S_res, B, g, c_ratio, .. } = base;
        let span = start.interval.min(self.longest_span);
        let mut ties = self.subject.is_tied.then(|| {
            let ties = restraint::sum(&restraint::ties(base, side, start.dissipators), |tie| tie.lever);
            TieSeries::new(ties, Angles::Small, state.theta)
        });
        let (g, lift, pivot) = (g + a_v.value, a_v.slope * span, side.sign() * B);
        let fours = &mut self.scratch.borrow_mut().fours;
        for four in fours.iter_mut() {
            let j = four.first;
            four.motion = [state.u.four(j), state.u_dot.four(j)];
            four.push = [a_top.value.four(j), a_top.slope.four(j) * span];
        }
        let mut before = f64x4::ZERO; // Σ Γ u of the order before
        let truncation = self.truncation(start, span, true);
        arc.expand_in_place(state, span, &truncation, |arc, k, per| {
            let n = k - 1;
            let of_order = |values: [f64; 2]| values.get(n).copied().unwrap_or(0.0);
            let weight = of_order([g, lift]);
            let lean = g * arc.theta[n] + if n > 0 { lift * arc.theta[n - 1] } else { 0.0 };
            let (mut moment, mut offset) = (f64x4::ZERO, f64x4::ZERO);
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                four.held = four.stiffness * u + four.damping * c_ratio * u_dot;
                moment += four.arm * four.held;
                offset += four.mass * four.share * u;
            }
            let mut moment = (moment + offset * g + before * lift).reduce_add() - pivot * m_t * weight;
            let [value, slope] = [(a_g.value, a_top.value), (a_g.slope, a_top.slope)]
                .map(|(a, on)| on.rest().map_or(0.0, |[_, moment]| moment) - S_res * a);
            moment += S_res * lean + of_order([value, slope * span]);
            before = offset;
            if let Some(ties) = &mut ties {
                moment -= ties.next(&arc.theta_dot, n, per);
            }
            let theta_dot = moment / self.left * per;
            arc.u_dot[k].count_as(&state.u_dot);
            for four in fours.iter_mut() {
                let mut along = four.share * lean - four.held;
                if let Some(load) = four.push.get(n) {
                    along -= *load;
                }
                four.motion = [four.motion[1] * per, along * per - four.height * theta_dot];
                arc.u_dot[k].set_four(four.first, four.motion[1]);
            }
            theta_dot
        });
    }
}

impl Level<Modes> for ManyModes {
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
        let held = self.liftable().map_or(f64::INFINITY, |liftable| liftable.least_hold(start));
        let near = springs[0].abs().max(springs[1].abs()) + bend * interval * interval / 8.0;
        (farthest < held || near < held).then_some(end)
    }

    fn rates(&self, _phase: Phase, _start: &Start<Modes>, _end: &State<Modes>) -> Rates {
        Rates::NONE
    }

    fn vibration(&self, phase: Phase, start: &Start<Modes>) -> Option<[Modes; 4]> {
        let (Phase::FullContact, Some(contact)) = (phase, &self.contact) else { return None };
        let &Start { state, a_top, interval, .. } = start;
        let mut bounds = [Modes::parts(&self.subject.structure, 0.0); 4];
        for (j, (oscillator, _)) in contact.iter().enumerate() {
            let from = [state.u.of(j), state.u_dot.of(j)];
            let swing = oscillator.swing(from, a_top.value.of(j), a_top.slope.of(j), interval);
            let [velocity, acceleration, jerk] = oscillator.rates(&swing, 0.0);
            let most = [swing.amplitude, velocity, acceleration, jerk];
            bounds.iter_mut().zip(most).for_each(|(of, most)| of.set(j, most));
        }
        Some(bounds)
    }

    fn series(&self, phase: Phase, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        match phase {
            Phase::Rocking(side) if self.detail == Detail::Linear => self.rocking_little(side, start, arc),
            Phase::Rocking(side) => self.rocking(side, start, arc),
            Phase::FullContact | Phase::Overturned(_) => self.resting(start, arc),
        }
    }

    fn is_singular(&self, phase: Phase, state: &State<Modes>) -> bool {
        let frame = &self.subject.structure;
        let &Base { m_t, J0, B, .. } = Modes::base(frame);
        self.detail != Detail::Linear
            && matches!(phase, Phase::Rocking(side) if inertia(&frame.base, frame.modes(), side, |j| state.u.of(j)) < LEAST_INERTIA * (J0 + m_t * B * B))
    }

    fn liftable(&self) -> Option<Liftable<'_>> {
        let Subject { structure, angles, .. } = &self.subject;
        (self.detail != Detail::FixedBase).then(|| Liftable {
            base: &structure.base,
            modes: structure.modes(),
            rigid: None,
            lean: 1.0,
            has_constant_inertia: *angles == Angles::Small,
        })
    }

    fn after_impact(&self, side: Side, before: &State<Modes>) -> (Phase, State<Modes>) {
        let &Subject { ref structure, local_error, .. } = &self.subject;
        match structure.modes() {
            [] => block::after_impact::<Modes>(structure, local_error, side, before),
            _ => impact::resolve::<Modes>(structure, side, before),
        }
    }

    fn chatter_limit(&self) -> ChatterLimit {
        match self.subject.structure.modes() {
            [] => block::chatter_limit(&self.subject.structure.base),
            _ => ChatterLimit::of(Modes::vibration(&self.subject.structure)),
        }
    }

    /// (M1), or the equations of rocking as they stand.
    fn accelerations(&self, phase: Phase, now: &Now<Modes>) -> Second<f64, Modes> {
        let frame = &self.subject.structure;
        let &Now { state, load, dissipators } = now;
        let &State { u, u_dot, theta, theta_dot } = state;
        let base = Modes::base(frame);
        let &Base { m0, S_res, B, .. } = base;
        let a_top = load.on_modes(frame);
        let elastic = |j: usize, mode: &Mode, damping: f64| {
            (damping * mode.damping * u_dot.of(j) + mode.stiffness * u.of(j)) / mode.mass
        };
        let Phase::Rocking(side) = phase else {
            let u_ddot = Modes::each(frame, |j, mode| -a_top.of(j) - elastic(j, mode, 1.0));
            return Second { u_ddot, theta_ddot: 0.0 };
        };
        let (g, pivot) = (base.g + load.a_v, side.sign() * B);
        let ties = restraint::sum(&restraint::ties(base, side, dissipators), |tie| tie.lever);
        let back = ties.moment(&self.subject.angles.chord(theta, theta_dot));
        if self.detail == Detail::Linear {
            let moment = Modes::sum(frame, |j, mode| {
                mode.mass * mode.height * elastic(j, mode, base.c_ratio) + mode.gamma * g * u.of(j)
            });
            let rigid = load.F_t.rest().map_or(0.0, |[_, moment]| moment) - S_res * load.a_g;
            let moment = moment - pivot * base.m_t * g + S_res * g * theta + rigid - back;
            let theta_ddot = moment / self.left;
            let along = |j: usize, mode: &Mode| mode.share * g * theta - a_top.of(j) - elastic(j, mode, base.c_ratio);
            return Second {
                u_ddot: Modes::each(frame, |j, mode| along(j, mode) - mode.height * theta_ddot),
                theta_ddot,
            };
        }
        let (sin, cos) = libm::sincos(theta);
        let lever = |j: usize, mode: &Mode| pivot * mode.share - u.of(j);
        let held = |j: usize, mode: &Mode| elastic(j, mode, base.c_ratio) + lever(j, mode) * theta_dot * theta_dot;
        let moment = Modes::sum(frame, |j, mode| {
            let weight = mode.share * g * cos + a_top.of(j) * sin;
            mode.mass * (mode.height * held(j, mode) + lever(j, mode) * (2.0 * theta_dot * u_dot.of(j) - weight))
        });
        let fall = g * sin - load.a_g * cos;
        let [force, height] = load.F_t.rest().unwrap_or_default();
        let moment = moment - pivot * m0 * (g * cos + load.a_g * sin) + S_res * fall - back;
        let moment = moment + force * pivot * sin + height * cos;
        let theta_ddot = moment / inertia(base, frame.modes(), side, |j| u.of(j));
        let along = |j: usize, mode: &Mode| mode.share * g * sin - a_top.of(j) * cos - held(j, mode);
        Second { u_ddot: Modes::each(frame, |j, mode| along(j, mode) - mode.height * theta_ddot), theta_ddot }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::piece::Turning;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::floors::MotionOfFloors;
    use crate::mechanics::gauge::Gauge;
    use crate::mechanics::instant::Instant;
    use crate::mechanics::load::{LinearLoad, Load};
    use crate::mechanics::reactions::Reactions;
    use crate::structure::Ties;
    use crate::structure::frame::{Body, Floor, Frame};
    use crate::{Parameters, Structure};
    use approx::assert_relative_eq;

    /// A restrained structure whose modes have these shares and carry the whole mass, or less of `more` mass.
    fn frame(shares: &[f64], more: f64) -> (Structure, Frame) {
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
        let of = |part: fn(&Mode) -> f64| more * modes.iter().map(part).sum::<f64>();
        let (m_s, S_1) = (of(|mode| mode.gamma * mode.share), of(|mode| mode.gamma * mode.height));
        let (I_2, ties) = (of(|mode| mode.mass * mode.height * mode.height), structure.base.ties);
        let body = Body { m0, J0, m_s, S_1, I_2, B, r: Some(r), g, c_ratio, ties };
        (structure, Frame::new(body, &modes, &[]).unwrap())
    }

    fn level(frame: &Frame, detail: Detail) -> ManyModes {
        let angles = detail.angles();
        ManyModes::new(Subject { structure: frame.clone(), local_error: 1e-16, is_tied: true, angles }, detail)
    }

    /// One mode of any scale, under all loads and with all ties, against Eqs 5 and 6.
    #[test]
    fn one_mode_has_the_accelerations_of_equations_5_and_6() {
        let (scale, dissipators) = (1.7, Dissipators { plastic: [2e-3, -1e-3], yields: [0, 1], ..Dissipators::NEW });
        let (structure, frame) = frame(&[1.0 / scale], 1.0);
        for side in [Side::Right, Side::Left] {
            let theta = 0.1 * side.sign();
            let one = State { u: 0.02, u_dot: -0.7, theta, theta_dot: 0.6 };
            let load = Load { a_g: 3.0, F_t: 250.0, a_v: -1.5 };
            let expected = accelerations(&structure, side, &one, load, &dissipators).unwrap();
            let of = |number: f64| Modes::new(&[number]);
            let state = State { u: of(one.u / scale), u_dot: of(one.u_dot / scale), theta, theta_dot: one.theta_dot };
            let load = Load { a_g: load.a_g, F_t: of(load.F_t * scale), a_v: load.a_v };
            let now = Now { state: &state, load, dissipators: &dissipators };
            let found = level(&frame, Detail::Nonlinear).accelerations(Phase::Rocking(side), &now);
            assert_relative_eq!(scale * found.u_ddot.of(0), expected[0], max_relative = 1e-12);
            assert_relative_eq!(found.theta_ddot, expected[1], max_relative = 1e-12);
        }
    }

    /// The derivatives of the series are the accelerations along it, under all loads and with all ties.
    #[test]
    fn the_series_satisfies_the_equations_of_many_masses() {
        let (_, frame) = frame(&[1.3, -0.6, 0.4], 1.25);
        let dissipators = Dissipators { plastic: [2e-3, -1e-3], ..Dissipators::NEW };
        let modes = |numbers: [f64; 3]| Modes::new(&numbers);
        let state =
            State { u: modes([0.01, -0.02, 0.005]), u_dot: modes([0.3, 0.1, -0.2]), theta: -0.2, theta_dot: 0.5 };
        let load = LinearLoad {
            value: Load { a_g: 3.0, F_t: modes([100.0, -200.0, 50.0]).and_rest([60.0, -90.0]), a_v: -1.5 },
            slope: Load { a_g: 200.0, F_t: modes([-3e3, 1e4, 2e4]).and_rest([-1e3, 4e3]), a_v: 80.0 },
        };
        for (detail, phase) in [
            (Detail::Nonlinear, Phase::Rocking(Side::Left)),
            (Detail::Linear, Phase::Rocking(Side::Left)),
            (Detail::Nonlinear, Phase::FullContact),
        ] {
            let level = level(&frame, detail);
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

    /// The distance from uplift is the larger of what (M3) misses and of −s D θ̈, by the equations of rocking, under all loads.
    #[test]
    fn the_uplift_margin_follows_from_the_equations_of_rocking() {
        let (_, frame) = frame(&[1.3, -0.6, 0.4], 1.25);
        let &Base { m_t, S_res, B, g, .. } = &frame.base;
        let dissipators = Dissipators { plastic: [2e-3, -1e-3], ..Dissipators::NEW };
        let level = level(&frame, Detail::Nonlinear);
        let weight = (m_t * g + frame.base.ties.P_0) * B;
        for (scale, a_v) in [(1.0, -1.5), (-1.0, 2.5), (0.2, 4.0)] {
            let [u, u_dot] = [[0.004, -0.003, 0.002], [0.3, 0.1, -0.2]].map(|of| Modes::new(&of.map(|it| scale * it)));
            let state = State { u, u_dot, theta: 0.0, theta_dot: 0.0 };
            let load = Load { a_g: 0.7, F_t: Modes::new(&[9.0, 5.0, -7.0]).and_rest([60.0, -90.0]), a_v };
            let now = Now { state: &state, load, dissipators: &dissipators };
            let springs =
                Modes::sum(&frame, |j, mode| mode.height * mode.stiffness * u.of(j)) - S_res * load.a_g - 90.0;
            let expected = [Side::Right, Side::Left].map(|side| {
                let [tendon, pair @ ..] = restraint::ties(&frame.base, side, &dissipators);
                let residual: f64 = pair.iter().map(|tie| tie.lever * tie.force).sum();
                let held = m_t * (g + a_v) * B + tendon.force * B + side.sign() * residual;
                let inertia = inertia(&frame.base, frame.modes(), side, |j| u.of(j));
                let turns = level.accelerations(Phase::Rocking(side), &now).theta_ddot * inertia;
                ((held - side.sign() * springs) / weight).max(-side.sign() * turns / weight)
            });
            let (found, side) = level.uplift_margin(&now);
            let least = if side == Side::Right { expected[0] } else { expected[1] };
            assert_relative_eq!(found, least, max_relative = 1e-9);
            assert!(found <= expected[0].min(expected[1]) + 1e-9, "{found} {expected:?}");
        }
    }

    /// Newton's law for a floor, for the moments about the pivot, and the shear of a storey as a sum, with mass that turns rigidly, and
    /// with modes whose rounding leaves next to none.
    #[test]
    fn gauges_and_reactions_follow_from_the_motion() {
        [1.25, 1.0 + 3e-10].into_iter().for_each(gauges_and_reactions_follow);
    }

    fn gauges_and_reactions_follow(more: f64) {
        let (structure, frame) = frame(&[1.3, -0.6, 0.4], more);
        let base = Base { ties: Ties::default(), ..structure.base };
        let floor = |mass, height, shape: [f64; 3]| Floor { mass, height, shape: Modes::new(&shape) };
        let floors = [floor(3.0, 1.1, [0.2, 0.5, -0.3]), floor(2.0, 2.3, [0.9, -0.4, 0.1])];
        let frame = Frame::new(Body { ties: base.ties, ..*frame.body() }, frame.modes(), &floors).unwrap();
        let level = level(&frame, Detail::Nonlinear);
        let modes = |numbers: [f64; 3]| Modes::new(&numbers);
        let (u, u_dot) = (modes([0.01, -0.02, 0.005]), modes([0.3, 0.1, -0.2]));
        let forces = [70.0, -40.0];
        let load = frame.load(3.0, -1.5, &forces).unwrap();
        let turned = State { u, u_dot, theta: -0.2, theta_dot: 0.5 };
        for (phase, state) in
            [(Phase::Rocking(Side::Left), turned), (Phase::FullContact, State { theta: 0.0, theta_dot: 0.0, ..turned })]
        {
            let now = Now { state: &state, load, dissipators: &Dissipators::NEW };
            let second = level.accelerations(phase, &now);
            let x = Instant::<f64, Modes>::of(&frame, phase, &state, load);
            let Instant { turn, theta_dot, a_g, a_v, s, .. } = x;
            let seen = Turning { x, theta_ddot: second.theta_ddot };
            let value = |gauge: &Gauge| seen.gauge(gauge);
            let (mut storey, gauges) = (0.0, frame.gauges());
            for (i, floor) in floors.iter().enumerate().rev() {
                let lever = s * frame.base.B - floor.displacement(&u);
                let along = floor.displacement(&second.u_ddot) + floor.height * second.theta_ddot;
                let expected = along + theta_dot * theta_dot * lever + a_g * turn.cos - a_v * turn.sin;
                assert_relative_eq!(value(&gauges.a[i]), expected, max_relative = 1e-12);
                storey += floor.mass * expected;
                assert_relative_eq!(value(&gauges.V[i]), storey, max_relative = 1e-12);
            }
            let x = &seen.x;
            let reactions = Reactions::at(x, &second);
            if let Phase::Rocking(_) = phase {
                assert_relative_eq!(reactions.R_m, x.pivot() * reactions.R_v, max_relative = 1e-11);
            } else {
                let weight = frame.base.g + a_v;
                let rigid = load.F_t.rest().unwrap_or_default()[1] - frame.base.S_res * a_g;
                let turns = Modes::sum(&frame, |j, mode| {
                    let elastic = mode.stiffness * u.of(j) + mode.damping * u_dot.of(j);
                    mode.height * elastic + mode.gamma * weight * u.of(j)
                });
                assert_relative_eq!(reactions.R_m, turns + rigid, max_relative = 1e-12);
                // the foundation carries its own a_g, and the masses carry the base shear
                let carried = value(&gauges.V_t) + frame.body().m0 * a_g - forces[0] - forces[1];
                assert_relative_eq!(reactions.R_h, -carried, max_relative = 1e-12);
                let pushed: f64 = forces.iter().zip(&floors).map(|(force, floor)| force * floor.height).sum();
                assert_relative_eq!(
                    value(&gauges.M_t),
                    -(reactions.R_m - weight * x.sum(|j, mode| mode.gamma * u.of(j)) - pushed),
                    max_relative = 1e-12
                );
            }
        }
    }
}
