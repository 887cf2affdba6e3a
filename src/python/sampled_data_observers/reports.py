"""What `replay --json` and `replay --report` write."""
import base64
import json
import re

import numpy

TYPES = {'u8': '<u1', 'u16': '<u2', 'u32': '<u4', 'f32': '<f4'}


def read_summary(path):
    """The figures of `replay --json FILE`, as a dictionary."""
    with open(path, encoding='utf-8') as file:
        return json.load(file)


def read_report(path):
    """What the page of `replay --report FILE.html` shows, as a tree whose packed arrays are NumPy arrays of floats.

    Raises ValueError where the file is no such page.
    """
    with open(path, encoding='utf-8') as page:
        found = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page.read(), re.DOTALL)
    if len(found) != 1:
        raise ValueError(f'{path}: expected a page of replay --report, found none of its data')
    return _unpacked(json.loads(found[0]))


def _unpacked(node):
    if isinstance(node, dict):
        if set(node) in ({'type', 'data'}, {'type', 'data', 'offset'}):
            raw = base64.b64decode(node['data'], validate=True)
            return numpy.frombuffer(raw, TYPES[node['type']]).astype(float) + node.get('offset', 0)
        return {key: _unpacked(value) for key, value in node.items()}
    return [_unpacked(value) for value in node] if isinstance(node, list) else node
