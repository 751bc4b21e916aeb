"""Riccati form of the Rui method: the accelerations of a whole tree in two sweeps [Rui2020].

The forward sweep gathers S and s of the cuts (`articulated`) from the tips to the root, where the free end (f = 0)
gives the root's acceleration; the backward sweep hands accelerations out to the tips. -S is the articulated-body
inertia, -s the articulated bias force, so the cost is O(n) and the pivot of a hinge, minus the inertia seen at its
axis, is never zero for bodies with mass and inertia. The wrench in any hinge follows from its cut
(`response.hinge_wrench`).
"""

from ...numerics.compiled import inlined
from ...numerics.spatial import add, cross, dot, rotate, rotate_back, scale, symmetric_product
from .articulated import CutOffset
from .cells import add3, add6, add9, get3, get6, get9, pick3, put3, put6, put9, sum_lanes
from .kinematics import MotionOffset
from .packing import HingeKind
from .response import ResponseOffset
from .root import solve_root
from .tree import BodyOffset


@inlined
def solve_accelerations(tree, motion, cuts, response):
    """Fill `response` from opened cuts with all loads; the cuts then hold S_h and s_h of every hinge."""
    for j in range(tree.parent.size - 1, -1, -1):
        p, cut = tree.parent[j], cuts.cells[j]
        if p < 0:
            _free_end(tree, cut, response.cells[j])
        else:
            if tree.alone[j]:
                _pool(tree, cut)
            if tree.kind[j] == HingeKind.PRISMATIC:
                _close_prismatic(tree, tree.body[j], motion.cells[j], cut)
            else:
                _close_revolute(tree, tree.body[j], motion.cells[j], cut)
            _hand_on(tree, tree.body[j], BodyOffset.SHARE, motion.cells[j], cut, cuts.cells[p])
            if tree.foot[j] >= 0:
                _hand_on(tree, tree.body[j], BodyOffset.FOOT_SHARE, motion.cells[j], cut, cuts.cells[tree.foot[j]])
    for j in range(tree.parent.size):
        p = tree.parent[j]
        if p >= 0:
            up = response.cells[p]
            if tree.foot[j] >= 0:
                _gather_parents(tree, tree.body[j], response.cells[tree.foot[j]], response.cells[p], response.parents)
                up = response.parents
            turns = 0.0 if tree.kind[j] == HingeKind.PRISMATIC else 1.0
            _hand_out(tree, turns, motion.cells[j], cuts.cells[j], up, response.cells[j])


@inlined
def _pool(tree, cut):
    """Where one body stands alone: what the lanes have gathered, summed, in all of them."""
    w = len(tree.lanes)
    sum_lanes(tree.lanes, cut, CutOffset.POOLED * tree.width[0])
    p, q, r = get6(cut, CutOffset.P, w, 0), get9(cut, CutOffset.Q, w, 0), get6(cut, CutOffset.R, w, 0)
    s_q, s_m, hinge = (
        get3(cut, CutOffset.FORCE, w, 0),
        get3(cut, CutOffset.MOMENT, w, 0),
        get3(cut, CutOffset.TORQUE, w, 0),
    )
    # one loop for all: alone, each would be too short to be worth a vector instruction to the compiler
    for i in range(tree.width[0]):
        put6(cut, CutOffset.P, w, i, p)
        put9(cut, CutOffset.Q, w, i, q)
        put6(cut, CutOffset.R, w, i, r)
        put3(cut, CutOffset.FORCE, w, i, s_q)
        put3(cut, CutOffset.MOMENT, w, i, s_m)
        put3(cut, CutOffset.TORQUE, w, i, hinge)


@inlined
def _free_end(tree, cut, response):
    """S x + s = 0 at the root's free end."""
    w = len(tree.lanes)
    sum_lanes(tree.lanes, cut, CutOffset.POOLED * tree.width[0])
    a, al = solve_root(
        get6(cut, CutOffset.P, w, 0),
        get9(cut, CutOffset.Q, w, 0),
        get6(cut, CutOffset.R, w, 0),
        get3(cut, CutOffset.FORCE, w, 0),
        get3(cut, CutOffset.MOMENT, w, 0),
    )
    # all x count from free fall; that of a free body itself has no other drift than gravity
    for i in range(tree.width[0]):
        put3(response, ResponseOffset.LINEAR, w, i, a)
        put3(response, ResponseOffset.ANGULAR, w, i, al)


@inlined
def _close_revolute(tree, body, m, cut):
    """u = S D, D_h = D^T u, gamma = D^T s + tau with D = [0; e], lane by lane."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        e = get3(m, MotionOffset.HINGE_AXIS, w, i)
        u_q = rotate(get9(cut, CutOffset.Q, w, i), e)
        u_m = symmetric_product(get6(cut, CutOffset.R, w, i), e)
        gamma = dot(e, get3(cut, CutOffset.MOMENT, w, i)) + cut[CutOffset.TORQUE * w + i]
        _eliminate(body, cut, w, i, u_q, u_m, dot(e, u_m), gamma)


@inlined
def _close_prismatic(tree, body, m, cut):
    """The same with D = [e; 0]."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        e = get3(m, MotionOffset.HINGE_AXIS, w, i)
        u_q = symmetric_product(get6(cut, CutOffset.P, w, i), e)
        u_m = rotate_back(get9(cut, CutOffset.Q, w, i), e)
        gamma = dot(e, get3(cut, CutOffset.FORCE, w, i)) + cut[CutOffset.TORQUE * w + i]
        _eliminate(body, cut, w, i, u_q, u_m, dot(e, u_q), gamma)


