//! A structure of one's own: options over a specimen or a file, natural quantities, the template.
#![allow(non_snake_case)] // H, B: the paper's own letters

mod command_line;

use command_line::{command, fail, folder, succeed};
use rocking::structure::natural_quantities::{NATURAL, names};
use std::{collections::BTreeMap, fs, path::Path};

/// The derived quantities that `describe` prints.
fn derived(folder: &Path, arguments: &str) -> BTreeMap<String, f64> {
    let (csv, _) = succeed(folder, &format!("describe {arguments} --format csv"));
    let row = |line: &str| {
        let mut fields = line.split(',');
        (fields.next().unwrap().to_owned(), fields.next().unwrap().parse().unwrap())
    };
    csv.lines().skip(1).map(row).collect()
}

#[test]
fn the_template_is_the_structure() {
    let folder = folder();
    for structure in ["--preset evison --c-ratio 0.5", "--preset mcmanus --m0 0 --g 1.62"] {
        let (template, talk) = succeed(folder.path(), &format!("describe {structure} --template"));
        assert!(talk.starts_with("structure      from ") && talk.lines().count() == 1, "{talk}");
        fs::write(folder.path().join("pier.toml"), &template).unwrap();
        let described = succeed(folder.path(), &format!("describe {structure}")).0;
        assert_eq!(succeed(folder.path(), "describe --parameters pier.toml").0, described);
        for name in names() {
            let has_line =
                template.lines().any(|line| line.trim_start_matches("# ").starts_with(&format!("{name} = ")));
            assert!(has_line, "{name}\n{template}");
        }
    }
}

/// Each commented line of the template, in the place of the one above it, is the same structure.
#[test]
fn a_natural_quantity_of_the_template_may_take_the_place_of_its_parameter() {
    let folder = folder();
    let (template, _) = succeed(folder.path(), "describe --template");
    let expected = derived(folder.path(), "");
    for natural in &NATURAL {
        let changed = template.lines().map(|line| {
            if line.starts_with(&format!("{} = ", natural.stands_for)) {
                format!("# {line}")
            } else if line.starts_with(&format!("# {} = ", natural.name)) {
                line[2..].to_owned()
            } else {
                line.to_owned()
            }
        });
        let changed = changed.collect::<Vec<_>>().join("\n");
        assert_ne!(changed, template.trim_end());
        fs::write(folder.path().join("natural.toml"), changed).unwrap();
        let found = derived(folder.path(), "--parameters natural.toml");
        for (name, value) in &expected {
            assert!((found[name] - value).abs() <= 1e-12 * value.abs(), "{}: {name}: {}", natural.name, found[name]);
        }
    }
}

/// Weight in kN, width, slenderness and period, checked by hand: m = W/g, B = width/2, H = B/tan(alpha) without a
/// foundation mass, k = m (2 pi/T)².
#[test]
fn natural_quantities_over_a_preset_or_a_file() {
    let folder = folder();
    let options = "--preset mcmanus --weight 500 --weight0 0 --width 3 --alpha-cg 0.25 --period-fc 0.4 --J0 0";
    let found = derived(folder.path(), options);
    let (m, B) = (500e3 / 9.81, 1.5);
    let H = B / f64::tan(0.25);
    for (name, expected) in [
        ("k", m * (std::f64::consts::TAU / 0.4).powi(2)),
        ("J_P", m * (H * H + B * B)),
        ("p_l", (9.81 * H / (H * H + B * B)).sqrt()),
        ("weight", 500.0),
        ("width", 3.0),
        ("alpha_cg", 0.25),
        ("period_fc", 0.4),
    ] {
        assert!((found[name] - expected).abs() <= 1e-12 * expected, "{name}: {} {expected}", found[name]);
    }
    let file = "weight = 500\nm0 = 0\nwidth = 3\nalpha_cg = 0.25\nperiod_fc = 0.1\nzeta_fc = 0.02\nr = 0.99\n";
    fs::write(folder.path().join("pier.toml"), file).unwrap();
    assert_eq!(derived(folder.path(), "--parameters pier.toml --period-fc 0.4"), found);
}

#[test]
fn every_command_and_the_archive_take_the_numbers() {
    let folder = folder();
    let stiff = "--preset evison --f-fc 30 --r 0.9 --width 0.4";
    let written = "m = 125.8\nm0 = 44.02\nH = 1.05\nB = 0.2\nf_fc = 30\nzeta_fc = 0.015\nr = 0.9\n";
    fs::write(folder.path().join("stiff.toml"), written).unwrap();
    for arguments in [
        "describe",
        "estimate --record pulse.AT2",
        "pushover -o -",
        "advise --record pulse.AT2",
        "simulate --record pulse.AT2 -o -",
    ] {
        let of = |structure: &str| {
            let (printed, said) = succeed(folder.path(), &format!("{arguments} {structure}"));
            let said: Vec<_> = said.lines().filter(|line| !line.starts_with("structure ")).map(str::to_owned).collect();
            (printed, said)
        };
        assert_eq!(of(stiff), of("--parameters stiff.toml"), "{arguments}");
        assert_ne!(of(stiff).0, of("--preset evison").0, "{arguments}");
    }
    let (_, said) = succeed(folder.path(), &format!("export {stiff} -o stiff.fmu"));
    assert!(said.contains("structure  m = 125.8 kg, m0 = 44.02 kg, H = 1.05 m, B = 0.2 m, "), "{said}");
    assert!(said.contains("f_fc = 30 Hz") && said.contains("r = 0.9"), "{said}");
}

