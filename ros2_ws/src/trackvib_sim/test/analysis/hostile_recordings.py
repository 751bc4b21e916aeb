"""Recordings whose every text tries to become part of a page."""

from pathlib import Path

import numpy as np
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.report.report_data import build_report_data

from .made_recordings import made_recording

SCRIPT = "</script><script>window.injected = 1</script><img src=x onerror='window.injected = 1'>\"'{{ 7 * 7 }}"


def hostile_report_data(name="bag"):
    """Return the report_data of 4 s of a sine, of which every name and value that a bag can choose is hostile."""
    time = np.arange(1, 4001)
    wave = np.sin(2.0 * np.pi * 20.0 * time[:, None] / 1e3) * (1.0, 2.0, 3.0)
    recording = made_recording(time, wave + np.random.default_rng(5).normal(size=wave.shape))
    provenance = {
        **recording.provenance,
        "parameters of /controller": {"law": SCRIPT, SCRIPT: SCRIPT},
        f"parameters of /{SCRIPT}": {"law": SCRIPT},
        SCRIPT: {SCRIPT: SCRIPT},
    }
    counts = recording.counts
    counts[f"/{SCRIPT}"] = 3
    hostile = recording._replace(
        path=Path(f"{SCRIPT.replace('/', '')} {name}"),
        provenance=provenance,
        diagnostics={**recording.diagnostics, SCRIPT: SCRIPT, "state": SCRIPT},
        vehicle=f"{recording.vehicle}\n# {SCRIPT}\n",
    )
    return build_report_data(hostile, analyse(hostile))
