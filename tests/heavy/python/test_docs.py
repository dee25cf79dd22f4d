"""All pages print what the program and the Python module print today."""

import pages
import pytest
from conftest import ROOT


@pytest.mark.parametrize("page", [
    str(page.relative_to(ROOT)) for page in pages.PAGES
    if page.stem != "opensees" and pages.BLOCK.search(page.read_text(encoding="utf-8"))])
def test_what_a_page_prints_is_what_its_blocks_print(page, check_page):
    check_page(page)
