"""What `--picture` draws, read back from the files and compared with the tables that the same commands write."""

import re

import numpy as np
import pandas as pd
import pytest
from host import output
from lxml import etree

UNITS = 8  # drawing units to a pixel
GREY, BLUE, GREEN, VERMILLION, INK = "#6E6E6E", "#0072B2", "#009E73", "#D55E00", "#222222"
MARKS = {"uplift": GREEN, "impact": VERMILLION, "landing": INK}


class Drawing:
    """An SVG file in pixels: lines (colour, points), dots (x, y), words (text, x, y, anchor) and vertical axes (x, top, bottom)."""

    def __init__(self, path):
        root = etree.parse(path).getroot()
        size = int(root.get("width")), int(root.get("height"))
        assert [int(edge) for edge in root.get("viewBox").split()] == [0, 0, *(UNITS * edge for edge in size)]
        of = {name: root.findall(f"{{*}}{name}") for name in ("polyline", "text", "circle")}
        pixels = lambda node, *names: tuple(float(node.get(name)) / UNITS for name in names)
        self.lines = [(node.get("stroke"), np.array([pair.split(",") for pair in node.get("points").split()], float) / UNITS)
                      for node in of["polyline"]]
        self.dots = [pixels(node, "cx", "cy") for node in of["circle"]]
        self.words = [(node.text.strip(), *pixels(node, "x", "y"), node.get("text-anchor")) for node in of["text"]]
        axes = [points for (colour, points), node in zip(self.lines, of["polyline"])
                if colour == GREY and len(points) == 2 and node.get("stroke-width") == str(UNITS)]
        self.panels = sorted(((x, *sorted(ends)) for (x, to), ends in (points.T for points in axes) if x == to and abs(np.ptp(ends)) > 40),
                             key=lambda axis: axis[1])

    def upward(self, panel):
        """Pixels down -> values, by the numbers beside the axis."""
        x, top, bottom = panel
        return straight([(y, number(text)) for text, at, y, anchor in self.words
                         if anchor == "end" and x - 40 < at < x and top - 5 <= y <= bottom + 5])

    def across(self, panel):
        """Pixels to the right -> values, by the numbers below the axis or below the panels that end with it."""
        x, _, bottom = panel
        below = [(y, at, number(text)) for text, at, y, anchor in self.words
                 if anchor == "middle" and y > bottom and at >= x - 5 and re.fullmatch(r"[−\d.e]+", text)]
        return straight([of for y, *of in below if y - min(below)[0] < 2])

    def within(self, panel, colour, least=2):
        """The lines of a colour of so many points in a panel."""
        _, top, bottom = panel
        return [points for of, points in self.lines if of == colour and len(points) >= least
                and (top - 1 <= points[:, 1]).all() and (points[:, 1] <= bottom + 1).all()]


def number(text):
    return float(text.replace("−", "-"))


def straight(points):
    """The line through points that are on one to within the drawing's unit."""
    x, y = np.transpose(points)
    slope, start = np.polyfit(x, y, 1)
    assert np.abs(start + slope * x - y).max() <= 1.5 / UNITS * abs(slope)
    return lambda at: start + slope * np.asarray(at)


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
def response(exporter, pacoima_record, tmp_path_factory):
    """The response every 0.1 ms, its transitions, what was printed, and the picture."""
    folder = tmp_path_factory.mktemp("pictures")
    printed = output(exporter, "simulate", "--record", pacoima_record, "--duration", 4, "--interval", "1e-4", "-o", "response.csv",
                     "--events", "events.csv", "--picture", "response.svg", cwd=folder)
    return pd.read_csv(folder / "response.csv"), pd.read_csv(folder / "events.csv"), printed, Drawing(folder / "response.svg")


def test_histories_are_the_response(response):
    table, _, printed, drawing = response
    assert len(drawing.panels) == 6  # the last holds the marks
    time = drawing.across(drawing.panels[-1])
    rows = [("a_g[m/s2]", 9.81, "a_g", GREY), ("theta[rad]", 1, "theta", BLUE), ("u[m]", 1e-3, "u", BLUE),
            ("delta_t[m]", 1e-3, "delta_t", BLUE), ("a_t[m/s2]", 9.81, "a_t", BLUE)]
    for panel, (column, unit, name, colour) in zip(drawing.panels, rows):
        [curve] = drawing.within(panel, colour, 3)
        values = drawing.upward(panel)
        is_on(table["time[s]"].to_numpy(), table[column].to_numpy() / unit, time, values, curve)
        assert np.allclose(time(curve[[0, -1], 0]), [0, 4], atol=1e-3)
        peak, instant = map(float, re.search(rf"peak \|{name}\| +(\S+) \S+ +at (\S+) s", printed).groups())
        unit_of_drawing = abs(values(1) - values(0)) / UNITS
        assert abs(np.abs(values(curve[:, 1])).max() - peak) <= 1.5 * unit_of_drawing  # no peak is lost
        [dot] = [(x, y) for x, y in drawing.dots if panel[1] <= y <= panel[2]]
        assert abs(time(dot[0]) - instant) < 1e-3 and abs(abs(values(dot[1])) - peak) <= unit_of_drawing


def test_every_transition_has_its_mark(response):
    _, events, _, drawing = response
    lanes = drawing.panels[-1]
    time = drawing.across(lanes)
    assert len(events) == 31
    for kind, colour in MARKS.items():
        expected = events["time[s]"][events["kind"].str.startswith(kind)]
        found = np.sort([time(points[0, 0]) for points in drawing.within(lanes, colour)])
        assert len(found) == len(expected) > 0
        assert np.abs(found - expected).max() < 1e-3


def test_any_title_can_be_drawn(exporter, tmp_path):
    title = "</text><script>throw 1</script> & \x01\x1f\uffff " + "long " * 60
    header = f"PEER\n{title}\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0100 SEC,\n"
    (tmp_path / "title.AT2").write_text(header + " 0 0.1 -0.1 0\n")
    output(exporter, "simulate", "--record", "title.AT2", "--picture", "title.svg", cwd=tmp_path)
    shown = Drawing(tmp_path / "title.svg").words[0][0]
    assert shown.startswith("</text><script>throw 1</script> & ") and shown.endswith("…")
