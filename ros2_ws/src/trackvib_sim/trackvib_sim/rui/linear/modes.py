"""Damped poles and modes of a tree about its equilibrium.

The undamped modes, all of them, serve as coordinates in which the poles are found at once, overdamped ones included;
Newton steps, each a sweep of the transfer matrix method at the complex s itself, take the rounding out again.
"""

import numpy as np

from .equilibrium import check_equilibrium
from .mode import Mode, scaled_mode
from .model import LinearModel
from .natural_modes import mode_shapes, natural_values
from .sweep import forced_motion, tips_to_root
from .tree import move

NEWTON_STEPS = 4
SPLIT = 1e-6  # of the size of a pole, from where on an imaginary part is more than rounding


def natural_frequencies(model: LinearModel, highest_frequency: float) -> np.ndarray:
    """Return all undamped frequencies below a limit [Hz], ascending, each as often as it occurs.

    Free motions are 0 except for rounding (about 1e-7 of the highest). An unstable motion exp(a t) gives -a / 2 pi.

    Examples
    --------
    A pendulum with M = 2 kg, l = 0.5 m and J = 0.1 kg m^2: sqrt(M g l / (J + M l^2)) / 2 pi.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> model = rui.LinearModel(bodies, rui.rest_state(bodies), fixed_root=True)
    >>> rui.natural_frequencies(model, highest_frequency=10.0).round(6)
    array([0.643545])
    """
    values = natural_values(check_equilibrium(model), (2.0 * np.pi * highest_frequency) ** 2)
    return np.sign(values) * np.sqrt(np.abs(values)) / (2.0 * np.pi)


def modes(model: LinearModel, highest_frequency: float = np.inf, zero_below: float = 1e-3) -> list[Mode]:
    """Return the damped modes of a tree about its equilibrium.

    Parameters
    ----------
    model : LinearModel
        In equilibrium (`find_equilibrium`).
    highest_frequency : float
        Modes with a larger |pole| / 2 pi [Hz] are left out.
    zero_below : float
        Modes below it [Hz] are free motions and are left out.

    Returns
    -------
    list of Mode
        Ascending frequency.

    Raises
    ------
    ValueError
        The model is not at rest.

    Examples
    --------
    The same pendulum with a damper of 0.5 N m s/rad in its hinge.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> model = rui.LinearModel(bodies, rui.rest_state(bodies), damping=[0.0, 0.5], fixed_root=True)
    >>> [(round(mode.frequency, 4), round(mode.damping_ratio, 4)) for mode in rui.modes(model)]
    [(0.6435, 0.103)]
    """
    tree = check_equilibrium(model)
    dampers = [tree.damping, tree.hinge_damping] + [bushing.child_rate for bushing in tree.bushings.values()]
    limits = 2.0 * np.pi * zero_below, 2.0 * np.pi * highest_frequency
    if any(np.any(damper) for damper in dampers):
        poles, x, coordinate = _damped(tree, limits)
    else:
        shapes = mode_shapes(tree, None if np.isinf(limits[1]) else limits[1] ** 2)
        poles = np.sqrt((-shapes.omega_squared).astype(complex))  # imaginary part >= 0
        kept = np.abs(poles) >= limits[0]
        poles, x, coordinate = poles[kept], shapes.x[:, :, kept], shapes.coordinate[:, kept]
        real = poles.imag == 0.0  # unstable: one way out, one way in
        poles = np.concatenate((poles, -poles[real]))
        x, coordinate = np.dstack((x, x[:, :, real])), np.hstack((coordinate, coordinate[:, real]))
    order = np.lexsort((poles.real, np.round(np.abs(poles), 9)))
    return [scaled_mode(tree, poles[k], x[:, :, k], coordinate[:, k]) for k in order]


def damping_loads(tree, x, coordinate):
    """Return what all dampers put up against speeds x (..., n, 6, m), coordinate (..., n, m): C times that.

    Wrench (..., n, 6, m) about every body's origin and axis load (..., n, m), signs of a load that drives the motion.
    """
    wrench, torque = tree.damping @ x, tree.hinge_damping[:, None] * coordinate
    for row, bushing in tree.bushings.items():
        parent, lever = tree.parent[row], move(tree.lever[row])
        at_child = bushing.child_rate @ x[..., row, :, :] + bushing.parent_rate @ (lever @ x[..., parent, :, :])
        wrench[..., row, :, :] += at_child
        wrench[..., parent, :, :] -= lever.T @ (move(tree.offset[row]).T @ at_child)
    return wrench, torque


def _damped(tree, limits):
    """Return poles (k,), x (n, 6, k), coordinate (n, k) with limits[0] <= |s| <= limits[1], Im s >= 0."""
    basis = mode_shapes(tree)
    count = len(basis.omega_squared)
    wrench, torque = damping_loads(tree, basis.x, basis.coordinate)
    damping = np.einsum("bik,bim->km", basis.x, wrench) + np.einsum("bk,bm->km", basis.coordinate, torque)
    companion = np.zeros((2 * count, 2 * count))
    companion[:count, count:] = np.eye(count)
    companion[count:, :count], companion[count:, count:] = -np.diag(basis.omega_squared), -damping
    poles, vectors = np.linalg.eig(companion)
    size = np.abs(poles)
    # rounding splits a real double pole into a pair: of that pair's vectors, both real and imaginary part are shapes
    split = (poles.imag != 0.0) & (np.abs(poles.imag) <= SPLIT * size)
    vectors[:, split] = np.where(poles.imag[split] > 0.0, vectors[:, split].real, vectors[:, split].imag)
    poles[split] = poles[split].real
    kept = (size >= limits[0]) & (size <= limits[1]) & (poles.imag >= 0.0)
    poles, vectors = poles[kept], vectors[:count, kept]
    x = np.moveaxis(basis.x @ vectors, 2, 0)[..., None]
    coordinate = (basis.coordinate @ vectors).T[..., None]
    poles, x, coordinate = _newton(tree, poles, x, coordinate)
    return poles, np.moveaxis(x[..., 0], 0, 2), coordinate[..., 0].T


def _newton(tree, poles, x, coordinate):
    """Correct poles (F,) and shapes (F, n, 6, 1), (F, n, 1) of (s^2 M + s C + K) x = 0.

    One step solves (s^2 M + s C + K) y = p with p = (2 s M + C) x, the derivative with s; then s - (x.p) / (y.p) is the
    next pole and y the next shape. Real poles stay real.
    """
    real = poles.imag == 0.0
    for _ in range(NEWTON_STEPS if len(poles) else 0):
        s = poles * (1.0 + 1e-10)  # beside the pole, where the sweep cannot meet a zero pivot
        sweep = tips_to_root(tree, s * s, s)
        wrench, torque = damping_loads(tree, x, coordinate)
        wrench = wrench + 2.0 * s[:, None, None, None] * (tree.inertia @ x)
        y, y_coordinate = forced_motion(sweep, wrench, torque)
        work, next_work = _work(x, coordinate, wrench, torque), _work(y, y_coordinate, wrench, torque)
        poles = s - work / next_work
        poles[real] = poles[real].real
        size = np.sqrt(np.sum(np.abs(y) ** 2, axis=(1, 2, 3), keepdims=True))
        x, coordinate = y / size, y_coordinate / size[:, 0]
    return poles, x, coordinate


def _work(x, coordinate, wrench, torque):
    return np.sum(x * wrench, axis=(1, 2, 3)) + np.sum(coordinate * torque, axis=(1, 2))
