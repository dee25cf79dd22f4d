//! State and phase of the structure.

use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::structure::ground::Footing;
use crate::structure::quantity::{Quantity, Refused, ensure, quantity};
use crate::{Mode, Structure};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use std::slice::{from_mut, from_ref};

/// State of the structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State<Q = f64> {
    /// Elastic displacement of the top mass in the frame that turns with the base, m; of many masses, a coordinate for each mode.
    pub u: Q,
    /// Rate of u, m/s.
    pub u_dot: Q,
    /// Rotation of the base, rad; positive about the right pivot.
    pub theta: f64,
    /// Rate of θ, rad/s.
    pub theta_dot: f64,
}

/// Names of the components of a state, in the order of [`State::components`].
pub const COMPONENTS: [&str; 4] = ["u", "u_dot", "theta", "theta_dot"];

/// The pivot about which the structure rocks: the sign s of θ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// About the left pivot, θ < 0, s = −1.
    Left,
    /// About the right pivot, θ > 0, s = +1.
    Right,
}

impl Side {
    /// s: +1 right, −1 left.
    pub const fn sign(self) -> f64 {
        match self {
            Side::Left => -1.0,
            Side::Right => 1.0,
        }
    }

    /// The other pivot.
    pub fn opposite(self) -> Side {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }

    /// The side whose sign `x` has; right for 0.
    pub fn of(x: f64) -> Side {
        if x < 0.0 { Side::Left } else { Side::Right }
    }
}

/// Contact of the base with the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Both pivots down: θ = θ̇ = 0, Eq 1.
    FullContact,
    /// Rocking about one pivot: Eqs 5, 6.
    Rocking(Side),
    /// |θ| has reached π/2; the simulation is over.
    Overturned(Side),
    /// On ground that gives, with these points pressed.
    OnGround(PressedPoints),
}

/// The pressed contact points of the ground, and whether the tendon is slack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PressedPoints {
    /// A bit for each contact point, the lowest for the left edge: whether the point is pressed.
    pub pressed: u32,
    /// Number of contact points.
    pub points: u8,
    /// Whether the tendon is slack.
    pub is_slack: bool,
    /// A bit for each contact point that yields.
    pub yields: u32,
    /// The friction of a base that may slide.
    pub friction: Friction,
}

/// The friction under a base on ground that gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Friction {
    /// The base sticks, or is held.
    #[default]
    Sticks,
    /// The base slides to this side.
    Slides(Side),
    /// The base, which may slide, touches nothing.
    Free,
}

impl Friction {
    /// The sign of the velocity over the ground; 0 if the base sticks or flies.
    pub fn sign(self) -> f64 {
        if let Friction::Slides(side) = self { side.sign() } else { 0.0 }
    }
}

impl PressedPoints {
    /// Nothing is pressed.
    pub const NONE: PressedPoints =
        PressedPoints { pressed: 0, points: 0, is_slack: false, yields: 0, friction: Friction::Sticks };

    /// Whether point `i` yields.
    #[inline]
    pub fn yields(self, i: usize) -> bool {
        self.yields >> i & 1 == 1
    }

    /// Whether point `i` is pressed.
    #[inline]
    pub fn is_pressed(self, i: usize) -> bool {
        self.pressed >> i & 1 == 1
    }

    /// Whether there are points and all are pressed.
    pub fn is_full(self) -> bool {
        self.pressed != 0 && self.pressed.count_ones() == u32::from(self.points)
    }
}

/// All that is asked of a phase.
#[derive(Clone, Copy, Debug)]
pub struct Properties {
    /// Name.
    pub name: &'static str,
    /// The pivot; the right one where no pivot matters.
    pub side: Side,
    /// The place of the pivot over B: the sign s, or 0 where the middle of the base is held.
    pub pivot: f64,
    /// Whether both edges are down, so that θ = θ̇ = 0.
    pub is_down: bool,
    /// Whether the base turns about a pivot, or has done so until it overturned.
    pub rotates: bool,
    /// Whether the simulation is over.
    pub is_over: bool,
    /// Whether a level may know the end of a step without an expansion.
    pub may_leap: bool,
    /// Whether the base touches nothing.
    pub is_free: bool,
}

