#!/usr/bin/env python3
"""All pages in Chromium: pages_in_browser_test.py SIMULATE REPLAY DESIGN

Skipped where there is no Chromium; scripts/install_deps test brings it along."""
import importlib.machinery
import importlib.util
import math
import os
import subprocess
import sys
import threading
import unittest

import genpy
from sampled_data_observers.msg import EventStatus, StateEstimate

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from browser import Browser, find_browser  # noqa: E402
from folder_test import FolderTest  # noqa: E402

SKIPPED = 77
EXAMPLES = os.path.join(ROOT, "config", "examples")
CHECKS = os.path.join(HERE, "figures.js")
TOOLS = {}
HEIGHT = 900  # pixels

# A puck between two walls: a path, jumps, outliers, late samples, and a covariance.
PUCK = """
plant:
  states: [x, y, v, w]
  units: {x: m, y: m, v: m/s, w: m/s}
  A: [[0, 0, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0]]
  jump_map: {A_d: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, -1]]}
sensors: {camera: {C: [[1, 0, 0, 0], [0, 1, 0, 0]], gate: {innovation: [0.5, 0.5], recovery: {after: 5, action: accept}}, source: {topic: camera}}}
jumps: {topic: jumps}
scenario:
  duration: 10
  initial_state: {x: 0, y: 0.1, v: 0.2, w: 0.7}
  jumps: {when: "max(-y, y - 1)", min_separation: 0.01}
  sensors: {camera: {schedule: {uniform: [0.05, 0.15]}, latency: [0, 0.1], noise: {formulas: ["3*(sin(5*t) > 0.95)", "0.01*sin(70*t)"]}}}
"""
FILTER = """
observer: HybridKalmanFilter
rate: 50
frame_id: map
publish_delay: 0.11
sampling: {T1: 0.06, T2: 0.14}
initial_estimate: {x: 0, y: 0.1, v: 0, w: 0.6}
outputs: {base_frame: puck, position: {x: x, y: y}, odometry: {topic: odometry}}
gains: {Q: [[0.001, 0, 0, 0], [0, 0.001, 0, 0], [0, 0, 0.01, 0], [0, 0, 0, 0.01]], R: {camera: [[0.01, 0], [0, 0.01]]},
        P0: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}
"""
# ferrante2019, example 1
OSCILLATOR = """
plant: {states: [z1, z2], A: [[0, 1], [-4, 0]]}
sensors: {position: {C: [[1, 0]]}}
design:
  sampling: {T1: 0.1, T2: 0.41}
  N: [[1], [0]]
  C_p: [[1, 0], [0, 1]]
  parameters: {lambda_t: 0.05}
"""


def run_tool(name, *arguments):
    result = subprocess.run([TOOLS[name], *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                            check=False)
    assert result.returncode == 0, result.stdout


def program(name):
    """One that is written in Python, as a module."""
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(ROOT, "src", "tools", name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


class PageTest(FolderTest):
    browser = None

    def show(self, address, width=1280, is_dark=False, until="true"):
        """Loads a page, waits until it is drawn, and looks at what all have in common."""
        with open(CHECKS, encoding="utf-8") as file:
            self.browser.show(address, width, HEIGHT, is_dark, file.read())
        self.browser.run("checks.until(() => %s).then(() => checks.frames(3))" % until)
        self.assertEqual(self.browser.faults(), [])
        self.assertEqual(self.browser.run("document.documentElement.classList.contains('dark')"), is_dark)
        self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), width)
        self.assertEqual(self.browser.run("checks.layout()"), [])

    def look_at(self, path, least_figures, unseen=()):
        """What every page of a file has to do; of curves that are covered by others, the keys in `unseen`."""
        address = "file://" + path
        self.show(address, 1920, is_dark=True)
        self.show(address)
        self.look_at_curves(least_figures, unseen)
        self.assertEqual(self.browser.faults(), [])

    def look_at_curves(self, least_figures, unseen=()):
        self.assertGreaterEqual(len(self.browser.run("checks.figures()")), least_figures)
        self.assertEqual(set(self.browser.run("checks.unseen()")), set(unseen))
        self.assertEqual(self.browser.run("checks.logFaults()"), [])

    def times(self, title):
        return self.browser.run("checks.times(%r)" % title)

    def zoom(self, title):
        place = self.browser.run("checks.place(%r)" % title)
        y = place["top"] + place["height"] / 2
        self.browser.drag((place["left"] + 0.4 * place["width"], y), (place["left"] + 0.6 * place["width"], y))
        self.browser.run("checks.frames()")

    def reset(self, title):
        place = self.browser.run("checks.place(%r)" % title)
        self.browser.click(place["left"] + place["width"] / 2, place["top"] + place["height"] / 2, count=2)
        self.browser.run("checks.frames()")

    def zoom_moves(self, title, others):
        """A drag in one chart moves the axes of others, and a double click brings all back."""
        before = [self.times(each) for each in (title, *others)]
        self.zoom(title)
        zoomed = [self.times(each) for each in (title, *others)]
        for one, other in zip(before, zoomed):
            self.assertNotEqual(one, other)
        self.assertEqual([labels for labels in zoomed if labels != zoomed[0]], [])
        self.reset(title)
        self.assertEqual([self.times(each) for each in (title, *others)], before)


