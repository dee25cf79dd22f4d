//! Where the model itself ends: what it takes for granted, and how far a motion goes beyond that; exact, between the ends
//! of its pieces too.
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
//! ```
//!
//! Of a restrained structure the reactions are those that the edges of the base carry. Where a vertical ground acceleration
//! brings g + a_v to 0, the base would fly: told by its first instant, while the motion goes on by the model's equations.
//!
//! The reactions are series in time (`reaction_series`). A value worse than λ is a point where a combination of them is
//! positive, as ±R_h − λ R_v for friction: it is looked for at that combination's stationary points, with λ the worst
//! seen so far, until none is positive (Dinkelbach). When, and for how long, a limit is passed is between its roots.

use super::{Finish, Run, RunError};
use crate::engine::piece::{Expansion, Piece, Sample, Watch};
use crate::levels::level::Rates;
use crate::mechanics::impact;
use crate::numbers::Number;
use crate::run::reaction_series::{self, extents};
use crate::series::bisection::last_where;
use crate::series::extremes;
use crate::series::taylor::evaluate;
use crate::series::terms::Terms;
use crate::{Detail, Impulse, Motion, Parameters, Phase, Ramp, Reactions, Side, Structure, Transition, TransitionKind};
use serde::{Deserialize, Serialize};

/// Something worse by no more than this part may be rounding.
const ROUNDING: f64 = 1e-14;

/// A force that is worse by no more than this part of the weight is not looked for, and what differs by no more is the same.
const MARGIN: f64 = 1e-12;

/// A series of reactions that is off by less than this part of its terms at its end has converged.
const CONVERGED: f64 = 1e-10;

/// How often an arc is halved before its reactions' series are taken as they are.
const FINEST_PART: u32 = 5;

/// Of a leap that takes more arcs than these, what lies between the first of them and the last period is left out: it is
/// no worse than what is looked at, but the time that it spends beyond a limit is not counted.
const MOST_ARCS: u32 = 1000;

/// What may be asked of the ground and of an impact without a word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of `tension_max` and `tension_impact`, parts of the weight and of the impulse.
    pub tension: f64,
    /// Of `R_v_min`, part of the weight.
    pub edge_load: f64,
    /// Of `mu_required` and `mu_impact`.
    pub friction: f64,
    /// Of `energy_gain_max`.
    pub energy_gain: f64,
}

impl Default for Limits {
    /// Friction: 0.5, of concrete on concrete cast against smooth formwork (EN 1992-1-1:2004, 6.2.5(2), "very smooth").
    /// Tension: 0.05, since any uplift at u_cr takes g/(H ω_fc²) or so, and damping adds to it. Edge load and gain: 0.
    fn default() -> Limits {
        Limits { tension: 0.05, edge_load: 0.0, friction: 0.5, energy_gain: 0.0 }
    }
}

/// A limit that is no finite number of at least 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value} is out of range: a finite number of at least 0 is needed")]
pub struct LimitError {
    name: &'static str,
    value: f64,
}

impl Limits {
    /// Whether each of them is a limit.
    ///
    /// # Errors
    ///
    /// One that is not a finite number of at least 0.
    pub fn check(&self) -> Result<(), LimitError> {
        let &Limits { tension, edge_load, friction, energy_gain } = self;
        let named =
            [("friction", friction), ("tension", tension), ("edge_load", edge_load), ("energy_gain", energy_gain)];
        match named.into_iter().find(|(_, value)| !(*value >= 0.0 && value.is_finite())) {
            Some((name, value)) => Err(LimitError { name, value }),
            None => Ok(()),
        }
    }
}

/// What is found of one of [`ASSUMPTIONS`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The worst value: the largest, of `R_v_min` the least.
    pub value: f64,
    /// Its first instant, s.
    pub time: f64,
    /// When the limit was passed first, s.
    pub first_beyond: Option<f64>,
    /// For how long, s, or at how many impacts it was passed.
    pub beyond: f64,
}

