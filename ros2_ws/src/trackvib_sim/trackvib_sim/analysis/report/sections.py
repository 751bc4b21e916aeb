"""What a report consists of: sections with figures and tables, for one bag and for several."""

from math import isfinite
from typing import NamedTuple

from mr_mount_controller.node_base.topics import imu_topic

from ..absorbed_power import RIDE_LIMIT
from ..numbers import AXES, SENSORS
from . import (
    bag_figures,
    comparison_figures,
    comparison_tables,
    order_figures,
    spectrogram_figures,
    speed_figures,
    tables,
)
from .differences import differing
from .thinning import MOST

_WEIGHTED = "Weighted: ISO 2631-1, Wk along z, Wd along x and y."
_WELCH = (
    "Welch's method, windows of 1 s. Dotted: links entering the sprockets, v/p and multiples. Dashed: engine orders. "
    "Shaded: where they moved with the speed"
)
_PARTS = "Vertical z: RMS, and the power that a driver sitting there would absorb (dotted: 6 W, the usual ride limit)."
_ORDERS = "Vertical z. Order spectra in dB re 1 (m/s²)²/order by engine speed, and RMS in a band about each order."
_CAMPBELL = (
    "Vertical z, level in dB re 1 (m/s²)²/Hz by speed. Dotted: links entering the sprockets, v/p and multiples. "
    "Dashed: engine orders."
)
_STAMPS = "Stamps, not times of recording, are the time base."
_LEVEL = "Level in dB re 1 (m/s²)²/Hz, windows of 0.5 s. Empty where samples are missing."


class Section(NamedTuple):
    """A part of the page: figures, so many beside each other at most, then tables."""

    title: str
    words: str
    figures: list
    tables: list
    columns: int = 1


def of_one(report_data):
    """Return the `Section`s about one bag."""
    analysis = report_data.analysis
    sections = [
        Section(
            "Numbers",
            "The sensors are at the two ends of the MR mounts. Changes are from chassis to powertrain. Part of them is "
            f"geometry, because the two ends would move differently even on rigid mounts. {_WEIGHTED}",
            [],
            [tables.accelerations(analysis), tables.further(analysis)],
        ),
        Section("By distance", _PARTS, [speed_figures.by_way(analysis)], []),
        Section("By speed", _PARTS, [speed_figures.by_speed(analysis)], [tables.by_speed(analysis)]),
        Section(
            "Histories",
            _about_histories([analysis], "settling"),
            [bag_figures.histories(report_data), bag_figures.levels(report_data)],
            [],
        ),
        Section("Spectra", f"{_WELCH}.", bag_figures.spectra(report_data), [], 3),
        Section("From chassis to powertrain", "", bag_figures.transmission(report_data), [], 2),
        Section(
            "Link passing and engine orders", "RMS in m/s² in a band about each line.", [], [tables.lines(analysis)]
        ),
        Section("Engine orders", _ORDERS, order_figures.of_sensors(analysis), [], 2),
        Section("Campbell diagrams", _CAMPBELL, order_figures.campbells(analysis), [], 2),
        Section(
            "Spectrograms",
            _LEVEL,
            spectrogram_figures.of_sensors(report_data),
            [],
            2,
        ),
        Section(
            "Mounts",
            "Vertical, in the hull's axes. Grey: positions of the mount, darker where it stayed longer. Line: the "
            "second about its largest travel.",
            bag_figures.mount_loops(report_data),
            [tables.mounts(analysis)],
            2,
        ),
        Section("Current", "", [bag_figures.currents(report_data)], []),
        Section("Stamps", _STAMPS, [], [tables.timing(analysis, "stamps of")]),
    ]
    return _filled(sections)


