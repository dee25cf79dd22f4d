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
//! motion. To add an output, write its row in `outputs!`, its place among the outputs and its formula. All
//! columns, peaks and pictures follow.

use crate::mechanics::instant::{Instant, Place, uplift};
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::load::Load;
use crate::numbers::{Number, Ordered};
use crate::structure::gauge::Gauge;
use crate::structure::mode::Modes;
use crate::{Base, Foundation, Phase, State, Structure};
use serde::{Deserialize, Serialize};

/// Declares [`Output`] by its rows: name, unit, description, where `#` stands for the number of a floor, and what the documentation adds.
macro_rules! outputs {
    ($($name:ident $(($i:ident: $number:ty))? [$unit:literal] $description:literal $($more:literal)?;)*) => {
        /// An output of a structure. Floors and storeys count from 0, from below; storey i is below floor i.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[allow(non_camel_case_types)] // the names of the outputs
        pub enum Output {
            $(
                #[doc = concat!("The ", $description, $(", ", $more,)? ", ", $unit, ".")]
                $name $(($number))?,
            )*
        }

        impl Output {
            /// The name, unit and description, and the floor if the output is of a floor, which takes the place of `#`.
            const fn told(self) -> (&'static str, &'static str, &'static str, Option<usize>) {
                match self {
                    $(Output::$name $(($i))? => (stringify!($name), $unit, $description, [$(Some($i),)? None][0]),)*
                }
            }
        }
    };
}

outputs! {
    theta ["rad"] "rotation of the base" "θ";
    theta_dot ["rad/s"] "angular velocity of the base" "θ̇";
    uplift ["m"] "uplift of the free edge of the base" "δ_u = 2 B sin|θ| (Eq 25)";
    V_t ["N"] "base shear if all F_t are 0: the sum of m a_t" "V_t (Eqs 2, 23)";
    M_t ["N.m"] "overturning moment if all F_t are 0: the sum of m h a_t" "M_t (Eqs 3, 24)";
    u(i: usize) ["m"] "elastic displacement of floor #" "u_i";
    u_dot(i: usize) ["m/s"] "elastic velocity of floor #" "u̇_i";
    drift(i: usize) ["m"] "drift of storey #" "u_i − u_{i−1}";
    drift_ratio(i: usize) ["1"] "drift of storey # over its height";
    delta_t(i: usize) ["m"] "displacement of floor # relative to the ground" "δ_i = sB (1 − cos θ) + u_i cos θ + h_i sin θ (Eq 26)";
    v_t(i: usize) ["m/s"] "velocity of floor # relative to the ground" "u̇_i cos θ + [(sB − u_i) sin θ + h_i cos θ] θ̇";
    a_t(i: usize) ["m/s2"] "lateral acceleration of floor #" "along the turning e_x a_i (Eq 27)";
    V(i: usize) ["N"] "shear of storey # if all F_t are 0: the sum of m a_t above it" "V_i";
    M(i: usize) ["N.m"] "overturning moment at the foot of storey # if all F_t are 0" "M_i";
    y ["m"] "height of the middle of the base above the unloaded ground" "on ground that gives as all that follow but the forces of ties";
    settlement ["m"] "settlement of the lower outer contact point" "rotation included, −min(e); the middle of the base settles by −y";
    contact ["1"] "stiffness of the pressed contact points over the stiffness of all";
    E_foundation ["J"] "energy that the ground has taken";
    N_left ["N"] "force of the left outer contact point";
    N_right ["N"] "force of the right outer contact point";
    pressure ["N/m"] "largest pressure under the base: the mean over the outer sixth at each edge, or of an inner point over its strip";
    N(i: usize) ["N"] "force of contact point # from the left";
    settled(i: usize) ["m"] "settlement of outer contact point #" "left (0) or right (1), or 0 above the unloaded ground";
    P_t ["N"] "force of the tendon";
    F_d1 ["N"] "force of the dissipators at +xi_d" "which a sample has";
    F_d2 ["N"] "force of the dissipators at -xi_d" "which a sample has";
    lifted(i: usize) ["m"] "height of edge # above the unloaded ground" "left (0) or right (1), or 0 below";
    edge(i: usize) ["N/m"] "mean pressure over the outer sixth of the base at edge #" "left (0) or right (1)";
}

use Output::{
    E_foundation, M, M_t, N, N_left, N_right, V, V_t, a_t, contact, delta_t, drift, drift_ratio, edge, lifted,
};
use Output::{F_d1, F_d2, P_t, pressure, settled, settlement, theta, theta_dot, u, u_dot, v_t, y};

