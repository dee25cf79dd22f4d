//! A base with modes on [ground that gives](crate::structure::ground), at any rotation. The middle of the base is held horizontally.
//!
//! With F = γ sin θ − a_g cos θ, G = γ cos θ + a_g sin θ, γ = g + a_v + ÿ, μ = Σ Γ u, and e = (c u̇ + k u)/m of each mode of the mass m, the
//! height h and the part S in a translation:
//!
//! ```text
//! ü + h θ̈ + e = θ̇² u + S F + T cos θ                                              T = φᵀF/m of forces on floors          (F5)
//! d/dt (D θ̇) = Σ m h (e − θ̇² u) + μ G + S_res F − cos θ Σ ξ N + T_θ                D = J + Σ m u²                         (F4)
//! d²/dt² [m_t y + S_1 cos θ − μ sin θ] = Σ N − m_t (g + a_v)                                                              (F6)
//! ```
//!
//! T_θ = N_res cos θ − sin θ Σ u φᵀF. A tendon and dissipators are points that pull. An order takes eight products, three squares, and a
//! product and a square for each mode. Products run side by side, four and four; modes do, too, or there is one and it is a number. Two unknowns are left, θ̈ and γ, with E = μ cos θ + S_res sin θ and m* = Σ Γ S:
//!
//! ```text
//! | D         −E            | | θ̈ |   (F7)
//! | −E   m_t − m* sin² θ    | | γ |
//! ```

use crate::levels::level::{Level, LevelSubject};
use crate::levels::modes::{Abreast, GroupSeries, ModeGroup};
use crate::levels::nonlinear::add_product;
use crate::levels::start::{Start, Truncation};
use crate::mechanics::arc::Arc;
use crate::mechanics::contact::energy;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::restraint::{Kept, ties};
use crate::series::taylor::{LONGEST_SPAN, MAX_ORDER, add_each_product};
use crate::structure::ground::Footing;
use crate::structure::mode::{Mode, Modes};
use crate::{Base, Foundation, Friction, Phase, PressedPoints, State, Structure};
use std::cell::RefCell;
use wide::{f64x2, f64x4};

/// Part of the energy that certainly changes no contact that a structure at rest may have.
const AT_REST: f64 = 0.9;

/// A structure on ground that gives.
#[derive(Clone, Debug)]
pub(crate) struct OnGround<V: Abreast> {
    pub(super) subject: LevelSubject<Modes>,
    /// The longest span of a series, and of one of a base that slides, s.
    longest_span: f64,
    pub(super) longest_slide: f64,
    /// The lowest frequency, rad/s, and the radius of gyration √(J_P/m_t), m.
    lowest: f64,
    radius: f64,
    /// Energy above rest on ground that has not settled below which no point leaves it, or yields if it may, J.
    least_change: f64,
    /// Bounds over √(2E) at an energy E (J) above rest: of the horizontal force that the modes need, and of how the normal force changes.
    swings: [f64; 2],
    scratch: RefCell<Box<GroundScratch<V>>>,
}

/// The forces of the pressed points and of ties on the base as functions of its motion.
#[derive(Clone, Copy)]
pub(crate) struct Pushes {
    /// Σ N and Σ ξ N at y = sin θ = 0 and at rest.
    push: [f64; 2],
    /// N and Σ ξ N by y, sin θ, ẏ and θ̇ cos θ.
    by: [f64x2; 4],
    /// The power of the dashpots of elastic points is taken (ẏ − lever θ̇ cos θ)² and what is left for (θ̇ cos θ)².
    pub taken: f64,
    pub lever: f64,
    pub left_for_turning: f64,
    k: [f64; 3],
    c: [f64; 3],
}

