#!/usr/bin/env python3
"""Publishes every second sample, each when it is taken.

Usage: sensor.py FIRST: from which sample on. When it has a subscriber it says so by a parameter,
and waits for another one, which says when the first sample is taken.
"""
import itertools
import sys

import genpy
import rospy
from oscillation import samples
from sampled_data_observers.msg import Measurement


def main():
    first = int(sys.argv[1])
    rospy.init_node("sensor_%d" % first)
    publisher = rospy.Publisher("position", Measurement, queue_size=1000, tcp_nodelay=True)
    while publisher.get_num_connections() == 0:
        rospy.sleep(0.05)
    rospy.set_param("~is_ready", True)
    while not rospy.has_param("/start"):
        rospy.sleep(0.2)
    start = int(rospy.get_param("/start"))
    for time, value in itertools.islice(samples(), first, None, 2):
        stamp = genpy.Time(nsecs=start + time)
        rospy.sleep(stamp - rospy.Time.now())
        if rospy.is_shutdown():
            return
        message = Measurement(values=[value])
        message.header.stamp = stamp
        publisher.publish(message)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass
