#!/usr/bin/env python3
"""Configuration files of any name without spaces reach the parameter server by roslaunch, those of an example
from its own folder, and may be loaded there as trees of parameters, too."""
import glob
import os
import subprocess
import sys
import unittest
import xmlrpc.client
import xml.etree.ElementTree

import yaml

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from folder_test import FolderTest  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(HERE))
LAUNCH = os.path.join(ROOT, "launch", "load_config.launch")


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

    def test_an_example_takes_files_of_its_folder_and_others(self):
        example = os.path.join(ROOT, "config", "examples", "bernard2022_neuron_jump_based")
        mine = self.write("mine.yaml", "rate: 7\n")
        found = subprocess.check_output(
            ["roslaunch", "--dump-params",
             os.path.join(example, "bernard2022_neuron_jump_based.launch"),
             "scenario:=scenario_delay_1.yaml", "observer:=" + mine])
        paths = {value for key, value in yaml.safe_load(found).items() if key.endswith("/path")}
        expected = {os.path.join(example, name)
                    for name in ("plant.yaml", "scenario_delay_1.yaml", "gains.yaml")} | {mine}
        self.assertEqual({os.path.realpath(path) for path in paths},
                         {os.path.realpath(path) for path in expected})

    def test_configurations_may_be_trees_of_parameters(self):
        # What <rosparam command="load"/> does: it takes no keys but texts, and no dates.
        files = glob.glob(os.path.join(ROOT, "config", "**", "*.yaml"), recursive=True)
        self.assertGreater(len(files), 30)
        for path in files:
            with self.subTest(path), open(path) as text:
                xmlrpc.client.dumps((yaml.safe_load(text),))

    def test_no_include_is_given_its_own_folder(self):
        # Within <include>, $(dirname) is the folder of the included file before roslaunch 1.15.15.
        launches = [path for folder in ("config", "launch", "test")
                    for path in glob.glob(os.path.join(ROOT, folder, "**", "*.launch"), recursive=True)]
        self.assertGreater(len(launches), 10)
        for path in launches:
            for include in xml.etree.ElementTree.parse(path).iter("include"):
                for argument in include.iter("arg"):
                    self.assertNotIn("$(dirname)", argument.get("value", ""), path)


if __name__ == "__main__":
    unittest.main()
