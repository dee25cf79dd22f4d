//! Exact text: what a small description must look like in XML.

use super::*;

fn variable(
    name: &str,
    causality: Causality,
    variability: Variability,
    initial: Option<Initial>,
    variable_type: VariableType,
) -> ScalarVariable {
    let description = "a < b".into();
    ScalarVariable {
        name: name.into(),
        value_reference: 7,
        description,
        causality,
        variability,
        initial,
        variable_type,
    }
}

fn spring() -> FmiModelDescription {
    let (exact, calculated) = (Some(Initial::Exact), Some(Initial::Calculated));
    let angle = Real {
        unit: Some("rad".into()),
        display_unit: Some("deg".into()),
        min: Some(0.0),
        max: Some(1e20),
        nominal: Some(0.25),
        start: Some(0.1),
        ..Real::default()
    };
    let speed = Real { derivative: Some(1), reinit: Some(true), ..Real::default() };
    let branch = Enumeration { declared_type: "Branch".into(), start: None };
    let (cycles, soft) = (Integer { min: Some(0) }, Boolean { start: Some(true) });
    let history = Text { start: Some("a & b.csv".into()) };
    FmiModelDescription {
        fmi_version: FmiVersion::V2_0,
        model_name: "Spring".into(),
        guid: "{1-2}".into(),
        description: "force < \"yield\" & so on".into(),
        version: "0.1.0".into(),
        license: "MIT".into(),
        generation_tool: "a test".into(),
        variable_naming_convention: VariableNamingConvention::Flat,
        number_of_event_indicators: 3,
        model_exchange: ModelExchange {
            model_identifier: "Spring".into(),
            completed_integrator_step_not_needed: false,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: false,
            provides_directional_derivative: true,
        },
        co_simulation: CoSimulation {
            model_identifier: "Spring".into(),
            can_handle_variable_communication_step_size: true,
            can_interpolate_inputs: true,
            max_output_derivative_order: 1,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: true,
        },
        unit_definitions: UnitDefinitions {
            units: vec![
                Unit { name: "N".into(), base_unit: BaseUnit { kg: 1, m: 1, s: -2, rad: 0 }, display_units: vec![] },
                Unit {
                    name: "rad".into(),
                    base_unit: BaseUnit { rad: 1, ..BaseUnit::default() },
                    display_units: vec![
                        DisplayUnit { name: "deg".into(), factor: 57.5 },
                        DisplayUnit { name: "mrad".into(), factor: 1000.0 },
                    ],
                },
            ],
        },
        type_definitions: TypeDefinitions {
            simple_types: vec![SimpleType {
                name: "Branch".into(),
                description: "part of the curve".into(),
                attributes: TypeAttributes::Enumeration(EnumerationType {
                    items: vec![Item { name: "elastic".into(), value: 1 }, Item { name: "plastic".into(), value: 2 }],
                }),
            }],
        },
        log_categories: LogCategories {
            categories: vec![Category { name: "logEvents".into(), description: "changes of branch".into() }],
        },
        default_experiment: DefaultExperiment { start_time: 0.0, stop_time: 2.5, tolerance: 1e-9, step_size: 1e-5 },
        model_variables: ModelVariables {
            scalar_variables: vec![
                variable("angle", Causality::Input, Variability::Continuous, None, VariableType::Real(angle)),
                variable(
                    "branch",
                    Causality::Output,
                    Variability::Discrete,
                    calculated,
                    VariableType::Enumeration(branch),
                ),
                variable("cycles", Causality::Local, Variability::Discrete, calculated, VariableType::Integer(cycles)),
                variable("soft", Causality::Parameter, Variability::Fixed, exact, VariableType::Boolean(soft)),
                variable("history", Causality::Parameter, Variability::Fixed, exact, VariableType::String(history)),
                variable(
                    "speed",
                    Causality::CalculatedParameter,
                    Variability::Fixed,
                    calculated,
                    VariableType::Real(speed),
                ),
            ],
        },
        model_structure: ModelStructure {
            outputs: Outputs { unknowns: vec![Unknown { index: 2, dependencies: vec![], dependencies_kind: vec![] }] },
            derivatives: Derivatives { unknowns: vec![dependent(6, vec![1])] },
            initial_unknowns: InitialUnknowns { unknowns: vec![dependent(2, vec![1, 4])] },
        },
    }
}

