"""The archive: what is in it, what describes it, and what is refused when it is made or opened."""

import os
import re
import struct
import subprocess
import zipfile
from xml.etree import ElementTree

import pytest
from host import Fmu


@pytest.fixture
def exported(exporter, tmp_path):
    """Exports Evison's specimen with `options` and returns the path, or the message of a refusal."""

    def run(*options, name="archive.fmu"):
        command = [exporter, "--quiet", "export", "--preset", "evison", *options, "-o", name]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        return tmp_path / name if done.returncode == 0 else done.stderr

    return run


@pytest.fixture
def records(tmp_path):
    files = {"pulse & 1.csv": "t/s,a\r\n0,1\r\n1,2\r\n", "sine.txt": "t/s,a\n0,1\n1,-1\n", "late.txt": "t/s,a\n1,1\n2,-1\n",
             "Sine.TXT": "t/s,a\n0,2\n1,0\n"}
    (tmp_path / "other").mkdir()
    for name, text in files.items():
        (tmp_path / ("other" if name == "Sine.TXT" else "") / name).write_bytes(text.encode())
    return files


def test_records_are_packed_as_they_are_and_the_first_is_the_default(exported, records, tmp_path):
    one = Fmu(exported("--record", "pulse & 1.csv", "sine.txt"), tmp_path / "one")
    for name in ("pulse & 1.csv", "sine.txt"):
        assert (one.resources / name).read_bytes() == records[name].encode()
    assert one.variables["record"].start == "pulse & 1.csv" and one.variables["record_v"].start in ("", None)
    swapped = Fmu(exported("--record", "sine.txt", "pulse & 1.csv"), tmp_path / "swapped")
    assert swapped.description.guid != one.description.guid
    pair = Fmu(exported("--record", "pulse & 1.csv", "--record-v", "sine.txt"), tmp_path / "pair")
    assert [pair.variables[name].start for name in ("record", "record_v")] == ["pulse & 1.csv", "sine.txt"]
    for options, text in [
        (("--record", "pulse & 1.csv", "--record-v", "late.txt"), 'the vertical component "late" begins at 1.0 s and'),
        (("--record", "sine.txt", "other/Sine.TXT"), "two records are called Sine.TXT: rename one of them; capitals and small letters"),
    ]:
        assert text in exported(*options)


def test_a_name_is_an_identifier_of_c(exported):
    for name in ("Pier1", "_", "a_b_2"):
        with zipfile.ZipFile(exported("--name", name)) as archive:
            assert f"binaries/linux64/{name}.so" in archive.namelist()
    for name in ("", "1Pier", "Pier 1", "../Pier", "Pfahl_ä", "Pier.1"):
        rule = "must consist of the letters a to z and A to Z, digits and _, and not begin with a digit"
        assert f'the name "{name}" {rule}' in exported("--name", name)


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


def test_packed_records_are_read_when_the_archive_is_opened(exported, records, tmp_path):
    """A host may delete the folder as soon as the instance is made."""
    fmu = Fmu(exported("--record", "pulse & 1.csv"), tmp_path / "unpacked")
    one = fmu.instance()
    for file in fmu.resources.iterdir():
        file.unlink()
    assert one.enter(record_start=-0.5).get("a_ground") == 1.5


def test_a_packed_record_that_was_altered_is_refused(exported, records, tmp_path):
    """It is the one whose samples the archive names; by its path it is any file."""
    fmu = Fmu(exported("--record", "pulse & 1.csv"), tmp_path / "unpacked")
    fmu.write("pulse & 1.csv", "t/s,a\n0,1\n1,3\n")
    one = fmu.instance().enter()
    with pytest.raises(Exception, match="fmi2ExitInitializationMode failed with status 3"):
        one.exit()
    text = 'record = "pulse & 1.csv" in the archive is not the one that was exported with it; export it again'
    assert one.errors[-1].endswith(text)
    one.set(record=str(fmu.resources / "pulse & 1.csv"))
    one.exit()


def test_resources_that_are_not_those_of_an_fmu_are_named(wall, of_each, tmp_path):
    file = wall.resources / "contents.bin"
    file.write_bytes(file.read_bytes().replace(struct.pack("<d", 0.96), struct.pack("<d", 1.5)))
    with pytest.raises(RuntimeError, match=re.escape("contents.bin: r = 1.5 is out of range")):
        wall.instance()
    building = Fmu(of_each["F_t[1]", 2].path, tmp_path / "building")
    file = building.resources / "contents.bin"
    whole = file.read_bytes()
    for length in (*range(0, len(whole), 9), len(whole) - 1):
        file.write_bytes(whole[:length])
        with pytest.raises(RuntimeError, match="contents.bin: not the numbers that were exported; export it again"):
            building.instance()


def described(path):
    with zipfile.ZipFile(path) as archive:
        return ElementTree.fromstring(archive.read("modelDescription.xml"))


