"""Random scenes through every door: command line, FMU 2.0, FMU 3.0, Python and the page give the same numbers.

docs/reference/runs.md has the rules. Numbers are equal to the bit, but for an FMU's last digits after the record."""

import functools
import json
import re
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from random import Random

import fmpy
import numpy as np
import pandas as pd
import pytest
from evidence.scenes import RECORD
from host import PHASES, Fmu, output, simulate, write
from reference import EVISON, MCMANUS, Structure

LEVELS = ("auto", "nonlinear", "linear", "modal", "rigid", "fixed_base")
VALIDITY = ("tension_max", "R_v_min", "mu_required", "mu_impact", "tension_impact", "energy_gain_max", "weight_min")
TIES = {"P_t", "F_d1", "F_d2"}  # the FMU of one mass has their peaks in any case
#: Kinds of transitions by the words of an FMU.
TOLD = {"contact point": "ground", "the base sticks": "stick", "the base slides": "slip", "the base leaves": "flight"}
GROUNDS = ("AT2", "CSV", "arrays", "arrays with a_v", "free")
SCENES = range(40)  # the last 15 in tests/heavy


@dataclass
class Scene:
    """A simulation; `answer` is the command line's."""

    structure: dict  # numbers by name, and the preset
    ground: str
    record: Path | None = None
    vertical: Path | None = None
    force: Path | None = None
    push: tuple = ()  # s, N
    arrays: list = field(default_factory=list)  # s, m/s2, m/s2
    scales: dict = field(default_factory=dict)
    initial: dict = field(default_factory=dict)
    how: dict = field(default_factory=dict)  # detail, tolerance
    duration: float | None = None
    start: float = 0.0
    record_end: float = 0.0
    answer: dict = field(default_factory=dict)


def random_structure(random: Random) -> tuple[Structure, dict]:
    """It for the reference, and as numbers by name."""
    preset, base = random.choice([("mcmanus", MCMANUS), ("evison", EVISON)])
    changed = dict(f_fc=random.uniform(2, 12), r=random.uniform(0.85, 1), m0=random.uniform(0, 80), g=random.choice([1.62, 9.80665]))
    changed = {name: changed[name] for name in random.sample(list(changed), random.randrange(5))}
    structure = replace(base, **changed)
    numbers = {"preset": preset} | changed if random.random() < 0.5 else asdict(structure)
    weight = (structure.m + structure.m0) * structure.g
    if random.random() < 0.4:
        numbers |= dict(P_0=random.uniform(0, 0.5) * weight, k_t=random.uniform(0, 20) * weight / structure.B)
    if random.random() < 0.2:
        numbers |= dict(xi_d=structure.B, c_d=0.01 * weight / structure.B, k_d=50 * weight / structure.B, F_y=0.1 * weight)
    return structure, numbers


def random_scene(number: int, folder: Path) -> Scene:
    random = Random(number)
    structure, numbers = random_structure(random)
    scene = Scene(numbers, GROUNDS[number % len(GROUNDS)])
    strength = random.uniform(1, 10) * structure.g * structure.tan_alpha_cg  # m/s2; 1 lifts a rigid block
    if scene.ground == "free":
        scene.duration = scene.record_end = 10.0
        scene.initial = dict(theta_0=random.uniform(-1.1, 1.1) * structure.alpha_cg, u_0=random.uniform(-1, 1) * structure.u_cr)
    elif scene.ground == "AT2":
        scene.record = RECORD
        scene.scales = dict(scale=strength / (1.17 * structure.g), time_scale=random.choice([0.2, 0.5, 1.0]))
        scene.record_end = 4171 * 0.01 * scene.scales["time_scale"]
    else:
        scene.start = random.choice([0.0, 0.0, 3.7])
        time = scene.start + np.cumsum([0.0, *(random.choice([0.01, 0.007]) for _ in range(299))])
        phase = 2 * np.pi * random.uniform(1, 3) * (time - scene.start)
        a_g = strength * np.sin(phase)
        if scene.ground == "CSV":
            scene.record = write(folder / f"{number}.csv", "cm/s2", time, 100 * a_g)
            scene.scales = random.choice([{}, dict(scale=1.3), dict(scale=0.7, time_scale=0.8)])
        else:
            scene.record, scene.arrays = write(folder / f"{number}.csv", "m/s2", time, a_g), [time, a_g]
        if scene.ground == "arrays with a_v":
            scene.arrays.append(random.uniform(0, 1.1) * structure.g * np.cos(3 * phase))
            scene.vertical = write(folder / f"{number}v.csv", "m/s2", time, scene.arrays[2])
        time_scale = scene.scales.get("time_scale", 1.0)
        scene.start, scene.record_end = time[0] * time_scale, time[-1] * time_scale
        scene.duration = random.choice([None, None, None, 1.2345])
    if random.random() < 0.6:
        can = LEVELS if numbers.keys().isdisjoint({"P_0", "xi_d"}) and not scene.vertical else ("nonlinear", "linear", "rigid")
        scene.how = dict(detail=random.choice(can), tolerance=random.choice([1e-9, 1e-6]))
        if scene.how["detail"] == "rigid":
            scene.initial.pop("u_0", None)
        elif scene.how["detail"] == "fixed_base":
            scene.initial.pop("theta_0", None)
    return scene


def options(**values) -> list[str]:
    text = {name: ",".join(map(str, value)) if isinstance(value, list) else value for name, value in values.items()}
    return [f"--{name.replace('_', '-')}={value}" for name, value in text.items()]


