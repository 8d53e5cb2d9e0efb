"""Names as long as they may be on paper: cut in the middle, since names mostly differ at an end."""

_GAP = "..."


def shortened(name: str, most: int) -> str:
    """Return a name in one line of at most so many characters, with its beginning and its end.

    Args:
        name: A name of any length; line breaks and runs of blanks count as one blank.
        most: Characters there is room for, 5 at least.
    """
    line = " ".join(name.split())
    if len(line) <= most:
        return line
    head = (most - len(_GAP) + 1) // 2
    tail = most - len(_GAP) - head
    return f"{line[:head].rstrip()}{_GAP}{line[len(line) - tail :].lstrip()}"
