"""What people and CI see: pages, figures, tables, the command line. Nothing is computed here.

- ``command_line``, ``commands``: `contact-verify`, the console command
- ``pages``: report.html and a page a case, comparison.html, summary.md, junit.xml, annotations
- ``charts``: what is drawn of a case
- ``figures``: one renderer and one style for every figure: SVG, PNG and CSV
- ``tables``: tables before anyone prints them
- ``words``: a number with its unit and no more digits than its uncertainty allows; names; outcomes
- ``terminal``: progress and tables while a run goes on
"""

import os

# Commands compute on one thread of BLAS unless the user asks for more, before anything loads it: side by side in
# processes, threads of small solves only wait for each other (ten times the processor time on a busy machine), and
# sums repeat bit by bit whatever the number of cores.
os.environ.setdefault("OMP_NUM_THREADS", "1")
