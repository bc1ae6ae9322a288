"""What changed below a folder of products since its index was written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from reduction.catalogue.files import FileState, archives_below, state_of
from reduction.catalogue.index import Index

__all__ = ["Changes", "changes_since"]


@dataclass(frozen=True)
class Changes:
    """Archives of a folder against those of an index.

    Parameters
    ----------
    paths : dict of str to pathlib.Path
        Every archive that is there, by what is shown of its path.
    states : dict of str to FileState
        Of each.
    same : frozenset of str
        As they were when they were read.
    copied : dict of str to str
        Size and time of writing as they were, and yet another file or place: these count as
        they are if they say the same of themselves; the identity that the index has.
    gone : frozenset of str
        In the index alone.
    """

    paths: dict[str, Path]
    states: dict[str, FileState]
    same: frozenset[str] = frozenset()
    copied: dict[str, str] = field(default_factory=dict)
    gone: frozenset[str] = frozenset()

    @property
    def is_none(self) -> bool:
        """The index says what is there."""
        return not self.gone and len(self.same) == len(self.states)


def changes_since(index: Index | None, folder: Path) -> Changes:
    """Compare a folder with its index.

    Parameters
    ----------
    index : Index, optional
        Its numbers are not looked at; None where there is none.
    folder : pathlib.Path
        Holds a folder for each campaign.

    Raises
    ------
    SettingsError
        If the folder is none of processed campaigns.
    """
    paths, states = {}, {}
    for name, path in archives_below(folder).items():
        try:
            states[name] = state_of(path)
        except OSError:
            continue  # went away since the folder was read, or is a link to nothing
        paths[name] = path
    before = {} if index is None else index.states()
    same = frozenset(name for name, (state, _) in before.items() if states.get(name) == state)
    copied = {
        name: identity
        for name, (state, identity) in before.items()
        if identity and name in states and name not in same and states[name].is_written_alike(state)
    }
    gone = frozenset(name for name in before if name not in states)
    return Changes(paths, states, same, copied, gone)