def of_several(report_data_list, names):
    """Return the `Section`s that set bags side by side, by their names."""
    analyses = [report_data.analysis for report_data in report_data_list]
    settings = tables.Table(("node", "parameter", *names), differing(report_data_list), 2 + len(names))
    sections = [
        Section(
            "What differs between the runs", "Parameters of the nodes and entries of the vehicle files.", [], [settings]
        ),
        Section(
            "Numbers",
            f"In brackets: difference from {names[0]}. {_WEIGHTED}",
            [comparison_figures.rms_bars(report_data_list, names)],
            [*comparison_tables.accelerations(analyses, names), *comparison_tables.mounts(analyses, names)],
        ),
        Section("By distance", "Vertical z, RMS.", speed_figures.along_ways(report_data_list, names), [], 2),
        Section("By speed", "Vertical z, RMS.", speed_figures.by_speeds(report_data_list, names), [], 2),
        Section(
            "Spectra", f"{_WELCH}; both of {names[0]}.", comparison_figures.spectra(report_data_list, names), [], 3
        ),
        Section("From chassis to powertrain", "", comparison_figures.transmission(report_data_list, names), [], 3),
        Section(
            "Link passing and engine orders",
            f"RMS in m/s² in a band about each line. In brackets: difference from {names[0]}.",
            [],
            comparison_tables.lines(analyses, names),
        ),
        Section(
            "Engine orders",
            "Powertrain, vertical z: RMS in a band about each order.",
            order_figures.of_powertrains(report_data_list, names),
            [],
            2,
        ),
        Section(
            "Spectrograms",
            f"Powertrain, vertical z. {_LEVEL}",
            spectrogram_figures.of_powertrains(report_data_list, names),
            [],
            2,
        ),
        Section(
            "Histories",
            _about_histories(analyses, f"settling of {names[0]}"),
            comparison_figures.histories(report_data_list, names),
            [],
        ),
        Section(
            "Mounts",
            "Vertical, in the hull's axes: the second about the largest travel of each mount.",
            comparison_figures.mount_loops(report_data_list, names),
            [],
            2,
        ),
        Section("Current", "", comparison_figures.currents(report_data_list, names), []),
        Section(
            "Stamps",
            _STAMPS,
            [],
            [tables.timing(analysis, name) for analysis, name in zip(analyses, names, strict=True)],
        ),
    ]
    return _filled(sections)


def tiles(analysis):
    """Return the headline numbers: words, number, unit, remark."""
    chassis, powertrain = (analysis.sensors[sensor] for sensor in ("chassis", "powertrain"))
    found = [(f"powertrain {axis}, RMS", powertrain[axis].rms, chassis[axis].rms) for axis in reversed(AXES)]
    found.append(("powertrain z, weighted (Wk)", powertrain["z"].rms_weighted, chassis["z"].rms_weighted))
    tiles = [
        (words, tables.number(value, 3), "m/s²", f"{tables.change(value, first)} against the chassis")
        for words, value, first in found
    ]
    if isfinite(power := analysis.absorbed_power["chassis"]):
        tiles.append(("absorbed power, chassis z", tables.number(power, 3), "W", f"ride limit: {RIDE_LIMIT:g} W"))
    if analysis.mounts:
        energy = sum(mount.energy_dissipated for mount in analysis.mounts.values())
        power = sum(mount.power_dissipated for mount in analysis.mounts.values())
        remark = f"{tables.number(power, 3)} W on average"
        tiles.append(("dissipated in the mounts", tables.number(energy, 3), "J", remark))
    return tiles


def _about_histories(analyses, grey):
    """Return what the histories of some bags show, and what is grey there."""
    words = ["Specific force as recorded, +g along z at rest."]
    if any(timing.samples > MOST for analysis in analyses for timing in _of_sensors(analysis)):
        words.append("For long recordings the least and the greatest value of each part are drawn.")
    return " ".join([*words, f"Grey: {grey}."])


def _of_sensors(analysis):
    """Return the `Timing` of each of the two sensors that is there."""
    return [analysis.timing[end] for end in map(imu_topic, SENSORS) if end in analysis.timing]


def _filled(sections):
    """Return sections without the figures and tables that a bag has nothing for, and without empty ones."""
    kept = []
    for section in sections:
        figures = [figure for figure in section.figures if figure is not None]
        rows = [table for table in section.tables if table.rows]
        if figures or rows:
            kept.append(section._replace(figures=figures, tables=rows))
    return kept