/// One of the things that the model takes for granted.
#[derive(Debug)]
pub struct Assumption {
    /// Of the value that tells of it.
    pub name: &'static str,
    /// Of the instant of that value.
    pub time_name: &'static str,
    /// What the value is.
    pub description: &'static str,
    /// What the instant is.
    pub time_description: &'static str,
    /// What it means where the value is beyond its limit.
    pub meaning: &'static str,
    /// Whether it is about impacts alone.
    pub is_of_impacts: bool,
    /// Its limit among others.
    pub limit: fn(&Limits) -> f64,
}

/// Place of `tension_max` in [`ASSUMPTIONS`].
pub const TENSION: usize = 0;
/// Of `R_v_min`.
pub const EDGE_LOAD: usize = 1;
/// Of `mu_required`.
pub const FRICTION: usize = 2;
/// Of `mu_impact`.
pub const IMPACT_FRICTION: usize = 3;
/// Of `tension_impact`.
pub const IMPACT_TENSION: usize = 4;
/// Of `energy_gain_max`.
pub const ENERGY: usize = 5;

macro_rules! assumption {
    ($name:literal $description:literal, $meaning:literal, $is_of_impacts:literal, $limit:expr) => {
        Assumption {
            name: $name,
            time_name: concat!("t_", $name),
            description: $description,
            time_description: concat!("first instant of ", $name),
            meaning: $meaning,
            is_of_impacts: $is_of_impacts,
            limit: $limit,
        }
    };
}

/// All of them, in the order of [`Found::worst`].
pub const ASSUMPTIONS: [Assumption; 6] = [
    assumption!(
        "tension_max" "largest (|R_m|/B - R_v)/W in full contact, W = (m + m0) g: above 0 tension holds the base down",
        "tension holds the base down in full contact; in truth it lifts off earlier than at u_cr",
        false, |limits| limits.tension
    ),
    assumption!(
        "R_v_min" "least R_v/W: below 0 a pull holds the edge of the base down",
        "a pull holds down the edge that the structure rocks about; in truth it jumps",
        false, |limits| limits.edge_load
    ),
    assumption!(
        "mu_required" "largest |R_h|/R_v, the friction that the ground must have; infinite once R_v is 0 or less",
        "it takes that much friction to keep the base where it is; in truth it may slide",
        false, |limits| limits.friction
    ),
    assumption!(
        "mu_impact" "largest |I_h|/I_v of an impact, friction likewise; infinite where I_v is not above 0",
        "it takes that much friction to keep the base where it is at an impact; in truth it may slide",
        true, |limits| limits.friction
    ),
    assumption!(
        "tension_impact" "largest (|I_m|/B - I_v)/I_v of an impact: above 0 one of the edges of the base pulls",
        "one of the edges pulls at an impact; in truth r is larger, or the other edge lifts off",
        true, |limits| limits.tension
    ),
    assumption!(
        "energy_gain_max" "largest gain of an impact over the kinetic energy before it; 0 while none gains",
        "an impact raises the energy; in truth it cannot",
        true, |limits| limits.energy_gain
    ),
];

/// What is found of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// In the order of [`ASSUMPTIONS`].
    pub worst: [Worst; ASSUMPTIONS.len()],
    /// Of (g + a_v)/g, whose least is the worst; beyond its limit the base would fly.
    pub weight: Worst,
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

impl Found {
    /// Nothing seen yet since `time` (s).
    pub fn since(time: f64) -> Found {
        let none = |value| Worst { value, time, first_beyond: None, beyond: 0.0 };
        // of each the least bad that there can be
        let worst = [-1.0, f64::INFINITY, 0.0, 0.0, -1.0, 0.0].map(none);
        Found { worst, weight: none(1.0), gains: 0, impacts: 0, settlings: 0, held: 0.0, duration: 0.0 }
    }

    /// Sees `value` of assumption `which` at `time` (s). Of values that are the same but for rounding the first counts.
    fn see(&mut self, which: usize, value: f64, time: f64) {
        let worst = &mut self.worst[which];
        let is_same =
            value == worst.value || (value - worst.value).abs() <= MARGIN * value.abs().min(worst.value.abs());
        let is_worse = if which == EDGE_LOAD { value < worst.value } else { value > worst.value };
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
        for (time, value) in ends {
            if value < self.weight.value {
                (self.weight.value, self.weight.time) = (value, time);
            }
        }
        let root = (-(g + ramp.value) / ramp.slope).clamp(0.0, duration);
        let (from, to) = match ends.map(|(_, value)| value <= 0.0) {
            [false, false] => return,
            [true, true] => (0.0, duration),
            [true, false] => (0.0, root),
            [false, true] => (root, duration),
        };
        self.weight.first_beyond.get_or_insert(time + from);
        self.weight.beyond += to - from;
    }

