"""The scenes that test_frames.py leaves out."""

import pytest
import test_frames
from frames import SCENES
from test_frames import program  # noqa: F401


@pytest.mark.parametrize("name, motion, tied", SCENES[1::2])
def test_modes_move_as_the_masses_do(name, motion, tied, program):
    test_frames.test_modes_move_as_the_masses_do(name, motion, tied, program)
