"""Chromium without a window, driven over a pipe: prints a page, asks it questions. No network.

    with Browser() as browser:
        browser.open(page, width=390, dark=True)
        browser.evaluate("document.title")
"""
from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from base64 import b64decode
from pathlib import Path
from typing import Any

PACKAGE = "chromium"
SECONDS = 120                       # that any one answer may take
_SWITCHES = (
    "--headless=new", "--remote-debugging-pipe", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-extensions", "--no-first-run",
    "--disable-background-networking", "--host-resolver-rules=MAP * ~NOTFOUND", "--hide-scrollbars",
    "--disable-dev-shm-usage", "--force-color-profile=srgb"
)

_KEYS = {"Tab": (9, ""), "Enter": (13, "\r"), " ": (32, " ")}   # their codes, what they write


class NoBrowser(Exception):
    """There is no Chromium here, or it does not answer."""


def find_browser() -> str:
    """The path of the program. Throws NoBrowser if it is not there."""
    program = shutil.which(PACKAGE)
    if program is None:
        raise NoBrowser(
            f"there is no {PACKAGE} here to print with; it is Debian's package {PACKAGE}"
        )
    return program


class Browser:
    """One Chromium with one page. What the page says on its console, and what
    it asks of the network, is kept."""

    def __init__(self) -> None:
        program = find_browser()
        self.complaints: list[str] = []      # errors of the page
        self.requests: list[str] = []        # addresses that the page asked for
        self._last, self._loads, self._unread = 0, 0, b""
        self._folder = tempfile.TemporaryDirectory(
            prefix="foldproof-browser-", ignore_cleanup_errors=True
        )
        self._start(program)
        try:
            target = self._call("Target.createTarget", url="about:blank")["targetId"]
            self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)[
                "sessionId"
            ]
            for domain in ("Page", "Runtime", "Log", "Network"):
                self._call(f"{domain}.enable")
        except NoBrowser:
            self.close()
            raise

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def open(
        self, page: Path, fragment: str = "", width: int = 1400, height: int = 900,
        dark: bool = False, script: bool = True, still: bool = False
    ) -> None:
        """Loads a file and waits until it is drawn. still: for a reader who wants as
        little motion as there can be."""
        self._call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
            mobile=width < 600
        )
        self._call(
            "Emulation.setEmulatedMedia",
            features=[
                {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
                {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"},
            ],
        )
        self._call("Emulation.setScriptExecutionDisabled", value=not script)
        self._load("about:blank")   # a page that differs in its fragment alone would not be loaded
        self._load(page.resolve().as_uri() + fragment)

    def evaluate(self, expression: str) -> Any:
        """The value of an expression in the page; of a promise, what it comes to.
        Throws NoBrowser for what throws."""
        reply = self._call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in reply:
            raise NoBrowser(
                f"{expression}:"
                f" {reply['exceptionDetails'].get('exception', {}).get('description', 'error')}"
            )
        return reply["result"].get("value")

    def press(self, key: str) -> None:
        """One key as from a keyboard: one that writes a letter, or one of _KEYS."""
        code, text = _KEYS.get(key, (0, key))
        for kind in ("keyDown", "keyUp"):
            self._call(
                "Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code,
                text=text if kind == "keyDown" else ""
            )

    def pdf(self, head: str, foot: str) -> bytes:
        """The page on A4 paper with an outline; `head` and `foot` are HTML with a style of its own,
        repeated on every sheet."""
        inch = 1 / 25.4
        reply = self._call(
            "Page.printToPDF", paperWidth=210 * inch, paperHeight=297 * inch, marginTop=18 * inch,
            marginBottom=18 * inch, marginLeft=16 * inch, marginRight=16 * inch,
            printBackground=True, displayHeaderFooter=True, headerTemplate=head,
            footerTemplate=foot, generateTaggedPDF=True, generateDocumentOutline=True
        )
        return b64decode(reply["data"])

    def close(self) -> None:
        """Ends the browser and removes its files."""
        for end in (self._to, self._from):
            os.close(end)
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._folder.cleanup()

    def _start(self, program: str) -> None:
        """The browser reads file descriptor 3 and writes 4."""
        its_in, self._to = os.pipe()
        self._from, its_out = os.pipe()
        switches = [
            *_SWITCHES, f"--user-data-dir={self._folder.name}",
            *(["--no-sandbox"] if os.geteuid() == 0 else [])
        ]
        # the two are moved out of each other's way before they take their places
        shell = f'exec {{a}}<&{its_in} {{b}}>&{its_out} 3<&- 4>&-; exec 3<&$a 4>&$b; exec "$0" "$@"'
        self._process = subprocess.Popen(
            ["/bin/bash", "-c", shell, program, *switches], pass_fds=(its_in, its_out),
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        os.close(its_in)
        os.close(its_out)

    def _call(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._last += 1
        message = {"id": self._last, "method": method, "params": parameters}
        if hasattr(self, "_session"):
            message["sessionId"] = self._session
        try:
            os.write(self._to, json.dumps(message).encode("utf-8") + b"\0")
        except OSError as error:
            raise NoBrowser(f"{PACKAGE} ended: {error}") from error
        while True:
            reply = self._next(method)
            if reply.get("id") == self._last:
                if "error" in reply:
                    raise NoBrowser(f"{PACKAGE} refuses {method}: {reply['error'].get('message')}")
                return reply.get("result", {})

    def _load(self, address: str) -> None:
        before = self._loads
        self._call("Page.navigate", url=address)
        while self._loads == before:
            self._next(f"Page.navigate to {address}")

    def _next(self, awaited: str) -> dict[str, Any]:
        """The next message of the browser. Throws NoBrowser if none comes in time."""
        end = time.monotonic() + SECONDS
        parts = [self._unread]
        while b"\0" not in parts[-1]:
            ready, _, _ = select.select([self._from], [], [], max(end - time.monotonic(), 0))
            parts.append(os.read(self._from, 1 << 20) if ready else b"")
            if not parts[-1]:
                raise NoBrowser(f"{PACKAGE} gives no answer to {awaited}")
        text, _, self._unread = b"".join(parts).partition(b"\0")
        reply = json.loads(text)
        self._note(reply.get("method"), reply.get("params", {}))
        return reply

    def _note(self, event: str | None, reply: dict[str, Any]) -> None:
        if event == "Page.loadEventFired":
            self._loads += 1
        elif event == "Runtime.exceptionThrown":
            details = reply["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description", details["text"]))
        elif event == "Log.entryAdded" and reply["entry"]["level"] == "error":
            self.complaints.append(reply["entry"]["text"])
        elif event == "Runtime.consoleAPICalled" and reply["type"] in ("error", "assert"):
            self.complaints.append(
                " ".join(str(part.get("value", part.get("description"))) for part in reply["args"])
            )
        elif event == "Network.requestWillBeSent" and not reply["request"]["url"].startswith(
            "data:"
        ):
            self.requests.append(reply["request"]["url"])