    /// What there is to say once the base would have flown: when, for how long, what it means.
    pub fn warning_of_flight(&self) -> Option<String> {
        let Worst { value, time, first_beyond, beyond } = self.weight;
        let first = first_beyond?;
        Some(format!(
            "t = {first} s: g + a_v is not above 0, for {beyond} s so far: nothing holds the base down, in truth it flies; so far \
             the least (g + a_v)/g = {value} at t = {time} s"
        ))
    }

    /// What assumption `which` of [`ASSUMPTIONS`] says once its limit has been passed: what, when, how much, what it
    /// means.
    pub fn warning(&self, which: usize, limits: &Limits) -> Option<String> {
        let (Assumption { name, meaning, limit, .. }, Worst { value, time, first_beyond, .. }) =
            (&ASSUMPTIONS[which], &self.worst[which]);
        let side = if which == EDGE_LOAD { "below" } else { "above" };
        let first = (*first_beyond)?;
        let limit = limit(limits);
        Some(format!("t = {first} s: {name} is {side} {limit}: {meaning}; so far {name} = {value} at t = {time} s"))
    }
}

/// Looks at a motion for what it goes beyond.
#[derive(Clone, Debug)]
pub struct Validity {
    structure: Structure,
    limits: Limits,
    found: Found,
}

impl Validity {
    /// Of `structure`; goes on from what has been `found`.
    pub fn new(structure: &Structure, limits: Limits, found: Found) -> Validity {
        Validity { structure: *structure, limits, found }
    }

    /// What has been found so far.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// W = (m + m0) g, N.
    fn weight(&self) -> f64 {
        let &Parameters { m, m0, g, .. } = self.structure.parameters();
        (m + m0) * g
    }

    /// The `reactions` in `phase` at `time` (s), which need not be in a piece.
    pub fn see_instant(&mut self, time: f64, phase: Phase, reactions: &Reactions) {
        for which in [TENSION, EDGE_LOAD, FRICTION] {
            if which != TENSION || phase == Phase::FullContact {
                self.found.see(which, self.value(which, reactions), time);
            }
        }
    }

    /// What `reactions` mean for assumption `which`.
    fn value(&self, which: usize, &Reactions { R_h, R_v, R_m }: &Reactions) -> f64 {
        match which {
            TENSION => (R_m.abs() / self.structure.parameters().B - R_v) / self.weight(),
            EDGE_LOAD => R_v / self.weight(),
            _ if R_v > 0.0 => R_h.abs() / R_v,
            _ => f64::INFINITY,
        }
    }

    /// The combinations of R_h, R_v, R_m and 1 one of which is positive where assumption `which` is worse than `than`.
    fn worse(&self, which: usize, than: f64) -> Vec<[f64; 4]> {
        let per_width = 1.0 / self.structure.parameters().B;
        match which {
            TENSION => [1.0, -1.0].map(|s| [0.0, -1.0, s * per_width, -than * self.weight()]).to_vec(),
            EDGE_LOAD => vec![[0.0, -1.0, 0.0, than * self.weight()]],
            _ => [1.0, -1.0].map(|s| [s, -than, 0.0, 0.0]).to_vec(),
        }
    }

    /// Whether reactions within these bounds may hold something worse than what has been seen, or go beyond a limit.
    fn may_matter(&self, phase: Phase, [R_h, R_v, R_m]: [f64; 3]) -> bool {
        let W = self.weight();
        let Limits { tension, edge_load, friction, .. } = self.limits;
        let [tension, edge_load, friction] = [(TENSION, tension), (EDGE_LOAD, edge_load), (FRICTION, friction)]
            .map(|(which, limit)| (self.found.worst[which].value, limit));
        let slack = MARGIN * W;
        let is_closed = R_v > edge_load.0.max(edge_load.1).max(0.0) * W - slack
            && R_h < friction.0.min(friction.1) * R_v + slack
            && (phase != Phase::FullContact
                || R_m / self.structure.parameters().B - W < tension.0.min(tension.1) * W + slack);
        !is_closed
    }

