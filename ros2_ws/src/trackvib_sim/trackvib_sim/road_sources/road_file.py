"""Roads by name or file: what `--road` and the road node's parameter `road` take.

E                a class of ISO 8608
profile.csv      a profile (`csv_profile`)
surface.crg      an OpenCRG surface (`crg`)
a bag            the road of a recorded run
road.yaml        any of these with options, or a roughness of one's own, and obstacles on top:

ground: {class: C, seed: 3}                       or {level: 2.0e-4, waviness: 2.3, seed: 3}
                                                  or {file: profile.csv, start: 10, reverse: true, repeat: true}
obstacles:
  - {shape: half_round, at: 30, radius: 0.15, side: left}
"""

import os
from pathlib import Path
from typing import Annotated, Literal

from mr_mount_controller.node_base.plain_text import readable, shortened
from mr_mount_controller.node_base.suggestion import suggestion
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from ..road.classes import CLASSES
from ..road.iso8608 import (
    FADE,
    HIGHEST,
    LEVEL_UNTIL,
    LOWEST,
    SPACING,
    Exponential,
    Iso8608Road,
    Isotropic,
    Roughness,
    roughness_of,
)
from ..road.obstacles import FINE, LevelRoad, Obstacle, ObstacleRoad
from ..road.profile import COARSEST, FINEST, ProfileError, ProfileRoad
from ..yaml_text import YamlTextError, read_text, validated
from .crg import read_crg
from .csv_profile import read_csv_profile
from .recorded import read_recorded_road

MOST_OBSTACLES = 10_000
HIGHEST_RMS = 10.0  # m, of a random road; class H has 0.5
DEFAULT_START = 10.0  # m, at which a profile begins: before it the vehicle stands or rolls on level ground


class RoadError(ValueError):
    """A road that cannot be had; the message names file, item, value and what is accepted."""


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class RandomGround(_Part):
    """A random road: a class, or a roughness of one's own."""

    road_class: Annotated[Literal[tuple(CLASSES)] | None, Field(alias="class")] = None
    """Class of ISO 8608; or give level."""
    level: Annotated[float, Field(gt=0.0, le=1.0, allow_inf_nan=False, json_schema_extra={"unit": "m^3"})] | None = None
    """PSD at 0.1 1/m, Gd(n0); instead of a class."""
    waviness: Annotated[float, Field(ge=0.5, le=4.0)] = 2.0
    """Exponent w of the PSD."""
    lowest: Annotated[float, Field(ge=1e-4, le=100.0, json_schema_extra={"unit": "1/m"})] = LOWEST
    """Lowest spatial frequency of the road."""
    highest: Annotated[float, Field(ge=1e-4, le=100.0, json_schema_extra={"unit": "1/m"})] = HIGHEST
    """Highest spatial frequency of the road."""
    seed: Annotated[int, Field(ge=0, le=10**9)] = 1
    """Seed; the same one gives the same road."""
    level_until: Annotated[float, Field(ge=-1000.0, le=1e6, json_schema_extra={"unit": "m"})] = LEVEL_UNTIL
    """Distance up to which the road is level."""
    fade: Annotated[float, Field(ge=0.1, le=1000.0, json_schema_extra={"unit": "m"})] = FADE
    """Distance over which the roughness then grows to its full level."""
    coherence_length: Annotated[float, Field(ge=0.0, le=100.0, json_schema_extra={"unit": "m"})] | None = None
    """Length l of the coherence exp(-l n) of both tracks; of an isotropic surface where left out."""

    @model_validator(mode="after")
    def _one_of_both(self):
        if (self.road_class is None) == (self.level is None):
            raise ValueError("one of class and level must be given")
        own = {"waviness", "lowest", "highest"} & self.model_fields_set
        if self.road_class and own:
            raise ValueError(f"{', '.join(sorted(own))} is given with a class, accepted only with a level")
        if not self.lowest < self.highest:
            raise ValueError(f"lowest is {self.lowest:g} 1/m and highest {self.highest:g}, lowest must be below")
        if not self._roughness.rms <= HIGHEST_RMS:
            raise ValueError(f"its heights have an RMS value of {self._roughness.rms:.3g} m, accepted: {HIGHEST_RMS:g}")
        return self

    @property
    def _roughness(self):
        if self.road_class:
            return roughness_of(self.road_class)
        return Roughness(self.level, self.waviness, self.lowest, self.highest)

    def road(self, folder, tread, spacing):
        """Return the road."""
        spacing = spacing or SPACING
        if not self.highest * spacing <= 0.5:
            raise RoadError(
                f"spacing is {spacing:g} m, must be at most {0.5 / self.highest:.3g} m for waves up to "
                f"{self.highest:g} 1/m"
            )
        coherence = Isotropic(tread) if self.coherence_length is None else Exponential(self.coherence_length)
        return Iso8608Road(
            self.road_class or self._roughness, self.seed, self.level_until, self.fade, coherence, spacing
        )


