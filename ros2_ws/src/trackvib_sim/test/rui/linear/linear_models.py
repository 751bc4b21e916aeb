"""Models that the tests of the linear analysis share."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.linear.equilibrium import find_equilibrium
from trackvib_sim.rui.linear.model import GroundSpring, LinearModel, Mount
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.state import free_bodies, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

from .linear_reference import Dense


def mount_values(current):
    """Stiffness [N/m], damping [N s/m] of one magnetorheological mount at a coil current [A], fit of [Tao2025]."""
    k = 1e6 * np.polyval([0.0412, -0.581, 2.8317, 0.904], current)
    return k, 2.0 * np.polyval([0.0121, -0.1567, 0.6526, -0.3573], current) * np.sqrt(k * 1000.0)


def planar_vehicle():
    """Hull on two springs with a hinged powertrain on a mount, in the x-y plane without gravity."""
    table = [
        Body(1, "hull", 30000.0, (0, 0, 0), np.diag([9e4, 9e4, 9e4])),
        Body(2, "powertrain", 4000.0, (1.0, 0, 0), np.diag([1500.0] * 3), Hinge(1, "revolute", "hull", (-1.5, 0, 0))),
    ]
    return LinearModel(
        table,
        rest_state(table),
        (0.0, 0.0, 0.0),
        stiffness=[0.0, 2e5],
        springs=tuple(GroundSpring("hull", (x, 0, 0), np.diag([0, 1.2e6, 0])) for x in (2.0, -2.0)),
        mounts=(Mount("powertrain", (2.0, 0, 0), np.diag([0, 2.0 * mount_values(2.0)[0], 0])),),
    )


def _disk(mass, radius, width):
    across = mass * (3.0 * radius**2 + width**2) / 12.0
    return np.diag([across, across, mass * radius**2 / 2.0])


def illustrative_vehicle():
    """Tracked vehicle of 41 bodies, y up, springs at the zero place of its wheels: not yet in equilibrium."""
    hull_inertia = np.array([[24000.0, -800, 0], [-800, 90000, 0], [0, 0, 85000]])
    turret_inertia = np.array([[8500.0, 400, 0], [400, 15000, 0], [0, 0, 11000]])
    engine_inertia = 4000.0 / 12.0 * np.diag([0.9**2 + 1.6**2, 2**2 + 1.6**2, 2**2 + 0.9**2])
    table = [
        Body(7, "hull", 20000.0, (-0.10, 1.05, 0), hull_inertia),
        Body(5, "turret", 9000.0, (-0.15, 0.35, 0), turret_inertia,
             Hinge(6, "revolute", "hull", (0.20, 1.75, 0), (0, 1, 0))),
        Body(3, "mantlet", 1500.0, (0.25, 0, 0), np.diag([90.0, 420, 420]),
             Hinge(4, "revolute", "turret", (0.90, 0.35, 0))),
        Body(1, "recoil part", 1800.0, (1.2, 0, 0), np.diag([40.0, 3600, 3600]),
             Hinge(2, "prismatic", "mantlet", (0.10, 0, 0), (1, 0, 0))),
        Body(9, "powertrain", 4000.0, (1.0, 0.10, 0), engine_inertia, Hinge(8, "revolute", "hull", (-3.0, 1.05, 0))),
    ]  # fmt: skip
    stiffness = [0.0, 4e7, 2e7, 6e6, 2e5]
    damping = [0.0, 2e4, 1e4, 5e3, 1.5e3]
    springs = []

    def add(name, mass, centre, inertia, parent, place, k=0.0, c=0.0):
        number = 10 + len(table)
        table.append(Body(number, name, mass, centre, inertia, Hinge(number, "revolute", parent, place)))
        stiffness.append(k)
        damping.append(c)

    for side, name in ((-1.0, "left"), (1.0, "right")):
        add(f"sprocket {name}", 250.0, (0, 0, 0), _disk(250.0, 0.31, 0.4), "hull", (-3.05, 0.92, side * 1.40))
        add(f"idler {name}", 180.0, (0, 0, 0), _disk(180.0, 0.28, 0.3), "hull", (2.95, 0.86, side * 1.40))
        for k, x in enumerate((1.8, 0.6, -0.6, -1.8), start=1):
            add(f"roller {name} {k}", 30.0, (0, 0, 0), _disk(30.0, 0.14, 0.2), "hull", (x, 1.05, side * 1.40))
        for k, x in enumerate((2.10, 1.26, 0.42, -0.42, -1.26, -2.10), start=1):
            arm, wheel = f"arm {name} {k}", f"wheel {name} {k}"
            add(arm, 90.0, (-0.17, -0.11, side * 0.05), np.diag([1.6, 2.2, 2.4]), "hull",
                (x + 0.33, 0.645, side * 1.10), 5.5e4, 3e3)  # fmt: skip
            add(wheel, 200.0, (0, 0, 0), _disk(200.0, 0.33, 0.35), arm, (-0.33, -0.225, side * 0.30))
            place = np.array([x, 0.42, side * 1.40])
            springs.append(
                GroundSpring(wheel, (0, 0, 0), np.diag([3e5, 2e6, 3e5]), np.diag([2e3, 1.2e4, 2e3]), place=place)
            )
    k, c = mount_values(2.0)
    mount = Mount(
        "powertrain",
        (2.0, -0.15, 0),
        2.0 * k * np.diag([0.8, 1.0, 0.6]),
        2.0 * c * np.diag([0.5, 1.0, 0.5]),
        place=(-1.0, 0.9, 0),
    )
    n = len(table)
    return LinearModel(
        table, rest_state(table), (0.0, -9.81, 0.0), stiffness, damping, np.zeros(n), tuple(springs), (mount,)
    )


def random_model(seed, kinds=("revolute", "revolute", "prismatic", "locked", "elastic"), even=True):
    """A random tree of 2 to 8 bodies in equilibrium: random pose, loads, springs, dampers, one hinge prescribed.

    Forces and torques that hold the pose are put on as constant loads, which keeps large static wrenches everywhere.
    `even`: elastic hinges have the same stiffness about all axes, without which their moments have no potential.
    """
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    table, prescribed = [], int(rng.integers(1, 2 * n))
    for row in range(n):
        hinge = None
        if row:
            kind = kinds[rng.integers(len(kinds))]
            bush = {}
            if kind == "elastic":
                turning = np.full(3, rng.uniform(2e3, 2e4)) if even else rng.uniform(2e3, 2e4, 3)
                bush = {"stiffness": np.r_[rng.uniform(2e3, 2e4, 3), turning], "damping": rng.uniform(0, 50, 6)}
            fixed = row == prescribed and kind in ("revolute", "prismatic")
            hinge = Hinge(row, kind, f"b{rng.integers(row)}", rng.normal(0, 0.5, 3), rng.normal(size=3), fixed, **bush)
        size = rng.uniform(0.1, 0.5, 3)
        mass = rng.uniform(1.0, 20.0)
        inertia = mass / 12.0 * np.diag(np.sum(size**2) - size**2)
        turn = Rotation.random(rng=rng).as_matrix()
        table.append(Body(row, f"b{row}", mass, rng.normal(0, 0.2, 3), turn @ inertia @ turn.T, hinge))
    state = rest_state(table)
    hinge = np.array([0.0 if b.hinge is None or b.hinge.kind in ("locked", "elastic") else 1.0 for b in table])
    state = state._replace(hinge=hinge * rng.normal(0, 0.6, n), position=rng.normal(0, 1.0, state.position.shape))
    state = state._replace(attitude=Rotation.random(len(state.position), rng=rng).as_quat(scalar_first=True))
    state = _near_parents(table, state, rng)

    def positive(scale, size=3):
        root = rng.normal(size=(size, size))
        return scale * (root @ root.T + 0.2 * np.eye(size))

    springs = [GroundSpring("b0", rng.normal(0, 0.5, 3), positive(3e3), positive(20.0), rng.normal(0, 50, 3))]
    springs.append(GroundSpring("b0", rng.normal(0, 0.5, 3), positive(3e3, 6), positive(20.0, 6), rng.normal(0, 50, 3)))
    springs.append(GroundSpring(f"b{n - 1}", rng.normal(0, 0.5, 3), positive(2e3), positive(9.0), rng.normal(0, 50, 3)))
    mounted = rng.choice(np.arange(1, n), size=min(2, n - 1), replace=False)
    mounts = [
        Mount(f"b{row}", rng.normal(0, 0.3, 3), positive(2e3), positive(9.0), rng.normal(0, 40, 3)) for row in mounted
    ]
    moves = np.array([b.hinge is not None and b.hinge.kind in ("revolute", "prismatic") for b in table])
    model = LinearModel(
        table, state, rng.normal(0, 9.81, 3), moves * rng.uniform(100, 3e3, n), moves * rng.uniform(0, 9, n),
        springs=tuple(springs), mounts=tuple(mounts),
    )  # fmt: skip
    return _held(model)


def _near_parents(table, state, rng):
    """Put every body behind an elastic hinge near its undeformed place."""
    for k, row in enumerate(free_bodies(table)):
        if row == 0:
            continue
        where = place_bodies(table, state)
        parent = next(p for p, body in enumerate(table) if body.name == table[row].hinge.parent)
        turn = Rotation.from_rotvec(rng.normal(0, 0.2, 3)).as_matrix()
        state.position[k] = where.hinge_point[row] + rng.normal(0, 0.05, 3)
        state.attitude[k] = Rotation.from_matrix(where.rotation[parent] @ turn).as_quat(scalar_first=True)
    return state


def _held(model):
    """Return the model with constant torques on hinges and constant forces on free bodies that make it rest.

    Forces on three points of a body rather than a force and a moment: a constant moment would have no potential.
    """
    dense, torque, springs = Dense(model), np.zeros(len(model.bodies)), list(model.springs)
    where = place_bodies(model.bodies, model.state)
    points = 0.5 * np.eye(3)
    for k, row in enumerate(dense.free):
        arms = [where.rotation[row] @ point for point in points]
        moments = np.hstack([np.cross(arm, np.eye(3)).T for arm in arms])
        forces = np.linalg.lstsq(np.vstack((np.tile(np.eye(3), 3), moments)), -dense.load[6 * k : 6 * k + 6])[0]
        for point, force in zip(points, forces.reshape(3, 3), strict=True):
            springs.append(GroundSpring(model.bodies[row].name, point, force=force))
    for k, row in enumerate(dense.hinges):
        torque[row] = -dense.load[6 * len(dense.free) + k]
    return replace(model, springs=tuple(springs), loads=model.loads._replace(torque=torque))


def settled_vehicle():
    """The illustrative vehicle in equilibrium."""
    return find_equilibrium(illustrative_vehicle())


def pendulum(count=1, angle=0.0, damping=0.0):
    """Equal pendulums (2 kg, 0.5 m, 0.1 kg m^2) on one held root, `angle` from hanging down, with the torque for it."""
    table = [Body(0, "root", 10.0, (0, 0, 0), np.eye(3))]
    for k in range(count):
        hinge = Hinge(k + 1, "revolute", "root", (k, 0, 0), (0, 1, 0))
        table.append(Body(k + 1, f"p{k}", 2.0, (0, 0, -0.5), 0.1 * np.eye(3), hinge))
    moves = np.r_[0.0, np.ones(count)]
    loads = no_loads(table)._replace(torque=moves * 2.0 * 9.81 * 0.5 * np.sin(angle))
    return LinearModel(
        table, rest_state(table)._replace(hinge=moves * angle), damping=moves * damping, loads=loads, fixed_root=True
    )
