"""The powertrain on its MR mounts as a linear model, for laws that are designed on one.

The hull heaves on its suspension; the powertrain turns about its rear hinge, with the mounts at its front. With the
heave z of the hull and the deflection d of the mounts (state z, d and their rates),

    [M + m    m r] [z'']   [K_s z + C_s z'                 ]   [w_road + w_engine    ]
    [             ] [   ] + [                               ] = [                     ]
    [m r       m_e] [d'']   [(K + n k) d + n c d'           ]   [r w_engine + u       ]

with M and m the masses of hull and powertrain, r the distance of the powertrain's centre of mass from the hinge over
that of the mounts, m_e its moment of inertia about the hinge over that distance squared, K the rubber of the hinge, k
and c of one of n mounts at a fixed current, and u what all of them do beyond that. Of a powertrain without such a hinge
r is 1 and m_e its mass. The hull's force reaches the powertrain through hinge and mounts alike, so that isolation by
the mounts alone has its limits. All numbers come from the description of the mounts.
"""

from typing import NamedTuple

import numpy as np

HEAVE, DEFLECTION, HEAVE_RATE, DEFLECTION_RATE = range(4)  # of the state


class MountModel(NamedTuple):
    """x' = A x + B u + G w,  y = C x + D u + F w."""

    a: np.ndarray  # (4, 4)
    b: np.ndarray  # (4, 1) of the force of all mounts beyond that of the fixed current, N
    g: np.ndarray  # (4, 2) of the forces of road and engine, N
    c: np.ndarray  # (2, 4) to the vertical accelerations of powertrain and hull at the mounts, m/s^2
    d: np.ndarray  # (2, 1)
    f: np.ndarray  # (2, 2)


def mount_model(current, mounting):
    """Return the `MountModel` of a `mounting.Mounting` about a current [A] in all its coils."""
    carried, curve, n = mounting.carried, mounting.curve, mounting.coils
    coupling = carried.powertrain_mass * carried.coupling
    mass = np.array([[carried.hull_mass + carried.powertrain_mass, coupling], [coupling, carried.mount_mass]])
    spring = np.diag([carried.suspension_stiffness, carried.other_stiffness + n * curve.stiffness(current)])
    damper = np.diag([carried.suspension_damping, n * curve.damping(current)])
    # of generalised accelerations, by state, force of the mounts, and disturbances
    by_state = -np.linalg.solve(mass, np.hstack((spring, damper)))
    by_force = np.linalg.solve(mass, np.array([[0.0], [1.0]]))
    by_disturbance = np.linalg.solve(mass, np.array([[1.0, 1.0], [0.0, carried.coupling]]))
    measured = np.array([[1.0, 1.0], [1.0, 0.0]])
    zeros = np.zeros
    return MountModel(
        a=np.vstack((np.hstack((zeros((2, 2)), np.eye(2))), by_state)),
        b=np.vstack((zeros((2, 1)), by_force)),
        g=np.vstack((zeros((2, 2)), by_disturbance)),
        c=measured @ by_state,
        d=measured @ by_force,
        f=measured @ by_disturbance,
    )