def command_line(exporter: Path, scene: Scene, folder: Path) -> dict:
    """Every number, and the instant that decides it: peaks, worsts, transitions, and how the run ended."""
    ground = options(record=scene.record, **scene.scales) if scene.record else []
    ground += options(**{name: of for name, of in (("record_v", scene.vertical), ("force", scene.force)) if of})
    ground += options(duration=scene.duration) if scene.duration else []
    told = json.loads(output(exporter, "--quiet", "simulate", *ground, *options(**scene.structure, **scene.initial, **scene.how),
                             "--format", "json", "--events", "events.csv", cwd=folder))
    events = pd.read_csv(folder / "events.csv")
    transitions = list(zip(events["time[s]"], events["kind"].str.split().str[0]))
    rows = {row["name"]: (float(row.get("peak", row.get("value"))), row["time"]) for row in told["peaks"] + told["validity"]}
    counted = {name: told[name] for name in ("transitions", "end", "ending", "fall", "steps", "evaluations")}
    return rows | numbered(transitions) | at_end(told["end"], counted)


def numbered(transitions: list) -> dict:
    return {f"{kind} {number}": (time, time) for number, (time, kind) in enumerate(transitions)}


def at_end(end: float, counted: dict) -> dict:
    return {name: (value, end) for name, value in counted.items() if value is not None}


@pytest.fixture(scope="session")
def scene_of(exporter, tmp_path_factory):
    """Makes the scene of a number, with the command line's answer."""
    folder = tmp_path_factory.mktemp("scenes")

    @functools.cache
    def make(number: int) -> Scene:
        scene = random_scene(number, folder)
        scene.answer = command_line(exporter, scene, folder)
        return scene

    return make


def export(exporter: Path, scene: Scene, fmi: int, folder: Path) -> Path:
    fmu = folder / f"{fmi}.fmu"
    files = [f"--{name}={path}" for name, path in (("record", scene.record), ("record-v", scene.vertical)) if path]
    output(exporter, "--quiet", "export", f"--fmi={fmi}", *options(**scene.structure), *files, "-o", fmu)
    return fmu


def co_simulation(fmu: Path, scene: Scene) -> dict:
    """The same of an FMU, the record inside, that fmpy steps to the end in one step."""
    end, overturns = scene.answer["end"][0], scene.answer["ending"][0] == "overturned"
    until = max(end, scene.record_end) + 1 if overturns else end
    values = {f"record_{name}": value for name, value in scene.scales.items()}
    for name, of in scene.initial.items():
        values |= {f"{name}[{i}]": number for i, number in enumerate(of, 1)} if np.size(of) > 1 else {name: np.ravel(of)[0]}
    values |= dict(peaks=True, validity=True, detail=1 + LEVELS.index(scene.how.get("detail", "auto")))
    names = {variable.name for variable in fmpy.read_model_description(str(fmu)).modelVariables}
    peaks = {name.removeprefix("t_") for name in names if re.fullmatch(r"t_.*_max(\[\d+\])?|t_mu_.*|t_R_v_min|t_tension_impact|t_weight_min", name)}
    asked = [*peaks, *(f"t_{name}" for name in peaks), "transitions", "phase", "t_overturned"]
    tolerance = scene.how.get("tolerance", 1e-9)
    if scene.force:
        floors = sum(name.startswith("F_t[") for name in names)
        time, F_t = np.append(scene.push[0], until), np.append(scene.push[1], 0.0)
        with Fmu(fmu).start(tolerance=tolerance, **values) as instance:
            instance.follow(time, 0 * time, ["theta"], **{f"F_t[{floors}]" if floors else "F_t": F_t})
            last, messages = dict(zip(asked, instance.get(*asked))) | {"time": until}, instance.messages
    else:
        rows, messages = simulate(str(fmu), start_time=scene.start, stop_time=until, output_interval=until - scene.start,
                                  start_values=values, relative_tolerance=tolerance, output=asked, record_events=False,
                                  fmi_type="CoSimulation")
        last = rows[-1]
    said = [message.text for message in messages]
    end = last["t_overturned"] if last["phase"] == PHASES["overturned"] else last["time"]
    found = {name if name in VALIDITY else re.sub(r"_max(?=\[|$)", "", name): (last[name], last[f"t_{name}"]) for name in peaks}
    kinds = "|".join(["uplift", "impact", "landing", "overturning", "yielding", "unloading", "release", "touch", "tendon", *TOLD])
    transitions = [(text, re.match(rf"t = (\S+) s: ({kinds})", text)) for text in said]
    transitions = [(float(of[1]), "settling" if "contact is held" in text else TOLD.get(of[2], of[2])) for text, of in transitions if of]
    fall = [float(of[1]) for text in said if (of := re.search(r"its fall began at t = (\S+) s", text))]
    counted = dict(transitions=last["transitions"], end=end, fall=fall[0] if fall else None)
    return found | numbered(transitions) | at_end(end, counted)


@pytest.mark.parametrize("number", SCENES[:25])
def test_both_fmus_have_the_command_lines_numbers(scene_of, exporter, tmp_path, number):
    scene = scene_of(number)
    expected = {name: of for name, of in scene.answer.items() if name not in ("a_g", "ending", "steps", "evaluations")}
    found, of_3 = (co_simulation(export(exporter, scene, fmi, tmp_path), scene) for fmi in (2, 3))
    assert of_3 == found
    assert found.keys() - TIES == expected.keys() - TIES
    for name, of in expected.items():
        is_exact = (expected["end"][1] if name in VALIDITY else max(of[1], found[name][1])) <= scene.record_end
        assert found[name] == pytest.approx(of, rel=0 if is_exact else 1e-9, abs=0), name
