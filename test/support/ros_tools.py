"""What tests in python need of ROS: the package's tools, and launches with a roscore of their own."""
import functools
import os
import signal
import subprocess

PACKAGE = "sampled_data_observers"
FREE_PORT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts", "free_port")

# A shell has what it starts in the background ignore Ctrl-C, and so all that this starts.
signal.signal(signal.SIGINT, signal.default_int_handler)


def free_port():
    return int(subprocess.check_output([FREE_PORT]))


@functools.lru_cache(maxsize=None)
def find_tool(name):
    found = subprocess.check_output(["catkin_find", "--first-only", "--libexec", PACKAGE, name])
    return found.decode().strip()


def run_tool(name, *arguments):
    result = subprocess.run([find_tool(name), *arguments], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    print(result.stdout)
    if result.returncode != 0:
        raise AssertionError("%s failed: %s" % (name, result.stdout))
    return result.stdout


def end_rospy_node():
    import rospy
    try:
        rospy.signal_shutdown("done")
    except AttributeError as fault:
        # The last that rospy before 1.15.10 does takes what Python 3.9 has no more.
        if "isAlive" not in str(fault):
            raise


class RosProcess:
    """A process with a roscore of its own, ended as a person would: by Ctrl-C."""

    def __init__(self, command, port):
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port)
        self.process = subprocess.Popen(command, env=environment)

    def __enter__(self):
        return self.process

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
