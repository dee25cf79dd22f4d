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
//! T_θ = N_res cos θ − sin θ Σ u φᵀF. A tendon and dissipators are points that pull. An order takes eleven products and two for each mode.
//! Four products run side by side. Two unknowns are left, θ̈ and γ, with E = μ cos θ + S_res sin θ and m* = Σ Γ S:
//!
//! ```text
//! | D         −E            | | θ̈ |   (F7)
//! | −E   m_t − m* sin² θ    | | γ |
//! ```

use crate::levels::level::{Level, Now, Subject, derivatives};
use crate::levels::modes::Four;
use crate::mechanics::contact::{energy, ties_on_ground};
use crate::mechanics::instant::Second;
use crate::mechanics::lateral::{Coordinates, Lateral, Modes};
use crate::mechanics::restraint::Dissipators;
use crate::series::taylor::{Arc, LONGEST_SPAN, MAX_ORDER, Start, Truncation};
use crate::{Base, Contact, Foundation, LinearLoad, Phase, State};
use std::cell::RefCell;
use wide::f64x4;

/// Part of the energy that certainly leaves all points pressed that a structure at rest may have.
const AT_REST: f64 = 0.9;

/// A structure on ground that gives.
#[derive(Clone, Debug)]
pub(crate) struct OnGround {
    subject: Subject,
    /// The longest span of a series, s.
    longest_span: f64,
    /// The lowest frequency, rad/s, and the radius of gyration √(J_P/m_t), m.
    lowest: f64,
    radius: f64,
    /// Energy above rest below which no point leaves the ground, J.
    least_lift: f64,
    scratch: RefCell<Box<Scratch>>,
    /// Room for the series of which only the first terms count.
    first: RefCell<Box<Arc<Modes>>>,
}

/// Left factors of four products of each order, and the right factors counted from their end.
type Rows = [[f64x4; MAX_ORDER + 2]; 2];

/// Room for the series of one step.
#[derive(Clone, Debug)]
struct Scratch {
    fours: Vec<Four>,
    /// Row i of the left factors, and row j of the right ones. The power is what the dashpots take.
    ///
    /// ```text
    /// ahead    left: θ̇, θ̇, θ̇, μ of i + 1            right: cos θ, sin θ, Σ m u², sin θ of j + 1
    /// behind   left: γ, γ, μ of i + 1, cos θ of i + 1      right: sin θ of j + 1, cos θ of j + 1, G, Σ ξ N
    /// same     left: θ̇, ẏ, θ̇ cos θ, Σ u φᵀF          right: θ̇, the power over ẏ, the power over θ̇ cos θ, sin θ
    /// ```
    ahead: Rows,
    behind: Rows,
    same: Rows,
    /// θ̇² for the modes of a four, from the end.
    square: [f64x4; MAX_ORDER + 1],
}

/// Puts the newest factors of order `n` and returns the sum over the orders from 0 to n of the products.
#[inline(always)]
fn products([left, right]: &mut Rows, n: usize, newest_left: [f64; 4], newest_right: [f64; 4]) -> [f64; 4] {
    (left[n], right[MAX_ORDER + 1 - n]) = (f64x4::new(newest_left), f64x4::new(newest_right));
    let mut sum = f64x4::ZERO;
    left[..=n].iter().zip(&right[MAX_ORDER + 1 - n..]).for_each(|(a, b)| sum += a * b);
    sum.to_array()
}

impl OnGround {
    /// The structure of `subject`, which stands on ground that gives.
    pub(crate) fn new(subject: Subject) -> OnGround {
        let structure = &subject.structure;
        let (base, body, modes) = (structure.base(), structure.body(), structure.modes());
        let foundation = structure.foundation().expect("it stands on ground that gives");
        let frequencies = foundation.frequencies(base, body, modes);
        let (highest, point) = (frequencies[frequencies.len() - 1], foundation.points[0]);
        let fastest = highest.max(point.c / point.k * highest * highest);
        let rows: Rows = [[f64x4::ZERO; MAX_ORDER + 2]; 2];
        OnGround {
            longest_span: LONGEST_SPAN / fastest,
            lowest: frequencies[0],
            radius: (base.J_P / base.m_t).sqrt(),
            least_lift: foundation.least_lift(base, body, modes),
            scratch: RefCell::new(Box::new(Scratch {
                fours: modes.chunks(4).enumerate().map(Four::new).collect(),
                ahead: rows,
                behind: rows,
                same: rows,
                square: [f64x4::ZERO; MAX_ORDER + 1],
            })),
            first: RefCell::default(),
            subject,
        }
    }

