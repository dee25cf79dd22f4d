"""What the FMU says of itself."""

import re
import zipfile

import pytest
from first_run import RECORD
from fmpy.util import fmu_info
from fmpy.validation import validate_fmu
from host import OUTPUTS, PHASES

PEAKS = {"theta": "rad", "u": "m", "delta_t": "m", "uplift": "m", "a_t": "m/s2", "V_t": "N", "M_t": "N.m"}


def with_instants(units: dict[str, str]) -> dict[str, str]:
    return units | {f"t_{name}": "s" for name in units}


KINDS = {
    ("input", "continuous", "Real"): {"a_g": "m/s2", "F_t": "N"},
    ("output", "continuous", "Real"): {
        "theta": "rad", "u": "m", "a_t": "m/s2", "V_t": "N", "M_t": "N.m",
        "uplift": "m", "delta_t": "m", "v_t": "m/s", "R_h": "N", "R_v": "N", "R_m": "N.m",
    },
    ("output", "discrete", "Real"): {"I_h": "N.s", "I_v": "N.s", "I_m": "N.m.s"},
    ("local", "continuous", "Real"): {"theta_dot": "rad/s", "u_dot": "m/s", "a_ground": "m/s2"}
    | with_instants({f"{of}_max": unit for of, unit in PEAKS.items()})
    | with_instants({"tension_max": "1", "R_v_min": "1", "mu_required": "1"}),
    ("local", "discrete", "Real"): {"t_overturned": "s"}
    | with_instants({"mu_impact": "1", "tension_impact": "1", "energy_gain_max": "1"}),
    ("local", "discrete", "Enumeration"): {"phase": None},
    ("local", "discrete", "Integer"): {"transitions": None, "energy_gains": None},
    ("local", "discrete", "Boolean"): {"overturned": None},
    ("parameter", "fixed", "Real"): {
        "m": "kg", "m0": "kg", "H": "m", "B": "m", "J0": "kg.m2", "f_fc": "Hz", "zeta_fc": "1", "c_ratio": "1", "r": "1",
        "g": "m/s2", "theta_0": "rad", "theta_dot_0": "rad/s", "u_0": "m", "u_dot_0": "m/s",
        "record_scale": "1", "record_time_scale": "1", "record_start": "s",
    },
    ("parameter", "fixed", "String"): {"record": None},
    ("parameter", "fixed", "Boolean"): {"extrapolate": None, "peaks": None, "validity": None},
    ("parameter", "fixed", "Enumeration"): {"detail": None},
    ("calculatedParameter", "fixed", "Real"): {"alpha_cg": "rad", "p_l": "rad/s", "chi": "1", "u_cr": "m", "f_u": "Hz",
                                                "record_duration": "s"},
}

STARTS = {
    "mcmanus": dict(m=130.1, m0=65.4, H=1.84, B=0.285, J0=10.7, f_fc=5, zeta_fc=0.02, c_ratio=1, r=0.99, g=9.81),
    "evison": dict(m=125.8, m0=44.02, H=1.05, B=0.285, J0=0, f_fc=11, zeta_fc=0.015, c_ratio=1, r=0.96, g=9.81),
}


@pytest.fixture(params=["mcmanus", "evison"])
def fmu(request):
    return request.getfixturevalue(request.param)


def test_fmpy_finds_no_problem(fmu):
    assert validate_fmu(fmu.path) == []


def test_variables(fmu):
    described = {}
    for variable in fmu.description.modelVariables:
        kind = (variable.causality, variable.variability, variable.type)
        described.setdefault(kind, {})[variable.name] = variable.unit
    # a ratio's unit may be left out or be "1"
    described = {kind: {name: unit or ("1" if kind[2] == "Real" else None) for name, unit in names.items()}
                 for kind, names in described.items()}
    assert described == KINDS


def test_every_variable_is_described(fmu):
    assert [variable.name for variable in fmu.description.modelVariables if not variable.description] == []


@pytest.mark.parametrize("preset", STARTS)
def test_start_values_are_those_of_the_structure(preset, request):
    fmu = request.getfixturevalue(preset)
    starts = STARTS[preset] | dict(theta_0=0, theta_dot_0=0, u_0=0, u_dot_0=0, record_scale=1, record_time_scale=1, record_start=0)
    described = {variable.name: float(variable.start) for variable in fmu.variables.values()
                 if variable.causality == "parameter" and variable.type == "Real"}
    assert described == starts
    with fmu.start() as instance:
        assert {name: instance.get(name) for name in starts} == starts


def test_ranges_are_what_the_library_accepts(fmu):
    """At its limits a parameter or initial value is accepted; every one has limits."""
    for variable in fmu.variables.values():
        if variable.causality not in ("parameter", "input") or variable.type != "Real":
            continue
        with fmu.instance() as instance:
            for limit in (variable.min, variable.max):
                assert limit is not None, f"{variable.name} has no limit"
                instance.set(**{variable.name: float(limit)})


