"""`trackvib road`: what a road is like, as a table and a picture, and written as a file."""

from contextlib import ExitStack
from pathlib import Path

import numpy as np
from rich.table import Table

from ..console import Terminal
from ..road.obstacles import ObstacleRoad
from ..road.profile import ProfileRoad
from ..road_sources.crg import write_crg
from ..road_sources.csv_profile import write_csv_profile
from ..road_sources.measures import measures
from ..road_sources.picture import road_picture
from ..road_sources.road_file import find_road, road_in_words
from ..road_sources.words import before, composition
from .result_folder import whole_or_none

SHORTEST_LOOK = 10.0  # m
MOST = 20_000_000  # samples
SHORTEST = 0.115  # m, of a link: what is shorter, shoes bridge


def run_road(text, seed, length, begin, tread, csv, crg, out):
    """Print what a road is like over a length [m], draw it, and write it as CSV or OpenCRG where asked.

    Raises
    ------
    road_file.RoadError, ValueError
        The road cannot be had, or the length has too many samples.
    CommandError
        A file cannot be written.
    """
    road = find_road(text, tread, seed)
    start = road.begins if begin is None else begin
    length = min(length, max(road.ends - start, SHORTEST_LOOK))
    first, count = round(start / road.spacing), round(length / road.spacing) + 1
    if count > MOST:
        raise ValueError(f"--length {length:g} m are {count} samples of {road.spacing:g} m, accepted: {MOST}")
    heights = road.heights(first, count)
    distance = road.spacing * np.arange(first, first + count)
    paths = [Path(path) for path in (out, csv, crg) if path is not None]
    if len({path.resolve() for path in (*paths, Path(text))}) <= len(paths):
        raise ValueError("the road, --out, --csv and --crg name the same file twice, must be different files")
    with ExitStack() as drafts:
        written = {path: drafts.enter_context(whole_or_none(path))[0] for path in paths}
        road_picture(distance, heights, f"{road_in_words(text)}, {length:g} m", written[Path(out)])
        if csv is not None:
            write_csv_profile(written[Path(csv)], distance, heights)
        if crg is not None:
            write_crg(written[Path(crg)], road.spacing, heights, tread, float(distance[0]))
    console = Terminal()
    name = road_in_words(text, composition(road))
    console.print(_table(heights, road, f"{name}, {distance[0]:g} to {distance[-1]:g} m"))
    if sentence := before(road):
        console.print(sentence, soft_wrap=True)
    ground = getattr(road, "ground", road)  # under obstacles
    taken = "interpolated linearly, " if isinstance(ground, ProfileRoad) and not ground.even else ""
    bridged = "; shoes bridge anything shorter than a link" if road.spacing < SHORTEST else ""
    console.print(f"samples are {taken}{road.spacing:g} m apart{bridged}", soft_wrap=True)
    console.print(f"left: {', '.join(map(str, paths))}", soft_wrap=True)


def _table(heights, road, title):
    table = Table("side", title=title, title_justify="left")
    for name in ("class", "Gd(0.1 1/m), 1e-6 m³", "waviness", "IRI, m/km", "RMS, mm", "heights, mm"):
        table.add_column(name, justify="right")
    for side, values in zip(("left", "right"), heights, strict=True):
        found = measures(values, road.spacing)
        numbers = 1e6 * found.level, found.waviness, found.iri, 1e3 * found.rms
        cells = (f"{number:.3g}" if np.isfinite(number) else "-" for number in numbers)
        low, high = 1e3 * values.min(), 1e3 * values.max()
        # of a random road with obstacles the title tells the class of the ground
        road_class = "" if isinstance(road, ObstacleRoad) else found.road_class
        table.add_row(side, road_class or "-", *cells, f"{low:.0f} to {high:.0f}")
    return table
