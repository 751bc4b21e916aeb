"""Writes a report: one HTML file that needs nothing else, neither beside it nor from a network."""

import json
import secrets
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs
from plotly.utils import PlotlyJSONEncoder

from ..summary import AXES
from . import bag_figures, comparison_figures, facts, tables


class Section(NamedTuple):
    """A part of the page: figures, then tables, under a heading and a sentence."""

    title: str
    words: str
    figures: list
    tables: list
    wide: bool = False  # figures below each other, each as wide as the page


def write_report(excerpts, path):
    """Write the report on one bag, or the comparison of several, to a new HTML file.

    Parameters
    ----------
    excerpts : list of Excerpt
    path : path

    Raises
    ------
    FileExistsError
        The file exists already.
    OSError
        It cannot be written; nothing is left of it.
    """
    names = facts.names([excerpt.analysis.bag for excerpt in excerpts])
    sections = _comparison(excerpts, names) if len(excerpts) > 1 else _single(excerpts[0])
    figures = {}
    placed = [section._replace(figures=[_place(figure, figures) for figure in section.figures]) for section in sections]
    environment = Environment(
        loader=PackageLoader(__package__), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.policies["json.dumps_function"] = lambda figure, **_: json.dumps(figure, cls=PlotlyJSONEncoder)
    text = environment.get_template("page.html.j2").render(
        title=f"{len(excerpts)} runs compared" if len(excerpts) > 1 else facts.headline(excerpts[0]),
        runs=[
            {
                "name": name,
                "facts": facts.facts(excerpt),
                "notes": excerpt.analysis.notes,
                "worries": tables.worries(excerpt.analysis),
                "provenance": excerpt.provenance,
                "messages": excerpt.analysis.messages,
                "vehicle": excerpt.vehicle,
                "gaps": tables.gaps(excerpt.analysis),
                "loop": tables.loop(excerpt.analysis),
            }
            for name, excerpt in zip(names, excerpts, strict=True)
        ],
        tiles=_tiles(excerpts[0].analysis) if len(excerpts) == 1 else [],
        sections=placed,
        figures=figures,
        plotly=Markup(get_plotlyjs()),
        nonce=secrets.token_urlsafe(16),
    )
    _write(text, Path(path))


def _single(excerpt):
    analysis = excerpt.analysis
    words = (
        "Both sensors sit at the ends of the MR mounts. Changes are those from chassis to powertrain; part of them is geometry, "
        "because the ends move differently on rigid mounts, too. Weighted: ISO 2631-1, Wk along z, Wd along x and y."
    )
    sections = [Section("Numbers", words, [], [tables.accelerations(analysis)])]
    words = "Specific force as recorded, +g along z at rest. Of long bags the least and the greatest value of each part is drawn."
    sections.append(Section("Histories", words, _some(bag_figures.histories(excerpt), bag_figures.levels(excerpt)), [], True))
    words = "Welch's method, windows of 1 s. Dotted: links entering the sprockets, v/p and multiples. Dashed: orders of the engine."
    sections.append(Section("Spectra", words, bag_figures.spectra(excerpt), []))
    sections.append(Section("From chassis to powertrain", "", bag_figures.transmission(excerpt), []))
    if analysis.lines:
        words = "RMS in m/s² in a band about each line."
        sections.append(Section("Link passing and engine orders", words, [], [tables.lines(analysis)]))
    words = "Level in dB re 1 (m/s²)²/Hz, windows of 0.5 s. Empty where samples are missing."
    sections.append(Section("Spectrograms", words, bag_figures.spectrograms(excerpt), []))
    if analysis.mounts:
        words = (
            "Vertical, hull's axes. Grey: where the mount was, darker where longer. Line: one second about its greatest travel."
        )
        sections.append(Section("Mounts", words, bag_figures.mount_loops(excerpt), [tables.mounts(analysis)]))
    sections.append(Section("Current", "", _some(bag_figures.currents(excerpt)), [], True))
    sections.append(Section("Stamps", "Stamps, not times of recording, are the time base.", [], [tables.timing(analysis)]))
    return [section for section in sections if section.figures or section.tables]


def _comparison(excerpts, names):
    analyses = [excerpt.analysis for excerpt in excerpts]
    words = f"In brackets: difference to {names[0]}. Weighted: ISO 2631-1, Wk along z, Wd along x and y."
    bars = [comparison_figures.rms_bars(excerpts, names)]
    sections = [Section("Numbers", words, bars, [tables.comparison(analyses, names)], True)]
    rows = facts.differing(excerpts)
    if rows:
        told = tables.Table(("node", "parameter", *names), rows, 2 + len(names))
        sections.append(Section("What differs between the runs", "Parameters of the nodes.", [], [told]))
    words = f"Lines of link passing (dotted) and of the engine (dashed) are those of {names[0]}."
    sections.append(Section("Spectra", words, comparison_figures.spectra(excerpts, names), []))
    sections.append(Section("From chassis to powertrain", "", comparison_figures.transmissibilities(excerpts, names), []))
    words = "Specific force as recorded, +g along z at rest."
    sections.append(Section("Histories", words, comparison_figures.histories(excerpts, names), [], True))
    words = "Vertical, hull's axes: one second about each mount's greatest travel."
    sections.append(Section("Mounts", words, comparison_figures.mount_loops(excerpts, names), []))
    sections.append(Section("Current", "", comparison_figures.currents(excerpts, names), [], True))
    return [section for section in sections if section.figures or section.tables]


def _tiles(analysis):
    """Return the headline numbers: words, number, unit, remark."""
    chassis, powertrain = (analysis.sensors[sensor] for sensor in ("chassis", "powertrain"))
    tiles = [
        (f"powertrain, RMS {axis}", tables.number(powertrain[axis].rms, 3), "m/s²",
         f"{tables.change(powertrain[axis].rms, chassis[axis].rms)} against the chassis")
        for axis in reversed(AXES)
    ]  # fmt: skip
    tiles.append(("powertrain, weighted z (Wk)", tables.number(powertrain["z"].rms_weighted, 3), "m/s²",
                  f"{tables.change(powertrain['z'].rms_weighted, chassis['z'].rms_weighted)} against the chassis"))  # fmt: skip
    if analysis.mounts:
        energy = sum(mount.energy_dissipated for mount in analysis.mounts.values())
        tiles.append(("dissipated in both mounts", tables.number(energy, 3), "J", f"in {analysis.measured:.4g} s"))
    return tiles


def _some(*figures):
    return [figure for figure in figures if figure is not None]


def _place(figure, figures):
    """Add a figure to those that the page draws; returns its id and height."""
    name = f"figure-{len(figures)}"
    figures[name] = figure.to_plotly_json()
    return name, figure.layout.height


def _write(text, path):
    with path.open("x", encoding="utf-8") as file:
        try:
            file.write(text)
        except OSError:
            path.unlink(missing_ok=True)
            raise
