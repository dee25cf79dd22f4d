"""The scenes of test_doors.py through Python."""

import flexible_rocking as fr
import pytest
from test_doors import SCENES, at_end, numbered, scene_of  # noqa: F401


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
