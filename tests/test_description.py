"""What the FMU says of itself."""

import contextlib
import re
import zipfile
from pathlib import PurePosixPath

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration
from fmpy.model_description import CoSimulation, ModelDescription, ModelVariable, Unknown
from fmpy.util import fmu_info
from fmpy.validation import validate_fmu
from host import OUTPUTS, PHASES, Fmu
from pacoima import TIME

PEAKS = {"theta": "rad", "u": "m", "delta_t": "m", "uplift": "m", "a_t": "m/s2", "V_t": "N", "M_t": "N.m"}


def with_instants(units: dict[str, str]) -> dict[str, str]:
    return units | {f"t_{name}": "s" for name in units}


STATES = ("u", "u_dot", "theta", "theta_dot")
RATES = dict(zip((f"der({name})" for name in STATES), ("m/s", "m/s2", "rad/s", "rad/s2")))
KINDS = {
    ("input", "continuous", "Real"): {"a_g": "m/s2", "F_t": "N"},
    ("output", "continuous", "Real"): {
        "theta": "rad", "u": "m", "a_t": "m/s2", "V_t": "N", "M_t": "N.m",
        "uplift": "m", "delta_t": "m", "v_t": "m/s", "R_h": "N", "R_v": "N", "R_m": "N.m",
    },
    ("output", "discrete", "Real"): {"I_h": "N.s", "I_v": "N.s", "I_m": "N.m.s"},
    ("local", "continuous", "Real"): {"theta_dot": "rad/s", "u_dot": "m/s", "a_ground": "m/s2"} | RATES
    | {"phase_indicator": "1", "overturning_indicator": "1"}
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
    ("parameter", "fixed", "Boolean"): {"a_g_late": None, "F_t_extrapolated": None, "peaks": None, "validity": None},
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


def test_display_units(fmu):
    """A value in its display unit is the value times the factor; g is the structure's own."""
    factors = {"deg": 180 / np.pi, "mm": 1e3, "ms": 1e3, "g": 1 / 9.81, "kN": 1e-3, "kN.m": 1e-3}
    defined = {display.name: display.factor for unit in fmu.description.unitDefinitions for display in unit.displayUnits}
    assert defined == pytest.approx(factors, rel=1e-15)
    shown = {name: variable.displayUnit for name, variable in fmu.variables.items() if variable.displayUnit}
    assert {shown[name] for name in ("theta", "theta_max", "theta_0", "alpha_cg")} == {"deg"}
    assert {shown[name] for name in ("u", "uplift", "delta_t", "u_cr")} == {"mm"}
    assert {shown[name] for name in ("a_g", "a_t", "a_ground", "a_t_max")} == {"g"}
    assert {shown[name] for name in ("F_t", "V_t", "R_h", "R_v")} == {"kN"} and shown["M_t"] == shown["R_m"] == "kN.m"
    assert not shown.keys() & {"H", "B", "g", "m", "t_theta_max"}


def test_nominal_values_are_of_the_magnitude_that_is_met(shaken):
    """What peaks in an earthquake is within a factor of 100 of its nominal value."""
    fmu = shaken["mcmanus"]
    result = simulate_fmu(fmu.path, start_values={"peaks": True}, output=[*OUTPUTS, *(f"{name}_max" for name in PEAKS)])
    for name in set(result.dtype.names) - {"time", "I_h", "I_v", "I_m"}:
        peak, nominal = np.abs(result[name]).max(), float(fmu.variables[name].nominal)
        assert nominal / 100 < peak < 100 * nominal, (name, peak, nominal)


def test_simulating_without_a_word_follows_the_record(shaken, mcmanus):
    """The default experiment ends as long after the record as free rocking lasts, 10/p_l, and its step is no longer than a
    sample; without a record, nothing has been said that would move the structure, and its stop time and step are those of a
    free vibration."""
    experiment = shaken["mcmanus"].description.defaultExperiment
    afterwards = float(experiment.stopTime) - (TIME[-1] - TIME[0])
    with mcmanus.start() as instance:
        assert afterwards == pytest.approx(10 / instance.reals(["p_l"])[0], abs=2 * np.diff(TIME).max())
    assert float(experiment.stepSize) <= np.diff(TIME).min() * (1 + 1e-8)
    result = simulate_fmu(shaken["mcmanus"].path)
    assert result["time"][-1] == pytest.approx(float(experiment.stopTime)) and np.abs(result["theta"]).max() > 0.01
    at_rest = simulate_fmu(mcmanus.path)
    assert not at_rest["theta"].any() and not at_rest["u"].any()
    released = simulate_fmu(mcmanus.path, start_values={"theta_0": 0.04})
    assert (np.diff(np.sign(released["theta"])) != 0).sum() > 5, "fewer than five impacts are seen"
    u = released["u"][:200]
    assert (np.diff(np.sign(np.diff(u))) != 0).sum() > 2, "the vibration mode is not resolved"


def test_two_exports_in_one_process(export, pacoima_record, tmp_path):
    """Under names of their own two structures are held at the same time, and each moves as it does alone."""
    fmus = [Fmu(export(preset, pacoima_record, name), tmp_path / name)
            for preset, name in (("mcmanus", "Pier1"), ("evison", "Pier2"))]
    for fmu, name in zip(fmus, ("Pier1", "Pier2")):
        assert fmu.description.modelName == fmu.description.coSimulation.modelIdentifier == name
        with zipfile.ZipFile(fmu.path) as archive:
            libraries = [PurePosixPath(path) for path in archive.namelist() if path.startswith("binaries/")]
        assert libraries and {library.stem for library in libraries} == {name}
        assert validate_fmu(fmu.path) == []

    def histories(*fmus):
        with contextlib.ExitStack() as stack:
            instances = [stack.enter_context(fmu.start()) for fmu in fmus]
            rows = []
            for until in np.arange(1, 200) * 0.02:
                for instance in instances:
                    instance.step(until)
                rows.append([instance.reals(("theta", "u", "a_t")) for instance in instances])
            return np.array(rows).swapaxes(0, 1)

    together, alone = histories(*fmus), [histories(fmu)[0] for fmu in fmus]
    assert (together == alone).all() and np.abs(together[:, :, 0]).max(axis=1).min() > 1e-3


def test_two_exports_in_one_container(export, pacoima_record, tmp_path):
    """fmpy's container of both gives what each gives by itself."""
    time = ModelVariable(name="time", valueReference=0, type="Real", causality="independent", variability="continuous")
    components, variables, mapping = [], [time], {}  # what is number 0 is the time
    for preset, name in (("mcmanus", "Pier1"), ("evison", "Pier2")):
        path = export(preset, pacoima_record, name)
        component = Component(name=name, filename=path, modelDescription=read_model_description(path))
        inner = next(v for v in component.modelDescription.modelVariables if v.name == "theta")
        outer = ModelVariable(name=f"{name}_theta", valueReference=0, type="Real", causality="output", variability="continuous",
                              initial="calculated")
        components.append(component)
        variables.append(outer)
        mapping[outer] = [(component, inner)]
    description = ModelDescription(
        fmiVersion="2.0", modelName="Two", instantiationToken="two", modelVariables=variables,
        coSimulation=CoSimulation(modelIdentifier="container_fmu", fixedInternalStepSize=0.01))
    description.outputs = [Unknown(variable=variable) for variable in variables[1:]]
    (tmp_path / "unpacked").mkdir()
    create_container_fmu(Configuration(parallelDoStep=False, modelDescription=description, components=components, connections=[],
                                       variableMappings=mapping), tmp_path / "unpacked", tmp_path / "two.fmu")
    both = simulate_fmu(tmp_path / "two.fmu", stop_time=3.0, output_interval=0.01)
    for component in components:
        alone = simulate_fmu(component.filename, stop_time=3.0, output_interval=0.01)
        assert np.abs(alone["theta"]).max() > 1e-3
        np.testing.assert_allclose(both[f"{component.name}_theta"], alone["theta"], rtol=0, atol=1e-14)


def test_phases(fmu):
    items = {item.name: int(item.value) for item in fmu.variables["phase"].declaredType.items}
    assert items == PHASES


def test_feedthrough(fmu):
    unknowns = fmu.description.outputs
    assert sorted(unknown.variable.name for unknown in unknowns) == sorted(OUTPUTS)
    feedthrough = {name: ["a_g", "F_t", *STATES] for name in ("a_t", "V_t", "M_t", "R_h", "R_v", "R_m", "der(u_dot)", "der(theta_dot)")}
    of_states = {"theta": ["theta"], "u": ["u"], "uplift": ["theta"], "delta_t": ["u", "theta"], "v_t": [*STATES],
                 "der(u)": ["u_dot"], "der(theta)": ["theta_dot"]}
    for unknown in unknowns + fmu.description.derivatives:
        # no attribute would mean "on all of the inputs and states"
        assert [known.name for known in unknown.dependencies] == (feedthrough | of_states).get(unknown.variable.name, [])


def test_the_states_are_those_of_the_model(fmu):
    rates = [unknown.variable for unknown in fmu.description.derivatives]
    assert [(rate.name, rate.derivative.name) for rate in rates] == list(zip(RATES, STATES))
    assert fmu.description.numberOfContinuousStates == 4 and fmu.description.numberOfEventIndicators == 2


def test_capabilities(fmu):
    capabilities, exchange = fmu.description.coSimulation, fmu.description.modelExchange
    assert exchange.needsCompletedIntegratorStep and not exchange.canBeInstantiatedOnlyOncePerProcess
    for name in ("modelIdentifier", "canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"):
        assert getattr(exchange, name) == getattr(capabilities, name), name
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
    assert re.search(r"FMI Type +Model Exchange, Co-Simulation\n", info)
    assert re.search(r"Model Name +\S", info)
    assert re.search(r"Description +\S", info)
    # no date: it would tell two exports of the same thing apart
    assert re.findall(r"^  (.*?) +None$", info, re.MULTILINE) == ["Generation Date"]
    for name in ("a_g", "F_t", *OUTPUTS):
        variable = fmu.variables[name]
        line = re.search(rf"^  {name} +{variable.causality} .*$", info, re.MULTILINE)
        assert line and variable.description in line[0], name
