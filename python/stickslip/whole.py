"""Files that are written completely or not at all: a file is written under an unused name and then renamed.

Links are never followed for writing, and a device, a pipe or a link is not replaced.
"""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from stickslip.errors import Fault


@contextmanager
def whole(path: Path | str) -> Iterator[Path]:
    """The path of an empty file of the same suffix to write to; the file replaces `path` when everything has been
    written.

    Missing folders are created. After an error the file is removed and `path` stays as it was.
    """
    path = Path(path)
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise Fault(f"{path} is no regular file: it is not replaced")
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f".{path.stem}.{secrets.token_hex(8)}.part{path.suffix}")
    os.close(os.open(draft, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    try:
        yield draft
        os.replace(draft, path)
    except BaseException:
        with suppress(OSError):
            draft.unlink()
        raise


def write_text(path: Path | str, text: str) -> None:
    """Writes a text file completely or not at all."""
    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="")
