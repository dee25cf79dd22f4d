"""The page of `make explore`: its numbers beside the command line's in Chromium and Firefox, its controls, its messages."""

import json
import os
import shutil
import socket
import subprocess
import time
import zipfile
from pathlib import Path
from urllib.parse import urlencode

import pytest
from first_run import RECORD, SCALE, TIME_SCALE
from test_view import browser, new_page, number, wait  # noqa: F401

pytestmark = pytest.mark.heavy

PAGE = Path(__file__).parents[1] / "out" / "explore.html"
PACOIMA = {"ground": "record", "scale": str(SCALE), "time_scale": str(TIME_SCALE)}

#: What is computed by the page and by the command line. Those under the record follow the file that both read.
SCENES = [
    *({"preset": preset, "detail": detail, **PACOIMA}
      for preset in ("mcmanus", "evison") for detail in ("auto", "nonlinear", "linear", "modal", "rigid", "fixed_base")),
    PACOIMA | {"scale": "2.2"},
    PACOIMA | {"r": "0.85", "f_fc": "9"},
    PACOIMA | {"weight": "2.5", "alpha_cg": "0.2"},
    PACOIMA | {"tolerance": "1e-6", "time_scale": "0.5"},
    {"ground": "ricker", "amplitude": "0.7", "frequency": "1.5"},
    {"ground": "mavroeidis_papageorgiou", "amplitude": "0.5", "cycles": "1.7", "phase": "0.4"},
    {"ground": "synthetic", "seed": "7", "amplitude": "0.8"},
    {"ground": "free", "duration": "8", "theta_0": "0.1", "u_0": "0.001"},
]

COMPUTED = """([fields, record]) => {
    const explorer = new wasm_bindgen.Explorer();
    explorer.take_record("record.AT2", new TextEncoder().encode(record));
    const scene = JSON.stringify(fields);
    return [explorer.peaks(scene), fields.ground === "free" ? "" : explorer.record_file(scene)];
}"""


@pytest.fixture
def opened(new_page):
    def opened(scene=None, **options):
        page = new_page(f"{PAGE.as_uri()}#{urlencode(scene or {})}", **options)
        page.locator("body[data-ready]").wait_for()
        return page

    return opened


