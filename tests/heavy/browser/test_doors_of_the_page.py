"""The scenes of test_doors.py through the page."""

import base64
import gzip
import json
import re
import subprocess

from conftest import ROOT
from playwright._impl import _driver as driver
from test_doors import SCENES, at_end, scene_of  # noqa: F401

#: The page's engine in node: a line of fields and file in, a line of answers out.
ENGINE = """
const fs = require("fs");
const page = fs.readFileSync(process.argv[1], "utf8");
const part = (id) => page.match(new RegExp(`<script[^>]*id="${id}"[^>]*>([^]*?)</script>`))[1];
require("vm").runInThisContext(part("glue") + ";globalThis.wasm_bindgen = wasm_bindgen");
wasm_bindgen.initSync({ module: new WebAssembly.Module(fs.readFileSync(process.argv[2])) });
const answer = ([fields, file]) => {
  const explorer = new wasm_bindgen.Explorer();
  if (file) explorer.take_record(file, fs.readFileSync(file));
  return [JSON.parse(explorer.peaks(fields)), JSON.parse(explorer.validity(fields))];
};
console.log(JSON.stringify(JSON.parse(fs.readFileSync(0)).map(answer)));
"""


def engine_in(page: str) -> bytes:
    """The page's letters are those of Adobe's Ascii85, two further on; "<" is "x". The first says how many zeros end the bytes."""
    zeros, letters = re.search('<script[^>]*id="engine"[^>]*>(.)(.*?)</script>', page).groups()
    found = base64.a85decode(bytes(letter - 2 for letter in letters.replace("x", "<").encode()))
    return gzip.decompress(found[:len(found) - int(zeros)])


def test_the_page_has_the_command_lines_numbers(scene_of, tmp_path):
    """Of the scenes that its fields can hold, in the node that playwright brings."""
    page = ROOT / "out" / "explore.html"
    assert page.is_file(), f"{page} is not there: make explore"
    meant = [scene for scene in map(scene_of, SCENES) if not scene.vertical and not (scene.record and scene.duration)]
    asked = []
    for scene in meant:
        ground = {"ground": "record"} | scene.scales if scene.record else {"ground": "free", "duration": scene.duration}
        fields = {name: str(value) for name, value in (scene.structure | scene.initial | scene.how | ground).items()}
        asked.append([json.dumps(fields), scene.record and str(scene.record)])
    node, _ = driver.compute_driver_executable()
    engine = tmp_path / "engine.wasm"
    engine.write_bytes(engine_in(page.read_text()))
    answers = json.loads(subprocess.run([node, "-e", ENGINE, page, engine], input=json.dumps(asked), check=True,
                                        stdout=subprocess.PIPE, text=True).stdout)
    assert len(answers) > 20
    unknown = {"a_g", "ending", "fall"}
    for scene, (run, validity) in zip(meant, answers):
        found = {name: (value, time) for name, value, time in run["peaks"]}
        found |= {row["name"]: (float(row["value"]), row["time"]) for row in validity}
        found |= at_end(run["end"], {name: run[name] for name in ("transitions", "end", "steps", "evaluations")})
        assert found == {name: of for name, of in scene.answer.items() if name not in unknown and " " not in name}, scene
