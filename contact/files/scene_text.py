"""The text of a scene file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from contact.records.errors import InvalidInput

# A file beyond this number of bytes is refused: it is no scene, or a device without an end.
MAX_BYTES: Final = 32_000_000


def scene_text(file: Path) -> str:
    """The text of a scene file, without a byte-order mark.

    Raises:
        InvalidInput: If the file cannot be read, is too large or empty, or is no UTF-8.
    """
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        # A path with a zero byte raises a ValueError.
        reason = getattr(error, "strerror", None) or error
        raise InvalidInput(f"{file}: cannot be read ({reason}); check the path") from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than a scene can have ({MAX_BYTES} bytes)")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidInput(
            f"{file}: not a text file in UTF-8 (byte {error.start}); save the scene as TOML in UTF-8"
        ) from None
    if not text.strip():
        raise InvalidInput(f"{file}: the file is empty; a scene needs [layer], [indenter] and [loading]")
    return text
