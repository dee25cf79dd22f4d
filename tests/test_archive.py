"""The archive: what is in it, what describes it, and what is refused when it is made or opened."""

import os
import re
import struct
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from host import Fmu, refusal

RECORDS = {"pulse & 1.csv": "t/s,a\r\n0,1\r\n1,2\r\n", "sine.txt": "t/s,a\n0,1\n1,-1\n", "late.txt": "t/s,a\n1,1\n2,-1\n",
           "other/Sine.TXT": "t/s,a\n0,2\n1,0\n", "Contents.BIN": "t/s,a\n0,2\n1,0\n"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("records")
    (path / "other").mkdir()
    for name, text in RECORDS.items():
        (path / name).write_bytes(text.encode())
    return path


def test_records_are_packed_as_they_are_and_the_first_is_the_default(export, folder):
    pulse, sine = folder / "pulse & 1.csv", folder / "sine.txt"
    one, swapped, pair = (export("evison", *of) for of in ((pulse, sine), (sine, pulse), (pulse, "--record-v", sine)))
    for path in (pulse, sine):
        assert (one.resources / path.name).read_bytes() == path.read_bytes()
    assert one.variables["record"].start == "pulse & 1.csv" and one.variables["record_v"].start in ("", None)
    assert swapped.description.guid != one.description.guid
    assert [pair.variables[name].start for name in ("record", "record_v")] == ["pulse & 1.csv", "sine.txt"]


RULE = "must consist of the letters a to z and A to Z, digits and _, and not begin with a digit"


@pytest.mark.parametrize("options, text", [
    (("--record", "pulse & 1.csv", "--record-v", "late.txt"), 'the vertical component "late" begins at 1.0 s and'),
    *((("--record", "sine.txt", name), f"two files called {Path(name).name}: rename the record; capitals and small letters")
      for name in ("other/Sine.TXT", "Contents.BIN")),
    *((("--name", name), f'the name "{name}" {RULE}') for name in ("", "1Pier", "Pier 1", "../Pier", "Pfahl_ä", "Pier.1")),
])
def test_what_no_archive_can_hold_is_refused(exporter, folder, options, text):
    assert text in refusal(exporter, "--quiet", "export", *options, "-o", "none.fmu", cwd=folder)


@pytest.mark.parametrize("name", ["Pier1", "_", "a_b_2"])
def test_a_name_is_an_identifier_of_c(export, name):
    assert (export("evison", None, "--name", name).resources.parent / f"binaries/linux64/{name}.so").is_file()


def test_a_record_is_known_by_its_content(wall):
    """A file that is rewritten is another record, even with the same size and time; a URI names the same file."""
    one, path = wall.instance(), wall.resources / "pulse 1.csv"

    def amid(text, name):
        path.write_text(text)
        os.utime(path, (1e9, 1e9))
        one.slave.reset()
        return one.enter(record=name, record_start=-0.5).get("a_ground")

    for last in (2, 3):
        for name in ("pulse 1.csv", str(path), path.as_uri().replace("file", "FILE")):
            assert amid(f"t/s,a\n0,1\n1,{last}\n", name) == (1 + last) / 2
    assert amid("t/s,a (g)\n0,1\n1,3\n", str(path)) == pytest.approx(2 * 9.81, rel=1e-15)


def test_packed_records_are_read_when_the_archive_is_opened(export, folder):
    """A host may delete the folder as soon as the instance is made. One that was altered is refused; by its path it is any file."""
    fmu, altered = (Fmu(export("evison", folder / "pulse & 1.csv").path) for _ in range(2))
    one = fmu.instance()
    for file in fmu.resources.iterdir():
        file.unlink()
    assert one.enter(record_start=-0.5).get("a_ground") == 1.5
    altered.write("pulse & 1.csv", "t/s,a\n0,1\n1,3\n")
    one = altered.instance().enter()
    with pytest.raises(FMICallException):
        one.exit()
    assert one.messages[-1].text.endswith('record = "pulse & 1.csv" in the archive is not the one that was exported with it; export it again')
    one.set(record=str(altered.resources / "pulse & 1.csv"))
    one.exit()


def test_resources_that_are_not_those_of_an_fmu_are_named(wall, of_each):
    file = wall.resources / "contents.bin"
    file.write_bytes(file.read_bytes().replace(struct.pack("<d", 0.96), struct.pack("<d", 1.5)))
    with pytest.raises(RuntimeError, match="contents.bin: r = 1.5 is out of range"):
        wall.instance()
    building = Fmu(of_each("F_t[1]", 2).path)
    file = building.resources / "contents.bin"
    whole = file.read_bytes()
    for length in (*range(0, len(whole), 9), len(whole) - 1):
        file.write_bytes(whole[:length])
        with pytest.raises(RuntimeError, match="contents.bin: not the numbers that were exported; export it again"):
            building.instance()


INPUT, FIXED, OF_RUN = ("input", "continuous", "exact"), ("parameter", "fixed", "exact"), ("local", "continuous", "calculated")
VARIABLES = {  # causality, variability, initial; type, and what it has
    "a_g": (INPUT, "Real", dict(unit="m/s2", displayUnit="g", min="-10000.0", max="10000.0", nominal="3.59", start="0.0")),
    "f_fc": (FIXED, "Real", dict(unit="Hz", min="0.001", max="10000.0", start="11.0")),
    "zeta_fc": (FIXED, "Real", dict(min="0.0", max="0.99", start="0.015")),
    "chi": (("calculatedParameter", "fixed", "calculated"), "Real", {}),
    "I_h": (("output", "discrete", "calculated"), "Real", dict(unit="N.s")),
    "phase": (("local", "discrete", "calculated"), "Enumeration", dict(declaredType="Phase")),
    "detail": (FIXED, "Enumeration", dict(declaredType="Detail", start="1")),
    "record": (FIXED, "String", dict(start="pulse & 1.csv")),
    "peaks": (FIXED, "Boolean", dict(start="false")),
    "theta_max": (OF_RUN, "Real", dict(unit="rad", displayUnit="deg", nominal="0.351")),
}


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_description_has_the_variables_of_the_structure(export, folder, fmi):
    """With units, ranges and start values. References of FMI 3.0 count from 1 in the order of the variables: OMSimulator reads
    `dependencies` as such places. Its enumerations have a name alone: fmpy up to 0.3.23 accepts no other attribute."""
    fmu = export("evison", folder / "pulse & 1.csv", fmi=fmi)
    for name, (roles, of_type, attributes) in VARIABLES.items():
        variable = fmu.variables[name]
        assert (variable.causality, variable.variability, variable.initial) == roles, name
        assert variable.type == (of_type if fmi == 2 else of_type.replace("Real", "Float64"))
        found = {key: getattr(variable, key) for key in ("unit", "displayUnit", "min", "max", "nominal", "start")}
        found["declaredType"] = variable.declaredType and variable.declaredType.name
        assert {key: value for key, value in found.items() if value is not None} == attributes, name
    description = fmu.description
    assert fmu.variables["a_g"].description == "horizontal ground acceleration, positive to the right"
    (phase, _), (newton,) = description.typeDefinitions, [unit for unit in description.unitDefinitions if unit.name == "N"]
    assert phase.items[1].name == "rocking left" and phase.items[1].value == "2"
    assert (newton.baseUnit.kg, newton.baseUnit.m, newton.baseUnit.s) == (1, 1, -2)
    said = {category.name: category.description for category in description.logCategories}
    assert said["logEvents"] == "uplift, impact, landing and overturning, as they happen"
    if fmi == 3:
        assert [variable.valueReference for variable in description.modelVariables] == list(range(1, len(fmu.variables) + 1))
        assert fmu.variables["der(theta)"].derivative.name == "theta"
        text = (fmu.resources.parent / "modelDescription.xml").read_text()
        assert re.search('name="a_g"[^>]*intermediateUpdate="true"', text)
        assert re.findall("<EnumerationType (.*)>", text) == ['name="Phase"', 'name="Detail"']


def test_the_structure_points_at_what_values_follow_from(export):
    """Once the simulation goes on, these are the inputs and states. The variables that give the states count at the start. FMI 3.0 adds
    parameters and time."""

    names = list(export("mcmanus").variables)
    ties = " ".join(names[names.index("P_0"):names.index("detail")])

    def follows(fmi, unknowns, name):
        (unknown,) = [of for of in getattr(export("mcmanus", fmi=fmi).description, unknowns) if of.variable.name == name]
        return " ".join(known.name for known in unknown.dependencies)

    for fmi, unknowns, name, expected in [
        (2, "outputs", "a_t", "a_g F_t a_v theta u theta_dot u_dot"), (2, "outputs", "delta_t", "theta u"), (2, "outputs", "I_v", ""),
        (2, "outputs", "theta", "theta"), (2, "derivatives", "der(u)", "u_dot"), (2, "initialUnknowns", "theta", "theta_0"),
        (2, "initialUnknowns", "p_l", "m m0 H B J0 g"), (2, "initialUnknowns", "delta_t", "H B theta_0 u_0"),
        (3, "outputs", "delta_t", "theta u H B"), (3, "eventIndicators", "overturning_indicator", "theta theta_dot B xi_d k_d F_y"),
        (3, "derivatives", "der(u_dot)", "a_g F_t a_v theta u theta_dot u_dot m m0 H B J0 f_fc zeta_fc c_ratio g "
         f"{ties} detail record record_v record_scale record_time_scale record_start time"),
    ]:
        assert follows(fmi, unknowns, name) == expected, name
