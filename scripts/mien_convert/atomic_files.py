"""Files that appear under their name only when they are whole, whenever the process that writes them is killed."""
import contextlib
import os


@contextlib.contextmanager
def whole(path):
    """A binary file to write. One process at a time may write to a path; what a killed one left beside it is
    overwritten."""
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
