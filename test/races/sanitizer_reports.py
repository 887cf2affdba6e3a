"""What the thread sanitizer wrote, and which of it concerns the package."""
import glob
import os
import re

SEPARATOR = "=" * 18
FRAME = re.compile(r"^    #\d+ .*? (?P<file>[^ ]+?)(:\d+)*( \((?P<module>[^()+]*)\+0x[0-9a-f]+\))?"
                   r"( \(BuildId: \w+\))?$")


def reports(log_path):
    """The texts of all reports in the logs of TSAN_OPTIONS=log_path=LOG_PATH."""
    found = []
    for name in sorted(glob.glob(log_path + ".*")):
        with open(name, encoding="utf-8", errors="replace") as log:
            found += [part for part in log.read().split(SEPARATOR) if "ThreadSanitizer:" in part]
    return found


class Judge:
    """Says of reports whether they concern the package.

    Strictly, a report names a file of the package as soon as the package created a mutex that
    roscpp holds, or called roscpp. And whenever roscpp lets go of a message or a buffer that the
    package has used, there is a report: Debian's roscpp is not built with the sanitizer, which
    therefore sees its calls of new, delete, memcpy, send and mutexes, but not the atomic reference
    counts of boost::shared_ptr by which its threads hand such objects over. So:

    - A data race counts when both accesses are the package's, or made by what it called: a file
      of the package lies somewhere in the stacks of both. Nobody else touches its data; where
      one access is roscpp's alone, it is of what roscpp hands over. A stack that the sanitizer
      could not restore may be the package's.
    - Mutexes that are locked in different orders don't count when all of them are locked by code
      without the sanitizer, that is, none of them is the package's.
    - Any other report counts that names a file of the package anywhere.
    """

    def __init__(self, root, build):
        self.own_folders = tuple(os.path.join(root, folder, "") for folder in ("src", "include"))
        self.build = build

    def names_package(self, report):
        """Whether the package has a file in any stack of the report, whatever it is about."""
        return any(self._is_own(stack) for stack in stacks(report).values())

    def concerns_package(self, report):
        if "ThreadSanitizer: data race" in report:
            accesses = list(stacks(report).values())[:2]
            return (any(map(self._is_own, accesses)) and
                    all(self._is_own(access) or not access for access in accesses))
        if "ThreadSanitizer: lock-order-inversion" in report:
            acquisitions = [stack for title, stack in stacks(report).items()
                            if "acquired here" in title]
            return (any(map(self._is_own, acquisitions)) and
                    any(map(is_instrumented, acquisitions)))
        return self.names_package(report)

    def _is_own(self, stack):
        """Whether a frame lies in a file of the package."""
        return any(os.path.normpath(os.path.join(self.build, frame["file"]))
                   .startswith(self.own_folders) for frame in stack)


def stacks(report):
    """The frames of each stack of a report, innermost first, by its title; in its order.

    Empty for a stack that could not be restored.
    """
    found = {}
    for section in report.split("\n\n"):
        lines = [line for line in section.splitlines() if "WARNING: " not in line]
        frames = [frame.groupdict() for frame in map(FRAME.match, lines) if frame]
        if frames or "[failed to restore the stack]" in section:
            found["%s [%d]" % (lines[0], len(found))] = frames
    return found


def is_instrumented(stack):
    """Whether code with the sanitizer called the interceptor, which has no source lines, of a
    function of the system."""
    for frame in stack:
        module = frame["module"] or ""
        is_interceptor = frame["file"] == "<null>" and not module.startswith("lib")
        if not is_interceptor:
            return module.startswith(("libsampled_data_observers", "constant_gain_observer"))
    return False
