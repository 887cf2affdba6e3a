#!/usr/bin/env python3
"""Bags replayed and played live: the estimates must be the same, bit for bit, and good."""
import json
import math
import os
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
import recordings  # noqa: E402
from ros_tools import PACKAGE, RosProcess, find_tool, free_port, run_tool  # noqa: E402
ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
EXAMPLE = os.path.join(ROOT, "config", "examples", "ferrante2016_mass_spring")
MASS_SPRING = [os.path.join(EXAMPLE, name)
               for name in ("scenario.yaml", "observer.yaml", "gains.yaml")]
HUSKY = os.path.join(ROOT, "config", "husky_unicycle.yaml")
HUSKY_GPS = os.path.join(ROOT, "config", "husky_gps.yaml")
HUSKY_POSE = os.path.join(ROOT, "config", "husky_pose.yaml")
INERTIAL = os.path.join(ROOT, "config", "crazyflie_inertial.yaml")
CRAZYFLIE = os.path.join(ROOT, "config", "crazyflie_position.yaml")
TWO_SENSORS = os.path.join(ROOT, "config", "crazyflie_two_sensors.yaml")
BOUNDS = os.path.join(ROOT, "config", "crazyflie_bounds")
CRASH = [os.path.join(ROOT, "config", name)
         for name in ("crazyflie_position.yaml", "crazyflie_crash.yaml",
                      "crazyflie_crash_detector.yaml")]


class ReplayTestCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def replay(self, bag, configs, output, *arguments):
        run_tool("replay", bag, *configs, "-o", self.path(output), "--json",
                 self.path("summary.json"), *arguments)
        with open(self.path("summary.json")) as summary:
            return json.load(summary)


class ExampleTest(ReplayTestCase):
    """A shipped example, simulated."""

    def test_example_live_as_replayed(self):
        run_tool("simulate", MASS_SPRING[0], "-o", self.path("example.bag"))
        summary = self.replay(self.path("example.bag"), MASS_SPRING, "replayed.bag",
                              "--truth", "truth", "--from", "35", "--plot", self.path("plot.png"))
        self.assertLess(summary["rmse_norm"], 0.05)
        self.assertGreater(summary["samples_late"], 0)
        self.assertGreater(summary["rejected"]["duplicate of an event taken in before"], 0)
        with open(self.path("plot.png"), "rb") as plot:
            self.assertEqual(b"\x89PNG", plot.read(4))
        port = free_port()
        launch = self.path("example.launch")
        # On a busy machine /clock comes late, at this speed by seconds of simulated time.
        with open(launch, "w") as text:
            text.write("""<launch>
              <include file="%s">
                <arg name="speed" value="10"/>
                <arg name="output" value="%s"/>
              </include>
              <param name="observer/future_tolerance" value="10"/>
              <param name="observer/history/duration" value="20"/>
              <param name="observer/history/max_events" value="5000"/>
            </launch>""" % (os.path.join(EXAMPLE, "ferrante2016_mass_spring.launch"),
                            self.path("live.bag")))
        with RosProcess(["roslaunch", "--port", str(port), launch], port) as process:
            self.assertEqual(0, process.wait(90))  # it ends with the simulation
        run_tool("compare_estimates", self.path("live.bag"), self.path("replayed.bag"),
                 "--at-least", "20")  # others on a busy machine

    def test_certified_example_keeps_its_bound(self):
        plant = os.path.join(ROOT, "config", "examples", "ferrante2019_oscillator", "plant.yaml")
        scenario = os.path.join(os.path.dirname(plant), "scenario.yaml")
        gains = os.path.join(ROOT, "test", "certificate", "ferrante2019_oscillator_0.41.yaml")
        with open(self.path("assumptions.yaml"), "w") as assumptions:
            assumptions.write("error_assumptions: {initial_error: 1, noise: 0, disturbance: 1}\n")
        run_tool("simulate", plant, scenario, "-o", self.path("example.bag"))
        summary = self.replay(self.path("example.bag"),
                              [plant, gains, self.path("assumptions.yaml")], "replayed.bag",
                              "--truth", "truth")
        self.assertIn("ferrante2019_theorem2", summary["guarantee"])
        self.assertGreater(summary["error_bound"]["finite"], 3900)
        self.assertEqual(0, summary["error_bound"]["exceeded"])
        self.assertLess(summary["error_bound"]["largest_share"], 1)
        self.assertGreater(summary["error_bound"]["largest_share"], 0.001)
        for state in "z1", "z2":
            bound = summary["error_bounds"][state]
            self.assertEqual(summary["error_bound"]["finite"], bound["finite"])
            self.assertEqual(0, bound["exceeded"])
            self.assertLess(bound["largest_share"], 1)
            self.assertGreater(bound["largest_share"], 0.001)

    def test_a_gap_longer_than_the_history_leaves_no_estimate_out(self):
        run_tool("simulate", MASS_SPRING[0], "-o", self.path("example.bag"))
        with open(MASS_SPRING[1]) as observer:
            text = observer.read()
        # Without the frequent inputs, messages come up to 3 s apart.
        text = text.replace("history: {duration: 4.0,", "future_tolerance: 0\nhistory: {duration: 0.1,")
        with open(self.path("short.yaml"), "w") as short:
            short.write(text)
        configs = [MASS_SPRING[0], self.path("short.yaml"), MASS_SPRING[2]]
        summary = self.replay(self.path("example.bag"), configs, "out.bag", "input:=/none",
                              "--no-input", "--truth", "truth")
        alone = self.replay(self.path("example.bag"), configs, "out.bag", "input:=/none",
                            "--no-input")
        self.assertGreater(summary["estimates"], 1900)
        self.assertEqual(summary["estimates"], alone["estimates"])
        self.assertEqual(summary["final_state"], alone["final_state"])

    def test_the_transform_that_every_sample_lacks_is_named(self):
        import rosbag
        import rospy
        from geometry_msgs.msg import PointStamped

        with rosbag.Bag(self.path("gps.bag"), "w") as bag:
            for second in range(1, 11):
                message = PointStamped()
                message.header.stamp = rospy.Time(second)
                message.header.frame_id = "gps_origin"
                bag.write("/gps", message, message.header.stamp)
        with open(self.path("gps.yaml"), "w") as config:
            config.write("""
                observer: ConstantGainObserver
                plant: {states: [p], A: [[0]]}
                sensors:
                  gps:
                    C: [[1]]
                    source: {topic: gps, type: geometry_msgs/PointStamped, fields: [point.x],
                             frame: mapp}
                sampling: {T1: 1, T2: 1}
                gains: {L: [[1]]}
                """)
        summary = self.replay(self.path("gps.bag"), [self.path("gps.yaml")], "replayed.bag")
        self.assertEqual({"no transform into the configured frame came in time: "
                          "gps_origin -> mapp": 10}, summary["rejected"])

    def test_the_bag_that_is_read_is_never_written(self):
        run_tool("simulate", MASS_SPRING[0], "-o", self.path("example.bag"), "--duration", "3")
        os.symlink(self.path("example.bag"), self.path("link.png"))
        before = os.path.getsize(self.path("example.bag"))
        for option in ("-o", "--json", "--plot"):
            result = subprocess.run([find_tool("replay"), self.path("example.bag"), *MASS_SPRING,
                                     option, self.path("link.png")], check=False)
            self.assertNotEqual(0, result.returncode)
            self.assertEqual(before, os.path.getsize(self.path("example.bag")))

    def test_replay_refuses_bad_input_with_a_message(self):
        run_tool("simulate", MASS_SPRING[0], "-o", self.path("example.bag"), "--duration", "3")
        with open(self.path("text.bag"), "w") as text:
            text.write("no bag")
        for arguments, message in (
                ([self.path("nothing.bag"), *MASS_SPRING], "nothing.bag"),
                ([self.path("text.bag"), *MASS_SPRING], "text.bag"),
                ([self.path("example.bag"), MASS_SPRING[0]], "observer: expected"),
                ([self.path("example.bag"), *MASS_SPRING, MASS_SPRING[1]], "in one place only"),
                ([self.path("example.bag"), CRAZYFLIE], "no topic /vrpn_client_node/Drone1/pose"),
                ([self.path("example.bag"), *MASS_SPRING, "--truth", "x"], "no topic /x"),
                ([self.path("example.bag"), *MASS_SPRING, "--truth", "truth", "--compare",
                  "z9=z1"], "'z9'"),
                ([self.path("example.bag"), *MASS_SPRING, "--thin", "2", "1"], "T1 <= T2"),
                ([self.path("example.bag"), *MASS_SPRING, "position:=elsewhere"], "/elsewhere"),
                ([self.path("example.bag"), *MASS_SPRING, "-o", "/nonexistent/o.bag"],
                 "/nonexistent/o.bag")):
            result = subprocess.run([find_tool("replay"), *arguments], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, universal_newlines=True, check=False)
            self.assertNotEqual(0, result.returncode, arguments)
            self.assertIn(message, result.stdout)


class CrazyflieTest(ReplayTestCase):
    """The same with a real quadrotor's motion capture."""

    def setUp(self):
        super().setUp()
        self.bag = recordings.find("crazyflie_crash.bag")
        if self.bag is None:
            print("SKIPPED: crazyflie_crash.bag is not there")
            self.skipTest("crazyflie_crash.bag is not there")

    def test_thinned_replay_beats_holding_the_last_sample_twice(self):
        summary = self.replay(self.bag, [CRAZYFLIE], "thinned.bag", "--thin", "0.05", "0.2",
                              "--seed", "1", "--from", "3", "--to", "23")
        self.assertEqual({"x", "y", "z"}, set(summary["rmse"]))
        self.assertGreater(summary["compared_stamps"], 2300)
        self.assertGreater(summary["samples_used"], 150)
        self.assertEqual(0, summary["samples_rejected"])
        self.assertLess(summary["rmse_norm"], 0.5 * summary["hold_rmse_norm"])

    def test_two_sensors_at_times_of_their_own_beat_holding_their_last_samples_twice(self):
        truth = "/vrpn_client_node/Drone1/pose"
        summary = self.replay(self.bag, [TWO_SENSORS], "thinned.bag", "--thin-to-sampling",
                              "--seed", "1", "--from", "3", "--to", "23", "--truth", truth,
                              "--compare", *("%s=pose.position.%s" % (axis, axis)
                                             for axis in "xyz"))
        for name in ("height", "mocap"):
            intervals = summary["sensors"][name]["intervals"]
            self.assertGreater(intervals["count"], 100)
            self.assertEqual(0, intervals["below_T1"])
            self.assertLess(intervals["above_T2"], 2)  # the recording has a gap
        self.assertGreater(summary["sensors"]["height"]["samples_used"],
                           1.5 * summary["sensors"]["mocap"]["samples_used"])
        self.assertLess(summary["rmse_norm"], 0.5 * summary["hold_rmse_norm"])

    def test_inertial_sensors_carry_the_estimate_from_pose_to_pose(self):
        import rosbag

        truth = "/vrpn_client_node/Drone1/pose"
        summary = self.replay(self.bag, [INERTIAL], "inertial.bag", "--thin", "0.1", "0.5",
                              "--seed", "1", "--from", "3", "--to", "23", "--truth", truth,
                              "--compare", *("%s=pose.position.%s" % (axis, axis)
                                             for axis in "xyz"))
        self.assertEqual({}, summary["rejected"])
        with rosbag.Bag(self.bag) as recorded:
            start = recorded.get_start_time()
            poses = {message.header.stamp.to_nsec() // 10 ** 7: message.pose.orientation
                     for _, message, _ in recorded.read_messages(truth)}
        squares = []
        with rosbag.Bag(self.path("inertial.bag")) as replayed:
            for _, message, _ in replayed.read_messages("/estimate"):
                at = poses.get(message.header.stamp.to_nsec() // 10 ** 7)
                if at is None or not 3 < message.header.stamp.to_sec() - start < 23:
                    continue
                w, x, y, z = message.state[6:10]
                self.assertAlmostEqual(1.0, w * w + x * x + y * y + z * z, delta=1e-12)
                cosine = min(1.0, abs(w * at.w + x * at.x + y * at.y + z * at.z))
                squares.append((2 * math.degrees(math.acos(cosine))) ** 2)
        angle = math.sqrt(sum(squares) / len(squares))
        print("RMSE of the position %.4f m, of the orientation %.2f deg" %
              (summary["rmse_norm"], angle))
        self.assertGreater(len(squares), 1000)
        # Holding the last sample: 0.098 m; a Kalman filter of constant velocity: 0.0675 m.
        self.assertLess(summary["rmse_norm"], 0.035)
        self.assertLess(angle, 2.0)

    def test_bounds_of_one_and_of_two_sensors_hold_at_all_stamps(self):
        truth = ["--truth", "/vrpn_client_node/Drone1/pose", "--compare"]
        truth += ["%s=pose.position.%s" % (axis, axis) for axis in "xyz"]
        for sensors, options in (("one_sensor", []), ("two_sensors", truth)):
            configs = [os.path.join(BOUNDS, sensors + end) for end in (".yaml", "_gains.yaml")]
            summary = self.replay(self.bag, configs, "bounds.bag", "--thin-to-sampling", "--seed",
                                  "1", *options)
            self.assertGreater(summary["compared_stamps"], 3000)
            for bound in (summary["error_bound"], *summary["error_bounds"].values()):
                self.assertEqual(summary["compared_stamps"], bound["finite"])
                self.assertEqual(0, bound["exceeded"])
            self.assertGreater(summary["error_bounds"]["y"]["largest_share"], 0.1)
            self.assertLess(summary["rmse_norm"], 0.8 * summary["hold_rmse_norm"])

    def test_the_crash_is_detected_and_nothing_before(self):
        import rosbag
        from sampled_data_observers.msg import EventStatus

        self.replay(self.bag, CRASH, "crash.bag")
        with rosbag.Bag(self.path("crash.bag")) as replayed:
            jumps = [message.header.stamp.to_sec()
                     for _, message, _ in replayed.read_messages("/events")
                     if message.kind == EventStatus.JUMP]
        # The motion capture saw the fall end.
        with rosbag.Bag(self.bag) as recorded:
            start = recorded.get_start_time()
            heights = [(message.header.stamp.to_sec(), message.pose.position.z)
                       for _, message, _ in
                       recorded.read_messages("/vrpn_client_node/Drone1/pose")]
        fell_below = next(stamp for stamp, height in heights if stamp - start > 20 and height < 0.15)
        impact = next(stamp for (stamp, height), (_, next_height) in zip(heights, heights[1:])
                      if stamp > fell_below and next_height > height)
        print("impact at %.4f s, detected at %.4f s" % (impact - start, jumps[0] - start))
        self.assertLess(abs(jumps[0] - impact), 0.02)

    def test_with_the_crash_as_a_jump_the_position_recovers_better(self):
        # From the impact on, for a second and to the end.
        for end in ("24.6", "27"):
            sums = [0.0, 0.0]
            for seed in range(1, 11):
                for i, configs in enumerate(([CRAZYFLIE], CRASH)):
                    summary = self.replay(self.bag, configs, "thinned.bag", "--thin", "0.05",
                                          "0.2", "--seed", str(seed), "--from", "23.56",
                                          "--to", end)
                    sums[i] += summary["rmse_norm"] ** 2 / 10
            without, with_jump = (value ** 0.5 for value in sums)
            print("RMSE after the crash, up to %s s: %.4f m without the jump, %.4f m with it"
                  % (end, without, with_jump))
            self.assertLess(with_jump, without)

    def test_live_is_as_replayed_and_so_is_the_past_asked_for_afterwards(self):
        import rosbag
        import rospy
        from sampled_data_observers.srv import GetEstimate

        self.replay(self.bag, [CRAZYFLIE], "replayed.bag")
        port = free_port()
        launch = self.path("observer.launch")
        with open(launch, "w") as text:
            text.write("""<launch>
              <param name="use_sim_time" value="true"/>
              <node name="manager" pkg="nodelet" type="nodelet" args="manager"/>
              <include file="$(find sampled_data_observers)/launch/observer.launch">
                <arg name="config" value="%s"/>
                <arg name="manager" value="manager"/>
              </include>
              <node name="recorder" pkg="rosbag" type="record" args="-O %s /estimate"/>
            </launch>""" % (CRAZYFLIE, self.path("live.bag")))
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
        with RosProcess(["roslaunch", "--port", str(port), launch], port):
            play = ["rosbag", "play", "--quiet", "--clock", "--hz=1000", "--wait-for-subscribers",
                    "--delay=2", self.bag, "--topics", "/vrpn_client_node/Drone1/pose"]
            time.sleep(3)
            subprocess.run(play, check=True, timeout=120)
            rospy.wait_for_service("/get_estimate", 10)
            get_estimate = rospy.ServiceProxy("/get_estimate", GetEstimate, persistent=True)
            with rosbag.Bag(self.path("replayed.bag")) as replayed:
                expected = [message for _, message, _ in replayed.read_messages("/estimate")]
            self.assertGreater(len(expected), 2500)
            for estimate in expected[::10]:
                found = get_estimate(estimate.header.stamp)
                self.assertTrue(found.success, found.message)
                self.assertEqual(estimate.events, found.estimate.events)
                self.assertEqual(estimate.state, found.estimate.state)
        run_tool("compare_estimates", self.path("live.bag"), self.path("replayed.bag"),
                 "--at-least", "20")  # others on a busy machine


class HuskyTest(ReplayTestCase):
    """Wheels and a tilted IMU of a real robot, which drives 359 m around a parking lot."""

    # Where robot_localization's EKF ends on the same recording, and the tolerance of its own test.
    PUBLISHED_END = (-40.0454, -76.9988)
    PUBLISHED_HEIGHT = -2.6974
    TOLERANCE = 1.0452

    def setUp(self):
        super().setUp()
        self.bag = recordings.find("husky_parking_lot.bag")
        if self.bag is None:
            print("SKIPPED: husky_parking_lot.bag is not there")
            self.skipTest("husky_parking_lot.bag is not there")

    def test_ends_where_the_published_estimate_does(self):
        summary = self.replay(self.bag, [HUSKY], "replayed.bag")
        state = summary["final_state"]
        distance = math.hypot(state["x"] - self.PUBLISHED_END[0], state["y"] - self.PUBLISHED_END[1])
        print("end: x = %.2f m, y = %.2f m, %.2f m from the published one" %
              (state["x"], state["y"], distance))
        self.assertLess(distance, self.TOLERANCE)
        self.assertEqual({}, summary["rejected"])
        self.assertGreaterEqual(summary["intervals"]["min"], 1.0)
        self.assertLess(summary["intervals"]["max"], 1.05)

    def test_in_space_too_it_ends_where_the_published_estimate_does(self):
        summary = self.replay(self.bag, [HUSKY_POSE], "pose.bag")
        state = summary["final_state"]
        end = [state[axis] for axis in "xyz"]
        distance = math.dist(end, (*self.PUBLISHED_END, self.PUBLISHED_HEIGHT))
        print("end: %.2f, %.2f, %.2f m, %.2f m from the published one" % (*end, distance))
        self.assertLess(distance, 0.5 * self.TOLERANCE)
        self.assertLess(abs(end[2] - self.PUBLISHED_HEIGHT), 0.5)
        self.assertEqual({}, summary["rejected"])

    def test_seldom_fixes_of_a_gps_tell_position_and_heading(self):
        import rosbag

        with open(self.path("seldom.yaml"), "w") as seldom:
            seldom.write("sensors: {gps: {source: {min_interval: 6}}}")
        summary = self.replay(self.bag, [HUSKY_GPS, self.path("seldom.yaml")], "gps.bag", "--truth", "/fix",
                              "--compare", "x=east", "y=north", "--from", "60")
        self.assertEqual("[42.375812000, -71.147394667, 7.3000]", summary["datum"])
        self.assertLess(summary["samples_used"], 70)
        with rosbag.Bag(self.path("gps.bag")) as replayed:
            *_, (_, last, _) = replayed.read_messages("/estimate")
        heading = math.degrees(math.sqrt(last.covariance[2 * 4 + 2]))
        print("from fix to fix: %.2f m, heading known to %.1f deg" % (summary["rmse_norm"], heading))
        self.assertGreater(summary["compared_stamps"], 700)
        # 3.1 m if the last fix is held; the fixes' own noise is 0.7 m
        self.assertLess(summary["rmse_norm"], 2.0)
        self.assertLess(heading, 15.0)

    def test_fixes_and_the_path_of_the_wheels_are_alike(self):
        import rosbag

        self.replay(self.bag, [HUSKY_GPS], "gps.bag")
        with rosbag.Bag(self.path("gps.bag")) as replayed:
            estimates = {round(message.header.stamp.to_sec() * 30): complex(*message.state[:2])
                         for _, message, _ in replayed.read_messages("/estimate")}
        pairs = []
        with rosbag.Bag(self.bag) as recorded:
            for _, message, _ in recorded.read_messages("/husky_velocity_controller/odom"):
                position = message.pose.pose.position
                estimate = estimates.get(round(message.header.stamp.to_sec() * 30))
                if estimate is not None:
                    pairs.append((complex(position.x, position.y), estimate))
        mean = [sum(points) / len(pairs) for points in zip(*pairs)]
        turn = sum((there - mean[1]) * (here - mean[0]).conjugate() for here, there in pairs)
        turn /= abs(turn)
        squares = [abs(mean[1] + turn * (here - mean[0]) - there) ** 2 for here, there in pairs]
        length = sum(abs(pairs[i + 1][0] - pairs[i][0]) for i in range(len(pairs) - 1))
        rmse = math.sqrt(sum(squares) / len(squares))
        print("wheels and GPS: %.1f m apart on %.0f m" % (rmse, length))
        self.assertGreater(len(pairs), 3900)
        self.assertLess(rmse, 0.025 * length)  # what the wheels slip

    def test_live_is_as_replayed(self):
        import rosbag
        import rospy
        from sampled_data_observers.srv import GetEstimate

        self.replay(self.bag, [HUSKY], "replayed.bag")
        self.replay(self.bag, [HUSKY_GPS], "gps.bag")
        port = free_port()
        launch = self.path("observer.launch")
        # So fast that messages come seconds of simulated time before and after the clock's.
        with open(launch, "w") as text:
            text.write("""<launch>
              <param name="use_sim_time" value="true"/>
              <include file="$(find sampled_data_observers)/launch/observer.launch">
                <arg name="config" value="%s"/>
              </include>
              <param name="observer/future_tolerance" value="60"/>
              <param name="observer/history/duration" value="120"/>
              <param name="observer/history/max_events" value="10000"/>
              <group ns="gps">
                <include file="$(find sampled_data_observers)/launch/observer.launch">
                  <arg name="config" value="%s"/>
                </include>
                <param name="observer/future_tolerance" value="60"/>
                <param name="observer/history/duration" value="120"/>
                <param name="observer/history/max_events" value="10000"/>
              </group>
            </launch>""" % (HUSKY, HUSKY_GPS))
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
        with RosProcess(["roslaunch", "--port", str(port), launch], port):
            time.sleep(3)
            subprocess.run(["rosbag", "play", "--quiet", "--clock", "--hz=1000", "--rate=10",
                            "--wait-for-subscribers", "--duration=120", self.bag, "--topics",
                            "/imu/data", "/husky_velocity_controller/odom", "/fix"],
                           check=True, timeout=120)
            for bag, service in (("replayed.bag", "/get_estimate"), ("gps.bag", "/gps/get_estimate")):
                rospy.wait_for_service(service, 10)
                get_estimate = rospy.ServiceProxy(service, GetEstimate, persistent=True)
                with rosbag.Bag(self.path(bag)) as replayed:
                    expected = [message for _, message, _ in replayed.read_messages("/estimate")]
                first = expected[0].header.stamp
                compared = [estimate for estimate in expected
                            if 100 < (estimate.header.stamp - first).to_sec() < 118]
                self.assertGreater(len(compared), 500)
                for estimate in compared[::10]:
                    found = get_estimate(estimate.header.stamp)
                    self.assertTrue(found.success, found.message)
                    self.assertEqual(estimate.events, found.estimate.events)
                    self.assertEqual(estimate.state, found.estimate.state)
                    self.assertEqual(estimate.covariance, found.estimate.covariance)


if __name__ == "__main__":
    import rostest
    rostest.rosrun(PACKAGE, "live_replay_test", "live_replay_test", sys.argv)
