"""The scenes that test_doors.py and test_frames.py leave out."""

import frames
import pytest
import test_doors
import test_frames

pytest_plugins = ["test_doors", "test_frames"]  # for their fixtures


@pytest.mark.parametrize("number", test_doors.SCENES[25:])
def test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number):
    test_doors.test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number)


@pytest.mark.parametrize("name, motion, tied", frames.SCENES[1::2])
def test_modes_move_as_the_masses_do(name, motion, tied, program):
    test_frames.test_modes_move_as_the_masses_do(name, motion, tied, program)
