"""What continuous integration does: run a case, write the report, end with its exit code (0: all checks passed)."""

from reports.command_line import run

code = run(["run", "coated_pair", "--method", "mdr", "--executor", "serial", "--out", "build/case", "--quiet"])
print(f"exit code {code}")
