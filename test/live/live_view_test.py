#!/usr/bin/env python3
"""The server of live_view, the markers of estimate_markers and the summary of run_summary, without a master: live_view_test.py"""
import http.client
import importlib.machinery
import importlib.util
import json
import math
import os
import threading
import unittest

import genpy
import numpy
from sampled_data_observers.msg import ErrorEllipsoid, EventStatus, StateEstimate

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "src", "tools")


def tool(name):
    """A program as a module."""
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(TOOLS, name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


live_view = tool("live_view")
run_summary = tool("run_summary")
estimate_markers = tool("estimate_markers")


def estimate(t, x, bound=math.nan, names=("p",)):
    message = StateEstimate(names=list(names), state=list(x), error_bound=bound)
    message.error_bounds = [] if math.isnan(bound) else [bound] * len(x)
    message.header.stamp = genpy.Time.from_sec(t)
    return message


def event(t, outcome=EventStatus.USED, reason="used"):
    message = EventStatus(source="s", kind=EventStatus.SAMPLE, outcome=outcome, reason=reason, values=[1.5], innovation=[0.5], interval=math.nan)
    message.header.stamp = genpy.Time.from_sec(t)
    return message


class FeedTest(unittest.TestCase):
    def batches(self, feed):
        feed.flush()
        return [json.loads(text) for _, text in feed.after(0, 0)]

    def test_truth_meets_the_estimate_of_its_stamp_whichever_comes_first(self):
        feed = live_view.Feed(10)
        feed.add_truth(estimate(1, [2]))
        feed.add_estimate(estimate(1, [3], bound=math.inf))
        feed.add_estimate(estimate(1.5, [4], bound=2))
        feed.add_truth(estimate(1.5, [5]))
        feed.add_truth(estimate(1.7, [5]))
        batch, = self.batches(feed)
        self.assertEqual(batch["compared"], [{"t": 0.0, "truth": [2]}, {"t": 0.5, "truth": [5]}])
        self.assertEqual([entry["bound"] for entry in batch["estimates"]], [None, 2])

    def test_it_holds_no_more_than_its_seconds_and_tells_what_it_leaves_out(self):
        feed = live_view.Feed(1)
        for k in range(100):
            for i in range(150):
                feed.add_estimate(estimate(k + i / 1000, [i]))
                feed.add_truth(estimate(k + 0.0005 + i / 1000, [i]))
            for i in range(300):
                feed.add_event(event(k + i / 1000))
            feed.flush()
        self.assertEqual(len(feed.batches), 10)
        self.assertLessEqual(len(feed.waiting["truth"]), live_view.MOST_WAITING)
        batch = json.loads(feed.batches[-1][1])
        self.assertEqual((len(batch["estimates"]), batch["count"]), (50, 150))
        self.assertEqual((len(batch["events"]), batch["left_out"]), (200, 100))

    def test_time_that_goes_back_begins_anew(self):
        feed = live_view.Feed(10)
        feed.add_estimate(estimate(100, [1]))
        feed.flush()
        feed.add_estimate(estimate(1, [2]))
        first, second = self.batches(feed)
        self.assertEqual(first, {"restart": True})
        self.assertEqual([entry["t"] for entry in second["estimates"]], [0.0])


class ServerTest(unittest.TestCase):
    def setUp(self):
        self.feed = live_view.Feed(10)
        live_view.Handler.feed = self.feed
        settings = {"units": {"p": "m </script>"}, "sensors": {}}
        live_view.Handler.make_page = staticmethod(lambda: live_view.page("Live", settings, 10))
        self.server = live_view.Server(("127.0.0.1", 0), live_view.Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def tearDown(self):
        self.server.shutdown()
        self.server.server_close()

    def get(self, path, host="localhost:1"):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.server_address[1], timeout=10)
        connection.request("GET", path, headers={"Host": host})
        return connection.getresponse()

    def test_it_serves_one_page_that_asks_no_other_host(self):
        text = self.get("/").read().decode("utf-8")
        self.assertIn("connect-src 'self'", text)
        self.assertEqual(text.count("</script"), 2)
        self.assertNotIn("/* SCRIPT */", text)
        self.assertEqual(self.get("/etc/passwd").status, 404)
        self.assertEqual(self.get("/", host="elsewhere.example:1").status, 403)

    def test_it_tells_what_comes(self):
        self.feed.add_estimate(estimate(1, [2]))
        self.feed.flush()
        answer = self.get("/stream")
        self.assertEqual(answer.getheader("Content-Type"), "text/event-stream")
        self.assertEqual(json.loads(answer.readline()[len("data: "):]), {"restart": True})
        answer.readline()
        self.assertEqual(json.loads(answer.readline()[len("data: "):])["estimates"][0]["x"], [2.0])
        answer.readline()
        self.feed.add_event(event(1, EventStatus.GATED, "outside"))
        self.feed.flush()
        told = json.loads(answer.readline()[len("data: "):])["events"][0]
        self.assertEqual((told["reason"], told["values"], told["interval"]), ("outside", [1.5], None))


class MarkersTest(unittest.TestCase):
    def setUp(self):
        self.markers = estimate_markers.Markers.__new__(estimate_markers.Markers)  # without a publisher
        self.markers.lock = threading.Lock()
        self.markers.frame, self.markers.size, self.markers.observer = "map", 0.3, "/observer"
        self.markers.forget()
        self.markers.settings = {"position": ["p", "q", 0.5], "yaw": None, "sensors": {"s": {"states": ["p"]}}}

    def see(self, t, x, bound, jumps=0):
        message = estimate(t, x, bound, names=("p", "q"))
        message.jumps = jumps
        self.markers.add_estimate(message)
        return dict(zip(message.names, message.state))

    def test_the_box_holds_what_the_bounds_allow(self):
        values = self.see(1, [1, 2], bound=0.25)
        box, ball = self.markers.guaranteed(values)
        self.assertEqual((box.scale.x, box.scale.y, ball.scale.z), (0.5, 0.5, 0.5))
        self.assertEqual((box.pose.position.x, box.pose.position.y, box.pose.position.z), (1, 2, 0.5))
        self.assertEqual({marker.action for marker in self.markers.guaranteed(self.see(2, [1, 2], bound=math.inf))}, {box.DELETE})

    def see_ellipsoid(self, t, Q, names=("p", "q", "r")):
        message = ErrorEllipsoid(names=list(names), matrix=numpy.ravel(Q).tolist())
        message.header.stamp = genpy.Time.from_sec(t)
        self.markers.add_ellipsoid(message)
        return self.markers.guaranteed_ellipsoid()

    def matrix_of(self, marker):
        """Of the ellipsoid that a marker draws."""
        q = marker.pose.orientation
        v, w = numpy.array([q.x, q.y, q.z]), q.w
        R = (w * w - v @ v) * numpy.eye(3) + 2 * numpy.outer(v, v) + 2 * w * numpy.cross(numpy.eye(3), v)
        numpy.testing.assert_allclose(R @ R.T, numpy.eye(3), atol=1e-14)
        return R @ numpy.diag([marker.scale.x / 2, marker.scale.y / 2, marker.scale.z / 2]) ** 2 @ R.T

    def test_the_ellipsoid_is_that_of_the_position_and_holds_it(self):
        random = numpy.random.RandomState(1)
        for k in range(200):
            self.markers.settings = {"position": [["p", "q", "r"], ["r", "p", 0.5], ["q", None, "p"]][k % 3], "yaw": None, "sensors": {}}
            self.markers.add_estimate(estimate(k, [1, 2, 3], 1, names=("p", "q", "r")))
            root = random.randn(3, 3) @ numpy.diag(10.0 ** random.uniform(-3, 3, 3)) if k > 5 else numpy.eye(3)
            Q = root @ root.T
            marker = self.see_ellipsoid(k, Q)
            self.assertEqual(marker.action, marker.ADD)
            selection = numpy.array([[float(name == axis) for name in "pqr"] for axis in self.markers.settings["position"]])
            wanted, drawn = selection @ Q @ selection.T, self.matrix_of(marker)
            size = numpy.trace(drawn)
            self.assertGreaterEqual(numpy.linalg.eigvalsh(drawn - wanted).min(), 0.0)
            numpy.testing.assert_allclose(drawn, wanted, atol=1e-11 * size + estimate_markers.LEAST_SPREAD ** 2)

    def test_the_ellipsoid_stands_around_the_estimate_of_its_stamp(self):
        self.see(1, [1, 2], 1)
        self.see(2, [3, 4], 1)
        marker = self.see_ellipsoid(1, numpy.eye(2), names=("p", "q"))
        self.assertEqual((marker.pose.position.x, marker.pose.position.y, marker.pose.position.z), (1, 2, 0.5))
        self.assertEqual(self.see_ellipsoid(7, 9 * numpy.eye(2), names=("p", "q")).pose, marker.pose)  # of which no estimate is known
        nothing = self.see_ellipsoid(2, numpy.diag([math.inf, math.inf]), names=("p", "q"))
        self.assertEqual(nothing.action, nothing.DELETE)

    def test_the_path_has_a_gap_at_jumps_and_samples_lie_where_they_were_measured(self):
        for t, (x, jumps) in enumerate(((0, 0), (1, 0), (5, 1), (6, 1)), 1):
            self.see(t, [x, 0], 1, jumps)
        self.assertEqual([point.x for point in self.markers.lines().points], [0, 1, 5, 6])
        self.assertEqual([point.x for point in self.markers.jumps], [5])
        self.markers.add_event(event(4))
        self.markers.add_event(event(4, EventStatus.GATED))
        point, = self.markers.samples["samples"]
        self.assertEqual((point.x, point.y, point.z), (1.5, 0, 0.5))
        self.assertEqual(len(self.markers.samples["rejected"]), 1)
        empty = self.markers.points("jumps", [])
        self.assertEqual(empty.action, empty.DELETE)


class SummaryTest(unittest.TestCase):
    def test_the_table(self):
        summary = run_summary.Summary()
        for t, x, truth, bound in ((1, 3.0, 0.0, 4.0), (2, 4.0, 8.0, 3.0), (3, 1.0, 1.0, math.inf)):
            summary.add_truth(estimate(t, [truth]))
            summary.add_estimate(estimate(t, [x], bound))
        for outcome, reason in ((EventStatus.USED, ""), (EventStatus.USED_LATE, ""), (EventStatus.GATED, "outside the gate")):
            summary.add_event(event(1, outcome, reason))
        text = summary.text()
        self.assertIn("3 estimates; 2 events used, 1 of them late; 1 rejected or without effect", text)
        self.assertIn("1 x outside the gate", text)
        row = [line for line in text.splitlines() if line.startswith("p ")][0].split()
        self.assertEqual(row[1:4], ["%.4g" % math.sqrt(25 / 3), "4", "0"])
        self.assertIn("EXCEEDED at 1 of 2 stamps", text)


if __name__ == "__main__":
    unittest.main()