impl Phase {
    /// No point of ground that gives is pressed.
    pub const FLIGHT: Phase = Phase::OnGround(PressedPoints::NONE);

    /// The phases that are [shown](Phase::shown), in the order in which the FMU numbers them; both sides of overturning are one.
    pub const SHOWN: [Phase; 5] = [
        Phase::FullContact,
        Phase::Rocking(Side::Left),
        Phase::Rocking(Side::Right),
        Phase::Overturned(Side::Right),
        Phase::FLIGHT,
    ];

    /// The properties of the phase.
    #[inline(always)]
    pub const fn properties(self) -> Properties {
        let still = Properties {
            name: "",
            side: Side::Right,
            pivot: 1.0,
            is_down: false,
            rotates: false,
            is_over: false,
            may_leap: false,
            is_free: false,
        };
        match self {
            Phase::FullContact => Properties { name: "full contact", is_down: true, may_leap: true, ..still },
            Phase::Rocking(side) => {
                let name = if let Side::Left = side { "rocking left" } else { "rocking right" };
                Properties { name, side, pivot: side.sign(), rotates: true, may_leap: true, ..still }
            }
            Phase::Overturned(side) => {
                Properties { name: "overturned", side, pivot: side.sign(), rotates: true, is_over: true, ..still }
            }
            Phase::OnGround(PressedPoints { pressed: 0, .. }) => {
                Properties { name: "flight", pivot: 0.0, is_free: true, ..still }
            }
            Phase::OnGround(_) => Properties { name: "on ground that gives", pivot: 0.0, ..still },
        }
    }

    /// Name of the phase.
    pub const fn name(self) -> &'static str {
        self.properties().name
    }

    /// The place of a phase among [`Phase::SHOWN`], which has it.
    pub fn number(self) -> usize {
        Phase::SHOWN.iter().position(|of| of.name() == self.name()).expect("it is shown")
    }

    /// The pivot; the right one where no pivot matters.
    #[inline]
    pub const fn side(self) -> Side {
        self.properties().side
    }

    /// The points that carry the base on ground that gives; otherwise none.
    #[inline]
    pub(crate) fn contact(self) -> PressedPoints {
        if let Phase::OnGround(contact) = self { contact } else { PressedPoints::default() }
    }

    /// This phase as it is shown at the rotation `theta` (rad). On ground that gives, this is full contact if all points are pressed,
    /// flight if none is pressed, and otherwise rocking about the side of θ.
    pub fn shown(self, theta: f64) -> Phase {
        match self {
            Phase::OnGround(contact) if contact.is_full() => Phase::FullContact,
            Phase::OnGround(PressedPoints { pressed: 0, .. }) => Phase::FLIGHT,
            Phase::OnGround(_) => Phase::Rocking(Side::of(theta)),
            phase => phase,
        }
    }

    /// This phase, or the phase in which `structure` overturned.
    pub(crate) fn in_motion(self, structure: &Structure) -> Phase {
        match self {
            Phase::Overturned(_) if structure.foundation().is_some() => Phase::FLIGHT,
            Phase::Overturned(side) => Phase::Rocking(side),
            phase => phase,
        }
    }
}

/// The initial values with their units and ranges, under their names in files and in the FMU.
pub const INITIAL_VALUES: [Quantity<State>; 4] = [
    quantity!("theta_0", theta["rad"] - 1.5, 1.5, "initial rotation of the base; 0 is full contact"),
    quantity!("theta_dot_0", theta_dot["rad/s"] - 1e3, 1e3, "initial angular velocity of the base"),
    quantity!("u_0", u["m"] - 1e4, 1e4, "initial elastic displacement of the top mass"),
    quantity!("u_dot_0", u_dot["m/s"] - 1e4, 1e4, "initial elastic velocity of the top mass"),
];

