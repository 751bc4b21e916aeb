"""The Markdown report of the M113 study."""

from .case import CORRELATION, RESISTANCE, ROAD_SHARE, TENSIONERS
from .measures import BANDS, LINES, LINES_SHARE, THIRD_OCTAVES, band_name, line_name, octave_name
from .reference import LEVEL, standing_octaves
from .table import CORRELATION_GOAL, FACTORS, GOALS, LOAD_GOAL, ROAD_BORNE_GOAL
from .variants import BASE, VARIANTS

_HIGH = band_name(*BANDS[3])


def report(rows, factors, loads, frequencies, phases):
    """Return the report as Markdown text.

    Parameters
    ----------
    rows : list of table.Row
    factors : dict
        As `table.variant_factors` returns them.
    loads : pair of arrays (2, stations)
        Static wheel loads, ours and theirs, N.
    frequencies : dict
        Name -> (ours, theirs) in Hz, of ride motions.
    phases : int
        Runs a case.
    """
    mine = [row for row in rows if row.variant == BASE]
    parts = [_head(phases), _levels(mine), _phases(mine), _standing(mine), _sides(mine), _loads(*loads)]
    parts += [_ride(frequencies), _variants(factors)]
    return "\n".join(parts)


def _head(phases):
    return f"""# The M113 compared with Project Chrono

Vertical acceleration of the hull at its centre of mass, RMS in m/s²: ours / theirs, and in brackets the factor between
them; **bold** where the goal is not met. Ours is the quadratic mean over {phases} phases between the tracks;
theirs is one run of 6 s per case. Goals:

* {_HIGH} within {GOALS[_HIGH]:g};
* third octaves there within {GOALS[octave_name(THIRD_OCTAVES[0])]:g};
* lines 1 to 3, k v/p, within {GOALS[line_name(1)]:g};
* 0.5-5 Hz on the rough road within {ROAD_BORNE_GOAL:g};
* the same motion over distance correlated by more than {CORRELATION_GOAL:g}.

The bands from 5 to 100 Hz, and all below 20 Hz on level ground, are no goals: in that code the vehicle vibrates there
while standing.
"""


def _levels(rows):
    cases = list(dict.fromkeys((row.road, row.speed) for row in rows))
    names = [*(band_name(*band) for band in BANDS), CORRELATION, ROAD_SHARE, *map(octave_name, THIRD_OCTAVES)]
    names += [*(line_name(k) for k in LINES), LINES_SHARE]
    lines = ["## Levels", "", *_header("", *(f"{road}, {speed} m/s" for road, speed in cases))]
    by_place = {(row.quantity, row.road, row.speed): row for row in rows}
    lines += [_line(name, *(_cell(by_place.get((name, *case))) for case in cases)) for name in names]
    return "\n".join(lines) + "\n"


def _cell(row):
    if row is None:
        return ""
    text = f"{row.ours:.2f}" if row.theirs is None else f"{row.ours:.2f} / {row.theirs:.2f} ({row.factor:.2f})"
    return f"**{text}**" if row.agrees is False else text


def _phases(rows):
    cases = list(dict.fromkeys((row.road, row.speed) for row in rows))
    by_place = {(row.quantity, row.road, row.speed): row for row in rows}
    lines = [
        "## Lines over the phases",
        "",
        "Range of our runs / theirs, which is one run with one phase; **bold** where theirs is outside the range.",
        "",
        *_header("", *(f"{road}, {speed} m/s" for road, speed in cases)),
    ]
    for name in map(line_name, LINES):
        cells = (range_cell(by_place[(name, *case)], "**{}**") for case in cases)
        lines.append(_line(name, *cells))
    return "\n".join(lines) + "\n"


def range_cell(row, outside):
    """Return a row's range and the reference's value as text, formatted by `outside` where it is not in the range."""
    text = f"{row.least:.2f} to {row.greatest:.2f} / {row.theirs:.2f}"
    return text if row.covers else outside.format(text)


def _standing(rows):
    rolling = {(row.quantity, row.speed): row.theirs for row in rows if row.road == LEVEL}
    speeds = sorted({speed for _, speed in rolling})
    lines = [
        "## Their vibration while standing",
        "",
        "Third octaves while standing, m/s², and their fraction of the mean square on level ground.",
        "",
        *_header("Hz", "standing", *(f"of {LEVEL}, {speed} m/s" for speed in speeds)),
    ]
    for centre, standing in zip(THIRD_OCTAVES, standing_octaves(), strict=True):
        parts = (f"{(standing / rolling[(octave_name(centre), speed)]) ** 2:.0%}" for speed in speeds)
        lines.append(_line(f"{centre:.0f}", f"{standing:.2f}", *parts))
    return "\n".join(lines) + "\n"


def _sides(rows):
    cases = list(dict.fromkeys((row.road, row.speed) for row in rows))
    lines = [
        "## Tensioners and running resistance",
        "",
        "Means over the runs, kN. Theirs at the tensioners in motion: 25 to 27 left, 3.7 to 4.5 right. The springs",
        "have the same law; forces follow from the lengths of tracks and running gear. Running resistance was not",
        "recorded there.",
        "",
        *_header("", *(f"{road}, {speed} m/s" for road, speed in cases)),
    ]
    by_place = {(row.quantity, row.road, row.speed): row for row in rows}
    for name in (*TENSIONERS, RESISTANCE):
        lines.append(_line(name, *(f"{by_place[(name, *case)].ours / 1e3:.1f}" for case in cases)))
    return "\n".join(lines) + "\n"


def _loads(ours, theirs):
    stations = [f"{side} {k + 1}" for side in ("left", "right") for k in range(ours.shape[1])]
    factor = (ours / theirs).ravel()
    cells = [f"**{each:.3f}**" if abs(each - 1.0) > LOAD_GOAL else f"{each:.3f}" for each in factor]
    lines = [
        "## Static wheel loads",
        "",
        "Loads of the wheels on their arms, standing, kN. Theirs by statics from that code's published masses,",
        f"positions, bars and contacts with the tension measured there. The goal is {100 * LOAD_GOAL:g} %.",
        "",
        *_header("", *stations),
        _line("ours", *(f"{each / 1e3:.2f}" for each in ours.ravel())),
        _line("theirs", *(f"{each / 1e3:.2f}" for each in theirs.ravel())),
        _line("factor", *cells),
    ]
    return "\n".join(lines) + "\n"


def _ride(frequencies):
    lines = ["## Ride frequencies", "", "Hz; theirs on rigid contacts.", "", *_header("", "ours", "theirs")]
    lines += [_line(name, *(f"{each:.2f}" for each in pair)) for name, pair in frequencies.items()]
    return "\n".join(lines) + "\n"


def _variants(factors):
    lines = [
        "## Sources of differences",
        "",
        "Variants with one change each: levels relative to those of the vehicle file, geometric mean over the four",
        "cases (0.5-5 Hz and correlation: the rough road; correlation as is), over the phases of the variants.",
        "",
        *_header("variant", *FACTORS),
    ]
    lines += [_line(VARIANTS[name].title, *(f"{each:.2f}" for each in values)) for name, values in factors.items()]
    return "\n".join(lines) + "\n"


def _header(*names):
    return [_line(*names), "|" + "---|" * len(names)]


def _line(*cells):
    return f"| {' | '.join(cells)} |"
