//! The one table of the FMU's variables. What a variable is called, what it may be, who sets it and what it depends on
//! stands here and nowhere else: the model description is written from this table, and the C functions read and write
//! through it. A value reference is a position in the table.

use crate::resources::Contents;
use crate::setup::Setup;
use rocking::Motion;
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::mechanics::state::{COMPONENTS, INITIAL_VALUES};
use rocking::run::ground_motion::{PLACEMENT, Placement};
use rocking::run::outside_step::INDICATORS;
use rocking::run::peaks::Peaks;
use rocking::run::validity::{ASSUMPTIONS, Assumption};
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::{OutOfRange, Quantity};
use rocking::structure::{DERIVED, Derived};
use rocking::{Detail, Impulse, Load, Outputs, Parameters, Phase, Reactions, Side, State};
use std::sync::LazyLock;

/// One variable.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name, as hosts show it.
    pub name: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
    /// Its data type, with what belongs to that type alone.
    pub data_type: DataType,
    /// Who sets it.
    pub causality: Causality,
    /// The inputs that its value depends on at any time, the state given, by name: direct feedthrough.
    pub feedthrough: &'static [&'static str],
    /// The states that its value depends on at any time, by name.
    pub states: &'static [&'static str],
    /// The parameters and initial values that its value at the start of a simulation depends on as well, by name.
    pub initial_dependencies: &'static [&'static str],
    /// Where its value is.
    pub(crate) source: Source,
}

/// Who sets a variable. With it goes how its initial value comes about: parameters are given, what the FMU computes is
/// calculated, inputs have none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The user, before the simulation.
    Parameter,
    /// The FMU, from the parameters.
    CalculatedParameter,
    /// The host, during the simulation.
    Input,
    /// The FMU, for other models.
    Output,
    /// The FMU, for display.
    Local,
    /// Time, which all others depend on.
    Independent,
}

/// Data type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DataType {
    /// A real number.
    Real {
        /// Unit as FMI writes it, `1` for a ratio.
        unit: &'static str,
        /// Smallest and largest value accepted, of what a host sets.
        range: Option<(f64, f64)>,
    },
    /// An integer, not negative.
    Integer,
    /// True or false.
    Boolean,
    /// Text.
    String,
    /// One of these, numbered from 1.
    Enumeration(&'static Enumeration),
}

/// A value of any type.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A real number.
    Real(f64),
    /// The number of an item of an enumeration.
    Item(i32),
    /// True or false.
    Boolean(bool),
    /// Text.
    String(String),
}

/// An enumeration.
#[derive(Debug, PartialEq)]
pub struct Enumeration {
    /// Name of the type.
    pub name: &'static str,
    /// What it tells, in one line.
    pub description: &'static str,
    /// Its items, numbered from 1.
    pub items: &'static [&'static str],
}

/// An integer, or a Boolean as 0 or 1.
pub(crate) type OfMotion = fn(&Motion) -> i32;