/// The most by which a quantity with this `rate` changes over `ahead` (s): an acceleration below 2/`ahead`, which is 1e8 in SI units and more
/// for the tiny times in question, adds less than `ahead` times 1.
pub(crate) fn most_change(ahead: f64, rate: f64) -> f64 {
    ahead * (rate.abs() + 1.0)
}

impl State {
    /// u, u̇, θ, θ̇ in m, m/s, rad, rad/s.
    pub fn components(&self) -> [f64; 4] {
        [self.u, self.u_dot, self.theta, self.theta_dot]
    }

    /// The state with these components.
    pub fn of([u, u_dot, theta, theta_dot]: [f64; 4]) -> State {
        State { u, u_dot, theta, theta_dot }
    }

    /// The phase that this state starts in: full contact for θ = 0, otherwise rocking about the side of θ's sign.
    pub fn initial_phase(&self) -> Result<Phase, Refused> {
        for quantity in &INITIAL_VALUES {
            quantity.check((quantity.get)(self))?;
        }
        self.phase()
    }
}

/// u and u̇ of each floor from below, or of none, which is 0 for all; of one mass those of the top mass.
impl State<Vec<f64>> {
    /// The numbers under each name of [`INITIAL_VALUES`].
    pub fn numbers(&self) -> [&[f64]; 4] {
        [from_ref(&self.theta), from_ref(&self.theta_dot), &self.u, &self.u_dot]
    }

    /// These numbers, to be changed.
    pub fn numbers_mut(&mut self) -> [&mut [f64]; 4] {
        [from_mut(&mut self.theta), from_mut(&mut self.theta_dot), &mut self.u, &mut self.u_dot]
    }

    /// Sets the numbers under the name of [`INITIAL_VALUES`] at this place.
    pub fn set(&mut self, place: usize, numbers: Vec<f64>) {
        match place {
            0 => self.theta = numbers[0],
            1 => self.theta_dot = numbers[0],
            2 => self.u = numbers,
            _ => self.u_dot = numbers,
        }
    }

    /// The coordinates q of the modes of `structure` whose floors move as these do. The nearest, weighed by mass, solve
    /// (ΦᵀMΦ) q = ΦᵀM u; refused are floors that stay away from them by more than 1e-6 of the largest.
    pub fn on<Q: Coordinates>(&self, structure: &Structure) -> Result<State<Q>, Refused> {
        let &State { ref u, ref u_dot, theta, theta_dot } = self;
        let [of_u, of_rate] = [&INITIAL_VALUES[2], &INITIAL_VALUES[3]];
        Ok(State {
            u: coordinates(structure, of_u, u)?,
            u_dot: coordinates(structure, of_rate, u_dot)?,
            theta,
            theta_dot,
        })
    }
}

fn coordinates<Q: Coordinates>(structure: &Structure, of: &Quantity<State>, given: &[f64]) -> Result<Q, Refused> {
    let &Quantity { name, unit, .. } = of;
    given.iter().try_for_each(|number| of.check(*number))?;
    let largest = given.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
    let (floors, modes) = (structure.floors(), structure.modes().len());
    if largest == 0.0 {
        return Ok(Q::each(structure, |_, _| 0.0));
    }
    ensure(given.len() == floors.len(), || {
        let (count, s) = (floors.len(), if floors.len() == 1 { "" } else { "s" });
        format!(
            "{name} = {given:?} {unit}: the structure has {count} floor{s}, give a number for each from below, or 0 for all"
        )
    })?;
    if structure.one().is_some() {
        return Ok(Q::each(structure, |_, _| given[0]));
    }
    let weighed = |j: usize, by: &dyn Fn(usize) -> f64| {
        floors.iter().enumerate().map(|(i, floor)| floor.mass * floor.shape.of(j) * by(i)).sum::<f64>()
    };
    let mass = DMatrix::from_fn(modes, modes, |j, k| weighed(j, &|i| floors[i].shape.of(k)));
    let solved = mass.cholesky().map(|of| of.solve(&DVector::from_fn(modes, |j, _| weighed(j, &|i| given[i]))));
    let found = Q::each(structure, |j, _| solved.as_ref().and_then(|of| of.get(j)).copied().unwrap_or(0.0));
    let nearest = |i: usize| floors[i].displacement(&found);
    for (i, given) in given.iter().enumerate() {
        ensure((nearest(i) - given).abs() <= 1e-6 * largest, || {
            format!(
                "{name}[{}] = {given:?} {unit} is out of reach of the {modes} modes, which come as near as {:?} {unit} there: give a \
                 sum of their shapes, or keep all modes",
                i + 1,
                nearest(i)
            )
        })?;
    }
    Ok(found)
}

