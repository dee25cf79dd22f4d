"""The scenes of test_doors.py through Python, and the last of them through the FMUs."""

import flexible_rocking as fr
import pytest
import test_doors
from test_doors import LEVELS, SCENES, at_end, numbered, scene_of  # noqa: F401


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


@pytest.mark.filterwarnings("ignore::UserWarning")  # of records
@pytest.mark.parametrize("number", SCENES)
def test_python_has_the_command_lines_numbers(scene_of, number):
    scene = scene_of(number)
    ground = None
    if scene.arrays:
        ground = fr.Record(*scene.arrays).scaled(**scene.scales)
    elif scene.record:
        ground = fr.Record.read(scene.record, **scene.scales)
    run = fr.simulate(fr.Structure(**scene.structure), ground, duration=scene.duration, **scene.initial, **scene.how)
    found = {name: (of.value, of.time) for name, of in (run.peaks | run.validity).items()}
    found |= numbered([(of.time, of.kind.split()[0]) for of in run.transitions])
    found |= at_end(run.end, {name: getattr(run, name) for name in ("end", "ending", "fall", "steps", "evaluations")})
    assert found == {name: of for name, of in scene.answer.items() if name != "transitions"}
