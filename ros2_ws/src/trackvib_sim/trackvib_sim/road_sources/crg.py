"""Road surfaces as OpenCRG files [CRG]: heights on a grid along and across a reference line.

Curves are those of the drive, not of the road, so that files whose reference line is curved are refused. The grid's
heights, with slope and banking of the line, are taken where the tracks run. All four representations are read: numbers
as text of 10 or 20 characters (LRFI, LDFI) and binary ones of 4 or 8 bytes, big-endian (KRBI, KDBI).

[CRG] ASAM OpenCRG 1.2.0, user manual, 2020.
"""

import re
from array import array
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.plain_text import readable, shortened

from ..ordinary_file import open_ordinary
from ..road.profile import MOST, ProfileError, checked

STRAIGHT = 0.005  # rad; a heading that changes by more is a curve
_TEXT = {"LRFI": (10, 8), "LDFI": (20, 4)}  # characters of a number, numbers of a line
_BINARY = {"KRBI": ">f4", "KDBI": ">f8"}
_BLOCK = 80  # bytes
_MOST_CHANNELS = 10_000
_LARGEST = 2**29  # bytes
_LONGEST_HEAD = 2**20  # bytes
_END_OF_HEAD = re.compile(rb"^\$\$\$\$[^\r\n]*\r?\n", re.MULTILINE)
_SECTION_AT = re.compile(r"long section at v\s*=\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)", re.IGNORECASE)


class _Head(NamedTuple):
    values: dict  # name in small letters -> number
    channels: list  # of the data, in order
    kind: str


def read_crg(path, tread):
    """Return the `profile.Profile` under both tracks of a vehicle, which are `tread` [m] apart, in an OpenCRG file.

    Raises
    ------
    ProfileError
        The file is none, is damaged, curved, or narrower than the vehicle.
    OSError
        It cannot be read.
    """
    name = readable(str(path))
    with open_ordinary(path, _LARGEST) as file:
        end = _END_OF_HEAD.search(file.read(_LONGEST_HEAD))
        if end is None:
            raise ProfileError(f"{name} is not an OpenCRG file: no line $$$$ ends its header")
        head = _head(end.string[: end.start()].decode("latin-1"), name)
        file.seek(end.end())
        grid = _grid(file.read(), head, name)
    with np.errstate(all="ignore"):  # what is not finite is refused
        return _tracks(head, grid, tread, name)


def write_crg(path, increment, heights, tread, start=0.0):
    """Write heights (2, n), left and right [m], `tread` [m] apart, as KDBI; they come back to the last bit.

    `increment` [m] lies between two of them, `start` [m] is where they begin.
    """
    half, (_, count) = 0.5 * tread, heights.shape
    head = (
        f"$CT\nwritten by trackvib: two tracks {tread!r} m apart\n$\n$ROAD_CRG\n"
        f"REFERENCE_LINE_START_U   = {start!r}\nREFERENCE_LINE_END_U     = {start + (count - 1) * increment!r}\n"
        f"REFERENCE_LINE_INCREMENT = {increment!r}\n$\n$KD_DEFINITION\n#:KDBI\n"
        f"U:reference line u,m,{start!r},{increment!r}\n"
        f"D:long section at v = {-half!r},m\nD:long section at v = {half!r},m\n$\n{'$' * 72}\n"
    )
    numbers = np.ascontiguousarray(heights[::-1].T, dtype=">f8").tobytes()  # from right to left
    padding = np.full(-len(numbers) % _BLOCK // 8, np.nan, dtype=">f8").tobytes()
    Path(path).write_bytes(head.encode("latin-1") + numbers + padding)


def _head(text, name):
    values, channels, kind, section = {}, [], None, ""
    for raw in text.splitlines():
        line = raw.split("!", 1)[0].rstrip()
        if raw.startswith("$"):
            section = line.upper()
        elif section == "$ROAD_CRG_FILE":
            raise ProfileError(f"{name} only refers to another file; give that file")
        elif section == "$ROAD_CRG_MODS" and "=" in line:
            raise ProfileError(f"{name} has modifiers ($ROAD_CRG_MODS), accepted: files without; apply them first")
        elif section == "$ROAD_CRG" and "=" in line:
            key, value = line.split("=", 1)
            values[key.strip().lower()] = _number(value)
            if not np.isfinite(_number(value)):
                shown = readable(shortened(line.strip()))
                raise ProfileError(f"{name}: {shown!r} in $ROAD_CRG, accepted: NAME = NUMBER")
        elif section == "$KD_DEFINITION" and line.startswith("#:"):
            kind = line[2:].strip().upper()
        elif section == "$KD_DEFINITION" and line.startswith("D:"):
            channel, _, unit = (part.strip().lower() for part in line[2:].rpartition(","))
            if channel.startswith("long section") and unit != "m":
                shown = readable(shortened(line[2:].strip()))
                raise ProfileError(f"{name}: channel {shown!r}, accepted: heights in m")
            channels.append(channel)
    if kind not in (*_TEXT, *_BINARY):
        accepted = ", ".join((*_TEXT, *_BINARY))
        raise ProfileError(f"{name}: data are {readable(shortened(str(kind)))}, accepted: {accepted}")
    if not 1 <= len(channels) <= _MOST_CHANNELS:
        raise ProfileError(f"{name}: {len(channels)} channels, accepted: 1 to {_MOST_CHANNELS}")
    if not values.get("reference_line_increment", 0.0) > 0.0:
        given = values.get("reference_line_increment")
        raise ProfileError(f"{name}: REFERENCE_LINE_INCREMENT is {given}, accepted: a length in m")
    return _Head(values, channels, kind)


def _number(text):
    try:
        return float(text)
    except ValueError:
        return np.nan


def _grid(data, head, name):
    """Return the data (rows, channels), missing ones not a number."""
    count = len(head.channels)
    if head.kind in _BINARY:
        kind = np.dtype(_BINARY[head.kind])
        numbers = np.frombuffer(data, kind, len(data) // kind.itemsize)
        whole = len(numbers) // count * count
        if not np.isnan(numbers[whole:]).all():
            raise ProfileError(f"{name} is cut short: {len(numbers)} numbers do not make whole rows of {count}")
        grid = numbers[:whole].reshape(-1, count)
        told = np.flatnonzero(~np.isnan(grid).all(axis=1))
        grid = grid[: told[-1] + 1 if told.size else 0]  # without rows of nothing but padding
    else:
        grid = _text_grid(data, count, *_TEXT[head.kind], name)
    if not 2 <= len(grid) <= MOST:
        raise ProfileError(f"{name}: {len(grid)} rows, accepted: 2 to {MOST}")
    return grid


def _text_grid(data, count, width, on_line, name):
    lines = [line for line in data.splitlines() if line.strip() and not line.startswith((b"* ", b"$"))]
    deep = -(-count // on_line)
    if len(lines) % deep:
        raise ProfileError(f"{name} is cut short: {len(lines)} lines do not make whole rows of {deep}")
    numbers = array("d")
    for first in range(0, len(lines), deep):
        cells = []
        for line in lines[first : first + deep]:
            cells += [line[k : k + width] for k in range(0, len(line.rstrip()), width)]
        if len(cells) != count:
            raise ProfileError(f"{name}: row {first // deep + 1} has {len(cells)} numbers, must have {count}")
        try:
            numbers.extend([np.nan if cell.lstrip().startswith(b"*") else float(cell) for cell in cells])
        except ValueError:
            shown = readable(shortened(lines[first].decode("latin-1")))
            raise ProfileError(f"{name}: row {first // deep + 1} begins {shown!r}, accepted: numbers") from None
    return np.array(numbers).reshape(-1, count)


def _tracks(head, grid, tread, name):
    values, step = head.values, head.values["reference_line_increment"]
    line = {
        kind: np.asarray(grid[:, head.channels.index(f"reference line {kind}")], float)
        for kind in ("phi", "slope", "banking")
        if f"reference line {kind}" in head.channels
    }
    _require_straight(line.get("phi"), values, name)
    sections = [k for k, channel in enumerate(head.channels) if channel.startswith("long section")]
    across = _across(head, sections, name)
    order = np.argsort(across)
    across, sections = across[order], np.array(sections)[order]
    half = 0.5 * tread
    if not (across[0] <= -half and half <= across[-1]):
        raise ProfileError(
            f"{name} reaches from {across[0]:g} to {across[-1]:g} m across, "
            f"the vehicle's tracks run at -{half:g} and {half:g} m"
        )
    heights = np.stack([_along(across, grid, sections, v, name) for v in (half, -half)])
    slope = line.get("slope", np.full(len(grid), values.get("reference_line_start_s", 0.0)))
    banking = line.get("banking", np.full(len(grid), values.get("reference_line_start_b", 0.0)))
    # the first row of a line's channel is unused: each row has what leads to it
    rise = np.concatenate(([0.0], np.cumsum(slope[1:] * step)))
    bank = np.concatenate((banking[1:2], banking[1:]))
    if np.any(rise):
        heights = heights + rise
    if np.any(bank):
        heights = heights + bank * np.array([[half], [-half]])
    start = values.get("reference_line_start_u", 0.0)
    return checked(start + step * np.arange(len(grid)), heights, name)


def _require_straight(phi, values, name):
    turns = 0.0
    if phi is not None and len(phi) > 1:
        known = phi[1:][np.isfinite(phi[1:])]
        turns = float(np.ptp(known)) if known.size else 0.0
    ends = [values.get(f"reference_line_{end}_phi") for end in ("start", "end")]
    if None not in ends:
        turns = max(turns, abs(ends[1] - ends[0]))
    if turns > STRAIGHT:
        raise ProfileError(
            f"{name} is a road with a curve, its heading changes by {turns:.3g} rad; accepted: straight ones "
            f"(up to {STRAIGHT:g} rad), curves are part of the drive"
        )


def _across(head, sections, name):
    """Return where across the reference line the sections lie (k,) m."""
    values, places = head.values, []
    for k in sections:
        found = _SECTION_AT.search(head.channels[k])
        if found:
            places.append(float(found[1]))
    if len(places) == len(sections) and places:
        return np.array(places)
    step, right, left = (values.get(f"long_section_v_{what}") for what in ("increment", "right", "left"))
    if not sections or step is None or not step > 0.0:
        raise ProfileError(f"{name} does not give the positions of its {len(sections)} long sections")
    if right is None:
        right = -0.5 * step * (len(sections) - 1) if left is None else left - step * (len(sections) - 1)
    return right + step * np.arange(len(sections))


def _along(across, grid, sections, v, name):
    """Return the heights (rows,) at a place across, linear between the sections to either side."""
    left = min(int(np.searchsorted(across, v)), len(across) - 1)
    heights = grid[:, sections[left]].astype(float)
    if across[left] != v:
        share = (across[left] - v) / (across[left] - across[left - 1])
        heights = (1.0 - share) * heights + share * grid[:, sections[left - 1]]
    missing = np.flatnonzero(~np.isfinite(heights))
    if missing.size:
        raise ProfileError(f"{name}: no height in row {missing[0] + 1} at {v:g} m across, under a track")
    return heights