    fn foundation(&self) -> &Foundation {
        self.subject.structure.foundation().expect("it stands on ground that gives")
    }

    /// The truncation that `start` requires over a step of `span` s.
    fn truncation(&self, start: &Start<Modes>, span: f64) -> Truncation<Modes> {
        let (structure, state) = (&self.subject.structure, &start.state);
        let (&Base { m_t, g, tan_alpha_cg, .. }, place) = (structure.base(), self.foundation().place);
        let size = |of: &dyn Fn(usize, f64) -> f64| {
            let modes = structure.modes().iter().enumerate();
            (modes.map(|(j, mode)| mode.mass * of(j, mode.stiffness / mode.mass).powi(2)).sum::<f64>() / m_t).sqrt()
        };
        let load = size(&|j, _| start.a_top.value.of(j)) + span * size(&|j, _| start.a_top.slope.of(j));
        let forcing = size(&|j, square| square * state.u.of(j)) + load + g * tan_alpha_cg;
        let lift = start.a_v.value.abs() + span * start.a_v.slope.abs() + state.u_dot.of(place).abs();
        let velocity = size(&|j, _| state.u_dot.of(j)) + lift + span.min(1.0 / self.lowest) * forcing;
        let theta_dot = start.local_error * (state.theta_dot.abs() + velocity / self.radius);
        let velocity = start.local_error * velocity;
        let mut u_dot = Modes::each(structure, |_, mode| velocity * (m_t / mode.mass).sqrt());
        [velocity, theta_dot, f64::INFINITY].iter().enumerate().for_each(|(i, limit)| u_dot.set(place + i, *limit));
        Truncation { u_dot, theta_dot }
    }