class AxesTest(PageTest):
    def test_logarithmic_axes_have_labels_however_little_they_show(self):
        with open(os.path.join(ROOT, "src", "page", "axes.js"), encoding="utf-8") as file:
            axes = file.read()
        for low, high in ((0.5, 0.62), (-3.01, -2.95), (2.35, 2.4), (0.1, 0.9), (-8, 5)):
            ticks = self.browser.run("(() => {%s\nreturn logTicks(%r, %r, 5);})()" % (axes, low, high))
            self.assertGreaterEqual(len(ticks), 2, (low, high))
            for tick in ticks:
                self.assertTrue(low - 1e-9 <= tick["value"] <= high + 1e-9, tick)
                said = float(tick["label"].replace("\u2212", "-"))
                self.assertAlmostEqual(said, 10 ** tick["value"], delta=1e-6 * said)


class CurvesTest(PageTest):
    THINNED = """(() => {
      %s
      const points = [];
      const note = (x, y) => points.push([x, y]);
      const context = {beginPath() {}, stroke() {}, fill() {}, moveTo: note, lineTo: note};
      const view = {from: 0, to: 1000, left: 0, right: 1000, x: (t) => t, y: (v) => v};
      // Entries of ten stamps each, one value for each stamp: the stamp, or its distance from the end.
      const times = Float64Array.from({length: 100}, (_, k) => 10 * k);
      const thinned = (low, high) => Object.assign(new Series(times, {high: {}}), {levels: [{low: times.map(low), high: times.map(high)}]});
      const rises = thinned((t) => t, (t) => t + 9);
      const falls = thinned((t) => 991 - t, (t) => 1000 - t);
      const drawn = (draw, layer) => { points.length = 0; draw(context, view, {colour: "estimate", ...layer}); return [...points]; };
      return {rises: drawn(drawLine, {series: rises}), falls: drawn(drawLine, {series: falls}),
              band: drawn(drawBand, {centre: rises, width: thinned(() => 5, () => 5)})};
    })()"""

    def test_thinned_curves_go_through_what_they_stand_for_and_bands_around_it(self):
        self.browser.show("data:text/html,<script type=application/json id=data>{}</script>")
        scripts = []
        for name in ("data", "axes", "drawing"):
            with open(os.path.join(ROOT, "src", "page", name + ".js"), encoding="utf-8") as file:
                scripts.append(file.read())
        drawn = self.browser.run(self.THINNED % "".join(scripts))
        self.assertEqual([len(drawn[key]) for key in ("rises", "falls", "band")], [200, 200, 400])
        for x, y in drawn["rises"]:
            self.assertLessEqual(abs(y - x), 9 if x == 990 else 1, x)  # the last entry has no end
        for x, y in drawn["falls"]:
            self.assertLessEqual(abs(1000 - y - x), 9 if x == 990 else 1, x)
        for x, y in drawn["band"]:
            self.assertLessEqual(abs(abs(y - x) - 5), 9 if x == 990 else 1, x)


