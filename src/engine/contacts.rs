//! Guards of ground that gives: contact points that are touched, released, and yield, a tendon that goes slack, dissipators that yield.
//!
//! A pressed point is released when f returns to 0. A free point is touched when e < 0 and f > 0 hold together. Both depend on the state
//! and the settlements alone, so that nothing else is remembered between steps. A gap that starts within rounding of its root is divided by
//! time until its first coefficient is a number. The gap then closes at once, or it opens and must return. Points that act at one instant,
//! as in vertical motion, follow one another in steps without duration.

use crate::engine::guard::{BAND, Guard};
use crate::engine::motion::Motion;
use crate::engine::sample::Sample;
use crate::engine::step::{Branch, Moved, Step, see};
use crate::engine::transition::TransitionKind;
use crate::engine::yielding::product_integral;
use crate::levels::level::Level;
use crate::levels::on_ground::Pushes;
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::contact::heights;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{dampers_on_ground, places};
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::{MAX_ORDER, Series, ZERO, evaluate, sum_of_magnitudes};
use crate::series::terms::Terms;
use crate::structure::ground::{ContactPoint, Footing};
use crate::{Foundation, Friction, Phase, PressedPoints, Ties};

/// Part of its terms by which a gap may miss its root.
pub(super) const ROUNDING: f64 = 1e-13;

/// y, sin θ and their rates over a step.
struct Rises {
    y: [Series; 2],
    sin: [Series; 2],
    order: usize,
    /// |y_s| + |y| at the start.
    scale: f64,
    /// Duration of the step over the longest one.
    part: f64,
}

impl Rises {
    #[inline]
    fn new<Q: Coordinates>(level: &dyn Level<Q>, arc: &Arc<Q>) -> Rises {
        let (foundation, part) = (level.structure().ground(), arc.span / level.longest_step());
        let mut rises = Rises { y: [ZERO; 2], sin: [ZERO; 2], order: arc.order, scale: 0.0, part };
        for (i, series) in [&arc.u, &arc.u_dot].into_iter().enumerate() {
            for (k, of) in arc.used(series).iter().enumerate() {
                let footing = of.footing(foundation);
                (rises.y[i][k], rises.sin[i][k]) = (footing.y, footing.sin);
            }
        }
        rises.scale = foundation.y_s.abs() + rises.y[0][0].abs();
        rises
    }

    /// The height over the step at ξ plus τ times its rate, and what counts as 0 of it.
    #[inline]
    fn at(&self, xi: f64, tau: f64) -> (Series, f64) {
        self.above(0.0, xi, tau)
    }

    /// The same with `more` height.
    #[inline]
    fn above(&self, more: f64, xi: f64, tau: f64) -> (Series, f64) {
        let Rises { y, sin, order, scale, .. } = self;
        let mut height = ZERO;
        for k in 0..=*order {
            height[k] = y[0][k] - xi * sin[0][k] + tau * (y[1][k] - xi * sin[1][k]);
        }
        height[0] += more;
        let rates = y[1][0].abs() + (xi * sin[1][0]).abs();
        (height, ROUNDING * (scale + (xi * sin[0][0]).abs() + tau * rates + more.abs()))
    }

    /// The rate of the height at ξ, and what counts as 0 of it.
    fn rate(&self, xi: f64) -> (Series, f64) {
        let Rises { y, sin, .. } = self;
        let rate = std::array::from_fn(|k| y[1][k] - xi * sin[1][k]);
        (rate, ROUNDING * (y[1][0].abs() + (xi * sin[1][0]).abs()))
    }

    /// The gap of `sign` times a series, divided by time while its first coefficients are no more than `rounding`, as they would be
    /// over the longest step; none if all are.
    #[inline]
    fn gap<'b>(&self, series: &'b (Series, f64), sign: f64) -> Option<Gap<'b>> {
        opened(series, sign, self.order, self.part)
    }
}

