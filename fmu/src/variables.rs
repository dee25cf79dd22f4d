//! The one table of the FMU's variables. The name, the range, the setter, the source and the dependencies of a variable stand
//! here and nowhere else.

use crate::floor_variables;
use crate::inputs::{FORCE, loads};
use crate::resources::Contents;
use crate::setup::Setup;
use crate::source::{DETAILS, PHASES, Source, VariableRow};
use fmi_unit::{Causality, DataType, Variable};
use rocking::mechanics::load::LOADS;
use rocking::mechanics::outputs::ACCELERATION;
use rocking::mechanics::state::{COMPONENTS, INITIAL_VALUES};
use rocking::run::ground_motion::PLACEMENT;
use rocking::run::host_step::INDICATORS;
use rocking::run::validity::{ASSUMPTIONS, Assumption};
use rocking::structure::derived::DERIVED;
use rocking::structure::description::{DescribedNumber, Description};
use rocking::structure::quantity::Quantity;
use rocking::{Output, Structure};
use rocking_records::LAYOUTS;
use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::{Arc, LazyLock};

#[derive(Clone, Debug)]
pub struct VariableTable {
    /// The variables, in the order of the model description.
    pub variables: Arc<[Variable]>,
    pub sources: Arc<[Source]>,
}

impl VariableTable {
    /// The table of an FMU with these `contents`, which give start values.
    pub fn new(contents: &Contents) -> VariableTable {
        let (setup, mut rows) = (Setup::new(contents), rows(&contents.structure));
        rows.retain(|(variable, _)| !contents.fixed || variable.data_type != DataType::String);
        let is_known = |(variable, _): &&VariableRow| variable.causality != Causality::CalculatedParameter;
        let knowns: HashSet<_> = rows.iter().filter(is_known).map(|(variable, _)| variable.name.clone()).collect();
        let known = |name: &Cow<'static, str>| floor_variables::all_of(name, &knowns);
        let started = rows.into_iter().map(|(variable, source)| {
            let depends_on = variable.depends_on.iter().flat_map(known).collect();
            (Variable { start: source.set_value(&setup), depends_on, ..variable }, source)
        });
        let (variables, sources): (Vec<_>, Vec<_>) = started.unzip();
        VariableTable { variables: variables.into(), sources: sources.into() }
    }
}

/// The rows of `structure`. One mass has parameters where many masses have fixed numbers, and its locals follow its outputs.
fn rows(structure: &Structure) -> Vec<VariableRow> {
    let is_one = structure.is_one_mass();
    let of = |is_so: bool, rows: fn(&Structure) -> Vec<VariableRow>| if is_so { rows(structure) } else { Vec::new() };
    let (of_one, of_many) = (|rows| of(is_one, rows), |rows| of(!is_one, rows));
    let is_coordinate = |of: &Output| matches!(of, Output::y | Output::x | Output::x_dot | Output::s(_));
    let outputs = Output::all(structure).into_iter().filter(|of| !is_coordinate(of)).map(|of| output(of, structure));
    let (outputs, locals_of_one): (Vec<_>, Vec<_>) =
        outputs.partition(|(variable, _)| !is_one || variable.causality == Causality::Output);
    let all = [
        inputs(structure),
        outputs,
        of(structure.one().is_none(), floor_variables::coordinates),
        of_many(floor_variables::state_rates),
        of_many(peaks),
        of(structure.one().is_none(), calculated_numbers),
        forces().into(),
        locals_of_one,
        locals(),
        of_one(floor_variables::state_rates),
        event_indicators(structure).into(),
        of_one(peaks),
        validity(),
        structure.description().map_or(Vec::new(), parameters),
        vec![parameter("detail", DETAILS.description, DataType::Enumeration(&DETAILS), Source::Detail)],
        initial_values(structure),
        records().into(),
        const { &PLACEMENT }.iter().map(|of| fixed(of, Source::Placement(of))).collect(),
        switches().into(),
        of(structure.one().is_some(), |_| calculated_parameters().into()),
        vec![record_duration(), (Variable::time(), Source::Time)],
    ];
    all.into_iter().flatten().collect()
}

