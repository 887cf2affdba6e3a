"""Runs a page as a reader would: writes the files that it shows, runs its commands, and compares what they print."""
import http.client
import os
import re
import signal
import subprocess
import threading
import time
import xmlrpc.client

from courses import EXIT_STATUS, is_left_out
from pages import ROOT

# A shell has what it starts in the background ignore Ctrl-C, and so all that this starts.
signal.signal(signal.SIGINT, signal.default_int_handler)

LIVE = re.compile(r'\b(roslaunch|rostopic|rosservice)\b')
PATIENCE = 240  # s, until an observer must publish, and a topic or a service must have answered, however busy the machine is
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


def parts_of(block):
    """Pairs (whether it takes a ROS master, commands): such commands one by one, the others together."""
    parts = []
    for command in block.replace('\\\n', ' ').split('\n'):
        is_live = bool(LIVE.search(command))
        if is_live or not parts or parts[-1][0]:
            parts.append((is_live, ''))
        parts[-1] = is_live, parts[-1][1] + command + '\n'
    return [part for part in parts if part[1].strip()]


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
    """Lines of an expected text that are not in an output: `…` stands for anything, numbers that are not whole may differ a little."""
    found = output.split('\n')
    return [line for line in expected.strip('\n').split('\n') if line.strip() and not any(agree(line, other) for other in found)]


def agree(expected, line):
    """Whether a printed line is as expected."""
    pattern = '.*'.join(re.escape(part) for part in NUMBER.sub('\0', ' '.join(expected.split())).split('…'))
    pattern = pattern.replace(re.escape('\0'), f'({NUMBER.pattern})')
    match = re.fullmatch(pattern.replace(r'\ ', r'\s+'), line.strip())
    if not match:
        return False
    return all(actual == number or not number.isdigit() and abs(float(actual) - float(number)) <= TOLERANCE * abs(float(number))
               for actual, number in zip(match.groups(), NUMBER.findall(expected)))


class Reader:
    """Follows pages in a scratch folder that looks like the clone, in the environment of the installed package."""

    def __init__(self, folder, port):
        self.folder = folder
        self.master = f'http://localhost:{port}'
        self.environment = dict(os.environ, ROS_MASTER_URI=self.master, ROS_HOSTNAME='localhost', BROWSER='true',
                                ROS_HOME=os.path.join(folder, 'ros'))
        self.launched = None
        self.launch_command = ''
        self.seconds = {}
        for name in ('scripts', 'config', 'doc', 'bench', 'test'):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))

    def write_files(self, page):
        """Writes the files that a page shows, without following it."""
        for _, kind, text in steps_of(page):
            if kind not in ('bash', 'text'):
                self.write(kind, text)

    def write(self, name, text):
        """Writes a file into the scratch folder."""
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)

    def follow(self, page):
        """The faults of a page."""
        faults, output, setup = [], '', ''
        for number, kind, text in steps_of(page):
            where = f'{page.path}:{number}'
            began = time.monotonic()
            if kind == 'text':
                faults += [f'{where}: not printed: {line}' for line in missing_lines(text, output)]
            elif kind != 'bash':
                self.write(kind, text)
            elif not is_left_out(text):
                for is_live, commands in parts_of(text):
                    if is_live:
                        found = self.follow_live(commands, setup)
                    else:
                        output, found = self.run(setup + commands)
                        setup += ''.join(line + '\n' for line in commands.split('\n') if re.match(r'source |\w+=', line))
                    faults += [f'{where}: {fault}' for fault in found]
            self.seconds[where] = time.monotonic() - began
        return faults + [f'{page.path}: {fault}' for fault in self.end_launch()]

    def follow_live(self, command, setup):
        """The faults of a command that takes a ROS master: a launch goes on beside what follows, until the next one."""
        if 'roslaunch' not in command:
            return self.ask(command)
        faults = self.end_launch()
        self.launch_command = setup + command
        return faults + self.launch()

    def launch(self):
        """Starts a launch, and waits until it publishes; the faults."""
        with open(os.path.join(self.folder, 'launched'), 'w', encoding='utf-8') as log:
            self.launched = self.start(self.launch_command, stdout=log, stderr=subprocess.STDOUT)
        is_beside_robot = re.search(r'observer\.launch|robot\.launch(?!.*simulated:=true)', self.launch_command)
        wanted = {'estimate'} if is_beside_robot else {'estimate', 'truth'}
        deadline = time.monotonic() + PATIENCE
        while self.launched.poll() is None and wanted - self.published():
            if time.monotonic() > deadline:
                return [f'nobody publishes {" and ".join(sorted(wanted - self.published()))} after {self.launch_command}\n{self.printed()}']
            time.sleep(0.2)
        return []

    def ask(self, command):
        """No fault, as soon as a topic or a service has answered. A simulation that ended before is begun anew."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            if self.launched and self.launched.poll() == 0:
                faults = self.launch()
                if faults:
                    return faults
            process = self.start(command.split('  #')[0], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            given_up = threading.Timer(deadline - time.monotonic(), lambda: end(process, signal.SIGKILL))
            given_up.start()
            answer = process.stdout.readline()
            given_up.cancel()
            end(process, signal.SIGKILL)
            if answer.strip():
                return []
            time.sleep(0.5)
        return [f'no answer to {command}']

    def published(self):
        """The last parts of the names of topics that the launch publishes."""
        try:
            _, _, (published, _, _) = xmlrpc.client.ServerProxy(self.master).getSystemState('/reader')
        except (OSError, http.client.HTTPException, xmlrpc.client.Error):
            return set()
        return {topic.split('/')[-1] for topic, _ in published}

    def printed(self):
        """The end of what a launch printed."""
        with open(os.path.join(self.folder, 'launched'), encoding='utf-8') as log:
            return log.read()[-2000:]

    def end_launch(self):
        """Ends what the last launch started; faults, where it ended with one before."""
        launched, self.launched = self.launched, None
        if launched is None:
            return []
        if launched.poll() is not None:
            return [f'a launch ended with status {launched.returncode}:\n{self.printed()}'] if launched.returncode else []
        os.killpg(launched.pid, signal.SIGINT)
        try:
            launched.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            end(launched, signal.SIGKILL)
        return []

    def run(self, script):
        """Output and faults of a block of commands; any that fails ends it."""
        process = self.start(script, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output, _ = process.communicate()
        expected = next((status for pattern, status in EXIT_STATUS.items() if re.search(pattern, script)), 0)
        return output, [] if process.returncode == expected else [
            f'ended with status {process.returncode}:\n{script}{output[-2000:]}']

    def start(self, script, **streams):
        """A process of a shell in the environment of the installed package, with a group of its own."""
        return subprocess.Popen([os.path.join(ROOT, 'scripts', 'run'), 'bash', '-c', f'set -eo pipefail\n{script}'], cwd=self.folder,
                                env=self.environment, text=True, stdin=subprocess.DEVNULL, start_new_session=True, **streams)


def end(process, by):
    """Ends a process and what it started, by a signal."""
    try:
        os.killpg(process.pid, by)
    except ProcessLookupError:
        pass
    process.wait()
