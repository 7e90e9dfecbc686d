"""Files that appear under their name only when they are whole, whenever the process that writes them is killed."""
import contextlib
import os


@contextlib.contextmanager
def whole(path):
    """A binary file for writing that replaces `path` when it is complete. One process at a time may write to a path; it
    overwrites the remains of a killed process."""
    partial = f"{os.fspath(path)}.partial"
    try:
        with open(partial, "wb") as out:
            yield out
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(partial)
        raise


def write_whole(path, data):
    with whole(path) as out:
        out.write(data)
