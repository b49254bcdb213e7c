"""Exceptions: one for each status of the library, each also the built-in one of its kind."""
import errno


class Error(Exception):
    """Any error of the library. `status` is that of enum refocus_status."""

    status: int = 0


class ArgumentError(Error, ValueError):
    """An argument is out of its documented range."""

    status = -1


class OutOfMemoryError(Error, MemoryError):
    """The allocator returned NULL."""

    status = -2


class SizeError(Error, ValueError):
    """A picture is larger than a stated limit."""

    status = -3


class StateError(Error, RuntimeError):
    """Called too early, as nothing is prepared yet, or after close()."""

    status = -4


class CancelledError(Error):
    """cancel() was called."""

    status = -5


class UnsupportedError(Error, NotImplementedError):
    """This build or processor cannot do it."""

    status = -6


class ThreadError(Error, RuntimeError):
    """A thread could not be started."""

    status = -7


class IoError(Error, OSError):
    """A file could not be opened, read or written."""

    status = -8


class NotFoundError(IoError, FileNotFoundError):
    """A file that should be read is not there."""

    def __init__(self, *words: object) -> None:
        super().__init__(*words)
        self.errno = errno.ENOENT


class FormatError(Error, ValueError):
    """A file is damaged or of an unknown format."""

    status = -9


class NoDepthError(Error, ValueError):
    """A picture carries no depth, or no known depth."""

    status = -10


class BusyError(Error, RuntimeError):
    """A renderer is used by another thread."""

    status = -14


class AccessError(Error, PermissionError):
    """Access to a file or device is refused."""

    status = -15


BY_STATUS = {kind.status: kind for kind in (
    ArgumentError, OutOfMemoryError, SizeError, StateError, CancelledError, UnsupportedError,
    ThreadError, IoError, FormatError, NoDepthError, BusyError, AccessError)}
