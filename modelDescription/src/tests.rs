//! Exact text: what a small description must look like in XML.

use super::*;

fn spring() -> FmiModelDescription {
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
                ScalarVariable {
                    name: "angle".into(),
                    value_reference: 0,
                    description: "rotation".into(),
                    causality: Causality::Input,
                    variability: Variability::Continuous,
                    initial: None,
                    variable_type: VariableType::Real(Real {
                        unit: Some("rad".into()),
                        display_unit: Some("deg".into()),
                        nominal: Some(0.25),
                        start: Some(0.0),
                        ..Real::default()
                    }),
                },
                ScalarVariable {
                    name: "ratio".into(),
                    value_reference: 1,
                    description: "hardening".into(),
                    causality: Causality::Parameter,
                    variability: Variability::Fixed,
                    initial: Some(Initial::Exact),
                    variable_type: VariableType::Real(Real {
                        unit: None,
                        min: Some(0.0),
                        max: Some(1e20),
                        start: Some(0.1),
                        ..Real::default()
                    }),
                },
                ScalarVariable {
                    name: "doubled".into(),
                    value_reference: 2,
                    description: "twice the hardening".into(),
                    causality: Causality::CalculatedParameter,
                    variability: Variability::Fixed,
                    initial: Some(Initial::Calculated),
                    variable_type: VariableType::Real(Real::default()),
                },
                ScalarVariable {
                    name: "branch".into(),
                    value_reference: 0,
                    description: "where the force is".into(),
                    causality: Causality::Output,
                    variability: Variability::Discrete,
                    initial: Some(Initial::Calculated),
                    variable_type: VariableType::Enumeration(Enumeration {
                        declared_type: "Branch".into(),
                        start: None,
                    }),
                },
                ScalarVariable {
                    name: "cycles".into(),
                    value_reference: 1,
                    description: "changes of branch".into(),
                    causality: Causality::Output,
                    variability: Variability::Discrete,
                    initial: Some(Initial::Calculated),
                    variable_type: VariableType::Integer(Integer { min: Some(0) }),
                },
                ScalarVariable {
                    name: "broken".into(),
                    value_reference: 0,
                    description: "beyond repair".into(),
                    causality: Causality::Output,
                    variability: Variability::Discrete,
                    initial: Some(Initial::Calculated),
                    variable_type: VariableType::Boolean(Boolean::default()),
                },
                ScalarVariable {
                    name: "soft".into(),
                    value_reference: 1,
                    description: "whether it softens".into(),
                    causality: Causality::Parameter,
                    variability: Variability::Fixed,
                    initial: Some(Initial::Exact),
                    variable_type: VariableType::Boolean(Boolean { start: Some(true) }),
                },
                ScalarVariable {
                    name: "history".into(),
                    value_reference: 0,
                    description: "file of forces".into(),
                    causality: Causality::Parameter,
                    variability: Variability::Fixed,
                    initial: Some(Initial::Exact),
                    variable_type: VariableType::String(Text { start: Some("a & b.csv".into()) }),
                },
                ScalarVariable {
                    name: "largest".into(),
                    value_reference: 3,
                    description: "largest force".into(),
                    causality: Causality::Local,
                    variability: Variability::Continuous,
                    initial: Some(Initial::Calculated),
                    variable_type: VariableType::Real(Real {
                        derivative: Some(1),
                        reinit: Some(true),
                        ..Real::default()
                    }),
                },
            ],
        },
        model_structure: ModelStructure {
            outputs: Outputs {
                unknowns: vec![
                    Unknown { index: 4, dependencies: vec![], dependencies_kind: vec![] },
                    Unknown { index: 5, dependencies: vec![], dependencies_kind: vec![] },
                    Unknown { index: 6, dependencies: vec![], dependencies_kind: vec![] },
                ],
            },
            derivatives: Derivatives {
                unknowns: vec![Unknown {
                    index: 9,
                    dependencies: vec![1],
                    dependencies_kind: vec![DependenciesKind::Dependent],
                }],
            },
            initial_unknowns: InitialUnknowns {
                unknowns: vec![
                    Unknown { index: 3, dependencies: vec![2], dependencies_kind: vec![DependenciesKind::Dependent] },
                    Unknown {
                        index: 4,
                        dependencies: vec![1, 2],
                        dependencies_kind: vec![DependenciesKind::Dependent, DependenciesKind::Dependent],
                    },
                    Unknown { index: 5, dependencies: vec![], dependencies_kind: vec![] },
                    Unknown { index: 6, dependencies: vec![], dependencies_kind: vec![] },
                ],
            },
        },
    }
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
    <ScalarVariable name="angle" valueReference="0" description="rotation" causality="input" variability="continuous">
      <Real unit="rad" displayUnit="deg" nominal="0.25" start="0.0"/>
    </ScalarVariable>
    <ScalarVariable name="ratio" valueReference="1" description="hardening" causality="parameter" variability="fixed" initial="exact">
      <Real min="0.0" max="1e20" start="0.1"/>
    </ScalarVariable>
    <ScalarVariable name="doubled" valueReference="2" description="twice the hardening" causality="calculatedParameter" variability="fixed" initial="calculated">
      <Real/>
    </ScalarVariable>
    <ScalarVariable name="branch" valueReference="0" description="where the force is" causality="output" variability="discrete" initial="calculated">
      <Enumeration declaredType="Branch"/>
    </ScalarVariable>
    <ScalarVariable name="cycles" valueReference="1" description="changes of branch" causality="output" variability="discrete" initial="calculated">
      <Integer min="0"/>
    </ScalarVariable>
    <ScalarVariable name="broken" valueReference="0" description="beyond repair" causality="output" variability="discrete" initial="calculated">
      <Boolean/>
    </ScalarVariable>
    <ScalarVariable name="soft" valueReference="1" description="whether it softens" causality="parameter" variability="fixed" initial="exact">
      <Boolean start="true"/>
    </ScalarVariable>
    <ScalarVariable name="history" valueReference="0" description="file of forces" causality="parameter" variability="fixed" initial="exact">
      <String start="a &amp; b.csv"/>
    </ScalarVariable>
    <ScalarVariable name="largest" valueReference="3" description="largest force" causality="local" variability="continuous" initial="calculated">
      <Real derivative="1" reinit="true"/>
    </ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs>
      <Unknown index="4" dependencies="" dependenciesKind=""/>
      <Unknown index="5" dependencies="" dependenciesKind=""/>
      <Unknown index="6" dependencies="" dependenciesKind=""/>
    </Outputs>
    <Derivatives>
      <Unknown index="9" dependencies="1" dependenciesKind="dependent"/>
    </Derivatives>
    <InitialUnknowns>
      <Unknown index="3" dependencies="2" dependenciesKind="dependent"/>
      <Unknown index="4" dependencies="1 2" dependenciesKind="dependent dependent"/>
      <Unknown index="5" dependencies="" dependenciesKind=""/>
      <Unknown index="6" dependencies="" dependenciesKind=""/>
    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"#;

#[test]
fn the_xml_has_the_elements_and_attributes_of_the_standard_in_its_order() {
    assert_eq!(spring().to_xml().unwrap(), SPRING);
}
