"""OpenFAST's MoorDyn module: the grammar of MoorDyn, other options, tables sought elsewhere.

Not run by the tests of this package: OpenFAST is no Python package.

References
----------
.. [1] MoorDyn documentation, "Input Files", v2.7.1, 2026, notes on MoorDyn-F.
"""

from __future__ import annotations

from reduction.export.deck import NO_GRAVITY, WEIGHTLESS
from reduction.export.header import header_lines
from reduction.export.moordyn import MoorDynForm, moordyn_files
from reduction.export.product import ExportLine

# OpenFAST hands its own gravity to the module, unless the file has another
_LEFT_OUT = ("0 writeLog", "1 disableOutTime", "10 TmaxIC", "0.1 dtIC", NO_GRAVITY, WEIGHTLESS)
_ABOUT_GRAVITY = "gravity is that of OpenFAST: the line sags, and has more tension than its strain"


def openfast_files(line: ExportLine, stem: str, *, form: MoorDynForm = "table") -> dict[str, str]:
    """Files of a line type for OpenFAST, the input file of its MoorDyn module first.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    stem : str
        Of the names of the files beside it.
    form : {"table", "static-dynamic", "load-dependent", "syrope"}
        As `reduction.export.moordyn.moordyn_files`.

    Returns
    -------
    files : dict of str to str
        Text by name; the key of the input file is empty.

    Raises
    ------
    SettingsError, DataError
        As `reduction.export.moordyn.moordyn_files`.
    """
    files = moordyn_files(line, stem, form=form)
    remarks = ["grammar of MoorDyn, not run in OpenFAST", _ABOUT_GRAVITY]
    if form in ("table", "syrope"):
        remarks.append(
            "files that are named here are sought beside the executable: put them there, or write "
            "the path"
        )
    if form == "syrope":
        remarks.append("Syrope needs an OpenFAST of June 2026 or later")
    first, *rest = files.pop("").split("\n")
    said = header_lines(line, None, *remarks)
    said = said[next(place for place, text in enumerate(said) if text.startswith("Remark")) :]
    kept = [row for row in rest if row not in _LEFT_OUT]
    return {"": "\n".join([first, *said, *kept]), **files}
