"""All that `analyze` says of a bag, as plain data. Each number carries its unit; `docs/bags.md` defines each.

Sensors are "chassis" and "powertrain", and those further ones of the bag where nothing else is said; axes are "x"
(forward), "y" (left) and "z" (up); mounts have the names that the bag tells, "left" and "right" of one that tells none.
A number that cannot be had is nan, as the current of a mount without a coil, and the notes of the `Analysis` say why.
"""

from dataclasses import dataclass, field

import numpy as np

AXES = ("x", "y", "z")
SENSORS = ("chassis", "powertrain")
INTERVAL = 50.0  # m of way, by which numbers are given
SPEED_BAND = 2.0  # m/s, likewise
STEADY = 0.05  # of its frequency, by which a line may move and still be one


def number(unit):
    """Return the field of a number with its unit."""
    return field(metadata={"unit": unit})


@dataclass(frozen=True)
class AxisNumbers:
    """One sensor along one axis over the measured time."""

    mean: float = number("m/s²")  # of the specific force as recorded; +g on z at rest
    rms_raw: float = number("m/s²")  # about that mean
    rms: float = number("m/s²")  # band-limited
    peak: float = number("m/s²")  # greatest absolute value, band-limited
    rms_weighted: float = number("m/s²")  # ISO 2631-1, Wd along x and y, Wk along z
    crest_factor: float = number("-")  # greatest absolute weighted value over rms_weighted
    mtvv: float = number("m/s²")  # greatest running RMS of the weighted values over 1 s
    vdv: float = number("m/s^1.75")  # fourth-power vibration dose value of the weighted ones


@dataclass(frozen=True)
class MotionSickness:
    """What the slow vertical motion of one sensor does to people, ISO 2631-1 with Wf."""

    rms: float = number("m/s²")  # weighted
    msdv: float = number("m/s^1.5")  # motion sickness dose value: root of the integral of the square over the time
    measured: float = number("s")  # time that counts


@dataclass(frozen=True)
class Line:
    """A line of the spectrum with a known cause, and what lies in a band around it."""

    name: str  # "link passing 1", "engine order 2"
    frequency: float = number("Hz")  # at the mean speed
    lowest: float = number("Hz")  # over the speeds driven
    highest: float = number("Hz")
    low: float = number("Hz")  # of the band
    high: float = number("Hz")
    rms: dict = number("m/s²")  # sensor -> axis -> RMS in the band

    @property
    def sweeps(self):
        """Whether it moved with a speed that varied, so that no single frequency stands for it."""
        return self.highest - self.lowest > STEADY * self.frequency

    @property
    def hertz(self):
        """Its frequency in words, or the range over which it moved."""
        return f"{self.lowest:.1f} to {self.highest:.1f}" if self.sweeps else f"{self.frequency:.1f}"


@dataclass(frozen=True)
class Part:
    """A part of the measured time, between two values of something, and what was measured in it."""

    low: float
    high: float
    measured: float = number("s")  # time that counts
    speed: float = number("m/s")  # mean
    engine_speed: float = number("r/min")  # mean; nan if it was not recorded
    rms: dict = number("m/s²")  # sensor -> axis -> band-limited RMS
    rms_weighted: dict = number("m/s²")  # sensor -> axis, ISO 2631-1
    absorbed_power: dict = number("W")  # sensor -> of the vertical


@dataclass(frozen=True)
class WayInterval(Part):
    """The time in which the hull was in an interval of its way."""

    low: float = number("m")  # distance where it begins
    high: float = number("m")


@dataclass(frozen=True)
class SpeedBand(Part):
    """The time in which the hull's speed, averaged over 1 s, was in a band."""

    low: float = number("m/s")
    high: float = number("m/s")


@dataclass(frozen=True)
class OrderLevel:
    """One order of the engine while it turned at one speed."""

    engine_speed: float = number("r/min")  # middle of a band
    order: float = number("1/revolution")
    windows: int = number("-")  # of revolutions, over which this is the mean
    rms: dict = number("m/s²")  # sensor -> axis -> RMS in a band about the order


@dataclass(frozen=True)
class OrderSpectra:
    """Spectra over the engine's revolutions instead of time, in bands of its speed; nan where it never turned so."""

    engine_speed: np.ndarray = number("r/min")  # (n,) middles
    order: np.ndarray = number("1/revolution")  # (f,)
    windows: np.ndarray = number("-")  # (n,) how many the means are of
    psd: dict = number("(m/s²)²/order")  # sensor -> (n, f, 3), one-sided


@dataclass(frozen=True)
class Campbell:
    """Spectra of the vertical in bands of a speed; nan where there was none."""

    over: str  # "engine speed" or "speed", of the hull
    unit: str  # of it
    value: np.ndarray  # (n,) middles of its bands
    frequency: np.ndarray = number("Hz")  # (f,)
    psd: dict = number("(m/s²)²/Hz")  # sensor -> (n, f), one-sided
    rays: tuple  # of `Ray`s


@dataclass(frozen=True)
class Ray:
    """Where a line of the spectrum with a known cause lies in a Campbell diagram: frequency over speed."""

    name: str  # as of a `Line`, and the gear if it depends on it
    ends: tuple  # two pairs of speed and frequency [Hz]