impl Output {
    /// The outputs of one mass, in the order of their columns.
    const OF_ONE: [Output; 10] =
        [theta, u(0), a_t(0), V_t, M_t, theta_dot, u_dot(0), Output::uplift, delta_t(0), v_t(0)];

    /// The outputs of one mass that have a peak, in the order of their peaks.
    pub const PEAKS_OF_ONE: [Output; 7] = [theta, u(0), delta_t(0), Output::uplift, a_t(0), V_t, M_t];

    /// The forces of a tendon and of dissipators.
    pub const OF_TIES: [Output; 3] = [P_t, F_d1, F_d2];

    /// The outputs of a base.
    const OF_BASE: [Output; 5] = [theta, theta_dot, Output::uplift, V_t, M_t];

    /// The outputs of a base on ground that gives.
    const OF_GROUND: [Output; 6] = [y, settlement, contact, E_foundation, N_left, N_right];

    /// The outputs of a floor and of the storey below the floor.
    const OF_FLOOR: [fn(usize) -> Output; 9] = [u, u_dot, drift, drift_ratio, delta_t, v_t, a_t, V, M];

    /// All outputs of `structure` in the order of their columns: of many masses those of the base, then each output of the floors
    /// from below.
    pub fn all(structure: &Structure) -> Vec<Output> {
        if structure.one().is_some() {
            return Output::OF_ONE.into();
        }
        let floors = structure.floors().len();
        let of_floors = Output::OF_FLOOR.iter().flat_map(|of| (0..floors).map(of));
        // two floors at the same height have a drift and no storey
        let is_one = |of: &Output| of.displaced(structure).is_none_or(|(_, factor)| factor.is_finite());
        let points = structure.foundation().map(|foundation| foundation.points.len());
        let of_ground = points.iter().flat_map(|_| Output::OF_GROUND);
        // two points are the outer ones
        let of_points = points.into_iter().filter(|n| *n > 2).flat_map(|n| [pressure].into_iter().chain((0..n).map(N)));
        Output::OF_BASE.into_iter().chain(of_ground).chain(of_points).chain(of_floors).filter(is_one).collect()
    }

    /// The outputs of `structure` that have a peak, in the order of their peaks; the forces of its tendon and of its dissipators last.
    pub fn with_peak(structure: &Structure) -> Vec<Output> {
        let base = structure.base();
        let is_there = |of: &Output| if *of == P_t { base.has_tendon() } else { base.has_dissipators() };
        Output::searched(structure).into_iter().chain(Output::OF_TIES.into_iter().filter(is_there)).collect()
    }

    /// The outputs with a peak, without the forces of tendon and dissipators.
    pub(crate) fn searched(structure: &Structure) -> Vec<Output> {
        match structure.one() {
            Some(_) => Output::PEAKS_OF_ONE.into(),
            None => Output::all(structure)
                .into_iter()
                .filter(|of| !matches!(of, theta_dot | u_dot(_) | v_t(_) | y | contact | E_foundation))
                .collect(),
        }
    }

    /// The name of an output of `structure`, of many masses with the number of the floor or storey from 1: `a_t[3]`.
    pub fn name(self, structure: &Structure) -> String {
        match self.told() {
            (name, .., Some(floor)) if structure.one().is_none() => format!("{name}[{}]", floor + 1),
            (name, ..) => name.into(),
        }
    }

    /// The symbol without a number, the same for all floors.
    pub const fn symbol(self) -> &'static str {
        self.told().0
    }

    /// The unit.
    pub const fn unit(self) -> &'static str {
        self.told().1
    }

    /// The description.
    pub fn description(self) -> String {
        let (_, _, description, floor) = self.told();
        floor.map_or(description.into(), |floor| description.replace('#', &(floor + 1).to_string()))
    }

    /// Whether the output of `structure` depends on the ground acceleration directly.
    pub fn has_feedthrough(self, structure: &Structure) -> bool {
        self.gauge(structure).is_some_and(Gauge::has_feedthrough)
    }

    /// Whether the output is linear in the components of the motion.
    pub(crate) fn is_component(self) -> bool {
        let of_ground =
            matches!(self, y | E_foundation | N_left | N_right | N(_) | P_t | settled(_) | lifted(_) | edge(_));
        of_ground || matches!(self, theta | theta_dot | u(_) | u_dot(_) | drift(_) | drift_ratio(_))
    }

    /// The outputs of `structure` on ground that gives of whose peaks the largest is the peak of this one, each with its factor.
    pub(crate) fn parts(self, structure: &Structure) -> Vec<(Output, f64)> {
        let (Some(foundation), B) = (structure.foundation(), structure.base().B) else { return Vec::new() };
        let (last, width) = (foundation.points.len() - 1, |[from, to]: [f64; 2]| to - from);
        match self {
            Output::uplift => vec![(lifted(0), 1.0), (lifted(1), 1.0)],
            settlement => vec![(settled(0), 1.0), (settled(1), 1.0)],
            N_left => vec![(N(0), 1.0)],
            N_right => vec![(N(last), 1.0)],
            pressure => {
                let inner = (1..last).map(|i| (N(i), 1.0 / width(foundation.strip(i, B))));
                [0, 1].map(|side| (edge(side), 1.0)).into_iter().chain(inner).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The output as a multiple of `other`, if it is one in every motion of `structure`.
    pub(crate) fn over(self, other: Output, structure: &Structure) -> Option<f64> {
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
    #[inline]
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
    pub(crate) fn of_height(self, base: &Base, Foundation { points, rest, .. }: &Foundation) -> Option<[f64; 4]> {
        match self {
            N(i) => points.get(i).map(|point| [point.xi, -point.k, -point.c, 0.0]),
            settled(i) => Some([points[i * (points.len() - 1)].xi, -1.0, 0.0, 0.0]),
            lifted(i) => Some([[-base.B, base.B][i], 1.0, 0.0, 0.0]),
            P_t => Some([0.0, base.ties.k_t, 0.0, base.ties.P_0 - base.ties.k_t * rest]),
            _ => None,
        }
    }

    /// The output in the motion `x` on ground that gives (F1, F2).
    fn on_ground<K: Number, Q: Lateral<K>>(self, x: &Instant<K, Q>, foundation: &Foundation) -> K {
        let (points, [footing, rates]) = (&foundation.points, x.footing(foundation));
        match self {
            y => footing.y,
            E_foundation => footing.taken,
            lifted(_) | settled(_) | P_t => {
                let [xi, k, _, offset] = self.of_height(x.base(), foundation).expect("it is of a height");
                footing.height(xi) * k + K::constant(offset)
            }
            N(i) if x.contact.is_pressed(i) => {
                let [e, rate] = [footing, rates].map(|of| of.height(points[i].xi));
                -(e * points[i].k + rate * points[i].c)
            }
            edge(side) => {
                let each = foundation.of_edge(side, x.base().B).into_iter();
                let each = each.map(|(i, factor)| N(i).on_ground(x, foundation) * factor);
                each.reduce(|sum, of| sum + of).expect("a strip is at the edge")
            }
            contact => {
                let pressed = points.iter().enumerate().filter(|(i, _)| x.contact.is_pressed(*i));
                K::constant(pressed.map(|(_, point)| point.k).sum::<f64>() / foundation.sum(0))
            }
            N_left => N(0).on_ground(x, foundation),
            N_right => N(points.len() - 1).on_ground(x, foundation),
            Output::uplift | settlement | pressure => K::constant(f64::NAN),
            _ => K::constant(0.0),
        }
    }

    /// The output in the motion `x`, NaN if the structure does not have it.
    #[inline]
    pub(crate) fn of<K: Ordered, Q: Lateral<K>>(self, x: &Instant<K, Q>) -> K {
        match self {
            _ if Q::foundation(x.structure).is_none() => self.smooth(x),
            lifted(_) | settled(_) | P_t => self.smooth(x).positive(),
            Output::uplift | settlement | pressure => {
                let parts = self.parts(x.structure).into_iter();
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
        let place = |i| Place { share: 1.0, height: floor(i).height, u: x.u.weighed(&floor(i).shape) };
        match self {
            theta => x.theta,
            theta_dot => x.theta_dot,
            Output::uplift if Q::foundation(x.structure).is_none() => uplift(x.pivot(), &x.turn),
            u(_) | drift(_) | drift_ratio(_) => {
                let (shape, factor) = self.displaced(x.structure).expect("it is a displacement");
                x.u.weighed(shape) * factor
            }
            u_dot(i) => x.u_dot.weighed(&floor(i).shape),
            delta_t(i) => place(i).right(x.pivot(), &x.turn),
            v_t(i) => place(i).rate_of_right(x.pivot(), &x.turn, [x.u_dot.weighed(&floor(i).shape), x.theta_dot]),
            V_t | M_t | a_t(_) | V(_) | M(_) => {
                self.gauge(x.structure).expect("a gauge measures accelerations and forces").at(x)
            }
            _ => Q::foundation(x.structure).map_or(K::constant(f64::NAN), |foundation| self.on_ground(x, foundation)),
        }
    }
}