class FileGround(_Part):
    """A profile or surface from a file, or the road of a bag."""

    file: Annotated[str, Field(min_length=1, max_length=1000)]
    """CSV, OpenCRG or bag, from the road file's folder."""
    start: Annotated[float, Field(ge=-1e6, le=1e6, json_schema_extra={"unit": "m"})] | None = None
    """Distance at which it begins; 10 m where left out, of a bag where it was."""
    reverse: bool = False
    """Whether it is driven from its end."""
    repeat: bool = False
    """Whether it is repeated without end."""

    def road(self, folder, tread, spacing):
        """Return the road."""
        if spacing is not None:
            raise RoadError(f"spacing is {spacing:g} m, but {self.file} has its own")
        return road_from_file(folder / self.file, tread, self.start, self.reverse, self.repeat)


def _kind_of_ground(ground):
    return "file" if isinstance(ground, dict) and "file" in ground else "random"


class RoadFile(_Part):
    """The whole file."""

    ground: (
        Annotated[
            Annotated[RandomGround, Tag("random")] | Annotated[FileGround, Tag("file")], Discriminator(_kind_of_ground)
        ]
        | None
    ) = None  # level
    """What lies under the obstacles; level where left out."""
    spacing: Annotated[float, Field(ge=FINEST, le=COARSEST, json_schema_extra={"unit": "m"})] | None = None
    """Distance between samples; 0.05 m of a random road, 0.01 m of a level one, where left out."""
    obstacles: Annotated[list[Obstacle], Field(max_length=MOST_OBSTACLES)] = []
    """Obstacles on the ground."""


def find_road(text, tread, seed=1):
    """Return the road given by the letter of a class or by a path.

    Parameters
    ----------
    text : str
    tread : float
        Distance between the tracks [m].
    seed : int
        Of a class.

    Raises
    ------
    RoadError
        It cannot be used.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.find_road("D", tread=2.8, seed=3).spacing  # m
    0.05
    """
    if text in CLASSES:
        return Iso8608Road(text, seed, coherence=Isotropic(tread))
    path = Path(text)
    if path.suffix.lower() in (".yaml", ".yml"):
        return _described(path, tread)
    return road_from_file(path, tread)


def road_in_words(text, composition=""):
    """Return what a road is called, as `find_road` takes it, and of a file what it consists of, where that is known."""
    if text in CLASSES:
        return f"class {text}"
    return f"road {Path(text).name}" + (f" ({composition})" if composition else "")


def whole_name(text):
    """Return the same road's name for a process in another folder: of a file its whole path."""
    return text if text in CLASSES else str(Path(text).absolute())


def road_from_file(path, tread, start=None, reverse=False, repeat=False):
    """Return the road in a CSV or OpenCRG file, or that of a bag, beginning at `start` [m].

    Where nothing is asked for, a file's begins at `DEFAULT_START` and a bag's lies where it was. Raises as `find_road`
    does.
    """
    suffix = path.suffix.lower()
    try:
        if suffix == ".csv":
            profile = read_csv_profile(path)
        elif suffix == ".crg":
            profile = read_crg(path, tread)
        elif os.path.exists(path):
            recorded = read_recorded_road(path)
            if start is None and not reverse and not repeat:
                return recorded
            profile = recorded.profile
        else:
            accepted = f"a class ({', '.join(CLASSES)}), .csv, .crg, .yaml or a bag"
            meant = suggestion(path.name, CLASSES)
            raise RoadError(f"road {shortened(str(path))!r} does not exist; accepted: {accepted}{meant}")
    except ProfileError as error:
        raise RoadError(str(error)) from None
    except OSError as error:
        raise RoadError(f"road {shortened(str(path))!r} cannot be read: {error.strerror or error}") from None
    return ProfileRoad(profile, DEFAULT_START if start is None else start, reverse, repeat)


def _described(path, tread):
    try:
        told = validated(RoadFile, read_text(path, "road file"), str(path), {"ground": 1, "obstacles": 2})
        if told.ground is None:
            ground = LevelRoad(told.spacing or FINE)
        else:
            ground = told.ground.road(path.parent, tread, told.spacing)
    except YamlTextError as error:
        raise RoadError(str(error)) from None
    except RoadError as error:
        raise RoadError(f"{readable(str(path))}: {error}") from None
    return ObstacleRoad(ground, tuple(told.obstacles)) if told.obstacles else ground
