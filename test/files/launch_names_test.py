#!/usr/bin/env python3
"""Configuration files of any name without spaces reach the parameter server by roslaunch."""
import os
import subprocess
import sys
import unittest

import yaml

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from folder_test import FolderTest  # noqa: E402

LAUNCH = os.path.join(HERE, "..", "..", "launch", "load_config.launch")


class LaunchNamesTest(FolderTest):
    def test_names_with_quotes_and_backslashes(self):
        names = [self.write(name, "rate: %d\n" % number)
                 for number, name in enumerate(["it's.yaml", 'say"it".yaml', "back\\slash.yaml",
                                                "$HOME;`x`.yaml", "-rf", "größe.yaml"])]
        found = subprocess.check_output(
            ["roslaunch", "--dump-params", LAUNCH, "files:=" + " ".join(names), "ns:=config"],
            cwd=self.folder)
        parameters = yaml.safe_load(found)
        for number, name in enumerate(names):
            file = "/config/file_%d/" % (number + 1)
            self.assertEqual(parameters[file + "path"], name)
            self.assertEqual(parameters[file + "text"], "rate: %d\n" % number)


if __name__ == "__main__":
    unittest.main()
