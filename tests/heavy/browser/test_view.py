"""The page of `rocking-fmu view` in headless Chromium: what it shows beside the table of `simulate`, and its controls."""

import math
import re
import shutil

import numpy as np
import pandas as pd
import pytest
from frames import FRAMES, toml
from host import output
from playwright.sync_api import sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

END = 4.0  # s

#: How many numbers each axis of the histories has, from above.
SCALES = """() => {
    const at = (of, name) => Number(of.getAttribute(name));
    const texts = [...document.querySelectorAll("#histories text")].filter(of => /^−?[\\d.]+$/.test(of.textContent));
    return [...document.querySelectorAll("#histories .axis")].filter(of => at(of, "x1") === at(of, "x2"))
        .map(axis => texts.filter(of => Math.abs(at(of, "x") - at(axis, "x1")) < 8 && at(axis, "y1") - 5 < at(of, "y") && at(of, "y") < at(axis, "y2") + 9).length);
}"""
HOSTILE = "</script><script>throw 1</script><!-- <b> & \" \u2028 </title>"


@pytest.fixture(scope="module")
def browser():
    if not CHROMIUM:
        pytest.skip("Chromium is not there and cannot be installed")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM)
        yield browser
        browser.close()


def shown(exporter, record, folder, *structure):
    """The page of a structure under the Pacoima Dam scene, the response every 0.1 ms and the transitions."""
    scene = [*structure, "--record", record, "--duration", END]
    output(exporter, "view", *scene, "-o", "view.html", cwd=folder)
    output(exporter, "simulate", *scene, "--interval", "1e-4", "-o", "response.csv", "--events", "events.csv", cwd=folder)
    return folder / "view.html", pd.read_csv(folder / "response.csv"), pd.read_csv(folder / "events.csv")


@pytest.fixture(scope="module")
def view(exporter, pacoima_record, tmp_path_factory):
    return shown(exporter, pacoima_record, tmp_path_factory.mktemp("view"))


@pytest.fixture
def new_page(browser):
    """Opens pages off line; at the end there must have been no error, and no request for anything but the pages themselves."""
    contexts, problems, requests = [], [], []

    def new_page(address, **options):
        contexts.append(browser.new_context(**({"viewport": {"width": 1440, "height": 900}, "offline": True} | options)))
        page = contexts[-1].new_page()
        page.on("console", lambda message: problems.append(message.text))
        page.on("pageerror", lambda error: problems.append(str(error)))
        page.on("request", lambda request: requests.append(request.url))
        page.goto(address)
        return page

    yield new_page
    for context in contexts:
        context.close()
    assert problems == []
    assert [url.split(":")[0] for url in requests if not url.startswith("blob:")] == ["file"] * len(contexts)


@pytest.fixture
def opened(new_page, view):
    return lambda path=view[0], **options: new_page(path.as_uri(), **options)


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def clock(page) -> float:
    return number(page.locator("#clock").text_content().split(" of ")[0])


def reading(page, name: str, column: int = 0) -> float:
    """Number of the readings: now, peak."""
    return number(page.locator(f"tr[data-name={name}] td").nth(column).text_content())


def wait(page, until) -> None:
    for _ in range(3000):  # a film takes long on a busy machine
        if until():
            return
        page.wait_for_timeout(20)
    raise TimeoutError


def go_to(page, instant: float) -> None:
    page.locator("#time").evaluate("(slider, t) => { slider.value = t; slider.dispatchEvent(new Event('input')); }", instant)


def drawn(page, floor: int = 1) -> tuple[float, float, float]:
    """θ (rad) and the pivot (m) by the transform of the body, u (m) by that of a floor."""
    transform = page.locator("#body").get_attribute("transform")
    angle, pivot = re.fullmatch(r"(?:translate\(0 \S+\) )?rotate\((\S+) (\S+) 0\)", transform).groups()
    top = page.locator("#body rect.mass").nth(floor).get_attribute("transform")
    return math.radians(float(angle)), float(pivot), float(re.match(r"translate\((\S+) ", top)[1])


