//! `terminalsAndIcons/terminalsAndIcons.xml`: where the structure meets what is beneath it and above it.

use model_description::List;
use model_description::fmi3::{BUS, FmiTerminalsAndIcons, SIGNAL, Terminal, TerminalMemberVariable};

/// Name, what it is, and its variables.
const TERMINALS: [(&str, &str, &[&str]); 2] = [
    (
        "base",
        "what the ground does and what it feels: accelerations, forces, moment, impulses of the impacts",
        &["a_g", "a_v", "R_h", "R_v", "R_m", "I_h", "I_v", "I_m"],
    ),
    ("top", "a force on the top mass, and how this moves", &["F_t", "delta_t", "v_t"]),
];

/// The terminals.
pub fn terminals() -> FmiTerminalsAndIcons {
    let member = |name: &&str| TerminalMemberVariable {
        variable_name: (*name).into(),
        member_name: (*name).into(),
        variable_kind: SIGNAL,
    };
    let terminal = |(name, description, members): (&str, &str, &[&str])| Terminal {
        name: name.into(),
        matching_rule: BUS,
        description: description.into(),
        members: members.iter().map(member).collect(),
    };
    FmiTerminalsAndIcons { fmi_version: "3.0", terminals: List { items: TERMINALS.map(terminal).into() } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::variables::{Causality, VARIABLES};

    #[test]
    fn the_inputs_are_in_the_terminals_and_outputs_with_them() {
        let members: Vec<_> = TERMINALS.iter().flat_map(|(_, _, members)| *members).collect();
        let of = |causality| VARIABLES.iter().filter(move |variable| variable.causality == causality).map(|of| of.name);
        assert!(of(Causality::Input).all(|input| members.contains(&&input)));
        let is_known = |name: &&&str| of(Causality::Input).chain(of(Causality::Output)).any(|known| known == **name);
        assert!(members.iter().all(is_known));
    }
}