@dataclass(frozen=True)
class Current:
    """Current of one coil over the measured time."""

    mean: float = number("A")
    rms: float = number("A")
    least: float = number("A")
    greatest: float = number("A")
    slew: float = number("A/s")  # greatest absolute change from sample to sample, over their distance in time


@dataclass(frozen=True)
class MountAxis:
    """One mount along one axis of the hull; travel is deflection less its mean, upper end against lower."""

    deflection_mean: float = number("m")  # from the unloaded place
    travel_rms: float = number("m")
    travel_peak: float = number("m")  # greatest distance from the mean
    force_mean: float = number("N")  # on the powertrain
    force_rms: float = number("N")  # about the mean
    force_peak: float = number("N")  # greatest distance from the mean


@dataclass(frozen=True)
class MountNumbers:
    """One mount over the measured time."""

    axes: dict  # axis -> MountAxis
    current: Current  # in the coil
    energy_dissipated: float = number("J")  # by its damping
    power_dissipated: float = number("W")  # mean


@dataclass(frozen=True)
class Spectra:
    """Means over the measured time by Welch's method: windows of 1 s, Hann, half overlapping."""

    frequency: np.ndarray = number("Hz")  # (f,)
    psd: dict = number("(m/s²)²/Hz")  # sensor -> (f, 3), one-sided
    coherence: np.ndarray = number("-")  # (f, 3) of chassis and powertrain, axis by axis
    transmissibility: np.ndarray = number("-")  # (f, 3) from chassis to powertrain, |H1|


@dataclass(frozen=True)
class History:
    """Levels along the whole bag, settling included, in bins of equal length; nan where there is nothing."""

    time: np.ndarray = number("s")  # (n,) middle of each bin, from the start of the bag
    rms: dict = number("m/s²")  # sensor -> (n, 3) band-limited
    rms_weighted: dict = number("m/s²")  # sensor -> (n, 3)
    absorbed_power: dict = number("W")  # sensor -> (n,) mean, of the vertical
    speed: np.ndarray = number("m/s")  # (n,) mean
    current: np.ndarray = number("A")  # (n, coils) mean in the coils
    power_dissipated: np.ndarray = number("W")  # (n, mounts) mean
    travel: np.ndarray = number("m")  # (n, mounts) RMS of the vertical travel about its mean over the bin
    mounts: tuple  # names, of the coils the first ones


@dataclass(frozen=True)
class Analysis:
    """The numbers of a bag. "From the start" means from one period before its first sample, 0 of a whole run.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> analysis = tv.analyse(tv.read_recording(bag))
    >>> analysis.rate, analysis.band  # Hz
    (1000.0, (0.5, 500.0))
    """

    bag: str  # path as it was given
    begin: int = number("ns")  # stamp of the start
    duration: float = number("s")  # from the start to the last sample of both sensors
    settle: float = number("s")  # of the start that does not count
    measured: float = number("s")  # time that counts
    rate: float = number("Hz")  # of both sensors, the slower one's where they differ
    rates: dict = number("Hz")  # sensor -> its own rate
    origins: dict  # sensor -> where its samples come from and what was done to them, in words
    band: tuple = number("Hz")  # low and high end of "band-limited"
    speed: float = number("m/s")  # mean forward speed of the hull
    speed_deviation: float = number("m/s")  # its standard deviation
    engine_speed: float = number("r/min")  # mean as recorded, else as the simulator was told
    engine_speed_deviation: float = number("r/min")  # its standard deviation, 0 where it was only told
    speed_range: tuple = number("m/s")  # least and greatest speed, averaged over 1 s
    engine_speed_range: tuple = number("r/min")  # least and greatest engine speed
    drive_force: float = number("N")  # work of the drive a metre: the running resistance where speed is steady
    drive_power: float = number("W")  # work of the drive a second; both from the start, as the simulator told them
    sensors: dict  # sensor -> axis -> AxisNumbers
    total_weighted: dict = number("m/s²")  # sensor -> root of the sum of the three rms_weighted squared
    absorbed_power: dict = number("W")  # sensor -> mean, of the vertical
    motion_sickness: dict  # sensor -> MotionSickness; those left out that were measured too short
    lines: tuple  # `Line`s, link passing first
    by_way: tuple  # `WayInterval`s in which anything was measured; empty if the bag does not tell the way
    by_speed: tuple  # `SpeedBand`s, likewise
    order_levels: tuple  # `OrderLevel`s; empty where the engine's recorded speed does not vary
    order_spectra: OrderSpectra | None  # likewise
    campbell: tuple  # `Campbell`s over the speeds that vary
    mounts: dict  # mount -> MountNumbers; empty without mount states
    demand: dict  # coil, called as its mount -> Current that the controller asked for; empty without answers
    mount_energy: dict | None = number("J")  # the simulator's own account of the whole run, if it told one
    loop: dict  # what was lost (None where the bag cannot tell), and what the simulator told last
    messages: dict  # topic -> count
    timing: dict  # end of topic -> Timing
    clocks: dict  # end of topic -> Clock, of sensors whose stamps were not even
    spectra: Spectra
    history: History
    notes: tuple  # sentences: what was found wrong, what could not be had and why
