//! Units of acceleration, and how files write them.

use serde::Deserialize;
use std::fmt;

/// Unit of the accelerations of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Unit {
    /// Multiples of the acceleration of gravity, as an AT2 file always has them.
    #[serde(rename = "g")]
    G,
    /// m/s².
    #[serde(rename = "m/s2")]
    MetrePerSecondSquared,
    /// cm/s², which is also called gal.
    #[serde(rename = "cm/s2", alias = "gal")]
    CentimetrePerSecondSquared,
    /// mm/s².
    #[serde(rename = "mm/s2")]
    MillimetrePerSecondSquared,
}

impl Unit {
    /// Every name by which a unit can be asked for.
    pub const NAMES: [(&str, Unit); 5] = [
        ("g", Unit::G),
        ("m/s2", Unit::MetrePerSecondSquared),
        ("cm/s2", Unit::CentimetrePerSecondSquared),
        ("gal", Unit::CentimetrePerSecondSquared),
        ("mm/s2", Unit::MillimetrePerSecondSquared),
    ];

    /// The unit in m/s², where `g` (m/s²) is what a record's g stands for.
    pub fn in_m_s2(self, g: f64) -> f64 {
        match self {
            Unit::G => g,
            Unit::MetrePerSecondSquared => 1.0,
            Unit::CentimetrePerSecondSquared => 1e-2,
            Unit::MillimetrePerSecondSquared => 1e-3,
        }
    }

    /// The unit that `text` is, as files write it: `cm/s^2`, `cm/sec/sec`, `CM S-2`, `gal`, `g`.
    pub(super) fn named(text: &str) -> Option<Unit> {
        let text = plain(text).replace("sec", "s");
        let length = match text.as_str() {
            "g" | "g's" => return Some(Unit::G),
            "gal" | "gals" => return Some(Unit::CentimetrePerSecondSquared),
            text => text.strip_suffix("/s2").or(text.strip_suffix("/s/s")).or(text.strip_suffix("/ss")),
        };
        let length = length.or(text.strip_suffix("s-2")).or(text.strip_suffix("ps2")).or(text.strip_suffix("s2"));
        match length? {
            "m" => Some(Unit::MetrePerSecondSquared),
            "cm" => Some(Unit::CentimetrePerSecondSquared),
            "mm" => Some(Unit::MillimetrePerSecondSquared),
            _ => None,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let name = Unit::NAMES.iter().find(|(_, unit)| unit == self).map(|(name, _)| *name);
        out.write_str(name.unwrap_or_default())
    }
}

/// What the heading of a column of times says of their unit, in s; nothing if it says none that is known.
pub(super) fn seconds(text: &str) -> Option<f64> {
    match plain(text).as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" => Some(1.0),
        "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => Some(1e-3),
        _ => None,
    }
}

/// Small letters, with powers as plain digits and without what units may have between them.
fn plain(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_whitespace() && !"^*.()_\u{b7}\u{22c5}".contains(*letter));
    let plain = plain.map(|letter| match letter {
        '\u{b2}' => '2',
        '\u{207b}' | '\u{2212}' => '-',
        letter => letter,
    });
    plain.flat_map(char::to_lowercase).collect()
}

/// All that stands in brackets in `heading`.
pub(super) fn bracketed(heading: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = heading;
    while let Some(open) = rest.find(['(', '[', '{']) {
        let inner = &rest[open + 1..];
        let close = match rest.as_bytes()[open] {
            b'(' => ')',
            b'[' => ']',
            _ => '}',
        };
        let Some(end) = inner.find(close) else { break };
        found.push(inner[..end].trim());
        rest = &inner[end + 1..];
    }
    found
}

/// Whether `text`, which is no unit that is known here, is meant as one, and not as a remark.
pub(super) fn is_like_a_unit(text: &str) -> bool {
    const OTHERS: [&str; 9] = ["mg", "ug", "%g", "counts", "count", "v", "mv", "volts", "milli-g"];
    let text = text.to_lowercase();
    text.contains(['/', '^', '%']) || OTHERS.contains(&text.as_str())
}

/// What a heading says of the unit of its column.
#[derive(Debug, PartialEq)]
pub(super) enum Stated {
    Nothing,
    Unit(Unit),
    /// A unit of something else, or one that is not known here.
    Other(String),
}

impl Stated {
    /// The unit that the `heading` of a column of accelerations states: in brackets, after the last blank or comma, or
    /// after the last underscore. `a_g` is the ground acceleration, whatever its unit.
    pub(super) fn of(heading: &str) -> Stated {
        let brackets = bracketed(heading);
        if let Some(unit) = brackets.iter().find_map(|text| Unit::named(text)) {
            return Stated::Unit(unit);
        }
        if let Some(other) = brackets.iter().find(|text| !text.is_empty()) {
            return Stated::Other((*other).to_owned());
        }
        let heading = heading.trim();
        if let Some(unit) = Unit::named(heading) {
            return Stated::Unit(unit);
        }
        let after_blank = heading.split_once(char::is_whitespace).and_then(|(_, unit)| {
            let last = unit.rsplit([' ', '\t', ',', ':', '=']).next();
            Unit::named(unit).or(last.and_then(Unit::named))
        });
        let after_underscore = heading.char_indices().filter(|(_, letter)| *letter == '_').find_map(|(index, _)| {
            let (name, unit) = (&heading[..index], &heading[index + 1..]);
            if name.eq_ignore_ascii_case("a") { None } else { Unit::named(unit) }
        });
        after_blank.or(after_underscore).map_or(Stated::Nothing, Stated::Unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_decides_its_unit() {
        let [g, m, cm, mm] =
            [Unit::G, Unit::MetrePerSecondSquared, Unit::CentimetrePerSecondSquared, Unit::MillimetrePerSecondSquared];
        for (heading, unit) in [
            ("a_g[g]", g),
            ("acc (G)", g),
            ("acceleration g", g),
            ("acc_g", g),
            ("Acceleration, g", g),
            ("a_g[m/s2]", m),
            ("ACC (m/s^2)", m),
            ("a [m s\u{207b}\u{b2}]", m),
            ("a (m/sec/sec)", m),
            ("acc_m_s2", m),
            ("acc (cm/s2)", cm),
            ("gal", cm),
            ("N-S(gal)", cm),
            ("acc, cm/sec^2", cm),
            ("acc_cms2", cm),
            ("{cm/s\u{b2}}", cm),
            ("a (filtered) [mm/s2]", mm),
            ("a mm/s/s", mm),
        ] {
            assert_eq!(Stated::of(heading), Stated::Unit(unit), "{heading}");
        }
        for nothing in ["a_g", "acc", "acceleration", "ground motion", "", "a_G", "ag", "EW"] {
            assert_eq!(Stated::of(nothing), Stated::Nothing, "{nothing}");
        }
        for other in ["cm/s", "counts", "ft/s2", "mg", "in/s2", "%g"] {
            assert_eq!(Stated::of(&format!("acc ({other})")), Stated::Other(other.into()));
        }
    }

    #[test]
    fn every_name_is_read_back() {
        for (name, unit) in Unit::NAMES {
            assert_eq!(Unit::named(name), Some(unit));
            assert_eq!(Unit::named(&unit.to_string()), Some(unit));
        }
        assert_eq!([Unit::G, Unit::CentimetrePerSecondSquared].map(|unit| unit.in_m_s2(9.81)), [9.81, 0.01]);
    }
}
