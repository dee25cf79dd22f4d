//! The outputs of a structure at an instant: of its base, its floors and its storeys (Eqs 2, 3, 23–27). One mass has one floor.
//!
//! ```text
//! a_t = ü + H θ̈ + θ̇² (sB − u) + a_g cos θ          (full contact: ü + a_g)                       (27)
//! ```
//!
//! By (5) this is g sin θ − (c_u u̇ + k u)/m + (F_t/m) cos θ, and by (1) −(c_fc u̇ + k u)/m + F_t/m in full contact. The outputs
//! therefore depend on the state and on F_t only. The levels with linear equations use Eq 5, too, instead of their own ü and θ̈.
//! Mass that no mode carries is the exception: its acceleration follows from θ̈ and the ground acceleration
//! ([`Gauge`]).
//!
//! A formula reads the motion in numbers of any kind: at an instant, as bounds, or as series in time over a polynomial of the
//! motion. All else that is known of an output is its row in `outputs!`. Columns, peaks, bounds and variables follow from both.

use crate::mechanics::instant::{Instant, MassPoint, uplift};
use crate::mechanics::lateral::{Coordinates, Duals, Lateral};
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{Dissipators, Kept};
use crate::mechanics::shown::{Legend, Place, UNITS};
use crate::numbers::dual::Dual;
use crate::numbers::{Number, Ordered};
use crate::structure::gauge::Gauge;
use crate::structure::mode::Modes;
use crate::structure::parameters::PARAMETERS;
use crate::{Base, Foundation, Phase, State, Structure};
use serde::{Deserialize, Serialize};

/// The part of a structure that has an output, on ground that gives but for the first two. Contact points are shown if there are more than the outer ones, edges
/// as parts of other outputs, and ties beside the outputs.
#[derive(Clone, Copy, PartialEq)]
enum Owner {
    Base,
    Floor,
    Ground,
    Points,
    Point,
    Edge,
    Tie,
    Slide,
    Yield,
    YieldingPoint,
}

/// How the largest magnitude of an output is searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Search {
    /// Not at all, or with those of all ties.
    None,
    /// It is the largest of its [parts](Output::parts).
    Parts,
    /// The output is linear in components of the motion.
    Component,
    /// The output is linear in magnitudes: of u, u̇, F_t, sin θ and 1 − cos θ.
    Linear,
    /// The output is none of these: its bound is the formula itself in bounds of the magnitudes.
    Curved,
}

/// All that is known of an output beside its formula.
struct OutputRow {
    name: &'static str,
    unit: &'static str,
    /// `#` stands for the number of a floor.
    description: &'static str,
    of: Owner,
    /// If one mass has it, its place among the columns and, if it has a peak, among the peaks.
    of_one: &'static [usize],
    search: Search,
    /// The variables of an FMU that it follows from directly; a state follows from what it starts from.
    from: &'static [&'static str],
    /// If a picture shows it.
    legend: Option<Legend>,
}

/// The places of an output that all pictures over time show.
const EVERYWHERE: &[Place] = &[Place::Histories, Place::OneMass, Place::Page, Place::Numbers];

