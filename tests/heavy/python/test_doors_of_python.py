"""The scenes of test_doors.py through Python, and the matrix: each kind of structure, free, tied, shaken vertically and pushed, has each
capability at each door with the same numbers, or the refusal is here with its reason."""

import json
import subprocess
import tomllib

import flexible_rocking as fr
import numpy as np
import pandas as pd
import pytest
from test_doors import SCENES, TIES, Scene, at_end, co_simulation, command_line, export, numbered, options, write

pytest_plugins = ["test_doors"]  # for its fixture

STOREYS = [(4e4, 3.5, 6e7), (4e4, 7.0, 5e7), (3e4, 10.5, 4e7)]
MANY = [(2e4, float(i), 4e8) for i in range(1, 31)]  # 24 modes; the mass of the other six turns with the base
#: Base, storeys, ties, and what is said of the run.
STRUCTURES = {
    "rigid block": (fr.Structure(preset="mcmanus").parameters, [], dict(P_0=400, k_t=2e4, xi_d=0.2, c_d=150, k_d=2e5, F_y=120), dict(detail="rigid")),
    "one mass": (fr.Structure(preset="mcmanus").parameters, [], dict(P_0=400, k_t=2e4, xi_d=0.2, c_d=150, k_d=2e5, F_y=120), {}),
    "three storeys": (dict(m0=2e4, J0=3e4, B=1.5), STOREYS, dict(P_0=1e5, k_t=1e6, xi_d=1.0, c_d=1e5, k_d=1e7, F_y=5e4), {}),
    "24 modes": (dict(m0=1e5, J0=1e5, B=4.0), MANY, dict(P_0=5e5, k_t=5e6, xi_d=3.0, c_d=1e5, k_d=5e7, F_y=2e5), {}),
}
#: Of a kind of structure ("" is any) in a case ("" is any), a capability that it has not, and the start of the reason.
REFUSED = {
    ("three storeys", "", "estimate"): "estimate needs a structure of one mass, because Eqs 10 to 24 have one mode of vibration",
    ("24 modes", "", "estimate"): "estimate needs a structure of one mass, because Eqs 10 to 24 have one mode of vibration",
    ("", "tied", "estimate"): "Eqs 10 to 24 hold only without tendon and dissipators",
    ("", "pushed", "estimate"): ("Eqs 10 to 24 hold only without a force F_t", "unexpected argument '--force' found"),
}
WHEN = np.linspace(0.0, 2.5, 26)


@pytest.mark.filterwarnings("ignore::UserWarning")  # of records
@pytest.mark.parametrize("number", SCENES)
def test_python_has_the_command_lines_numbers(scene_of, number):
    scene = scene_of(number)
    ground = None
    if scene.arrays:
        ground = fr.Record(*scene.arrays).scaled(**scene.scales)
    elif scene.record:
        ground = fr.Record.read(scene.record, **scene.scales)
    assert found_in(fr.simulate(fr.Structure(**scene.structure), ground, duration=scene.duration, **scene.initial, **scene.how)) == {
        name: of for name, of in scene.answer.items() if name != "transitions"}


def found_in(run) -> dict:
    """The numbers of a run as `command_line` has them."""
    found = {name: (of.value, of.time) for name, of in (run.peaks | run.validity).items()}
    found |= numbered([(of.time, of.kind.split()[0]) for of in run.transitions])
    return found | at_end(run.end, {name: getattr(run, name) for name in ("end", "ending", "fall", "steps", "evaluations")})


