//! A rocking base that carries modes, nonlinear or linear: structures of many masses, a rigid structure, and one mass by linear
//! equations with ties. Full contact has exact modes.
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
//! moment of this force ([`Structure::load`](crate::Structure::load)). A structure without modes is rigid: Housner's block with a
//! rule of [impact](crate::mechanics::impact) of its own.

use crate::levels::detail::Detail;
use crate::levels::full_contact::{self, ExactContact};
use crate::levels::level::{Level, LevelSubject};
use crate::levels::nonlinear::{Factors, LEAST_INERTIA, NO_ROW, products, row};
use crate::levels::oscillator::Oscillator;
use crate::levels::start::{Start, Truncation};
use crate::levels::uplift::{Liftable, inertia};
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{Angles, Dissipators, MomentSeries, Restraint};
use crate::series::taylor::{LONGEST_SPAN, MAX_ORDER, NEGLIGIBLE};
use crate::structure::mode::{Modes, Vibration};
use crate::{Base, Mode, Phase, Side, State};
use std::cell::RefCell;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};
use wide::f64x4;

/// Motion of a base with modes.
#[derive(Clone, Debug)]
pub(crate) struct ManyModes<Q: Coordinates> {
    subject: LevelSubject<Q>,
    pub base: Base,
    modes: Vec<Mode>,
    /// Mass (kg) and height (m) of a top mass that turns rigidly with the base.
    pub rigid: Option<[f64; 2]>,
    vibration: Vibration,
    /// The oscillators of full contact, if their exact flow is used.
    pub contact: Option<Vec<ExactContact>>,
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
    fours: Vec<ModeGroup>,
    /// Row i of the left factors, and of the right ones counted from their end, of six products of order i ("next": of order i + 1):
    ///
    /// ```text
    /// left:   θ̇       θ̇       θ̇    D, next   X        Σ φᵀF w
    /// right:  cos θ   sin θ   θ̇    θ̇         weight   sin θ
    /// ```
    factors: [Factors; 2],
    /// θ̇² for the modes of a four, from the end.
    square: GroupSeries,
}

/// Numbers of modes side by side: of four, or of one.
pub(crate) trait Abreast:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + AddAssign
    + SubAssign
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + 'static
{
    /// How many modes.
    const COUNT: usize;

    /// Modes of a structure: an array if their number is known, which spares loops.
    type Groups: AsMut<[ModeGroup<Self>]> + Clone + Debug + Send;

    fn groups(modes: &[Mode]) -> Self::Groups;

    /// The number of each.
    fn each(number: impl Fn(usize) -> f64) -> Self;

    fn sum(self) -> f64;

    /// Writes the numbers to `modes`, from mode `first` on.
    fn put(self, modes: &mut Modes, first: usize);
}

impl Abreast for f64 {
    const COUNT: usize = 1;

    type Groups = [ModeGroup<f64>; 1];

    fn groups(modes: &[Mode]) -> [ModeGroup<f64>; 1] {
        [ModeGroup::new((0, modes))]
    }

    #[inline(always)]
    fn each(number: impl Fn(usize) -> f64) -> f64 {
        number(0)
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        self
    }

    #[inline(always)]
    fn put(self, modes: &mut Modes, first: usize) {
        modes.set(first, self);
    }
}

impl Abreast for f64x4 {
    const COUNT: usize = 4;

    type Groups = Vec<ModeGroup>;

    fn groups(modes: &[Mode]) -> Vec<ModeGroup> {
        modes.chunks(4).enumerate().map(ModeGroup::new).collect()
    }

    #[inline(always)]
    fn each(number: impl Fn(usize) -> f64) -> f64x4 {
        f64x4::new([0, 1, 2, 3].map(number))
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        self.reduce_add()
    }

    #[inline(always)]
    fn put(self, modes: &mut Modes, first: usize) {
        modes.set_four(first, self);
    }
}

/// Coefficients for modes side by side.
pub(super) type GroupSeries<V = f64x4> = [V; MAX_ORDER + 1];

