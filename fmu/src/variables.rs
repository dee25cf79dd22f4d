//! The one table of the FMU's variables. What a variable is called, what it may be, who sets it and what it depends on
//! stands here and nowhere else: the model description is written from this table, and the C functions read and write
//! through it. A value reference is a position in the table.

use rocking::engine::Motion;
use rocking::load::LOADS;
use rocking::parameters::PARAMETERS;
use rocking::quantity::Quantity;
use rocking::state::INITIAL_VALUES;
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
    /// The FMU, for the host.
    Output,
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
    /// One of these, numbered from 1.
    Enumeration(&'static Enumeration),
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
    Input(&'static Quantity<Load>),
    Output(fn(&Outputs) -> f64),
    Reaction(fn(&Reactions) -> f64),
    Impulse(fn(&Impulse) -> f64),
    Integer(OfMotion),
    Boolean(OfMotion),
    Parameter(&'static Quantity<Parameters>),
    InitialValue(&'static Quantity<State>),
    Derived(&'static Derived),
    Detail,
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
pub(crate) fn detail(number: i32) -> Option<Detail> {
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

/// All variables, in the order of the model description.
pub static VARIABLES: LazyLock<Vec<Variable>> = LazyLock::new(|| {
    let inputs = const { &LOADS }.iter().map(input);
    inputs
        .chain(outputs())
        .chain(const { &PARAMETERS }.iter().map(|quantity| fixed(quantity, Source::Parameter(quantity))))
        .chain(std::iter::once(detail_parameter()))
        .chain(const { &INITIAL_VALUES }.iter().map(|quantity| fixed(quantity, Source::InitialValue(quantity))))
        .chain(calculated_parameters())
        .collect()
});

fn input(quantity: &'static Quantity<Load>) -> Variable {
    Variable {
        name: quantity.name,
        description: quantity.description,
        data_type: DataType::Real { unit: quantity.unit, range: Some((quantity.min, quantity.max)) },
        causality: Causality::Input,
        feedthrough: &[],
        initial_dependencies: &[],
        source: Source::Input(quantity),
    }
}

fn outputs() -> Vec<Variable> {
    // The masses, the geometry and theta_dot_0 by the rigid level, the others by the elastic ones.
    const ACCELERATIONS: &[&str] = &[
        "m",
        "m0",
        "H",
        "B",
        "J0",
        "f_fc",
        "zeta_fc",
        "c_ratio",
        "g",
        "detail",
        "theta_0",
        "theta_dot_0",
        "u_0",
        "u_dot_0",
    ];
    const DELTA_T: &[&str] = &["H", "B", "theta_0", "u_0"];
    const V_T: &[&str] = &["H", "B", "theta_0", "theta_dot_0", "u_0", "u_dot_0"];
    let of_state = |name, unit, description, of, initial_dependencies| {
        output(name, unit, description, Source::Output(of), &[], initial_dependencies)
    };
    let force = |name, unit, description, of| {
        output(name, unit, description, Source::Output(of), &["a_g", "F_t"], ACCELERATIONS)
    };
    let reaction = |name, unit, description, of| {
        output(name, unit, description, Source::Reaction(of), &["a_g", "F_t"], ACCELERATIONS)
    };
    let impulse = |name, unit, description, of| {
        discrete(name, description, DataType::Real { unit, range: None }, Source::Impulse(of), &[])
    };
    let elastic = "elastic displacement of the top mass in the frame that turns with the base";
    vec![
        of_state("theta", "rad", "rotation of the base, positive about the right edge", |o| o.theta, &["theta_0"]),
        of_state("u", "m", elastic, |o| o.u, &["u_0"]),
        force("a_t", "m/s2", "acceleration of the top mass, ground included (Eq 27)", |o| o.a_t),
        force("V_t", "N", "m a_t, the base shear where no force acts on the top mass (Eqs 2, 23)", |o| o.V_t),
        force("M_t", "N.m", "m H a_t, the overturning moment where no force acts on the top mass (Eqs 3, 24)", |o| {
            o.M_t
        }),
        of_state("theta_dot", "rad/s", "angular velocity of the base", |o| o.theta_dot, &["theta_dot_0"]),
        of_state("u_dot", "m/s", "elastic velocity of the top mass", |o| o.u_dot, &["u_dot_0"]),
        of_state("uplift", "m", "height of the free edge of the base (Eq 25)", |o| o.uplift, &["B", "theta_0"]),
        of_state("delta_t", "m", "lateral displacement of the top mass (Eq 26)", |o| o.delta_t, DELTA_T),
        of_state("v_t", "m/s", "lateral velocity of the top mass relative to the ground", |o| o.v_t, V_T),
        reaction("R_h", "N", "horizontal force on the ground, positive to the right", |r| r.R_h),
        reaction("R_v", "N", "vertical force on the ground, positive downwards", |r| r.R_v),
        reaction("R_m", "N.m", "moment on the ground about the middle of the base, positive as theta", |r| r.R_m),
        impulse("I_h", "N.s", "horizontal impulse of the impacts on the ground so far", |i| i.I_h),
        impulse("I_v", "N.s", "vertical impulse of the impacts on the ground so far, downwards", |i| i.I_v),
        impulse("I_m", "N.m.s", "moment impulse of the impacts on the ground so far, positive as theta", |i| i.I_m),
        discrete(
            "phase",
            PHASES.description,
            DataType::Enumeration(&PHASES),
            Source::Integer(phase_number),
            &["theta_0"],
        ),
        discrete(
            "transitions",
            "uplifts, impacts and landings so far",
            DataType::Integer,
            Source::Integer(transitions),
            &[],
        ),
        discrete(
            "overturned",
            "whether the structure has overturned",
            DataType::Boolean,
            Source::Boolean(overturned),
            &[],
        ),
    ]
}

fn detail_parameter() -> Variable {
    Variable {
        name: "detail",
        description: DETAILS.description,
        data_type: DataType::Enumeration(&DETAILS),
        causality: Causality::Parameter,
        feedthrough: &[],
        initial_dependencies: &[],
        source: Source::Detail,
    }
}

fn calculated_parameters() -> [Variable; 5] {
    [
        calculated("alpha_cg", &["m", "m0", "H", "B"]),
        calculated("p_l", &["m", "m0", "H", "B", "J0", "g"]),
        calculated("chi", &["m", "m0", "H", "B", "J0"]),
        calculated("u_cr", &["m", "m0", "H", "B", "f_fc", "g"]),
        calculated("f_u", &["m", "m0", "H", "B", "J0", "f_fc"]),
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
    Variable {
        name,
        description,
        data_type: DataType::Real { unit, range: None },
        causality: Causality::Output,
        feedthrough,
        initial_dependencies,
        source,
    }
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
        initial_dependencies,
        source,
    }
}

fn fixed<T>(quantity: &'static Quantity<T>, source: Source) -> Variable {
    Variable {
        name: quantity.name,
        description: quantity.description,
        data_type: DataType::Real { unit: quantity.unit, range: Some((quantity.min, quantity.max)) },
        causality: Causality::Parameter,
        feedthrough: &[],
        initial_dependencies: &[],
        source,
    }
}

fn calculated(name: &'static str, initial_dependencies: &'static [&'static str]) -> Variable {
    let derived = const { &DERIVED }.iter().find(|derived| derived.name == name);
    let derived = derived.unwrap_or_else(|| panic!("no derived quantity is called {name}"));
    Variable {
        name,
        description: derived.description,
        data_type: DataType::Real { unit: derived.unit, range: None },
        causality: Causality::CalculatedParameter,
        feedthrough: &[],
        initial_dependencies,
        source: Source::Derived(derived),
    }
}

impl Variable {
    /// Whether it may change at any time, and not at transitions alone.
    pub fn is_continuous(&self) -> bool {
        matches!(self.source, Source::Input(_) | Source::Output(_) | Source::Reaction(_))
    }

    /// The start value in an FMU of the structure `parameters`: of the inputs, the parameters and the initial values.
    pub fn start(&self, parameters: &Parameters) -> Option<f64> {
        match self.source {
            Source::Input(quantity) => Some((quantity.get)(&Load::default())),
            Source::Parameter(quantity) => Some((quantity.get)(parameters)),
            Source::InitialValue(quantity) => Some((quantity.get)(&State::default())),
            Source::Detail => Some(f64::from(detail_number(Detail::default()))),
            _ => None,
        }
    }
}
