"""Runs without the page of the campaign, which takes longer than all the rest."""

from reduction.report.campaign_page import CampaignAnswers, CampaignPage

NO_ANSWERS = CampaignAnswers((), False, (), frozenset(), {})


def leave_out_page(patch):
    """No section is made of an archive, and no page of the sections."""
    patch.setattr(CampaignPage, "add", lambda *given: None)
    patch.setattr(CampaignPage, "write", lambda *given, **shown: (None, NO_ANSWERS))