def compare(page, table, row, floor: int = 1, of_floor: str = "", exaggeration: int = 1):
    """What is drawn and read at the instant of a row of the table, on a floor; returns the row."""
    now, largest = table.iloc[row], table.select_dtypes("number").abs().max()
    go_to(page, now["time[s]"])
    theta, _, u = drawn(page, floor)
    # the page's lines leave the motion by a ten-thousandth of its peaks, its values are rounded to a tenth of that
    assert abs(theta / exaggeration - now["theta[rad]"]) <= 1.1e-4 * largest["theta[rad]"]
    assert abs(u / exaggeration - now[f"u{of_floor}[m]"]) <= 1.1e-4 * largest[f"u{of_floor}[m]"]
    for name, column, unit in [("a_g", "a_g[m/s2]", 9.81), ("theta", "theta[rad]", 1), ("u", f"u{of_floor}[m]", 1e-3), ("V_t", "V_t[N]", 1e3),
                               ("delta_t", f"delta_t{of_floor}[m]", 1e-3), ("a_t", f"a_t{of_floor}[m/s2]", 9.81), ("uplift", "uplift[m]", 1e-3),
                               ("M_t", "M_t[N.m]", 1e3), ("settlement", "settlement[m]", 1e-3), ("N_left", "N_left[N]", 1e3)][:8 + 2 * ("y[m]" in table)]:
        assert abs(reading(page, name) - now[column] / unit) <= 2e-3 * largest[column] / unit, (name, row)
    return now


@pytest.mark.parametrize("exaggeration", [1, 20])
def test_what_is_drawn_is_the_response(opened, view, exaggeration):
    page = opened()
    page.select_option("#exaggeration", str(exaggeration))
    for row in (0, 6667, 8765, 17041, 30000):
        now = compare(page, view[1], row, exaggeration=exaggeration)
        if now["theta[rad]"] != 0:
            assert drawn(page)[1] == math.copysign(0.285, now["theta[rad]"])
        assert page.locator("#pivot").is_visible() == (now["theta[rad]"] != 0)
        assert page.locator("tr.phase td").text_content() == now["phase"]


def test_what_is_drawn_is_true_to_scale(opened):
    """A base 0.57 m wide and a mass 1.84 m above it, measured on the screen."""
    page = opened()
    page.select_option("#exaggeration", "1")
    corners = """shape => {
        const box = shape.getBBox(), on = shape.getScreenCTM();
        return [[box.x, box.y], [box.x + box.width, box.y + box.height]].map(([x, y]) => {
            const point = new DOMPoint(x, y).matrixTransform(on);
            return [point.x, point.y];
        });
    }"""
    base, top = (np.array(page.locator("#body rect.mass").nth(i).evaluate(corners)) for i in (0, 1))
    ground = page.locator("#surface").evaluate(corners)[0][1]
    assert base[1, 1] == pytest.approx(ground, abs=0.01)
    assert (ground - top[:, 1].mean()) / np.ptp(base[:, 0]) == pytest.approx(1.84 / 0.57, rel=1e-3)
    assert "true to scale" in page.locator(".exaggeration").text_content()


def test_the_peaks_are_exact_and_a_click_away(opened):
    page = opened()
    for name, peak in [("theta", 0.01200009), ("uplift", 6.83989), ("a_t", 0.53823)]:
        page.locator(f"tr[data-name={name}] button").click()
        assert [reading(page, name, 1), abs(reading(page, name))] == pytest.approx([peak, peak], rel=6e-4)


def test_transitions_are_marked_and_stepped_through(opened, view):
    page, (_, _, events) = opened(), view
    for kind in ("uplift", "impact", "landing"):
        expected = events["time[s]"][events["kind"].str.startswith(kind)]
        ticks = page.locator(f"line.tick[data-kind={kind}]").evaluate_all("ticks => ticks.map(tick => Number(tick.getAttribute('x1')))")
        ticks.sort()
        assert len(ticks) == len(expected) > 0
        # all ticks of all kinds are at one scale: 0 to 4 s over the width of the axis
        assert np.polyval(np.polyfit(expected, ticks, 1), expected) == pytest.approx(ticks, abs=0.1)
    instants = sorted(events["time[s]"])
    for key, instant in [*((".", instant) for instant in instants[:4]), (",", instants[2])]:
        page.keyboard.press(key)
        assert abs(clock(page) - instant) <= 5e-4 + 1e-9


def test_play_pause_and_speed(opened):
    page = opened()
    does = lambda: page.locator("#play").get_attribute("aria-label")
    go_to(page, 0)
    page.select_option("#speed", "0.5")
    page.locator("#play").click()
    assert does() == "Pause"
    wait(page, lambda: clock(page) > 0.2)
    page.keyboard.press("Space")
    at = clock(page)
    assert does() == "Play" and 0.2 <= at < END
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert clock(page) == at
    page.keyboard.press("ArrowUp")
    assert page.locator("#speed").input_value() == "1"
    go_to(page, END - 0.05)
    page.keyboard.press("Space")
    wait(page, lambda: does() == "Play")
    assert clock(page) == END


