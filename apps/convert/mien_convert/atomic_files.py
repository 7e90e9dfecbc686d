"""Files that appear under their name only when complete, even if the process is killed."""
import contextlib
import os


@contextlib.contextmanager
def whole(path):
    """Opens a binary file for writing. Only one process at a time may write to a path. Overwrites the temporary file of
    a killed process."""
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