class ReportTest(PageTest):
    def report(self, scenario, *observer):
        run_tool("simulate", scenario, "-o", self.path("run.bag"))
        run_tool("replay", self.path("run.bag"), scenario, *observer, "--truth", "truth", "--report", self.path("report.html"))
        return self.path("report.html")

    def select(self, place, value):
        self.browser.run("""(() => {
          const select = document.querySelectorAll("#events select")[%d];
          select.value = %r;
          select.dispatchEvent(new Event("change"));
        })()""" % (place, value))
        return int(self.browser.run("document.querySelector('#events .filters .note').textContent").split(" of ")[0])

    def test_of_a_run_with_a_bound(self):
        folder = os.path.join(EXAMPLES, "ferrante2016_mass_spring")
        self.look_at(self.report(*(os.path.join(folder, name + ".yaml")
                                   for name in ("scenario", "observer", "assumptions", "gains_timer_dependent"))), 16)
        self.zoom_moves("z1 [m]", ["Error of z1 [m]", "z2 [m]"])
        place = self.browser.run("checks.place('z1 [m]')")
        self.browser.mouse("Moved", place["left"] + 300, place["top"] + 50)
        # The keys of all charts tell the values at the pointer.
        self.assertGreaterEqual(self.browser.run("[...document.querySelectorAll('#states .value')].filter((key) => key.textContent).length"), 10)
        every = self.select(1, "")
        late = self.select(1, "1")
        self.assertTrue(0 < late < every, (late, every))

    def test_of_a_run_with_jumps_and_a_covariance(self):
        self.look_at(self.report(self.write("scenario.yaml", PUCK), self.write("observer.yaml", FILTER)), 16)
        titles = self.browser.run("checks.figures()")
        for title in ("From above", "Jumps j", "(t, j, x), drag to turn", "camera: NIS"):
            self.assertIn(title, titles)
        self.saves_pictures()
        self.browser.run("document.querySelector('#toolbar button:last-child').click()")
        self.assertTrue(self.browser.run("document.documentElement.classList.contains('dark')"))


    def saves_pictures(self):
        """Of a chart with many keys and little width, which go on in a second row."""
        self.show("file://" + self.path("report.html"), 1000)
        saved = self.browser.run("""(async () => {
          const saved = {};
          HTMLAnchorElement.prototype.click = function () { saved[this.download.split(".")[1]] = this.href; };
          document.querySelectorAll("#states figure:first-child .export").forEach((button) => button.click());
          const image = new Image();
          image.src = saved.png;
          await image.decode();
          document.body.innerHTML = decodeURIComponent(saved.svg.split(",").slice(1).join(","));
          const texts = [...document.querySelectorAll("svg text")].map((text) => [text.textContent, text.getBBox()]);
          const {width, height} = document.querySelector("svg").viewBox.baseVal;
          return {png: [image.naturalWidth, image.naturalHeight], svg: [width, height], texts: texts.map(([text]) => text),
                  cut: texts.filter(([, box]) => box.x < 0 || box.x + box.width > width).map(([text]) => text)};
        })()""")
        self.assertEqual(saved["png"], [2 * length for length in saved["svg"]])
        self.assertGreater(saved["svg"][1], 210 + 34)
        self.assertEqual(saved["cut"], [])
        for text in ("x [m]", "jumps", "3\u03c3", "truth", "samples used", "used late", "gated", "estimate", "time [s]"):
            self.assertIn(text, saved["texts"])
        self.show("file://" + self.path("report.html"))


class DesignTest(PageTest):
    def test_of_a_sweep(self):
        run_tool("design", "sweep", self.write("plant.yaml", OSCILLATOR), "-o", self.path("sweep"), "--method", "ferrante2019_proposition2",
                 "--T2", "0.1", "0.41", "--points", "2", "--jobs", "2")
        self.look_at(self.path("sweep/report.html"), 1)
        title, = self.browser.run("checks.figures()")
        self.assertIn("T2 [s]", self.times(title))
        self.assertEqual(self.browser.run("document.querySelector('.tools button').getAttribute('aria-pressed')"), "true")
        self.zoom_moves(title, [])

    def test_of_an_explanation(self):
        run_tool("design", "explain", os.path.join(EXAMPLES, "ferrante2016_mass_spring", "scenario.yaml"), "--report",
                 self.path("explain.html"))
        self.look_at(self.path("explain.html"), 1)
        title, = self.browser.run("checks.figures()")
        self.zoom_moves(title, [])


