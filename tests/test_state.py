"""The same steps from the same state give the same bits, whatever else goes on."""

import threading

import numpy as np
import pytest
from host import REALS, pacoima

TIME, A_G = pacoima("pul164")
CUT = 700  # between uplifts, with most of the response still to come


def continued(instance, start=CUT):
    """Follows the record from a sample on; every output's bits, phase and transitions at the end."""
    rows = instance.follow(TIME[start:], A_G[start:])
    return rows.tobytes(), instance.get("phase", "transitions")


@pytest.fixture(scope="module")
def straight(mcmanus):
    """The response without interruption, from CUT on."""
    with mcmanus.start() as instance:
        instance.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        return continued(instance)


def test_the_cut_is_in_the_middle_of_things(mcmanus, straight):
    with mcmanus.start() as instance:
        instance.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        assert 0 < instance.get("transitions") < straight[1][1] - 10


def test_set_fmu_state_goes_back(mcmanus, straight):
    with mcmanus.start() as instance:
        instance.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        state = instance.slave.getFMUstate()
        first = continued(instance)
        instance.slave.setFMUstate(state)
        instance.time = TIME[CUT]
        second = continued(instance)
        instance.slave.freeFMUstate(state)
    assert first == straight
    assert second == straight


def test_the_input_is_part_of_the_state(mcmanus):
    """A value and a slope set before the state was taken hold for the step after it is put back."""
    with mcmanus.start() as instance:
        instance.load(3.0, 400.0)
        state = instance.slave.getFMUstate()
        instance.step(0.01)
        first = instance.reals()
        instance.load(-1.0)
        instance.slave.setFMUstate(state)
        instance.time = 0.0
        instance.step(0.01)
        second = instance.reals()
        instance.slave.freeFMUstate(state)
    assert first == second


def test_serialized_state_goes_on_in_another_instance(mcmanus, straight):
    with mcmanus.start() as instance:
        instance.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        state = instance.slave.getFMUstate()
        serialized = instance.slave.serializeFMUstate(state)
        instance.slave.freeFMUstate(state)
    with mcmanus.instance() as other:
        state = other.slave.deSerializeFMUstate(serialized)
        other.slave.setFMUstate(state)
        other.slave.freeFMUstate(state)
        other.time = TIME[CUT]
        assert continued(other) == straight


def test_damaged_bytes_are_refused(mcmanus):
    with mcmanus.start() as instance:
        serialized = instance.slave.serializeFMUstate(instance.slave.getFMUstate())
        for damaged in (serialized[:-1], serialized[:-9] + bytes([serialized[-9] ^ 1]) + serialized[-8:], b""):
            with pytest.raises(Exception, match="fmi2DeSerializeFMUstate failed with status 3"):
                instance.slave.deSerializeFMUstate(damaged)
            assert "serializedState" in instance.errors[-1]


def test_interleaved_instances_do_not_touch_each_other(mcmanus, straight):
    with mcmanus.start() as one, mcmanus.start(m=100.0, r=0.9) as other:
        one.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        rows = [one.reals()]
        for i in range(CUT, len(TIME) - 1):
            slope = (A_G[i + 1] - A_G[i]) / (TIME[i + 1] - TIME[i])
            for instance, factor in ((one, 1.0), (other, -1.0)):
                instance.load(factor * A_G[i], factor * slope)
            one.step(TIME[i + 1])
            other.slave.doStep(other.time, TIME[i + 1] - TIME[i])
            other.time += TIME[i + 1] - TIME[i]
            rows.append(one.reals())
        assert other.get("transitions") > 0
        assert (np.array(rows).tobytes(), one.get("phase", "transitions")) == straight


def test_eight_threads_give_the_serial_bits(mcmanus):
    """ctypes lets go of the interpreter lock during each call, so that the instances do run side by side."""
    variants = [dict(r=0.99 - 0.02 * i, theta_0=0.001 * i) for i in range(8)]

    def run(instance):
        return instance.follow(TIME, A_G).tobytes(), instance.get("phase", "transitions")

    serial = []
    for variant in variants:
        with mcmanus.start(**variant) as instance:
            serial.append(run(instance))
    assert len({bits for bits, _ in serial}) == len(variants), "each thread is to have a response of its own"

    instances = [mcmanus.start(**variant) for variant in variants]
    parallel = [None] * len(variants)
    ready = threading.Barrier(len(variants))

    def work(i):
        ready.wait()
        parallel[i] = run(instances[i])

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(variants))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for instance in instances:
        instance.slave.freeInstance()
    assert parallel == serial


def test_reset_starts_anew(mcmanus, straight):
    with mcmanus.start(m=100.0, theta_0=0.02) as instance:
        instance.load(3.0, 400.0)
        instance.step(0.3)
        instance.slave.reset()
        instance.initialize()
        instance.follow(TIME[: CUT + 1], A_G[: CUT + 1])
        assert continued(instance) == straight


def test_reals_are_those_of_the_last_step(mcmanus):
    """Reading outputs changes nothing."""
    with mcmanus.start() as watched, mcmanus.start() as unwatched:
        for i in range(CUT):
            slope = (A_G[i + 1] - A_G[i]) / (TIME[i + 1] - TIME[i])
            for instance in (watched, unwatched):
                instance.load(A_G[i], slope)
                instance.step(TIME[i + 1])
            watched.reals(REALS)
            watched.get("phase", "transitions", "overturned")
        assert watched.reals() == unwatched.reals()
