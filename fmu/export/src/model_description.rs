//! `modelDescription.xml`, from the table of variables.

use crate::{Version, units};
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::Table;
use fmi_unit::Variable;
use model_description::{DefaultExperiment, Description};

/// The model in one line.
pub const DESCRIPTION: &str = "A flexible structure that rocks on its foundation under earthquake ground motion";

/// The content of the log category of events, in one line.
pub const EVENTS: &str = "uplift, impact, landing and overturning, as they happen";

/// The text of the description of the FMU `name` with these `contents`.
pub fn xml(version: Version, name: &str, contents: &Contents, default_experiment: DefaultExperiment) -> String {
    let (structure, variables) = (&contents.structure, Table::new(contents).variables);
    let variables: Vec<_> = variables
        .iter()
        .map(|variable| Variable {
            display_unit: units::display_unit(variable, structure).map(Into::into),
            nominal: units::nominal(variable, structure),
            ..variable.clone()
        })
        .collect();
    let description = Description {
        name,
        token: FlexibleRocking::guid(contents),
        description: DESCRIPTION,
        version: env!("CARGO_PKG_VERSION"),
        license: env!("CARGO_PKG_LICENSE"),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")),
        events: EVENTS,
        has_slopes: true,
        units: units::definitions(structure),
        variables: &variables,
        default_experiment,
    };
    description.to_xml(version)
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::resources::PackedRecord;
    use rocking::{Parameters, Structure};

    fn one_mass(parameters: Parameters) -> Contents {
        Contents::from(Structure::new(parameters).unwrap())
    }

    fn described(version: Version, contents: &Contents) -> String {
        let experiment = DefaultExperiment { start_time: 0.0, stop_time: 4.0, tolerance: 1e-9, step_size: 0.005 };
        xml(version, "Pier", contents, experiment)
    }

    /// The description repeats what the table says a variable depends on. Once the simulation goes on, these are the states. The
    /// dependencies at the start are the variables that give the states; FMI 3.0 adds parameters and time.
    #[test]
    fn the_structure_points_at_what_the_table_names() {
        let contents = one_mass(Parameters::MCMANUS);
        let variables = Table::new(&contents).variables;
        let dependencies = |version, element: &str, of: &str| {
            let attribute = if version == Version::Fmi2 { "index" } else { "valueReference" };
            let at = fmi_unit::variables::position(&variables, of) + 1;
            let xml = described(version, &contents);
            let list = xml.split(&format!("<{element}")).skip(1).find_map(|rest| {
                rest.split(&format!("{attribute}=\"{at}\" dependencies=\"")).nth(1)?.split('"').next()
            });
            let name = |place: &str| variables[place.parse::<usize>().unwrap() - 1].name.clone();
            list.unwrap().split_whitespace().map(name).collect::<Vec<_>>().join(" ")
        };
        let of_2 = |element, of| dependencies(Version::Fmi2, element, of);
        assert_eq!(of_2("Outputs", "a_t"), "a_g F_t a_v theta u theta_dot u_dot");
        assert_eq!((of_2("Outputs", "delta_t"), of_2("Outputs", "I_v")), ("theta u".into(), String::new()));
        assert_eq!((of_2("Outputs", "theta"), of_2("InitialUnknowns", "theta")), ("theta".into(), "theta_0".into()));
        assert_eq!(of_2("Derivatives", "der(u)"), "u_dot");
        assert_eq!(of_2("InitialUnknowns", "p_l"), "m m0 H B J0 g");
        assert_eq!(of_2("InitialUnknowns", "delta_t"), "H B theta_0 u_0");
        let of_3 = |element, of| dependencies(Version::Fmi3, element, of);
        assert_eq!(of_3("Output", "delta_t"), "theta u H B");
        assert_eq!(
            of_3("ContinuousStateDerivative", "der(u_dot)"),
            "a_g F_t a_v theta u theta_dot u_dot m m0 H B J0 f_fc zeta_fc c_ratio g P_0 k_t xi_d c_d k_d F_y detail record \
             record_v record_scale record_time_scale record_start time"
        );
        assert_eq!(of_3("EventIndicator", "overturning_indicator"), "theta theta_dot B xi_d k_d F_y");
    }

    #[test]
    fn start_values_are_those_of_the_structure() {
        let record = PackedRecord { file: "pulse & rest.csv".into(), digest: "any".into() };
        let contents = Contents { records: vec![record], ..one_mass(Parameters::EVISON) };
        let xml = described(Version::Fmi2, &contents);
        for element in [
            r#"name="a_g" valueReference="0" description="horizontal ground acceleration, positive to the right" causality="input" variability="continuous">
      <Real unit="m/s2" displayUnit="g" min="-10000.0" max="10000.0" nominal="3.59" start="0.0"/>"#,
            r#"description="natural frequency in full contact (fixed base)" causality="parameter" variability="fixed" initial="exact">
      <Real unit="Hz" min="0.001" max="10000.0" start="11.0"/>"#,
            r#"description="damping ratio in full contact" causality="parameter" variability="fixed" initial="exact">
      <Real min="0.0" max="0.99" start="0.015"/>"#,
            r#"description="modal participation of rocking" causality="calculatedParameter" variability="fixed" initial="calculated">
      <Real/>"#,
            r#"description="phase of the motion" causality="local" variability="discrete" initial="calculated">
      <Enumeration declaredType="Phase"/>"#,
            r#"<Item name="rocking left" value="2"/>"#,
            r#"<String start="pulse &amp; rest.csv"/>"#,
            r#"description="true computes the largest magnitudes theta_max, u_max, ... and their instants" causality="parameter" variability="fixed" initial="exact">
      <Boolean start="false"/>"#,
            r#"also between communication points, without the fall if the structure overturns; NaN unless peaks is true" causality="local" variability="continuous" initial="calculated">
      <Real unit="rad" displayUnit="deg" nominal="0.351"/>"#,
            r#"<BaseUnit kg="1" m="1" s="-2"/>"#,
            r#"<Category name="logEvents" description="uplift, impact, landing and overturning, as they happen"/>"#,
            r#"modelName="Pier" guid"#,
            r#"<CoSimulation modelIdentifier="Pier" "#,
            r#"<DefaultExperiment startTime="0.0" stopTime="4.0" tolerance="1e-9" stepSize="0.005"/>"#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
        let xml = described(Version::Fmi3, &contents);
        for element in [
            r#"causality="input" variability="continuous" intermediateUpdate="true" unit="m/s2" displayUnit="g" min="-10000.0" max="10000.0""#,
            r#"causality="output" variability="discrete" initial="calculated" unit="N.s""#,
            r#"causality="parameter" variability="fixed" initial="exact" declaredType="Detail" start="1"/>"#,
            r#"      <Start value="pulse &amp; rest.csv"/>"#,
            r#"derivative="4""#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
    }
}
