"""Pages, figures, tables and the command line. Nothing is computed here.

- ``command_line``, ``commands``: `contact-verify`, the console command
- ``page``: report.html, one page per case and comparison.html
- ``ci``: summary.md, junit.xml and annotations
- ``findings``, ``tables``: results of a run in words and as tables
- ``charts``, ``pictures``, ``inside``, ``fit_figures``: pictures
- ``answer``, ``fit_tables``: single answers and fits as tables and CSV files
- ``style``, ``words``: one look for all figures; numbers with units and no digit beyond their uncertainty
- ``terminal``, ``progress``: tables and bars in the terminal
- ``book``: pages of the documentation
"""

import os

# Commands compute on one thread of BLAS unless the user asks for more, before anything loads it: side by side in
# processes, threads of small solves only wait for each other (ten times the processor time on a busy machine), and
# sums repeat bit by bit whatever the number of cores.
os.environ.setdefault("OMP_NUM_THREADS", "1")
