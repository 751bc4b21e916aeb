"""Writes a report: one HTML file that needs nothing else, neither beside it nor from a network."""

import json
import secrets
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs
from plotly.utils import PlotlyJSONEncoder

from . import facts, tables
from .sections import of_one, of_several, tiles


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
    single = len(excerpts) == 1
    sections = of_one(excerpts[0]) if single else of_several(excerpts, names)
    figures = {}
    placed = [section._replace(figures=[_place(figure, figures) for figure in section.figures]) for section in sections]
    text = _environment().get_template("page.html.j2").render(
        title=facts.headline(excerpts[0]) if single else f"{len(excerpts)} runs side by side",
        runs=[_run(name, excerpt) for name, excerpt in zip(names, excerpts, strict=True)],
        tiles=tiles(excerpts[0].analysis) if single else [],
        sections=placed,
        figures=figures,
        plotly=Markup(get_plotlyjs()),
        nonce=secrets.token_urlsafe(16),  # scripts without it do not run, should ever one come in with a bag
    )  # fmt: skip
    _write(text, Path(path))


def _environment():
    """Return templates that escape what is put into them; figures go in as JSON without signs that HTML knows."""
    environment = Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_function"] = lambda figures, **_: json.dumps(figures, cls=PlotlyJSONEncoder)
    return environment


def _run(name, excerpt):
    analysis = excerpt.analysis
    return {
        "name": name,
        "facts": facts.facts(excerpt),
        "notes": analysis.notes,
        "worries": tables.worries(analysis),
        "sound": tables.sound(analysis),
        "provenance": excerpt.provenance,
        "messages": analysis.messages,
        "vehicle": excerpt.vehicle,
        "gaps": tables.gaps(analysis),
        "loop": tables.loop(analysis),
    }


def _place(figure, figures):
    """Add a figure to those that the page draws; returns its id and height."""
    name = f"figure-{len(figures)}"
    figures[name] = figure.to_plotly_json()
    return name, figure.layout.height


def _write(text, path):
    with path.open("x", encoding="utf-8") as file:
        try:
            file.write(text)
            file.flush()
        except OSError:
            path.unlink(missing_ok=True)
            raise