/// As [`Rises::gap`], over a step with this highest `order` that is this `part` of the longest one.
#[inline]
pub(super) fn opened<'b>((series, rounding): &'b (Series, f64), sign: f64, order: usize, part: f64) -> Option<Gap<'b>> {
    let (used, mut limit) = (&series[..=order], rounding / part);
    let is_more = |c: &f64| {
        limit *= part;
        c.abs() > limit
    };
    let zeros = used.iter().position(is_more)?;
    Some(Gap::new(&used[zeros..], sign, 0.0))
}

/// The first instant up to `reach` at which all `gaps` are closed.
pub(super) fn first<const N: usize>(gaps: [Option<Gap>; N], reach: f64) -> Crossing {
    match gaps.iter().all(Option::is_some) {
        true => first_time_all_closed(gaps.map(|gap| gap.expect("all are there")), reach),
        false => Crossing::None,
    }
}

/// The points that are pressed, or that yield, change.
pub(crate) struct Points;

/// Signs of the branches in which a point yields, or is elastic again; ±1 is a touch or a release.
const YIELDS: i8 = 2;
const ELASTIC: i8 = -2;

impl<Q: Coordinates> Guard<Q> for Points {
    fn first(&self, &Step { level, contact, start, arc, reach, .. }: &Step<Q>) -> (Crossing, Branch) {
        let foundation = level.structure().ground();
        let rises = Rises::new(level, arc);
        let mut found = (Crossing::None, Branch::default());
        for (i, point) in foundation.points.iter().enumerate() {
            let settled = start.settled[i];
            let pushes = |more: f64| rises.above(settled + more, point.xi, point.c / point.k);
            let reach = found.0.sigma().min(reach);
            if contact.yields(i) {
                // ṡ = ė − v, with all orders, of which the motion may have fewer
                let (fall, mut rounding) = rises.rate(point.xi);
                let creep = point.creep(start.state.u.footing(foundation).height(point.xi) + settled);
                let mut settles = fall.map(|fall| -fall);
                settles[..=MAX_ORDER]
                    .iter_mut()
                    .zip(point.fades(arc.span))
                    .for_each(|(of, fades)| *of += creep * fades);
                // as much as of the force less the capacity, from which a point begins to yield
                rounding += if point.c > 0.0 { pushes(point.q / point.k).1 * point.k / point.c } else { 0.0 };
                let rate = (settles, rounding);
                see(&mut found, first([opened(&rate, 1.0, MAX_ORDER, rises.part)], reach), i, ELASTIC);
                continue;
            }
            if contact.is_pressed(i) {
                let depth = pushes(0.0);
                let reserve = point.q / point.k;
                let (first_depth, swing) = (depth.0[0], sum_of_magnitudes(&depth.0[1..=arc.order]) * reach);
                if -first_depth > swing.max(depth.1) && reserve + first_depth - depth.1 > swing {
                    continue; // most steps need no more
                }
                see(&mut found, first([rises.gap(&depth, -1.0)], reach), i, -1);
                if foundation.yields {
                    let reach = found.0.sigma().min(reach);
                    see(&mut found, first([rises.gap(&pushes(reserve), 1.0)], reach), i, YIELDS);
                }
                continue;
            }
            let height = rises.above(settled, point.xi, 0.0);
            let above = rises.gap(&height, 1.0);
            if above.is_some_and(|above| !above.is_open_throughout(reach)) {
                see(&mut found, first([above, rises.gap(&pushes(0.0), 1.0)], reach), i, 1);
            }
        }
        found
    }

    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind> {
        let (i, state) = (usize::from(branch.which), &mut motion.state);
        if let Phase::OnGround(contact) = &mut motion.phase {
            let ground = level.structure().ground();
            let ContactPoint { xi, k, .. } = *ground.points.get(i)?;
            if branch.sign.abs() > 1 {
                contact.yields ^= 1 << i;
                return Some(if branch.sign == YIELDS { TransitionKind::Settles(i) } else { TransitionKind::Holds(i) });
            }
            let footing = state.u.footing(ground);
            let e = footing.height(xi) + motion.settled.as_ref()[i];
            contact.pressed ^= 1 << i;
            let taken = footing.taken - f64::from(branch.sign) * 0.5 * k * e * e;
            state.u.set_footing(ground, Footing { taken, ..footing });
        }
        Some(if branch.sign > 0 { TransitionKind::Touch(i) } else { TransitionKind::Release(i) })
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        let (Motion { phase, state, settled, .. }, structure) = (&now.motion, now.level.structure());
        let (contact, ground, base) = (phase.contact(), structure.ground(), structure.base());
        let margin = |(i, [depth, push]): (usize, [f64; 2])| {
            let (ContactPoint { xi, k, c, q }, margin) = (ground.points[i], depth.min(push));
            match q / k - push {
                _ if !contact.is_pressed(i) => -margin,
                reserve if !contact.yields(i) => margin.min(reserve),
                reserve if c > 0.0 => margin.min(-reserve),
                // without a dashpot it carries its capacity as long as it goes down
                _ => margin.min(ground.y_s * state.u_dot.footing(ground).height(xi) / (base.g * base.B).sqrt()),
            }
        };
        let margins = heights(ground, state, settled.as_ref()).enumerate().map(margin);
        (0, margins.fold(f64::INFINITY, f64::min) / ground.y_s.abs() + BAND)
    }
}

