"""Errors that the user can correct."""


class Fault(Exception):
    """An error that the user can correct; its text is one line."""


class Missing(Fault, KeyError):
    """A result has nothing of this name; the text says what there is."""

    __str__ = Exception.__str__


def one_line(error: BaseException) -> str:
    """The text of an error without line ends."""
    return " ".join(str(error).split()) or type(error).__name__