/// The initial values, of many masses of each floor.
fn initial_values(structure: &Structure) -> Vec<VariableRow> {
    let row = |which: usize, floor: usize| {
        let (mut variable, source) = fixed(&INITIAL_VALUES[which], Source::InitialValue(which, floor));
        if which > 1 && !structure.is_one_mass() {
            variable.name = format!("{}[{}]", variable.name, floor + 1).into();
            variable.description = variable.description.replace("the top mass", &format!("floor {}", floor + 1)).into();
        }
        (variable, source)
    };
    let count = |which| if which < 2 { 1 } else { structure.floors().len() };
    (0..INITIAL_VALUES.len()).flat_map(|which| (0..count(which)).map(move |floor| row(which, floor))).collect()
}

fn records() -> [VariableRow; 2] {
    static OF_HORIZONTAL: LazyLock<String> = LazyLock::new(|| {
        format!(
            "ground motion record, which is added to a_g: the name of a file in the archive's resources, or the path or \
             URI of a file on disk; {LAYOUTS} in s and m/s2 or the unit of the heading; none if empty"
        )
    });
    let vertical = "vertical ground motion record, which is added to a_v: a file as for record, with the same start and \
                    scales; none if empty";
    [
        parameter("record", &OF_HORIZONTAL, DataType::String, Source::Text(|setup| &mut setup.record)),
        parameter("record_v", vertical, DataType::String, Source::Text(|setup| &mut setup.record_v)),
    ]
}

/// The loads, of many masses a force on each floor.
fn inputs(structure: &Structure) -> Vec<VariableRow> {
    let row = |(which, load): (usize, usize)| {
        let (mut variable, source) = fixed(&LOADS[load], Source::Input(which));
        if load == FORCE && !structure.is_one_mass() {
            let floor = which - 1; // after a_g and a_v
            variable.name = format!("{}[{floor}]", variable.name).into();
            variable.description = format!("external horizontal force on floor {floor}, positive to the right").into();
        }
        (Variable { causality: Causality::Input, is_continuous: true, ..variable }, source)
    };
    loads(structure).into_iter().enumerate().map(row).collect()
}

