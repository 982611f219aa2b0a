"""Exceptions and warnings of pcednet, each also one of Python's own kinds."""

__all__ = ["Error", "UsageError", "ExistsError", "UnreadableError", "MissingFileError",
           "InsufficientError", "ModelError", "FailureError", "PcednetWarning"]


class Error(Exception):
    """Any error of pcednet."""


class UsageError(Error, ValueError):
    """The request itself is wrong: an option out of range, arrays that do not fit together."""


class ExistsError(UsageError, FileExistsError):
    """A file to write exists already; give ``overwrite=True`` to replace it."""

    def __str__(self):
        return super().__str__() + "; give overwrite=True to replace it"


class UnreadableError(Error, OSError):
    """A file cannot be read: truncated, or not of the format that it claims."""


class MissingFileError(UnreadableError, FileNotFoundError):
    """There is no such file."""


class InsufficientError(Error, ValueError):
    """The points are readable but not enough: too few, or without normals or labels."""


class ModelError(Error, ValueError):
    """A model file is damaged, foreign, or does not fit the request."""


class FailureError(Error, OSError):
    """Anything else: the disk is full, a folder is not writable, a limit is reached."""


class PcednetWarning(UserWarning):
    """A result that needs a look: normals were estimated, points are not finite, ..."""
