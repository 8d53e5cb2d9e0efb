"""What is written on paper fits, breaks where it may, and can be read whatever signs a name has."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from synth.export.sheet import typesetting
from synth.export.sheet.typesetting import FAMILY, families, legible, shortened, width, wrapped

WORDS = st.lists(st.text("abcXYZ0.()-äß字", min_size=1, max_size=40), max_size=30).map(" ".join)


@pytest.mark.parametrize("bold", [False, True])
@pytest.mark.parametrize("text", ["Soften the link and shape it.|", "0123456789 mm|", "wwwwiiii|"])
def test_a_line_is_as_wide_as_it_is_drawn_and_no_wider_than_said(text, bold):
    prop = FontProperties(family=FAMILY, weight="bold" if bold else "normal")
    drawn = TextPath((0, 0), text, size=100, prop=prop).get_extents().x1 * 25.4 / 72.0
    assert drawn < width(text, 100.0, bold=bold) < 1.06 * drawn


@given(WORDS, st.floats(20.0, 100.0))
def test_lines_fit_and_hold_every_word_in_order(text, room):
    lines = wrapped(text, room, 7.0)
    assert all(width(line, 7.0) <= room for line in lines)
    assert "".join(lines).replace(" ", "") == legible(text).replace(" ", "")


def test_a_number_stays_with_its_name_and_its_unit():
    told = "a hand (9.6 ± 2.1 mm, 4 ± 1.2 deg): joint 1 at 180.0 deg, by tape d13 428.8, d24 410.2 mm"
    for room in range(20, 100, 2):
        for line in wrapped(told, float(room), 7.0):
            assert not line.startswith(("mm", "deg", "±", "428.8", "410.2", "1 at"))
            assert not line.endswith(("±", "d13", "d24", "joint"))


def test_of_too_many_lines_the_first_are_kept_and_it_is_seen_that_there_are_more():
    lines = wrapped("word " * 100, 40.0, 7.0, most=2)
    assert len(lines) == 2
    assert lines[1].endswith("word ...")
    assert width(lines[1], 7.0) <= 40.0


@pytest.mark.parametrize(
    ("name", "room", "shown"),
    [
        ("crate", 30.0, "crate"),
        ("two\n lines", 30.0, "two lines"),
        ("a" * 3000 + "17", 30.0, "a" * 8 + "..." + "a" * 6 + "17"),
        ("left side of the bin, upper 3", 18.0, "left s...per 3"),
    ],
)
def test_a_long_name_keeps_its_beginning_and_its_end(name, room, shown):
    assert shortened(name, room, 7.5) == shown
    assert width(shown, 7.5) <= room


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("αβγ Ünïcödé", "αβγ Ünïcödé"),
        ("取る", r"\u53d6ru"),
        ("김", "gim"),
        ("box \N{ROBOT FACE}", "box [robot face]"),
        ("Ａ１", "A1"),
        ("a\N{ZERO WIDTH JOINER}b", "ab"),
        ("\ud83d half", r"\ud83d half"),
        ("bell\a", r"bell\u0007"),
    ],
)
def test_what_no_font_draws_can_be_read_all_the_same(monkeypatch, name, read):
    """Whatever is installed here: with the sheet's own font alone."""
    monkeypatch.setattr(typesetting, "_others", list)
    for cached in (typesetting._family, typesetting._drawable):
        cached.cache_clear()
    assert legible(name) == read
    assert families(legible(name)) == [FAMILY]
    for cached in (typesetting._family, typesetting._drawable):
        cached.cache_clear()


def test_a_sign_that_another_font_draws_is_drawn_by_it():
    """A combining mark that comes with matplotlib, in another font than the sheet's own."""
    sign = "\N{COMBINING ANTICLOCKWISE ARROW ABOVE}"
    assert legible(f"v{sign}") == f"v{sign}"
    own, other = families(f"v{sign}")
    assert own == FAMILY
    assert other != FAMILY
    assert width(f"v{sign}", 7.0) > 0.0
