"""The figures of several bags side by side: a function each, from their `ReportData`s and names."""

import plotly.graph_objects as go

from ..numbers import AXES, SENSORS
from .figure_style import AXIS_NAMES, BAG_COLOURS, BAG_DASHES, coherence, density, line, plain, ratio, settling, styled


def _look(index):
    return BAG_COLOURS[index % len(BAG_COLOURS)], BAG_DASHES[index // len(BAG_COLOURS) % len(BAG_DASHES)]


def overlay(report_data_list, names, points, **options):
    """Return a line a bag; `points(report_data)` is None where a bag has none."""
    traces = []
    for index, (report_data, name) in enumerate(zip(report_data_list, names, strict=True)):
        found = points(report_data)
        if found is not None:
            colour, dash = _look(index)
            traces.append(line(found, plain(name), colour, dash=dash, **options))
    return traces


def rms_bars(report_data_list, names):
    """RMS of each sensor and axis as groups of bars, a bar a bag."""
    groups = [f"{sensor} {axis}" for sensor in SENSORS for axis in AXES]
    figure = go.Figure()
    for index, (report_data, name) in enumerate(zip(report_data_list, names, strict=True)):
        found = report_data.analysis.sensors
        heights = [found[sensor][axis].rms for sensor in SENSORS for axis in AXES]
        figure.add_trace(go.Bar(x=groups, y=heights, name=plain(name), marker_color=_look(index)[0]))
    figure.update_xaxes(automargin=True)
    figure.update_yaxes(title_text="RMS, m/s²")
    return styled(figure, 340)


def spectra(report_data_list, names):
    """Power spectral densities: a figure a sensor and axis. Lines are those of the first bag."""
    return [
        density(
            _spectrum(report_data_list, names, column, lambda found, s=sensor: found.psd[s]),
            report_data_list[0].analysis,
            f"{sensor.capitalize()}, {AXIS_NAMES[axis]}",
        )
        for sensor in reversed(SENSORS)
        for column, axis in enumerate(AXES)
    ]


def transmission(report_data_list, names):
    """Transmissibility from chassis to powertrain, and their coherence: a figure an axis each."""
    return [
        kind(
            _spectrum(report_data_list, names, column, lambda found, v=values: getattr(found, v)),
            report_data_list[0].analysis,
            f"{values.capitalize()}, {AXIS_NAMES[axis]}",
        )
        for kind, values in ((ratio, "transmissibility"), (coherence, "coherence"))
        for column, axis in enumerate(AXES)
    ]


def _spectrum(report_data_list, names, column, values):
    def points(report_data):
        found = report_data.analysis.spectra
        return found.frequency[1:], values(found)[1:, column]

    return overlay(report_data_list, names, points)


def histories(report_data_list, names):
    """Vertical specific force: a figure a sensor."""
    figures = []
    for sensor in reversed(SENSORS):
        traces = overlay(
            report_data_list, names, lambda each, s=sensor: each.accelerations[s]["z"], width=0.8, opacity=0.75
        )
        figure = styled(go.Figure(traces), 320, f"{sensor.capitalize()}, {AXIS_NAMES['z']}")
        figure.update_xaxes(title_text="time, s")
        figure.update_yaxes(title_text="specific force, m/s²")
        figures.append(settling(figure, report_data_list[0].analysis))
    return figures


def mount_loops(report_data_list, names):
    """A second of force over deflection and over velocity: a figure a mount each."""
    figures = []
    for kind, unit in (("deflection_loops", "deflection, mm"), ("velocity_loops", "velocity, m/s")):
        for mount in _of_any(getattr(each, kind) for each in report_data_list):
            traces = overlay(report_data_list, names, lambda each, k=kind, m=mount: _second(getattr(each, k).get(m)))
            if traces:
                title = f"{plain(mount.capitalize())} mount, force over {unit.split(',')[0]}"
                figure = styled(go.Figure(traces), 340, title)
                figure.update_xaxes(title_text=unit, zeroline=False)
                figure.update_yaxes(title_text="force on the powertrain, kN", zeroline=False)
                figures.append(figure)
    return figures


def _of_any(parts):
    """Return the names that any of some dicts has, in their order."""
    return dict.fromkeys(name for part in parts for name in part)


def _second(loop):
    return loop.line if loop is not None else None


def currents(report_data_list, names):
    """Current in the coils: a figure a mount."""
    figures = []
    for coil in _of_any(each.currents for each in report_data_list):
        traces = overlay(report_data_list, names, lambda each, c=coil: each.currents.get(c))
        if traces:
            figure = styled(go.Figure(traces), 300, f"{plain(coil.capitalize())} coil")
            figure.update_xaxes(title_text="time, s")
            figure.update_yaxes(title_text="current, A", rangemode="tozero")
            figures.append(settling(figure, report_data_list[0].analysis))
    return figures