HEAD = dict(name="a_g", valueReference="0", description="horizontal ground acceleration, positive to the right", causality="input",
            variability="continuous")
REAL = dict(unit="m/s2", displayUnit="g", min="-10000.0", max="10000.0", nominal="3.59", start="0.0")


def test_the_description_has_the_variables_of_the_structure(exported, records):
    """By type, with units, ranges and start values in the places of each version."""
    root = described(exported("--record", "pulse & 1.csv", "--name", "Pier"))
    variables = {variable.get("name"): variable for variable in root.find("ModelVariables")}
    assert variables["a_g"].attrib == HEAD
    fixed, calculated = ("parameter", "fixed", "exact"), ("calculatedParameter", "fixed", "calculated")
    for name, roles, tag, attributes in [
        ("a_g", ("input", "continuous", None), "Real", REAL),
        ("f_fc", fixed, "Real", dict(unit="Hz", min="0.001", max="10000.0", start="11.0")),
        ("zeta_fc", fixed, "Real", dict(min="0.0", max="0.99", start="0.015")),
        ("chi", calculated, "Real", {}),
        ("phase", ("local", "discrete", "calculated"), "Enumeration", dict(declaredType="Phase")),
        ("record", fixed, "String", dict(start="pulse & 1.csv")),
        ("peaks", fixed, "Boolean", dict(start="false")),
        ("theta_max", ("local", "continuous", "calculated"), "Real", dict(unit="rad", displayUnit="deg", nominal="0.351")),
    ]:
        (of_type,) = variables[name]
        assert tuple(variables[name].get(role) for role in ("causality", "variability", "initial")) == roles
        assert (of_type.tag, of_type.attrib) == (tag, attributes)
    assert root.find(".//Item[@name='rocking left']").get("value") == "2"
    assert root.find(".//Unit[@name='N']/BaseUnit").attrib == dict(kg="1", m="1", s="-2")
    assert root.find(".//Category[@name='logEvents']").get("description") == "uplift, impact, landing and overturning, as they happen"
    assert root.get("modelName") == root.find("CoSimulation").get("modelIdentifier") == "Pier"
    root = described(exported("--record", "pulse & 1.csv", "--fmi", "3"))
    variables = {variable.get("name"): variable for variable in root.find("ModelVariables")}
    assert variables["a_g"].attrib == HEAD | dict(valueReference="1", intermediateUpdate="true") | REAL
    roles = "causality", "variability", "initial", "unit", "declaredType", "start", "derivative"
    assert [variables["I_h"].get(role) for role in roles] == ["output", "discrete", "calculated", "N.s", None, None, None]
    assert [variables["detail"].get(role) for role in roles] == ["parameter", "fixed", "exact", None, "Detail", "1", None]
    assert variables["record"].find("Start").get("value") == "pulse & 1.csv" and variables["der(theta)"].get("derivative") == "4"


def test_the_structure_points_at_what_values_follow_from(export):
    """Once the simulation goes on, these are the inputs and states. The variables that give the states count at the start. FMI 3.0 adds
    parameters and time."""
    of_2, of_3 = described(export("mcmanus")), described(export("mcmanus", fmi=3))
    in_order = [variable.get("name") for variable in of_2.find("ModelVariables")]
    by_reference = {variable.get("valueReference"): variable.get("name") for variable in of_3.find("ModelVariables")}

    def of_version_2(element, name):
        unknown = of_2.find(f"ModelStructure/{element}/Unknown[@index='{in_order.index(name) + 1}']")
        return " ".join(in_order[int(at) - 1] for at in unknown.get("dependencies").split())

    def of_version_3(element, name):
        (unknown,) = [of for of in of_3.iter(element) if by_reference[of.get("valueReference")] == name]
        return " ".join(by_reference[at] for at in unknown.get("dependencies").split())

    assert of_version_2("Outputs", "a_t") == "a_g F_t a_v theta u theta_dot u_dot"
    assert (of_version_2("Outputs", "delta_t"), of_version_2("Outputs", "I_v"), of_version_2("Outputs", "theta")) == ("theta u", "", "theta")
    assert of_version_2("Derivatives", "der(u)") == "u_dot"
    assert of_version_2("InitialUnknowns", "theta") == "theta_0" and of_version_2("InitialUnknowns", "p_l") == "m m0 H B J0 g"
    assert of_version_2("InitialUnknowns", "delta_t") == "H B theta_0 u_0"
    assert of_version_3("Output", "delta_t") == "theta u H B"
    assert of_version_3("ContinuousStateDerivative", "der(u_dot)") == (
        "a_g F_t a_v theta u theta_dot u_dot m m0 H B J0 f_fc zeta_fc c_ratio g P_0 k_t xi_d c_d k_d F_y detail record record_v "
        "record_scale record_time_scale record_start time")
    assert of_version_3("EventIndicator", "overturning_indicator") == "theta theta_dot B xi_d k_d F_y"
