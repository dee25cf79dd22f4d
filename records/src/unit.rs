//! Units of acceleration, and how files write them.

use serde::Deserialize;
use std::{fmt, iter};

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
    /// in/s², 0.0254 m/s².
    #[serde(rename = "in/s2")]
    InchPerSecondSquared,
    /// ft/s², 0.3048 m/s².
    #[serde(rename = "ft/s2")]
    FootPerSecondSquared,
    /// Thousandths of g.
    #[serde(rename = "mg")]
    MilliG,
    /// Hundredths of g.
    #[serde(rename = "%g")]
    PercentG,
}

impl Unit {
    /// Every name by which a unit can be asked for.
    pub const NAMES: [(&str, Unit); 9] = [
        ("g", Unit::G),
        ("m/s2", Unit::MetrePerSecondSquared),
        ("cm/s2", Unit::CentimetrePerSecondSquared),
        ("gal", Unit::CentimetrePerSecondSquared),
        ("mm/s2", Unit::MillimetrePerSecondSquared),
        ("in/s2", Unit::InchPerSecondSquared),
        ("ft/s2", Unit::FootPerSecondSquared),
        ("mg", Unit::MilliG),
        ("%g", Unit::PercentG),
    ];

    /// The unit in m/s². A record's g means `g` (m/s²).
    pub fn in_m_s2(self, g: f64) -> f64 {
        match self {
            Unit::G => g,
            Unit::MetrePerSecondSquared => 1.0,
            Unit::CentimetrePerSecondSquared => 1e-2,
            Unit::MillimetrePerSecondSquared => 1e-3,
            Unit::InchPerSecondSquared => 0.0254,
            Unit::FootPerSecondSquared => 0.3048,
            Unit::MilliG => g / 1e3,
            Unit::PercentG => g / 1e2,
        }
    }