/// Declares [`Output`] by its rows: name, unit, description and what the documentation adds; label, symbol and places of an output that
/// pictures show; and the rest of [`OutputRow`] in its order.
macro_rules! outputs {
    ($($name:ident $(($i:ident: $number:ty))? [$unit:literal] $description:literal $($more:literal)?,
        $({ $label:literal $symbol:literal $places:expr })? $of:ident $of_one:tt $search:ident, $from:expr;)*) => {
        /// An output of a structure. Floors and storeys count from 0, from below; storey i is below floor i.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[allow(non_camel_case_types)] // the names of the outputs
        pub enum Output {
            $(
                #[doc = concat!("The ", $description, $(", ", $symbol,)? $(", ", $more,)? ", ", $unit, ".")]
                $name $(($number))?,
            )*
        }

        /// The first of each output.
        const EACH: &[Output] = &[$(Output::$name $(({ let $i: $number = 0; $i }))?),*];

        /// How many columns and peaks one mass has.
        const OF_ONE: [usize; 2] = [0 $(+ (<[usize]>::len(&$of_one) > 0) as usize)*, 0 $(+ (<[usize]>::len(&$of_one) > 1) as usize)*];

        impl Output {
            const fn row(self) -> &'static OutputRow {
                match self {
                    $(Output::$name { .. } => const { &OutputRow {
                        name: stringify!($name), unit: $unit, description: $description, of: Owner::$of, of_one: &$of_one,
                        search: Search::$search, from: $from,
                        legend: [$(Some(Legend { label: $label, symbol: $symbol, places: $places }),)? None][0],
                    } },)*
                }
            }

            /// The number of the floor, point or edge that has it.
            pub fn number(self) -> Option<usize> {
                match self {
                    $(Output::$name $(($i))? => [$(Some($i),)? None][0],)*
                }
            }

            /// The same output of the floor, point or edge of another `number`.
            fn numbered(self, number: usize) -> Output {
                match self {
                    $(Output::$name { .. } => Output::$name $(({ let $i: $number = number; $i }))?,)*
                }
            }
        }
    };
}

/// The variables of an FMU that accelerations follow from: the load, the motion, the level, and all parameters but r.
pub const ACCELERATION: &[&str] = &{
    const OTHERS: [&str; 10] =
        ["a_ground", "F_t", "a_v_ground", "u", "u_dot", "theta", "theta_dot", "detail", "s", "f_v"];
    let (mut names, mut count, mut i) = ([""; OTHERS.len() + PARAMETERS.len() - 1], OTHERS.len(), 0);
    names.split_at_mut(count).0.copy_from_slice(&OTHERS);
    while i < PARAMETERS.len() {
        if !matches!(PARAMETERS[i].name.as_bytes(), b"r") {
            names[count] = PARAMETERS[i].name;
            count += 1;
        }
        i += 1;
    }
    names
};

/// The variables of an FMU that forces of contact points follow from.
pub const CONTACT: &[&str] = &["y", "y_dot", "theta", "theta_dot", "s", "f_v"];

/// The variables of an FMU that forces of dissipators follow from.
const DISSIPATORS: &[&str] = &["theta", "theta_dot", "B", "xi_d", "c_d", "k_d", "F_y"];

use Place::{Feet, Floors, Histories, Numbers, OneMass, Page, PageOnGround, Scene, Storeys};

