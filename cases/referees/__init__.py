"""Outside referees: solvers that nobody here wrote, put through the same cases as optional methods.

Each runs as a process of its own (`process.ask`, or its own program), so that its crashes, its pins and its licence
stay there.  One that is not installed skips with its reason.  Read `contact_mechanics` first.
"""
