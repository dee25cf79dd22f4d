//! Exact text: what a small description must look like in XML.

use super::*;
use crate::{BaseUnit, Category, Item, Unit};

fn spring() -> FmiModelDescription {
    let common = |name: &str, value_reference, causality, variability, initial| Common {
        name: name.into(),
        value_reference,
        description: "a < b".into(),
        causality,
        variability,
        initial,
    };
    let (exact, calculated) = (Some(Initial::Exact), Some(Initial::Calculated));
    let float = |common| Float64 {
        common,
        intermediate_update: None,
        unit: None,
        display_unit: None,
        min: None,
        max: None,
        nominal: None,
        start: None,
        derivative: None,
        reinit: None,
    };
    FmiModelDescription {
        fmi_version: FmiVersion::V3_0,
        model_name: "Spring".into(),
        instantiation_token: "{1-2}".into(),
        description: "force".into(),
        version: "0.1.0".into(),
        license: "MIT".into(),
        generation_tool: "a test".into(),
        variable_naming_convention: VariableNamingConvention::Flat,
        model_exchange: ModelExchange {
            model_identifier: "Spring".into(),
            can_be_instantiated_only_once_per_process: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: false,
            provides_directional_derivatives: true,
            provides_adjoint_derivatives: true,
            needs_completed_integrator_step: true,
        },
        co_simulation: CoSimulation {
            model_identifier: "Spring".into(),
            can_be_instantiated_only_once_per_process: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivatives: true,
            provides_adjoint_derivatives: true,
            can_handle_variable_communication_step_size: true,
            max_output_derivative_order: 1,
            provides_intermediate_update: true,
            might_return_early_from_do_step: true,
            can_return_early_after_intermediate_update: false,
            has_event_mode: true,
        },
        unit_definitions: UnitDefinitions {
            units: vec![Unit {
                name: "N".into(),
                base_unit: BaseUnit { kg: 1, m: 1, s: -2, rad: 0 },
                display_units: vec![],
            }],
        },
        type_definitions: TypeDefinitions {
            enumeration_types: vec![EnumerationType {
                name: "Branch".into(),
                description: "part of the curve".into(),
                items: vec![Item { name: "elastic".into(), value: 1 }],
            }],
        },
        log_categories: LogCategories {
            categories: vec![Category { name: "logEvents".into(), description: "changes of branch".into() }],
        },
        default_experiment: DefaultExperiment { start_time: 0.0, stop_time: 2.5, tolerance: 1e-9, step_size: 1e-5 },
        model_variables: ModelVariables {
            variables: vec![
                Variable::Float64(Float64 {
                    intermediate_update: Some(true),
                    unit: Some("N".into()),
                    display_unit: Some("kN".into()),
                    min: Some(-1e20),
                    max: Some(1e20),
                    nominal: Some(0.25),
                    start: Some(0.0),
                    ..float(common("force", 0, Causality::Input, Variability::Continuous, None))
                }),
                Variable::Int32(Int32 {
                    common: common("cycles", 1, Causality::Local, Variability::Discrete, calculated),
                    min: Some(0),
                }),
                Variable::Boolean(Boolean {
                    common: common("soft", 2, Causality::Parameter, Variability::Fixed, exact),
                    start: Some(true),
                }),
                Variable::String(Text {
                    common: common("history", 3, Causality::Parameter, Variability::Fixed, exact),
                    start: Some(Start { value: "a & b.csv".into() }),
                }),
                Variable::Enumeration(Enumeration {
                    common: common("branch", 4, Causality::Output, Variability::Discrete, calculated),
                    declared_type: "Branch".into(),
                    start: None,
                }),
                Variable::Float64(float(common("time", 5, Causality::Independent, Variability::Continuous, None))),
                Variable::Float64(Float64 {
                    reinit: Some(true),
                    ..float(common("x", 6, Causality::Local, Variability::Continuous, calculated))
                }),
                Variable::Float64(Float64 {
                    derivative: Some(6),
                    ..float(common("der(x)", 7, Causality::Local, Variability::Continuous, calculated))
                }),
            ],
        },
        model_structure: ModelStructure {
            outputs: vec![Unknown { value_reference: 4, dependencies: vec![], dependencies_kind: vec![] }],
            continuous_state_derivatives: vec![Unknown {
                value_reference: 7,
                dependencies: vec![0],
                dependencies_kind: vec![DependenciesKind::Dependent],
            }],
            initial_unknowns: vec![Unknown {
                value_reference: 4,
                dependencies: vec![0, 2],
                dependencies_kind: vec![DependenciesKind::Dependent; 2],
            }],
            event_indicators: vec![Unknown { value_reference: 6, dependencies: vec![], dependencies_kind: vec![] }],
        },
    }
}

