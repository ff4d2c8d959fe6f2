"""A text as an editor holds it, and its positions as the protocol counts them."""

import re

from lsprotocol.types import Position, Range, TextEdit

# The protocol's line ends; Python's own splitting knows more.
LINE_END = re.compile(r"\r\n|\n|\r")


class Buffer:
    """The text of one open file."""

    def __init__(self, text, encoding, version=1):
        self.text = text
        self.encoding = encoding
        self.version = version

    def length(self, text):
        """How long a text is in the units of the protocol."""
        units = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
        codec, size = units[self.encoding]
        return len(text.encode(codec)) // size

    def lines(self):
        """Where each line begins and where its line end begins."""
        ends = [(found.start(), found.end()) for found in LINE_END.finditer(self.text)]
        starts = [0, *(end for _, end in ends)]
        stops = [*(start for start, _ in ends), len(self.text)]
        return list(zip(starts, stops))

    def position(self, offset):
        """The position of a character's number."""
        before = [line for line in enumerate(self.lines()) if line[1][0] <= offset]
        number, (start, _) = before[-1]
        return Position(line=number, character=self.length(self.text[start:offset]))

    def range(self, start, end):
        return Range(start=self.position(start), end=self.position(end))

    def offset(self, position):
        """The character's number at a position. A position within a character is a mistake."""
        start, stop = self.lines()[position.line]
        for at in range(start, stop + 1):
            if self.length(self.text[start:at]) == position.character:
                return at
        raise AssertionError(f"{position} is no place of the text")

    def cut(self, range):
        """The text of a range."""
        return self.text[self.offset(range.start) : self.offset(range.end)]

    def at(self, words):
        """The place of the `|` in words that stand in the text once."""
        before, bar, behind = words.partition("|")
        assert bar and self.text.count(before + behind) == 1, f"{words!r} is not there once"
        return self.position(self.text.index(before + behind) + len(before))

    def applied(self, edits: list[TextEdit]):
        """The text with edits, which may not overlap. Those at one place keep their order."""
        places = [(self.offset(edit.range.start), self.offset(edit.range.end), edit.new_text) for edit in edits]
        places.sort(key=lambda place: place[:2])
        result, last = "", 0
        for start, end, new in places:
            assert last <= start <= end, "edits overlap"
            result += self.text[last:start] + new
            last = end
        return result + self.text[last:]
