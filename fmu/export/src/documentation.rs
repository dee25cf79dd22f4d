//! `documentation/index.html`: one screen about the FMU.

use crate::Version;
use crate::library::Library;
use crate::model_description::DESCRIPTION;
use FlexibleRocking::resources::Contents;

const TEMPLATE: &str = include_str!("../resources/index.html");
const ICON: &str = include_str!("../resources/model.svg");

pub fn documentation(version: Version, name: &str, contents: &Contents, libraries: &[&Library]) -> String {
    let of = &contents.structure;
    let structure = match of.one() {
        Some(_) => "A top mass stands on an elastic strut".to_owned(),
        None => format!("A building of {} floors vibrates in {} modes", of.floors().len(), of.modes().len()),
    };
    let record = escaped(contents.default_record());
    let (record, start_values) = if record.is_empty() {
        (
            "No record is inside.".to_owned(),
            r#"{"record": "/data/RSN77_SFERN_PUL164.AT2", "record_time_scale": 0.2, "record_scale": 1.45, "peaks": True}"#,
        )
    } else {
        (format!("The record <code>{record}</code> is inside and shakes the structure."), r#"{"peaks": True}"#)
    };
    let platforms: Vec<_> = libraries.iter().map(|library| library.platform.folder(version)).collect();
    let fillings = [
        ("{icon}", ICON),
        ("{name}", name),
        ("{version}", env!("CARGO_PKG_VERSION")),
        ("{description}", DESCRIPTION),
        ("{fmi}", if version == Version::Fmi2 { "2" } else { "3" }),
        ("{platforms}", &platforms.join(", ")),
        ("{guid}", &FlexibleRocking::guid(contents)),
        ("{structure}", &structure),
        ("{start_values}", start_values),
        ("{record}", &record), // last, because a file may have any name
    ];
    fillings.iter().fold(TEMPLATE.to_owned(), |page, (place, text)| page.replace(place, text))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::resources::PackedRecord;
    use rocking::{Parameters, Structure};

    #[test]
    fn the_page_names_the_record_and_leaves_no_place_open() {
        let mut contents = Contents::from(Structure::new(Parameters::EVISON).unwrap());
        let page = documentation(Version::Fmi2, "Pier", &contents, &[]);
        assert!(page.contains("<h1>Pier</h1>") && page.contains("No record is inside."), "{page}");
        contents.records.push(PackedRecord { file: "a<b & {name}.csv".into(), digest: String::new() });
        let page = documentation(Version::Fmi3, "Pier", &contents, &[]);
        assert!(page.contains("<code>a&lt;b &amp; {name}.csv</code>") && page.contains("FMI 3.0"), "{page}");
    }
}
