"""A Chromium without a window, for the tests: opens a page, asks it, takes its picture. It is spoken to through a pair of pipes."""
from __future__ import annotations

import base64
import json
import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

OPTIONS = ("--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
           "--remote-debugging-pipe")


class Browser:
    """One page of so many CSS pixels; use it in a `with`."""

    def __init__(self, width: int = 1000, height: int = 800, **media: str) -> None:
        self._folder = tempfile.TemporaryDirectory()
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()

        def take_pipes() -> None:                       # Chromium reads from 3 and writes to 4
            reader, writer = os.dup(to_browser), os.dup(from_browser)
            for descriptor, wanted in ((os.dup(reader), 3), (os.dup(writer), 4)):
                os.dup2(descriptor, wanted)

        self._process = subprocess.Popen(["chromium", *OPTIONS, f"--user-data-dir={self._folder.name}"], close_fds=False,
                                         preexec_fn=take_pipes, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self._rest, self._count, self._session = b"", 0, ""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia", features=[{"name": f"prefers-{key.replace('_', '-')}", "value": value}
                                                          for key, value in media.items()])

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._write)
        os.close(self._read)
        self._folder.cleanup()

    def open(self, page: Path) -> None:
        """Loads a page to its end."""
        self.call("Page.navigate", url=page.resolve().as_uri())
        self.ask("new Promise((done) => document.readyState === 'complete' ? done() : addEventListener('load', done))")

    def ask(self, script: str) -> Any:
        """The value of an expression; promises are waited for. Throws RuntimeError if it throws."""
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:2000])
        return answer["result"].get("value")

    def picture(self) -> bytes:
        """What is seen of the page, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Sends one command of the DevTools protocol and waits for its answer."""
        self._count += 1
        said = {"id": self._count, "method": method, "params": parameters} | ({"sessionId": self._session} if self._session else {})
        os.write(self._write, json.dumps(said).encode("utf-8") + b"\0")
        while True:
            told = self._message()
            if told.get("id") == self._count:
                if "error" in told:
                    raise RuntimeError(f"{method}: {told['error']}")
                return told["result"]

    def _message(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            part = os.read(self._read, 1 << 16)
            if not part:
                raise RuntimeError("chromium has ended")
            self._rest += part
        whole, _, self._rest = self._rest.partition(b"\0")
        return json.loads(whole)
