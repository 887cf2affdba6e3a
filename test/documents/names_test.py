#!/usr/bin/env python3
"""What pages name is there: paths, launch files and their arguments, tools, messages with their fields, outcomes, topics and services."""
import glob
import os
import re
import unittest
import xml.etree.ElementTree

from pages import ROOT, all_pages

FOLDERS = ('bench', 'build', 'cmake', 'config', 'doc', 'include', 'launch', 'msg', 'scripts', 'src', 'srv', 'test')


def spans():
    """Pairs (where, code span) of all prose."""
    for page in all_pages():
        for number, line in page.prose():
            for span in re.findall(r'`([^`]+)`', line):
                yield f'{page.path}:{number}', span


def commands():
    """Pairs (where, command) of all blocks of shell commands, with continued lines joined."""
    for page in all_pages():
        for start, text in page.blocks('bash'):
            for line in text.replace('\\\n', ' ').split('\n'):
                yield f'{page.path}:{start}', line.split('  #')[0]


def source():
    """All text of src/."""
    text = ''
    for path in sorted(glob.glob(os.path.join(ROOT, 'src', '**', '*'), recursive=True)):
        if path.endswith(('.cpp', '.h')):
            with open(path, encoding='utf-8') as file:
                text += file.read()
    return text


def expanded(path):
    """The paths that a shell makes of braces."""
    braces = re.search(r'\{([^{}]*,[^{}]*)\}', path)
    if not braces:
        return [path]
    return [whole for part in braces.group(1).split(',') for whole in expanded(path[:braces.start()] + part + path[braces.end():])]


def definition(name):
    """The text of a message or service of this package; empty where there is none."""
    for path in (f'msg/{name}.msg', f'srv/{name}.srv'):
        if os.path.exists(os.path.join(ROOT, path)):
            with open(os.path.join(ROOT, path), encoding='utf-8') as file:
                return file.read()
    return ''


class Names(unittest.TestCase):
    def test_paths_exist(self):
        words = [(where, word) for where, span in spans() for word in span.split()]
        words += [(where, word) for where, command in commands() for word in command.split()]
        faults = []
        for where, word in words:
            word = word.strip('"\'().,:;').split('#')[0]
            if not re.match(r'(%s)/[\w{},./*-]+$' % '|'.join(FOLDERS), word) or word.startswith('build/') or word.endswith('.bag'):
                continue
            faults += [f'{where}: {path}' for path in expanded(word) if not glob.glob(os.path.join(ROOT, path))]
        self.assertEqual(faults, [])

    def test_launch_files_take_their_arguments(self):
        files = {os.path.basename(path): path for path in glob.glob(os.path.join(ROOT, 'launch', '*.launch')) +
                 glob.glob(os.path.join(ROOT, 'config', 'examples', '*', '*.launch'))}
        faults = []
        for where, command in commands():
            launched = re.search(r'roslaunch (?:-\S+ )*sampled_data_observers (\S+)(.*)', command)
            if not launched:
                continue
            if launched.group(1) not in files:
                faults.append(f'{where}: {launched.group(1)}')
                continue
            declared = {arg.get('name') for arg in xml.etree.ElementTree.parse(files[launched.group(1)]).getroot().iter('arg')}
            faults += [f'{where}: {launched.group(1)} has no argument {name}'
                       for name in re.findall(r'(?<!_)\b([a-z]\w*):=', launched.group(2)) if name not in declared]
        self.assertEqual(faults, [])

    def test_tools_are_built(self):
        with open(os.path.join(ROOT, 'CMakeLists.txt'), encoding='utf-8') as file:
            cmake = file.read()
        run = {(where, name) for where, command in commands() for name in re.findall(r'rosrun sampled_data_observers (\w+)', command)}
        self.assertEqual([f'{where}: {name}' for where, name in sorted(run) if not re.search(r'\b%s\b' % name, cmake)], [])

    def test_fields_of_messages_are_there(self):
        faults = []
        for where, span in spans():
            named = re.fullmatch(r'(\w+)/(\w+)', span)
            if named and definition(named.group(1)) and not re.search(r'\b%s\b' % named.group(2), definition(named.group(1))):
                faults.append(f'{where}: {span}')
        self.assertEqual(faults, [])

    def test_outcomes_are_those_of_the_message(self):
        outcomes = set(re.findall(r'^uint8 ([A-Z_]+)=', definition('EventStatus'), re.MULTILINE))
        named = {span for _, span in spans() if re.fullmatch(r'[A-Z]+(_[A-Z]+)+', span)}
        self.assertEqual(sorted(name for name in named - outcomes if not name.startswith(('ROS_', 'SDO_'))), [])
        kinds = {name for name in outcomes if name.startswith(('INTERVAL_', 'DWELL_'))} | {
            'INPUT', 'JUMP', 'JUMP_OUTPUT', 'OUTPUT', 'SAMPLE', 'WITHDRAWAL', 'USED', 'USED_LATE'}
        self.assertEqual(sorted(outcomes - kinds - {span for _, span in spans()}), [])

    def test_topics_and_services_are_advertised(self):
        text = source().replace('"/', '"')
        named = {name for page in all_pages() if page.path == 'doc/ros_interface.md' for _, rows in page.tables()
                 if rows[0][0] in ('topic', 'service') for row in rows[1:] for name in re.findall(r'`/?(\w+)`', row[0])}
        self.assertGreater(len(named), 10)
        self.assertEqual([name for name in sorted(named - {'diagnostics'}) if f'"{name}"' not in text], [])  # that one by a library


if __name__ == '__main__':
    unittest.main()
