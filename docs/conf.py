"""The site, `make docs`. Its source is the repository: links of README and of the pages hold on it as in the files."""

import re
from importlib.util import find_spec

import latex2mathml.converter

FUNCTION = re.compile(r"<msup><mi>(?:sin|cos|tan|ln)</mi><mn>\d</mn></msup>|(?<!<msup>)<mi>(?:sin|cos|tan|ln)</mi>")

project = "FlexibleRocking"
extensions = ["myst_parser", "sphinx_external_toc"]
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**"]
exclude_patterns = [".venv", ".git", "target", "out", "study", "examples", "tests", "**/target"]
external_toc_path = "docs/toc.yml"
html_theme = "furo"
html_title = project
html_copy_source = False
html_static_path = ["static", f"{find_spec('ziamath').submodule_search_locations[0]}/fonts"]  # STIX Two Math
html_css_files = ["site.css"]
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 3
nitpicky = True


def mathml(translator, node):
    """An equation as browsers show it by themselves, without a script."""
    from docutils.nodes import SkipNode

    block = node.tagname == "math_block"
    equation = latex2mathml.converter.convert(node.astext(), display="block" if block else "inline")
    equation = FUNCTION.sub(r'<mspace width="0.17em"/>\g<0><mspace width="0.17em"/>', equation)  # as TeX sets them
    translator.body.append(f'<div class="equation">{equation}</div>' if block else equation)
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(mathml, None), block_renderers=(mathml, None))
