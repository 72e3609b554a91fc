"""Another revision of the source beside this one, in a git worktree of its own that vanishes afterwards."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from cases.gate.write_permission import git


@contextmanager
def worktree(repository: Path, revision: str) -> Iterator[Path]:
    """Check out ``revision`` into a folder of its own while the body runs; the working tree is not touched.

    Raises:
        InvalidInput: with git's own words if there is no such revision.
    """
    commit = git(repository, "rev-parse", "--verify", f"{revision}^{{commit}}").strip()
    with TemporaryDirectory(prefix="contact-verify-") as folder:
        path = Path(folder) / "source"
        git(repository, "worktree", "add", "--detach", "--quiet", str(path), commit)
        try:
            yield path
        finally:
            git(repository, "worktree", "remove", "--force", str(path))