impl Pushes {
    /// Of the points of `ground` in this `contact`, which have `settled` by so much.
    pub fn of(ground: &Foundation, contact: PressedPoints, settled: &[f64]) -> Pushes {
        // Σ N = push − k y + k ξ sin θ − c ẏ + c ξ θ̇ cos θ, and Σ ξ N
        let (mut k, mut c, mut push) = ([0.0; 3], [0.0; 3], [0.0; 2]);
        for (i, point) in ground.points.iter().enumerate().filter(|(i, _)| contact.is_pressed(*i)) {
            if contact.yields(i) {
                push = [push[0] + point.q, push[1] + point.xi * point.q];
                continue;
            }
            add_moments(&mut k, point.xi, point.k);
            add_moments(&mut c, point.xi, point.c);
            if ground.yields {
                let force = point.k * settled[i];
                push = [push[0] - force, push[1] - point.xi * force];
            }
        }
        let lever = if c[0] > 0.0 { c[1] / c[0] } else { 0.0 };
        Pushes { push, by: forces_by(k, c), taken: c[0], lever, left_for_turning: c[2] - lever * c[1], k, c }
    }

    /// Coefficient `k` of N and Σ ξ N, from this coefficient of the footing and of its rates.
    #[inline]
    pub fn forces(&self, [of, rates]: [Footing; 2], k: usize) -> [f64; 2] {
        let push = if k == 0 { self.push } else { [0.0; 2] };
        let motion = [of.y, of.sin, rates.y, rates.sin];
        self.by.iter().zip(motion).fold(f64x2::new(push), |sum, (by, of)| sum + *by * of).to_array()
    }

    /// These with the ties of `subject`.
    pub fn with_ties(self, subject: &LevelSubject<Modes>, start: &Start<Modes>, contact: PressedPoints) -> Pushes {
        let Pushes { mut push, mut k, mut c, .. } = self;
        if !subject.is_tied {
            return self;
        }
        let (base, y_s) = (subject.structure.base(), subject.structure.ground().y_s);
        for tie in ties(base, start.dissipators, y_s, contact.is_slack) {
            add_moments(&mut k, tie.lever, tie.stiffness);
            add_moments(&mut c, tie.lever, tie.damping);
            push = [push[0] - tie.force, push[1] - tie.lever * tie.force];
        }
        Pushes { push, by: forces_by(k, c), ..self }
    }
}

/// The bounds [`OnGround::swings`]. With w = u less its place at rest at the same rotation, the friction that sticking needs is Σ Γ (k w +
/// c u̇)/m but for products of the motion; mass that no mode carries adds θ̈, which a bound `fastest` (1/s) of all rates bounds.
fn swings(structure: &Structure, fastest: f64) -> [f64; 2] {
    let (&Base { m_t, J0, S_res, .. }, ground, modes) = (structure.base(), structure.ground(), structure.modes());
    let springs =
        modes.iter().map(|mode| mode.gamma * mode.gamma * mode.stiffness / (mode.mass * mode.mass)).sum::<f64>();
    let damper =
        |mode: &Mode| mode.gamma * mode.damping / mode.mass * (1.0 / mode.mass.sqrt() + mode.height / J0.sqrt());
    let along = match S_res == 0.0 {
        true => springs.sqrt() + modes.iter().map(|mode| damper(mode).abs()).sum::<f64>(),
        false => 4.0 * fastest * m_t.sqrt(),
    };
    let dashpots = ground.points.iter().map(|point| point.c).sum::<f64>();
    [along, ground.sum(0).sqrt() + dashpots / m_t.sqrt()]
}

/// Adds `of` at ξ to its sums with 1, ξ and ξ².
fn add_moments(sums: &mut [f64; 3], xi: f64, of: f64) {
    *sums = [sums[0] + of, sums[1] + of * xi, sums[2] + of * xi * xi];
}

fn forces_by(k: [f64; 3], c: [f64; 3]) -> [f64x2; 4] {
    [[-k[0], -k[1]], [k[1], k[2]], [-c[0], -c[1]], [c[1], c[2]]].map(f64x2::new)
}

/// Two rows of four factors of an order.
type EightRow = [f64x4; 2];

