"""What the FMU refuses, in which words, and that the host lives on."""

from math import inf, nan, pi

import pytest
from fmpy.fmi1 import FMICallException
from host import REALS, simulate

OUT_OF_RANGE = [
    ("r", 0.0, "r = 0 ", "1"),
    ("r", 1.5, "r = 1.5 ", "1"),
    ("B", -0.3, "B = -0.3 m ", "0.001"),
    ("m", 0.0, "m = 0 kg ", "between 1e-6 and 1e12 kg"),
    ("m", nan, "m = NaN kg ", "between 1e-6 and 1e12 kg"),
    ("H", inf, "H = inf m ", "10000"),
    ("m0", -1.0, "m0 = -1 kg ", "0"),
    ("zeta_fc", -0.01, "zeta_fc = -0.01 ", "0"),
    ("f_fc", 0.0, "f_fc = 0 Hz ", "0.001"),
    ("g", -9.81, "g = -9.81 m/s2 ", "0.001"),
    ("theta_0", pi / 2, "theta_0 = 1.5707963267948966 rad ", "1.5"),
    ("theta_0", -2.0, "theta_0 = -2 rad ", "-1.5"),
    ("u_0", nan, "u_0 = NaN m ", "10000"),
    ("a_g", nan, "a_g = NaN m/s2 ", "10000"),
    ("a_g", inf, "a_g = inf m/s2 ", "10000"),
]


@pytest.mark.parametrize(("name", "value", "words", "limit"), OUT_OF_RANGE, ids=lambda x: str(x))
def test_a_value_out_of_range_is_refused_when_it_is_set(mcmanus, name, value, words, limit):
    with mcmanus.instance() as instance:
        with pytest.raises(FMICallException, match="fmi2SetReal failed with status 3"):
            instance.set(**{name: value})
        (message,) = instance.errors
        assert words in message
        assert limit in message.partition("must")[2], message
        instance.initialize()
        instance.step(0.01)


def test_one_refused_value_leaves_all_as_they_were(mcmanus):
    with mcmanus.instance() as instance:
        with pytest.raises(FMICallException):
            instance.set(m=100.0, r=0.0)
        instance.initialize()
        assert instance.get("m", "r") == [130.1, 0.99]


CONTRADICTIONS = [
    (dict(theta_dot_0=0.1), ("theta_dot_0 = 0.1 rad/s", "theta_0 = 0", "set theta_dot_0 to 0")),
    (dict(H=1000.0, B=0.5), ("H/B = 2000", "1000", "lower H or raise B")),
]


@pytest.mark.parametrize(("start", "words"), CONTRADICTIONS, ids=["turning in full contact", "too slender"])
def test_values_that_contradict_each_other_are_refused_before_the_first_step(mcmanus, start, words):
    with mcmanus.instance() as instance:
        instance.set(**start)
        instance.slave.enterInitializationMode()
        with pytest.raises(FMICallException, match="fmi2ExitInitializationMode failed with status 3"):
            instance.slave.exitInitializationMode()
        (message,) = instance.errors
        for word in words:
            assert word in message
        instance.slave.reset()
        instance.messages.clear()
        instance.initialize()
        instance.step(0.01)
        assert instance.errors == []


def test_simulate_fmu_fails_with_the_message_in_the_log(mcmanus):
    messages = []
    with pytest.raises(FMICallException, match="fmi2SetReal failed with status 3"):
        simulate(mcmanus, messages, stop_time=1.0, start_values={"r": 0.0})
    (message,) = messages
    assert message.category == "logStatusError" and "r = 0 " in message.text
    result, _ = simulate(mcmanus, stop_time=0.1, output_interval=0.05, output=["theta"])
    assert len(result) == 3


def test_fixed_parameters_stay_fixed(mcmanus):
    with mcmanus.start() as instance:
        with pytest.raises(FMICallException, match="status 3"):
            instance.set(m=100.0)
        assert "m is fixed once the simulation has started" in instance.errors[-1]
        assert instance.get("m") == 130.1


@pytest.mark.parametrize("name", [*REALS, "alpha_cg"])
def test_what_the_fmu_computes_cannot_be_set(mcmanus, name):
    with mcmanus.instance() as instance:
        with pytest.raises(FMICallException, match="status 3"):
            instance.set(**{name: 0.1})
        assert f"{name} cannot be set" in instance.errors[-1]


@pytest.mark.parametrize("tolerance", [0.0, -1e-6, 1.0, nan])
def test_a_tolerance_out_of_range_is_refused(mcmanus, tolerance):
    with mcmanus.instance() as instance:
        with pytest.raises(FMICallException, match="fmi2SetupExperiment failed with status 3"):
            instance.slave.setupExperiment(tolerance)
        assert "tolerance = " in instance.errors[-1] and "between 0 and 1" in instance.errors[-1]


def test_functions_out_of_turn_are_refused(mcmanus):
    with mcmanus.instance() as instance:
        with pytest.raises(FMICallException, match="fmi2DoStep failed with status 3"):
            instance.slave.doStep(0.0, 0.1)
        assert "fmi2DoStep" in instance.errors[-1] and "instantiated" in instance.errors[-1]
        instance.initialize()
        with pytest.raises(FMICallException, match="fmi2SetupExperiment failed with status 3"):
            instance.slave.setupExperiment()
        instance.step(0.1)


def test_unknown_value_references_are_refused(mcmanus):
    with mcmanus.start() as instance:
        for call in (instance.slave.getReal, instance.slave.getInteger, instance.slave.getBoolean):
            with pytest.raises(FMICallException, match="status 3"):
                call([4_000_000_000])
            assert "4000000000" in instance.errors[-1]
        with pytest.raises(FMICallException, match="status 3"):
            instance.slave.getReal([instance.fmu.variables["phase"].valueReference])
        assert "phase is an enumeration" in instance.errors[-1]


def test_only_first_derivatives_of_the_input_are_taken(mcmanus):
    with mcmanus.start() as instance:
        a_g, theta = (instance.fmu.variables[name].valueReference for name in ("a_g", "theta"))
        for reference, order, value, words in [
            (a_g, 2, 1.0, ("order = 2", "a_g")),
            (a_g, 1, nan, ("a_g", "NaN", "finite")),
            (theta, 1, 1.0, ("theta",)),
        ]:
            with pytest.raises(FMICallException, match="fmi2SetRealInputDerivatives failed with status 3"):
                instance.slave.setRealInputDerivatives([reference], [order], [value])
            for word in words:
                assert word in instance.errors[-1]
