"""Which pages are followed as a reader would, and which commands of others are left out, and why."""
import re

# Pages of one course build on each other, and are followed in this order.
COURSES = [
    ['README.md'],
    ['doc/tutorials/linear_observer.md', 'doc/tutorials/python.md'],
    ['doc/tutorials/mobile_robot.md'],
    ['doc/tutorials/altitude.md'],
    ['doc/tutorials/impacts.md'],
    ['doc/tutorials/own_plant.md'],
    ['doc/design_tool.md'],
    ['doc/migration.md', 'doc/simulation.md'],
]

# Whose files a page takes, as it says.
FILES_OF = {'doc/design_tool.md': 'README.md'}

# Blocks of commands that nobody follows here.
LEFT_OUT = {
    'names to be replaced': r'\b(BAG|FOLDER|SCENARIO|LIVE)\b|-- withdraw',
    'recordings that are too large for the clone': r'crazyflie_crash|husky_parking_lot',
    'builds, tests and benchmarks, which are followed by themselves': r'scripts/(build|demo|test|lint|bench|try_on)\b|\bctest\b',
    'takes minutes': r'design sweep|independent_check|^design synthesize',
    'takes RViz': r'view\.launch',
}

# Pages of which no block is followed.
NOT_FOLLOWED = {
    'doc/replay.md': 'files of the reader',
    'doc/ros_interface.md': 'files of the reader',
    'doc/jumps.md': 'a message to an observer of the reader',
    'doc/live_view.md': 'test/live/live_view_test.py, and the same launch is in README.md',
}

# Commands that end with another exit status than 0, as their pages say.
EXIT_STATUS = {r'design check_ell .*bernard2022_clutch': 2}


def is_left_out(block):
    """Whether a block of commands is one that nobody follows here."""
    return any(re.search(pattern, block, re.MULTILINE) for pattern in LEFT_OUT.values())


def course_of(page):
    """The course that a page is in."""
    return next(course for course in COURSES if page in course)
