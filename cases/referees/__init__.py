"""Outside solvers, by other authors: optional methods on the same cases.

Each runs as a process of its own (`process.ask`, or its own program), so that its crashes, its pins and its licence
stay there.  One that is not installed skips with its reason.  Read `contact_mechanics` first.
"""
