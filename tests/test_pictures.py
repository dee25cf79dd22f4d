"""What `--picture` draws, read back from the files and compared with the tables that the same commands write."""

import re
import subprocess
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest
from lxml import etree

UNITS = 8  # drawing units to a pixel
GREY, BLUE, GREEN, VERMILLION, INK = "#6E6E6E", "#0072B2", "#009E73", "#D55E00", "#222222"
MARKS = {"uplift": GREEN, "impact": VERMILLION, "landing": INK}


@dataclass
class Drawing:
    """An SVG file, in pixels."""

    lines: list  # (colour, points)
    axes: list  # vertical ones: x, top, bottom
    words: list  # (text, x, y, anchor)
    dots: list  # (colour, x, y)

    def panels(self):
        """The vertical axes, from the top."""
        return sorted(self.axes, key=lambda axis: axis[1])

    def upward(self, panel):
        """Pixels down -> values, by the numbers beside the axis."""
        x, top, bottom = panel
        beside = [(y, value(text)) for text, at, y, anchor in self.words
                  if anchor == "end" and x - 40 < at < x and top - 5 <= y <= bottom + 5]
        return straight(*zip(*beside))

    def across(self, panel):
        """Pixels to the right -> values, by the numbers below the axis or below the panels that end with it."""
        x, _, bottom = panel
        below = [(at, y, value(text)) for text, at, y, anchor in self.words
                 if anchor == "middle" and y > bottom and at >= x - 5 and re.fullmatch(r"[−\d.e]+", text)]
        row = min(y for _, y, _ in below)
        return straight(*zip(*[(at, number) for at, y, number in below if abs(y - row) < 2]))

    def curves(self, colour, panel):
        """The data lines of a colour that lie in a panel."""
        _, top, bottom = panel
        return [points for of, points in self.lines if of == colour and len(points) > 2
                and (top - 1 <= points[:, 1]).all() and (points[:, 1] <= bottom + 1).all()]


def value(text):
    return float(text.replace("−", "-"))


def straight(x, y):
    """The line through points that are on one to within the drawing's unit."""
    slope, start = np.polyfit(x, y, 1)
    assert np.abs(np.polyval([slope, start], x) - y).max() <= 1.5 / UNITS * abs(slope)
    return lambda at: start + slope * np.asarray(at)


def read(path) -> Drawing:
    root = etree.parse(path).getroot()
    size = int(root.get("width")), int(root.get("height"))
    assert [int(edge) for edge in root.get("viewBox").split()] == [0, 0, *(UNITS * edge for edge in size)]
    of = {name: [node for node in root if etree.QName(node).localname == name] for name in ("polyline", "text", "circle")}
    points = [np.array([pair.split(",") for pair in node.get("points").split()], float) for node in of["polyline"]]
    position = lambda node, x, y: (float(node.get(x)) / UNITS, float(node.get(y)) / UNITS)
    lines = [(node.get("stroke"), each / UNITS) for node, each in zip(of["polyline"], points)]
    axes = [each for (colour, each), node in zip(lines, of["polyline"])
            if colour == GREY and len(each) == 2 and node.get("stroke-width") == str(UNITS)]
    axes = [(a[0], min(a[1], b[1]), max(a[1], b[1])) for a, b in axes if a[0] == b[0] and abs(a[1] - b[1]) > 40]
    return Drawing(lines, axes,
                   [(node.text.strip(), *position(node, "x", "y"), node.get("text-anchor")) for node in of["text"]],
                   [(node.get("fill"), *position(node, "cx", "cy")) for node in of["circle"]])


def is_on(time, values, of_time, of_values, points):
    """Whether each of `points` is on the curve to within 1.5 units in both directions."""
    near = 1.5 / UNITS
    for x, y in points:
        t = np.sort(of_time([x - near, x + near]))
        window = np.concatenate([np.interp(t, time, values), values[(time >= t[0]) & (time <= t[1])]])
        v = np.sort(of_values([y - near, y + near]))
        v += 0.1 * np.ptp(window) * np.array([-1, 1])  # at a transition the table has no row on either side
        assert v[0] <= window.max() and window.min() <= v[1], (x, y, of_time(x), of_values(y), window)


@pytest.fixture(scope="module")
def run(exporter, tmp_path_factory):
    """Runs the command line in a folder of its own and returns what it printed."""
    folder = tmp_path_factory.mktemp("pictures")

    def run(*arguments):
        command = [exporter, *map(str, arguments)]
        return subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout

    run.folder = folder
    return run


SCENE = ["--duration", "4"]


@pytest.fixture(scope="module")
def response(run, pacoima_record):
    """The response every 0.1 ms, and what was printed; its picture is response.svg."""
    printed = run("simulate", "--record", pacoima_record, *SCENE, "--interval", "1e-4", "-o", "response.csv",
                  "--events", "events.csv", "--picture", "response.svg")
    return pd.read_csv(run.folder / "response.csv"), printed


def test_histories_are_the_response(run, response):
    table, printed = response
    drawing = read(run.folder / "response.svg")
    panels = drawing.panels()
    assert len(panels) == 6  # the last holds the marks
    time = drawing.across(panels[-1])
    rows = [("a_g[m/s2]", 9.81, "a_g", GREY), ("theta[rad]", 1, "theta", BLUE), ("u[m]", 1e-3, "u", BLUE),
            ("delta_t[m]", 1e-3, "delta_t", BLUE), ("a_t[m/s2]", 9.81, "a_t", BLUE)]
    for panel, (column, unit, name, colour) in zip(panels, rows):
        [curve] = drawing.curves(colour, panel)
        values = drawing.upward(panel)
        is_on(table["time[s]"].to_numpy(), table[column].to_numpy() / unit, time, values, curve)
        assert np.allclose(time(curve[[0, -1], 0]), [0, 4], atol=1e-3)
        magnitude, instant = re.search(rf"peak \|{name}\| +(\S+) \S+ +at (\S+) s", printed).groups()
        peak = float(magnitude)
        unit_of_drawing = abs(values(1) - values(0)) / UNITS
        assert abs(np.abs(values(curve[:, 1])).max() - peak) <= 1.5 * unit_of_drawing  # no peak is lost
        [dot] = [(x, y) for _, x, y in drawing.dots if panel[1] <= y <= panel[2]]
        assert abs(time(dot[0]) - float(instant)) < 1e-3 and abs(abs(values(dot[1])) - peak) <= unit_of_drawing


def test_every_transition_has_its_mark(run, response):
    drawing = read(run.folder / "response.svg")
    lanes = drawing.panels()[-1]
    time = drawing.across(lanes)
    events = pd.read_csv(run.folder / "events.csv")
    assert len(events) == 31
    for kind, colour in MARKS.items():
        expected = events["time[s]"][events["kind"].str.startswith(kind)]
        ticks = [points for of, points in drawing.lines
                 if of == colour and len(points) == 2 and lanes[1] <= points[0, 1] <= lanes[2]]
        found = np.sort([time(points[0, 0]) for points in ticks])
        assert len(found) == len(expected) > 0
        assert np.abs(found - expected).max() < 1e-3


def test_any_title_can_be_drawn(run):
    title = "</text><script>throw 1</script> & \x01\x1f\uffff " + "long " * 60
    header = f"PEER\n{title}\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0100 SEC,\n"
    (run.folder / "title.AT2").write_text(header + " 0 0.1 -0.1 0\n")
    run("simulate", "--record", "title.AT2", "--picture", "title.svg")
    shown = read(run.folder / "title.svg").words[0][0]
    assert shown.startswith("</text><script>throw 1</script> & ") and shown.endswith("…")