def test_phases(fmu):
    items = {item.name: int(item.value) for item in fmu.variables["phase"].declaredType.items}
    assert items == PHASES


def test_feedthrough(fmu):
    unknowns = fmu.description.outputs
    assert sorted(unknown.variable.name for unknown in unknowns) == sorted(OUTPUTS)
    feedthrough = {name: ["a_g", "F_t"] for name in ("a_t", "V_t", "M_t", "R_h", "R_v", "R_m")}
    for unknown in unknowns:
        # no attribute would mean "on all of the inputs"
        assert [known.name for known in unknown.dependencies] == feedthrough.get(unknown.variable.name, [])


def test_initial_dependencies_are_the_true_ones(fmu):
    """Changing one number, at the elastic or at the rigid level, changes exactly those that name it as a dependency."""
    unknowns = {unknown.variable.name: unknown for unknown in fmu.description.initialUnknowns}
    names = [name for name in unknowns if fmu.variables[name].type == "Real"]
    auto, rigid = 1, 5
    bases = [
        (auto, dict(theta_0=0.01, theta_dot_0=0.02, u_0=0.0003, u_dot_0=0.004, record_start=-1.2345)),
        (rigid, dict(theta_0=0.01, theta_dot_0=0.02, record_start=-1.2345)),
    ]

    def initialized(instance, detail, start):
        instance.set(**start)
        instance.slave.setInteger([fmu.variables["detail"].valueReference], [detail])
        instance.slave.setString([fmu.variables["record"].valueReference], [str(RECORD)])
        instance.slave.enterInitializationMode()
        return instance

    def values(detail, start):
        with fmu.instance() as instance:
            return initialized(instance, detail, start).reals(names)

    changed = set()
    for detail, start in bases:
        with fmu.instance() as instance:
            initialized(instance, detail, start)
            numbers = {variable.name: instance.get(variable.name) for variable in fmu.variables.values()
                       if variable.causality in ("parameter", "input") and variable.type == "Real"}
        if detail == rigid:  # which does not deform
            numbers = {name: number for name, number in numbers.items() if name not in ("u_0", "u_dot_0")}
        before = values(detail, start)
        for known, number in numbers.items():
            after = values(detail, start | {known: number * 0.75 if number else 0.75})
            changed |= {(name, known) for name, old, new in zip(names, before, after)
                        if new != pytest.approx(old, rel=1e-12)}
    stated = {(name, v.name) for name in names for v in unknowns[name].dependencies if v.name not in ("detail", "record")}
    assert changed == stated


def test_capabilities(fmu):
    capabilities = fmu.description.coSimulation
    assert capabilities.modelIdentifier == "FlexibleRocking"
    assert capabilities.canHandleVariableCommunicationStepSize
    assert capabilities.canInterpolateInputs
    assert capabilities.canGetAndSetFMUstate
    assert capabilities.canSerializeFMUstate
    assert capabilities.providesDirectionalDerivative
    assert not capabilities.canBeInstantiatedOnlyOncePerProcess


def test_archive(fmu):
    with zipfile.ZipFile(fmu.path) as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        for name in ("modelDescription.xml", "model.png", "binaries/linux64/FlexibleRocking.so",
                     "documentation/index.html"):
            assert name in names
        page = archive.read("documentation/index.html").decode()
        assert archive.read("model.png").startswith(b"\x89PNG\r\n")
    for name in fmu.variables:
        assert name in page, f"the documentation does not mention {name}"


def test_two_exports_are_identical(export):
    first, second = (export("mcmanus").read_bytes() for _ in range(2))
    assert first == second, "the archives differ"


def test_the_library_refuses_another_builds_description(fmu):
    other = "{00000000-0000-0000-0000-000000000000}"
    messages = []
    with pytest.raises(Exception, match="Failed to instantiate"):
        fmu.instance(guid=other, messages=messages)
    (message,) = messages
    assert message.status == 3 and message.category == "logStatusError"
    assert other in message.text and fmu.description.guid in message.text


def test_info(fmu):
    info = fmu_info(fmu.path)
    assert re.search(r"FMI Version +2\.0\n", info)
    assert re.search(r"FMI Type +Co-Simulation\n", info)
    assert re.search(r"Model Name +\S", info)
    assert re.search(r"Description +\S", info)
    # no date: it would tell two exports of the same thing apart
    assert re.findall(r"^  (.*?) +None$", info, re.MULTILINE) == ["Generation Date"]
    for name in ("a_g", "F_t", *OUTPUTS):
        variable = fmu.variables[name]
        line = re.search(rf"^  {name} +{variable.causality} .*$", info, re.MULTILINE)
        assert line and variable.description in line[0], name
