"""What is wrong with a recording, in sentences."""

import numpy as np
from mr_mount_controller.node_base import topics

from .iso2631 import LEAST_RATE, REACH
from .stamps import BLOCK, blocks

_NEARLY = 1e-3  # relative, by which a rate may miss what it is meant to be
_WITHOUT = {  # what cannot be had of a bag without these topics
    topics.MOUNT_STATE: "no numbers of the mounts",
    topics.COIL_CURRENT: "no demanded currents, so it is unknown which samples were answered",
}


def find_notes(recording, segments):
    """Return what was found wrong with a recording and its `Segments`, and what cannot be had of it."""
    notes = []
    if not recording.complete:
        notes.append("the bag was cut short; its readable part is used (`trackvib bag repair` repairs it)")
    odd = {end: _not_finite(columns) for end, columns in recording.streams.items()}
    for end, found in segments.timing.items():
        missing = "1 sample is" if found.missing == 1 else f"{found.missing} samples are"
        counts = {
            f"gaps: {found.gap_count}, in which {missing} missing": found.gap_count,
            f"samples within half a period of the one before: {found.repeated}": found.repeated,
            f"samples older than the one before: {found.backward}": found.backward,
            f"samples that are not finite: {odd[end]}": odd[end]
            % found.samples,  # of a sensor that measured nothing all
        }
        notes += [f"{end}: {text}" for text, count in counts.items() if count]
    return notes + [
        f"no {end} in the recording: {what}" for end, what in _WITHOUT.items() if end not in recording.streams
    ]


def rate_notes(rates):
    """Say what of the weighted values the rates of sensors [Hz], by name, cannot hold."""
    notes = []
    for rate in sorted(set(rates.values())):
        names = ", ".join(name for name, each in rates.items() if each == rate)
        if rate < LEAST_RATE:
            notes.append(
                f"{names}: sampling rate is {rate:.6g} Hz, below {LEAST_RATE:g} Hz: no weighted values of ISO 2631-1"
            )
        elif rate < 2.0 * REACH * (1.0 - _NEARLY):
            notes.append(
                f"{names}: sampling rate is {rate:.6g} Hz, so that weighted values hold what is below {0.5 * rate:.4g} "
                f"Hz; Wk and Wd of ISO 2631-1 reach {REACH:g} Hz"
            )
    return notes


def _not_finite(columns):
    """Count the samples of some columns, the stamps first, with a value that is not finite."""
    count = 0
    others = ("logged", "covariance")
    named = zip(columns._fields[1:], columns[1:], strict=True)
    measured = [column for name, column in named if name not in others and column is not None]
    for block in blocks(len(columns[0]), BLOCK):
        parts = (column[block].reshape(len(column[block]), -1) for column in measured)
        count += int(np.count_nonzero(~np.logical_and.reduce([np.isfinite(part).all(axis=1) for part in parts])))
    return count