/// A continuous real number, and what it follows from.
fn real(
    causality: Causality,
    [name, unit, description]: [&'static str; 3],
    source: Source,
    of: &[&'static str],
) -> VariableRow {
    (Variable::real(causality, name, unit, description).from(of.iter().copied()), source)
}

fn local(texts: [&'static str; 3], source: Source, of: &[&'static str]) -> VariableRow {
    real(Causality::Local, texts, source, of)
}

/// A local variable that events alone change.
fn counted(name: &'static str, description: &'static str, data_type: DataType, source: Source) -> VariableRow {
    (Variable::of_type(data_type, Causality::Local, name, description), source)
}

const fn number(unit: &'static str) -> DataType {
    DataType::Real { unit, range: None }
}

/// An output of the library, with the variables that it follows from, of which many masses have some.
fn output(of: Output, structure: &Structure) -> VariableRow {
    let is_local = matches!(of, Output::theta_dot | Output::u_dot(_));
    let causality = if is_local { Causality::Local } else { Causality::Output };
    let name = of.name(structure);
    let variable = Variable::real(causality, name.clone(), of.unit(), of.description(structure));
    let variable = match COMPONENTS.contains(&&*name) {
        true => variable.from([format!("{name}_0")]).state(),
        false => variable.from(of.follows_from().iter().copied()),
    };
    (variable, Source::Output(of))
}

/// Reactions, forces of the ties, and impulses.
fn forces() -> [VariableRow; 9] {
    let force = |texts, source, of: &_| real(Causality::Output, texts, source, of);
    let reaction = |name, unit, description, of| force([name, unit, description], Source::Reaction(of), ACCELERATION);
    let impulse = |name, unit, description, of| {
        (Variable::of_type(number(unit), Causality::Output, name, description), Source::Impulse(of))
    };
    let tie =
        |of: Output, value| force([of.symbol(), of.unit(), of.text()], Source::Restraint(value), of.follows_from());
    [
        reaction("R_h", "N", "horizontal force on the ground, positive to the right", |r| r.R_h),
        reaction("R_v", "N", "vertical force on the ground, positive downwards", |r| r.R_v),
        reaction("R_m", "N.m", "moment on the ground about the middle of the base, signed like theta", |r| r.R_m),
        tie(Output::P_t, |r| r.P_t),
        tie(Output::F_d1, |r| r.F_d1),
        tie(Output::F_d2, |r| r.F_d2),
        impulse("I_h", "N.s", "horizontal impulse of the impacts on the ground so far", |i| i.I_h),
        impulse("I_v", "N.s", "vertical impulse of the impacts on the ground so far, downwards", |i| i.I_v),
        impulse("I_m", "N.m.s", "moment impulse of the impacts on the ground so far, signed like theta", |i| i.I_m),
    ]
}

/// Variables for display: no other model needs them.
fn locals() -> Vec<VariableRow> {
    const PLASTIC: &[&str] = &["B", "theta_0", "xi_d", "k_d", "F_y"];
    let kept = |name, unit, description, of, from| local([name, unit, description], Source::Dissipator(of), from);
    let ground = |name, description, is_vertical, input, record| {
        let placed = ["record_scale", "record_time_scale", "record_start", "g", "time"];
        local([name, "m/s2", description], Source::Ground(is_vertical), &[&[input, record][..], &placed].concat())
    };
    let (phase, source) = counted("phase", PHASES.description, DataType::Enumeration(&PHASES), Source::Phase);
    vec![
        ground("a_ground", "ground acceleration: a_g and the record", false, "a_g", "record"),
        ground("a_v_ground", "vertical ground acceleration: a_v and record_v", true, "a_v", "record_v"),
        kept("e_p1", "m", "plastic elongation of the elastoplastic dissipator at +xi_d", |d| d.plastic[0], PLASTIC),
        kept("e_p2", "m", "plastic elongation of the elastoplastic dissipator at -xi_d", |d| d.plastic[1], PLASTIC),
        kept("E_viscous", "J", "energy dissipated by the viscous dissipators", |d| d.viscous, &[]),
        kept("E_hysteretic", "J", "energy dissipated by the elastoplastic dissipators", |d| d.hysteretic, &[]),
        (phase.from(["theta_0"]), source),
        counted(
            "transitions",
            "number of transitions so far: uplift, impact, landing (also settling), overturning, start and end of yielding of a dissipator; \
             on ground that gives touch and release of a contact point, start and end of its yielding, slip, stick and flight",
            DataType::Integer,
            Source::Transitions,
        ),
        counted("overturned", "whether the structure has overturned", DataType::Boolean, Source::Overturned),
        counted(
            "t_overturned",
            "instant of overturning; startTime until the structure overturns",
            number("s"),
            Source::Overturning,
        ),
    ]
}

/// The event indicators, in their order: they tell a host that integrates that a phase ends.
fn event_indicators(structure: &Structure) -> [VariableRow; INDICATORS] {
    #[rustfmt::skip]
    const PHASE: &[&str] = &[
        "a_ground", "F_t", "a_v_ground", "u", "u_dot", "theta", "m", "m0", "H", "B", "f_fc", "zeta_fc", "c_ratio", "g", "detail", "P_0",
        "xi_d", "k_d", "F_y", "s", "f_v",
    ];
    const END: &[&str] = &["theta", "theta_dot", "B", "xi_d", "k_d", "F_y"];
    let may_slide = structure.foundation().is_some_and(|ground| ground.mu_c.is_some());
    let end = if may_slide { [END, ACCELERATION, &["x_dot"]].concat() } else { END.into() };
    let indicator = |which, name, description, of| {
        let (variable, source) = local([name, "1", description], Source::Indicator(which), of);
        (variable.indicator(), source)
    };
    let of_phase = "event indicator, positive while the phase lasts: in full contact the margin to uplift, while rocking \
                    s theta/alpha_cg, s = 1 about the right edge, -1 about the left; on ground that gives until a contact point is \
                    touched or released, or starts or stops yielding";
    let of_end = "event indicator, positive until the structure overturns, a dissipator starts or stops yielding, or the base \
                  starts or stops sliding";
    [indicator(0, "phase_indicator", of_phase, PHASE), indicator(1, "overturning_indicator", of_end, &end)]
}

/// Largest magnitudes and their instants. A host may add a tendon and dissipators.
fn peaks(structure: &Structure) -> Vec<VariableRow> {
    let mut all = Output::with_peak(structure);
    let missing = Output::OF_TIES.into_iter().filter(|of| !all.contains(of));
    all.extend(Vec::from_iter(missing));
    let rows = all.into_iter().flat_map(|of| {
        let (symbol, name) = (of.symbol(), of.name(structure));
        let peak = name.replacen(symbol, &format!("{symbol}_max"), 1);
        let magnitude = format!(
            "largest |{name}| since startTime, exact, also between communication points, without the fall if the structure \
             overturns; NaN unless peaks is true"
        );
        let instant = format!("first instant of {peak}; NaN unless peaks is true");
        [
            (Variable::real(Causality::Local, peak.clone(), of.unit(), magnitude), Source::Peak(of)),
            (Variable::real(Causality::Local, format!("t_{peak}"), "s", instant), Source::PeakInstant(of)),
        ]
    });
    rows.collect()
}

fn validity() -> Vec<VariableRow> {
    let of_assumption = |(which, assumption): (usize, &'static Assumption)| {
        let Assumption { name, time_name, description, time_description, is_of_impacts, .. } = *assumption;
        let worst = |name, unit, description, source| {
            let (variable, source) = local([name, unit, description], source, &[]);
            (Variable { is_continuous: !is_of_impacts, ..variable }, source)
        };
        [
            worst(name, "1", description, Source::Worst(which)),
            worst(time_name, "s", time_description, Source::WorstInstant(which)),
        ]
    };
    let gains = counted("energy_gains", "number of impacts that raise the energy", DataType::Integer, Source::Gains);
    const { &ASSUMPTIONS }.iter().enumerate().flat_map(of_assumption).chain([gains]).collect()
}

fn switches() -> [VariableRow; 4] {
    let switch = |name, description, of| parameter(name, description, DataType::Boolean, Source::Switch(of));
    let peaks = "true computes the largest magnitudes theta_max, u_max, ... and their instants";
    let validity = "true checks the limits of the model (tension, load of the edge, friction, energy gain) and logs the first \
                    time that the motion exceeds each";
    let late = "if a_g and a_v are set without derivatives: true follows straight lines from value to value, one \
                communication step late; false holds each value over its step";
    let extrapolated = "if F_t is set without its derivative: true extrapolates F_t over the step from its values at the last \
                        two communication points; false, or a step before which F_t is not set, holds F_t";
    [
        switch("a_g_late", late, |setup| &mut setup.a_g_late),
        switch("F_t_extrapolated", extrapolated, |setup| &mut setup.F_t_extrapolated),
        switch("peaks", peaks, |setup| &mut setup.peaks),
        switch("validity", validity, |setup| &mut setup.validity),
    ]
}

fn parameters(description: &Description) -> Vec<VariableRow> {
    let row = |(which, of): (usize, DescribedNumber)| {
        let data_type = DataType::Real { unit: of.unit, range: Some((of.min, of.max)) };
        (Variable::of_type(data_type, Causality::Parameter, of.name, of.description), Source::Parameter(which))
    };
    description.numbers().into_iter().enumerate().map(row).collect()
}

/// The numbers of a structure that follow from these, but for those of one mass on rigid ground.
fn calculated_numbers(structure: &Structure) -> Vec<VariableRow> {
    let row = |(which, (variable, _))| (variable, Source::Known(which));
    floor_variables::numbers(structure).into_iter().enumerate().map(row).collect()
}

fn calculated_parameters() -> [VariableRow; 5] {
    let calculated = |name, of: &[&'static str]| {
        let derived = const { &DERIVED }.iter().find(|derived| derived.name == name);
        let derived = derived.unwrap_or_else(|| panic!("no derived quantity is called {name}"));
        real(Causality::CalculatedParameter, [name, derived.unit, derived.description], Source::Derived(derived), of)
    };
    [
        calculated("alpha_cg", &["m", "m0", "H", "B"]),
        calculated("p_l", &["m", "m0", "H", "B", "J0", "g"]),
        calculated("chi", &["m", "m0", "H", "B", "J0"]),
        calculated("u_cr", &["m", "m0", "H", "B", "f_fc", "g", "P_0"]),
        calculated("f_u", &["m", "m0", "H", "B", "J0", "f_fc"]),
    ]
}

fn record_duration() -> VariableRow {
    let duration = "time from the first to the last sample of the record, of either component; 0 without a record";
    let texts = ["record_duration", "s", duration];
    real(Causality::CalculatedParameter, texts, Source::RecordDuration, &["record", "record_v", "record_time_scale"])
}

fn parameter(name: &'static str, description: &'static str, data_type: DataType, source: Source) -> VariableRow {
    (Variable::of_type(data_type, Causality::Parameter, name, description), source)
}

fn fixed<T>(quantity: &'static Quantity<T>, source: Source) -> VariableRow {
    let &Quantity { name, unit, description, min, max, .. } = quantity;
    parameter(name, description, DataType::Real { unit, range: Some((min, max)) }, source)
}
