"""Runs a page as a reader would: writes the files that it shows, runs its commands, and compares what they print."""
import os
import re
import signal
import subprocess
import time

from pages import ROOT

LIVE = re.compile(r'\b(roslaunch|rostopic|rosservice)\b')
NOT_FOLLOWED = re.compile(r'\b(scripts/demo|scripts/test)\b')  # the gate itself
ASK_FOR = 12  # s, until a topic or a service must have answered
KEEP_UP = 8  # s that a launch must last, or end by itself without a fault
NUMBER = re.compile(r'-?\d+(?:\.\d+)?(?:e[+-]?\d+)?')
TOLERANCE = 0.03  # relative: solvers and compilers differ in last digits, and so do designs


def steps_of(page):
    """Triples (line number, kind, text) in their order: files as (number, name, text), `bash` and `text` blocks."""
    steps = []
    blocks = sorted(page.blocks('yaml', 'bash', 'text', 'cpp', 'xml', 'cmake', with_language=True))
    for number, language, text in blocks:
        name = file_before(page, number)
        if language == 'bash' or language == 'text':
            steps.append((number, language, text))
        elif name:
            steps.append((number, name, text))
    return steps


def file_before(page, number):
    """The file that a block shows: the last name in the paragraph before it, where that ends with a colon."""
    paragraph = []
    for line in reversed(page.lines[:number - 1]):
        if not line.strip() and paragraph:
            break
        paragraph.insert(0, line)
    text = ' '.join(paragraph).strip()
    names = re.findall(r'`([\w/]+\.(?:yaml|cpp|xml|txt))`', text)
    return names[-1] if names and re.search(r'`:$|\b([Ww]rite|in) `.*:$', text) else None


def missing_lines(expected, output):
    """Lines of an expected text that are not in an output: `…` stands for anything, numbers may differ a little."""
    found = output.split('\n')
    return [line for line in expected.strip('\n').split('\n') if line.strip() and not any(agree(line, other) for other in found)]


def agree(expected, line):
    """Whether a printed line is as expected."""
    pattern = '.*'.join(re.escape(part) for part in NUMBER.sub('\0', ' '.join(expected.split())).split('…'))
    pattern = pattern.replace(re.escape('\0'), f'({NUMBER.pattern})')
    match = re.fullmatch(pattern.replace(r'\ ', r'\s+'), line.strip())
    if not match:
        return False
    numbers = [float(number) for number in NUMBER.findall(expected)]
    return all(abs(float(actual) - number) <= TOLERANCE * abs(number) for actual, number in zip(match.groups(), numbers))


class Reader:
    """Follows pages in a scratch folder that looks like the clone."""

    def __init__(self, folder, port):
        self.folder = folder
        self.environment = dict(os.environ, ROS_MASTER_URI=f'http://localhost:{port}', ROS_HOSTNAME='localhost',
                                ROS_HOME=os.path.join(folder, 'ros'))
        self.launched = None
        self.seconds = {}
        for name in ('scripts', 'config', 'doc', 'bench', 'test'):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))

    def follow(self, page):
        """The faults of a page."""
        faults, output, setup = [], '', ''
        for number, kind, text in steps_of(page):
            where = f'{page.path}:{number}'
            if kind == 'text':
                faults += [f'{where}: not printed: {line}' for line in missing_lines(text, output)]
            elif kind != 'bash':
                path = os.path.join(self.folder, kind)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, 'w', encoding='utf-8') as file:
                    file.write(text)
            elif LIVE.search(text):
                faults += [f'{where}: {fault}' for fault in self.follow_live(text)]
            elif not NOT_FOLLOWED.search(text):
                began = time.monotonic()
                status, output = self.run(setup + text)
                self.seconds[where] = time.monotonic() - began
                setup += ''.join(line + '\n' for line in text.split('\n') if re.match(r'source |\w+=', line))
                if status:
                    faults.append(f'{where}: ended with status {status}:\n{text}{output[-2000:]}')
        self.end_launch()
        return faults

    def follow_live(self, text):
        """The faults of a block of commands that take a ROS master: a launch goes on beside what follows, until the next one."""
        for command in text.replace('\\\n', ' ').split('\n'):
            if 'roslaunch' in command:
                self.end_launch()
                self.launched = subprocess.Popen(['bash', '-c', command], cwd=self.folder, env=self.environment, text=True,
                                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                                 start_new_session=True)
                try:
                    if self.launched.wait(KEEP_UP):
                        yield f'ended with status {self.launched.returncode}: {command}\n{self.launched.stdout.read()[-2000:]}'
                except subprocess.TimeoutExpired:
                    pass
            elif command.strip():
                _, output = self.run(f'timeout {ASK_FOR} {command.split("  #")[0]} | head -n 5')
                if 'ERROR' in output or not output.strip():
                    yield f'no answer to {command}\n{output}'

    def end_launch(self):
        """Ends what the last launch started."""
        if self.launched and self.launched.poll() is None:
            os.killpg(self.launched.pid, signal.SIGINT)
            try:
                self.launched.communicate(timeout=30)
            except subprocess.TimeoutExpired:
                os.killpg(self.launched.pid, signal.SIGKILL)
        self.launched = None

    def run(self, script):
        """Exit status and output of a block of commands; any that fails ends it."""
        script = f'set -eo pipefail\nset +u\n{script}'
        process = subprocess.Popen(['bash', '-c', script], cwd=self.folder, env=self.environment, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   start_new_session=True)
        try:
            output, _ = process.communicate(timeout=300)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
        return process.returncode, output
