"""The scenes that test_doors.py, test_frames.py and test_frames_fmu.py leave out."""

import frames
import numpy as np
import pytest
import test_doors
import test_frames
from test_frames_fmu import over_one_fmu, softer, springs

pytest_plugins = ["test_doors", "test_frames", "test_frames_fmu"]  # for their fixtures


@pytest.mark.parametrize("number", test_doors.SCENES[25:])
def test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number):
    test_doors.test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number)


@pytest.mark.parametrize("name, motion, tied", frames.SCENES[1::2])
def test_modes_move_as_the_masses_do(name, motion, tied, program):
    test_frames.test_modes_move_as_the_masses_do(name, motion, tied, program)


@pytest.mark.parametrize("fmi", (2, 3))
def test_fifty_points_over_one_fmu_are_fifty_exports(export_frame, fmi):
    points = np.random.default_rng(fmi).uniform((1.4, 2e7, 3e8, 0.0), (2.2, 8e7, 2e9, 4e5), (50, 4)).tolist()
    over_one_fmu(export_frame, fmi, [({"B": B, "k[2]": k, "k_v": k_v, "P_0": P_0}, (softer(k, B=B), frames.Ties(P_0=P_0), springs(k_v)))
                                     for B, k, k_v, P_0 in points])
