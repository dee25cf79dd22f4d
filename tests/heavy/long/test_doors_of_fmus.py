"""All scenes of test_doors.py are made, and the last of them go through the FMUs."""

import pytest
import test_doors
from test_doors import LEVELS, SCENES, scene_of  # noqa: F401


def test_the_scenes_are_of_all_kinds(scene_of):
    scenes = [scene_of(number) for number in SCENES]

    def count(is_meant):
        return sum(map(is_meant, scenes))

    assert [count(lambda of: of.answer["ending"][0] == ending) > 3 for ending in ("at rest", "overturned", "at time")] == [True] * 3
    assert count(lambda of: of.structure.get("g", 9.81) != 9.81) > 9 and count(lambda of: "preset" in of.structure) > 9
    assert count(lambda of: "k_t" in of.structure) > 9 and count(lambda of: "k_d" in of.structure) > 3
    assert count(lambda of: of.start != 0) > 3 and {of.how.get("detail") for of in scenes} >= set(LEVELS[1:])
    assert count(lambda of: of.answer["transitions"][0] > 10) > 20


@pytest.mark.parametrize("number", SCENES[25:])
def test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number):
    test_doors.test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number)
