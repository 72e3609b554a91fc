"""Sphinx settings of the documentation. `make docs` builds it with warnings as errors; nothing is downloaded."""

import inspect
import sys
from pathlib import Path

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util.inspect import stringify_signature

from cases.declare.registry import load_cases
from reports.book import write_book

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))  # scripts of the gallery import their common parts
from docs.written import write_accuracy, write_case_figure, write_commands, write_equations, write_tasks

write_book(load_cases().values(), HERE / "book")
for case in load_cases():
    page, figure = HERE / "book" / f"{case}.md", write_case_figure(case, HERE / "book")
    page.write_text(page.read_text(encoding="utf-8").replace("\n## ", f"{figure}\n## ", 1), encoding="utf-8")
write_equations(HERE.parent, HERE / "generated" / "equations.md")
write_accuracy(HERE / "generated" / "accuracy.md")
write_commands(HERE / "commands")
write_tasks(HERE / "tasks")

project = "contact-verification"
author = "contact-verification contributors"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
bibtex_bibfiles = ["references.bib"]
smartquotes = False  # "--option" keeps its two hyphens
html_theme = "pydata_sphinx_theme"
html_static_path = ["_static"]
html_css_files = ["docs.css"]
html_title = "contact-verification"
html_theme_options = {"show_prev_next": False, "navigation_with_keys": False, "secondary_sidebar_items": ["page-toc"]}
html_show_sourcelink = False
# Pages without neighbours of their own need no list of them.
ALONE = (
    "accuracy",
    "api",
    "contributing",
    "formulas",
    "limits",
    "paper",
    "referees",
    "shared",
    "theory",
    "which_method",
)
html_sidebars = {page: [] for page in ALONE}
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
napoleon_use_ivar = True
exclude_patterns = [
    "tutorials",
    "gallery",
    "figures/sg_execution_times.rst",
    "generated",
    "start/sg_execution_times.rst",
    "sg_execution_times.rst",
]
sphinx_gallery_conf = {
    "examples_dirs": ["tutorials", "gallery"],
    "gallery_dirs": ["start", "figures"],
    "filename_pattern": r"\.py$",
    "ignore_pattern": r"^_",
    "abort_on_example_error": True,
    "capture_repr": (),
    "download_all_examples": False,
    "show_memory": False,
    "within_subsection_order": "FileNameSortKey",
    "min_reported_time": 60,
}
html_math_renderer = "mathml"
suppress_warnings = ["config.cache", "myst.xref_missing"]


def setup(app):
    """Formulas as MathML, which browsers draw themselves: pages need no script from elsewhere."""
    app.add_html_math_renderer("mathml", (_inline_math, None), (_display_math, None))
    app.connect("autodoc-process-signature", _fields_without_validators)


def _fields_without_validators(_app, what, _name, found, _options, _signature, _returned):
    """Signatures of records without annotations, which hold validators; their fields follow with units."""
    if what != "class":
        return None
    return stringify_signature(inspect.signature(found), show_annotation=False), None


def _inline_math(translator, node):
    translator.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _display_math(translator, node):
    translator.body.append(f'<div class="formula">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode
