"""The files of a run for people and CI: report.html, comparison.html, summary.md, junit.xml.

Enters: results of a run. Leaves: self-contained files. Read `report` first.
"""
