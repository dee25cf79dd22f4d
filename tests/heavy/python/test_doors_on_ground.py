"""A hundred random structures on ground that slips and yields, through every door: command line, Python, sweep, FMU 2.0 and FMU 3.0."""

import re
from random import Random

import flexible_rocking as fr
import numpy as np
import pytest
from frames import Frame, ties_of, toml
from test_doors import TIES, Scene, co_simulation, command_line, export, write
from test_doors_of_python import found_in


def random_scene(number: int, folder) -> Scene:
    """Of 1 to 5 storeys, free or tied, on 2 to 11 points that may settle under a base that may slide, shaken with or without a_v."""
    random = Random(number)
    count, B = random.randint(1, 5), random.uniform(1.2, 3)
    heights = tuple(3.2 * i for i in range(1, count + 1))
    frame = Frame((4e4,) * count, heights, tuple(5e7 * random.uniform(0.5, 2) for _ in heights), m0=3e4, J0=4e4 * B**2 / 3, B=B, zeta=0.03)
    ground = dict(f_v=random.uniform(3, 20), zeta_v=random.uniform(0.05, 0.6), n_points=random.choice([2, 3, 5, 11]))
    kinds = random.choice([("mu_c",), ("fs",), ("mu_c", "fs")])
    ground |= {name: of for name, of in dict(mu_c=random.uniform(0.05, 0.6), fs=random.uniform(1.2, 5)).items() if name in kinds}
    file = folder / "structure.toml"
    ties = {"ties": ties_of(frame, random.uniform(0, 0.3))} if random.random() < 0.3 else {}
    file.write_text(toml(frame, **ties, ground="\n".join(f"{name} = {of}" for name, of in ground.items())).replace("r = None\n", ""))
    time = 0.01 * np.arange(201)
    strength = random.uniform(0.5, 2.5) * frame.g * B / (frame.S_1 / frame.m_t)  # 1 lifts a rigid block
    a_g = strength * np.sin(2 * np.pi * random.uniform(0.7, 3) * time) * np.sin(np.pi * time / 2)
    scene = Scene(dict(parameters=file), "CSV", record=write(folder / "ground.csv", "m/s2", time, a_g), record_end=time[-1])
    if random.random() < 0.4:
        scene.vertical = write(folder / "up.csv", "m/s2", time, random.uniform(0.1, 0.9) * frame.g * np.cos(17 * time))
    if random.random() < 0.3:
        scene.how = dict(detail=random.choice(["rigid", "nonlinear"]), tolerance=1e-8)
    return scene


@pytest.mark.filterwarnings("ignore::UserWarning")  # of records
@pytest.mark.parametrize("number", range(100))
def test_every_door_has_the_same_numbers(exporter, tmp_path, number):
    scene = random_scene(number, tmp_path)
    scene.answer = command_line(exporter, scene, tmp_path)
    ground = fr.Record.read(scene.record, record_v=scene.vertical)
    structure = fr.Structure.read(scene.structure["parameters"])
    run = fr.simulate(structure, ground, **scene.how)
    assert found_in(run) == {name: of for name, of in scene.answer.items() if name != "transitions"}
    last, row = run.at(run.end), fr.sweep(structure, ground, **scene.how).iloc[0]
    row = {re.sub(r"\[\D[^]]*\]$", "", name): of for name, of in row.items()}
    for name, of in run.residuals.items():
        assert name.endswith("_res") or of == last[name.removesuffix("_end")][0], name
        assert row[name] == abs(of), name
    for name, of in run.peaks.items():
        assert name == "a_g" or row[f"peak_{name}"] == of.value, name
    expected = {name: of for name, of in scene.answer.items() if name not in ("a_g", "ending", "steps", "evaluations")}
    found, of_3 = (co_simulation(export(exporter, scene, fmi, tmp_path), scene) for fmi in (2, 3))
    assert of_3 == found
    assert found.keys() - TIES == expected.keys() - TIES
    for name, of in expected.items():
        is_exact = max(of[1], found[name][1]) <= scene.record_end
        has_instant = not re.match(r"N|pressure", name)  # a point may reach its capacity many times
        same = lambda value: pytest.approx(value, rel=1e-13 if is_exact else 1e-9, abs=0)
        assert found[name][0] == same(of[0]) and (found[name][1] == same(of[1]) or not has_instant), (name, found[name], of)
