"""The ledger of claims as the page shows it: sorted by section. Rulings are the program's."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from data.results import Claim, Finding
from pages.counts import counted, grouped

RULINGS = ("confirmed", "confirmed under a condition", "refuted", "undecided")


@dataclass
class Deciding:
    """A finding that decides a claim; None where the run has no finding of this name."""
    name: str
    role: str          # "supports" | "limits" | "contradicts"
    finding: Finding | None


@dataclass
class ClaimView:
    """One row of the ledger."""
    claim: Claim
    deciding: list[Deciding]

    @property
    def as_recorded(self) -> bool:
        """False if another ruling was expected."""
        claim = self.claim
        waits = claim.ruling == "undecided" and bool(claim.missing)
        return not claim.recorded or claim.recorded == claim.ruling or waits


def claim_views(claims: Iterable[Claim], findings: Iterable[Finding]) -> list[ClaimView]:
    """All rows of the ledger."""
    known = {finding.name: finding for finding in findings}
    return [
        ClaimView(claim, [Deciding(name, role, known.get(name)) for name, role in claim.decided_by])
        for claim in claims
    ]


def ruling_counts(views: Iterable[ClaimView]) -> list[tuple[str, int]]:
    """How many claims have each ruling; only those that occur."""
    return count_rulings(view.claim for view in views)


def count_rulings(claims: Iterable[Claim]) -> list[tuple[str, int]]:
    """The same of claims themselves."""
    rulings = counted((claim.ruling for claim in claims), RULINGS)
    return [(ruling, count) for ruling, count in rulings if count]


def by_paper(views: Iterable[ClaimView]) -> dict[str, list[ClaimView]]:
    """Rows by paper, each under "BMF03: its title (2003)"."""
    return grouped(
        views,
        lambda view: ": ".join(part for part in (view.claim.paper, view.claim.paper_title) if part)
    )


def by_section(views: Iterable[ClaimView]) -> dict[str, list[ClaimView]]:
    """Rows by the section of the paper."""
    return grouped(views, lambda view: view.claim.section)