/// Room for the series of one step.
#[derive(Clone, Debug)]
struct GroundScratch<V: Abreast> {
    fours: V::Groups,
    /// Row i of the left factors, and row j of the right ones counted from their end, of eight products of order i + j:
    ///
    /// ```text
    /// left   θ̇, θ̇, θ̇, μ of i + 1                  from i = 1 on   γ of i − 1, γ of i − 1, μ, cos θ
    /// right  cos θ, sin θ, Σ m u², sin θ of j + 1                  sin θ of j + 1, cos θ of j + 1, G, Σ ξ N
    /// ```
    left: [EightRow; MAX_ORDER + 1],
    right: [EightRow; MAX_ORDER + 1],
    /// θ̇, the rate at the middle of the pressed dashpots, and θ̇ cos θ, to be squared.
    squared: [f64x4; MAX_ORDER + 1],
    /// Σ u φᵀF, if there are forces.
    pushed: [f64; MAX_ORDER + 1],
    /// θ̇² for the modes of a four, from the end.
    square: GroupSeries<V>,
}

impl<V: Abreast> OnGround<V> {
    /// The structure of `subject`, which stands on ground that gives.
    pub(crate) fn new(subject: LevelSubject<Modes>) -> OnGround<V> {
        let structure = &subject.structure;
        let (base, body, modes) = (structure.base(), structure.body(), structure.modes());
        let foundation = structure.ground();
        let frequencies = foundation.frequencies(base, body, modes);
        let fastest = foundation.fastest(&frequencies, base, modes);
        OnGround {
            longest_span: LONGEST_SPAN / fastest,
            longest_slide: LONGEST_SPAN / foundation.fastest_sliding(fastest, base, modes),
            lowest: frequencies[0],
            radius: (base.J_P / base.m_t).sqrt(),
            least_change: match foundation.yields {
                true => foundation.least_yield(structure, [foundation.y_s, 0.0], &|_| 0.0),
                false => foundation.least_lift(base, body, modes),
            },
            swings: swings(structure, fastest),
            scratch: RefCell::new(Box::new(GroundScratch {
                fours: V::groups(modes),
                left: [[f64x4::ZERO; 2]; MAX_ORDER + 1],
                right: [[f64x4::ZERO; 2]; MAX_ORDER + 1],
                squared: [f64x4::ZERO; MAX_ORDER + 1],
                pushed: [0.0; MAX_ORDER + 1],
                square: [V::default(); MAX_ORDER + 1],
            })),
            subject,
        }
    }

    /// The truncation that `start` requires over a step of `span` s; the power that the ground takes counts if the base moves over the ground,
    /// or into it.
    pub(super) fn truncation(&self, start: &Start<Modes>, span: f64, moves_on: bool) -> Truncation<Modes> {
        let (structure, state) = (&self.subject.structure, &start.state);
        let (&Base { m_t, g, tan_alpha_cg, .. }, ground) = (structure.base(), structure.ground());
        let size = |of: &dyn Fn(usize, f64) -> f64| {
            let modes = structure.modes().iter().enumerate();
            (modes.map(|(j, mode)| mode.mass * of(j, mode.stiffness / mode.mass).powi(2)).sum::<f64>() / m_t).sqrt()
        };
        let load = size(&|j, _| start.a_top.value.of(j)) + span * size(&|j, _| start.a_top.slope.of(j));
        let forcing = size(&|j, square| square * state.u.of(j)) + load + g * tan_alpha_cg;
        let lift = start.a_v.value.abs() + span * start.a_v.slope.abs() + state.u_dot.footing(ground).y.abs();
        let velocity = size(&|j, _| state.u_dot.of(j)) + lift + span.min(1.0 / self.lowest) * forcing;
        let theta_dot = start.local_error * (state.theta_dot.abs() + velocity / self.radius);
        let power = if moves_on { start.local_error * m_t * velocity * velocity / span } else { f64::INFINITY };
        let velocity = start.local_error * velocity;
        let mut u_dot = Modes::each(structure, |_, mode| velocity * (m_t / mode.mass).sqrt());
        u_dot.set_footing(ground, Footing { y: velocity, sin: theta_dot, taken: power });
        ground.slide().into_iter().for_each(|place| u_dot.set(place, velocity));
        Truncation { u_dot, theta_dot }
    }