/// Number of the tendon among the ties.
const TENDON: u8 = 2;

/// The tendon becomes slack or taut, or a dissipator begins or ceases to yield.
///
/// A tendon rests on its guard if P_0 is 0. A taut one therefore pushes by up to 2e-13 k_t |y_s|, which is rounding, before it counts as
/// slack; its peak has pulls alone, and stays 0 then.
pub(crate) struct Tied;

impl<Q: Coordinates> Guard<Q> for Tied {
    fn first(&self, &Step { level, contact, start, arc, reach, .. }: &Step<Q>) -> (Crossing, Branch) {
        let (foundation, base) = (level.structure().ground(), level.structure().base());
        let mut found = (Crossing::None, Branch::default());
        let Ties { P_0, k_t, k_d, F_y, .. } = base.ties;
        if !base.is_restrained() {
            return found;
        }
        let rises = Rises::new(level, arc);
        if k_t > 0.0 {
            let ((height, rounding), slack) = (rises.at(0.0, 0.0), P_0 / k_t - foundation.y_s);
            let (opens, sign) = if contact.is_slack { (-1.0, 1) } else { (1.0, -1) };
            let gap = Gap::new(&height[..=rises.order], opens, opens * slack + rounding);
            see(&mut found, first_time_all_closed([gap], reach), usize::from(TENDON), sign);
        }
        for (j, xi) in places(base).into_iter().enumerate().filter(|_| F_y > 0.0) {
            let rate = rises.rate(xi);
            match start.dissipators.yields[j] {
                0 => {
                    for sign in [1_i8, -1] {
                        let mut height = rises.at(xi, 0.0);
                        height.0[0] -= foundation.y_s + start.dissipators.plastic[j] + f64::from(sign) * F_y / k_d;
                        height.1 += ROUNDING * F_y / k_d;
                        let gaps = [&height, &rate].map(|of| rises.gap(of, -f64::from(sign)));
                        see(&mut found, first(gaps, reach), j, sign);
                    }
                }
                sign => see(&mut found, first([rises.gap(&rate, f64::from(sign))], reach), j, 0),
            }
        }
        found
    }

