//! The assumptions of the model, and the amounts by which a motion breaks them: exact, between the ends of pieces, too.
//!
//! The model holds the base down until |u| = u_cr, keeps the edge that it rocks about on the ground, lets nothing slide
//! and takes θ̇ ← r θ̇ at every impact. With W = (m + m0) g, the reactions R and the impulse I of an impact
//! ([`reactions`](crate::mechanics::reactions)), these tell what that asks for:
//!
//! ```text
//! tension_max      largest (|R_m|/B − R_v)/W in full contact      above 0 the base is held down by tension
//! R_v_min          least R_v/W                                    below 0 the edge is held down by a pull
//! mu_required      largest |R_h|/R_v                              friction; infinite once R_v is 0 or less
//! mu_impact        largest |I_h|/I_v of an impact                 the same; infinite where I_v is not above 0
//! tension_impact   largest (|I_m|/B − I_v)/I_v of an impact       above 0 one of the edges pulls
//! energy_gain_max  largest (T₊ − T₋)/T₋ of an impact              above 0 energy comes out of nothing
//! weight_min       least (g + a_v)/g                              at 0 or below nothing holds the base down
//! ```
//!
//! The reactions of a restrained structure are those that the edges of the base carry. If a vertical ground acceleration
//! brings g + a_v to 0, the real base would fly. The first such instant is reported, and the motion continues by the model's
//! equations.
//!
//! The reactions are series in time (`reaction_series`). A value is worse than λ where a combination of them is positive, such
//! as ±R_h − λ R_v for friction. The search goes through the stationary points of the combination, with λ the worst value so
//! far, until none is positive (Dinkelbach). A limit is passed between the roots of the combination with that limit.

mod assumptions;

use super::reaction_series::{self, Extent};
use crate::digits::short;
use crate::engine::piece::{Expansion, Piece, PiecePart, Watch};
use crate::engine::sample::Sample;
use crate::levels::level::off_chord;
use crate::mechanics::energy::kinetic;
use crate::mechanics::impact;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::Coordinates;
use crate::series::bisection::last_where;
use crate::series::extremes;
use crate::series::taylor::evaluate;
use crate::series::terms::Terms;
use crate::{
    Base, Detail, Foundation, Impulse, Load, Mode, Motion, OneMass, Output, Parameters, Phase, Ramp, Reactions, Side,
    Structure, Transition, TransitionKind,
};
pub use assumptions::{
    ASSUMPTIONS, Assumption, EDGE_LOAD, ENERGY, FRICTION, IMPACT_FRICTION, IMPACT_TENSION, Limits, Passing, TENSION,
    WEIGHT,
};
use assumptions::{Combination, NO_SLIDING, OF_REACTIONS, OfReactions, PRESSED_EDGE, Scale, of_impact};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Something worse by no more than this part may be rounding.
const ROUNDING: f64 = 1e-14;

/// A value that is worse by no more than this is not looked for, and what differs by no more than this part is the same.
const MARGIN: f64 = 1e-12;

/// A series of reactions that is off by less than this part of its terms at its end has converged.
const CONVERGED: f64 = 1e-10;

/// Settlement at rest as a fraction of B, and bounce frequency as a multiple of the highest frequency, that are doubted.
const SETTLED: f64 = 0.02;
const STIFF: f64 = 20.0;

/// Damping ratio of a bounce as fast as that, below which a change of 1e-9 of a record grows more than 1e4 times.
const BOUNCING: f64 = 0.02;

/// Reactions without bounds.
const UNBOUNDED: Reactions<Extent> = Reactions { R_h: Extent::ANY, R_v: Extent::ANY, R_m: Extent::ANY };

/// The largest number of arcs of a leap that are all looked at. Of a longer leap only the first arcs and the last period are: the
/// rest is no worse, but its time beyond a limit is not counted.
const MOST_ARCS: u32 = 1000;

/// The findings about one of [`ASSUMPTIONS`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The worst value: the largest or the least, as [`Passing`] tells. [`Assumption::start`] if no value has been seen.
    pub value: f64,
    /// First instant of the worst value, s.
    pub time: f64,
    /// When the limit was passed first, s.
    pub first_beyond: Option<f64>,
    /// For how long, s, or at how many impacts it was passed.
    pub beyond: f64,
}

/// The findings about a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// In the order of [`ASSUMPTIONS`].
    pub worst: [Worst; ASSUMPTIONS.len()],
    /// Impacts that raise the energy, however little.
    pub gains: u64,
    /// Impacts and landings.
    pub impacts: u64,
    /// Bursts of transitions that ended in contact held by force ([`TransitionKind::Settling`]).
    pub settlings: u64,
    /// For how long contact was held so, s.
    pub held: f64,
    /// How long the motion has been, s.
    pub duration: f64,
}

impl Findings {
    /// Findings before anything has been seen, from `time` (s) on.
    pub fn since(time: f64) -> Findings {
        let none = |value| Worst { value, time, first_beyond: None, beyond: 0.0 };
        let worst = ASSUMPTIONS.map(|assumption| none(assumption.start));
        Findings { worst, gains: 0, impacts: 0, settlings: 0, held: 0.0, duration: 0.0 }
    }

    /// Sees `value` of assumption `which` at `time` (s). The first of several values that differ by rounding counts.
    fn see(&mut self, which: usize, value: f64, time: f64) {
        let worst = &mut self.worst[which];
        let is_same =
            value == worst.value || (value - worst.value).abs() <= MARGIN * value.abs().min(worst.value.abs());
        let is_worse = ASSUMPTIONS[which].passing.is_worse(value, worst.value);
        if is_same {
            worst.time = worst.time.min(time);
        } else if is_worse {
            worst.time = time;
        }
        if is_worse {
            worst.value = value;
        }
    }

    /// Sees that the limit of `which` is passed from `time` (s) on, for `amount` of time or once.
    fn see_beyond(&mut self, which: usize, time: f64, amount: f64) {
        let worst = &mut self.worst[which];
        worst.first_beyond.get_or_insert(time);
        worst.beyond += amount;
    }

    /// Sees a `ramp` of the vertical ground acceleration that lasts from `time` (s) on for `duration`, where gravity is `g`.
    fn see_vertical(&mut self, g: f64, ramp: Ramp, time: f64, duration: f64) {
        let ends = [0.0, duration].map(|tau| (time + tau, 1.0 + ramp.at(tau) / g));
        ends.iter().for_each(|(time, value)| self.see(WEIGHT, *value, *time));
        let root = (-(g + ramp.value) / ramp.slope).clamp(0.0, duration);
        let (from, to) = match ends.map(|(_, value)| ASSUMPTIONS[WEIGHT].passing.passes(value, 0.0)) {
            [false, false] => return,
            [true, true] => (0.0, duration),
            [true, false] => (0.0, root),
            [false, true] => (root, duration),
        };
        self.see_beyond(WEIGHT, time + from, to - from);
    }

    /// The warning about assumption `which` of [`ASSUMPTIONS`] once its limit has been passed: instant, value, meaning.
    pub fn warning(&self, which: usize, limits: &Limits) -> Option<String> {
        let (Assumption { name, meaning, limit, passing, .. }, Worst { value, time, first_beyond, .. }) =
            (&ASSUMPTIONS[which], &self.worst[which]);
        let (first, limit) = ((*first_beyond)?, limit(limits));
        let [first, limit, value, time] = [first, limit, *value, *time].map(short);
        Some(format!("t = {first} s: {name} is {passing} {limit}: {meaning}; so far {name} = {value} at t = {time} s"))
    }
}

/// Looks at a motion for what it goes beyond.
#[derive(Clone, Debug)]
pub struct Validity {
    structure: Structure,
    limits: Limits,
    found: Findings,
}

impl Validity {
    /// The watcher of `structure`, which continues from what has been `found`. Of many masses, `structure` is the one that moves
    /// ([`Engine::structure`](crate::Engine::structure)).
    pub fn new(structure: &Structure, limits: Limits, found: Findings) -> Validity {
        Validity { structure: structure.clone(), limits, found }
    }

    /// The findings so far.
    pub fn found(&self) -> &Findings {
        &self.found
    }

    fn scale(&self) -> Scale {
        let &Base { m_t, g, B, .. } = self.structure.base();
        Scale { W: m_t * g, B }
    }

    /// Sees an instant, which need not be in a piece.
    pub fn see_instant<Q: Coordinates>(&mut self, at: &Sample<Q>) {
        let &Sample { motion: Motion { time, phase, .. }, load, .. } = at;
        self.found.see(WEIGHT, 1.0 + load.a_v / self.structure.base().g, time);
        self.see_reactions(time, phase, &at.edges());
    }

