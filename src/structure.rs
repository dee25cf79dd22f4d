//! A structure: a rigid base, the modes of vibration in full contact that the base carries, and the floors.
//!
//! One mass is one mode with the shape 1 and one floor; a rigid structure has no mode.

pub mod base;
pub mod derived;
mod described;
pub mod description;
pub mod doubts;
pub mod gauge;
pub mod ground;
pub mod mode;
pub mod natural_quantities;
pub mod one_mass;
pub mod parameters;
pub mod quantity;

use crate::series::bisection::last_where;
use base::{Base, Body};
use described::{Description, ManyMasses};
use gauge::{Gauges, Reach, rest};
use ground::{Foundation, Ground};
use mode::{Floor, MOST_MODES, Mode, Modes, OF_FLOOR, Vibration};
use one_mass::OneMass;
use parameters::Parameters;
use quantity::{OutOfRange, Quantity, Refused, Units, ensure, quantity};
use serde::Serialize;
use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

/// A rest beside the modes that counts as none, as a fraction of the whole.
pub(crate) const ROUNDING: f64 = 1e-9;

/// The most by which sums over exact modes miss the whole, as a fraction of the whole.
const EXACT: f64 = 1e-13;

/// The most that rounded modes may carry beyond the whole, as a fraction of the whole; the modes are then the whole.
const EXCESS: f64 = 5e-3;

/// Limits of the moments of the mass above the foundation.
const MOMENTS: [Quantity<Body>; 3] = [
    quantity!(m_s ["kg"] 1e-6, 1e12, "mass above the base"),
    quantity!(S_1 ["kg.m"] 1e-9, 1e16, "first moment of the mass above the base"),
    quantity!(I_2 ["kg.m2"] 1e-12, 1e20, "second moment of the mass above the base"),
];

/// Limits of a mode, whose coordinate may have any scale.
const OF_MODE: [Quantity<Mode>; 6] = [
    quantity!(mass ["kg"] 1e-24, 1e36, "modal mass"),
    quantity!(gamma ["kg"] f64::MIN, f64::MAX, "part of a mode in a translation"),
    quantity!(share ["1"] f64::MIN, f64::MAX, "participation of a mode"),
    quantity!(height ["m"] f64::MIN, f64::MAX, "height of a mode"),
    quantity!(stiffness ["N/m"] 1e-36, 1e48, "modal stiffness"),
    quantity!(damping ["N.s/m"] 0.0, 1e48, "modal damping"),
];

/// A rigid base that carries modes. The mass above the foundation that the modes do not carry turns rigidly with the base. Copies share
/// their numbers.
#[derive(Clone, Debug)]
pub struct Structure(Arc<SharedNumbers>, Provenance);

/// How the numbers of a structure were given.
#[derive(Clone, Debug, Default)]
struct Provenance {
    units: Units,
    description: Option<Arc<Description>>,
}

/// How the numbers were given is no part of what is compared.
impl PartialEq for Structure {
    fn eq(&self, other: &Structure) -> bool {
        self.0 == other.0
    }
}

/// The numbers of a structure.
#[derive(Clone, Debug, PartialEq)]
struct SharedNumbers {
    base: Base,
    body: Body,
    modes: Vec<Mode>,
    /// The ground that gives under the base; none on rigid ground.
    foundation: Option<Foundation>,
    /// A mode for each lateral coordinate: on ground that gives, y, sin θ and the energy of the ground take no part in any sum.
    coordinates: Vec<Mode>,
    floors: Vec<Floor>,
    gauges: Gauges,
    vibration: Vibration,
    /// Of one mass, its parameters and what follows from them.
    one: Option<OneMass>,
    /// Of a structure with one mode that is all of it, the numbers of this mode as of one mass.
    of_mode: Option<OneMass>,
    reaches: Reaches,
}

/// The reaches of outputs, which follow from the rest of a structure, once they have been asked for.
#[derive(Clone, Debug, Default)]
struct Reaches(OnceLock<Vec<Reach>>);

impl PartialEq for Reaches {
    fn eq(&self, _: &Reaches) -> bool {
        true
    }
}

/// The refusal of a number of this mode or floor, counted from 1.
pub(crate) fn of_number(what: &str, number: usize, cause: OutOfRange) -> Refused {
    Refused::from(cause).of(&format!("{what} {number}"))
}

/// Refuses more modes than a structure may have, or none.
pub(crate) fn check_count(modes: usize) -> Result<(), Refused> {
    let is_possible = (1..=MOST_MODES).contains(&modes);
    ensure(is_possible, || format!("{modes} modes are given: a structure has 1 to {MOST_MODES}"))
}

impl Structure {
    /// The structure of one mass with these `parameters`, or the first parameter that is out of range.
    pub fn new(parameters: Parameters) -> Result<Structure, Refused> {
        OneMass::new(parameters).map(Structure::from)
    }

    /// The structure of this `body` with these `modes`, which shows these `floors`.
    pub fn of_body(body: Body, modes: &[Mode], floors: &[Floor]) -> Result<Structure, Refused> {
        let count = modes.len();
        check_count(count)?;
        MOMENTS.iter().try_for_each(|moment| moment.check((moment.get)(&body)))?;
        body.check()?;
        for (number, mode) in (1..).zip(modes) {
            let checked = OF_MODE.iter().try_for_each(|of| of.check((of.get)(mode)));
            checked.map_err(|cause| of_number("mode", number, cause))?;
        }
        for (number, floor) in (1..).zip(floors) {
            let checked = OF_FLOOR.iter().try_for_each(|of| of.check((of.get)(floor)));
            checked.map_err(|cause| of_number("floor", number, cause))?;
            let numbers = floor.shape.count;
            ensure(numbers == count, || {
                format!("floor {number} has {numbers} numbers of its shape: give one for each of the {count} modes")
            })?;
        }
        let of = |part: fn(&Mode) -> f64| modes.iter().map(part).sum::<f64>();
        let whole = |name, unit, whole: f64, of_modes: f64| match rest(whole, of_modes, EXACT) {
            rest if rest < -EXCESS * whole => Err(Refused::shown(|units| {
                let [of_modes, whole] = [of_modes, whole].map(|of| units.show_by(|of| format!("{of:?}"), of, unit));
                format!(
                    "the modes carry {of_modes} of the {name} = {whole} above the foundation: check masses, heights and units"
                )
            })),
            rest => Ok(if rest < 0.0 { of_modes } else { whole }),
        };
        let [mass, inertia] = [of(|mode| mode.gamma * mode.share), of(|mode| mode.mass * mode.height * mode.height)];
        let m_s = whole("m_s", "kg", body.m_s, mass)?;
        let I_2 = whole("I_2", "kg.m2", body.I_2, inertia)?;
        Ok(Structure::of(Body { m_s, I_2, ..body }, modes, floors, None))
    }

    /// The structure of checked numbers, of one mass with the bits of the paper's formulas. The modes are all of it if they leave no more of
    /// any of its sums than their rounding.
    fn of(body: Body, modes: &[Mode], floors: &[Floor], one: Option<OneMass>) -> Structure {
        let of = |part: fn(&Mode) -> f64| modes.iter().map(part).sum::<f64>();
        let (mass, first) = (of(|mode| mode.gamma * mode.share), of(|mode| mode.gamma * mode.height));
        let second = of(|mode| mode.mass * mode.height * mode.height);
        let rests = |rounding| {
            let [m_res, I_res] = [rest(body.m_s, mass, rounding), rest(body.I_2, second, rounding)];
            let rest = [m_res.max(0.0), rest(body.S_1, first, rounding), I_res.max(0.0)];
            (rest, Gauges::new(&body, modes, floors, rounding))
        };
        let rounded = Some(rests(ROUNDING)).filter(|(rest, gauges)| *rest == [0.0; 3] && !gauges.has_feedthrough);
        let exact = |whole, of_modes| if rest(whole, of_modes, EXACT) == 0.0 { whole } else { of_modes };
        let body = match rounded {
            Some(_) => {
                Body { m_s: exact(body.m_s, mass), S_1: exact(body.S_1, first), I_2: exact(body.I_2, second), ..body }
            }
            None => body,
        };
        let ([m_res, S_res, I_res], gauges) = rounded.unwrap_or_else(|| rests(0.0));
        let Body { m0, J0, m_s, I_2, S_1, B, r, g, c_ratio, ties } = body;
        let m_t = m0 + m_s;
        let J_P = J0 + m_t * B * B + I_2;
        let base = Base {
            m_t,
            m0: m0 + m_res,
            S_res,
            B,
            J0: J0 + I_res,
            J_P,
            r,
            g,
            c_ratio,
            p_l: (g * S_1 / J_P).sqrt(),
            tan_alpha_cg: m_t * B / S_1,
            ties,
        };
        let whole = SharedNumbers {
            vibration: match one {
                Some(one) => Vibration { contact: one.omega_fc, rocking: [one.omega_u; 2] },
                None => vibration(&base, modes),
            },
            base: one.map_or(base, |one| one.base),
            body,
            modes: modes.to_vec(),
            foundation: None,
            coordinates: modes.to_vec(),
            floors: floors.to_vec(),
            gauges,
            one,
            of_mode: one,
            reaches: Reaches::default(),
        };
        Structure(Arc::new(whole), Provenance::default())
    }

    /// This structure with numbers that `change` writes.
    fn changed(&self, change: impl FnOnce(&mut SharedNumbers)) -> Structure {
        let mut whole = SharedNumbers { reaches: Reaches::default(), ..SharedNumbers::clone(&self.0) };
        change(&mut whole);
        Structure(Arc::new(whole), self.1.clone())
    }

    /// This structure on `ground` that gives, with at most 21 modes, or 20 if the base may slide. The structure has no numbers of one mass
    /// any more: it is moved as structures of many masses are. Without `ground`, this structure.
    pub fn on<'g>(&self, ground: impl Into<Option<&'g Ground>>) -> Result<Structure, Refused> {
        let Some(ground) = ground.into() else { return Ok(self.clone()) };
        let founded = |structure: &Structure| {
            let foundation = Foundation::new(ground, structure.base(), structure.body(), structure.modes());
            foundation.map_err(|error| error.of("ground"))
        };
        let Some(mut foundation) = founded(self)? else { return Ok(self.on_rigid_ground()) };
        let (mut kept, beside) = (self.clone(), foundation.coordinates());
        if self.modes().len() + beside > MOST_MODES {
            kept = self.with_lowest(MOST_MODES - beside);
            foundation = founded(&kept)?.unwrap_or(foundation);
        }
        let coordinates = [kept.modes(), &vec![Mode { mass: 1.0, ..Mode::default() }; beside]].concat();
        let standing = kept.standing(Some(foundation), coordinates);
        Ok(standing.redescribed(|description| description.ground = Some(ground.clone())))
    }

    /// This structure without ground that gives.
    pub(crate) fn on_rigid_ground(&self) -> Structure {
        match self.foundation() {
            Some(_) => self.standing(None, self.modes().to_vec()).redescribed(|description| description.ground = None),
            None => self.clone(),
        }
    }

    /// This structure with these lateral `coordinates`, and without numbers of one mass.
    fn standing(&self, foundation: Option<Foundation>, coordinates: Vec<Mode>) -> Structure {
        self.changed(|whole| {
            (whole.foundation, whole.coordinates) = (foundation, coordinates);
            (whole.one, whole.of_mode) = (None, None);
        })
    }

    /// `structure` on the ground of this one.
    fn on_own_ground(&self, structure: Structure) -> Result<Structure, Refused> {
        structure.on(self.foundation().map(|foundation| &foundation.ground))
    }

    /// The ground that gives under the base; none on rigid ground.
    #[inline(always)]
    pub fn foundation(&self) -> Option<&Foundation> {
        self.0.foundation.as_ref()
    }

    /// The ground under a structure that stands on ground that gives.
    #[inline(always)]
    pub(crate) fn ground(&self) -> &Foundation {
        self.foundation().expect("it stands on ground that gives")
    }

    /// A mode for each lateral coordinate.
    #[inline(always)]
    pub(crate) fn coordinates(&self) -> &[Mode] {
        &self.0.coordinates
    }

    /// This structure with its `count` modes of the lowest frequencies, or none. The mass of the others turns rigidly with the base.
    pub fn keeping(&self, count: usize) -> Result<Structure, Refused> {
        let modes = self.0.modes.len();
        ensure(count <= modes, || format!("{count} modes cannot be kept of {modes}: keep 0 to {modes}"))?;
        let keep = |many: &mut ManyMasses| many.keep = Some(count as i64);
        Ok(self.with_lowest(count).redescribed(|description| description.many.iter_mut().for_each(keep)))
    }

    /// This structure as the level `rigid` of one mass shows it: floors and gauges know no mode.
    pub(crate) fn shown_rigid(&self) -> Structure {
        let floors = Vec::from_iter(self.0.floors.iter().map(|floor| Floor { shape: Modes::default(), ..*floor }));
        let gauges = Gauges::new(self.body(), &[], &floors, ROUNDING);
        self.changed(|whole| (whole.floors, whole.gauges) = (floors, gauges))
    }

    /// This structure, whose numbers were given in `units`, in which its doubts name them.
    pub fn measured_in(self, units: Units) -> Structure {
        Structure(self.0, Provenance { units, ..self.1 })
    }

    /// This structure, of which the numbers of `description` were given.
    fn described_as(self, description: Description) -> Structure {
        Structure(self.0, Provenance { description: Some(Arc::new(description)), ..self.1 })
    }

    /// This structure with what `change` makes of the numbers that were given.
    fn redescribed(self, change: impl FnOnce(&mut Description)) -> Structure {
        let Some(mut description) = self.1.description.as_deref().cloned() else { return self };
        change(&mut description);
        self.described_as(description)
    }

    /// The numbers that it was made of; none of a structure of a body and modes.
    pub fn description(&self) -> Option<&Description> {
        self.1.description.as_deref()
    }

    /// Whether it was described as one mass, on whatever ground: its outputs have the names of one mass.
    #[inline]
    pub fn is_one_mass(&self) -> bool {
        self.description().is_some_and(|description| description.many.is_none())
    }

    /// The units in which the numbers were given.
    pub fn units(&self) -> Units {
        self.1.units
    }

    /// The places of the `count` modes of the lowest frequencies.
    pub(crate) fn lowest_places(&self, count: usize) -> Vec<usize> {
        let square = |j: &usize| self.0.modes[*j].stiffness / self.0.modes[*j].mass;
        let mut kept = Vec::from_iter(0..self.0.modes.len());
        kept.sort_by(|a, b| square(a).total_cmp(&square(b)));
        kept.truncate(count);
        kept.sort_unstable();
        kept
    }

    pub(crate) fn with_lowest(&self, count: usize) -> Structure {
        let kept = self.lowest_places(count);
        let shape = |floor: &Floor| Modes::new(&Vec::from_iter(kept.iter().map(|j| floor.shape.of[*j])));
        let floors = Vec::from_iter(self.0.floors.iter().map(|floor| Floor { shape: shape(floor), ..*floor }));
        let kept = Structure::of(self.0.body, &Vec::from_iter(kept.iter().map(|j| self.0.modes[*j])), &floors, None);
        self.on_own_ground(Structure(kept.0, self.1.clone()))
            .expect("the rest of the modes rides rigidly, which makes the base heavier and stiffer")
    }

    /// All numbers by which its motion differs from that of another structure.
    pub fn numbers(&self) -> impl Serialize + use<'_> {
        (self.parameters(), self.body(), self.modes(), self.floors(), self.foundation())
    }

    /// The structure as a rigid body.
    pub fn body(&self) -> &Body {
        &self.0.body
    }

    /// The numbers of one mass, if the structure was made of them.
    #[inline]
    pub fn one(&self) -> Option<&OneMass> {
        self.0.one.as_ref()
    }

    /// The parameters of one mass. Many masses have those of the base, and the lowest mode gives f_fc and zeta_fc. m and H are NaN, and
    /// so is r if no coefficient is given.
    pub fn parameters(&self) -> Parameters {
        if let Some(Description { parameters, many: None, .. }) = self.description() {
            return *parameters;
        }
        let [f_fc, zeta_fc] = self.lowest().map_or([f64::NAN; 2], |mode| [mode.omega() / TAU, mode.zeta()]);
        self.0.body.over(Parameters { m: f64::NAN, H: f64::NAN, f_fc, zeta_fc, ..Parameters::EVISON })
    }

    /// This structure with these `parameters`; of many masses only the parameters of the base are changed.
    pub fn with(&self, parameters: Parameters) -> Result<Structure, Refused> {
        if let Some(of @ Description { many: None, .. }) = self.description() {
            return Description { parameters, ..of.clone() }.structure();
        }
        let Body { m_s, S_1, I_2, .. } = self.0.body;
        let body = Body::of(&parameters, Some(parameters.r).filter(|r| !r.is_nan()), [m_s, S_1, I_2]);
        let of_body = Structure::of_body(body, &self.0.modes, &self.0.floors)?;
        let of_body = Structure(of_body.0, self.1.clone()).redescribed(|Description { parameters: own, .. }| {
            // those of one mass stay
            *own = Parameters { m: own.m, H: own.H, f_fc: own.f_fc, zeta_fc: own.zeta_fc, ..parameters };
        });
        self.on_own_ground(of_body)
    }

    /// This structure as engines of one coordinate move it, if one mode is all of it: the coordinate is scaled so that the mode takes the
    /// whole translation of the base. Its names stay those of this structure.
    pub fn of_one_mode(&self) -> Option<Structure> {
        if self.0.of_mode.is_some() {
            return Some(self.clone());
        }
        let &[Mode { mass, gamma, share, height, stiffness, damping }] = self.modes() else { return None };
        if self.rest() != [0.0; 3] || self.0.gauges.has_feedthrough || self.foundation().is_some() {
            return None;
        }
        let square = share * share;
        let mode = Mode {
            mass: mass * square,
            gamma: gamma * share,
            share: 1.0,
            height: height / share,
            stiffness: stiffness * square,
            damping: damping * square,
        };
        let (m, H, r) = (mode.mass, mode.height, self.0.body.r.unwrap_or(1.0));
        let of_mode = OneMass::new(Parameters { m, H, r, ..self.parameters() }).ok()?;
        let floor =
            |floor: &Floor| Floor { shape: floor.shape.with(&Modes::default(), |own, _| own * share), ..*floor };
        let floors = Vec::from_iter(self.0.floors.iter().map(floor));
        let of_one = Structure::of(self.0.body, &[mode], &floors, None).changed(|whole| whole.of_mode = Some(of_mode));
        Some(Structure(of_one.0, self.1.clone()))
    }

    /// The numbers of one mass of a structure that engines of one coordinate move.
    pub(crate) fn of_mode(&self) -> Result<&OneMass, Refused> {
        self.0.of_mode.as_ref().ok_or_else(|| self.is_no_one_mass("an engine of one coordinate"))
    }

    /// The numbers of one mass, which `task` needs.
    pub fn one_mass(&self, task: &'static str) -> Result<&OneMass, Refused> {
        self.one().ok_or_else(|| self.is_no_one_mass(task))
    }

    fn is_no_one_mass(&self, task: &str) -> Refused {
        let (needed, has) = match self.foundation() {
            None if self.is_one_mass() => {
                ("a number r, because Eqs 10 to 24 have one", "takes it from momentum".into())
            }
            Some(_) => ("rigid ground, because Eqs 10 to 24 rock on it", "stands on ground that gives".into()),
            None => (
                "a structure of one mass, because Eqs 10 to 24 have one mode of vibration",
                format!("has {} modes", self.modes().len()),
            ),
        };
        Refused::by(format!("{task} needs {needed}, and this structure {has}: simulate the motion instead"))
    }

    /// Circular frequencies of vibration, rad/s.
    #[inline(always)]
    pub fn vibration(&self) -> Vibration {
        self.0.vibration
    }

    /// The rigid base.
    #[inline(always)]
    pub fn base(&self) -> &Base {
        &self.0.base
    }

    /// The modes of vibration in full contact.
    #[inline(always)]
    pub fn modes(&self) -> &[Mode] {
        &self.0.modes
    }

    /// The mode of the lowest frequency in full contact.
    pub(crate) fn lowest(&self) -> Option<&Mode> {
        self.0.modes.iter().min_by(|a, b| a.omega().total_cmp(&b.omega()))
    }

    /// The gauges of the floors and of the base.
    pub fn gauges(&self) -> &Gauges {
        &self.0.gauges
    }

    /// The reaches of outputs, which `find` finds once.
    #[inline(always)]
    pub(crate) fn reaches_by(&self, find: fn(&Structure) -> Vec<Reach>) -> &[Reach] {
        self.0.reaches.0.get_or_init(|| find(self))
    }

    /// Whether no mode moves what is shown of the structure.
    pub(crate) fn is_rigid(&self) -> bool {
        self.0.gauges.V_t.shape.count == 0
    }

    /// The floors, from below.
    #[inline(always)]
    pub fn floors(&self) -> &[Floor] {
        &self.0.floors
    }

    /// Circular frequencies of vibration while the structure rocks, rad/s, lowest first.
    pub fn rocking_frequencies(&self) -> Vec<f64> {
        (1..=self.0.modes.len()).map(|n| rocking(&self.0.base, &self.0.modes, n)).collect()
    }

    /// Circular frequencies of small motions on ground that gives with all points pressed, rad/s, lowest first; none on rigid ground.
    pub fn frequencies_on_ground(&self) -> Vec<f64> {
        let frequencies = |of: &Foundation| of.frequencies(self.base(), self.body(), self.modes());
        self.foundation().map_or(Vec::new(), frequencies)
    }

    /// The fastest rate of small motions on ground that gives, 1/s.
    pub(crate) fn fastest_on_ground(&self) -> Option<f64> {
        self.foundation().map(|of| of.fastest(&self.frequencies_on_ground(), self.base(), self.modes()))
    }

    /// The fastest rate of small motions while the structure rocks on rigid ground, 1/s: the highest frequency, or the rate Σ c h²/(J0 + m_t B²)
    /// at which the dampers turn the base.
    pub(crate) fn fastest_rocking(&self) -> f64 {
        let &Base { m_t, J0, B, c_ratio, .. } = self.base();
        let damping: f64 = self.modes().iter().map(|mode| mode.damping * mode.height * mode.height).sum();
        (c_ratio * damping / (J0 + m_t * B * B)).max(self.vibration().rocking[1])
    }

    /// Mass (kg), first (kg·m) and second moment (kg·m²) that no mode carries.
    pub fn rest(&self) -> [f64; 3] {
        [self.0.base.m0 - self.0.body.m0, self.0.base.S_res, self.0.base.J0 - self.0.body.J0]
    }
}