fn dependent(index: usize, dependencies: Vec<usize>) -> Unknown {
    let dependencies_kind = vec![DependenciesKind::Dependent; dependencies.len()];
    Unknown { index, dependencies, dependencies_kind }
}

const SPRING: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Spring" guid="{1-2}" description="force &lt; &quot;yield&quot; &amp; so on" version="0.1.0" license="MIT" generationTool="a test" variableNamingConvention="flat" numberOfEventIndicators="3">
  <ModelExchange modelIdentifier="Spring" completedIntegratorStepNotNeeded="false" canBeInstantiatedOnlyOncePerProcess="false" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="false" providesDirectionalDerivative="true"/>
  <CoSimulation modelIdentifier="Spring" canHandleVariableCommunicationStepSize="true" canInterpolateInputs="true" maxOutputDerivativeOrder="1" canBeInstantiatedOnlyOncePerProcess="false" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true" providesDirectionalDerivative="true"/>
  <UnitDefinitions>
    <Unit name="N">
      <BaseUnit kg="1" m="1" s="-2"/>
    </Unit>
    <Unit name="rad">
      <BaseUnit rad="1"/>
      <DisplayUnit name="deg" factor="57.5"/>
      <DisplayUnit name="mrad" factor="1000.0"/>
    </Unit>
  </UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Branch" description="part of the curve">
      <Enumeration>
        <Item name="elastic" value="1"/>
        <Item name="plastic" value="2"/>
      </Enumeration>
    </SimpleType>
  </TypeDefinitions>
  <LogCategories>
    <Category name="logEvents" description="changes of branch"/>
  </LogCategories>
  <DefaultExperiment startTime="0.0" stopTime="2.5" tolerance="1e-9" stepSize="1e-5"/>
  <ModelVariables>
    <ScalarVariable name="angle" valueReference="7" description="a &lt; b" causality="input" variability="continuous">
      <Real unit="rad" displayUnit="deg" min="0.0" max="1e20" nominal="0.25" start="0.1"/>
    </ScalarVariable>
    <ScalarVariable name="branch" valueReference="7" description="a &lt; b" causality="output" variability="discrete" initial="calculated">
      <Enumeration declaredType="Branch"/>
    </ScalarVariable>
    <ScalarVariable name="cycles" valueReference="7" description="a &lt; b" causality="local" variability="discrete" initial="calculated">
      <Integer min="0"/>
    </ScalarVariable>
    <ScalarVariable name="soft" valueReference="7" description="a &lt; b" causality="parameter" variability="fixed" initial="exact">
      <Boolean start="true"/>
    </ScalarVariable>
    <ScalarVariable name="history" valueReference="7" description="a &lt; b" causality="parameter" variability="fixed" initial="exact">
      <String start="a &amp; b.csv"/>
    </ScalarVariable>
    <ScalarVariable name="speed" valueReference="7" description="a &lt; b" causality="calculatedParameter" variability="fixed" initial="calculated">
      <Real derivative="1" reinit="true"/>
    </ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs>
      <Unknown index="2" dependencies="" dependenciesKind=""/>
    </Outputs>
    <Derivatives>
      <Unknown index="6" dependencies="1" dependenciesKind="dependent"/>
    </Derivatives>
    <InitialUnknowns>
      <Unknown index="2" dependencies="1 4" dependenciesKind="dependent dependent"/>
    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"#;

#[test]
fn the_xml_has_the_elements_and_attributes_of_the_standard_in_its_order() {
    assert_eq!(spring().to_xml().unwrap(), SPRING);
}
