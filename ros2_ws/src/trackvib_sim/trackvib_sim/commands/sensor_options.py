"""The options that tell which sensors a recording has, how they sit, by which clock and in which unit they measured.

Shared by all verbs that read recordings of others.
"""

from functools import wraps
from math import isfinite

import click

from ..bags.sources import BY_MEAN, GRAVITIES, SourceError, Sources
from .option_types import Known

_OPTIONS = (
    click.option("--chassis", metavar="TOPIC", help="Topic or CSV file of the chassis sensor.  [default: chassis/imu]"),
    click.option(
        "--powertrain", metavar="TOPIC", help="Topic or CSV file of the powertrain sensor.  [default: powertrain/imu]"
    ),
    click.option(
        "--sensor",
        "further",
        metavar="NAME=TOPIC",
        multiple=True,
        help="Another sensor; may be repeated. Topics are of type Imu, AccelStamped or Vector3Stamped.  "
        "[default: none]",
    ),
    click.option(
        "--rotate",
        metavar="[NAME=]R,P,Y",
        multiple=True,
        help="Roll, pitch and yaw in degrees of a sensor relative to the vehicle (x forward, y left, z up), or of "
        "all sensors that are not named.  [default: from the bag's /tf_static]",
    ),
    click.option(
        "--gravity",
        type=Known(GRAVITIES),
        default=BY_MEAN,
        show_default=True,
        help="Remove gravity as the mean, or by the orientation in the Imu messages.",
    ),
    click.option(
        "--csv",
        "csv_columns",
        metavar="COLUMN=NAME,...",
        default="",
        help="Column names of a CSV file, with their units: time_s=t,x_g=ax,y_g=ay,z_g=az.  "
        "[default: time_s,x_m/s2,...]",
    ),
    click.option(
        "--time",
        type=Known(("header", "log")),
        default="header",
        show_default=True,
        help="Time base: the stamps in the message headers, or the times at which the messages were recorded.",
    ),
    click.option(
        "--unit",
        type=Known(("m/s2", "g")),
        default="m/s2",
        show_default=True,
        help="Unit of the recorded accelerations.",
    ),
)


def sensor_options(command):
    """Give a command the options above; it gets `time`, `unit`, and a `bags.sources.Sources` as `sources`."""

    @wraps(command)
    def with_sources(*, chassis, powertrain, further, rotate, gravity, csv_columns, **others):
        try:
            sources = _sources(chassis, powertrain, further, rotate, gravity, csv_columns)
        except SourceError as error:
            raise click.UsageError(str(error)) from None
        return command(sources=sources, **others)

    for option in reversed(_OPTIONS):
        with_sources = option(with_sources)
    return with_sources


def _sources(chassis, powertrain, further, rotate, gravity, csv_columns):
    named = {name: topic for name, topic in (("chassis", chassis), ("powertrain", powertrain)) if topic is not None}
    for word in further:
        name, equals, topic = word.partition("=")
        if not (equals and topic and name.isidentifier()):
            raise SourceError(
                f"--sensor is {word!r}, accepted: NAME=TOPIC, where NAME consists of letters, digits and _"
            )
        if name in named:
            raise SourceError(f"--sensor: {name!r} is given twice, must be given once")
        named[name] = topic
    rotations = dict(map(_rotation, rotate))
    if len(rotations) < len(rotate):
        raise SourceError("--rotate is given twice for the same sensor, must be given once")
    columns = {}
    for word in filter(None, csv_columns.split(",")):
        column, equals, name = word.partition("=")
        if not (equals and column.strip() and name.strip()):
            raise SourceError(f"--csv has {word!r}, accepted: COLUMN_UNIT=NAME, separated by commas, like time_s=t")
        columns[column.strip().lower()] = name.strip()
    return Sources(named, rotations, gravity, columns)


def _rotation(word):
    name, _, told = word.rpartition("=")
    try:
        angles = tuple(float(each) for each in told.split(","))
    except ValueError:
        angles = ()
    if len(angles) != 3 or not all(map(isfinite, angles)):
        raise SourceError(f"--rotate is {word!r}, accepted: ROLL,PITCH,YAW in degrees, like 0,0,90, or NAME=0,0,90")
    return name, angles
