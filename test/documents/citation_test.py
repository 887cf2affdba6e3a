#!/usr/bin/env python3
"""CITATION.cff is of the newest release."""
import os
import re
import unittest

import yaml

from pages import ROOT


def text_of(name):
    with open(os.path.join(ROOT, name), encoding='utf-8') as file:
        return file.read()


class Citation(unittest.TestCase):
    def test_is_of_the_newest_release(self):
        citation = yaml.safe_load(text_of('CITATION.cff'))
        version, date = re.search(r'^([\d.]+) \((\d{4}-\d{2}-\d{2})\)$', text_of('CHANGELOG.rst'), re.MULTILINE).groups()
        self.assertEqual((citation['version'], str(citation['date-released'])), (version, date))
        self.assertEqual(citation['cff-version'], '1.2.0')
        self.assertEqual(len(citation['references']), 5)


if __name__ == '__main__':
    unittest.main()
