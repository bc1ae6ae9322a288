"""Run the IOOS compliance checker on archives: ``python tests/compliance.py FILE...``.

Same as ``compliance-checker -t cf:1.11 -c strict FILE...``, but quick: the checker asks
the same questions of the file again for each pair of variables (25 s for 200 of them),
and here each answer is remembered.  It knows no groups: each group is given to it as a flat file
with the coordinates that it inherits.  Each archive is held against the schema too.  Exit status 0
says that nothing was found.  With ``--serve`` paths are read line by line, as tests/rulesofcf.py
writes them.
"""

import copy
import functools
import json
import os
import sys
import tempfile
import traceback
from pathlib import Path
from tempfile import TemporaryDirectory

from archive_check import check_archive
from compliance_checker.cf import util
from compliance_checker.runner import CheckSuite, ComplianceChecker
from flat_groups import write_flat_groups


def remembered(function):
    """Answer from memory; a copy, since callers change what they are given."""
    answers = functools.cache(function)

    @functools.wraps(function)
    def answer(*arguments, **options):
        return copy.copy(answers(*arguments, **options))

    return answer


def main(paths):
    for name, function in vars(util).copy().items():
        if name.startswith("get_") and callable(function):
            setattr(util, name, remembered(function))
    CheckSuite.load_all_available_checkers()
    passed = []
    for path in paths:
        faults = check_archive(Path(path))
        sys.stdout.write("".join(f"{one}\n" for one in faults))
        passed.append(not faults)
        with TemporaryDirectory() as folder:
            for flat in write_flat_groups(path, folder):
                good, failed = ComplianceChecker.run_checker(
                    str(flat), ["cf:1.11"], 0, "strict", output_filename="-", output_format="text"
                )
                passed.append(good and not failed)
    return 0 if passed and all(passed) else 1


def serve():
    """Answer each line of paths from a process of its own, which begins with everything loaded."""
    for line in sys.stdin:
        with tempfile.TemporaryFile() as out:
            child = os.fork()
            if not child:
                os.dup2(out.fileno(), 1)
                os.dup2(out.fileno(), 2)
                status = 1
                try:
                    status = main(json.loads(line))
                except BaseException:
                    traceback.print_exc()
                finally:
                    sys.stdout.flush()
                    sys.stderr.flush()
                    os._exit(status)
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            out.seek(0)
            sys.stdout.write(json.dumps([status, out.read().decode()]) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(serve() if sys.argv[1:] == ["--serve"] else main(sys.argv[1:]))
