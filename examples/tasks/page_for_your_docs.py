"""The documentation: the page of a case as Markdown."""

from pathlib import Path

from cases.declare.registry import load_cases
from reports.book import write_book

write_book([load_cases()["coated_pair"]], Path("build/book"))
page = Path("build/book/coated_pair.md").read_text(encoding="utf-8").splitlines()
print(page[0], "|", ", ".join(line[3:] for line in page if line.startswith("## ")))
