"""Runs the blocks of README and of the pages: `make pages` writes their output, tests compare it. `make docs` writes the references of the command line,
of Python and of the FMU's variables to out/reference, from which the site takes them.

Commands of `console` blocks ("$ ...") and scripts that a `text` block follows are run, page by page in a folder of its own
with what `make demo` leaves in out/. The scripts of a page are one program. Scripts of `py` blocks need the Python module.
"..." stands for anything.
"""

import argparse
import doctest
import inspect
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from evidence.scenes import RECORD
from fmpy import read_model_description

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*/*.md"))]
LANGUAGES = ("console", "python", "py")
COMMAND = re.compile(r"^\$ (?P<shell>.*)\n(?P<told>(?:(?!\$ |```).*\n)*)", re.MULTILINE)
BLOCK = re.compile(r"^```console\n[^`]*?^```$|^```(?P<language>python|py)\n(?P<script>(?:(?!```)[^\n]*\n)*)```\n\n```text\n(?P<printed>.*?)^```$",
                   re.MULTILINE | re.DOTALL)


def scripts(text: str, language: str = "py") -> list[tuple[str, str]]:
    """The scripts of the page `text`, each with what it prints."""
    return [(of["script"], of["printed"]) for of in BLOCK.finditer(text) if of["language"] == language]


def rerun(text: str, exporter: Path, folder: Path, languages: tuple[str, ...] = LANGUAGES) -> str:
    """The page `text` with what its blocks of these languages print when they are run in `folder`."""
    environment = os.environ | {"PATH": f"{exporter.parent}:{Path(sys.executable).parent}:{os.environ['PATH']}", "MPLBACKEND": "agg"}

    def output(*command: str, errors: int = subprocess.STDOUT) -> str:
        done = subprocess.run(command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=errors)
        assert done.returncode == 0, (command, done.stdout, done.stderr)
        return "".join(f"{line.rstrip()}\n" for line in done.stdout.split("\n")[:-1])

    def kept(told: str, printed: str) -> str:
        return told if doctest.OutputChecker().check_output(told, printed, doctest.ELLIPSIS) else printed

    def line(found: re.Match) -> str:
        return f"$ {found['shell']}\n{kept(found['told'], output('bash', '-c', found['shell']))}"

    def block(found: re.Match) -> str:
        language = found["language"] or "console"
        if language not in languages:
            return found[0]
        if language == "console":
            return COMMAND.sub(line, found[0])
        if language not in printed:  # the first script of the page runs with all that follow
            program = "print('\\0')\n".join(script for script, _ in scripts(text, language))
            printed[language] = iter(output(sys.executable, "-c", program, errors=subprocess.PIPE).split("\0\n"))
        return f"```{language}\n{found['script']}```\n\n```text\n{kept(found['printed'], next(printed[language]))}```"

    printed = {}
    return BLOCK.sub(block, text)


def prepare(folder: Path, exporter: Path) -> Path:
    """Puts what `make demo` leaves, and what the pages name of this repository, into `folder`."""
    (folder / "out").mkdir(parents=True)
    for name in ("docs", "examples"):
        (folder / name).symlink_to(ROOT / name)
    for record in RECORD, next(RECORD.parents[1].glob("*/RSN6_*ELC180*")):
        shutil.copy(record, folder / "out")
    for preset in ("mcmanus", "evison"):
        command = [exporter, "--quiet", "export", "--preset", preset, "-o", folder / "out" / f"{preset}.fmu"]
        subprocess.run(command, check=True)
    return folder


def command_line(exporter: Path) -> str:
    """The help of `rocking-fmu` and of its commands."""
    def printed(*arguments: str) -> str:
        text = subprocess.run([exporter, *arguments, "--help"], check=True, capture_output=True, text=True).stdout
        return "".join(f"{line.rstrip()}\n" for line in ["```text", *text.splitlines(), "```"])

    whole = printed()
    commands = re.findall(r"^  (\w+) ", whole.partition("Commands:")[2], re.MULTILINE)
    return whole + "".join(f"\n## {command}\n\n{printed(command)}" for command in commands if command != "help")


ARGUMENT = re.compile(r"^(\w+(?:, \w+)*): ", re.MULTILINE)


