"""What the numbers of a report mean: each word of the page, with standard, clause and equation."""

from ..absorbed_power import RIDE_LIMIT
from ..lines import HARMONICS
from .sections import Section
from .tables import Table

_ISO = "ISO 2631-1:1997"
_ROWS = (
    ("RMS, band-limited", "root mean square of the acceleration from 0.5 Hz to half the sampling rate", ""),
    ("RMS, raw, about the mean", "root mean square of the acceleration as recorded, without its mean", ""),
    ("peak, band-limited", "greatest absolute value of the same acceleration as the band-limited RMS", ""),
    ("mean", "mean of the specific force as recorded; 9.81 m/s² along z of a level sensor at rest", ""),
    ("weighted, Wk, Wd", "filtered by how strongly a seated person feels each frequency; Wk along z, Wd along x and y",
     f"{_ISO}, 6.4, annex A"),
    ("RMS, weighted", "a_w = (1/T ∫ a_w(t)² dt)^½, the root mean square of the weighted acceleration",
     f"{_ISO}, 6.1, (1)"),
    ("crest factor", "greatest absolute weighted value over the weighted RMS; above 9 MTVV and VDV count as well",
     f"{_ISO}, 6.2"),
    ("MTVV", "maximum transient vibration value: the greatest weighted RMS over any 1 s",
     f"{_ISO}, 6.3.1, (2) and (4)"),
    ("VDV", "vibration dose value: (∫ a_w(t)⁴ dt)^¼; it stresses shocks and grows with the time",
     f"{_ISO}, 6.3.2, (5)"),
    ("all axes", "root of the sum of the squares of the three weighted RMS values", f"{_ISO}, 6.5"),
    ("absorbed power", f"mean power that a driver sitting there would absorb from z; usual ride limit {RIDE_LIMIT:g} W",
     "Pradko, Lee and Kaluza, 1966"),
    ("PSD", "power spectral density: how the mean square of an acceleration is spread over frequency",
     "Welch's method, Hann windows of 1 s"),
    ("transmissibility, |H1|", "amplitude at the powertrain over that at the chassis, of what is coherent", ""),
    ("coherence", "share of the powertrain's motion that goes linearly with the chassis; 1 is all, 0 none", ""),
    ("link passing, v/p", "links enter the sprocket v/p times a second: speed over the pitch of the track; with "
     f"multiples up to {HARMONICS} v/p", ""),
    ("engine order m", "m times the revolutions of the crankshaft per second", ""),
    ("Campbell diagram", "spectra by speed: what follows the speed rises from left to right, resonances are level", ""),
    ("travel, deflection", "deflection of a mount from its unloaded length; travel is deflection about its mean", ""),
    ("settling", "time from the start that does not count", ""),
)  # fmt: skip


def definitions():
    """Return the `Section` that stands at the end of every report."""
    words = "People are exposed at seats; at the ends of the mounts these values serve to compare runs."
    return Section("What the numbers mean", words, [], [Table(("number", "meaning", "source"), list(_ROWS), 3)])