def test_scrubbing_and_the_keyboard(opened):
    page = opened()
    frame = page.locator("#inside rect").evaluate("rect => [rect.x.baseVal.value, rect.width.baseVal.value]")
    box = page.locator("#histories").bounding_box()
    x = lambda instant: box["x"] + frame[0] + frame[1] * instant / END
    page.mouse.move(x(1), box["y"] + 200)
    page.mouse.down()
    page.mouse.move(x(3), box["y"] + 300, steps=5)
    assert abs(clock(page) - 3) < END / frame[1]
    at = page.locator(".cursor").evaluate("cursor => cursor.getBoundingClientRect().x")
    assert abs(at - x(3)) < 1.5
    page.mouse.up()
    page.mouse.move(x(1), box["y"] + 200)
    assert abs(clock(page) - 3) < END / frame[1]
    for key, expected in [("Home", 0), ("ArrowRight", 0.04), ("Shift+ArrowRight", 0.44), ("ArrowLeft", 0.4), ("End", END)]:
        page.keyboard.press(key)
        assert abs(clock(page) - expected) < 1e-9, key
    before = page.locator("#exaggeration").input_value()
    page.keyboard.press("E")
    assert int(page.locator("#exaggeration").input_value()) < int(before)
    page.keyboard.press("e")
    assert page.locator("#exaggeration").input_value() == before
    page.keyboard.press("?")
    assert page.locator("#help").is_visible() and "play, pause" in page.locator("#help").text_content()
    page.keyboard.press("Escape")
    assert not page.locator("#help").is_visible()


@pytest.fixture
def under(opened, exporter, tmp_path):
    """The page of McManus's specimen under a record of this text."""

    def under(name: str, text: str):
        (tmp_path / name).write_text(text)
        output(exporter, "view", "--record", name, "-o", "view.html", cwd=tmp_path)
        return opened(tmp_path / "view.html")

    return under


def test_a_structure_that_falls_lies(under):
    page = under("push.csv", "time (s),a (m/s2)\n0,0\n0.2,6\n0.6,6\n0.8,-2\n1.2,0\n")
    assert page.locator("line.tick[data-kind=overturning]").count() == 1
    for keys in (["End"], ["Home", ".", "."]):  # uplift, overturning
        for key in keys:
            page.keyboard.press(key)
        assert page.locator("tr.phase td").text_content() == "overturned"
        assert page.locator("#fallen").text_content().startswith("overturned at 1.31")
    theta, pivot, _ = drawn(page)
    assert abs(theta + math.pi / 2) < 1e-4 and pivot == -0.285


def test_a_hostile_title_is_text(under):
    page = under("hostile.AT2", f"PEER\n{HOSTILE}\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0100 SEC,\n 0 0.1 -0.1 0\n")
    assert page.locator("#title").text_content().strip() == HOSTILE
    assert page.title().startswith("</script>")


@pytest.mark.parametrize("ground", ["", "f_v = 15"])
def test_a_frame_moves_as_its_response_says(opened, exporter, pacoima_record, tmp_path, ground):
    (tmp_path / "frame.toml").write_text(toml(FRAMES["frame"], ground=ground))
    path, table, _ = shown(exporter, pacoima_record, tmp_path, "--parameters", "frame.toml")
    page = opened(path)
    page.select_option("#exaggeration", "1")
    for row in (0, 12340, 30000):
        for floor in (1, 2, 3):
            page.select_option("#floor", str(floor))
            now = compare(page, table, row, floor, f"[{floor}]")
        if ground:
            down = re.match(r"translate\(0 (\S+)\) ", page.locator("#body").get_attribute("transform"))
            assert abs(float(down[1]) + now["y[m]"]) <= 2e-3 * table["y[m]"].abs().max()
    assert page.locator("#heights").is_visible() and page.locator("#peaks tr").count() == 3
    for width, height in ((1366, 768), (1100, 800), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(200)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.locator("#numbers").evaluate("numbers => numbers.scrollWidth <= numbers.clientWidth"), width
        scales = page.evaluate(SCALES)
        assert len(scales) == (9 if ground else 5) and min(scales) >= 2, (width, scales)
        titles = page.locator("#profile text").evaluate_all("all => all.map(text => text.getBoundingClientRect().toJSON())")
        meet = lambda a, b: a["left"] < b["right"] and b["left"] < a["right"] and a["top"] < b["bottom"] - 3 and b["top"] < a["bottom"] - 3
        assert not any(meet(a, b) for i, a in enumerate(titles) for b in titles[:i]), width