/// Four modes side by side, or one; modes that are none have no mass and stay at rest.
#[derive(Clone, Debug)]
pub(crate) struct ModeGroup<V = f64x4> {
    /// The number of the first mode.
    pub first: usize,
    pub mass: V,
    pub share: V,
    pub height: V,
    /// μ h.
    pub arm: V,
    /// k/μ.
    pub stiffness: V,
    /// c/μ in full contact.
    pub damping: V,
    /// The newest coefficients of u and u̇.
    pub motion: [V; 2],
    /// Force over mass, and its change over the span.
    pub push: [V; 2],
    /// e + w θ̇² of the newest order.
    pub resistance: V,
    /// w.
    pub lever: GroupSeries<V>,
    /// μ w, from the end.
    heavy: GroupSeries<V>,
}

impl<V: Abreast> ModeGroup<V> {
    pub fn new((place, modes): (usize, &[Mode])) -> ModeGroup<V> {
        let both = |of: fn(&Mode) -> f64| V::each(|i| modes.get(i).map_or(0.0, of));
        ModeGroup {
            first: V::COUNT * place,
            mass: both(|mode| mode.mass),
            share: both(|mode| mode.share),
            height: both(|mode| mode.height),
            arm: both(|mode| mode.mass * mode.height),
            stiffness: both(|mode| mode.stiffness / mode.mass),
            damping: both(|mode| mode.damping / mode.mass),
            motion: Default::default(),
            push: Default::default(),
            resistance: V::default(),
            lever: [V::default(); MAX_ORDER + 1],
            heavy: [V::default(); MAX_ORDER + 1],
        }
    }

    /// Σ a_i b_{k−i} over the first terms of `a`, with b kept from its end.
    #[inline(always)]
    pub fn product(a: &[V], b: &[V]) -> V {
        let mut sum = V::default();
        a.iter().zip(b).for_each(|(a, b)| sum += *a * *b);
        sum
    }

    /// Puts w in order 0.
    #[inline(always)]
    pub fn start(&mut self, lever: V) -> V {
        let heavy = self.mass * lever;
        (self.lever[0], self.heavy[MAX_ORDER]) = (lever, heavy);
        heavy
    }

    /// Puts −u in order `k` of w, and returns that order of μ w² and μ w.
    #[inline(always)]
    pub fn next(&mut self, k: usize, per: f64) -> [V; 2] {
        let ModeGroup { lever, heavy, .. } = self;
        lever[k] = self.motion[1] * -per;
        heavy[MAX_ORDER - k] = self.mass * lever[k];
        // both halves of Σ w_i μ w_{k−i} are the same
        let half = k.div_ceil(2);
        let mut square = ModeGroup::product(&lever[..half], &heavy[MAX_ORDER - k..]);
        square += square;
        if k.is_multiple_of(2) {
            square += lever[half] * heavy[MAX_ORDER - half];
        }
        [square, heavy[MAX_ORDER - k]]
    }
}

impl<Q: Coordinates> ManyModes<Q> {
    /// The structure of `subject`; at the level `rigid` the one mass turns rigidly with the base.
    pub(crate) fn new(subject: LevelSubject<Q>) -> ManyModes<Q> {
        let (structure, detail) = (&subject.structure, subject.detail);
        let (mut base, mut modes, mut vibration) = (*structure.base(), Q::modes(structure), structure.vibration());
        let mut rigid = None;
        if let (Detail::Rigid, &[Mode { mass: m, height: H, .. }]) = (detail, modes) {
            base = Base { m0: m + base.m0, S_res: m * H, J0: base.J0 + m * H * H, ..base };
            (modes, vibration) = (&[], Vibration { contact: base.p_l, rocking: [base.p_l; 2] });
            rigid = Some([m, H]);
        }
        let modes = modes.to_vec();
        let exact = |mode: &Mode| {
            let omega = mode.omega();
            ExactContact::new(Oscillator::new(omega, mode.damping / (2.0 * mode.mass * omega)))
        };
        let left = inertia(&base, &modes, Side::Right, |_| 0.0);
        let [springs, dampers] = Restraint::about(&base, Side::Right, &Dissipators::NEW).rates(left);
        let [_, highest] = vibration.rocking;
        let fastest = (highest * highest + springs).sqrt().max(base.p_l).max(dampers);
        let has_flow = detail != Detail::Nonlinear && rigid.is_none();
        ManyModes {
            contact: has_flow.then(|| modes.iter().map(exact).collect()),
            radius: (base.J_P / base.m_t).sqrt(),
            left,
            quickening: base.J_P / left,
            longest_span: LONGEST_SPAN / fastest,
            scratch: RefCell::new(Box::new(Scratch {
                fours: f64x4::groups(&modes),
                factors: [[NO_ROW; MAX_ORDER + 1]; 2],
                square: [f64x4::ZERO; MAX_ORDER + 1],
            })),
            modes,
            subject,
            base,
            rigid,
            vibration,
        }
    }

