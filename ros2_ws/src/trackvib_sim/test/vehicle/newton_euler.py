"""Newton and Euler for a tree of bodies, written out in plain numpy: what the sweeps are judged by."""

from types import SimpleNamespace

import numpy as np
from scipy.spatial.transform import Rotation

G = (0.0, 0.0, -9.81)


def newton_euler(bodies, state, found):
    """Motion of every centre of mass and the rates of momentum, from coordinates and the sweeps' accelerations.

    Of what was found only the root's and the hinges' accelerations are used.
    """
    n, names = len(bodies), {body.name: row for row, body in enumerate(bodies)}
    turn, place, v, om, a, al, hinge, axis = (np.zeros((n, *s)) for s in ((3, 3), *((3,),) * 7))
    turn[0] = Rotation.from_quat(state.attitude[0], scalar_first=True).as_matrix()
    place[0] = hinge[0] = state.position[0]
    v[0], om[0], a[0], al[0] = state.velocity[0], state.angular_velocity[0], found.linear[0], found.angular[0]
    for b in range(1, n):
        joint = bodies[b].hinge
        p, th, thd, thdd = names[joint.parent], state.hinge[b], state.hinge_rate[b], found.hinge[b]
        axis[b] = e = turn[p] @ joint.axis
        hinge[b] = place[b] = place[p] + turn[p] @ joint.place
        turn[b], om[b], al[b] = turn[p], om[p], al[p]
        if joint.kind == "prismatic":
            place[b] = hinge[b] + e * th
        else:
            turn[b] = turn[p] @ Rotation.from_rotvec(np.array(joint.axis) * th).as_matrix()
            om[b] = om[p] + e * thd
            al[b] = al[p] + e * thdd + np.cross(om[p], e) * thd
        arm = place[b] - place[p]
        v[b] = v[p] + np.cross(om[p], arm)
        a[b] = a[p] + np.cross(al[p], arm) + np.cross(om[p], np.cross(om[p], arm))
        if joint.kind == "prismatic":
            v[b] += e * thd
            a[b] += e * thdd + 2.0 * np.cross(om[p], e) * thd
    mass = np.array([[body.mass] for body in bodies])
    arm = np.einsum("nij,nj->ni", turn, [body.centre for body in bodies])
    inertia = np.einsum("nij,njk,nlk->nil", turn, [body.inertia for body in bodies], turn)
    spin = np.einsum("nij,nj->ni", inertia, om)
    return SimpleNamespace(
        parent=[-1] + [names[body.hinge.parent] for body in bodies[1:]],
        prismatic=np.array([body.hinge is not None and body.hinge.kind == "prismatic" for body in bodies]),
        mass=mass,
        origin=place,
        hinge=hinge,
        axis=axis,
        a=a,
        al=al,
        c=place + arm,
        v=v + np.cross(om, arm),
        om=om,
        spin=spin,
        rate_of_momentum=mass * (a + np.cross(al, arm) + np.cross(om, np.cross(om, arm))),
        rate_of_spin=np.einsum("nij,nj->ni", inertia, al) + np.cross(om, spin),
        inertia=inertia,
    )


def brute_wrenches(body, loads):
    """What each hinge must carry so that its outboard bodies move as they do: q and m of the child on the parent."""
    n = len(body.parent)
    force = body.mass * G - body.rate_of_momentum
    wrench = np.zeros((n, 6))
    for b in range(n):
        for j in range(b, n):
            k = j
            while k > b:
                k = body.parent[k]
            if k == b:
                wrench[b, :3] += force[j] + loads.force[j]
                wrench[b, 3:] += (
                    np.cross(body.c[j] - body.hinge[b], force[j])
                    - body.rate_of_spin[j]
                    + loads.moment[j]
                    + np.cross(body.origin[j] - body.hinge[b], loads.force[j])
                )
    return wrench