class Doors:
    """The command line and Python on one structure in one case."""

    def __init__(self, exporter, folder, kind: str, case: str):
        base, storeys, ties, how = STRUCTURES[kind]
        self.exporter, self.folder = exporter, folder
        base = base | (ties if case == "tied" else {})
        text = "".join(f"{name} = {value!r}\n" for name, value in base.items())
        rows = "".join(f"[[storeys]]\nm = {m!r}\nh = {h!r}\nk = {k!r}\n" for m, h, k in storeys)
        self.file = folder / "structure.toml"
        self.file.write_text(f"zeta = 0.02\n[base]\n{text}{rows}" if storeys else text)
        many = dict(zeta=0.02, storeys=[dict(m=m, h=h, k=k) for m, h, k in storeys]) if storeys else {}
        self.structure = fr.Structure(**tomllib.loads(text), **many)
        time = 0.01 * np.arange(301)
        unit, peak = ("g", 0.4) if case == "pushed" else ("m/s2", 4)
        record = write(folder / "ground.csv", unit, time, peak * np.sin(9 * time))
        up = write(folder / "up.csv", "cm/s2", 0.7 * time, 300 * np.cos(20 * time)) if case == "vertical" else None
        scales = dict(scale=1.1)
        self.ground = fr.Record.read(record, record_v=up, **scales)
        push = (0.0497 * np.arange(41), 3 * (storeys[-1][0] if storeys else base["m"]) * np.sin(np.arange(41) * np.pi / 8))
        force = write(folder / "force.csv", "", *push, heading="time[s],F_t[N]") if case == "pushed" else None
        self.ground = self.ground.with_force(*push) if force else self.ground
        initial = self.initial() if case == "free" and not how else {}
        self.how = how | initial
        self.scene = Scene(dict(parameters=self.file), "CSV", record=record, vertical=up, force=force, push=push, scales=scales, how=how, initial=initial, duration=2.5, record_end=3.0)
        self.motion = options(record=record, **scales, **(dict(record_v=up) if up else {}), **(dict(force=force) if force else {}))
        self.run = fr.simulate(self.structure, self.ground, duration=2.5, **self.how)

    def initial(self) -> dict:
        """What the floors do while the structure rocks."""
        response = fr.simulate(self.structure, self.ground).at(0.5)
        return {f"{name}_0": [float(of[0]) for column, of in response.items() if column.partition("[")[0] == name] for name in ("u", "u_dot")}

    def shell(self, command: str, *more, structure=True):
        of = options(parameters=self.file) if structure else []
        done = subprocess.run([self.exporter, "--quiet", command, *of, *map(str, more)], cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            raise ValueError([line for line in done.stderr.splitlines() if line.startswith("error: ")][-1].removeprefix("error: "))
        return done.stdout

    def told(self, *arguments):
        return json.loads(self.shell(*arguments, "--format", "json"))

    def table(self, name: str) -> pd.DataFrame:
        return pd.read_csv(self.folder / name)

    def swept(self, text: str, **initial) -> pd.DataFrame:
        text += f"\ninitial = {{ {', '.join(f'{name} = {of}' for name, of in initial.items())} }}" if initial else ""
        (self.folder / "sweep.toml").write_text(f"{text}\n[[structures]]\nname = 'structures'\nfile = 'structure.toml'\n")
        (self.folder / "rows.csv").unlink(missing_ok=True)
        self.shell("sweep", "sweep.toml", "-o", "rows.csv", structure=False)
        return self.table("rows.csv")


def numbers_of(structure) -> dict:
    modes = structure.mode_table if "storeys" in structure.parameters else {}
    own = {} if modes else structure.parameters
    return own | structure.derived | {f"{name}[{i + 1}]": of[i] for name, of in modes.items() for i in range(len(of))}


def response(door):
    door.shell("simulate", *door.motion, *options(duration=2.5, interval=0.1, output="out.csv", **door.how))
    return door.table("out.csv").rename(columns=lambda name: name.rpartition("[")[0] or name).to_dict("list")


def spectra(door):
    door.shell("simulate", *door.motion, *options(duration=2.5, spectrum="floors.csv", **door.how))
    return door.table("floors.csv").iloc[:, 1:].to_numpy().T.tolist()


def pushed(door):
    door.shell("pushover", "--points", 5, "-o", "push.csv")
    return [door.table("push.csv")[name].tolist() for name in ("theta[rad]", "u[m]", "delta_t[m]", "P[N]", "M[N.m]")]


def advised(door):
    rows = [row for row in door.told("advise", *door.motion, *options(duration=2.5, **door.scene.initial))["rows"] if row["level"] not in ("reference", "auto without a_v")]
    return [(row["level"], row.get("keep"), float(row["error_theta"]), float(row["error_a_t"]), row["steps"]) for row in rows]


def beside(door):
    return ", record_v = 'up.csv'" * bool(door.scene.vertical) + ", force = 'force.csv'" * bool(door.scene.force)


PULSES = "[pulses]\nshape = 'sine'\nfrequency = [2.0, 5.0]\namplitude = [1.5, 6.0]\ndimensionless = true"
MAPPED = ["frequency[Hz]", "amplitude[m/s2]", "fate", "impacts", "theta_max/alpha_cg", "transitions", "end[s]"]
#: What each door has, in the same form: first the command line, then Python.
CAPABILITIES = {
    "describe": (lambda door: {of["name"]: of["value"] for of in door.told("describe")}, lambda door: numbers_of(door.structure)),
    "simulate": (lambda door: {name: of for name, of in command_line(door.exporter, door.scene, door.folder).items() if name != "transitions"},
                 lambda door: found_in(door.run)),
    "response": (response, lambda door: {name: of.tolist() for name, of in door.run.at(WHEN).items()}),
    "floor spectrum": (spectra, lambda door: [door.run.spectrum(i + 1)["S_a"].tolist() for i in range(len(door.run.profile["h"]))]),
    "advise": (advised, lambda door: [(of["level"], of.get("keep"), of["theta"], of["a_t"], of["steps"])
                                      for of in fr.advise(door.structure, door.ground, duration=2.5, **door.scene.initial).levels]),
    "estimate": (lambda door: {of["name"]: of["value"] for of in door.told("estimate", *door.motion)["rows"] if "f_r" not in of["name"]},
                 lambda door: dict(fr.estimate(door.structure, door.ground))),
    "pushover": (pushed, lambda door: [of.tolist() for of in door.structure.pushover(5).values()]),
    "restoring": (lambda door: [of["moment"] for of in door.told("describe", "--restoring", 0.02)],
                  lambda door: door.structure.restoring(0.02)["moment"].tolist()),
    "sweep": (lambda door: door.swept(f"records = [{{ file = 'ground.csv', scale = 1.1{beside(door)} }}]\nscale = [0.8, 1.2]", **door.scene.initial).filter(regex="peak_|scale").to_dict("list"),
              lambda door: fr.sweep(door.structure, door.ground, scale=[0.8, 1.2], **door.scene.initial).filter(regex="peak_|scale").to_dict("list")),
    "map": (lambda door: door.swept(PULSES).sort_values(["amplitude[m/s2]", "frequency[Hz]"])[MAPPED].to_dict("list"),
            lambda door: fr.overturning_map(door.structure, frequency=[2, 5], amplitude=[1.5, 6])[MAPPED].to_dict("list")),
}


@pytest.mark.filterwarnings("ignore::UserWarning")  # of records
@pytest.mark.parametrize("case", ["free", "tied", "vertical", "pushed"])
@pytest.mark.parametrize("kind", STRUCTURES)
def test_each_door_has_each_capability_or_says_why_not(exporter, tmp_path, kind, case):
    door = Doors(exporter, tmp_path, kind, case)
    assert len(door.run.transitions) > 2
    for name, doors in CAPABILITIES.items():
        reasons = [why for (of, when, what), why in REFUSED.items() if what == name and of in ("", kind) and when in ("", case)]
        if reasons:
            for ask in doors:
                with pytest.raises(ValueError) as refused:
                    ask(door)
                assert any(str(refused.value).startswith(why) for why in reasons), (name, refused.value)
            continue
        shell, python = (ask(door) for ask in doors)
        assert shell == python, name
    told = command_line(exporter, door.scene, tmp_path)
    expected = {name: of for name, of in told.items() if name not in ("a_g", "ending", "steps", "evaluations")}
    door.scene.answer = told
    found = co_simulation(export(exporter, door.scene, 2, tmp_path), door.scene)
    assert found.keys() - TIES == expected.keys() - TIES
    for name, of in expected.items():
        assert found[name] == pytest.approx(of, rel=1e-9, abs=0) or 0 < max(abs(found[name][0]), abs(of[0])) < 1e-14, name  # rounding
