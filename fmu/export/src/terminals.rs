//! `terminalsAndIcons/terminalsAndIcons.xml`: where the structure meets what is beneath it and above it.

use model_description::fmi3::{
    FmiTerminalsAndIcons, FmiVersion, MatchingRule, Terminal, TerminalMemberVariable, Terminals, VariableKind,
};

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
        variable_kind: VariableKind::Signal,
    };
    let terminal = |(name, description, members): (&str, &str, &[&str])| Terminal {
        name: name.into(),
        matching_rule: MatchingRule::Bus,
        description: description.into(),
        members: members.iter().map(member).collect(),
    };
    FmiTerminalsAndIcons {
        fmi_version: FmiVersion::V3_0,
        terminals: Terminals { terminals: TERMINALS.map(terminal).into() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::variables::{Causality, VARIABLES};
    use std::collections::BTreeSet;

    /// Every input is in one of them; what is in none is an output that nothing is joined to.
    #[test]
    fn the_inputs_and_what_answers_them_are_in_the_terminals() {
        let members: Vec<_> = TERMINALS.iter().flat_map(|(_, _, members)| *members).collect();
        assert_eq!(members.iter().collect::<BTreeSet<_>>().len(), members.len());
        let named = |name: &str| VARIABLES.iter().find(|variable| variable.name == name).unwrap().causality;
        assert!(members.iter().all(|name| matches!(named(name), Causality::Input | Causality::Output)));
        let inputs = VARIABLES.iter().filter(|variable| variable.causality == Causality::Input);
        assert!(inputs.into_iter().all(|input| members.contains(&&input.name)));
    }
}