outputs! {
    theta ["rad"] "rotation of the base, positive about the right edge", { "rotation" "θ" EVERYWHERE } Base [0, 0] Component, &[];
    theta_dot ["rad/s"] "angular velocity of the base" "θ̇", Base [5] None, &[];
    uplift ["m"] "uplift of the free edge of the base (Eq 25)" "2 B sin|θ|", { "uplift" "δ_u" &[PageOnGround, Numbers] }
        Base [7, 3] Parts, &["theta", "B", "y"];
    V_t ["N"] "base shear if all F_t are 0: the sum of m a_t (Eqs 2, 23)", { "base shear" "V_t" &[Page, Numbers] }
        Base [3, 5] Linear, ACCELERATION;
    M_t ["N.m"] "overturning moment if all F_t are 0: the sum of m h a_t (Eqs 3, 24)", { "overturning moment" "M_t" &[Numbers] }
        Base [4, 6] Linear, ACCELERATION;
    y ["m"] "height of the middle of the base above the unloaded ground" "on ground that gives as all that follow but those of floors and ties",
        { "height of the base" "y" &[Scene] } Ground [] None, &[];
    settlement ["m"] "settlement of the lower outer contact point" "rotation included, −min(e); the middle of the base settles by −y",
        { "settlement of the lower edge" "s" &[PageOnGround, Numbers] } Ground [] Parts, &["y", "theta", "f_v"];
    contact ["1"] "stiffness of the pressed contact points over the stiffness of all", Ground [] None, &[];
    E_foundation ["J"] "energy that the ground has taken", Ground [] None, &[];
    x ["m"] "way of the middle of the base over the ground, to the right", { "way of the base" "x" &[Scene, PageOnGround, Numbers] }
        Slide [] Component, &[];
    x_dot ["m/s"] "velocity of the middle of the base over the ground", Slide [] None, &[];
    slip_path ["m"] "sum of the slips of the base", Slide [] None, &[];
    E_friction ["J"] "energy that friction has taken", Slide [] None, &[];
    settled ["m"] "mean settlement of the contact points for good", Yield [] None, &["s"];
    tilt ["rad"] "rotation of the contact points for good", Yield [] None, &["s"];
    E_plastic ["J"] "energy that settling for good has taken", Yield [] None, &[];
    s(i: usize) ["m"] "settlement of contact point # for good, from the left", YieldingPoint [] None, &[];
    N_left ["N"] "force of the left outer contact point", { "force of the left edge" "N_left" &[PageOnGround, Numbers] }
        Ground [] Parts, CONTACT;
    N_right ["N"] "force of the right outer contact point", { "force of the right edge" "N_right" &[PageOnGround, Numbers] }
        Ground [] Parts, CONTACT;
    pressure ["N/m"] "largest pressure under the base: the mean over the outer sixth at each edge, or of an inner point over its strip",
        Points [] Parts, CONTACT;
    N(i: usize) ["N"] "force of contact point # from the left", Point [] Component, CONTACT;
    u(i: usize) ["m"] "elastic displacement of floor # in the frame that turns with the base", { "elastic displacement" "u" EVERYWHERE }
        Floor [1, 1] Component, &["u"];
    u_dot(i: usize) ["m/s"] "elastic velocity of floor #" "u̇_i", Floor [6] None, &["u_dot"];
    drift(i: usize) ["m"] "drift of storey #" "u_i − u_{i−1}", { "drift" "drift" &[Storeys] } Floor [] Component, &["u"];
    drift_ratio(i: usize) ["1"] "drift of storey # over its height", Floor [] Component, &["u"];
    delta_t(i: usize) ["m"] "lateral displacement of floor # relative to the ground (Eq 26)" "sB (1 − cos θ) + u_i cos θ + h_i sin θ",
        { "displacement" "δ_t" &[OneMass, Numbers] } Floor [8, 2] Linear, &["u", "theta", "H", "B", "x"];
    v_t(i: usize) ["m/s"] "lateral velocity of floor # relative to the ground" "u̇_i cos θ + [(sB − u_i) sin θ + h_i cos θ] θ̇",
        Floor [9] None, &["u", "u_dot", "theta", "theta_dot", "H", "B", "x_dot"];
    a_t(i: usize) ["m/s2"] "lateral acceleration of floor #, ground included (Eq 27)" "along the turning e_x",
        { "acceleration" "a_t" &[Histories, OneMass, Page, Numbers, Floors] } Floor [2, 4] Linear, ACCELERATION;
    V(i: usize) ["N"] "shear of storey # if all F_t are 0: the sum of m a_t above it", { "storey shear" "V" &[Storeys] }
        Floor [] Linear, ACCELERATION;
    M(i: usize) ["N.m"] "overturning moment at the foot of storey # if all F_t are 0", { "storey moment" "M" &[Feet] }
        Floor [] Linear, ACCELERATION;
    sunk(i: usize) ["m"] "settlement of outer contact point #" "left (0) or right (1), or 0 above the unloaded ground",
        Edge [] Component, &[];
    lifted(i: usize) ["m"] "height of edge # above the unloaded ground" "left (0) or right (1), or 0 below",
        Edge [] Component, &[];
    edge(i: usize) ["N/m"] "mean pressure over the outer sixth of the base at edge #" "left (0) or right (1)",
        Edge [] Component, &[];
    P_t ["N"] "force of the tendon", Tie [] Component, &["theta", "B", "P_0", "k_t"];
    F_d1 ["N"] "force of the dissipators at +xi_d, viscous plus elastoplastic; tension is positive" "which a sample has",
        Tie [] None, DISSIPATORS;
    F_d2 ["N"] "force of the dissipators at -xi_d; see F_d1" "which a sample has", Tie [] None, DISSIPATORS;
}