    /// The unit that `text` is, as files write it: `cm/s^2`, `cm/sec/sec`, `CM S-2`, `gal`, `g`.
    pub(super) fn named(text: &str) -> Option<Unit> {
        let text = plain(text).replace("sec", "s");
        let length = match text.as_str() {
            "g" | "g's" => return Some(Unit::G),
            "gal" | "gals" => return Some(Unit::CentimetrePerSecondSquared),
            "mg" | "milli-g" | "millig" => return Some(Unit::MilliG),
            "%g" => return Some(Unit::PercentG),
            text => text.strip_suffix("/s2").or(text.strip_suffix("/s/s")).or(text.strip_suffix("/ss")),
        };
        let length = length.or(text.strip_suffix("s-2")).or(text.strip_suffix("ps2")).or(text.strip_suffix("s2"));
        match length? {
            "m" => Some(Unit::MetrePerSecondSquared),
            "cm" => Some(Unit::CentimetrePerSecondSquared),
            "mm" => Some(Unit::MillimetrePerSecondSquared),
            "in" | "inch" => Some(Unit::InchPerSecondSquared),
            "ft" | "feet" => Some(Unit::FootPerSecondSquared),
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

/// Unit of times that the heading of a column states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum TimeUnit {
    Unstated,
    Second,
    Millisecond,
}

impl TimeUnit {
    /// The unit that the `heading` of a column of times states: of `time`, `t`, these with a unit, and of a heading that is a
    /// unit or ends with one in brackets. None of any other heading, of a period, and of times with a factor.
    pub(super) fn of(heading: &str) -> Option<TimeUnit> {
        let heading = heading.to_lowercase();
        let words = heading.split(|letter: char| !letter.is_alphanumeric());
        let words: Vec<_> = words.filter(|word| !word.is_empty() && *word != "in").collect();
        match words.as_slice() {
            _ if heading.contains("period") || has_factor(&heading) => None,
            ["t" | "time" | "times" | "zeit"] => Some(TimeUnit::Unstated),
            [unit] | ["t" | "time" | "times" | "zeit", unit] => TimeUnit::named(unit),
            [.., unit] if heading.ends_with(&format!("({unit})")) || heading.ends_with(&format!("[{unit}]")) => {
                TimeUnit::named(unit)
            }
            _ => None,
        }
    }

    pub(super) fn named(text: &str) -> Option<TimeUnit> {
        match text {
            "s" | "sec" | "secs" | "second" | "seconds" => Some(TimeUnit::Second),
            "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => Some(TimeUnit::Millisecond),
            _ => None,
        }
    }

    /// The unit in seconds; an unstated unit is the second.
    pub(super) fn in_seconds(self) -> f64 {
        if self == TimeUnit::Millisecond { 1e-3 } else { 1.0 }
    }
}

/// Small letters, with powers as plain digits and without what units may have between them.
fn plain(text: &str) -> String {
    let plain =
        text.chars().filter(|letter| !letter.is_whitespace() && !"^*.()_\u{b7}\u{22c5}\u{d7}".contains(*letter));
    let plain = plain.map(|letter| match letter {
        '\u{b2}' => '2',
        '\u{207b}' | '\u{2212}' => '-',
        letter => letter,
    });
    plain.flat_map(char::to_lowercase).collect()
}

/// Whether `text`, which is no unit that is known here, is meant as one.
fn is_like_a_unit(text: &str) -> bool {
    let text = text.to_lowercase();
    text.contains("/s")
        || text.contains(['^', '%'])
        || matches!(&*text, "counts" | "count" | "v" | "mv" | "volts" | "ug")
}

/// Whether `text`, a heading or the parts of one beside its unit, has a factor: `10^-3`, `*1000`, `x 0.1`, `/1000`.
fn has_factor(text: &str) -> bool {
    text.char_indices().any(|(start, sign)| {
        let (before, after) = (&text[..start], &text[start + sign.len_utf8()..]);
        let is_sign = match sign {
            '*' | '\u{d7}' | '\u{b7}' | '\u{22c5}' => true,
            '^' => before.ends_with(char::is_numeric),
            'x' | 'X' if before.is_empty() => after.starts_with(' '), // unlike the name x1
            'x' | 'X' => before.ends_with([' ', '\t', '(', '[', '{']),
            '/' => !before.trim_end().ends_with(char::is_numeric), // unlike a date
            _ => false,
        };
        is_sign && after.trim_start_matches([' ', '\t', '+', '-', '\u{2212}', '.']).starts_with(char::is_numeric)
    })
}

/// Words of a heading by which the accelerations are multiplied or turned round.
const FACTORS: [&str; 18] = [
    "%",
    "\u{2030}",
    "percent",
    "per",
    "mille",
    "permille",
    "tenth",
    "tenths",
    "hundredth",
    "hundredths",
    "thousandth",
    "thousandths",
    "parts",
    "scaled",
    "times",
    "multiplied",
    "divided",
    "minus",
];

/// Whether a word of `text` is one of [`FACTORS`].
fn has_factor_in_words(text: &str) -> bool {
    let text = text.to_lowercase();
    text.split(|letter: char| !letter.is_alphabetic() && !"%\u{2030}".contains(letter))
        .any(|word| FACTORS.contains(&word))
}

/// Whether `word` is a number, or a factor such as `10^-3`, `10-3`, `x0.1`.
fn is_factor(word: &str) -> bool {
    let begins = word.trim_start_matches(['x', 'X', '+', '-', '.']).starts_with(char::is_numeric);
    begins && word.chars().all(|letter| !letter.is_alphabetic() || "eEdDxX".contains(letter))
}

/// Whether `line` has a unit of accelerations as a word anywhere.
pub(super) fn mentions_unit(line: &str) -> bool {
    let words = line.split(|letter: char| letter.is_whitespace() || ",;:=()[]{}\"".contains(letter));
    words.filter(|word| !word.is_empty()).any(|word| {
        let unit = word.trim_start_matches(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
        Unit::named(unit).is_some() || word.rsplit('/').next().is_some_and(|last| Unit::named(last).is_some())
    })
}

/// Whether `text`, one of the parts of a heading beside its unit, has a second unit that is not the unit of a number.
fn has_second_unit(text: &str) -> bool {
    let words: Vec<&str> = text.split_whitespace().collect();
    let is_of_a_number = |index: usize| index > 0 && is_factor(words[index - 1]);
    words.iter().enumerate().any(|(index, word)| mentions_unit(word) && !is_of_a_number(index))
}

/// Unit of a column, as the heading states it.
#[derive(Debug, PartialEq)]
pub(super) enum Stated {
    Nothing,
    Unit(Unit),
    /// A unit of something else or one that is not known here; or all of a heading with a known unit in an unclear place.
    Other(String),
    /// The accelerations are multiplied by a factor: this heading has one.
    Multiplied(String),
}

impl Stated {
    /// The unit that `heading` states: the heading of a column of accelerations, or a line of text before samples alone. The
    /// unit stands after a blank, a slash, an underscore or the like, up to the end or the next bracket. `a_g` is the ground acceleration, whatever its
    /// unit. A unit after a number is the unit of that number.
    pub(super) fn of(heading: &str) -> Stated {
        const DIVIDERS: &[char] = &[' ', '\t', ',', ':', '=', '/', '_', '(', '[', '{'];
        const LONGEST: usize = 200;
        if heading.len() > LONGEST {
            return Stated::Nothing;
        }
        let starts = || iter::once(0).chain(heading.match_indices(DIVIDERS).map(|(index, _)| index + 1));
        let to_bracket = |start: usize| heading[start..].split([')', ']', '}']).next().unwrap_or_default();
        let is_free = |start: &usize| {
            let mut words = heading[..*start].rsplit(DIVIDERS);
            !words.find(|word| !matches!(*word, "" | "x" | "X" | "*" | "\u{d7}")).is_some_and(is_factor)
        };
        let is_a_g = |start: usize| heading[..start].to_lowercase().ends_with("a_");
        let named = |start| {
            let unit = Unit::named(to_bracket(start)).filter(|unit| *unit != Unit::G || !is_a_g(start))?;
            Some((unit, [&heading[..start], &heading[start + to_bracket(start).len()..]]))
        };
        let found = starts().filter(is_free).find_map(named);
        let (unit, beside) = found.map_or((None, [heading, ""]), |(unit, beside)| (Some(unit), beside));
        match unit {
            _ if beside.into_iter().any(|text| has_factor(text) || has_factor_in_words(text)) => {
                return Stated::Multiplied(heading.to_owned());
            }
            Some(_) if beside.into_iter().any(has_second_unit) => return Stated::Other(heading.to_owned()),
            Some(unit) => return Stated::Unit(unit),
            None => {}
        }
        let mut words = heading.rsplit([' ', '\t', ',', '(', '[', '{', ')', ']', '}']);
        let other = words.find(|word| is_like_a_unit(word));
        let shown = |other| if mentions_unit(other) { heading } else { other };
        other.map_or(Stated::Nothing, |other| Stated::Other(shown(other).to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_decides_its_unit() {
        let [g, m, cm, mm] =
            [Unit::G, Unit::MetrePerSecondSquared, Unit::CentimetrePerSecondSquared, Unit::MillimetrePerSecondSquared];
        for (headings, unit) in [
            (&["a_g[g]", "acc (G)", "acceleration g", "acc_g", "Acceleration, g", "a/g"][..], g),
            (
                &[
                    "a_g[m/s2]",
                    "ACC (m/s^2)",
                    "a [m s\u{207b}\u{b2}]",
                    "a (m/sec/sec)",
                    "acc_m_s2",
                    "Acc. / (m/s\u{b2})",
                ],
                m,
            ),
            (&["acc (cm/s2)", "gal", "N-S(gal)", "acc, cm/sec^2", "acc_cms2", "{cm/s\u{b2}}"], cm),
            (&["a (filtered) [mm/s2]", "a mm/s/s"], mm),
            (&["a [in/sec^2]"], Unit::InchPerSecondSquared),
            (&["acc_ft/s2"], Unit::FootPerSecondSquared),
            (&["ACC (mg)"], Unit::MilliG),
            (&["acc, %g"], Unit::PercentG),
        ] {
            headings.iter().for_each(|heading| assert_eq!(Stated::of(heading), Stated::Unit(unit), "{heading}"));
        }
        for nothing in
            ["a_g", "acc", "acceleration", "ground motion", "", "a_G", "ag", "EW", "peak 0.3 g", "in g: 0.3", "# a_g"]
        {
            assert_eq!(Stated::of(nothing), Stated::Nothing, "{nothing}");
        }
        for multiplied in [
            "acc (10^-3 g)",
            "acc (10-3 g)",
            "a [10\u{207b}\u{b3} g]",
            "acc (x0.1 g)",
            "acc (1000 x g)",
            "acc*1000 (g)",
            "acc x 1000 [m/s^2]",
            "acc (g/1000)",
            "acc (g\u{b7}10^-3)",
            "acc (g) x 10",
            "acc (g x10)",
            "acc (1/1000 g)",
            "acc (1e-3 g)",
            "acc*1000",
            "acc [% of g]",
            "acc (percent of g)",
            "acc per mille g",
            "acc (thousandths of g)",
            "acc (g) scaled by 1000",
            "minus acc (g)",
        ] {
            let stated = Stated::of(multiplied);
            let is_refused =
                matches!(stated, Stated::Multiplied(_)) || stated == Stated::Nothing && mentions_unit(multiplied);
            assert!(is_refused, "{multiplied}: {stated:?}");
        }
        for (heading, unit) in
            [("CH 2, 090 deg, acc (g)", g), ("17/3/2005 north (g)", g), ("acc x [g]", g), ("S90E m*s^-2", m)]
        {
            assert_eq!(Stated::of(heading), Stated::Unit(unit), "{heading}");
        }
        let with_a_value = "ground acceleration (m/s2): a full sine of 0.5 s and 0.6 g";
        assert_eq!(Stated::of(with_a_value), Stated::Unit(Unit::MetrePerSecondSquared));
        for two in ["acc (gal, not g)", "acc (m/s^2)*g", "acc (cm/s/s) g"] {
            assert_eq!(Stated::of(two), Stated::Other(two.into()));
        }
        for other in ["cm/s", "counts", "km/s2", "nm/s^2"] {
            assert_eq!(Stated::of(&format!("acc ({other})")), Stated::Other(other.into()));
            assert_eq!(Stated::of(&format!("acc {other}")), Stated::Other(other.into()));
        }
    }

    #[test]
    fn every_name_is_read_back() {
        for (name, unit) in Unit::NAMES {
            assert_eq!(Unit::named(name), Some(unit));
            assert_eq!(Unit::named(&unit.to_string()), Some(unit));
        }
        let in_m_s2 = Unit::NAMES.map(|(_, unit)| unit.in_m_s2(9.81));
        assert_eq!(in_m_s2, [9.81, 1.0, 0.01, 0.01, 0.001, 12.0_f64.recip() * 0.3048, 0.3048, 9.81 / 1e3, 0.0981]);
    }

    #[test]
    fn a_heading_of_times_states_their_unit() {
        for (headings, unit) in [
            (&["t", "Time", "Zeit"][..], TimeUnit::Unstated),
            (&["t/s", "Zeit [s]", "time, sec"], TimeUnit::Second),
            (&["t/ms", "time_ms", "(ms)", "time in ms"], TimeUnit::Millisecond),
        ] {
            headings.iter().for_each(|heading| assert_eq!(TimeUnit::of(heading).as_ref(), Some(&unit), "{heading}"));
        }
        for other in [
            "time*1000 (s)",
            "t (x10 s)",
            "t/10 (s)",
            "time history",
            "trigger",
            "theta",
            "a (m/s2)",
            "acc",
            "",
            "T1",
            "Period (s)",
            "t (min)",
            "f (Hz)",
        ] {
            assert_eq!(TimeUnit::of(other), None, "{other}");
        }
    }
}
