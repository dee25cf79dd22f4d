"""The site, `make docs`. Its source is the repository: links of README and of the pages hold on it as in the files."""

import latex2mathml.converter

project = "FlexibleRocking"
extensions = ["myst_parser", "sphinx_external_toc"]
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**"]
exclude_patterns = [".venv", ".git", "target", "out", "study", "examples", "tests", "**/target"]
external_toc_path = "docs/toc.yml"
html_theme = "furo"
html_title = project
html_copy_source = False
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
    translator.body.append(f'<div style="overflow: auto hidden">{equation}</div>' if block else equation)
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(mathml, None), block_renderers=(mathml, None))