use Output::{
    E_foundation, E_friction, E_plastic, M, M_t, N, N_left, N_right, V, V_t, a_t, contact, delta_t, drift, drift_ratio,
    edge,
};
use Output::{F_d1, F_d2, P_t, lifted, pressure, settled, settlement, slip_path, sunk, theta, theta_dot, tilt};
use Output::{u, u_dot, v_t, x_dot, y};

/// The outputs of one mass, each at its place among the columns (0) or peaks (1).
const fn of_one<const N: usize>(which: usize) -> [Output; N] {
    let (mut all, mut is_taken, mut i) = ([theta; N], [false; N], 0);
    while i < EACH.len() {
        let &OutputRow { of_one: places, search, .. } = EACH[i].row();
        if which < places.len() {
            assert!((places.len() == 1) == matches!(search, Search::None), "one mass has the peaks of many masses");
            assert!(!is_taken[places[which]], "two outputs of one mass have the same place");
            (all[places[which]], is_taken[places[which]]) = (EACH[i], true);
        }
        i += 1;
    }
    all
}

/// These outputs `of_one` mass, and those among `all` of ground that gives.
fn with_ground(of_one: &[Output], all: impl Iterator<Item = Output>) -> Vec<Output> {
    of_one.iter().copied().chain(all.filter(|of| of.is_of_ground())).collect()
}

impl Output {
    /// The outputs of one mass, in the order of their columns.
    const OF_ONE: [Output; OF_ONE[0]] = of_one(0);

    /// The outputs of one mass that have a peak, in the order of their peaks.
    pub const PEAKS_OF_ONE: [Output; OF_ONE[1]] = of_one(1);

    /// The forces of a tendon and of dissipators.
    pub const OF_TIES: [Output; 3] = [P_t, F_d1, F_d2];

    /// The outputs of `structure` that are meant, in the order of their rows.
    fn meant(structure: &Structure, is_meant: impl Fn(&OutputRow) -> bool) -> impl Iterator<Item = Output> {
        let points = structure.foundation().map_or(0, |foundation| foundation.points.len());
        let slides = usize::from(structure.foundation().is_some_and(|of| of.mu_c.is_some()));
        let yielding = if structure.foundation().is_some_and(|of| of.yields) { points } else { 0 };
        let count = move |of: Owner| match of {
            Owner::Slide => slides,
            Owner::Yield => yielding.min(1),
            Owner::YieldingPoint => yielding,
            Owner::Base => 1,
            Owner::Floor => structure.floors().len(),
            Owner::Ground | Owner::Points | Owner::Tie => points.min(1),
            Owner::Point => points,
            Owner::Edge => points.min(2),
        };
        let is_one = structure.is_one_mass();
        let is_of_many =
            move |row: &OutputRow| is_one && row.of_one.is_empty() && matches!(row.of, Owner::Base | Owner::Floor);
        let meant = EACH.iter().filter(move |of| is_meant(of.row()) && !is_of_many(of.row()));
        meant.flat_map(move |of| (0..count(of.row().of)).map(|number| of.numbered(number)))
    }

    /// All outputs of `structure` in the order of their columns: of one mass its own and those of ground that gives; of many masses those
    /// of the base, of the ground, then each output of the floors from below.
    pub fn all(structure: &Structure) -> Vec<Output> {
        // two floors at the same height have a drift and no storey
        let is_one = |of: &Output| of.displaced(structure).is_none_or(|(_, factor)| factor.is_finite());
        let has_inner = structure.foundation().is_some_and(|foundation| foundation.points.len() > 2);
        let is_column = |row: &OutputRow| match row.of {
            Owner::Base | Owner::Floor | Owner::Ground | Owner::Slide | Owner::Yield | Owner::YieldingPoint => true,
            Owner::Points | Owner::Point => has_inner,
            Owner::Edge | Owner::Tie => false,
        };
        let all = Output::meant(structure, is_column).filter(is_one);
        if structure.is_one_mass() { with_ground(&Output::OF_ONE, all) } else { all.collect() }
    }

