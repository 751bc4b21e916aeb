"""How a vehicle's mounts are described to controllers and bags."""

from mr_mount_controller.mounting import Kind, Mount, Mounting

from .body_tree import bodies_on_hinges
from .carried import carried_by_mounts, curve_of
from .mounts import mounts_in_order
from .parameters import POWERTRAIN
from .sensors import sensors_of

_KINDS = {"mr": Kind.MR, "rubber": Kind.RUBBER}


def mounting_of(vehicle):
    """Return the `Mounting` of a vehicle, mounts in the order of the simulation's sample."""
    bodies = bodies_on_hinges(vehicle)
    chassis, *_ = sensors_of(vehicle)
    mounts = [
        Mount(
            name,
            _KINDS[vehicle.mount_types[mount.type].kind],
            tuple(a + b - c for a, b, c in zip(bodies[mount.body].place, mount.place, chassis.place, strict=True)),
        )
        for name, mount in mounts_in_order(vehicle)
    ]
    return Mounting(tuple(mounts), _turning(bodies[POWERTRAIN]), carried_by_mounts(vehicle), curve_of(vehicle))


def _turning(powertrain):
    """About which axes the powertrain can turn against its parent."""
    if powertrain.hinge == "revolute":
        return tuple(map(bool, powertrain.axis))
    return (powertrain.hinge in ("free", "elastic"),) * 3