    /// Whether the structure has no modes.
    pub(crate) fn is_rigid(&self) -> bool {
        self.modes.is_empty()
    }

    /// The structure as far as uplift depends on it.
    fn standing(&self) -> Liftable<'_> {
        let ManyModes { base, modes, rigid, .. } = self;
        let has_constant_inertia = self.subject.detail.angles() == Angles::Small;
        Liftable { base, modes, rigid: *rigid, lean: 1.0, has_constant_inertia }
    }

    /// The root of the mean square of a velocity or an acceleration over all mass, by `of` each mode.
    fn size(&self, of: impl Fn(usize, &Mode) -> f64) -> f64 {
        let square = |(j, mode): (usize, &Mode)| mode.mass * of(j, mode) * of(j, mode);
        (self.modes.iter().enumerate().map(square).sum::<f64>() / self.base.m_t).sqrt()
    }

    /// The truncation that `start` requires over a step of `span` s, while rocking or not.
    #[inline]
    fn truncation(&self, start: &Start<Q>, span: f64, is_rocking: bool) -> Truncation<Q> {
        let &Start { ref state, a_g, ref a_top, local_error, .. } = start;
        let (&Base { m_t, g, tan_alpha_cg, .. }, vibration) = (&self.base, self.vibration);
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
            u_dot: Q::each(&self.subject.structure, |_, mode| local_error * velocity * (m_t / mode.mass).sqrt()),
            theta_dot: if is_rocking { local_error * theta_dot } else { 0.0 },
        }
    }

    /// Writes the motion in full contact into `arc` (M1).
    fn resting(&self, start: &Start<Q>, arc: &mut Arc<Q>) {
        let Start { state, a_top, interval, .. } = start;
        let span = interval.min(LONGEST_SPAN / self.vibration.rocking[1]);
        let fours = &mut self.scratch.borrow_mut().fours;
        for four in fours.iter_mut() {
            let j = four.first;
            four.motion = [state.u.four(j), state.u_dot.four(j)];
            four.push = [a_top.value.four(j), a_top.slope.four(j) * span];
        }
        let truncation = self.truncation(start, span, false);
        arc.expand(state, span, &truncation, |arc, k, per| {
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
    fn rocking(&self, side: Side, start: &Start<Q>, arc: &mut Arc<Q>) {
        let Start { state, a_g, a_top, a_v, .. } = start;
        let &Base { m0, J0, S_res, B, g, c_ratio, .. } = &self.base;
        let span = start.interval.min(self.longest_span);
        let mut ties = self.ties(side, start);
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
        let [on_rest, rest_slope] =
            [(a_g.value, a_top.value), (a_g.slope, a_top.slope)].map(|(a_g, a_top)| self.standing().rest(a_g, &a_top));
        is_pushed |= [on_rest, rest_slope] != [[0.0; 2]; 2];
        // Σ φᵀF w + sB F_res
        let pushes = |fours: &[ModeGroup], k: usize| {
            let mut sum = f64x4::ZERO;
            for ModeGroup { mass, push, lever, .. } in fours {
                sum += mass * (push[0] * lever[k] + if k > 0 { push[1] * lever[k - 1] } else { f64x4::ZERO });
            }
            sum.reduce_add() + pivot * [on_rest[0], rest_slope[0] * span].get(k).unwrap_or(&0.0)
        };
        let truncation = self.truncation(start, span, true);
        arc.expand(state, span, &truncation, |arc, k, per| {
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
                products::<3>(left, right, (&newest_left, &newest_right), n);
            square[MAX_ORDER - n] = f64x4::splat(turning);
            let mut moment = f64x4::ZERO;
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                let elastic = four.stiffness * u + four.damping * c_ratio * u_dot;
                four.resistance = ModeGroup::product(&four.lever[..k], &square[MAX_ORDER - n..]) + elastic;
                moment += four.arm * four.resistance;
            }
            let mut moment = moment.reduce_add() - weight_moment + push_moment + S_res * fall;
            if is_pushed {
                moment += on_rest[1] * cos + rest_slope[1] * span * cos_before;
            }
            if let Some(ties) = &mut ties {
                moment -= ties.next(&arc.theta_dot, n, per);
            }
            theta_dot = per_inertia * (moment * per - known);
            for four in fours.iter_mut() {
                let j = four.first;
                let mut along = four.share * fall - four.resistance;
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

    /// Writes the motion of a structure without modes while rocking about `side` into `arc` (M9). D and X do not change, and two products
    /// are left. This takes two thirds of the instructions of [`ManyModes::rocking`] without modes.
    fn rocking_rigidly(&self, side: Side, start: &Start<Q>, arc: &mut Arc<Q>) {
        let Start { state, a_g, a_top, a_v, .. } = start;
        let &Base { m_t, S_res, B, g, .. } = &self.base;
        let span = start.interval.min(self.longest_span);
        let mut ties = self.ties(side, start);
        let (pivot, per_inertia) = (side.sign() * B, 1.0 / self.left);
        // the moment by sin θ and cos θ, and their slopes
        let moment = |g: f64, a_g: f64, a_top: &Q| {
            let [force, height] = self.standing().rest(a_g, a_top);
            [S_res * g + pivot * (force - m_t * a_g), height - S_res * a_g - pivot * m_t * g].map(|of| of * per_inertia)
        };
        let by = moment(g + a_v.value, a_g.value, &a_top.value);
        let slopes = moment(a_v.slope, a_g.slope, &a_top.slope).map(|of| of * span);
        let Scratch { factors: [left, right], .. } = &mut **self.scratch.borrow_mut();
        let (mut theta_dot, mut before) = (state.theta_dot, [0.0; 2]);
        let mut turn = <[f64; 2]>::from(libm::sincos(state.theta));
        let truncation = self.truncation(start, span, true);
        arc.expand(state, span, &truncation, |arc, k, per| {
            let [sin, cos] = turn;
            let (newest_left, newest_right) = (row([theta_dot; 6]), row([cos, sin, 0.0, 0.0, 0.0, 0.0]));
            (left[k - 1][0], right[MAX_ORDER + 1 - k][0]) = (newest_left[0], newest_right[0]);
            let [sin_rate, minus_cos_rate, ..] = products::<1>(left, right, (&newest_left, &newest_right), k - 1);
            let mut theta_ddot = by[0] * sin + by[1] * cos + slopes[0] * before[0] + slopes[1] * before[1];
            if let Some(ties) = &mut ties {
                theta_ddot -= per_inertia * ties.next(&arc.theta_dot, k - 1, per);
            }
            (theta_dot, before, turn) = (theta_ddot * per, turn, [sin_rate * per, -minus_cos_rate * per]);
            theta_dot
        });
    }

    /// The moment of the ties about `side` as a series, if there are ties.
    fn ties(&self, side: Side, start: &Start<Q>) -> Option<MomentSeries> {
        let &LevelSubject { is_tied, detail, .. } = &self.subject;
        is_tied
            .then(|| Restraint::about(&self.base, side, start.dissipators).series(detail.angles(), start.state.theta))
    }

    /// Writes the motion while rocking about `side` by small angles into `arc`. From (M10) and (M11), with e = (c u̇ + k u)/μ,
    ///
    /// ```text
    /// ü + h θ̈ = −e + S g θ − a,      (J_P − Σ μ h²) θ̈ = Σ (μ h e + Γ g u) − s m_t g B + S_res (g θ − a_g) − ties
    /// ```
    fn rocking_little(&self, side: Side, start: &Start<Q>, arc: &mut Arc<Q>) {
        let Start { state, a_top, a_v, .. } = start;
        let &Base { m_t, S_res, B, g, c_ratio, .. } = &self.base;
        let span = start.interval.min(self.longest_span);
        let mut ties = self.ties(side, start);
        let (g, lift, pivot) = (g + a_v.value, a_v.slope * span, side.sign() * B);
        let fours = &mut self.scratch.borrow_mut().fours;
        for four in fours.iter_mut() {
            let j = four.first;
            four.motion = [state.u.four(j), state.u_dot.four(j)];
            four.push = [a_top.value.four(j), a_top.slope.four(j) * span];
        }
        let rest = self.standing().moment_of_rest_over(start);
        let rigid = [rest.value, rest.slope * span];
        let mut before = f64x4::ZERO; // Σ Γ u of the order before
        let truncation = self.truncation(start, span, true);
        arc.expand(state, span, &truncation, |arc, k, per| {
            let n = k - 1;
            let of_order = |values: [f64; 2]| values.get(n).copied().unwrap_or(0.0);
            let weight = of_order([g, lift]);
            let lean = g * arc.theta[n] + if n > 0 { lift * arc.theta[n - 1] } else { 0.0 };
            let (mut moment, mut offset) = (f64x4::ZERO, f64x4::ZERO);
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                four.resistance = four.stiffness * u + four.damping * c_ratio * u_dot;
                moment += four.arm * four.resistance;
                offset += four.mass * four.share * u;
            }
            let mut moment = (moment + offset * g + before * lift).reduce_add() - pivot * m_t * weight;
            moment += S_res * lean + of_order(rigid);
            before = offset;
            if let Some(ties) = &mut ties {
                moment -= ties.next(&arc.theta_dot, n, per);
            }
            let theta_dot = moment / self.left * per;
            for four in fours.iter_mut() {
                let mut along = four.share * lean - four.resistance;
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

impl<Q: Coordinates> Level<Q> for ManyModes<Q> {
    fn subject(&self) -> &LevelSubject<Q> {
        &self.subject
    }

    fn boxed(&self) -> Box<dyn Level<Q>> {
        Box::new(self.clone())
    }

    fn leap(&self, phase: Phase, start: &Start<Q>) -> Option<State<Q>> {
        let (Phase::FullContact, Some(contact)) = (phase, &self.contact) else { return None };
        let hold = self.liftable().map_or(f64::INFINITY, |liftable| liftable.least_hold(start));
        full_contact::leap(contact, start, hold, |j| self.modes[j].height * self.modes[j].stiffness)
    }

    fn contact(&self) -> Option<&[ExactContact]> {
        self.contact.as_deref()
    }

    fn series(&self, phase: Phase, start: &Start<Q>, arc: &mut Arc<Q>) {
        match phase {
            Phase::Rocking(side) if self.subject.detail == Detail::Linear => self.rocking_little(side, start, arc),
            Phase::Rocking(side) if self.is_rigid() => self.rocking_rigidly(side, start, arc),
            Phase::Rocking(side) => self.rocking(side, start, arc),
            Phase::FullContact | Phase::Overturned(_) | Phase::OnGround(_) if self.is_rigid() => {
                let nothing = Truncation { u_dot: Q::ZERO, theta_dot: 0.0 };
                let rest = self.admissible(Phase::FullContact, start.state);
                arc.expand(&rest, start.interval, &nothing, |_, _, _| 0.0);
            }
            Phase::FullContact | Phase::Overturned(_) | Phase::OnGround(_) => self.resting(start, arc),
        }
    }

    fn is_singular(&self, phase: Phase, state: &State<Q>) -> bool {
        let (&Base { m_t, J0, B, .. }, Phase::Rocking(side)) = (&self.base, phase) else { return false };
        let inertia = || inertia(&self.base, &self.modes, side, |j| state.u.of(j));
        self.subject.detail != Detail::Linear && inertia() < LEAST_INERTIA * (J0 + m_t * B * B)
    }

    fn liftable(&self) -> Option<Liftable<'_>> {
        (self.subject.detail != Detail::FixedBase).then(|| self.standing())
    }

    fn admissible(&self, phase: Phase, state: State<Q>) -> State<Q> {
        let state = if phase.properties().is_down { State { theta: 0.0, theta_dot: 0.0, ..state } } else { state };
        if self.is_rigid() { State { u: Q::ZERO, u_dot: Q::ZERO, ..state } } else { state }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::instant::Instant;
    use crate::mechanics::lateral::Lateral;
    use crate::mechanics::load::Load;
    use crate::mechanics::reactions::Reactions;
    use crate::structure::description::tests::three_storeys;
    use crate::structure::gauge::Gauge;
    use crate::structure::ground::MOST_POINTS;
    use crate::structure::mode::Modes;
    use crate::{Body, Parameters, Structure};
    use approx::assert_relative_eq;

    fn level(frame: &Structure, detail: Detail) -> ManyModes<Modes> {
        let (structure, first) = (frame.clone(), RefCell::default());
        ManyModes::new(LevelSubject { structure, local_error: 1e-16, is_tied: true, detail, first })
    }

    /// The distance from uplift is the larger of what (M3) misses and of −s D θ̈, by the equations of rocking, under all loads.
    #[test]
    fn the_uplift_margin_follows_from_the_equations_of_rocking() {
        let frame = three_storeys().keeping(2).unwrap();
        let tied = Parameters { P_0: 2e5, k_t: 1e6, xi_d: 0.5, c_d: 1e4, k_d: 1e7, F_y: 4e4, ..frame.parameters() };
        let frame = frame.with(Parameters { c_ratio: 1.3, ..tied }).unwrap();
        let &Base { m_t, S_res, B, g, .. } = frame.base();
        let dissipators = Dissipators { plastic: [2e-3, -1e-3], ..Dissipators::NEW };
        let level = level(&frame, Detail::Nonlinear);
        let weight = (m_t * g + frame.base().ties.P_0) * B;
        for (scale, a_v) in [(1.0, -1.5), (-1.0, 2.5), (0.2, 4.0)] {
            let [u, u_dot] = [[2.5, -1.5], [200.0, 50.0]].map(|of| Modes::new(&of.map(|it| scale * it)));
            let state = State { u, u_dot, theta: 0.0, theta_dot: 0.0 };
            let load = Load { a_g: 0.7, F_t: Modes { rest: [6e4, -9e4], ..Modes::new(&[90.0, 50.0]) }, a_v };
            let kept = (&dissipators, &[0.0; MOST_POINTS]);
            let springs = Modes::sum(&frame, |j, mode| mode.height * mode.stiffness * u.of(j)) - S_res * load.a_g - 9e4;
            let expected = [Side::Right, Side::Left].map(|side| {
                let residual = |(xi, e_p): (f64, f64)| -1e7 * e_p * (side.sign() * B - xi);
                let residual: f64 = [(0.5, 2e-3), (-0.5, -1e-3)].map(residual).iter().sum();
                let held = m_t * (g + a_v) * B + 2e5 * B + side.sign() * residual;
                let inertia = inertia(frame.base(), frame.modes(), side, |j| u.of(j));
                let turns = level.accelerations(Phase::Rocking(side), (&state, load), kept).theta_ddot * inertia;
                ((held - side.sign() * springs) / weight).max(-side.sign() * turns / weight)
            });
            let (found, side) = level.uplift_margin(&state, load, &dissipators);
            let least = if side == Side::Right { expected[0] } else { expected[1] };
            assert_relative_eq!(found, least, max_relative = 1e-9);
            assert!(found <= expected[0].min(expected[1]) + 1e-9, "{found} {expected:?}");
        }
    }

    /// Newton's law for a floor, for the moments about the pivot, and the shear of a storey as a sum, with mass that turns rigidly, and
    /// with modes whose rounding leaves next to none.
    #[test]
    fn gauges_and_reactions_follow_from_the_motion() {
        let (frame, more) = (three_storeys(), 1.0 + 3e-10);
        let &Body { m_s, S_1, I_2, .. } = frame.body();
        let body = Body { m_s: more * m_s, S_1: more * S_1, I_2: more * I_2, ..*frame.body() };
        let rounded = Structure::of_body(body, frame.modes(), frame.floors()).unwrap();
        [frame.keeping(2).unwrap(), rounded].into_iter().for_each(gauges_and_reactions_follow);
    }

    fn gauges_and_reactions_follow(frame: Structure) {
        let (level, floors) = (level(&frame, Detail::Nonlinear), frame.floors());
        let modes = |numbers: [f64; 3]| Modes::new(&numbers[..frame.modes().len()]);
        let (u, u_dot) = (modes([3.0, -2.0, 0.5]), modes([90.0, 30.0, -20.0]));
        let forces = [70e3, -40e3, 20e3];
        let load = frame.load(3.0, -1.5, &forces).unwrap();
        let turned = State { u, u_dot, theta: -0.2, theta_dot: 0.5 };
        for (phase, state) in
            [(Phase::Rocking(Side::Left), turned), (Phase::FullContact, State { theta: 0.0, theta_dot: 0.0, ..turned })]
        {
            let second = level.accelerations(phase, (&state, load), (&Dissipators::NEW, &[0.0; MOST_POINTS]));
            let x = Instant::<f64, Modes>::of(&frame, phase, &state, load);
            let Instant { turn, theta_dot, a_g, a_v, s, .. } = x;
            let x = Instant { theta_ddot: second.theta_ddot, ..x };
            let value = |gauge: &Gauge| gauge.at(&x);
            let (mut storey, gauges) = (0.0, frame.gauges());
            for (i, floor) in floors.iter().enumerate().rev() {
                let lever = f64::from(s) * frame.base().B - floor.displacement(&u);
                let along = floor.displacement(&second.u_ddot) + floor.height * second.theta_ddot;
                let expected = along + theta_dot * theta_dot * lever + a_g * turn.cos - a_v * turn.sin;
                assert_relative_eq!(value(&gauges.a[i]), expected, max_relative = 1e-12);
                storey += floor.mass * expected;
                assert_relative_eq!(value(&gauges.V[i]), storey, max_relative = 1e-12);
            }
            let reactions = Reactions::at(&x, &second);
            if let Phase::Rocking(_) = phase {
                assert_relative_eq!(reactions.R_m, x.pivot() * reactions.R_v, max_relative = 1e-11);
            } else {
                let weight = frame.base().g + a_v;
                let rigid = load.F_t.rest().unwrap_or_default()[1] - frame.base().S_res * a_g;
                let turns = Modes::sum(&frame, |j, mode| {
                    let elastic = mode.stiffness * u.of(j) + mode.damping * u_dot.of(j);
                    mode.height * elastic + mode.gamma * weight * u.of(j)
                });
                assert_relative_eq!(reactions.R_m, turns + rigid, max_relative = 1e-12);
                // the foundation carries its own a_g, and the masses carry the base shear
                let carried = value(&gauges.V_t) + frame.body().m0 * a_g - forces.iter().sum::<f64>();
                assert_relative_eq!(reactions.R_h, -carried, max_relative = 1e-12);
                let pushed: f64 = forces.iter().zip(floors).map(|(force, floor)| force * floor.height).sum();
                assert_relative_eq!(
                    value(&gauges.M_t),
                    -(reactions.R_m - weight * Modes::sum(&frame, |j, mode| mode.gamma * u.of(j)) - pushed),
                    max_relative = 1e-12
                );
            }
        }
    }
}
