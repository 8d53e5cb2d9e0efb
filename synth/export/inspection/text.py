"""What the terminal and the docs show of an inspection. Millimetres and degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.measurement import Fit
from synth.rounding import rounded_down, rounded_up
from synth.sentences import bulleted, headed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.measurement import Inspection, Misprint, Nearest, Spread, Suspect

_COLUMNS = (
    "",
    "intended",
    "P1 to P4 realisable",
    "with P5",
    "α, °",
    "a, mm",
    "P2 to axis 2, mm",
    "P1 to axis 2, mm",
    "P5 off the surface, mm",
    "nearest with P5: α, a",
    "link",
)


def inspection_text(inspection: Inspection) -> str:
    """Return an inspection as a headline and a few bullets, without a line break at the end."""
    measurement = inspection.measurement
    verdict = "realisable" if inspection.is_realisable else "NOT realisable"
    headline = f"{measurement.name}: {verdict}"
    bullets = [] if inspection.misprint is None else _misprint_lines(inspection.misprint)
    bullets.append(f"P1 to P4: {_fit_sentence(inspection.axes)}")
    if measurement.has_pose:
        bullets.append(f"with P5: {_fit_sentence(inspection.whole)}")
    bullets += _spread_lines(inspection)
    invariants = inspection.invariants
    nearest = f"axes at {math.degrees(invariants.alpha):.1f} deg, {1e3 * invariants.a:.1f} mm apart"
    bullets.append(f"the nearest shape: {nearest}; {inspection.category_distances.describe()}")
    if inspection.misfit is not None:
        line = f"recorded end effector: {1e3 * inspection.misfit:.1f} mm off the workspace of P1 to P4"
        if "misfit" in inspection.spreads:
            line += f", {_range(inspection.spreads['misfit'], 1e3)} mm off those that the bounds allow"
        bullets.append(line)
    bullets.append(_link_sentence(inspection))
    count = 0 if inspection.samples is None else len(inspection.samples)
    bullets.append(f"seed {inspection.seed}, {count} shapes drawn; ranges are from 5 % to 95 % of them")
    return headed(headline, map(bulleted, bullets))


def inspections_markdown(inspections: Sequence[Inspection]) -> str:
    """Return a table of inspections in Markdown, a row for each, without a line break at the end.

    Ranges are written "median (5 % to 95 %; least to largest sample)".
    """
    rows = [_COLUMNS, ("---",) * len(_COLUMNS), *(_row(inspection) for inspection in inspections)]
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in rows)


def _row(inspection: Inspection) -> tuple[str, ...]:
    measurement, spreads = inspection.measurement, inspection.spreads
    intended = "" if measurement.intended is None else measurement.intended.value
    degrees = math.degrees(1.0)
    cells = [
        _cell(spreads.get(name), unit)
        for name, unit in (("alpha", degrees), ("a", 1e3), ("puma", 1e3), ("spherical", 1e3))
    ]
    misfit = "–"
    if inspection.misfit is not None:
        misfit = f"{1e3 * inspection.misfit:.1f}; {_cell(spreads.get('misfit'), 1e3)}"
    whole = _change(inspection.whole) if measurement.has_pose else "–"
    if inspection.misprint is not None:
        whole = "; ".join([_misprint_cell(inspection.misprint), whole])
    link = "yes" if inspection.link.found else ("no" if inspection.link.obstacle else "not found")
    nearest = "–"
    if measurement.has_pose and inspection.whole.is_realisable:
        invariants = inspection.invariants
        nearest = f"{degrees * invariants.alpha:.0f}°, {1e3 * invariants.a:.0f} mm"
    return (measurement.name, intended, _change(inspection.axes), whole, *cells, misfit, nearest, link)


def _cell(spread: Spread | None, unit: float) -> str:
    if spread is None:
        return "–"
    least, low, median, high, most = (
        f"{unit * value:.0f}" for value in (spread.least, spread.low, spread.median, spread.high, spread.most)
    )
    return f"{median} ({low} to {high}; {least} to {most})"


def _range(spread: Spread, unit: float) -> str:
    return f"{unit * spread.low:.1f} to {unit * spread.high:.1f}"


def _change(nearest: Nearest) -> str:
    """Return the largest change that makes distances realisable, in a few words."""
    largest = float(np.max(np.abs(nearest.residuals)))
    match nearest.fit:
        case Fit.AS_GIVEN:
            return "as given"
        case Fit.WITHIN_BOUNDS:
            return f"within {rounded_up(largest, digits=2)} mm"
        case Fit.NOT_FOUND:
            return f"not found; nearest at {rounded_up(largest, digits=2)} mm"
        case Fit.IMPOSSIBLE:
            return f"**no**; nearest at {rounded_up(largest, digits=2)} mm"


def _fit_sentence(nearest: Nearest) -> str:
    """Return how points fit distances, and which distance they change most."""
    worst = int(np.argmax(np.abs(nearest.residuals)))
    change = f"{nearest.measured.names[worst]} by {_away_from_zero(nearest.residuals[worst])} mm"
    match nearest.fit:
        case Fit.AS_GIVEN:
            return nearest.fit.sentence
        case Fit.WITHIN_BOUNDS:
            return f"{nearest.fit.sentence}; the nearest change {change} at most"
        case Fit.NOT_FOUND | Fit.IMPOSSIBLE:
            beyond = rounded_up(float(np.max(nearest.beyond)), digits=3)
            return f"{nearest.fit.sentence}; the nearest change {change}, {beyond} mm beyond a bound"


def _away_from_zero(change: float) -> str:
    """Return a change with its sign, in mm: no larger one is meant."""
    size = rounded_up(abs(change), digits=3)
    return f"{'-' if change < 0.0 else '+'}{size}"


def _misprint_lines(misprint: Misprint) -> list[str]:
    lines = list(misprint.reasons)
    if misprint.named is not None:
        lines.append(f"so {_suspect_words(misprint.named)}")
    elif misprint.suspects:
        lines.append(f"so one of these is wrong: {'; or '.join(map(_suspect_words, misprint.suspects))}")
    else:
        lines.append("no single wrong number explains that")
    return lines


def _suspect_words(suspect: Suspect) -> str:
    words = (
        f"{suspect.name} = {1e3 * suspect.value:.6g} mm is impossible, the others ask for "
        f"{rounded_down(suspect.lower)} to {rounded_up(suspect.upper)} mm"
    )
    if suspect.reading is None:
        return words
    return f"{words}; with its decimal point moved it is {1e3 * suspect.reading:.6g} mm, which is read here"


def _misprint_cell(misprint: Misprint) -> str:
    names = " or ".join(f"{suspect.name} = {1e3 * suspect.value:.6g}" for suspect in misprint.suspects)
    words = f"**{names or 'more than one number'} is impossible**"
    if misprint.named is None or misprint.named.reading is None:
        return words
    return f"{words}, read as {1e3 * misprint.named.reading:.6g}"


def _spread_lines(inspection: Inspection) -> list[str]:
    spreads = inspection.spreads
    if not spreads:
        return ["no shape was drawn that the bounds allow: nothing is said of ranges"]
    degrees = math.degrees(1.0)
    intended = inspection.measurement.intended
    meant = "" if intended is None else f"; meant to be {intended.value}"
    angle, apart = _range(spreads["alpha"], degrees), _range(spreads["a"], 1e3)
    return [
        f"under the bounds: axes at {angle} deg, {apart} mm apart{meant}",
        (
            f"from axis 2 to P2 {_range(spreads['puma'], 1e3)} mm (PUMA-like at 0), "
            f"to P1 {_range(spreads['spherical'], 1e3)} mm (spherical at 0), "
            f"from parallel {_range(spreads['scara'], degrees)} deg (SCARA at 0)"
        ),
    ]


def _link_sentence(inspection: Inspection) -> str:
    link, shape = inspection.link, inspection.link.arm.shape
    if link.obstacle:
        return f"the link cannot take this pose: {link.obstacle}"
    if not link.found:
        return (
            f"no shape of the link was found that takes this pose; the nearest is "
            f"{rounded_up(link.beyond)} mm beyond a bound of d13, d14, d23 or d24"
        )
    return (
        f"the link can take this pose: {1e3 * shape.length:.0f} mm long, "
        f"smallest bend radius {rounded_down(shape.min_bend_radius, digits=0)} mm"
    )
