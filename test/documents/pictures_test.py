#!/usr/bin/env python3
"""The picture that a script draws without any program of the package is what the script draws."""
import os
import subprocess
import sys
import tempfile
import unittest

from pages import ROOT


class Pictures(unittest.TestCase):
    def test_of_the_data_flow_is_what_its_script_draws(self):
        with tempfile.TemporaryDirectory() as folder:
            drawn = os.path.join(folder, 'drawn.svg')
            subprocess.run([sys.executable, os.path.join(ROOT, 'scripts', 'draw_data_flow'), drawn], check=True)
            with open(drawn, encoding='utf-8') as new, open(os.path.join(ROOT, 'doc', 'data_flow.svg'), encoding='utf-8') as shown:
                self.assertEqual(new.read(), shown.read())


if __name__ == '__main__':
    unittest.main()
