#!/usr/bin/env python3
"""Keys: each that the code reads stands on a page, and each that a page has in a table of keys is read by the code."""
import glob
import os
import re
import unittest

from pages import ROOT, all_pages

# How sections of a configuration are read (config_section.h), with the key as a literal.
READERS = ('section|section_or_empty|sections|has|text|texts|named_texts|text_matrix|text_lists|number|number_in|number_or_infinity_in|'
           'count|choice|flag|flags|matrix|is_matrix|square_matrix|vector|vectors|interval_in|is_map|is_list|is_number')
CALL = re.compile(r'\b(?:%s)\(\s*"([A-Za-z]\w*)"' % READERS)
# Parts of a documented path that stand for names of the user's own.
PLACEHOLDER = re.compile(r'[A-Z]+|q|…|\.\.\.')


def keys_of_code():
    """Keys as literals of reading calls."""
    keys = set()
    for path in glob.glob(os.path.join(ROOT, 'src', '**', '*.cpp'), recursive=True) + glob.glob(
            os.path.join(ROOT, 'src', '**', '*.h'), recursive=True):
        if '/config/' in path or '/simulation/' in path or '/messages/' in path or '/tools/' in path:
            with open(path, encoding='utf-8') as source:
                keys.update(CALL.findall(source.read()))
    return keys


def literals_of_code():
    """All words that the code has in quotes: keys are also read in loops over lists of them."""
    words = set()
    for folder in ('config', 'simulation', 'messages', 'design', 'certificate', 'observer', 'replay', 'tools'):
        for path in glob.glob(os.path.join(ROOT, 'src', folder, '**', '*'), recursive=True):
            if path.endswith(('.cpp', '.h')):
                with open(path, encoding='utf-8') as source:
                    words.update(re.findall(r'"([A-Za-z]\w*)', source.read()))
    return words


def keys_of_tables():
    """Pairs (where, key) of all tables whose first column is one of keys."""
    for page in all_pages():
        for start, rows in page.tables():
            if rows[0][0].startswith('key'):
                for row in rows[1:]:
                    for path in re.findall(r'`([^`]+)`', row[0]):
                        for key in path.split('/'):
                            if not PLACEHOLDER.fullmatch(key):
                                yield f'{page.path}:{start}', key


def words_of_pages():
    """All words in code spans and in blocks of YAML."""
    words = set()
    for page in all_pages():
        for _, line in page.prose():
            for span in re.findall(r'`([^`]+)`', line):
                words.update(re.findall(r'\w+', span))
        for _, text in page.blocks('yaml'):
            words.update(re.findall(r'(\w+):', text))
    return words


class Keys(unittest.TestCase):
    def test_that_are_read_stand_on_a_page(self):
        self.assertEqual(sorted(keys_of_code() - words_of_pages()), [])

    def test_of_summaries_stand_on_the_page_of_replay(self):
        with open(os.path.join(ROOT, 'src', 'replay', 'summary.cpp'), encoding='utf-8') as source:
            keys = set(re.findall(r'\bjson\["(\w+)"\]', source.read()))
        self.assertGreater(len(keys), 30)
        with open(os.path.join(ROOT, 'doc', 'replay.md'), encoding='utf-8') as page:
            self.assertEqual(sorted(keys - set(re.findall(r'`(\w+)`', page.read()))), [])

    def test_that_stand_in_a_table_are_read(self):
        known = keys_of_code() | literals_of_code()
        self.assertEqual([f'{where}: {key}' for where, key in keys_of_tables() if key not in known], [])


if __name__ == '__main__':
    unittest.main()
