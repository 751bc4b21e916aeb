"""The field of a mount remembers: no current makes energy or a jerk of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.vehicle.mount_law import (
    lay_fields,
    mount_characteristics,
    mount_force,
    mount_stored_energy,
    new_field_state,
    switch_field,
)

METRES = st.tuples(*[st.floats(-0.02, 0.02)] * 3)
MOVES = st.lists(st.tuples(METRES, st.floats(-1.0, 6.0)), min_size=1, max_size=40)
STILL = (0.0, 0.0, 0.0)
SOFT, FIRM = 0.8, 3.5  # A


YIELDING = 1e3 * np.array([(0.0, 0.0, 1.2, 0.3)] * 2)  # N, 1.2 kN more an ampere


@pytest.fixture(scope="module", params=["without yield", "yielding"])
def unloaded(system, request):
    """The mounts without what they carry, so that rest is at zero and stores nothing."""
    mounts = system.mounts._replace(load=np.zeros((2, 3)))
    return mounts._replace(yield_fit=YIELDING) if request.param == "yielding" else mounts


def laid(mounts, current):
    """The fields of mounts at ease."""
    fields = new_field_state(2)
    lay_fields(mounts, np.full(2, current), fields)
    return fields


def spring(mounts, fields, l):
    """The force of the first mount at rest."""
    return np.array(mount_force(mounts, fields, 0, 1.0, l, STILL)[0])


def led(mounts, fields, here, there, steps=1000):
    """The work that it takes to lead the first mount slowly on a straight line, by the trapezoidal rule."""
    places = np.linspace(here, there, steps + 1)
    force = np.array([spring(mounts, fields, tuple(place)) for place in places])
    return -0.5 * ((force[1:] + force[:-1]) * np.diff(places, axis=0)).sum()


@pytest.mark.slow(reason="many sequences of moves, one by one")
@pytest.mark.property
@given(moves=MOVES, first=st.floats(0.0, 4.0))
def test_passive_from_rest_under_any_current(unloaded, moves, first):
    """Work done on the springs is what they store, turn into heat and lose by switching, which is never negative."""
    fields, here, work, lost = laid(unloaded, first), STILL, 0.0, 0.0
    for l, current in moves:
        work += led(unloaded, fields, here, l)
        heat, loss = switch_field(unloaded, fields, 0, current, l)
        assert heat >= -1e-9 and loss >= -1e-9
        here, lost = l, lost + heat + loss
        assert work == pytest.approx(mount_stored_energy(unloaded, fields, 0, l) + lost, rel=1e-3, abs=1e-3)
        assert work >= -1e-3


@pytest.mark.property
@given(l=METRES, first=st.floats(0.0, 4.0), second=st.floats(0.0, 4.0))
def test_force_never_rises_with_the_current_at_rest(unloaded, l, first, second):
    """New field on a mount at rest gives no force; what a falling current takes away is that part of the field's."""
    fields = laid(unloaded, first)
    before = spring(unloaded, fields, l)
    switch_field(unloaded, fields, 0, second, l)
    rubber, *k = (mount_characteristics(unloaded, 0, current)[0] for current in (0.0, first, min(first, second)))
    of_rubber = -rubber * unloaded.stiffness[0] * l
    left = (k[1] - rubber) / (k[0] - rubber) if k[0] > rubber else 1.0
    expected = of_rubber + left * (before - of_rubber)
    assert spring(unloaded, fields, l) == pytest.approx(expected, rel=1e-9, abs=1e-6)


@pytest.mark.analytic
def test_firm_on_return_gets_nothing(unloaded):
    """A law that would pump: soft outwards, firm on the way back. A spring k(I) l would give 2 (k2 - k1) / 2 A^2."""
    fields, amplitude, here, work = laid(unloaded, SOFT), 1e-3, STILL, 0.0
    for _ in range(10):
        for l, then in ((amplitude, FIRM), (0.0, SOFT), (-amplitude, FIRM), (0.0, SOFT)):
            there = (0.0, 0.0, l)
            work += led(unloaded, fields, here, there, 10)
            switch_field(unloaded, fields, 0, then, there)
            here = there
        assert work > 0.0
