"""The rolling and the standing vehicle: how a run begins, the line of link passing, the tension of the tracks."""

import numpy as np
import pytest
from trackvib_sim.analysis.vibration import psd
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.simulation import Probe
from trackvib_sim.vehicle.system import new_work
from trackvib_sim.vehicle.tracks.nodes import TENSION
from trackvib_sim.vehicle.tracks.tracks import add_tracks
from trackvib_sim.rui.kinematics import update_motion

from .momentum import shoes

RATE = 1000.0  # Hz


def other_links(vehicle, links, pitch, teeth):
    """The vehicle with tracks of as much mass and elasticity a metre, of other links, and sprockets that suit them."""
    t, teeth_section = vehicle.tracks, vehicle.sprocket_teeth
    part = pitch / t.pitch
    tracks = t.model_copy(
        update={
            "links": float(links),
            "pitch": pitch,
            "shoe_mass": part * t.shoe_mass,
            "link_stiffness": t.link_stiffness / part,
            "link_damping": t.link_damping / part,
        }
    )
    return vehicle.model_copy(
        update={"tracks": tracks, "sprocket_teeth": teeth_section.model_copy(update={"teeth": float(teeth)})}
    )
