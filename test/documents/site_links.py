#!/usr/bin/env python3
"""Every link within a site of HTML pages leads to a file, and every fragment to an element. The argument is the site's folder."""
import html.parser
import os
import sys
import urllib.parse


class Elements(html.parser.HTMLParser):
    """Links and identifiers of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.identifiers = [], {''}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ('href', 'src') and value:
                self.links.append(value)
            elif name in ('id', 'name'):
                self.identifiers.add(value)


def main():
    """Prints the faults, and ends with 1 where there are any."""
    site = os.path.abspath(sys.argv[1])
    pages = {}
    for folder, _, names in os.walk(site):
        for name in names:
            if name.endswith('.html') and name != '404.html':  # that one's links are of the server's root
                path = os.path.join(folder, name)
                with open(path, encoding='utf-8') as file:
                    pages[path] = Elements(file.read())
    faults = []
    for path, page in pages.items():
        if os.path.relpath(path, site).startswith('api/'):
            continue  # Doxygen's own, some of which lead nowhere
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(parts.path))) if parts.path else path
            if not os.path.exists(target):
                faults.append(f'{os.path.relpath(path, site)}: {link}: no such file')
            elif target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].identifiers:
                faults.append(f'{os.path.relpath(path, site)}: {link}: no such heading')
    print('\n'.join(sorted(set(faults))) or f'{len(pages)} pages, all links lead somewhere')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()