def by_command_line(exporter, folder, fields: dict, record: str) -> dict:
    """The summary of `simulate` for a scene of the page; `record` is the page's own where it is no pulse."""
    options = dict(fields)
    ground = options.pop("ground")
    name = {name: options.pop(name, None) for name in ("amplitude", "frequency", "cycles", "phase", "seed", "duration")}
    if ground == "record":
        motion = ["--record", RECORD]
    elif ground == "free":
        motion = ["--free", name["duration"]]
    elif ground == "synthetic":
        (folder / "ground.csv").write_text(record)
        motion = ["--record", "ground.csv"]
    else:
        name["frequency"] = name["frequency"] or "2"
        numbers = [f"--{key}={value}" for key, value in name.items() if value]
        subprocess.run([exporter, "--quiet", "pulse", ground, *numbers, "-o", "ground.csv"], cwd=folder, check=True, capture_output=True)
        motion = ["--record", "ground.csv"]
    given = options.keys() - {"preset", "detail", "tolerance", "scale", "time_scale", "theta_0", "u_0"}
    if given:
        options.setdefault("preset", "mcmanus")
    arguments = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
    done = subprocess.run([exporter, "--quiet", "simulate", *motion, *arguments, "--format", "json"],
                          cwd=folder, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def agree(exporter, folder, evaluate):
    """Every digit of every scene is the command line's."""
    for fields in SCENES:
        answer, record = evaluate([fields, RECORD.read_text()])
        ours, theirs = json.loads(answer), by_command_line(exporter, folder, fields, record)
        rows = {row["name"]: row for row in theirs["peaks"]}
        for name, peak, instant in ours["peaks"]:
            assert (peak, instant) == (rows[name]["peak"], rows[name]["time"]), (fields, name)
        assert (ours["transitions"], ours["end"]) == (theirs["transitions"], theirs["end"]), fields


def test_numbers_are_the_command_lines_in_chromium(opened, exporter, tmp_path):
    page = opened()
    agree(exporter, tmp_path, lambda given: page.evaluate(COMPUTED, given))
    assert PAGE.stat().st_size <= 2.5e6


class Firefox:
    """Firefox as its own remote protocol, Marionette, drives it: messages of JSON behind their length."""

    def __init__(self, program: str, profile: Path):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        (profile / "user.js").write_text(f'user_pref("marionette.port", {port});\n')
        environment = os.environ | {"MOZ_HEADLESS": "1", "HOME": str(profile)}
        self.process = subprocess.Popen([program, "--marionette", "--profile", profile], env=environment,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(300):
            try:
                self.socket = socket.create_connection(("127.0.0.1", port), timeout=120)
                break
            except ConnectionRefusedError:
                time.sleep(0.1)
        self.stream = self.socket.makefile("rb")
        self.read()
        self.command("WebDriver:NewSession", {})

    def read(self):
        length = b""
        while not length.endswith(b":"):
            length += self.stream.read(1)
        return json.loads(self.stream.read(int(length[:-1])))

    def command(self, name: str, parameters: dict):
        message = json.dumps([0, 1, name, parameters])
        self.socket.sendall(f"{len(message)}:{message}".encode())
        _, _, error, result = self.read()
        assert error is None, error
        return result

    def evaluate(self, script: str, *arguments):
        return self.command("WebDriver:ExecuteScript", {"script": script, "args": arguments, "sandbox": None})["value"]


@pytest.fixture
def firefox(tmp_path_factory):
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    if not program:
        pytest.skip("Firefox is not there: make browser")
    firefox = Firefox(program, tmp_path_factory.mktemp("firefox"))
    yield firefox
    firefox.stream.close()
    firefox.socket.close()
    firefox.process.terminate()
    firefox.process.wait()


def test_numbers_are_the_command_lines_in_firefox(firefox, exporter, tmp_path):
    firefox.command("WebDriver:Navigate", {"url": PAGE.as_uri()})
    for _ in range(300):
        if firefox.evaluate("return document.body.dataset.ready !== undefined"):
            break
        time.sleep(0.1)
    shown = firefox.evaluate('return document.querySelector("#histories path.curve").getAttribute("d").length')
    assert shown > 100

    def evaluate(given):  # by a script of the page itself: Marionette's do not see what the page declares
        return firefox.evaluate("""
            const script = document.createElement("script");
            script.textContent = `document.body.dataset.answer = JSON.stringify((${arguments[0]})(${JSON.stringify(arguments[1])}))`;
            document.body.append(script);
            return JSON.parse(document.body.dataset.answer);""", COMPUTED, given)

    agree(exporter, tmp_path, evaluate)


def drop(page, name: str, content: bytes) -> None:
    page.locator("#file").set_input_files({"name": name, "mimeType": "text/plain", "buffer": content})


def settled(page) -> None:
    """Waits until what was asked for is shown exactly."""
    page.wait_for_timeout(400)


def test_a_record_is_dropped_shown_and_moved(opened):
    page = opened({"scale": str(SCALE), "time_scale": str(TIME_SCALE)})
    drop(page, RECORD.name, RECORD.read_bytes())
    settled(page)
    assert "PEER AT2" in page.locator("#remarks").text_content()
    peak = lambda name: number(page.locator(f"tr[data-name={name}] td").nth(1).text_content())
    assert abs(peak("theta") - 0.0120001) < 1e-6
    assert page.locator("#validity summary").text_content().endswith("3 of 6 limits are passed")
    before = page.locator("path.curve[data-name=theta]").get_attribute("d")
    slider = page.locator(".row[data-name=H] input[type=range]")
    slider.evaluate("slider => { slider.value = 0.6; slider.dispatchEvent(new Event('input', { bubbles: true })); }")
    settled(page)
    assert float(page.locator("#field-H").input_value()) > 1.84
    assert page.locator("path.curve[data-name=theta]").get_attribute("d") != before
    assert "H=2.79" in page.url


def test_what_is_refused_is_said_as_everywhere_and_the_page_stays_alive(opened, exporter, tmp_path):
    page = opened()
    problem = page.locator("#problem")
    for name, text in [("H", "NaN"), ("r", "1.5"), ("B", "-0.3"), ("H", "300")]:
        field = page.locator(f"#field-{name}")
        field.fill(text)
        problem.wait_for()
        refused = subprocess.run([exporter, "simulate", "--preset=mcmanus", f"--{name}={text}", "--free=1"], capture_output=True, text=True)
        assert refused.stderr.strip() == f"error: {problem.text_content()}"
        field.fill("")
        problem.wait_for(state="hidden")
    page.locator("#field-m").fill("heavy")
    problem.wait_for()
    assert problem.text_content() == 'm = "heavy": invalid float literal'
    page.locator("#reset").click()
    problem.wait_for(state="hidden")
    for number, content in enumerate([b"", b"\x00\xff\xfe", b"0,1\n1,?\n", b"PEER\nx\nVELOCITY\nNPTS= 9, DT= .01\n1 2"]):
        (tmp_path / f"bad{number}.csv").write_bytes(content)
        drop(page, f"bad{number}.csv", content)
        problem.wait_for()
        refused = subprocess.run([exporter, "--quiet", "simulate", "--record", f"bad{number}.csv"], cwd=tmp_path, capture_output=True, text=True)
        assert refused.stderr.startswith(f"error: {problem.text_content()}"), problem.text_content()
        page.select_option("#ground", "sine")
        problem.wait_for(state="hidden")


def test_natural_quantities_take_the_place_of_parameters(opened):
    page = opened()
    page.locator("#natural").check()
    page.locator(".row[data-name=B]").wait_for(state="hidden")
    page.locator("#field-width").fill("0.8")
    settled(page)
    page.locator("#natural").uncheck()
    assert page.locator("#field-B").input_value() == "0.4"
    page.locator("#field-B").fill("0.5")
    settled(page)
    assert "B=0.5" in page.url and "width" not in page.url


def test_levels_are_compared_and_a_scene_is_pinned(opened, exporter):
    page = opened(PACOIMA | {"tab": "compare"})
    drop(page, RECORD.name, RECORD.read_bytes())
    page.locator("#levels tr.advised").wait_for()
    page.wait_for_timeout(500)
    advised = subprocess.run([exporter, "advise", "--record", RECORD, "--time-scale", str(TIME_SCALE), "--scale", str(SCALE), "--format", "json"],
                             check=True, capture_output=True, text=True).stdout
    advised = next(row["level"] for row in json.loads(advised)["rows"] if row.get("advised"))
    assert page.locator("#levels tr.advised").get_attribute("data-detail") == advised
    curves = page.locator("path.curve[data-name=theta]")
    assert curves.count() == 2  # fixed base beside it
    page.locator("#levels input[name=rigid]").check()
    page.locator("#pin").click()
    assert curves.count() == 4
    page.locator("#levels input[name=fixed_base]").uncheck()
    assert curves.count() == 3


def test_the_map_fills_in_and_a_click_shows_the_run(opened):
    page = opened({"tab": "map"})
    canvas = page.locator("#spectrum")
    colours = """canvas => {
        const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
        const context = copy.getContext("2d", { willReadFrequently: true });
        context.drawImage(canvas, 0, 0);
        const data = new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
        return [data.filter(pixel => pixel === 0).length, new Set(data).size];
    }"""
    wait(page, lambda: canvas.evaluate(colours)[0] == 0)
    assert canvas.evaluate(colours)[1] >= 4
    box = canvas.bounding_box()
    for across, up, ends in [(0.2, 0.9, "overturned"), (0.95, 0.3, "at rest in the end")]:
        page.mouse.click(box["x"] + across * box["width"], box["y"] + (1 - up) * box["height"])
        settled(page)
        assert page.locator("#about").text_content().endswith(ends)


def test_speed_is_shown_against_accuracy(opened):
    page = opened({"tab": "speed", "step": "0.0005"})
    chart = page.locator("#precision circle")
    wait(page, lambda: chart.count() == 22)
    rows = page.locator("#methods tbody tr")
    engine, rk4 = (float(rows.nth(i).locator("td").first.text_content()) for i in (0, 1))
    assert engine < 1e-9 < 1e-6 < rk4


def test_what_is_taken_along_is_what_the_command_line_makes(opened, exporter, tmp_path):
    page = opened({"tab": "take", "m": "150"})
    drop(page, "record.csv", b"time[s],a_g[g]\n0,0\n0.2,0.6\n0.4,-0.6\n0.6,0\n")
    settled(page)
    with page.expect_download() as download:
        page.locator("#fmu").click()
    download.value.save_as(tmp_path / "page.fmu")
    (tmp_path / "record.csv").write_bytes(b"time[s],a_g[g]\n0,0\n0.2,0.6\n0.4,-0.6\n0.6,0\n")
    library = exporter.with_name("deps") / "libFlexibleRocking.so"
    subprocess.run([exporter, "--quiet", "export", "--preset=mcmanus", "--m=150", "--record", "record.csv", "--library", library, "-o", "own.fmu"],
                   cwd=tmp_path, check=True)
    content = lambda name: {entry: zipfile.ZipFile(tmp_path / name).read(entry) for entry in zipfile.ZipFile(tmp_path / name).namelist()}
    assert content("page.fmu") == content("own.fmu")
    command = page.locator("#command").text_content()
    assert command == "rocking-fmu simulate --preset mcmanus --record record.csv --m 150"
    page.select_option("#ground", "cosine")
    settled(page)
    link = page.locator("#link").text_content()
    again = page.context.new_page()
    again.goto(link)
    again.locator("body[data-ready]").wait_for()
    assert again.locator("#title").text_content() == page.locator("#title").text_content()
    first, second = page.locator("#command").text_content().splitlines()
    for line in (first, second):
        subprocess.run([exporter, *line.split()[1:]], cwd=tmp_path, check=True, capture_output=True)


def test_a_narrow_screen_shows_everything(opened):
    page = opened(viewport={"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    for selector in ("#scene", "#readings", "#histories", "#play", "#time", "#preset", "#tabs"):
        box = page.locator(selector).bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= 390 and box["height"] > 0, selector
