"""How the viewer is laid out: the vehicle from a camera that follows it, the curves beside it, one time for all."""

import rerun.blueprint as rrb

from ..vehicle.parameters import CHASSIS, POWERTRAIN
from .curves import ACCELERATION, CURRENT, FORCE, SPECTRUM
from .vehicle_log import FOLLOW, TIMELINE, WORLD

_BACKGROUND = (226, 232, 238)


def layout(has_coils, has_mounts, live=False):
    """Return the `rerun.blueprint.Blueprint`; a live one goes along with what comes."""
    eye = rrb.EyeControls3D(position=(3.6, 6.9, 2.5), look_target=(0.2, 0.0, 0.8), eye_up=(0.0, 0.0, 1.0))
    vehicle = rrb.Spatial3DView(
        origin=FOLLOW,
        contents=f"/{WORLD}/**",
        name="vehicle",
        background=_BACKGROUND,
        line_grid=False,
        eye_controls=eye,
    )
    curves = [_curves(ACCELERATION, "vertical acceleration, m/s²")]
    if has_coils:
        curves.append(_curves(CURRENT, "coil current, A"))
    if has_mounts:
        curves.append(_curves(FORCE, "mount force upwards, kN"))
    spectra = [
        rrb.BarChartView(origin=f"{SPECTRUM}/{name}", name=f"{name}, last second, m/s²/√Hz over Hz")
        for name in (CHASSIS, POWERTRAIN)
    ]
    play = {"play_state": "following"} if live else {"play_state": "playing", "loop_mode": "all"}
    return rrb.Blueprint(
        rrb.Horizontal(vehicle, rrb.Vertical(*curves, rrb.Horizontal(*spectra)), column_shares=[1.7, 1.0]),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, **play),
        auto_views=False,
        auto_layout=False,
    )


def _curves(path, name):
    return rrb.TimeSeriesView(origin=path, contents=f"/{path}/**", name=name)