class GalleryTest(PageTest):
    def test_of_one_paper(self):
        folder = os.path.join(EXAMPLES, "etienne2019_dc_drive")
        files = [os.path.join(folder, name + ".yaml") for name in ("scenario", "observer", "gains_printed")]
        run_tool("simulate", files[0], "-o", self.path("run.bag"))
        run_tool("replay", self.path("run.bag"), *files,
                 self.write("start.yaml", "start: {at: 1000}"), "--truth", "truth", "--csv", self.path("etienne2019_fig1"))
        subprocess.run([sys.executable, os.path.join(ROOT, "scripts", "paper_gallery"), self.folder, "etienne2019"], check=True,
                       stdout=subprocess.DEVNULL)
        self.look_at(self.path("gallery.html"), 3)
        self.zoom_moves("x2", ["x3", "samples"])


class LiveTest(PageTest):
    def serve(self):
        live_view = program("live_view")
        self.feed = live_view.Feed(20)
        live_view.Handler.feed = self.feed
        sensors = {"gps": {"states": ["p"], "T1": 0.1, "T2": 0.4}}
        live_view.Handler.make_page = staticmethod(
            lambda: live_view.page("Live: /observer", {"units": {"p": "m", "v": "m/s", "gps": "m"}, "sensors": sensors}, 20))
        server = live_view.Server(("127.0.0.1", 0), live_view.Handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        return "http://localhost:%d/" % server.server_address[1]

    def add(self, begin, end):
        for k in range(begin, end):
            t = 0.1 * k
            truth = StateEstimate(names=["p", "v"], state=[math.sin(t), math.cos(t)])
            message = StateEstimate(names=["p", "v"], state=[math.sin(t) + 0.2 * math.exp(-t), math.cos(t) + 0.1], jumps=k // 60,
                                    error_bound=0.5, error_bounds=[0.4, 0.3], covariance=[0.01, 0.0, 0.0, 0.04])
            truth.header.stamp = message.header.stamp = genpy.Time.from_sec(10 + t)
            self.feed.add_truth(truth)
            self.feed.add_estimate(message)
            if k % 3 == 0:
                outcomes = (EventStatus.USED, EventStatus.USED_LATE, EventStatus.GATED, EventStatus.NOT_FINITE)
                status = EventStatus(source="gps", kind=EventStatus.SAMPLE, outcome=outcomes[k // 3 % 4], reason="as it is", latency=0.01 * (k % 5),
                                     interval=0.1 * (k % 5), values=[math.sin(t)], innovation=[0.1 * math.sin(9 * t)], nis=math.nan)
                status.header.stamp = message.header.stamp
                self.feed.add_event(status)
            if k % 60 == 59:
                status = EventStatus(source="jumps", kind=EventStatus.JUMP, outcome=EventStatus.USED, reason="used", interval=math.nan, nis=math.nan)
                status.header.stamp = message.header.stamp
                self.feed.add_event(status)
        self.feed.flush()

    def test_what_it_shows_and_that_it_follows(self):
        address = self.serve()
        for begin in range(0, 120, 40):
            self.add(begin, begin + 40)
        self.show(address, 1920, is_dark=True, until="document.querySelectorAll('.plot').length >= 8")
        self.show(address, until="document.querySelectorAll('.plot').length >= 8")
        self.look_at_curves(8)
        self.zoom_moves("p [m]", ["Error of p [m]", "v [m/s]"])
        self.add(120, 160)
        self.browser.run("checks.until(() => document.querySelector('#status li').textContent.includes('15.90 s'))")
        self.assertEqual(self.browser.run("[...document.querySelectorAll('#status li')].some((line) => line.className === 'bad')"), False)
        self.assertEqual(self.browser.faults(), [])


def main():
    if find_browser() is None:
        print("skipped: no Chromium (scripts/install_deps test)")
        return SKIPPED
    TOOLS.update(zip(("simulate", "replay", "design"), sys.argv[1:4]))
    with Browser(find_browser()) as PageTest.browser:
        return not unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2, exit=False).result.wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