const SPRING: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="Spring" instantiationToken="{1-2}" description="force" version="0.1.0" license="MIT" generationTool="a test" variableNamingConvention="flat">
  <ModelExchange modelIdentifier="Spring" canBeInstantiatedOnlyOncePerProcess="false" canGetAndSetFMUState="true" canSerializeFMUState="false" providesDirectionalDerivatives="true" providesAdjointDerivatives="true" needsCompletedIntegratorStep="true"/>
  <CoSimulation modelIdentifier="Spring" canBeInstantiatedOnlyOncePerProcess="false" canGetAndSetFMUState="true" canSerializeFMUState="true" providesDirectionalDerivatives="true" providesAdjointDerivatives="true" canHandleVariableCommunicationStepSize="true" maxOutputDerivativeOrder="1" providesIntermediateUpdate="true" mightReturnEarlyFromDoStep="true" canReturnEarlyAfterIntermediateUpdate="false" hasEventMode="true"/>
  <UnitDefinitions>
    <Unit name="N">
      <BaseUnit kg="1" m="1" s="-2"/>
    </Unit>
  </UnitDefinitions>
  <TypeDefinitions>
    <EnumerationType name="Branch" description="part of the curve">
      <Item name="elastic" value="1"/>
    </EnumerationType>
  </TypeDefinitions>
  <LogCategories>
    <Category name="logEvents" description="changes of branch"/>
  </LogCategories>
  <DefaultExperiment startTime="0.0" stopTime="2.5" tolerance="1e-9" stepSize="1e-5"/>
  <ModelVariables>
    <Float64 name="force" valueReference="0" description="a &lt; b" causality="input" variability="continuous" intermediateUpdate="true" unit="N" displayUnit="kN" min="-1e20" max="1e20" nominal="0.25" start="0.0"/>
    <Int32 name="cycles" valueReference="1" description="a &lt; b" causality="local" variability="discrete" initial="calculated" min="0"/>
    <Boolean name="soft" valueReference="2" description="a &lt; b" causality="parameter" variability="fixed" initial="exact" start="true"/>
    <String name="history" valueReference="3" description="a &lt; b" causality="parameter" variability="fixed" initial="exact">
      <Start value="a &amp; b.csv"/>
    </String>
    <Enumeration name="branch" valueReference="4" description="a &lt; b" causality="output" variability="discrete" initial="calculated" declaredType="Branch"/>
    <Float64 name="time" valueReference="5" description="a &lt; b" causality="independent" variability="continuous"/>
    <Float64 name="x" valueReference="6" description="a &lt; b" causality="local" variability="continuous" initial="calculated" reinit="true"/>
    <Float64 name="der(x)" valueReference="7" description="a &lt; b" causality="local" variability="continuous" initial="calculated" derivative="6"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="4" dependencies="" dependenciesKind=""/>
    <ContinuousStateDerivative valueReference="7" dependencies="0" dependenciesKind="dependent"/>
    <InitialUnknown valueReference="4" dependencies="0 2" dependenciesKind="dependent dependent"/>
    <EventIndicator valueReference="6" dependencies="" dependenciesKind=""/>
  </ModelStructure>
</fmiModelDescription>
"#;

const TERMINALS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiTerminalsAndIcons fmiVersion="3.0">
  <Terminals>
    <Terminal name="end" matchingRule="bus" description="where it is held">
      <TerminalMemberVariable variableName="F_1" memberName="F" variableKind="signal"/>
    </Terminal>
  </Terminals>
</fmiTerminalsAndIcons>
"#;

#[test]
fn the_xml_has_the_elements_and_attributes_of_the_standard_in_its_order() {
    assert_eq!(spring().to_xml().unwrap(), SPRING);
    let member = TerminalMemberVariable {
        variable_name: "F_1".into(),
        member_name: "F".into(),
        variable_kind: VariableKind::Signal,
    };
    let end = Terminal {
        name: "end".into(),
        matching_rule: MatchingRule::Bus,
        description: "where it is held".into(),
        members: vec![member],
    };
    let terminals = Terminals { terminals: vec![end] };
    assert_eq!(FmiTerminalsAndIcons { fmi_version: FmiVersion::V3_0, terminals }.to_xml().unwrap(), TERMINALS);
}
