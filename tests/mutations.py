"""Files that were damaged: bytes, lines and columns lost, doubled, exchanged or overwritten."""

_WORDS = [
    *(
        word.encode()
        for word in (*',\t\n\r\0"-', "", "nan", "inf", "1e999", "mm", "Meters", "X1", "Frame", "Marker")
    ),
    *(b"\xff", b"\xfe\xff", b"\xef\xbb\xbf", b"MARKER_NAMES", b"Length Units", b"P1", b"0.000", b"9" * 400),
]


def mutated(content, chance):
    """Return bytes with one to four things wrong."""
    for _ in range(chance.randint(1, 4)):
        content = chance.choice([_overwritten, _cut, _lines, _cells, _flipped])(content, chance)
    return content


def _overwritten(content, chance):
    at = chance.randrange(len(content) + 1)
    return content[:at] + chance.choice(_WORDS) + content[at + chance.choice([0, 1, 8]) :]


def _cut(content, chance):
    start, end = sorted(chance.randrange(len(content) + 1) for _ in range(2))
    return content[:start] + content[min(end, start + 200) :] if chance.random() < 0.8 else content[:end]


def _lines(content, chance):
    lines = content.split(b"\n")
    at, other = (chance.randrange(len(lines)) for _ in range(2))
    change = chance.randrange(3)
    if change == 0:
        del lines[at]
    elif change == 1:
        lines.insert(other, lines[at])
    else:
        lines[at], lines[other] = lines[other], lines[at]
    return b"\n".join(lines)


def _cells(content, chance):
    """Lose, double or overwrite a cell of a line."""
    lines = content.split(b"\n")
    at = chance.randrange(len(lines))
    between = b"\t" if b"\t" in lines[at] else b","
    cells = lines[at].split(between)
    column = chance.randrange(len(cells))
    cells[column : column + 1] = chance.choice([[], [cells[column]] * 2, [chance.choice(_WORDS)]])
    lines[at] = between.join(cells)
    return b"\n".join(lines)


def _flipped(content, chance):
    if not content:
        return content
    at = chance.randrange(len(content))
    return content[:at] + bytes([content[at] ^ 1 << chance.randrange(8)]) + content[at + 1 :]
