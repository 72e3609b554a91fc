"""The files of a run for people and CI: report.html and a page a case, comparison.html, summary.md, junit.xml.

Enters: results of a run. Leaves: self-contained files. Read `report` first.
"""