    /// The outputs of `structure` that have a peak, in the order of their peaks; the forces of its tendon and of its dissipators last.
    pub fn with_peak(structure: &Structure) -> Vec<Output> {
        let base = structure.base();
        let all = Output::all(structure);
        let mut all = if structure.is_one_mass() { with_ground(&Output::PEAKS_OF_ONE, all.into_iter()) } else { all };
        all.retain(|of| of.search() != Search::None);
        all.extend(
            Output::OF_TIES.iter().filter(|of| if **of == P_t { base.has_tendon() } else { base.has_dissipators() }),
        );
        all
    }

    /// What people read of it, if a picture shows it.
    pub fn legend(self) -> Option<&'static Legend> {
        self.row().legend.as_ref()
    }

    /// Whether a place shows it which is `meant`.
    fn is_shown(self, meant: impl Fn(Place) -> bool) -> bool {
        self.row().legend.is_some_and(|legend| legend.places.iter().any(|place| meant(*place)))
    }

    /// The outputs of `structure` that `place` shows, in the order of their units and rows, those of ground that gives last.
    pub fn shown_in(place: Place, structure: &Structure) -> Vec<Output> {
        let is_there = match place {
            Place::PageOnGround => structure.foundation().is_some(),
            Place::OneMass => structure.is_one_mass(),
            _ => true,
        };
        let mut shown = Output::all(structure);
        shown.retain(|output| is_there && output.is_shown(|of| of == place));
        let rank = |of: &Output| UNITS.iter().position(|unit| unit.1 == of.unit()).unwrap_or(UNITS.len());
        let row = |of: &Output| EACH.iter().position(|each| each.symbol() == of.symbol());
        shown.sort_by_key(|of| (of.is_of_ground(), rank(of), row(of)));
        shown
    }

    /// The outputs of `structure` at the points of a picture over time, and the forces of ties.
    pub fn drawn(structure: &Structure) -> Vec<Output> {
        let ties = Output::OF_TIES.into_iter().filter(|_| structure.base().is_restrained());
        let is_drawn = |output: &Output| output.is_shown(|place| place < Place::Floors);
        Output::all(structure).into_iter().filter(is_drawn).chain(ties).collect()
    }

    /// The outputs of a floor or storey that pictures over the height show, and where.
    pub fn over_height() -> impl Iterator<Item = (Output, Place)> {
        let at =
            |place| EACH.iter().filter(move |output| output.is_shown(|of| of == place)).map(move |of| (*of, place));
        [Place::Floors, Place::Storeys, Place::Feet].into_iter().flat_map(at)
    }

    /// The outputs of `structure` whose bounds are found for a search of their own.
    pub(crate) fn bounded(structure: &Structure) -> impl Iterator<Item = Output> {
        Output::meant(structure, |row| !matches!(row.search, Search::None | Search::Parts))
    }

    /// How its largest magnitude is searched.
    pub(crate) fn search(self) -> Search {
        self.row().search
    }

    /// Whether the output is linear in components of the motion.
    pub(crate) fn is_component(self) -> bool {
        self.search() == Search::Component
    }

    /// Whether it is of ground that gives or of ties.
    pub fn is_of_ground(self) -> bool {
        !matches!(self.row().of, Owner::Base | Owner::Floor)
    }

    /// The name of an output of `structure`, of many masses with the number of the floor or storey from 1: `a_t[3]`.
    pub fn name(self, structure: &Structure) -> String {
        match self.number() {
            Some(number) if !structure.is_one_mass() || self.is_of_ground() => {
                format!("{}[{}]", self.symbol(), number + 1)
            }
            _ => self.symbol().into(),
        }
    }

    /// The symbol without a number, the same for all floors.
    pub const fn symbol(self) -> &'static str {
        self.row().name
    }

    /// The unit.
    pub const fn unit(self) -> &'static str {
        self.row().unit
    }

    /// The description, in which `#` stands for the number of a floor.
    pub const fn text(self) -> &'static str {
        self.row().description
    }

    /// The description of an output of `structure`.
    pub fn description(self, structure: &Structure) -> String {
        let OutputRow { description, .. } = self.row();
        match self.number() {
            Some(_) if structure.is_one_mass() && !self.is_of_ground() => {
                description.replace("floor #", "the top mass")
            }
            Some(number) => description.replace('#', &(number + 1).to_string()),
            None => (*description).into(),
        }
    }

    /// The names of the variables of an FMU that it follows from directly.
    pub fn follows_from(self) -> &'static [&'static str] {
        self.row().from
    }

    /// Whether the output of `structure` depends on the ground acceleration directly.
    pub fn has_feedthrough(self, structure: &Structure) -> bool {
        self.gauge(structure).is_some_and(Gauge::has_feedthrough)
    }

    /// The outputs of `structure` on ground that gives of whose peaks the largest is the peak of this one, each with its factor.
    pub(crate) fn parts(self, structure: &Structure) -> impl Iterator<Item = (Output, f64)> {
        structure.foundation().into_iter().flat_map(move |foundation| {
            let last = foundation.points.len() - 1;
            let (first, second, inner) = match self {
                Output::uplift => (Some(lifted(0)), Some(lifted(1)), 1..1),
                settlement => (Some(sunk(0)), Some(sunk(1)), 1..1),
                N_left => (Some(N(0)), None, 1..1),
                N_right => (Some(N(last)), None, 1..1),
                pressure => (Some(edge(0)), Some(edge(1)), 1..last),
                _ => (None, None, 1..1),
            };
            let width = |[from, to]: [f64; 2]| to - from;
            let inner = inner.map(move |i| (N(i), 1.0 / width(foundation.strip(i, structure.base().B))));
            first.into_iter().chain(second).map(|of| (of, 1.0)).chain(inner)
        })
    }

    /// The output as a multiple of `other`, if it is one in every motion of `structure`.
    pub fn over(self, other: Output, structure: &Structure) -> Option<f64> {
        match [self, other].map(|of| of.displaced(structure)) {
            [Some((shape, factor)), Some((other, of_other))] => (shape == other).then(|| factor / of_other),
            [None, None] => self.gauge(structure)?.over(other.gauge(structure)?),
            _ => None,
        }
    }

    /// Of a displacement, the shape in the modes and the factor.
    #[inline]
    fn displaced(self, structure: &Structure) -> Option<(&Modes, f64)> {
        let (floors, drifts) = (structure.floors(), &structure.gauges().drift);
        match self {
            u(i) => Some((&floors[i].shape, 1.0)),
            drift(i) => Some((&drifts[i], 1.0)),
            drift_ratio(i) => {
                let foot = if i == 0 { 0.0 } else { floors[i - 1].height };
                Some((&drifts[i], 1.0 / (floors[i].height - foot)))
            }
            _ => None,
        }
    }

    /// The gauge that measures the output.
    #[inline(always)]
    pub(crate) fn gauge(self, structure: &Structure) -> Option<&Gauge> {
        let gauges = structure.gauges();
        match self {
            V_t => Some(&gauges.V_t),
            M_t => Some(&gauges.M_t),
            a_t(i) => Some(&gauges.a[i]),
            V(i) => Some(&gauges.V[i]),
            M(i) => Some(&gauges.M[i]),
            _ => None,
        }
    }

    /// The output of `structure`, all of whose mass the modes carry, in `phase` and `state` under `load`.
    pub fn at<Q: Coordinates>(self, structure: &Structure, phase: Phase, state: &State<Q>, load: Load<Q>) -> f64 {
        self.of(&Instant::of(structure, phase, state, load))
    }

    /// ξ, k, c and offset of an output that is the positive part of offset + k e + c ė of the height e at ξ, or 0.
    pub(crate) fn of_height(self, base: &Base, Foundation { points, y_s, .. }: &Foundation) -> Option<[f64; 4]> {
        match self {
            N(i) => points.get(i).map(|point| [point.xi, -point.k, -point.c, 0.0]),
            sunk(i) => Some([points[i * (points.len() - 1)].xi, -1.0, 0.0, 0.0]),
            lifted(i) => Some([[-base.B, base.B][i], 1.0, 0.0, 0.0]),
            P_t => Some([0.0, base.ties.k_t, 0.0, base.ties.P_0 - base.ties.k_t * y_s]),
            _ => None,
        }
    }

    /// The output in the motion `x`, beside which `kept` adds up; of one mass, whose engine is compiled without ground, nothing does.
    #[inline]
    pub(crate) fn in_motion<Q: Coordinates>(self, x: &Instant<f64, Q>, kept: Kept) -> f64 {
        let added_up = Q::foundation(x.structure).and_then(|_| self.added_up(x.structure, kept));
        added_up.unwrap_or_else(|| self.of(x))
    }

    /// The output of `structure` if it adds up over a motion beside the state.
    pub(crate) fn added_up(self, structure: &Structure, (of, s): Kept) -> Option<f64> {
        match self {
            slip_path => Some(of.slip),
            E_friction => Some(of.friction),
            E_plastic => Some(of.settling),
            Output::s(i) => s.get(i).copied(),
            settled => structure.foundation().map(|ground| ground.residual(|i| s[i], 0)),
            tilt => structure.foundation().map(|ground| ground.residual(|i| s[i], 1)),
            _ => None,
        }
    }

    /// The rate in the motion `x` of an output that adds up: |ẋ| and μ_c N |ẋ| while the base slides, and ṡ, the same of the sums of s and
    /// Σ q ṡ.
    pub(crate) fn added_up_rate<Q: Coordinates>(self, x: &Instant<Dual<f64>, Duals<Q>>) -> Option<f64> {
        self.added_up(x.structure, (&Dissipators::NEW, x.settled))?;
        let Some(ground) = <Q as Lateral<f64>>::foundation(x.structure) else { return Some(0.0) };
        let motion = [x.u.value, x.u_dot.value].map(|of| of.footing(ground));
        let rates = ground.settling(x.contact, motion, x.settled);
        let (points, mu_c) = (0..ground.points.len(), ground.mu_c.unwrap_or(0.0));
        let slip = x.contact.friction.sign() * x.u_dot.slide(ground).map_or(0.0, |rate| rate.value);
        Some(match self {
            slip_path => slip,
            E_friction => slip * mu_c * points.map(|i| N(i).on_ground(x, ground).value).sum::<f64>(),
            Output::s(i) => rates[i],
            settled => ground.residual(|i| rates[i], 0),
            tilt => ground.residual(|i| rates[i], 1),
            _ => points.map(|i| ground.points[i].q * rates[i]).sum(),
        })
    }

    /// The output in the motion `x` on ground that gives (F1, F2).
    fn on_ground<K: Number, Q: Lateral<K>>(self, x: &Instant<K, Q>, foundation: &Foundation) -> K {
        let (points, [footing, rates]) = (&foundation.points, x.footing(foundation));
        let same = || unreachable!("{self:?} has the same formula on all ground");
        match self {
            y => footing.y,
            E_foundation => footing.taken,
            lifted(_) | sunk(_) | P_t => {
                let [xi, k, _, offset] = self.of_height(x.base(), foundation).expect("it is of a height");
                footing.height(xi) * k + K::constant(offset)
            }
            N(i) if x.contact.yields(i) => K::constant(points[i].q),
            N(i) if x.contact.is_pressed(i) => {
                let [e, rate] = [footing, rates].map(|of| of.height(points[i].xi));
                let e = if foundation.yields { e + K::constant(x.settled[i]) } else { e };
                -(e * points[i].k + rate * points[i].c)
            }
            Output::x => x.u.slide(foundation).unwrap_or(K::constant(f64::NAN)),
            x_dot => x.u_dot.slide(foundation).unwrap_or(K::constant(f64::NAN)),
            edge(side) => {
                let each = foundation.of_edge(side, x.base().B);
                let each = each.map(|(i, factor)| N(i).on_ground(x, foundation) * factor);
                each.reduce(|sum, of| sum + of).expect("a strip is at the edge")
            }
            N(_) => K::constant(0.0),
            contact => {
                let pressed = points.iter().enumerate().filter(|(i, _)| x.contact.is_pressed(*i));
                K::constant(pressed.map(|(_, point)| point.k).sum::<f64>() / foundation.sum(0))
            }
            N_left => N(0).on_ground(x, foundation),
            N_right => N(points.len() - 1).on_ground(x, foundation),
            Output::uplift | settlement | pressure | F_d1 | F_d2 => K::constant(f64::NAN),
            slip_path | E_friction | settled | tilt | E_plastic | Output::s(_) => K::constant(f64::NAN),
            theta | theta_dot | u(_) | u_dot(_) | drift(_) | drift_ratio(_) | delta_t(_) | v_t(_) | V_t | M_t => same(),
            a_t(_) | V(_) | M(_) => same(),
        }
    }

    /// The output in the motion `x`, NaN if the structure does not have it.
    #[inline]
    pub(crate) fn of<K: Ordered, Q: Lateral<K>>(self, x: &Instant<K, Q>) -> K {
        match self {
            _ if Q::foundation(x.structure).is_none() => self.smooth(x),
            lifted(_) | sunk(_) | P_t => self.smooth(x).positive(),
            _ if self.search() == Search::Parts => {
                let parts = self.parts(x.structure);
                parts.map(|(part, factor)| part.of(x) * factor).reduce(K::larger).expect("it has parts")
            }
            _ => self.smooth(x),
        }
    }

    /// The output in numbers without a sign, such as series: not the positive part but that of which it is one, and NaN if the output is the
    /// largest of its [parts](Output::parts).
    #[inline]
    pub(crate) fn smooth<K: Number, Q: Lateral<K>>(self, x: &Instant<K, Q>) -> K {
        let floor = |i: usize| &x.structure.floors()[i];
        let plus_slide = |of: &Q, value: K| match Q::foundation(x.structure).and_then(|ground| of.slide(ground)) {
            Some(slid) => value + slid,
            None => value,
        };
        let place = |i| MassPoint { share: 1.0, height: floor(i).height, u: x.u.weighed(&floor(i).shape) };
        match self {
            theta => x.theta,
            theta_dot => x.theta_dot,
            Output::uplift if Q::foundation(x.structure).is_none() => uplift(x.pivot(), &x.turn),
            u(i) => x.u.weighed(&floor(i).shape),
            drift(_) | drift_ratio(_) => {
                let (shape, factor) = self.displaced(x.structure).expect("it is a displacement");
                x.u.weighed(shape) * factor
            }
            u_dot(i) => x.u_dot.weighed(&floor(i).shape),
            delta_t(i) => plus_slide(&x.u, place(i).right(x.pivot(), &x.turn)),
            v_t(i) => {
                let rates = [x.u_dot.weighed(&floor(i).shape), x.theta_dot];
                plus_slide(&x.u_dot, place(i).rate_of_right(x.pivot(), &x.turn, rates))
            }
            V_t | M_t | a_t(_) | V(_) | M(_) => {
                self.gauge(x.structure).expect("a gauge measures accelerations and forces").at(x)
            }
            _ => Q::foundation(x.structure).map_or(K::constant(f64::NAN), |foundation| self.on_ground(x, foundation)),
        }
    }
}
