//! State and phase of the structure.

use crate::Structure;
use crate::digits::with_unit;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::structure::NotOneMass;
use crate::structure::quantity::{OutOfRange, Quantity, quantity};
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
    pub fn sign(self) -> f64 {
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
    OnGround(Contact),
}

/// The pressed contact points of the ground, and whether the tendon is slack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Contact {
    /// A bit for each contact point, the lowest for the left edge: whether the point is pressed.
    pub pressed: u32,
    /// Number of contact points.
    pub points: u8,
    /// Whether the tendon is slack.
    pub is_slack: bool,
}

impl Contact {
    /// Whether point `i` is pressed.
    #[inline]
    pub fn is_pressed(self, i: usize) -> bool {
        self.pressed >> i & 1 == 1
    }

    /// Whether all points are pressed.
    pub fn is_full(self) -> bool {
        self.pressed.count_ones() == u32::from(self.points)
    }
}

impl Phase {
    /// No point of ground that gives is pressed.
    pub const FLIGHT: Phase = Phase::OnGround(Contact { pressed: 0, points: 0, is_slack: false });

    /// Name of the phase.
    pub const fn name(self) -> &'static str {
        match self {
            Phase::FullContact => "full contact",
            Phase::Rocking(Side::Left) => "rocking left",
            Phase::Rocking(Side::Right) => "rocking right",
            Phase::Overturned(_) => "overturned",
            Phase::OnGround(Contact { pressed: 0, .. }) => "flight",
            Phase::OnGround(_) => "on ground that gives",
        }
    }

    /// The pivot; the right one in full contact, where it does not matter.
    pub fn side(self) -> Side {
        match self {
            Phase::FullContact | Phase::OnGround(_) => Side::Right,
            Phase::Rocking(side) | Phase::Overturned(side) => side,
        }
    }

    /// The place of the pivot over B: the sign s, or 0 on ground that gives, where the middle of the base is held.
    #[inline]
    pub(crate) fn pivot(self) -> f64 {
        if let Phase::OnGround(_) = self { 0.0 } else { self.side().sign() }
    }

    /// The points that carry the base on ground that gives; otherwise none.
    #[inline]
    pub(crate) fn contact(self) -> Contact {
        if let Phase::OnGround(contact) = self { contact } else { Contact::default() }
    }

    /// This phase as it is shown at the rotation `theta` (rad). On ground that gives, this is full contact if all points are pressed,
    /// flight if none is pressed, and otherwise rocking about the side of θ.
    pub fn shown(self, theta: f64) -> Phase {
        match self {
            Phase::OnGround(contact) if contact.is_full() => Phase::FullContact,
            Phase::OnGround(Contact { pressed: 0, .. }) => Phase::FLIGHT,
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

/// Why an initial state is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages name the fields
pub enum InitialStateError {
    /// One value is outside its own range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The tolerance of the results is out of range.
    #[error("tolerance = {} is out of range: it must be between 0 and 1, such as 1e-9", with_unit(*.0, "1"))]
    Tolerance(f64),
    /// The base turns although both pivots are down.
    #[error(
        "theta_dot_0 = {0:?} rad/s contradicts theta_0 = 0 (full contact, where theta and theta_dot are both 0): \
         set theta_dot_0 to 0, or theta_0 to an angle with the sign of the pivot that the structure rocks about"
    )]
    TurningInFullContact(f64),
    /// The base is turned although it is fixed.
    #[error("theta_0 = {0:?} rad contradicts detail = fixed_base, where the base cannot turn: set theta_0 to 0")]
    TurnedFixedBase(f64),
    /// A restrained structure has no modes.
    #[error(
        "detail = modal has no modes of a structure that is restrained or shaken vertically, whose equations change with \
         time and with what yields: choose linear, or set P_0, k_t, c_d, k_d and a_v to 0"
    )]
    RestrainedModal,
    /// Displacements or velocities of another count than the floors.
    #[error(
        "{name} = {given:?} {unit}: the structure has {floors} floor{}, give a number for each from below, or 0 for all",
        if *floors == 1 { "" } else { "s" }
    )]
    OtherFloors { name: &'static str, unit: &'static str, given: Vec<f64>, floors: usize },
    /// Displacements or velocities that no modes of the structure have.
    #[error(
        "{name}[{floor}] = {given:?} {unit} is out of reach of the {modes} modes, which come as near as {nearest:?} {unit} \
         there: give a sum of their shapes, or keep all modes"
    )]
    NoSuchShape { name: &'static str, unit: &'static str, floor: usize, given: f64, nearest: f64, modes: usize },
    /// The structure has more than one mass.
    #[error(transparent)]
    NotOneMass(#[from] NotOneMass),
    /// Structures of many masses have no such level.
    #[error("detail = {0} moves structures of one mass alone: choose auto, nonlinear, linear, rigid or fixed_base")]
    OneMass(&'static str),
    /// The level has no equations on ground that gives.
    #[error(
        "detail = {0} has no ground that gives: choose auto, nonlinear, rigid or fixed_base, or leave [ground] out"
    )]
    OnGround(&'static str),
    /// Coordinates of modes that the structure does not have.
    #[error(
        "the initial state has {given} coordinates, and {modes} modes move: give one coordinate for each, or 0 for all"
    )]
    Coordinates { given: usize, modes: usize },
    /// The top mass is displaced although the strut is rigid.
    #[error("u_0 = {u:?} m, u_dot_0 = {u_dot:?} m/s contradict detail = rigid, where u is always 0: set both to 0")]
    DeformedRigid { u: f64, u_dot: f64 },
}

/// The most by which a quantity with this `rate` changes over `ahead` (s), whatever accelerates it.
pub(crate) fn way(ahead: f64, rate: f64) -> f64 {
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
    pub fn initial_phase(&self) -> Result<Phase, InitialStateError> {
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
    pub fn on<Q: Coordinates>(&self, structure: &Structure) -> Result<State<Q>, InitialStateError> {
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

fn coordinates<Q: Coordinates>(
    structure: &Structure,
    of: &Quantity<State>,
    given: &[f64],
) -> Result<Q, InitialStateError> {
    let &Quantity { name, unit, .. } = of;
    given.iter().try_for_each(|number| of.check(*number))?;
    let largest = given.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
    let (floors, modes) = (structure.floors(), structure.modes().len());
    if largest == 0.0 {
        return Ok(Q::each(structure, |_, _| 0.0));
    }
    if given.len() != floors.len() {
        return Err(InitialStateError::OtherFloors { name, unit, given: given.into(), floors: floors.len() });
    }
    if structure.one().is_some() {
        return Ok(Q::each(structure, |_, _| given[0]));
    }
    let weighed = |j: usize, by: &dyn Fn(usize) -> f64| {
        floors.iter().enumerate().map(|(i, floor)| floor.mass * floor.shape.of(j) * by(i)).sum::<f64>()
    };
    let mass = DMatrix::from_fn(modes, modes, |j, k| weighed(j, &|i| floors[i].shape.of(k)));
    let solved = mass.cholesky().map(|of| of.solve(&DVector::from_fn(modes, |j, _| weighed(j, &|i| given[i]))));
    let coordinates = solved.unwrap_or_else(|| DVector::zeros(modes));
    let found = Q::each(structure, |j, _| coordinates.get(j).copied().unwrap_or(0.0));
    let nearest = |i: usize| floors[i].displacement(&found);
    match (0..floors.len()).find(|i| (nearest(*i) - given[*i]).abs() > 1e-6 * largest) {
        None => Ok(found),
        Some(i) => {
            let (floor, given, nearest) = (i + 1, given[i], nearest(i));
            Err(InitialStateError::NoSuchShape { name, unit, floor, given, nearest, modes })
        }
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
    pub(crate) fn phase(&self) -> Result<Phase, InitialStateError> {
        if self.theta != 0.0 {
            Ok(Phase::Rocking(Side::of(self.theta)))
        } else if self.theta_dot == 0.0 {
            Ok(Phase::FullContact)
        } else {
            Err(InitialStateError::TurningInFullContact(self.theta_dot))
        }
    }
}
