"""README and the pages print what the program prints today."""

import re

import pytest
from conftest import ROOT


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
