#!/usr/bin/env python3
"""Every link and picture of the pages leads to a file, and every fragment to a heading of it; every page is reached."""
import os
import unittest

from pages import ROOT, all_pages


class Links(unittest.TestCase):
    def setUp(self):
        self.pages = {page.path: page for page in all_pages()}

    def targets(self):
        """Triples (where, path from the root, fragment) of all links within the repository."""
        for page in self.pages.values():
            for number, target in page.links():
                if '://' in target or target.startswith('mailto:'):
                    continue
                path, _, fragment = target.partition('#')
                path = os.path.normpath(os.path.join(os.path.dirname(page.path), path)) if path else page.path
                yield f'{page.path}:{number}', path, fragment

    def test_lead_to_files_and_headings(self):
        faults = []
        for where, path, fragment in self.targets():
            if not os.path.exists(os.path.join(ROOT, path)):
                faults.append(f'{where}: {path} does not exist')
            elif fragment and fragment not in self.pages[path].anchors():
                faults.append(f'{where}: {path} has no heading #{fragment}')
        self.assertEqual(faults, [])

    def test_reach_every_page_from_the_readme(self):
        links = {}
        for where, path, _ in self.targets():
            links.setdefault(where.rsplit(':', 1)[0], set()).add(path)
        reached, waiting = set(), ['README.md']
        while waiting:
            path = waiting.pop()
            if path not in reached:
                reached.add(path)
                waiting += links.get(path, ())
        self.assertEqual(sorted(set(self.pages) - reached), [])


if __name__ == '__main__':
    unittest.main()