    fn apply(&self, _level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind> {
        let which = usize::from(branch.which);
        Some(match (&mut motion.phase, branch) {
            (Phase::OnGround(contact), Branch { which: TENDON, sign }) => {
                contact.is_slack = sign < 0;
                if sign < 0 { TransitionKind::Slack } else { TransitionKind::Taut }
            }
            (_, Branch { sign, .. }) => {
                *motion.dissipators.yields.get_mut(which)? = sign;
                if sign == 0 { TransitionKind::Unloading(which) } else { TransitionKind::Yielding(which) }
            }
        })
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        let (structure, Motion { phase, state, dissipators, .. }) = (now.level.structure(), &now.motion);
        let Ties { P_0, k_t, k_d, F_y, .. } = structure.base().ties;
        let (ground, y_s) = (structure.ground(), structure.ground().y_s);
        let of = |i: usize, xi: f64| [state.u, state.u_dot][i].footing(ground).height(xi);
        let sign = if phase.contact().is_slack { -1.0 } else { 1.0 };
        let of_tendon = (of(0, 0.0) - y_s + P_0 / k_t) / y_s.abs() * sign;
        let of_pair = places(structure.base()).into_iter().enumerate().map(|(j, xi)| match dissipators.yields[j] {
            0 => 1.0 - (k_d * (of(0, xi) - y_s - dissipators.plastic[j])).abs() / F_y,
            sign => f64::from(sign) * of(1, xi) / (y_s.abs() * structure.vibration().contact),
        });
        let margins = Some(of_tendon).filter(|_| k_t > 0.0).into_iter().chain(of_pair.filter(|_| F_y > 0.0));
        (1, margins.fold(f64::INFINITY, f64::min) + BAND)
    }
}

/// The dissipators at the reach of a step, and what friction and points that yield have taken there, if the step changes them; and how far
/// points have settled for good.
pub(crate) fn moved<Q: Coordinates>(step: &Step<Q>) -> Moved<Q> {
    let &Step { level, contact, start, arc, reach, .. } = step;
    let base = level.structure().base();
    if !base.is_restrained() && contact.yields == 0 && contact.friction.sign() == 0.0 {
        return (None, None);
    }
    let (ground, mut moved) = (level.structure().ground(), *start.dissipators);
    let end = || Q::evaluate(arc.used(&arc.u), reach);
    if base.is_restrained() {
        let rises = Rises::new(level, arc);
        let of = |j: usize| evaluate(&rises.at(places(base)[j], 0.0).0[..=arc.order], reach) - ground.y_s;
        let power = |(c, rate): (f64, Terms)| c * arc.span * product_integral(rate.used(), rate.used(), reach);
        moved = start.dissipators.stepped(base, of, dampers_on_ground(base, arc, ground).map(power));
    }
    if let (Friction::Slides(side), Some(mu_c), Some(place)) = (contact.friction, ground.mu_c, ground.slide()) {
        let rate: Series = std::array::from_fn(|k| arc.u_dot[k].of(place));
        let normal = normal(ground, contact, start, arc);
        let rubbed = product_integral(arc.used(&normal), arc.used(&rate), reach) * arc.span;
        moved.slip += side.sign() * (end().of(place) - arc.u[0].of(place));
        moved.friction += side.sign() * mu_c * rubbed;
    }
    let settled = (contact.yields != 0).then(|| settled(step));
    if let Some(settled) = &settled {
        for (i, point) in ground.points.iter().enumerate().filter(|(i, _)| contact.yields(*i)) {
            moved.settling += point.q * (settled.as_ref()[i] - start.settled[i]);
        }
    }
    (Some(moved), settled)
}

/// How far points have settled for good at the reach of a step.
fn settled<Q: Coordinates>(&Step { level, contact, start, arc, reach, .. }: &Step<Q>) -> Q::Settled {
    let mut settled = Q::Settled::default();
    settled.as_mut().iter_mut().zip(start.settled).for_each(|(settled, start)| *settled = *start);
    let ground = level.structure().ground();
    let [begin, end] = [arc.u[0], Q::evaluate(arc.used(&arc.u), reach)].map(|u| u.footing(ground));
    for (i, point) in ground.points.iter().enumerate().filter(|(i, _)| contact.yields(*i)) {
        let crept = point.crept(begin.height(point.xi) + start.settled[i], reach * arc.span);
        settled.as_mut()[i] = crept - end.height(point.xi);
    }
    settled
}

/// The normal force of the points over a step, N.
pub(super) fn normal<Q: Coordinates>(
    ground: &Foundation,
    contact: PressedPoints,
    start: &Start<Q>,
    arc: &Arc<Q>,
) -> Series {
    let (mut normal, points) = (ZERO, Pushes::of(ground, contact, start.settled));
    for (k, (u, u_dot)) in arc.used(&arc.u).iter().zip(&arc.u_dot).enumerate() {
        [normal[k], _] = points.forces([u, u_dot].map(|of| of.footing(ground)), k);
    }
    normal
}