impl From<OneMass> for Structure {
    fn from(one: OneMass) -> Structure {
        let &Parameters { m, H, r, .. } = one.parameters();
        let body = Body::of(one.parameters(), Some(r), [m, m * H, m * H * H]);
        let floor = Floor { mass: m, height: H, shape: Modes::new(&[1.0]) };
        let description = Description { parameters: *one.parameters(), many: None, ground: None };
        Structure::of(body, &[one.mode], &[floor], Some(one)).described_as(description)
    }
}

/// The lowest and the highest frequency of vibration; of a structure without modes, its frequency parameter.
fn vibration(base: &Base, modes: &[Mode]) -> Vibration {
    if modes.is_empty() {
        return Vibration { contact: base.p_l, rocking: [base.p_l; 2] };
    }
    let contact = modes.iter().map(Mode::omega).fold(f64::INFINITY, f64::min);
    Vibration { contact, rocking: [rocking(base, modes, 1), rocking(base, modes, modes.len())] }
}

/// The circular frequency number `n` of vibration while the structure rocks, rad/s, from 1: a root λ = ω² of (M13):
///
/// ```text
/// J_P = Σ μ h² λ/(λ − ω²)
/// ```
fn rocking(base: &Base, modes: &[Mode], n: usize) -> f64 {
    let square = |mode: &Mode| mode.stiffness / mode.mass;
    let inertia = |mode: &Mode| mode.mass * mode.height * mode.height;
    let held = base.J_P - modes.iter().map(inertia).sum::<f64>();
    let lowest = modes.iter().map(square).fold(f64::INFINITY, f64::min);
    let highest = modes.iter().map(square).fold(0.0, f64::max);
    // each root lies between two frequencies of full contact, or beyond the last
    let roots_below = |lambda: f64| {
        let passed = modes.iter().filter(|mode| square(mode) < lambda).count();
        let secular = modes.iter().map(|mode| square(mode) * inertia(mode) / (square(mode) - lambda)).sum::<f64>();
        passed - usize::from(passed > 0 && held + secular < 0.0)
    };
    let beyond = highest * (2.0 * base.J_P / held);
    last_where(lowest, beyond, |lambda| roots_below(lambda) < n).sqrt()
}