    /// Writes the motion with these pressed points into `arc` (F4–F7).
    fn motion(&self, contact: Contact, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let Start { state, a_g, a_top, a_v, .. } = start;
        let structure = &self.subject.structure;
        let &Base { m_t, J0, S_res, g, .. } = structure.base();
        let &Foundation { ref points, rest, place: at, .. } = self.foundation();
        let span = start.interval.min(self.longest_span);
        // Σ N = push − k y + k ξ sin θ − c ẏ + c ξ θ̇ cos θ, and Σ ξ N
        let (mut k, mut taken, mut push) = ([0.0; 3], [0.0; 3], [0.0; 2]);
        let moments =
            |sums: &mut [f64; 3], xi: f64, of: f64| *sums = [sums[0] + of, sums[1] + of * xi, sums[2] + of * xi * xi];
        for (_, point) in points.iter().enumerate().filter(|(i, _)| contact.is_pressed(*i)) {
            moments(&mut k, point.xi, point.k);
            moments(&mut taken, point.xi, point.c);
        }
        let mut c = taken;
        if self.subject.is_tied {
            for tie in ties_on_ground(structure.base(), rest, start.dissipators, contact) {
                moments(&mut k, tie.lever, tie.stiffness);
                moments(&mut c, tie.lever, tie.damping);
                push = [push[0] - tie.force, push[1] - tie.lever * tie.force];
            }
        }
        let (ground, weight) = ([a_g.value, a_g.slope * span], [g + a_v.value, a_v.slope * span]);
        let scratch = &mut **self.scratch.borrow_mut();
        let Scratch { fours, ahead, behind, same, square } = scratch;
        let (mut inertia, mut offset, mut carried, mut is_pushed) = (f64x4::ZERO, f64x4::ZERO, f64x4::ZERO, false);
        for four in fours.iter_mut() {
            let of = |q: &Modes| {
                f64x4::new([0, 1, 2, 3].map(|i| if four.first + i < at { q.of(four.first + i) } else { 0.0 }))
            };
            let heavy = four.share * four.mass;
            (four.motion, four.push) = ([of(&state.u), of(&state.u_dot)], [of(&a_top.value), of(&a_top.slope)]);
            four.push = [four.share * a_g.value - four.push[0], (four.share * a_g.slope - four.push[1]) * span];
            is_pushed |= four.push != [f64x4::ZERO; 2];
            inertia += four.motion[0] * four.start(-four.motion[0]);
            offset += heavy * four.motion[0];
            carried += heavy * four.share;
        }
        let on_rest = [a_top.value, a_top.slope].map(|a_top| a_top.rest().unwrap_or_default()[1]);
        is_pushed |= on_rest != [0.0; 2];
        let on_rest = [on_rest[0], on_rest[1] * span];
        let (sin_0, cos_0) = libm::sincos(state.theta);
        let (offset_0, carried) = (offset.reduce_add(), carried.reduce_add());
        let (D, E, M) = (J0 - inertia.reduce_add(), offset_0 * cos_0 + S_res * sin_0, m_t - carried * sin_0 * sin_0);
        let per_determinant = 1.0 / (D * M - E * E);
        let [D, E, M] = [D, E, M].map(|of| of * per_determinant);
        let S_1 = structure.body().S_1;
        let (mut theta_dot, mut turning, mut turning_sin) =
            (state.theta_dot, state.theta_dot * cos_0, state.theta_dot * sin_0);
        let (mut sin, mut cos, [mut sin_before, mut cos_before]) = (sin_0, cos_0, [0.0; 2]);
        let (mut y_dot, mut gamma, mut G, mut M_before, mut offset) = (state.u_dot.of(at), 0.0, 0.0, 0.0, offset_0);
        let mut state = *state;
        state.u.set(at + 1, sin_0);
        state.u_dot.set(at + 1, turning);
        let truncation = self.truncation(start, span);
        arc.expand_in_place(&state, span, &truncation, |arc, order, per| {
            let n = order - 1;
            let (y, next_sin, next_cos) = (arc.u[n].of(at), turning * per, -turning_sin * per);
            let [mut inertia, mut next_offset] = [f64x4::ZERO; 2];
            for four in fours.iter_mut() {
                let [of_inertia, heavy] = four.next(order, per);
                inertia += of_inertia;
                next_offset -= four.share * heavy;
            }
            let next_offset = next_offset.reduce_add();
            let newest = [next_cos, next_sin, inertia.reduce_add(), next_sin];
            let [turning_cos, sin_turning, spin, lean] =
                products(ahead, n, [theta_dot, theta_dot, theta_dot, next_offset], newest);
            let [fall, hang, weighed, moved] = match n {
                0 => [0.0; 4],
                _ => products(behind, n - 1, [gamma, gamma, offset, cos], [sin, cos, G, M_before]),
            };
            let mut pushed = f64x4::ZERO;
            if is_pushed {
                for four in fours.iter() {
                    let before = if n > 0 { four.lever[n - 1] } else { f64x4::ZERO };
                    pushed -= four.mass * (four.push[0] * four.lever[n] + four.push[1] * before);
                }
            }
            let powers = [taken[0] * y_dot - taken[1] * turning, taken[2] * turning - taken[1] * y_dot];
            let [turning_square, of_y, of_turning, pushed] = products(
                same,
                n,
                [theta_dot, y_dot, turning, pushed.reduce_add()],
                [theta_dot, powers[0], powers[1], sin],
            );
            square[MAX_ORDER - n] = f64x4::splat(turning_square);
            let power = of_y + of_turning;
            arc.u_dot[n].set(at + 2, power);
            arc.u[order].set(at + 2, power * per);
            let of_order = |of: [f64; 2]| of.get(n).copied().unwrap_or(0.0);
            let N = of_order([push[0], 0.0]) - k[0] * y + k[1] * sin - c[0] * y_dot + c[1] * turning;
            M_before = of_order([push[1], 0.0]) - k[1] * y + k[2] * sin - c[1] * y_dot + c[2] * turning;
            let fall = fall - (ground[0] * cos + ground[1] * cos_before);
            let hang = hang + ground[0] * sin + ground[1] * sin_before;
            let [mut moment, mut upwards] = [f64x4::ZERO; 2];
            for four in fours.iter_mut() {
                let [u, u_dot] = four.motion;
                let elastic = four.stiffness * u + four.damping * u_dot;
                four.resistance = Four::product(&four.lever[..order], &square[MAX_ORDER - n..]) + elastic;
                moment += four.arm * four.resistance;
                four.resistance = four.share * fall - four.resistance;
                if is_pushed {
                    four.resistance += four.push[0] * cos + four.push[1] * cos_before;
                }
                upwards += four.share * four.mass * four.resistance;
            }
            let mut moment =
                moment.reduce_add() + offset_0 * hang + weighed + S_res * fall - cos_0 * M_before - moved - spin / per;
            if is_pushed {
                moment += on_rest[0] * cos + on_rest[1] * cos_before - pushed;
            }
            let rise = S_1 * sin_turning + offset_0 * turning_cos + (n + 2) as f64 / span * lean;
            let upwards = N + rise / per + sin_0 * upwards.reduce_add();
            let theta_ddot = M * moment + E * upwards;
            gamma = E * moment + D * upwards;
            G = hang + gamma * cos_0;
            theta_dot = theta_ddot * per;
            y_dot = (gamma - of_order(weight)) * per;
            arc.u_dot[order].count_as(&state.u_dot);
            for four in fours.iter_mut() {
                let along = four.resistance + four.share * (sin_0 * gamma) - four.height * theta_ddot;
                four.motion = [four.motion[1] * per, along * per];
                arc.u_dot[order].set_four(four.first, four.motion[1]);
            }
            (turning, turning_sin) = (turning_cos + theta_dot * cos_0, sin_turning + theta_dot * sin_0);
            (sin_before, cos_before, sin, cos, offset) = (sin, cos, next_sin, next_cos, next_offset);
            [y_dot, turning, 0.0].iter().enumerate().for_each(|(i, of)| arc.u_dot[order].set(at + i, *of));
            theta_dot
        });
    }
}

