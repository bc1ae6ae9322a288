"""Whether the XML in a zipped workbook is well-formed, which its parser does not ask.

It skips what it cannot make sense of: a tag that lost a letter takes a cell with it, and the
rows around it look sound.
"""

from __future__ import annotations

from pathlib import Path
from xml.parsers import expat

from reduction.errors import LogError

_SUFFIXES = (".xml", ".rels")


def is_markup(name: str) -> bool:
    """Whether a part of a workbook has to be XML.

    Examples
    --------
    >>> is_markup("xl/worksheets/sheet1.xml"), is_markup("xl/media/image1.png")
    (True, False)
    """
    return name.lower().endswith(_SUFFIXES)


class SoundMarkup:
    """Parses a part as it is unpacked; keeps nothing, and fetches nothing from elsewhere.

    Parameters
    ----------
    path : pathlib.Path
        The workbook, for messages.
    name : str
        Of the part.
    """

    def __init__(self, path: Path, name: str) -> None:
        """Begin before the first byte."""
        self._path, self._name = path, name
        self._parser = expat.ParserCreate()
        self._parser.StartDoctypeDeclHandler = self._refuse

    def add(self, data: bytes) -> None:
        """The bytes that follow.

        Raises
        ------
        LogError
            If they cannot follow those before, or declare a document type.
        """
        self._parse(data, False)

    def finish(self) -> None:
        """After the last byte.

        Raises
        ------
        LogError
            If something is still open.
        """
        self._parse(b"", True)

    def _parse(self, data: bytes, is_last: bool) -> None:
        try:
            self._parser.Parse(data, is_last)
        except (expat.ExpatError, LookupError) as error:  # an encoding that there is not
            raise LogError(
                self._path, "the workbook is damaged", found=f"{self._name}: {error}",
                needed="well-formed XML", hint="Save it again with the program that wrote it.",
            ) from error  # fmt: skip

    def _refuse(self, *_declared: object) -> None:
        raise LogError(
            self._path, f"'{self._name}' declares a document type",
            needed="a workbook without entities",
        )  # fmt: skip
