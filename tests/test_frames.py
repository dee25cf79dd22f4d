"""A frame of one mass in the physical equations of many masses, against the FMU of one mass."""

import frames_reference
import numpy as np
import pytest
from frames import Frame
from host import G, ground_motion
from reference import MCMANUS
from restrained_reference import Ties

WEIGHT = (MCMANUS.m + MCMANUS.m0) * G


@pytest.mark.parametrize("ties", [Ties(), Ties(0.3 * WEIGHT, 2e5, 0.2, 500.0, 1e6, 0.1 * WEIGHT)], ids=["free", "tied"])
def test_a_frame_of_one_mass_moves_as_one_mass(ties, mcmanus):
    """Every transition, and u, θ and a_t at every sample, to 1e-9 of the peak; with vertical motion if tied."""
    p, start = MCMANUS, {name: getattr(MCMANUS, name) for name in ("m", "m0", "H", "B", "J0", "f_fc", "zeta_fc", "r", "g")}
    time, a_g = ground_motion("imperialValley_elCentro_1940", "elc180", 800, time_scale=5, scale=1.75)
    a_v = ground_motion("imperialValley_elCentro_1940", "up", 800, time_scale=5, scale=1.75)[1] * (ties != Ties())
    frame = Frame((p.m,), (p.H,), (p.k,), m0=p.m0, J0=p.J0, B=p.B, r=p.r, zeta=p.zeta_fc, g=p.g)
    exact = frames_reference.simulate(frame, time[1], a_g, a_v, ties)
    with mcmanus.start(tolerance=1e-12, **start, **vars(ties)) as instance:
        rows, events = instance.follow(time, a_g, ("u", "theta", "a_t"), a_v=a_v), instance.events
    assert [event.kind for event in events] == [transition.kind for transition in exact.transitions]
    assert len(events) > 10
    for name, expected in (("u", exact.u[:, 0]), ("theta", exact.theta), ("a_t", exact.a[:, 0])):
        np.testing.assert_allclose(rows[name], expected, rtol=0, atol=1e-9 * np.abs(expected).max(), err_msg=name)
