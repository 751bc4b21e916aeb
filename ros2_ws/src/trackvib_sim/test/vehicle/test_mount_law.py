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


@pytest.fixture(scope="module")
def unloaded(system):
    """The mounts without what they carry, so that rest is at zero and stores nothing."""
    return system.mounts._replace(load=np.zeros((2, 3)))


def laid(mounts, current):
    """The fields of mounts at ease."""
    fields = new_field_state(2)
    lay_fields(mounts, np.full(2, current), fields)
    return fields


def spring(mounts, fields, l):
    """The force of the first mount at rest."""
    return np.array(mount_force(mounts, fields, 0, 1.0, l, STILL)[0])


@pytest.mark.property
@given(moves=MOVES, first=st.floats(0.0, 4.0))
def test_passive_from_rest_under_any_current(unloaded, moves, first):
    """Work done on the springs is what they store and what switching loses, which is never less than nothing."""
    fields, here, work, lost = laid(unloaded, first), STILL, 0.0, 0.0
    for l, current in moves:
        before = spring(unloaded, fields, here)
        work -= 0.5 * np.dot(before + spring(unloaded, fields, l), np.subtract(l, here))  # linear between
        assert work == pytest.approx(mount_stored_energy(unloaded, fields, 0, l) + lost, rel=1e-9, abs=1e-6)
        assert work >= -1e-6
        loss = switch_field(unloaded, fields, 0, current, l)
        assert loss >= -1e-9
        here, lost = l, lost + loss


@pytest.mark.property
@given(l=METRES, first=st.floats(0.0, 4.0), second=st.floats(0.0, 4.0))
def test_force_never_rises_with_the_current_at_rest(unloaded, l, first, second):
    """New field on a mount at rest gives no force; what a falling current takes away is that part of the field's."""
    fields = laid(unloaded, first)
    before = spring(unloaded, fields, l)
    switch_field(unloaded, fields, 0, second, l)
    k = [mount_characteristics(unloaded, 0, current)[0] for current in (first, min(first, second))]
    expected = before * np.where(before == 0.0, 1.0, k[1] / k[0])
    assert spring(unloaded, fields, l) == pytest.approx(expected, rel=1e-9, abs=1e-6)


@pytest.mark.analytic
def test_firm_on_return_gets_nothing(unloaded):
    """A law that would pump: soft outwards, firm on the way back. A spring k(I) l would give 2 (k2 - k1) / 2 A^2."""
    fields, amplitude, here, work = laid(unloaded, SOFT), 1e-3, STILL, 0.0
    for _ in range(10):
        for l, then in ((amplitude, FIRM), (0.0, SOFT), (-amplitude, FIRM), (0.0, SOFT)):
            there = (0.0, 0.0, l)
            force = spring(unloaded, fields, here) + spring(unloaded, fields, there)
            work -= 0.5 * np.dot(force, np.subtract(there, here))
            switch_field(unloaded, fields, 0, then, there)
            here = there
        assert work > 0.0
