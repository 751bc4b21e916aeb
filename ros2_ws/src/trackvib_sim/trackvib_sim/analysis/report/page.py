"""Writes a report: one HTML file that needs nothing else, neither beside it nor from a network."""

import json
import secrets
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs
from plotly.utils import PlotlyJSONEncoder

from . import facts, tables
from .definitions import definitions
from .sections import of_one, of_several, tiles


def write_report(report_data_list, path, first=()):
    """Write the report on one bag, or the comparison of several, to a new HTML file.

    Parameters
    ----------
    report_data_list : list of ReportData
    path : path
    first : sequence of Section
        That stand before all others.

    Raises
    ------
    FileExistsError
        The file exists already.
    OSError
        It cannot be written; nothing is left of it.
    """
    names = facts.names([report_data.analysis.bag for report_data in report_data_list])
    single = len(report_data_list) == 1
    found = of_one(report_data_list[0]) if single else of_several(report_data_list, names)
    sections = [*first, *found, definitions()]
    figures = {}
    placed = [section._replace(figures=[_place(figure, figures) for figure in section.figures]) for section in sections]
    text = _environment().get_template("page.html.j2").render(
        title=facts.headline(report_data_list[0]) if single else f"{len(report_data_list)} runs compared",
        runs=[_run(name, report_data) for name, report_data in zip(names, report_data_list, strict=True)],
        tiles=tiles(report_data_list[0].analysis) if single else [],
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


def _run(name, report_data):
    analysis = report_data.analysis
    return {
        "name": name,
        "facts": facts.facts(report_data),
        "notes": analysis.notes,
        "worries": tables.worries(analysis),
        "sound": tables.sound(analysis),
        "provenance": report_data.provenance,
        "messages": analysis.messages,
        "vehicle": report_data.vehicle,
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
