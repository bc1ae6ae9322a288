"""Every note of every stage in one list, with the stage that gave it."""

from __future__ import annotations

from collections.abc import Iterator

from reduction.archive.values import Values, texts
from reduction.product import ReducedTest

__all__ = ["note_values"]


def note_values(test: ReducedTest) -> Values:
    """Return the notes in the order of the stages.

    The notes of the test repeat some of its stages; those are kept under the stage alone.
    """
    pairs = list(dict.fromkeys(_stage_notes(test)))
    said = {text for _, text in pairs}
    pairs += [("test", text) for text in dict.fromkeys(test.notes) if text not in said]
    return {
        "note": texts([text for _, text in pairs]),
        "note_stage": texts([stage for stage, _ in pairs]),
    }


def _stage_notes(test: ReducedTest) -> Iterator[tuple[str, str]]:
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