@inlined
def _eliminate(body, cut, w, i, u_q, u_m, pivot, gamma):
    """S_h = S - u u^T / D_h, s_h = s - u gamma / D_h; a prescribed hinge keeps S and adds u thdd to s."""
    mobility = body[BodyOffset.MOBILE * w + i] / (pivot - cut[CutOffset.IMPEDANCE * w + i])
    p, q, r = get6(cut, CutOffset.P, w, i), get9(cut, CutOffset.Q, w, i), get6(cut, CutOffset.R, w, i)
    x, y, z = scale(mobility, u_q)
    p = (
        p[0] - x * u_q[0], p[1] - y * u_q[1], p[2] - z * u_q[2],
        p[3] - x * u_q[1], p[4] - x * u_q[2], p[5] - y * u_q[2],
    )  # fmt: skip
    q = (
        q[0] - x * u_m[0], q[1] - x * u_m[1], q[2] - x * u_m[2],
        q[3] - y * u_m[0], q[4] - y * u_m[1], q[5] - y * u_m[2],
        q[6] - z * u_m[0], q[7] - z * u_m[1], q[8] - z * u_m[2],
    )  # fmt: skip
    x, y, z = scale(mobility, u_m)
    r = (
        r[0] - x * u_m[0], r[1] - y * u_m[1], r[2] - z * u_m[2],
        r[3] - x * u_m[1], r[4] - x * u_m[2], r[5] - y * u_m[2],
    )  # fmt: skip
    along = cut[CutOffset.DRIVE * w + i] - mobility * gamma
    put6(cut, CutOffset.P, w, i, p)
    put9(cut, CutOffset.Q, w, i, q)
    put6(cut, CutOffset.R, w, i, r)
    add3(cut, CutOffset.FORCE, w, i, along, u_q)
    add3(cut, CutOffset.MOMENT, w, i, along, u_m)
    put3(cut, CutOffset.U_FORCE, w, i, u_q)
    put3(cut, CutOffset.U_MOMENT, w, i, u_m)
    cut[CutOffset.MOBILITY * w + i] = mobility
    cut[CutOffset.GAMMA * w + i] = gamma


@inlined
def _hand_on(tree, body, share_of, m, cut, up):
    """Add X^T S_h X and X^T s_h to the parents' cuts, where X moves accelerations from their origin by the lever."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        x, y, z = lever = get3(m, MotionOffset.LEVER, w, i)
        p, q, r = get6(cut, CutOffset.P, w, i), get9(cut, CutOffset.Q, w, i), get6(cut, CutOffset.R, w, i)
        s_q = get3(cut, CutOffset.FORCE, w, i)
        s_m = add(get3(cut, CutOffset.MOMENT, w, i), cross(lever, s_q))
        # Q' = Q - P [l]x
        n = (
            q[0] - (p[3] * z - p[4] * y), q[1] - (p[4] * x - p[0] * z), q[2] - (p[0] * y - p[3] * x),
            q[3] - (p[1] * z - p[5] * y), q[4] - (p[5] * x - p[3] * z), q[5] - (p[3] * y - p[1] * x),
            q[6] - (p[5] * z - p[2] * y), q[7] - (p[2] * x - p[4] * z), q[8] - (p[4] * y - p[5] * x),
        )  # fmt: skip
        # R' = R + [l]x Q' + ([l]x Q)^T
        r = (
            r[0] + (y * n[6] - z * n[3]) + (y * q[6] - z * q[3]),
            r[1] + (z * n[1] - x * n[7]) + (z * q[1] - x * q[7]),
            r[2] + (x * n[5] - y * n[2]) + (x * q[5] - y * q[2]),
            r[3] + (y * n[7] - z * n[4]) + (z * q[0] - x * q[6]),
            r[4] + (y * n[8] - z * n[5]) + (x * q[3] - y * q[0]),
            r[5] + (z * n[2] - x * n[8]) + (x * q[4] - y * q[1]),
        )
        share = body[share_of * w + i]
        add6(up, CutOffset.P, w, i, share, p)
        add9(up, CutOffset.Q, w, i, share, n)
        add6(up, CutOffset.R, w, i, share, r)
        add3(up, CutOffset.FORCE, w, i, share, s_q)
        add3(up, CutOffset.MOMENT, w, i, share, s_m)


@inlined
def _gather_parents(tree, body, foot, up, out):
    """Bring together the x of the parents, where some stand on the foot."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        second = body[BodyOffset.FOOT_SHARE * w + i] > 0.0
        pick3(second, foot, up, out, ResponseOffset.LINEAR, w, i)
        pick3(second, foot, up, out, ResponseOffset.ANGULAR, w, i)


@inlined
def _hand_out(tree, turns, m, cut, up, response):
    """thdd = -(u^T x + gamma) / D_h from the parents' x moved to the hinge, and with it the children's x."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        al = get3(up, ResponseOffset.ANGULAR, w, i)
        a = add(get3(up, ResponseOffset.LINEAR, w, i), cross(al, get3(m, MotionOffset.LEVER, w, i)))
        along = (
            dot(get3(cut, CutOffset.U_FORCE, w, i), a)
            + dot(get3(cut, CutOffset.U_MOMENT, w, i), al)
            + cut[CutOffset.GAMMA * w + i]
        )
        thdd = cut[CutOffset.DRIVE * w + i] - cut[CutOffset.MOBILITY * w + i] * along
        e = get3(m, MotionOffset.HINGE_AXIS, w, i)
        put3(response, ResponseOffset.LINEAR, w, i, add(a, scale(thdd - turns * thdd, e)))
        put3(response, ResponseOffset.ANGULAR, w, i, add(al, scale(turns * thdd, e)))
        response[ResponseOffset.HINGE * w + i] = thdd
