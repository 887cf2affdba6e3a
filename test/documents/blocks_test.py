#!/usr/bin/env python3
"""Blocks of YAML are YAML, those of shell commands are read by a shell, and expected texts are compared as they should be."""
import subprocess
import textwrap
import unittest

import yaml

from pages import all_pages
from transcript import agree


class Blocks(unittest.TestCase):
    def test_of_yaml_are_yaml(self):
        faults = []
        for page in all_pages():
            for start, text in page.blocks('yaml'):
                if '…' in text:  # cut short
                    continue
                try:
                    yaml.load(textwrap.dedent(text), Loader=yaml.BaseLoader)
                except yaml.YAMLError as fault:
                    faults.append(f'{page.path}:{start}: {fault}')
        self.assertEqual(faults, [])

    def test_of_commands_are_read_by_a_shell(self):
        text = ''.join(f': {page.path.replace("/", "_")}_{start}\n{text}' for page in all_pages() for start, text in page.blocks('bash'))
        read = subprocess.run(['bash', '-n'], input=text, text=True, capture_output=True)
        self.assertEqual(read.stderr, '')

    def test_printed_lines_agree_as_they_should(self):
        self.assertTrue(agree('  v    0.0684   -', 'v  0.0691 -'))
        self.assertFalse(agree('  v    0.0684   -', 'v  0.0791 -'))
        self.assertFalse(agree('  v    0.0684   -', 'w  0.0684 -'))
        self.assertTrue(agree('in … s, 3 times', 'in 0.0031 s, 3 times'))
        self.assertFalse(agree('in … s, 3 times', 'in 0.0031 s, 4 times'))
        self.assertFalse(agree('655 used', '656 used'))


if __name__ == '__main__':
    unittest.main()