/// Where the value of a variable is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// By its place in [`LOADS`].
    Input(usize),
    Output(fn(&Outputs) -> f64),
    Reaction(fn(&Reactions) -> f64),
    /// The derivative of one of [`COMPONENTS`], by its place.
    StateRate(usize),
    /// One of the event indicators, by its place.
    Indicator(usize),
    Impulse(fn(&Impulse) -> f64),
    Restraint(fn(&Restraints) -> f64),
    Dissipator(fn(&Dissipators) -> f64),
    Integer(OfMotion),
    Boolean(OfMotion),
    Parameter(&'static Quantity<Parameters>),
    InitialValue(&'static Quantity<State>),
    Derived(&'static Derived),
    Detail,
    /// One of the ground's accelerations, the input and the record, by its place in [`LOADS`].
    Ground(usize),
    Peak(fn(&Peaks) -> f64),
    /// The worst value of one of [`ASSUMPTIONS`].
    Worst(usize),
    /// The instant of the worst value of one of [`ASSUMPTIONS`].
    WorstInstant(usize),
    /// Impacts that raise the energy.
    Gains,
    /// The instant of overturning.
    Overturning,
    Text(&'static Text),
    RecordDuration,
    Time,
    Placement(&'static Quantity<Placement>),
    Switch(&'static Switch),
}

/// A parameter that is text: which record.
#[derive(Debug)]
pub(crate) struct Text {
    pub get: fn(&Setup) -> &str,
    pub set: fn(&mut Setup, &str),
}

/// A Boolean parameter.
#[derive(Debug)]
pub(crate) struct Switch {
    pub get: fn(&Setup) -> bool,
    pub set: fn(&mut Setup, bool),
}

impl Source {
    /// The value of a Real parameter or an initial value.
    pub fn setting(&self, setup: &Setup) -> Option<f64> {
        match self {
            Source::Parameter(quantity) => Some((quantity.get)(&setup.parameters)),
            Source::InitialValue(quantity) => Some((quantity.get)(&setup.initial)),
            Source::Placement(quantity) => Some((quantity.get)(&setup.placement)),
            _ => None,
        }
    }

    /// Accepts `value` for a Real parameter or an initial value, or says why not.
    pub fn check(&self, value: f64) -> Result<(), OutOfRange> {
        match self {
            Source::Parameter(quantity) => quantity.check(value),
            Source::InitialValue(quantity) => quantity.check(value),
            Source::Placement(quantity) => quantity.check(value),
            _ => Ok(()),
        }
    }

    /// Sets a Real parameter or an initial value.
    pub fn set(&self, setup: &mut Setup, value: f64) {
        match self {
            Source::Parameter(quantity) => (quantity.set)(&mut setup.parameters, value),
            Source::InitialValue(quantity) => (quantity.set)(&mut setup.initial, value),
            Source::Placement(quantity) => (quantity.set)(&mut setup.placement, value),
            _ => (),
        }
    }
}

/// The phases, as [`phase_number`] numbers them.
pub static PHASES: Enumeration = Enumeration {
    name: "Phase",
    description: "what holds of the base",
    items: &[
        Phase::FullContact.name(),
        Phase::Rocking(Side::Left).name(),
        Phase::Rocking(Side::Right).name(),
        Phase::Overturned(Side::Right).name(),
    ],
};

/// The levels of detail, in the order of [`Detail::ALL`].
pub static DETAILS: Enumeration = Enumeration {
    name: "Detail",
    description: "level of detail: the equations that move the structure",
    items: &[
        Detail::Auto.name(),
        Detail::Nonlinear.name(),
        Detail::Linear.name(),
        Detail::Modal.name(),
        Detail::Rigid.name(),
        Detail::FixedBase.name(),
    ],
};

/// The level that `number` stands for.
pub(crate) fn detail(number: i64) -> Option<Detail> {
    usize::try_from(number).ok()?.checked_sub(1).and_then(|at| Detail::ALL.get(at)).copied()
}

/// The number that stands for `detail`.
pub(crate) fn detail_number(detail: Detail) -> i32 {
    detail as i32 + 1
}

fn phase_number(motion: &Motion) -> i32 {
    match motion.phase {
        Phase::FullContact => 1,
        Phase::Rocking(Side::Left) => 2,
        Phase::Rocking(Side::Right) => 3,
        Phase::Overturned(_) => 4,
    }
}

fn transitions(motion: &Motion) -> i32 {
    i32::try_from(motion.transitions).unwrap_or(i32::MAX)
}

fn overturned(motion: &Motion) -> i32 {
    i32::from(matches!(motion.phase, Phase::Overturned(_)))
}

/// How many variables there are: their table is no allocation, which would be left behind where the library is
/// unloaded.
const COUNT: usize = 106;

/// All variables, in the order of the model description.
pub static VARIABLES: LazyLock<[Variable; COUNT]> = LazyLock::new(|| {
    let inputs = (0..LOADS.len()).map(input);
    inputs
        .chain(outputs())
        .chain(locals())
        .chain(state_rates())
        .chain(event_indicators())
        .chain(peaks())
        .chain(validity())
        .chain(const { &PARAMETERS }.iter().map(|quantity| fixed(quantity, Source::Parameter(quantity))))
        .chain([parameter("detail", DETAILS.description, DataType::Enumeration(&DETAILS), Source::Detail)])
        .chain(const { &INITIAL_VALUES }.iter().map(|quantity| fixed(quantity, Source::InitialValue(quantity))))
        .chain(records())
        .chain(const { &PLACEMENT }.iter().map(|quantity| fixed(quantity, Source::Placement(quantity))))
        .chain(switches())
        .chain(calculated_parameters())
        .chain([time()])
        .collect::<Vec<_>>()
        .try_into()
        .unwrap_or_else(|found: Vec<_>| panic!("{} variables, not {COUNT}", found.len()))
});

fn records() -> [Variable; 2] {
    static HORIZONTAL: Text = Text { get: |setup| &setup.record, set: |setup, text| setup.record = text.into() };
    static VERTICAL: Text = Text { get: |setup| &setup.record_v, set: |setup, text| setup.record_v = text.into() };
    let horizontal = "ground motion record that the ground follows beside a_g: the name of a file in the archive's \
                      resources, or the path or URI of one on disk; PEER .AT2, ESM, K-NET, COSMOS, CSMIP, or a table \
                      of text in s and m/s2 or the unit of the heading; none if empty";
    let vertical = "record that the ground follows vertically beside a_v, as record, with the same start and scales; none if \
                    empty";
    [
        parameter("record", horizontal, DataType::String, Source::Text(&HORIZONTAL)),
        parameter("record_v", vertical, DataType::String, Source::Text(&VERTICAL)),
    ]
}

fn input(which: usize) -> Variable {
    Variable { causality: Causality::Input, ..fixed(&LOADS[which], Source::Input(which)) }
}

/// The inputs.
const LOAD_NAMES: &[&str] = &["a_g", "F_t", "a_v"];

/// What accelerations depend on: the masses, the geometry and theta_dot_0 by the rigid level, the others by the elastic
/// ones.
#[rustfmt::skip]
const ACCELERATIONS: &[&str] = &[
    "m", "m0", "H", "B", "J0", "f_fc", "zeta_fc", "c_ratio", "g", "detail", "theta_0", "theta_dot_0", "u_0", "u_dot_0",
    "P_0", "k_t", "xi_d", "c_d", "k_d", "F_y", "record", "record_v", "record_scale", "record_time_scale", "record_start",
];

fn outputs() -> Vec<Variable> {
    const DELTA_T: &[&str] = &["H", "B", "theta_0", "u_0"];
    const V_T: &[&str] = &["H", "B", "theta_0", "theta_dot_0", "u_0", "u_dot_0"];
    let of_state = |name, unit, description, of, states, initial_dependencies| Variable {
        states,
        ..output(name, unit, description, Source::Output(of), &[], initial_dependencies)
    };
    let force = |name, unit, description, of| Variable {
        states: &COMPONENTS,
        ..output(name, unit, description, Source::Output(of), LOAD_NAMES, ACCELERATIONS)
    };
    let reaction = |name, unit, description, of| Variable {
        states: &COMPONENTS,
        ..output(name, unit, description, Source::Reaction(of), LOAD_NAMES, ACCELERATIONS)
    };
    let impulse = |name, unit, description, of| {
        discrete(name, description, DataType::Real { unit, range: None }, Source::Impulse(of), &[])
    };
    let tie = |name, description, of, states, initial_dependencies| Variable {
        states,
        ..output(name, "N", description, Source::Restraint(of), &[], initial_dependencies)
    };
    const OF_DISSIPATOR: &[&str] = &["B", "theta_0", "theta_dot_0", "xi_d", "c_d", "k_d", "F_y"];
    let elastic = "elastic displacement of the top mass in the frame that turns with the base";
    vec![
        of_state(
            "theta",
            "rad",
            "rotation of the base, positive about the right edge",
            |o| o.theta,
            &["theta"],
            &["theta_0"],
        ),
        of_state("u", "m", elastic, |o| o.u, &["u"], &["u_0"]),
        force("a_t", "m/s2", "acceleration of the top mass, ground included (Eq 27)", |o| o.a_t),
        force("V_t", "N", "m a_t, the base shear where no force acts on the top mass (Eqs 2, 23)", |o| o.V_t),
        force("M_t", "N.m", "m H a_t, the overturning moment where no force acts on the top mass (Eqs 3, 24)", |o| {
            o.M_t
        }),
        of_state(
            "uplift",
            "m",
            "height of the free edge of the base (Eq 25)",
            |o| o.uplift,
            &["theta"],
            &["B", "theta_0"],
        ),
        of_state(
            "delta_t",
            "m",
            "lateral displacement of the top mass (Eq 26)",
            |o| o.delta_t,
            &["u", "theta"],
            DELTA_T,
        ),
        of_state("v_t", "m/s", "lateral velocity of the top mass relative to the ground", |o| o.v_t, &COMPONENTS, V_T),
        reaction("R_h", "N", "horizontal force on the ground, positive to the right", |r| r.R_h),
        reaction("R_v", "N", "vertical force on the ground, positive downwards", |r| r.R_v),
        reaction("R_m", "N.m", "moment on the ground about the middle of the base, positive as theta", |r| r.R_m),
        tie("P_t", "force of the tendon", |r| r.P_t, &["theta"], &["B", "theta_0", "P_0", "k_t"]),
        tie(
            "F_d1",
            "force of the dissipators at +xi_d, viscous and elastoplastic together; pulled is positive",
            |r| r.F_d1,
            &["theta", "theta_dot"],
            OF_DISSIPATOR,
        ),
        tie("F_d2", "force of the dissipators at -xi_d, as F_d1", |r| r.F_d2, &["theta", "theta_dot"], OF_DISSIPATOR),
        impulse("I_h", "N.s", "horizontal impulse of the impacts on the ground so far", |i| i.I_h),
        impulse("I_v", "N.s", "vertical impulse of the impacts on the ground so far, downwards", |i| i.I_v),
        impulse("I_m", "N.m.s", "moment impulse of the impacts on the ground so far, positive as theta", |i| i.I_m),
    ]
}

/// Variables for display: no other model needs them.
fn locals() -> [Variable; 12] {
    const GROUND: &[&str] = &["g", "record", "record_scale", "record_time_scale", "record_start"];
    const GROUND_V: &[&str] = &["g", "record_v", "record_scale", "record_time_scale", "record_start"];
    const PLASTIC: &[&str] = &["B", "theta_0", "xi_d", "k_d", "F_y"];
    let local = |name, unit, description, source, feedthrough, initial_dependencies| Variable {
        causality: Causality::Local,
        ..output(name, unit, description, source, feedthrough, initial_dependencies)
    };
    let counted = |name, description, data_type, source, initial_dependencies| Variable {
        causality: Causality::Local,
        ..discrete(name, description, data_type, source, initial_dependencies)
    };
    let kept = |name, unit, description, of, initial_dependencies| {
        local(name, unit, description, Source::Dissipator(of), &[], initial_dependencies)
    };
    let (turning, swaying) = (Source::Output(|o| o.theta_dot), Source::Output(|o| o.u_dot));
    let phases = DataType::Enumeration(&PHASES);
    [
        local("theta_dot", "rad/s", "angular velocity of the base", turning, &[], &["theta_dot_0"]),
        local("u_dot", "m/s", "elastic velocity of the top mass", swaying, &[], &["u_dot_0"]),
        local("a_ground", "m/s2", "ground acceleration: a_g and the record", Source::Ground(0), &["a_g"], GROUND),
        local(
            "a_v_ground",
            "m/s2",
            "vertical ground acceleration: a_v and record_v",
            Source::Ground(VERTICAL),
            &["a_v"],
            GROUND_V,
        ),
        kept("e_p1", "m", "plastic elongation of the elastoplastic dissipator at +xi_d", |d| d.plastic[0], PLASTIC),
        kept("e_p2", "m", "plastic elongation of the elastoplastic dissipator at -xi_d", |d| d.plastic[1], PLASTIC),
        kept("E_viscous", "J", "energy that the viscous dissipators have taken", |d| d.viscous, &[]),
        kept("E_hysteretic", "J", "energy that the elastoplastic dissipators have taken", |d| d.hysteretic, &[]),
        counted("phase", PHASES.description, phases, Source::Integer(phase_number), &["theta_0"]),
        counted(
            "transitions",
            "transitions so far: uplifts, impacts, landings (settling, too), overturning; dissipators that begin or cease to yield",
            DataType::Integer,
            Source::Integer(transitions),
            &[],
        ),
        counted(
            "overturned",
            "whether the structure has overturned",
            DataType::Boolean,
            Source::Boolean(overturned),
            &[],
        ),
        counted(
            "t_overturned",
            "instant of overturning; startTime while the structure stands",
            DataType::Real { unit: "s", range: None },
            Source::Overturning,
            &[],
        ),
    ]
}

/// Derivatives of the states.
fn state_rates() -> [Variable; 4] {
    let rate = |which, name, unit, description| Variable {
        causality: Causality::Local,
        ..output(name, unit, description, Source::StateRate(which), &[], &[])
    };
    let velocity = |which, name, unit, description, states, initial_dependencies| Variable {
        states,
        initial_dependencies,
        ..rate(which, name, unit, description)
    };
    let acceleration = |which, name, unit, description| Variable {
        states: &COMPONENTS,
        feedthrough: LOAD_NAMES,
        initial_dependencies: ACCELERATIONS,
        ..rate(which, name, unit, description)
    };
    let [of_u, of_theta] = ["rate of u", "rate of theta"];
    [
        velocity(0, "der(u)", "m/s", of_u, &["u_dot"], &["u_dot_0"]),
        acceleration(1, "der(u_dot)", "m/s2", "rate of u_dot, by the equations of the level of detail"),
        velocity(2, "der(theta)", "rad/s", of_theta, &["theta_dot"], &["theta_dot_0"]),
        acceleration(3, "der(theta_dot)", "rad/s2", "rate of theta_dot, by the equations of the level of detail"),
    ]
}

/// The event indicators, in their order: they tell a host that integrates that a phase ends.
fn event_indicators() -> [Variable; INDICATORS] {
    #[rustfmt::skip]
    const PHASE: &[&str] = &[
        "m", "m0", "H", "B", "f_fc", "zeta_fc", "c_ratio", "g", "detail", "theta_0", "u_0", "u_dot_0",
        "P_0", "record", "record_v", "record_scale", "record_time_scale", "record_start",
    ];
    let indicator = |which, name, description| Variable {
        causality: Causality::Local,
        ..output(name, "1", description, Source::Indicator(which), &[], &[])
    };
    [
        Variable {
            feedthrough: LOAD_NAMES,
            states: &["u", "u_dot", "theta"],
            initial_dependencies: PHASE,
            ..indicator(
                0,
                "phase_indicator",
                "event indicator, positive while the phase lasts: what u and its moment lack to uplift; theta over alpha_cg",
            )
        },
        Variable {
            states: &["theta", "theta_dot"],
            initial_dependencies: &["B", "theta_0", "xi_d", "k_d", "F_y"],
            ..indicator(
                1,
                "overturning_indicator",
                "event indicator, positive until the structure has overturned, or a dissipator yields or ceases to",
            )
        },
    ]
}

/// Largest magnitudes and their instants.
fn peaks() -> Vec<Variable> {
    let peak = |name, unit, description, of| Variable {
        causality: Causality::Local,
        ..discrete(name, description, DataType::Real { unit, range: None }, Source::Peak(of), &[])
    };
    macro_rules! peaks {
        ($($name:ident $unit:literal)*) => {
            vec![$(
                peak(
                    concat!(stringify!($name), "_max"),
                    $unit,
                    concat!(
                        "largest |",
                        stringify!($name),
                        "| since startTime, exact: within steps, too, and during a fall to overturning; NaN unless peaks is true"
                    ),
                    |peaks| peaks.$name().magnitude,
                ),
                peak(
                    concat!("t_", stringify!($name), "_max"),
                    "s",
                    concat!("first instant of ", stringify!($name), "_max; NaN unless peaks is true"),
                    |peaks| peaks.$name().time,
                ),
            )*]
        };
    }
    peaks!(theta "rad" u "m" delta_t "m" uplift "m" a_t "m/s2" V_t "N" M_t "N.m" P_t "N")
}

/// What the motion goes beyond.
fn validity() -> Vec<Variable> {
    let local = |name, description, data_type, source| Variable {
        causality: Causality::Local,
        ..discrete(name, description, data_type, source, &[])
    };
    let real = |unit| DataType::Real { unit, range: None };
    let of_assumption = |(which, assumption): (usize, &'static Assumption)| {
        let Assumption { name, time_name, description, time_description, .. } = assumption;
        [
            local(name, description, real("1"), Source::Worst(which)),
            local(time_name, time_description, real("s"), Source::WorstInstant(which)),
        ]
    };
    let gains = "impacts since startTime that raise the energy";
    const { &ASSUMPTIONS }
        .iter()
        .enumerate()
        .flat_map(of_assumption)
        .chain([local("energy_gains", gains, DataType::Integer, Source::Gains)])
        .collect()
}

fn switches() -> [Variable; 4] {
    static LATE: Switch = Switch { get: |setup| setup.a_g_late, set: |setup, on| setup.a_g_late = on };
    static EXTRAPOLATED: Switch =
        Switch { get: |setup| setup.F_t_extrapolated, set: |setup, on| setup.F_t_extrapolated = on };
    static PEAKS: Switch = Switch { get: |setup| setup.peaks, set: |setup, on| setup.peaks = on };
    static VALIDITY: Switch = Switch { get: |setup| setup.validity, set: |setup, on| setup.validity = on };
    let validity =
        "whether it is watched what the motion goes beyond: tension, edges that pull, friction, energy gained";
    let late = "whether a_g and a_v, set without their derivatives, are followed one communication step late, in a straight \
                line from each value to the next, and are not held";
    let extrapolated = "whether F_t, set without its derivative, goes on with the slope of its values at the last two \
                        communication points, and is not held; where it is not set before a step it is held over that";
    [
        parameter("a_g_late", late, DataType::Boolean, Source::Switch(&LATE)),
        parameter("F_t_extrapolated", extrapolated, DataType::Boolean, Source::Switch(&EXTRAPOLATED)),
        parameter(
            "peaks",
            "whether the largest magnitudes theta_max, u_max, ... are watched for",
            DataType::Boolean,
            Source::Switch(&PEAKS),
        ),
        parameter("validity", validity, DataType::Boolean, Source::Switch(&VALIDITY)),
    ]
}

/// Time. Descriptions of FMI 2.0 leave it out: it is last, so that the other references are the same in both versions.
fn time() -> Variable {
    Variable {
        causality: Causality::Independent,
        ..output("time", "s", "where the simulation is", Source::Time, &[], &[])
    }
}

fn calculated_parameters() -> [Variable; 6] {
    [
        calculated("alpha_cg", &["m", "m0", "H", "B"]),
        calculated("p_l", &["m", "m0", "H", "B", "J0", "g"]),
        calculated("chi", &["m", "m0", "H", "B", "J0"]),
        calculated("u_cr", &["m", "m0", "H", "B", "f_fc", "g", "P_0"]),
        calculated("f_u", &["m", "m0", "H", "B", "J0", "f_fc"]),
        Variable {
            causality: Causality::CalculatedParameter,
            ..output(
                "record_duration",
                "s",
                "from the first to the last sample of the record, of either component; 0 without a record",
                Source::RecordDuration,
                &[],
                &["record", "record_v", "record_time_scale"],
            )
        },
    ]
}

fn output(
    name: &'static str,
    unit: &'static str,
    description: &'static str,
    source: Source,
    feedthrough: &'static [&'static str],
    initial_dependencies: &'static [&'static str],
) -> Variable {
    let data_type = DataType::Real { unit, range: None };
    Variable { feedthrough, ..discrete(name, description, data_type, source, initial_dependencies) }
}

fn discrete(
    name: &'static str,
    description: &'static str,
    data_type: DataType,
    source: Source,
    initial_dependencies: &'static [&'static str],
) -> Variable {
    Variable {
        name,
        description,
        data_type,
        causality: Causality::Output,
        feedthrough: &[],
        states: &[],
        initial_dependencies,
        source,
    }
}

fn parameter(name: &'static str, description: &'static str, data_type: DataType, source: Source) -> Variable {
    Variable { causality: Causality::Parameter, ..discrete(name, description, data_type, source, &[]) }
}

fn fixed<T>(quantity: &'static Quantity<T>, source: Source) -> Variable {
    let data_type = DataType::Real { unit: quantity.unit, range: Some((quantity.min, quantity.max)) };
    parameter(quantity.name, quantity.description, data_type, source)
}

fn calculated(name: &'static str, initial_dependencies: &'static [&'static str]) -> Variable {
    let derived = const { &DERIVED }.iter().find(|derived| derived.name == name);
    let derived = derived.unwrap_or_else(|| panic!("no derived quantity is called {name}"));
    let Derived { description, unit, .. } = derived;
    Variable {
        causality: Causality::CalculatedParameter,
        ..output(name, unit, description, Source::Derived(derived), &[], initial_dependencies)
    }
}

impl Variable {
    /// Whether it may change at any time, and not at transitions alone.
    pub fn is_continuous(&self) -> bool {
        match self.source {
            Source::Input(_) | Source::Output(_) | Source::Reaction(_) => true,
            Source::StateRate(_) | Source::Indicator(_) => true,
            Source::Restraint(_) | Source::Dissipator(_) => true,
            Source::Ground(_) | Source::Peak(_) | Source::Time => true,
            Source::Worst(which) | Source::WorstInstant(which) => !ASSUMPTIONS[which].is_of_impacts,
            _ => false,
        }
    }

    /// Which of the continuous states it is, by the place in [`COMPONENTS`].
    pub fn as_state(&self) -> Option<usize> {
        COMPONENTS.iter().position(|name| *name == self.name)
    }

    /// Which of the continuous states it is the derivative of.
    pub fn as_state_rate(&self) -> Option<usize> {
        if let Source::StateRate(which) = self.source { Some(which) } else { None }
    }

    /// Which of the event indicators it is.
    pub fn as_indicator(&self) -> Option<usize> {
        if let Source::Indicator(which) = self.source { Some(which) } else { None }
    }

    /// The start value in an FMU with these `contents`: of the inputs, the parameters and the initial values.
    pub fn start(&self, contents: &Contents) -> Option<Value> {
        let setup = Setup::new(contents);
        match self.source {
            Source::Input(which) => Some(Value::Real((LOADS[which].get)(&Load::default()))),
            Source::Detail => Some(Value::Item(detail_number(setup.detail))),
            Source::Text(text) => Some(Value::String((text.get)(&setup).to_owned())),
            Source::Switch(switch) => Some(Value::Boolean((switch.get)(&setup))),
            _ => self.source.setting(&setup).map(Value::Real),
        }
    }
}
