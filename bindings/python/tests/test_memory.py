import subprocess
import sys
import textwrap

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems do not enforce a memory limit of a process")

# Raises the memory limit of the process until an object can be created; counts the errors of the package.
CREATE_WITH_LIMITS = textwrap.dedent("""
    import resource
    import mien
    from mien import errors

    def address_space():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[0]) * resource.getpagesize()

    def refusals(make, step=64 * 1024):
        make().close()  # loads everything that is loaded on first use
        used, refused = address_space(), 0
        for more in range(0, 64 << 20, step):
            resource.setrlimit(resource.RLIMIT_AS, (used + more, resource.RLIM_INFINITY))
            try:
                made = make()
            except MemoryError as error:
                refused += isinstance(error, errors.OutOfMemoryError)
                continue
            finally:
                resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
            return refused, made

    {body}
    """)


def run(body):
    script = CREATE_WITH_LIMITS.replace("{body}", textwrap.dedent(body))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@pytest.mark.parametrize("lod", [1, 4])
def test_a_tracker_without_memory_is_an_error_and_the_next_one_works(lod):
    refused, status = run(f"""
        import numpy
        refused, tracker = refusals(lambda: mien.Tracker({lod}))
        print(refused, tracker.track(numpy.zeros((48, 64, 3), numpy.uint8), 0).status.name)
    """)
    assert int(refused) > 3
    assert status == "SEARCHING"


def test_a_network_without_memory_is_an_error_and_the_next_one_works():
    refused, outputs = run("""
        import numpy
        from mien._library import MODELS
        refused, network = refusals(lambda: mien.Network(MODELS / "basenet.mien", "encoder"))
        print(refused, len(network.run(numpy.zeros(network.input_shape, numpy.float32))))
    """)
    assert int(refused) > 3
    assert int(outputs) > 0