impl Level<Modes> for OnGround {
    #[inline(always)]
    fn subject(&self) -> &Subject {
        &self.subject
    }

    fn boxed(&self) -> Box<dyn Level<Modes>> {
        Box::new(self.clone())
    }

    fn leap(&self, _phase: Phase, _start: &Start<Modes>) -> Option<State<Modes>> {
        None
    }

    fn series(&self, phase: Phase, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        self.motion(phase.contact(), start, arc);
    }

    fn accelerations(&self, phase: Phase, &Now { state, load, dissipators }: &Now<Modes>) -> Second<f64, Modes> {
        let given = (state, dissipators, LinearLoad::held(load));
        let [second] = derivatives(self, phase, given, &mut self.first.borrow_mut());
        second
    }

    /// `state` with the sine of its rotation.
    fn admissible(&self, _phase: Phase, mut state: State<Modes>) -> State<Modes> {
        let ((sin, cos), place) = (libm::sincos(state.theta), self.foundation().place + 1);
        state.u.set(place, sin);
        state.u_dot.set(place, state.theta_dot * cos);
        state
    }

    /// Whether the energy above rest is too small to lift a point.
    fn stays_down(&self, state: &State<Modes>, dissipators: &Dissipators) -> bool {
        let structure = &self.subject.structure;
        let still = Modes::parts(structure, 0.0);
        let rest =
            self.foundation().begin(&State { u: still, u_dot: still, theta: 0.0, theta_dot: 0.0 }, structure.base());
        let of = |state: &State<Modes>| {
            energy(structure, self.foundation().contact(state, structure.base()), state, dissipators)
        };
        of(state) - of(&rest) < AT_REST * self.least_lift
    }
}
