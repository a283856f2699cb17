"""Memory as the system sees it: pages that are resident, whoever allocated them and however. Linux only; the same
as `cpp-tests/comparisons/memory.cpp`."""

import ctypes
import gc
from pathlib import Path

_C_LIBRARY = ctypes.CDLL(None)


def begin_peak() -> int | None:
    """Gives back what is free to the system, makes the resident bytes of now the peak, and returns them; nothing
    where the system does not allow it."""
    gc.collect()
    _C_LIBRARY.malloc_trim(0)
    # 5 resets the peak, see proc(5).
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return None
    return _status("VmRSS")


def peak_bytes() -> int:
    """The most bytes that were resident at once since `begin_peak`."""
    return _status("VmHWM")


def _status(key: str) -> int:
    for line in Path("/proc/self/status").read_text().splitlines():
        name, _, value = line.partition(":")
        if name == key:
            return 1024 * int(value.split()[0])
    raise OSError(f"/proc/self/status has no {key}")
