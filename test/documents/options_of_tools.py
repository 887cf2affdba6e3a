#!/usr/bin/env python3
"""Options: each that a tool's --help lists stands on a page, and each that a page gives a tool is one of its own. Arguments: the
programs simulate, replay, compare_estimates and design."""
import os
import re
import subprocess
import sys
import unittest

from pages import all_pages

COMMANDS = ('synthesize', 'analyze', 'verify', 'sweep', 'explain', 'jump_observability', 'check_ell')


def help_of(*command):
    """The long options that a program's help lists."""
    text = subprocess.run([*command, '--help'], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r'(?<![\w-])--[a-z][\w-]*', text))


def command_lines():
    """Triples (where, tool or command of design, its options) of all blocks of shell commands."""
    for page in all_pages():
        for start, text in page.blocks('bash'):
            for line in text.replace('\\\n', ' ').split('\n'):
                called = re.search(r'(?:rosrun sampled_data_observers|\$tool|^design)\s+(?:design\s+)?(\w+)(.*)', line.split('  #')[0])
                if called:
                    yield f'{page.path}:{start}', called.group(1), re.findall(r'(?<![\w-])--[a-z][\w-]*', called.group(2).split('|')[0])


class Options(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.options = {os.path.basename(program): help_of(program) for program in PROGRAMS}
        for command in COMMANDS:
            cls.options[command] = help_of(PROGRAMS[-1], command)

    def test_that_help_lists_stand_on_a_page(self):
        words = set()
        for page in all_pages():
            words.update(re.findall(r'(?<![\w-])--[a-z][\w-]*', '\n'.join(page.lines)))
        missing = {f'{tool} {option}' for tool, options in self.options.items() for option in options - words}
        self.assertEqual(sorted(missing), [])

    def test_that_pages_give_are_those_of_the_tool(self):
        lines = [line for line in command_lines() if line[1] in self.options]
        self.assertGreater(len(lines), 30)
        faults = [f'{where}: {tool} {option}' for where, tool, options in lines for option in options
                  if option not in self.options[tool]]
        self.assertEqual(faults, [])


if __name__ == '__main__':
    PROGRAMS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
