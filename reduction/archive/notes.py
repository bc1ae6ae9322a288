"""Every note of every stage in one list, each once, with the stage that gave it."""

from __future__ import annotations

from collections.abc import Iterator

from reduction.archive.values import Values, texts
from reduction.product import ReducedTest

__all__ = ["note_values"]


def note_values(test: ReducedTest) -> Values:
    """Return the notes in the order of the stages.

    A note that is given twice is kept once, under the stage that is nearest to it.
    """
    once: dict[str, str] = {}
    for stage, text in _all_notes(test):
        once.setdefault(text, stage)
    return {"note": texts(list(once)), "note_stage": texts(list(once.values()))}


def _all_notes(test: ReducedTest) -> Iterator[tuple[str, str]]:
    if test.record is not None:
        yield from (("ingest", text) for text in test.record.notes)
    for specimen in test.specimens:
        yield from ((f"specimen {specimen.name}", text) for text in specimen.notes)
    for model in test.strain_models:
        yield from ((f"strain {model.specimen}", text) for text in model.notes)
    stages = (
        ("cycles", test.cycles),
        ("moduli", test.curves),
        ("first loading", test.first_loading),
        ("slips", test.slips),
        ("comparison", test.ratio),
        ("stepwise", test.stepwise),
    )
    for stage, product in stages:
        if product is not None:
            yield from ((stage, text) for text in product.notes)
    for fit in test.elastomers:
        yield from ((f"{fit.law} {fit.specimen}", text) for text in fit.notes)
    for number, hold in enumerate(test.holds, start=1):
        yield from ((f"hold {number} {hold.specimen}", text) for text in hold.notes)
        yield from (
            (f"hold {number} {hold.specimen}", f"refused: {text}") for text in hold.refusals
        )
    yield from (("test", text) for text in test.notes)
