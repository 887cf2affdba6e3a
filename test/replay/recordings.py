"""Real robots' recordings for the tests, kept outside the package."""
import os
import tempfile

import rosbag

FOLDERS = [os.environ.get("SDO_RECORDINGS", ""),
           os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared", "data")]


def is_readable(path):
    try:
        with rosbag.Bag(path):
            return True
    except rosbag.ROSBagException:
        return False


def find(name):
    """The path of a readable recording, or None.

    Copies of crazyflie_crash.bag are about from which '/tmp/' was cut out wherever it stood in a
    log message, so that all offsets behind it are wrong. The messages tell where it belongs.
    """
    for folder in FOLDERS:
        path = os.path.join(folder, name)
        if not folder or not os.path.exists(path):
            continue
        if is_readable(path):
            return path
        with open(path, "rb") as damaged:
            data = damaged.read().replace(b"binarydeb/", b"/tmp/binarydeb/")
        mended = os.path.join(tempfile.mkdtemp(), name)
        with open(mended, "wb") as out:
            out.write(data)
        if is_readable(mended):
            return mended
        raise RuntimeError(path + " is damaged in a way that is not known")
    return None