    /// Whether a leap in full contact may hold such: what changes no faster than its second derivative leaves its chord by no
    /// more than that over 8/h².
    fn leap_may_matter(&self, piece: &Piece) -> bool {
        let &Parameters { m, m0, H, g, .. } = self.structure.parameters();
        let &Structure { k, c_fc, .. } = &self.structure;
        let ends = [(0.0, &piece.before.state), (piece.duration, &piece.end)].map(|(tau, state)| {
            let strut = c_fc * state.u_dot + k * state.u;
            [strut - m0 * piece.load.at(tau).a_g, H * strut + m * g * state.u]
        });
        let start = piece.model.start(piece.before.state, &piece.before.dissipators, piece.load, piece.duration);
        let Rates { u_ddot, u_dddot, .. } = piece.model.level.rates(piece.before.phase, &start, &piece.end);
        let per_bend = piece.duration * piece.duration / 8.0;
        let strut = per_bend * (c_fc * u_dddot + k * u_ddot);
        let [R_h, R_m] = [0, 1].map(|i| ends[0][i].abs().max(ends[1][i].abs()));
        let bounds = [R_h + strut, self.weight(), R_m + H * strut + per_bend * m * g * u_ddot];
        self.may_matter(piece.before.phase, bounds)
    }

    /// Whether the motion over a polynomial may hold something worse than what has been seen, or go beyond a limit.
    fn arc_may_matter(&self, &Expansion { piece, from, arc }: &Expansion) -> bool {
        let phase = piece.before.phase;
        let Reactions { R_h, R_v, R_m } = extents(piece.model, phase, piece.load.from(from), arc);
        self.may_matter(phase, [R_h.magnitude(), R_v.least, R_m.magnitude()])
    }

    /// Looks at the motion over a polynomial; `halvings` are left.
    fn look(&mut self, expansion: Expansion, halvings: u32) {
        let stretch = Stretch::new(expansion);
        let Expansion { piece, from, arc } = expansion;
        if halvings > 0 && !stretch.has_converged() {
            let middle = 0.5 * arc.reach;
            for [start, end] in [[0.0, middle], [middle, arc.reach]] {
                let half = &arc.between(start, end);
                self.look(Expansion { piece, from: from + start * arc.span, arc: half }, halvings - 1);
            }
            return;
        }
        let phase = piece.before.phase;
        // no friction is enough from where R_v is 0, which may be sooner than either end
        if let Some((start, _)) = stretch.above(&[[0.0, -1.0, 0.0, 0.0]]).first() {
            self.found.see(FRICTION, f64::INFINITY, stretch.of.time(*start));
        }
        for sigma in [0.0, arc.reach] {
            self.see_instant(stretch.of.time(sigma), phase, &stretch.reactions(sigma));
        }
        for which in [TENSION, EDGE_LOAD, FRICTION] {
            if which == TENSION && phase != Phase::FullContact {
                continue;
            }
            self.search(which, &stretch);
            let beyond = self.worse(which, (ASSUMPTIONS[which].limit)(&self.limits));
            for (start, end) in stretch.above(&beyond) {
                self.found.see_beyond(which, stretch.of.time(start), (end - start) * arc.span);
            }
        }
    }

    /// Looks for the worst of assumption `which` within `stretch`, where R_v > 0 for the sake of friction.
    fn search(&mut self, which: usize, stretch: &Stretch) {
        loop {
            let worst = self.found.worst[which].value;
            if worst.is_infinite() {
                return;
            }
            let combinations = self.worse(which, worst);
            for combination in &combinations {
                let series = stretch.combination(combination);
                let used = series.used();
                if highest(used, stretch.of.arc.reach) > ROUNDING * self.weight() {
                    extremes::stationary_points(used, stretch.of.arc.reach, |sigma| {
                        let value = self.value(which, &stretch.reactions(sigma));
                        self.found.see(which, value, stretch.of.time(sigma));
                    });
                }
            }
            let now = self.found.worst[which].value;
            // where friction is stationary is not where its combination is, unless with the friction found there
            if which != FRICTION || now <= worst * (1.0 + ROUNDING) {
                return;
            }
        }
    }