def described(title: str, thing) -> str:
    """A section with the signature and the docstring of a class, a function or an attribute; a line "name: ..." begins an item."""
    try:
        of = inspect.signature(thing)
        plain = [argument.replace(annotation=argument.empty) for argument in of.parameters.values()]
        signature = f"```py\n{title}{of.replace(parameters=plain, return_annotation=of.empty)}\n```\n\n"
    except (TypeError, ValueError):
        signature = ""
    text = (inspect.getdoc(thing) or "").replace("<", "\\<").replace("*", "\\*")
    paragraphs = [ARGUMENT.sub(r"\n- **\1**: ", paragraph).strip() for paragraph in text.split("\n\n")]
    return f"{title}\n\n{signature}" + "\n\n".join(paragraphs) + "\n\n"


def python() -> str:
    """The reference of the Python module, from its docstrings."""
    import flexible_rocking as fr

    page = ""
    for name in sorted(set(fr.__all__) - {"__version__"}, key=lambda name: (name[0].isupper(), name.lower())):
        thing = getattr(fr, name)
        page += f"## {described(name, thing)}"
        own = vars(thing) if inspect.isclass(thing) else {}
        page += "".join(f"### {described(f'{name}.{part}', getattr(thing, part))}" for part in own
                        if not part.startswith("_") and inspect.getdoc(getattr(thing, part)))
    return page


INITIAL_VALUES = ("theta_0", "theta_dot_0", "u_0", "u_dot_0")
KINDS = {
    "Inputs": lambda v: v.causality == "input",
    "Outputs": lambda v: v.causality == "output",
    "Parameters": lambda v: v.causality == "parameter" and v.name.partition("[")[0] not in INITIAL_VALUES,
    "Initial values": lambda v: v.causality == "parameter" and v.name.partition("[")[0] in INITIAL_VALUES,
    "Calculated parameters": lambda v: v.causality == "calculatedParameter",
    "Local variables": lambda v: v.causality == "local",
}


OF_PEAKS = " since startTime, exact, also between communication points, without the fall if the structure overturns; NaN unless peaks is true"


def variables(described: list, of: str = "") -> str:
    """Variables of an FMU in tables, by their kind; i stands for every floor, storey or mode."""
    def number(value: str | None) -> str:
        return "" if value is None else re.sub(r"e([+-])0?", r"e\1", f"{float(value):g}").replace("e+", "e")

    page = ""
    for title, is_one in KINDS.items():
        rows = [v for v in described if is_one(v)]
        page += f"\n## {title}{of}\n\n| name | unit | value | range | meaning |\n|---|---|---|---|---|\n" if rows else ""
        for v in rows:
            value = number(v.start) if v.type == "Real" else v.start or ""
            limits = f"{number(v.min)} to {number(v.max)}" if v.min and v.max else ""
            choices = ": " + ", ".join(f"{item.value} {item.name}" for item in v.declaredType.items) if v.declaredType else ""
            meaning = v.description.removesuffix(OF_PEAKS).replace("|", "\\|") + choices
            page += re.sub(r"(\[|floor |storey |mode )1\b", r"\1i", f"| `{v.name}` | {v.unit or ''} | {value} | {limits} | {meaning} |\n")
    return page


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("exporter", type=Path, help="rocking-fmu")
    parser.add_argument("--site", action="store_true", help="write the references of the site instead")
    arguments = parser.parse_args()
    exporter = arguments.exporter.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        if not arguments.site:
            for number, page in enumerate(PAGES):
                folder = prepare(Path(temporary) / str(number), exporter)
                page.write_text(rerun(page.read_text(encoding="utf-8"), exporter, folder), encoding="utf-8")
            return
        import flexible_rocking as fr

        pier = prepare(Path(temporary) / "fmus", exporter) / "out/mcmanus.fmu"
        storey = fr.Structure(storeys=[dict(m=4e4, h=3.5, k=6e7)], zeta=0.02, m0=2e4, J0=3e4, B=1.5)
        building = fr.export(pier.with_name("building.fmu"), storey, library=pier)
        of_one, of_building = (read_model_description(fmu).modelVariables for fmu in (pier, building))
    own = [v for v in of_building if v.name not in {of.name for of in of_one}]
    references = {"command_line": command_line(exporter), "python": python(), "variables": variables(of_one),
                  "variables_of_buildings": variables(own, " of buildings")}
    folder = ROOT / "out/reference"
    folder.mkdir(parents=True, exist_ok=True)
    for name, page in references.items():
        (folder / f"{name}.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
