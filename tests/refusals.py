"""One test of every call of a table that is refused."""

import pytest


def refusals(cases):
    """Test of cases by name: a call, its error, and a pattern of the message."""

    @pytest.mark.parametrize("what", cases)
    def is_refused(what):
        call, error, message = cases[what]
        with pytest.raises(error, match=message):
            call()

    return is_refused