impl Structure {
    /// Usual magnitudes in a motion: of each mode, as if the mode had all mass, where the base is about to lift off statically; the
    /// angle at which the structure falls; and the rates that belong to them.
    pub fn usual<Q: Coordinates>(&self) -> State<Q> {
        let reach = self.body().m_s.sqrt() * self.base().hold_at_rest() / self.body().S_1;
        let u = |mode: &Mode| reach * mode.mass.sqrt() / mode.stiffness;
        let u_dot = |_: usize, mode: &Mode| u(mode) * mode.omega();
        let theta = libm::atan(self.base().tan_alpha_cg);
        let theta_dot = self.base().p_l * theta;
        let mut usual = State { u: Q::each(self, |_, mode| u(mode)), u_dot: Q::each(self, u_dot), theta, theta_dot };
        if let Some(foundation) = self.foundation() {
            let settled = foundation.y_s.abs();
            let rate = (self.base().g * settled).sqrt();
            for (of, y) in [(&mut usual.u, settled), (&mut usual.u_dot, rate)] {
                of.set_footing(foundation, Footing { y, ..of.footing(foundation) });
                foundation.slide().into_iter().for_each(|place| of.set(place, y));
            }
        }
        usual
    }
}

impl<Q: Coordinates> State<Q> {
    /// No bounds of the state of `structure`.
    pub(crate) fn unbounded(structure: &Structure) -> State<Q> {
        let none = Q::each(structure, |_, _| f64::INFINITY);
        State { u: none, u_dot: none, theta: f64::INFINITY, theta_dot: f64::INFINITY }
    }

    /// Whether all components are finite numbers.
    pub fn is_finite(&self) -> bool {
        // one instruction where f64::is_finite takes a dozen
        (self.u.total() + self.u_dot.total() + self.theta + self.theta_dot).abs() <= f64::MAX
    }

    /// The phase by θ and θ̇.
    pub(crate) fn phase(&self) -> Result<Phase, Refused> {
        ensure(self.theta != 0.0 || self.theta_dot == 0.0, || {
            format!(
                "theta_dot_0 = {:?} rad/s contradicts theta_0 = 0 (full contact, where theta and theta_dot are both 0): set theta_dot_0 \
                 to 0, or theta_0 to an angle with the sign of the pivot that the structure rocks about",
                self.theta_dot
            )
        })?;
        Ok(if self.theta == 0.0 { Phase::FullContact } else { Phase::Rocking(Side::of(self.theta)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shown_phase_is_shown_as_it_is() {
        let on = |pressed, points| Phase::OnGround(PressedPoints { pressed, points, ..PressedPoints::NONE });
        let sides =
            [Side::Left, Side::Right].into_iter().flat_map(|side| [Phase::Rocking(side), Phase::Overturned(side)]);
        for phase in sides.chain([Phase::FullContact, Phase::FLIGHT, on(0, 2), on(1, 2), on(2, 2), on(3, 2)]) {
            for theta in [-0.1, 0.0, 0.1] {
                let shown = phase.shown(theta);
                assert_eq!(shown.shown(theta), shown);
                assert_eq!(shown == Phase::FLIGHT, phase.name() == "flight");
            }
        }
    }
}