/// A bridge pier whose J0, r and damping nobody gave did run with those of the laboratory specimen.
#[test]
fn numbers_alone_are_a_structure_or_lack_what_is_named() {
    let folder = folder();
    let pier = "--H 30 --width 9 --weight 12000 --weight0 6000 --period-fc 1.0";
    for command in ["describe", "simulate --record pulse.AT2", "estimate", "pushover", "advise --free 1", "export"] {
        let (code, message) = fail(folder.path(), &format!("{command} {pier}"));
        let expected = "error: zeta_fc (damping ratio in full contact) is missing: give --zeta-fc; r (coefficient of \
                        restitution on the angular velocity at impact) is missing: give --r; or take what is missing from a \
                        specimen of the paper: --preset evison or --preset mcmanus\n";
        assert_eq!((code, message.as_str()), (1, expected), "{command}");
    }
    let (_, message) = fail(folder.path(), "describe --r 0.9");
    assert!(message.starts_with("error: m (top mass) is missing: give --m (kg) or --weight (kN); m0 "), "{message}");

    let said = |structure: &str| succeed(folder.path(), &format!("describe {structure} --format csv")).1;
    let whole = format!("{pier} --zeta-fc 0.05 --r 0.93");
    assert_eq!(said(&whole), "structure      by default: J0 = 0 kg.m2, c_ratio = 1, g = 9.81 m/s2\n");
    assert_eq!(said(&format!("{whole} --p-l 0.5 --c-ratio 1 --g 9.81")), "");
    let found = derived(folder.path(), &whole);
    assert_eq!([found["J0"], found["zeta_fc"], found["r"]], [0.0, 0.05, 0.93]);
    assert_eq!(
        said(&format!("{pier} --preset mcmanus")),
        "structure      from mcmanus: J0 = 10.7 kg.m2, zeta_fc = 0.02, c_ratio = 1, r = 0.99, g = 9.81 m/s2\n"
    );
    assert_eq!(said(""), "structure      mcmanus, for none is given: see --preset, --parameters\n");
    assert_eq!(said("--preset evison"), "structure      evison\n");
    assert_eq!(succeed(folder.path(), "describe --quiet").1, "");
}

#[test]
fn contradictions_are_named() {
    let folder = folder();
    fs::write(folder.path().join("twice.toml"), "m = 1\nweight = 1\n").unwrap();
    fs::write(folder.path().join("gap.toml"), "m = 1\nm0 = 0\nH = 2\nf_fc = 1\n").unwrap();
    for (arguments, expected) in [
        ("--weight 3 --m 4", "error: weight = 3 kN is given beside m: weight determines m, leave one of them out"),
        ("--H 2 --B 1 --alpha-cg 0.3", "error: alpha_cg = 0.3 rad is given beside H and B: "),
        ("--preset mcmanus --p-l 9", "error: p_l = 9 rad/s does not fit: it would take a negative J0"),
        ("--width -1", "error: width = -1 m is out of range: it must lie between 0.002 and 20000 m"),
        ("--preset mcmanus --r 1.5", "error: r = 1.5"),
        ("--parameters twice.toml", "error: parameters in twice.toml: weight = 1 kN is given beside m"),
        (
            "--parameters gap.toml",
            "error: parameters in gap.toml: B (half-width of the base) is missing: give B (m) or width (m)",
        ),
    ] {
        let (code, message) = fail(folder.path(), &format!("describe {arguments}"));
        assert!(code == 1 && message.starts_with(expected), "{arguments}: {message}");
    }
    let twice = command(folder.path(), "describe --r 1 --r 0.9").output().unwrap();
    assert_eq!(twice.status.code(), Some(2));
}

/// The dimensions' ends are dots: their distances are those of the structure, in proportion.
#[test]
fn the_drawing_is_to_scale() {
    let folder = folder();
    for (H, width) in [(1.84, 0.57), (5.0, 4.0), (1.0, 8.0)] {
        succeed(folder.path(), &format!("describe --preset mcmanus --H {H} --width {width} --picture pier.svg"));
        let svg = fs::read_to_string(folder.path().join("pier.svg")).unwrap();
        let of = |circle: &str, name: &str| {
            let (_, rest) = circle.split_once(&format!("{name}=\"")).unwrap();
            rest.split_once('"').unwrap().0.parse::<f64>().unwrap()
        };
        let dots: Vec<_> = svg.lines().filter(|line| line.contains("<circle") && line.contains("#D55E00")).collect();
        assert_eq!(dots.len(), 4, "{svg}");
        let across = of(dots[1], "cx") - of(dots[0], "cx");
        let upwards = of(dots[2], "cy") - of(dots[3], "cy");
        assert!((across / upwards / (width / H) - 1.0).abs() < 5e-3, "{across} {upwards} {width} {H}");
        assert_eq!((of(dots[0], "cy"), of(dots[2], "cx")), (of(dots[1], "cy"), of(dots[3], "cx")));
    }
}