    /// Looks at the impulse of an impact at `time` (s), and at the energy it gains over what there was.
    fn see_impact(&mut self, time: f64, Impulse { I_h, I_v, I_m }: Impulse, gain: f64) {
        self.found.impacts += 1;
        let B = self.structure.parameters().B;
        let per_impulse = |of: f64| if I_v > 0.0 { of / I_v } else { f64::INFINITY };
        let values = [
            (IMPACT_FRICTION, per_impulse(I_h.abs())),
            (IMPACT_TENSION, per_impulse(I_m.abs() / B - I_v)),
            (ENERGY, gain),
        ];
        for (which, value) in values {
            self.found.see(which, value, time);
            if value > (ASSUMPTIONS[which].limit)(&self.limits) {
                self.found.see_beyond(which, time, 1.0);
            }
        }
        self.found.gains += u64::from(gain > 0.0);
    }
}

impl Watch for Validity {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        self.found.duration += piece.duration;
        self.found.held += piece.before.chatter.held.min(piece.duration);
        if piece.load.is_vertical() {
            let g = self.structure.parameters().g;
            self.found.see_vertical(g, piece.load.upwards(), piece.before.time, piece.duration);
        }
        let is_leap = piece.arc.is_none() && piece.before.phase == Phase::FullContact;
        let is_restrained = piece.model.level.ties().is_some();
        if is_leap && !is_restrained && !self.leap_may_matter(piece) {
            return;
        }
        let mut arcs = piece.arcs();
        let mut count = 0;
        while let Some(expansion) = arcs.next() {
            if is_restrained || self.arc_may_matter(&expansion) {
                self.look(expansion, FINEST_PART);
            }
            count += 1;
            if count >= MOST_ARCS {
                arcs.skip_middle();
            }
        }
    }

    fn transition(&mut self, transition: &Transition) {
        let &Transition { time, kind, before, after } = transition;
        let structure = &self.structure;
        let (side, phase) = match kind {
            TransitionKind::Impact(side) => (side.opposite(), Phase::Rocking(side)),
            // s θ falls to 0
            TransitionKind::Landing | TransitionKind::Settling => (Side::of(-before.theta_dot), Phase::FullContact),
            TransitionKind::Uplift(_)
            | TransitionKind::Overturning(_)
            | TransitionKind::Yielding(_)
            | TransitionKind::Unloading(_) => return,
        };
        self.found.settlings += u64::from(kind == TransitionKind::Settling);
        if phase == Phase::FullContact && after != impact::land(structure, &before) {
            return; // the rigid limit has come to rest: what is left below the tolerance is no impact
        }
        let kinetic = impact::kinetic_energy(structure, side, &before);
        if kinetic == 0.0 {
            return;
        }
        let gained = match phase {
            Phase::Rocking(_) => impact::energy_gained(structure, side, &before),
            _ => 0.0, // a landing always loses
        };
        let impulse = Impulse::of(structure, (Phase::Rocking(side), &before), (phase, &after));
        self.see_impact(time, impulse, gained / kinetic);
    }
}

/// A polynomial of a motion with its reactions.
struct Stretch<'a> {
    of: Expansion<'a>,
    series: Reactions<Terms>,
}