    /// Writes the motion with these pressed points into `arc` (F4–F7).
    fn motion(&self, contact: PressedPoints, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let &Start { ref state, ref a_g, ref a_top, ref a_v, settled, .. } = start;
        let structure = &self.subject.structure;
        let &Base { m_t, J0, S_res, g, .. } = structure.base();
        let (under, modes) = (structure.ground(), structure.modes().len());
        let slide = under.slide();
        let span = start.interval.min(self.longest_span).min(under.longest_yielding(contact));
        let pushes @ Pushes { taken, lever, left_for_turning, .. } =
            Pushes::of(under, contact, settled).with_ties(&self.subject, start, contact);
        let (ground, mut weight) = ([a_g.value, a_g.slope * span], [g + a_v.value, a_v.slope * span]);
        let GroundScratch { fours, left, right, squared, pushed, square } = &mut **self.scratch.borrow_mut();
        let fours = fours.as_mut();
        let (mut inertia, mut offset, mut carried, mut is_pushed) = (V::default(), V::default(), V::default(), false);
        for four in fours.iter_mut() {
            let of = |q: &Modes| V::each(|i| if four.first + i < modes { q.of(four.first + i) } else { 0.0 });
            let heavy = four.share * four.mass;
            (four.motion, four.push) = ([of(&state.u), of(&state.u_dot)], [of(&a_top.value), of(&a_top.slope)]);
            four.push = [four.share * a_g.value - four.push[0], (four.share * a_g.slope - four.push[1]) * span];
            is_pushed |= four.push != [V::default(); 2];
            inertia += four.motion[0] * four.start(-four.motion[0]);
            offset += heavy * four.motion[0];
            carried += heavy * four.share;
        }
        let on_rest = [a_top.value, a_top.slope].map(|a_top| a_top.rest[1]);
        is_pushed |= on_rest != [0.0; 2];
        let on_rest = [on_rest[0], on_rest[1] * span];
        let (sin_0, cos_0) = libm::sincos(state.theta);
        let (offset_0, carried) = (offset.sum(), carried.sum());
        let (D, E, M_0) = (J0 - inertia.sum(), offset_0 * cos_0 + S_res * sin_0, m_t - carried * sin_0 * sin_0);
        let per_determinant = 1.0 / (D * M_0 - E * E);
        let [D, E, M_0] = [D, E, M_0].map(|of| of * per_determinant);
        let S_1 = structure.body().S_1;
        let (mut theta_dot, mut turning, mut turning_sin) =
            (state.theta_dot, state.theta_dot * cos_0, state.theta_dot * sin_0);
        let (mut sin, mut cos, [mut sin_before, mut cos_before]) = (sin_0, cos_0, [0.0; 2]);
        let (mut y, mut y_dot, mut gamma, mut offset) =
            (state.u.footing(under).y, state.u_dot.footing(under).y, 0.0, offset_0);
        let mut state = *state;
        state.u.set_footing(under, Footing { sin: sin_0, ..state.u.footing(under) });
        state.u_dot.set_footing(under, Footing { sin: turning, ..state.u_dot.footing(under) });
        let rest = |rate: &mut Modes| slide.into_iter().for_each(|place| rate.set(place, 0.0));
        rest(&mut state.u_dot);
        let truncation = self.truncation(start, span, contact.yields != 0);
        let per_span = 1.0 / span;
        arc.expand(&state, span, &truncation, |arc, order, per| {
            let (n, rate) = (order - 1, order as f64 * per_span);
            let (next_sin, next_cos) = (turning * per, -turning_sin * per);
            let [mut inertia, mut next_offset] = [V::default(); 2];
            for four in fours.iter_mut() {
                let [of_inertia, heavy] = four.next(order, per);
                inertia += of_inertia;
                next_offset -= four.share * heavy;
            }
            let next_offset = next_offset.sum();
            left[n][0] = f64x4::new([theta_dot, theta_dot, theta_dot, next_offset]);
            left[n][1] = f64x4::new([gamma, gamma, offset, cos]);
            let newest = [f64x4::new([next_cos, next_sin, inertia.sum(), next_sin]), f64x4::ZERO];
            right[MAX_ORDER - n][0] = newest[0];
            let mut sums = [f64x4::ZERO; 2];
            add_each_product!(add_product::<2, 2, _>, &mut sums, left, right, (&left[n], &newest), n);
            let [[turning_cos, sin_turning, spin, lean], [fall, hang, weighed, moved]] = sums.map(f64x4::to_array);
            squared[n] = f64x4::new([theta_dot, y_dot - lever * turning, turning, 0.0]);
            let half = order / 2;
            let mut squares = f64x4::ZERO;
            squared[..half].iter().zip(squared[n + 1 - half..=n].iter().rev()).for_each(|(a, b)| squares += a * b);
            squares += squares;
            if n % 2 == 0 {
                squares += squared[half] * squared[half];
            }
            let [turning_square, of_middle, of_turning, _] = squares.to_array();
            square[MAX_ORDER - n] = V::each(|_| turning_square);
            let mut power = taken * of_middle + left_for_turning * of_turning;
            if contact.yields != 0 {
                power += under.power_of_yielding(contact, settled, arc, n);
            }
            let rates = arc.u_dot[n].footing(under);
            arc.u_dot[n].set_footing(under, Footing { taken: power, ..rates });
            let [of, of_rates] = [[y, sin], [y_dot, turning]].map(|[y, sin]| Footing { y, sin, taken: 0.0 });
            let [N, M] = pushes.forces([of, of_rates], n);
            let fall = fall - (ground[0] * cos + ground[1] * cos_before);
            let hang = hang + ground[0] * sin + ground[1] * sin_before;
            let [mut moment, mut upwards] = [V::default(); 2];
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                let elastic = four.stiffness * u + four.damping * u_dot;
                four.resistance = ModeGroup::product(&four.lever[..order], &square[MAX_ORDER - n..]) + elastic;
                moment += four.arm * four.resistance;
                four.resistance = four.share * fall - four.resistance;
                if is_pushed {
                    four.resistance += four.push[0] * cos + four.push[1] * cos_before;
                }
                upwards += four.share * four.mass * four.resistance;
            }
            let mut moment = moment.sum() + offset_0 * hang + weighed + S_res * fall - cos_0 * M - moved - spin * rate;
            if is_pushed {
                let force = |of: usize, k: usize| {
                    fours.iter().map(move |four| (four.mass * four.push[of] * four.lever[k]).sum())
                };
                let before = if n > 0 { force(1, n - 1).sum() } else { 0.0 };
                pushed[n] = -(force(0, n).sum::<f64>() + before);
                let sines = right[MAX_ORDER + 1 - n..].iter().map(|row| row[0].to_array()[1]);
                moment -= pushed[n] * sin_0 + pushed[..n].iter().zip(sines).map(|(of, sin)| of * sin).sum::<f64>();
                moment += on_rest[0] * cos + on_rest[1] * cos_before;
            }
            let rise = S_1 * sin_turning + offset_0 * turning_cos + (n + 2) as f64 * per_span * lean;
            let upwards = N + rise * rate + sin_0 * upwards.sum();
            let theta_ddot = M_0 * moment + E * upwards;
            gamma = E * moment + D * upwards;
            right[MAX_ORDER - n][1] = f64x4::new([next_sin, next_cos, hang + gamma * cos_0, M]);
            theta_dot = theta_ddot * per;
            (y, y_dot) = (y_dot * per, (gamma - weight[0]) * per);
            weight = [weight[1], 0.0]; // of the next order
            let (new, new_rate) = (&mut arc.u[order], &mut arc.u_dot[order]);
            for four in fours.iter_mut() {
                let along = four.resistance + four.share * (sin_0 * gamma) - four.height * theta_ddot;
                four.motion = [four.motion[1] * per, along * per];
                four.motion[1].put(new_rate, four.first);
            }
            (turning, turning_sin) = (turning_cos + theta_dot * cos_0, sin_turning + theta_dot * sin_0);
            (sin_before, cos_before, sin, cos, offset) = (sin, cos, next_sin, next_cos, next_offset);
            new.set_footing(under, Footing { y, sin, taken: power * per });
            new_rate.set_footing(
                under,
                Footing { y: y_dot, sin: turning, taken: if contact.yields != 0 { power } else { 0.0 } },
            );
            rest(new_rate);
            theta_dot
        });
    }
}

