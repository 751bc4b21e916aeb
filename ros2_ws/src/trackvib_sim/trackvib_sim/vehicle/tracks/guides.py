"""Guide horns: they stand between the discs of a wheel and hold its shoes sideways.

A horn comes in between the discs before its shoe touches the rim, and tapers. So the guide's stiffness grows from
nothing, where the shoe is a horn's reach above the rim, to its whole at the rim. Of a shoe at the place y sideways and
the depth d below the rim a guide stores

    V = k y^2 / 2 s(1 + d / reach)        s(x) = x^2 (3 - 2 x) between 0 and 1,

and its forces are V's gradient: besides the one sideways, a horn that leans on its disc pushes the shoe out. A guide
that came and went with the touch itself would give k y^2 / 2 to each shoe that comes in beside its wheel's middle.
"""

from ...numerics.compiled import inlined

REACH = 0.05  # m by which horns stand above the rims of wheels, rollers and idlers


@inlined
def hold(stiffness, damping, reach, depth, sideways, rate):
    """Return what a guide does to a shoe: forces outwards and sideways [N], heat [W] and energy stored [J].

    The shoe is `sideways` of its wheel's middle [m], moves so at a `rate` [m/s] and is at a `depth` below the rim [m].
    """
    way = min(max(1.0 + depth / reach, 0.0), 1.0)
    part = way * way * (3.0 - 2.0 * way)
    energy = 0.5 * stiffness * sideways * sideways
    outwards = 6.0 * way * (1.0 - way) / reach * energy
    damped = part * damping * rate
    return outwards, -part * stiffness * sideways - damped, damped * rate, part * energy