impl<'a> Stretch<'a> {
    fn new(of: Expansion<'a>) -> Stretch<'a> {
        let Expansion { piece, from, arc } = of;
        let Motion { phase, dissipators, .. } = piece.before;
        let series = reaction_series::series(piece.model, *phase, dissipators, piece.load.from(from), arc);
        Stretch { of, series }
    }

    /// The reactions at `sigma`, from the state there.
    fn reactions(&self, sigma: f64) -> Reactions {
        let Expansion { piece: &Piece { model, before, load, .. }, from, arc } = self.of;
        let motion = Motion { state: arc.at(sigma), ..*before };
        Sample { motion, load: load.at(from + sigma * arc.span), model }.edges()
    }

    /// Whether the series of R_h and R_v end where the state does.
    fn has_converged(&self) -> bool {
        let Reactions { R_h, R_v, .. } = self.reactions(self.of.arc.reach);
        [(&self.series.R_h, R_h), (&self.series.R_v, R_v)].into_iter().all(|(series, expected)| {
            let used = series.used();
            let terms = used.iter().rev().fold(0.0, |sum, c| sum * self.of.arc.reach + c.abs());
            let off = evaluate(used, self.of.arc.reach) - expected;
            // what is no number is not so for want of terms
            off.is_nan() || off.abs() <= CONVERGED.max(1e3 * self.of.piece.model.local_error) * terms
        })
    }

    /// h R_h + v R_v + m R_m + n for [h, v, m, n].
    fn combination(&self, &[h, v, m, n]: &[f64; 4]) -> Terms {
        let Reactions { R_h, R_v, R_m } = &self.series;
        let weighed = [(h, R_h), (v, R_v), (m, R_m)].into_iter().filter(|(weight, _)| *weight != 0.0);
        weighed.fold(Terms::constant(n), |sum, (weight, terms)| sum + *terms * weight)
    }

    /// Where one of `combinations` is positive: from and to, in σ, in their order.
    fn above(&self, combinations: &[[f64; 4]]) -> Vec<(f64, f64)> {
        let mut found: Vec<(f64, f64)> = Vec::new();
        for combination in combinations {
            let series = self.combination(combination);
            let used = series.used();
            if highest(used, self.of.arc.reach) > 0.0 {
                positive(used, self.of.arc.reach, &mut found);
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

/// Adds to `found` where Σ c_k σᵏ is positive up to σ = `reach`, stretch by stretch on which it rises or falls throughout.
fn positive(coefficients: &[f64], reach: f64, found: &mut Vec<(f64, f64)>) {
    let mut start = 0.0;
    let mut look = |end: f64| {
        let is_positive = |sigma: f64| evaluate(coefficients, sigma) > 0.0;
        match [start, end].map(is_positive) {
            [true, true] => found.push((start, end)),
            [true, false] => found.push((start, last_where(start, end, is_positive))),
            [false, true] => found.push((last_where(start, end, |sigma| !is_positive(sigma)), end)),
            [false, false] => (),
        }
        start = end;
    };
    extremes::stationary_points(coefficients, reach, &mut look);
    look(reach);
}

impl Run<'_> {
    /// What the run goes beyond, and how it ended.
    pub fn validity(&self, limits: Limits) -> Result<(Found, Finish), RunError> {
        let mut validity = Validity::new(&self.structure, limits, Found::since(self.ground.start()));
        let finish = self.follow(&mut validity)?;
        Ok((validity.found, finish))
    }
}

/// What the parameters alone say at the level `detail`, before anything moves.
pub fn of_parameters(structure: &Structure, detail: Detail) -> Vec<String> {
    let &Parameters { B, H, g, r, .. } = structure.parameters();
    let &Structure { gamma, omega_fc, u_cr, .. } = structure;
    let mut warnings = Vec::new();
    if detail == Detail::FixedBase {
        return warnings;
    }
    if detail != Detail::Rigid && u_cr > B {
        let balanced = gamma * g * B / (H * omega_fc * omega_fc + g);
        warnings.push(format!(
            "u_cr = {u_cr} m exceeds B = {B} m (H w_fc^2 < gamma g): the base is held down until the top mass is beyond \
             its edge, although from u = {balanced} m on its weight does not keep it there; raise f_fc, or do not \
             believe what follows"
        ));
    }
    let pulling = impact::pulling_restitution(structure);
    if r < pulling {
        warnings.push(format!(
            "r = {r} is below 1 - 2 (m + m0) B^2/J_P = {pulling}: an impact with u = 0 needs an impulse that pulls at \
             one of the edges; raise r, or lower H/B"
        ));
    }
    if detail != Detail::Rigid && impact::greatest_gain(structure, u_cr) > 0.0 {
        let range = match impact::lossless_restitution(structure, u_cr) {
            Some([least, most]) => format!("only r from {least} to {most} cannot"),
            None => "so can any other r".to_owned(),
        };
        warnings.push(format!(
            "r = {r} can raise the energy at an impact with |u| = u_cr: {range}, see docs/explain/failures.md, section 7"
        ));
    }
    warnings
}
