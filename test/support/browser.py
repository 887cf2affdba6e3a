"""A Chromium without a screen, asked over its debugging protocol (https://chromedevtools.github.io/devtools-protocol) by pipes: Python's
own library is enough, and what is awaited is an answer, never a time."""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PROGRAMS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
PATIENCE = 120  # s, after which a test fails that nothing answers


def find_browser():
    """The path of a browser, or None."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Browser:
    def __init__(self, program):
        self.folder = tempfile.TemporaryDirectory()
        to_browser, self.requests = os.pipe()
        self.answers, from_browser = os.pipe()
        # The browser reads from 3 and writes to 4: the shell moves them there, from where neither is in the way.
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (to_browser, from_browser)]
        self.process = subprocess.Popen(
            ["bash", "-c", 'exec "$@" 3<&%d 4>&%d' % tuple(ends), "bash", program, "--headless", "--no-sandbox", "--disable-gpu",
             "--disable-dev-shm-usage",  # a container may have little of it
             "--hide-scrollbars", "--force-color-profile=srgb", "--user-data-dir=" + self.folder.name, "--remote-debugging-pipe",
             "about:blank"],
            pass_fds=ends, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for end in (to_browser, from_browser, *ends):
            os.close(end)
        self.rest = b""
        self.count = 0
        self.events = []
        target = self.ask("Target.createTarget", {"url": "about:blank"}, session=None)["targetId"]
        self.session = self.ask("Target.attachToTarget", {"targetId": target, "flatten": True}, session=None)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.ask(domain + ".enable")

    def close(self):
        try:
            self.ask("Browser.close", session=None)
            self.process.wait(PATIENCE)
        finally:
            self.process.kill()
            self.process.wait()
            os.close(self.requests)
            os.close(self.answers)
            self.folder.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def read(self):
        """The next message of the browser."""
        end = time.monotonic() + PATIENCE
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.answers], [], [], max(0.0, end - time.monotonic()))
            got = os.read(self.answers, 1 << 20) if ready else b""
            assert got, "the browser does not answer" if not ready else "the browser has ended"
            self.rest += got
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, parameters=None, session=""):
        """The result of a command, of this page unless `session` is None."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters or {}}
        if session is not None:
            message["sessionId"] = session or self.session
        os.write(self.requests, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.read()
            if answer.get("id") == self.count:
                assert "error" not in answer, "%s: %s" % (method, answer.get("error"))
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method):
        """The first event of a kind since it was last waited for one."""
        while True:
            for event in self.events:
                if event["method"] == method:
                    self.events.remove(event)
                    return event["params"]
            self.events.append(self.read())

    def show(self, address, width=1280, height=900, is_dark=False, first=""):
        """Loads a page, in a window of that size; `first` is a script that is run before those of the page."""
        self.ask("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        self.ask("Emulation.setEmulatedMedia",
                 {"features": [{"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}]})
        self.faults()
        script = self.ask("Page.addScriptToEvaluateOnNewDocument", {"source": first})["identifier"]
        self.events = [event for event in self.events if event["method"] != "Page.loadEventFired"]
        self.ask("Page.navigate", {"url": address})
        self.wait_for("Page.loadEventFired")
        self.ask("Page.removeScriptToEvaluateOnNewDocument", {"identifier": script})

    def run(self, expression):
        """The value of an expression of JavaScript, or of the promise that it is."""
        result = self.ask("Runtime.evaluate", {"expression": expression, "awaitPromise": True, "returnByValue": True, "userGesture": True})
        assert "exceptionDetails" not in result, json.dumps(result["exceptionDetails"], indent=1)
        return result["result"].get("value")

    def mouse(self, kind, x, y, **properties):
        self.ask("Input.dispatchMouseEvent", {"type": "mouse" + kind, "x": x, "y": y, **properties})

    def click(self, x, y, count=1):
        for number in range(1, count + 1):
            for kind in ("Pressed", "Released"):
                self.mouse(kind, x, y, button="left", clickCount=number)

    def drag(self, start, end):
        self.mouse("Moved", *start)
        self.mouse("Pressed", *start, button="left", clickCount=1)
        self.mouse("Moved", *end, button="left", buttons=1)
        self.mouse("Released", *end, button="left", clickCount=1)

    def faults(self):
        """What scripts ran into, and what else the browser complained of, since it was last asked."""
        said = []
        for event in self.events:
            told = event.get("params", {})
            if event["method"] == "Runtime.exceptionThrown":
                details = told["exceptionDetails"]
                said.append(details.get("exception", {}).get("description") or details["text"])
            elif event["method"] == "Runtime.consoleAPICalled" and told["type"] in ("error", "assert", "warning"):
                said.append(" ".join(str(value.get("value", "")) for value in told["args"]))
            elif event["method"] == "Log.entryAdded" and told["entry"]["level"] in ("error", "warning"):
                said.append(told["entry"]["text"])
        self.events = [event for event in self.events if event["method"].startswith("Page.")]
        return said

    def photograph(self, path, whole=True):
        """A picture of the window, or of the whole page."""
        if whole:
            size = self.ask("Page.getLayoutMetrics")["cssContentSize"]
            width = self.run("innerWidth")
            self.ask("Emulation.setDeviceMetricsOverride",
                     {"width": width, "height": int(size["height"]), "deviceScaleFactor": 1, "mobile": False})
            self.run("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve))))")
        picture = self.ask("Page.captureScreenshot", {"format": "png"})["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture))
