"""Whether a picture can be read: by contrast (WCAG 2), and in grey where colours tell things apart."""

import itertools

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.markers import MarkerStyle
from matplotlib.text import Text

TEXT, GRAPHIC = 4.5, 3.0  # least contrasts of WCAG 2.2, 1.4.3 and 1.4.11
APART = 1.25  # least contrast of two greys that are told apart by nothing else


def luminance(colour):
    """The relative luminance of a colour, by WCAG."""
    channels = np.array(to_rgb(colour))
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(one, other):
    """The contrast of two colours, from 1 to 21."""
    dark, light = sorted([luminance(one), luminance(other)])
    return (light + 0.05) / (dark + 0.05)


def written(figure):
    """All texts of a figure that are not empty, legends and ticks among them."""
    figure.draw_without_rendering()
    return [text for text in figure.findobj(Text) if text.get_text().strip()]


def pale_texts(figure):
    """Texts with too little contrast to what is behind them, with that contrast."""
    texts = [text for text in written(figure) if text.get_visible()]
    for text in texts:
        text.set_alpha(0.0)  # a box behind a text stays
    figure.canvas.draw()
    behind = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3] / 255.0
    found = []
    for text in texts:
        box = text.get_window_extent()
        rows, columns = (
            slice(max(int(low), 0), int(high) + 1) for low, high in (box.intervaly, box.intervalx)
        )
        patch = behind[rows, columns].reshape(-1, 3)
        if len(patch) and (value := contrast(text.get_color(), np.median(patch, axis=0))) < TEXT:
            found.append((text.get_text(), round(value, 2)))
    return found


def pale_lines(figure):
    """Named lines and markers with too little contrast to their ground."""
    return [
        (line.get_label(), round(value, 2))
        for axes in figure.axes
        for line in named(axes)
        if (value := contrast(line.get_color(), axes.get_facecolor())) < GRAPHIC
    ]


def named(axes):
    """The lines of axes that their legend names."""
    return [line for line in axes.lines if not line.get_label().startswith("_")]


def alike_in_grey(figure):
    """Pairs of named lines that only their colours tell apart, too little so in grey."""
    return [
        (one.get_label(), other.get_label())
        for axes in figure.axes
        for one, other in itertools.combinations(named(axes), 2)
        if look(one) == look(other) and contrast(one.get_color(), other.get_color()) < APART
    ]


def look(line):
    """What tells a line from others but its colour."""
    marker = MarkerStyle(line.get_marker())
    drawn = marker.get_transform().transform(marker.get_path().vertices)  # a diamond is a turned square
    return line.get_linestyle(), drawn.round(6).tobytes()
