"""The documentation: the page of a case as Markdown, with its accepted numbers where a repository keeps some."""

from pathlib import Path

from cases.declare.registry import load_cases
from cases.gate.baseline import read_baselines
from reports.pages.book import write_book

write_book([load_cases()["coated_pair"]], read_baselines(Path("baselines")), Path("build/book"))
page = Path("build/book/coated_pair.md").read_text(encoding="utf-8").splitlines()
print(page[0], "|", ", ".join(line[3:] for line in page if line.startswith("## ")))