    /// Sees the `reactions` in `phase` at `time` (s).
    fn see_reactions(&mut self, time: f64, phase: Phase, reactions: &Reactions) {
        for of in OF_REACTIONS.iter().filter(|of| (of.holds_in)(phase)) {
            self.found.see(of.place, (of.value)(self.scale(), reactions), time);
        }
    }

    /// Whether reactions within these bounds may hold something worse than what has been seen, or go beyond a limit.
    fn may_matter(&self, phase: Phase, reactions: &Reactions<Extent>) -> bool {
        let Reactions { R_h, R_v, R_m } = reactions;
        // they break each assumption more than others do
        let worst = Reactions { R_h: R_h.most(), R_v: R_v.least(), R_m: R_m.most() };
        OF_REACTIONS.iter().filter(|of| (of.holds_in)(phase)).any(|of| {
            let Assumption { limit, passing, .. } = &ASSUMPTIONS[of.place];
            let (seen, limit) = (self.found.worst[of.place].value, limit(&self.limits));
            let first = if passing.is_worse(seen, limit) { limit } else { seen };
            let value = (of.value)(self.scale(), &worst);
            !if *passing == Passing::Above { value < first + MARGIN } else { value > first - MARGIN }
        })
    }

    /// Looks at the motion over a polynomial for the worst value of each assumption and for the time beyond its limit; `extents` are bounds of
    /// its reactions.
    fn look<Q: Coordinates>(&mut self, expansion: &Expansion<Q>, extents: &Reactions<Extent>) {
        expansion.in_parts(&mut |part, is_finest| {
            let polynomial = Polynomial { of: *part, series: reaction_series::over(part), extents };
            let &Expansion { piece, arc, .. } = part;
            let last = polynomial.reactions(arc.reach);
            if !is_finest && !polynomial.has_converged(&last) {
                return false;
            }
            let phase = piece.before.phase;
            // no friction is enough from where R_v is 0, which may be sooner than either end
            if let Some((start, _)) = polynomial.above([Some(Combination([0.0, -1.0, 0.0, 0.0])), None]).first() {
                self.found.see(FRICTION, f64::INFINITY, part.time(*start));
            }
            self.see_reactions(part.time(0.0), phase, &polynomial.reactions(0.0));
            self.see_reactions(part.time(arc.reach), phase, &last);
            for of in OF_REACTIONS.iter().filter(|of| (of.holds_in)(phase)) {
                self.search(of, &polynomial);
                let beyond = (of.worse)(self.scale(), (ASSUMPTIONS[of.place].limit)(&self.limits));
                for (start, end) in polynomial.above(beyond) {
                    self.found.see_beyond(of.place, part.time(start), (end - start) * arc.span);
                }
            }
            true
        });
    }

    /// Looks for the worst value of an assumption within `polynomial`.
    fn search<Q: Coordinates>(&mut self, of: &OfReactions, polynomial: &Polynomial<Q>) {
        let (scale, reach) = (self.scale(), polynomial.of.arc.reach);
        loop {
            let worst = self.found.worst[of.place].value;
            if worst.is_infinite() {
                return;
            }
            for combination in (of.worse)(scale, worst).iter().flatten() {
                let Some(series) = polynomial.combination(combination, ROUNDING * scale.W) else { continue };
                let used = series.used();
                if highest(used, reach) > ROUNDING * scale.W {
                    extremes::stationary_points(used, reach, |sigma| {
                        let value = (of.value)(scale, &polynomial.reactions(sigma));
                        self.found.see(of.place, value, polynomial.of.time(sigma));
                    });
                }
            }
            let now = self.found.worst[of.place].value;
            // a ratio is stationary where its combination is, with the ratio found there
            if of.place != FRICTION || now <= worst * (1.0 + ROUNDING) || now.total_cmp(&worst).is_le() {
                return;
            }
        }
    }
}

impl<Q: Coordinates> Watch<Q> for Validity {
    fn piece(&mut self, piece: &Piece<Q>) {
        let phase = piece.before.phase;
        self.found.duration += piece.duration;
        self.found.held += piece.before.chatter.held.min(piece.duration);
        if piece.load.is_vertical() && (PRESSED_EDGE.holds_in)(phase) {
            let g = self.structure.base().g;
            self.found.see_vertical(g, piece.load.upwards(), piece.before.time, piece.duration);
        } else {
            self.found.see(WEIGHT, 1.0, piece.before.time);
        }
        if !(NO_SLIDING.holds_in)(phase) {
            return;
        }
        let (mut arcs, mut count) = (piece.arcs(), 0);
        loop {
            if arcs.left.and_then(extents_of_vibration).is_some_and(|extents| !self.may_matter(phase, &extents)) {
                break;
            }
            let Some(expansion) = arcs.next() else { break };
            let is_passed = reaction_series::bounds(&expansion).is_some_and(|bounds| !self.may_matter(phase, &bounds));
            if !is_passed {
                let extents = extents(&expansion);
                if self.may_matter(phase, &extents) {
                    self.look(&expansion, &extents);
                }
            }
            count += 1;
            if count >= MOST_ARCS {
                arcs.skip_middle();
            }
        }
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        let &Transition { time, kind, before, after } = transition;
        let structure = &self.structure;
        let (side, phase) = match kind {
            TransitionKind::Impact(side) => (side.opposite(), Phase::Rocking(side)),
            // s θ falls to 0
            TransitionKind::Landing | TransitionKind::Settling => (Side::of(-before.theta_dot), Phase::FullContact),
            TransitionKind::Uplift(_)
            | TransitionKind::Overturning(_)
            | TransitionKind::Yielding(_)
            | TransitionKind::Unloading(_)
            | TransitionKind::Touch(_)
            | TransitionKind::Release(_)
            | TransitionKind::Settles(_)
            | TransitionKind::Holds(_)
            | TransitionKind::Friction(_)
            | TransitionKind::Taut
            | TransitionKind::Slack => return,
        };
        self.found.settlings += u64::from(kind == TransitionKind::Settling);
        let is_landing = phase.properties().is_down;
        // the rigid limit that bounces has come to rest: what is left below the tolerance is no impact
        let is_no_impact = match structure.is_rigid() {
            true => impact::restitution::<Q>(structure, side, &before) > 0.0,
            false => after != impact::land::<Q>(structure, &before),
        };
        if is_landing && is_no_impact {
            return;
        }
        let kinetic = kinetic(&Instant::<f64, Q>::of(structure, Phase::Rocking(side), &before, Load::NONE));
        if kinetic == 0.0 {
            return;
        }
        let gained = match is_landing {
            false => impact::energy_gained::<Q>(structure, side, &before),
            true => 0.0, // a landing always loses
        };
        let impulse = Impulse::of::<Q>(structure, (Phase::Rocking(side), &before), (phase, &after));
        self.found.impacts += 1;
        self.found.gains += u64::from(gained / kinetic > 0.0);
        for (which, value) in of_impact(&impulse, gained / kinetic, structure.base().B) {
            self.found.see(which, value, time);
            let Assumption { limit, passing, .. } = &ASSUMPTIONS[which];
            if passing.passes(value, limit(&self.limits)) {
                self.found.see_beyond(which, time, 1.0);
            }
        }
    }
}

/// Bounds of the reactions of the edges over a polynomial.
fn extents<Q: Coordinates>(expansion: &Expansion<Q>) -> Reactions<Extent> {
    let (series, reach) = (reaction_series::over(expansion), expansion.arc.reach);
    let polynomial = Polynomial { of: *expansion, series, extents: &UNBOUNDED };
    match polynomial.has_converged(&polynomial.reactions(reach)) {
        true => Extent::of_all(&series, reach),
        false => UNBOUNDED,
    }
}

/// Bounds of the reactions of the edges over a part in full contact, if the ground does not move vertically. The reactions of the motion
/// that follows the load are linear in time, so that the vibration alone leaves the chord.
fn extents_of_vibration<Q: Coordinates>(part: PiecePart<Q>) -> Option<Reactions<Extent>> {
    let &Piece { level, before: &Motion { phase, .. }, load, .. } = part.piece;
    let step = part.step();
    let [u, u_dot, u_ddot, jerk] = level.swings(phase, &step)?;
    if load.is_vertical() {
        return None;
    }
    let (structure, per_bend) = (level.structure(), step.interval * step.interval / 8.0);
    let moved = |of: &Q| Q::sum(structure, |j, mode| mode.gamma.abs() * of.of(j));
    let off = |output: Output, weight: f64| {
        let reach = &structure.reaches()[output.place(structure).expect("it reaches")];
        let of = |u: &Q, u_dot: &Q| reach.elastic(1.0, u, u_dot) + weight * moved(u);
        off_chord(of(&u, &u_dot), [per_bend, of(&u_ddot, &jerk)])
    };
    let PiecePart { piece, start: (from, ref start) } = part;
    let [first, last] = [piece.edges(from, start), piece.edges(piece.duration, &piece.end)];
    Some(Reactions {
        R_h: Extent::between(first.R_h, last.R_h, off(Output::V_t, 0.0)),
        R_v: Extent::between(first.R_v, last.R_v, 0.0),
        R_m: Extent::between(first.R_m, last.R_m, off(Output::M_t, structure.base().g)),
    })
}

/// A polynomial of a motion with its reactions.
struct Polynomial<'a, Q: Coordinates> {
    of: Expansion<'a, Q>,
    series: Reactions<Terms>,
    extents: &'a Reactions<Extent>,
}

impl<Q: Coordinates> Polynomial<'_, Q> {
    /// The reactions at `sigma`, from the state there.
    fn reactions(&self, sigma: f64) -> Reactions {
        let Expansion { piece, from, arc } = self.of;
        piece.edges(from + sigma * arc.span, &arc.at(sigma))
    }

    /// Whether the series of R_h and R_v end in the reactions `last` of the state, but for rounding of the weight, below which
    /// nothing is looked for.
    fn has_converged(&self, last: &Reactions) -> bool {
        let &Base { m_t, g, .. } = self.of.piece.level.structure().base();
        let is_same =
            |series: &Terms, last: f64| (evaluate(series.used(), self.of.arc.reach) - last).abs() <= ROUNDING * m_t * g;
        let pairs = [(&self.series.R_h, last.R_h), (&self.series.R_v, last.R_v)];
        pairs.into_iter().all(|(series, last)| is_same(series, last) || self.of.has_converged(series, last, CONVERGED))
    }

    /// The series of a combination that may exceed `least`.
    fn combination(&self, combination: &Combination, least: f64) -> Option<Terms> {
        (combination.extent(self.extents).largest() > least).then(|| combination.series(&self.series))
    }

    /// The intervals of σ on which one of `combinations` is positive, in their order.
    fn above(&self, combinations: [Option<Combination>; 2]) -> Vec<(f64, f64)> {
        let (mut found, reach): (Vec<(f64, f64)>, _) = (Vec::new(), self.of.arc.reach);
        for combination in combinations.iter().flatten() {
            let extent = combination.extent(self.extents);
            if extent.least() > 0.0 {
                return vec![(0.0, reach)];
            }
            if extent.largest() > 0.0 {
                let series = combination.series(&self.series);
                if highest(series.used(), reach) > 0.0 {
                    positive(series.used(), reach, &mut found);
                }
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        found.dedup_by(|next, last| {
            let is_one = next.0 <= last.1;
            if is_one {
                last.1 = last.1.max(next.1);
            }
            is_one
        });
        found
    }
}

/// Bound of Σ c_k σᵏ up to σ = `reach`.
fn highest(coefficients: &[f64], reach: f64) -> f64 {
    coefficients[0].max(evaluate(coefficients, reach)) + extremes::off_chord(coefficients, reach)
}

/// Adds to `found` where Σ c_k σᵏ is positive up to σ = `reach`, one interval between stationary points after the other.
fn positive(coefficients: &[f64], reach: f64, found: &mut Vec<(f64, f64)>) {
    let is_positive = |sigma: f64| evaluate(coefficients, sigma) > 0.0;
    let (mut start, mut was_positive) = (0.0, coefficients[0] > 0.0);
    let mut look = |end: f64| {
        let is_so = is_positive(end);
        match [was_positive, is_so] {
            [true, true] => found.push((start, end)),
            [true, false] => found.push((start, last_where(start, end, is_positive))),
            [false, true] => found.push((last_where(start, end, |sigma| !is_positive(sigma)), end)),
            [false, false] => (),
        }
        (start, was_positive) = (end, is_so);
    };
    extremes::stationary_points(coefficients, reach, &mut look);
    look(reach);
}

/// The warnings that follow from a structure at the level `detail`, before anything moves.
pub fn of_structure(structure: &Structure, detail: Detail) -> Vec<String> {
    let base @ &Base { J_P, m_t, B, r, .. } = structure.base();
    match (structure.foundation(), structure.one()) {
        _ if !detail.has_uplift() => Vec::new(),
        (Some(foundation), _) => on_ground(structure, foundation),
        (None, Some(one)) => of_one(one, detail),
        (None, None) => {
            let at_rest = base.restitution(|| [0.0; 2]);
            let mut warnings = Vec::from_iter(r.and_then(|r| pulling(r, base, "m_t")));
            if r.is_none() && at_rest <= 0.0 {
                let [at_rest, J_P, least] = [at_rest, J_P, 2.0 * m_t * B * B].map(short);
                warnings.push(format!(
                    "r = {at_rest} by momentum: J_P = {J_P} kg.m2 is not above 2 m_t B^2 = {least} kg.m2, and an impact with u = 0 \
                     ends rocking; are masses in kg, heights in m, and is B half of the base's width?"
                ));
            }
            warnings
        }
    }
}

fn of_one(structure: &OneMass, detail: Detail) -> Vec<String> {
    let &Parameters { m, B, H, g, r, P_0, .. } = structure.parameters();
    let &OneMass { gamma, omega_fc, u_cr, .. } = structure;
    let mut warnings = Vec::new();
    if detail.has_strut() && u_cr > B {
        let balanced = (gamma * g * B + P_0 * B / m) / (H * omega_fc * omega_fc + g);
        let held = if P_0 > 0.0 { "gamma g + P_0/m" } else { "gamma g" };
        warnings.push(format!(
            "u_cr = {} m exceeds B = {} m (H w_fc^2 < {held}): the model holds the base down until the top mass is \
             beyond the edge of the base, but the weight holds it only up to u = {} m; raise f_fc, or do not \
             rely on the results",
            short(u_cr),
            short(B),
            short(balanced)
        ));
    }
    warnings.extend(pulling(r, structure.base(), "(m + m0)"));
    if detail.has_strut() && impact::greatest_gain(structure, u_cr) > 0.0 {
        let range = match impact::lossless_restitution(structure, u_cr) {
            Some(range) => {
                let [least, most] = range.map(short);
                format!("only r from {least} to {most} cannot")
            }
            None => "so can any other r".to_owned(),
        };
        warnings.push(format!(
            "r = {} can raise the energy at an impact with |u| = u_cr: {range}, see docs/explain/failures.md, section 7",
            short(r)
        ));
    }
    warnings
}

/// The warnings that follow from ground that gives.
fn on_ground(frame: &Structure, foundation: &Foundation) -> Vec<String> {
    let (base, settled) = (frame.base(), -foundation.y_s);
    let [omega_v, zeta_v] = [foundation.omega_v(base), foundation.zeta_v(base)];
    let highest = frame.modes().iter().map(Mode::omega).fold(0.0, f64::max);
    let mut warnings = Vec::new();
    if settled > SETTLED * base.B {
        warnings.push(format!(
            "the base settles by {} m under its weight, more than B/50: are k_v in N/m and masses in kg?",
            short(settled)
        ));
    }
    if highest > 0.0 && omega_v > STIFF * highest && zeta_v < BOUNCING {
        let [f_v, zeta_v, highest] = [omega_v / TAU, zeta_v, highest / TAU].map(short);
        warnings.push(format!(
            "f_v = {f_v} Hz is more than 20 times the highest frequency of the structure, {highest} Hz, and with zeta_v = {zeta_v} many \
             bounces leave few sure digits; lower f_v, or raise zeta_v"
        ));
    }
    if let Some(mu_c) = foundation.mu_c.filter(|mu_c| *mu_c < base.tan_alpha_cg) {
        let [mu_c, slender] = [mu_c, base.tan_alpha_cg].map(short);
        warnings.push(format!("mu_c = {mu_c} is below tan(alpha_cg) = {slender}: the base may slide rather than rock"));
    }
    if let Some(fs) = foundation.ground.fs.filter(|_| base.ties.P_0 > 0.0) {
        warnings.push(format!(
            "fs = {}: the capacities grow with P_0, which counts as load at rest; give q_u for ground whose strength is known",
            short(fs)
        ));
    }
    let reserve = foundation.reserve();
    if foundation.yields && foundation.points.len() == 2 && reserve >= 2.0 {
        warnings.push(format!(
            "fs = {}: from 2 on, two points yield by their dashpots alone, because one carries all at most; take n_points = 11 for soil",
            short(reserve)
        ));
    }
    warnings
}

/// The warning about a coefficient of restitution `r` that requires a pull.
fn pulling(r: f64, base: &Base, mass: &str) -> Option<String> {
    let limit = impact::pulling_restitution(base);
    (r < limit).then(|| {
        let [r, limit] = [r, limit].map(short);
        format!(
            "r = {r} is below 1 - 2 {mass} B^2/J_P = {limit}: an impact with u = 0 needs an impulse that pulls at \
             one of the edges; raise r, or lower H/B"
        )
    })
}
