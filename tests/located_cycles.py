"""The cycles of a series as the reduction finds them: past its standstills."""

from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.standstills import find_standstills

AS_BY_DEFAULT = CycleSettings()


def cycles_of_log(time, position, tension, *, settings=AS_BY_DEFAULT, cycle_counter=None):
    """Find the cycles of a record."""
    stands = find_standstills(time, position, tension, settings=PhaseSettings())
    return find_cycles(
        time, position, tension, stands, settings=settings, cycle_counter=cycle_counter
    )
