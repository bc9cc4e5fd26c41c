"""The page of verdict as Markdown, and how many words it has."""
from __future__ import annotations

import re

from pages.sentences import Quoted, escaped_markdown, markdown_of
from pages.summary import Summary

TITLE = "foldproof: the verdict on one page"


def count_words(summary: Summary) -> int:
    """Words of the page: what stands between blanks and has a letter or a digit."""
    return sum(bool(re.search(r"\w", word)) for word in summary_markdown(summary).split())


def summary_markdown(summary: Summary) -> str:
    """The same for a pull request."""
    lines = [f"# {TITLE}", "", f"**{markdown_of(summary.verdict)}**", ""]
    lines += [f"- {label}: {escaped_markdown(words)}" for label, words in summary.tested]
    lines += [f"- {label}: {escaped_markdown(words)}" for label, words in summary.details]
    lines += [f"- asked: {markdown_of(summary.asked)}"] if summary.asked else []
    lines += ["", "## Scope", "", markdown_of(summary.scope)]
    if summary.conclusions:
        lines += ["", "## Conclusions", ""]
        for number, one in enumerate(summary.conclusions, start=1):
            said = [f"**{markdown_of(one.headline)}**", markdown_of(one.rest).strip(),
                    f"*{markdown_of(one.advice)}*" if one.advice else ""]
            lines.append(f"{number}. {' '.join(part for part in said if part)}")
    if summary.limits:
        lines += ["", f"## {summary.limits_title}", ""]
        lines += [f"- {markdown_of(limit)}" for limit in summary.limits]
    if summary.margins:
        lines += ["", "## Tightest margins", "", "| finding | remaining margin |", "|---|---:|"]
        lines += [
            f"| {_name(margin.finding.name)} | {markdown_of([margin.left])} |"
            for margin in summary.margins
        ]
        lines += ["", markdown_of(summary.attained)] if summary.attained else []
    if summary.faults:
        lines += ["", "## Seeded faults", "", markdown_of(summary.faults)]
    if summary.since:
        lines += ["", "## Since the last run", "", markdown_of(summary.since)]
    return "\n".join([*lines, ""])


def _name(name: str) -> str:
    return markdown_of([Quoted(name.replace("|", "/"), "", is_name=True)])
