"""What people and CI see: pages, figures, tables, the command line. Nothing is computed here.

========================  ==========================================================
`reports.command_line`    `contact-verify`, the console command
`reports.pages`           report.html, one self-contained file
`reports.comparison`      report of two runs side by side
`reports.summary`         summary.md, failing rows first
`reports.junit`           junit.xml, one testcase per case, method and claim
`reports.annotations`     at most nine `::error` lines
`reports.drawing`         one renderer for every figure: SVG, PNG and CSV
`reports.style`           colours, lines and fonts, deterministic SVG
`reports.numbers`         a number with its unit and no more digits than its uncertainty allows
`reports.terminal`        progress and tables while a run goes on
========================  ==========================================================
"""

import os

# Commands compute on one thread of BLAS unless the user asks for more, before anything loads it: side by side in
# processes, threads of small solves only wait for each other (ten times the processor time on a busy machine), and
# sums repeat bit by bit whatever the number of cores.
os.environ.setdefault("OMP_NUM_THREADS", "1")
