"""README and the pages print what the program prints today, and the examples run."""

import re

import frames
import pytest
import test_against_reference as scenes
from conftest import ROOT
from host import output


@pytest.mark.parametrize("page", ["README.md", "docs/tutorial/quickstart.md"])
def test_the_first_pages_print_what_their_commands_print(page, check_page):
    check_page(page, ("console", "python"))


def test_both_readmes_have_the_first_run_of_the_page_of_python():
    page = (ROOT / "docs/howto/python.md").read_text(encoding="utf-8")
    first = re.search(r"```py\n.*?```\n\n```text\n.*?```", page, re.DOTALL)[0]
    package = (ROOT / "python/README.md").read_text(encoding="utf-8")
    assert first in (ROOT / "README.md").read_text(encoding="utf-8") and first in package
    assert "](" not in package, "the package's page has no files to link to"


def test_every_page_is_in_readme_and_in_the_list_of_the_site():
    readme, site = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "docs/toc.yml"))
    for page in sorted((ROOT / "docs").glob("*/*.md")):
        name = str(page.relative_to(ROOT))
        assert f"]({name})" in readme and f"file: {name.removesuffix('.md')}\n" in site, name


def test_readme_counts_the_scenes_that_are_compared_with_an_independent_integration():
    of = [*scenes.FREE, *scenes.RESTRAINED, *frames.SCENES]
    assert f"to 1e-9 of the peak in {len(of)} scenes." in (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("file", sorted((ROOT / "examples").glob("*.toml")), ids=lambda file: file.name)
def test_sweeps_of_the_examples_run(file, exporter, tmp_path):
    text = file.read_text(encoding="utf-8").replace('"../', f'"{ROOT}/')
    (tmp_path / "few.toml").write_text(re.sub(r"count = \d+", "count = 2", text), encoding="utf-8")
    output(exporter, "--quiet", "sweep", "few.toml", "-o", "rows.csv", cwd=tmp_path)
    assert len((tmp_path / "rows.csv").read_text(encoding="utf-8").splitlines()) > 4


@pytest.mark.parametrize("folder", ["evidence", "explain"])
def test_every_table_and_picture_of_a_page_is_in_a_page(folder):
    words = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").glob("*/*.md"))
    found = [path for path in (ROOT / "docs" / folder).rglob("*.*") if path.suffix != ".md"]
    assert [path.name for path in found if f"{path.relative_to(ROOT / 'docs' / folder)})" not in words] == []
