#!/usr/bin/env python3
"""Rows of a table have as many cells as its head, and cells are short."""
import re
import unittest

from pages import all_pages

LONGEST = 160  # characters: two lines of a wide column


class Tables(unittest.TestCase):
    def test_have_full_rows(self):
        faults = [f'{page.path}:{start}: {row}' for page in all_pages() for start, rows in page.tables()
                  for row in rows if len(row) != len(rows[0])]
        self.assertEqual(faults, [])

    def test_have_short_cells(self):
        faults = [f'{page.path}:{start}: longer than {LONGEST} characters: {cell}' for page in all_pages()
                  for start, rows in page.tables() for row in rows for cell in row
                  if len(re.sub(r'\]\([^)]*\)', ']', cell)) > LONGEST]
        self.assertEqual(faults, [])


if __name__ == '__main__':
    unittest.main()