impl<V: Abreast> Level<Modes> for OnGround<V> {
    #[inline(always)]
    fn subject(&self) -> &LevelSubject<Modes> {
        &self.subject
    }

    fn boxed(&self) -> Box<dyn Level<Modes>> {
        Box::new(self.clone())
    }

    fn longest_step(&self) -> f64 {
        self.longest_span
    }

    fn series(&self, phase: Phase, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let contact = phase.contact();
        match contact.friction {
            Friction::Sticks => self.motion(contact, start, arc),
            Friction::Slides(_) | Friction::Free => self.slide(contact, start, arc),
        }
    }

    /// `state` with the sine of its rotation.
    fn admissible(&self, phase: Phase, mut state: State<Modes>) -> State<Modes> {
        let ((sin, cos), ground) = (libm::sincos(state.theta), self.subject.structure.ground());
        state.u.set_footing(ground, Footing { sin, ..state.u.footing(ground) });
        state.u_dot.set_footing(ground, Footing { sin: state.theta_dot * cos, ..state.u_dot.footing(ground) });
        if let (Some(place), Friction::Sticks) = (ground.slide(), phase.contact().friction) {
            state.u_dot.set(place, 0.0);
        }
        state
    }

    /// Whether the energy above rest is too small to lift a point, to make one yield, or to make the base slide.
    fn stays_down(&self, state: &State<Modes>, kept @ (_, settled): Kept) -> bool {
        let structure = &self.subject.structure;
        let (ground, base) = (structure.ground(), structure.base());
        let of = |state: &State<Modes>| energy(structure, ground.contact(state, settled, base), state, kept);
        let (resting, room) = if settled.iter().any(|s| *s != 0.0) {
            let now = libm::sin(state.theta);
            let Some(rest @ [y, sin]) = ground.at_rest(structure, now, &|i| settled[i]) else { return false };
            let mut u = Modes::each(structure, |_, mode| base.g * mode.gamma * sin / mode.stiffness);
            ground.slide().into_iter().for_each(|place| u.set(place, state.u.of(place)));
            u.set_footing(ground, Footing { y, sin, taken: 0.0 });
            let resting = State { u, u_dot: Modes::parts(structure, 0.0), theta: libm::asin(sin), theta_dot: 0.0 };
            (resting, ground.least_yield(structure, rest, &|i| settled[i]))
        } else {
            let still = Modes::parts(structure, 0.0);
            (ground.begin(&State { u: still, u_dot: still, theta: 0.0, theta_dot: 0.0 }, base), self.least_change)
        };
        let room = match (ground.mu_c, state.u_dot.slide(ground)) {
            (Some(mu_c), Some(0.0)) => {
                let [along, down] = self.swings;
                let sines = libm::sin(state.theta).abs() + resting.u.footing(ground).sin.abs();
                room.min(0.5 * (mu_c * base.m_t * base.g / (along + down * (sines + mu_c))).powi(2))
            }
            (Some(_), _) => return false,
            (None, _) => room,
        };
        room > 0.0 && of(state) - of(&resting) < AT_REST * room
    }
}
