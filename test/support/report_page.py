"""Reads the page that `replay --report` writes, by its own means."""
import base64
import json
import re
import struct

FORMATS = {"u8": "B", "u16": "H", "u32": "I", "f32": "f"}


def read_page(path):
    with open(path, encoding="utf-8") as page:
        return page.read()


def data_of(page):
    """What the page shows, from its only element that holds data."""
    found, = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)
    return json.loads(found)


def values_of(packed):
    """The numbers of a packed array, with its offset."""
    raw = base64.b64decode(packed["data"], validate=True)
    letter = FORMATS[packed["type"]]
    numbers = struct.unpack("<%d%s" % (len(raw) // struct.calcsize(letter), letter), raw)
    return [number + packed.get("offset", 0) for number in numbers]


def stamps_of(data, packed):
    """Stamps in seconds."""
    return [data["origin"] + count * data["time_unit"] for count in values_of(packed)]
