"""Outside solvers, by other authors: optional methods on the same cases.

Each runs in a process of its own (`process.run_worker`, or its own program), to which crashes, pinned versions and
licences are confined. A solver that is not installed refuses every scene with this reason. Read `grids` first.
"""
