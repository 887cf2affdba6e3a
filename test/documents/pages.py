"""The pages of this package, as tests read them: README, CONTRIBUTING and doc/."""
import os
import re

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))


class Page:
    """One Markdown page: `path` from the root, `lines`, and what is in them."""

    def __init__(self, path):
        self.path = path
        with open(os.path.join(ROOT, path), encoding='utf-8') as page:
            self.lines = page.read().split('\n')

    def prose(self):
        """Pairs (line number, line) outside of fenced blocks."""
        fenced = False
        for number, line in enumerate(self.lines, 1):
            if line.lstrip().startswith('```'):
                fenced = not fenced
            elif not fenced:
                yield number, line

    def blocks(self, *languages, with_language=False):
        """Pairs (line number, text) of fenced blocks in one of these languages, without their indentation; or triples,
        with the language in the middle."""
        start, language, indent, text = 0, None, 0, []
        for number, line in enumerate(self.lines, 1):
            fence = re.match(r'( *)```(\w*)', line)
            if fence and language is None:
                start, language, indent, text = number, fence.group(2), len(fence.group(1)), []
            elif fence:
                if language in languages:
                    content = '\n'.join(text) + '\n'
                    yield (start, language, content) if with_language else (start, content)
                language = None
            else:
                text.append(line[indent:])

    def tables(self):
        """Lists of rows of cells, with the line number of the first row; the row of dashes is left out."""
        rows, start = [], 0
        for number, line in list(self.prose()) + [(0, '')]:
            if line.startswith('|'):
                start = start if rows else number
                cells = [cell.strip() for cell in re.split(r'(?<!\\)\|', line.strip())[1:-1]]
                if not all(re.fullmatch(r':?-+:?', cell) for cell in cells):
                    rows.append(cells)
            elif rows:
                yield start, rows
                rows = []

    def anchors(self):
        """The fragments that GitHub and MkDocs give to the headings of this page."""
        found = {}
        for _, line in self.prose():
            heading = re.match(r'#+ +(.*)', line)
            if heading:
                anchor = anchor_of(re.sub(r'\[([^]]*)\]\([^)]*\)', r'\1', heading.group(1)), '-')
                count = found.get(anchor, 0)
                found[anchor] = count + 1
                yield anchor if count == 0 else f'{anchor}-{count}'

    def links(self):
        """Pairs (line number, target) of links and pictures."""
        for number, line in self.prose():
            for target in re.findall(r'\]\(([^)\s]+)\)', re.sub(r'`[^`]*`', '``', line)):
                yield number, target


def anchor_of(heading, separator):
    """The fragment of a heading, as GitHub makes it; scripts/site has MkDocs make the same."""
    return re.sub(r'[^\w\- ]', '', heading.lower()).strip().replace(' ', separator)


def all_pages():
    """Every page, in order."""
    paths = ['README.md', 'CONTRIBUTING.md']
    for folder, folders, files in os.walk(os.path.join(ROOT, 'doc')):
        folders.sort()
        paths += [os.path.relpath(os.path.join(folder, name), ROOT) for name in sorted(files) if name.endswith('.md')]
    return [Page(path) for path in paths]
