"""The wheel without extras: the solver works, and what is missing says which extra brings it."""

import subprocess
import sys

HIDE = "import sys; sys.modules.update(dict.fromkeys(('gmsh', 'meshio', 'skfem', 'matplotlib'))); "
COMMAND = HIDE + "from reports.command_line import run; sys.exit(run(sys.argv[1:]))"
for method in "mdr", "fem":
    words = [sys.executable, "-c", COMMAND, "solve", "sticking_punch.toml", "--method", method]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    hint = "contact-verification[fem]" in done.stderr
    print(f"{method}: exit code {done.returncode}" + ", install contact-verification[fem]" * hint)
