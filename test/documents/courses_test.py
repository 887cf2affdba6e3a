#!/usr/bin/env python3
"""Each block of commands is followed, unless it is told why not, and each course is a test."""
import os
import re
import unittest

from courses import COURSES, LEFT_OUT, NOT_FOLLOWED, is_left_out
from pages import ROOT, all_pages


class Courses(unittest.TestCase):
    def test_have_all_commands_but_for_those_with_a_reason(self):
        followed = {page for course in COURSES for page in course} | set(NOT_FOLLOWED)
        self.assertEqual([f'{page.path}:{start}' for page in all_pages() if page.path not in followed
                          for start, text in page.blocks('bash') if not is_left_out(text)], [])

    def test_reasons_are_about_something(self):
        blocks = {page.path: [text for _, text in page.blocks('bash')] for page in all_pages()}
        self.assertEqual([page for page in NOT_FOLLOWED if all(is_left_out(text) for text in blocks[page])], [])
        texts = [text for of_page in blocks.values() for text in of_page]
        self.assertEqual([reason for reason, pattern in LEFT_OUT.items()
                          if not any(re.search(pattern, text, re.MULTILINE) for text in texts)], [])

    def test_are_tests(self):
        with open(os.path.join(ROOT, 'test', 'CMakeLists.txt'), encoding='utf-8') as file:
            cmake = file.read()
        self.assertEqual(re.findall(r'^ +follow_page\((\S+)\)', cmake, re.MULTILINE),
                         [course[0] for course in COURSES])


if __name__ == '__main__':
    unittest.main()
