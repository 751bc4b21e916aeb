"""Cut pins that cannot be used are refused by name."""

from dataclasses import replace

import numpy as np
import pytest
from trackvib_sim.rui.closed_chain import closed_accelerations, closure_error
from trackvib_sim.rui.cut_pin import CutPin
from trackvib_sim.rui.state import no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

from .closed_chains import parallelogram


def _refused(match, **changes):
    bodies, cut, state, loads = parallelogram(0.3, 0.0)
    for call in (lambda p: closed_accelerations(bodies, p, state, loads), lambda p: closure_error(bodies, p, state)):
        with pytest.raises(ValueError, match=match):
            call([replace(cut, **changes)])


@pytest.mark.analytic
@pytest.mark.parametrize(
    "match, changes",
    [
        ("between 'rod' and 'crank': there is no body 'crank'; known are base, left, rod, right", {"body_b": "crank"}),
        ("must join two different bodies", {"body_b": "rod"}),
        ("point_a is .*, must be 3 finite numbers", {"point_a": (0.0, np.nan, 0.0)}),
        ("point_b is .*, must be 3 finite numbers", {"point_b": (0.0, 1.0)}),
        ("axis is .*, must be 1e-06 to 1e\\+06 long", {"axis": (0, 0, 0)}),
        ("axis is .*, must be 1e-06 to 1e\\+06 long", {"axis": (0, 1e-300, 0)}),
        ("alpha is -1.0 1/s, must be finite and >= 0", {"alpha": -1.0}),
        ("beta is inf 1/s, must be finite and >= 0", {"beta": np.inf}),
        ("hinge 3 of body 'right' is revolute with axis .*accepted: revolute parallel", {"axis": (0, 1, 1e-3)}),
        (r"points are 0\.2\d* m apart along \(0, 1, 0\), must be 0 m", {"point_a": (1.5, 0.2, 0)}),
    ],
)
def test_impossible_pins(match, changes):
    """A pin that is not possible is refused by name, with what is accepted."""
    _refused(match, **changes)


@pytest.mark.analytic
@pytest.mark.parametrize("kind, axis", [("prismatic", (0, 1, 0)), ("elastic", (0, 1, 0)), ("revolute", (1, 0, 0))])
def test_loops_that_leave_their_planes(kind, axis):
    """Hinges in the loop that would let it leave its planes are refused; outside of the loop they are not."""
    bodies, cut, state, loads = parallelogram(0.3, 0.0)
    bodies[2] = replace(bodies[2], hinge=replace(bodies[2].hinge, kind=kind, axis=axis))
    if kind == "elastic":
        state = rest_state(bodies)
    with pytest.raises(ValueError, match=f"in its loop, hinge 2 of body 'rod' is {kind}"):
        closed_accelerations(bodies, [cut], state, loads)
    bodies, cut, state, loads = parallelogram(0.3, 0.0)
    bodies.append(Body(4, "flag", 1.0, (0, 0, 0.1), np.eye(3), Hinge(4, kind, "rod", (0, 0, 0), axis)))
    state = rest_state(bodies)._replace(hinge=np.append(state.hinge, 0.0))
    found, _ = closed_accelerations(bodies, [cut], state, no_loads(bodies))
    assert np.all(np.isfinite(found.linear))


@pytest.mark.analytic
def test_dependent_closure_equations():
    """A loop of two bodies, one stretched out, and two pins for one loop are refused with the pins' names."""
    bodies, cut, state, loads = parallelogram(0.3, 0.0)
    cases = [
        # on the hinge that is there already
        ([CutPin("left", (0, 0, -0.8), "rod", (0, 0, 0), (0, 1, 0))], state),
        ([CutPin("base", (1.0, 0, 0), "left", (0.3, 0, 0.1), (0, 1, 0))], state),
        ([cut, cut], state),
    ]
    for pins, at in cases:
        with pytest.raises(ValueError, match=f"cut pin between '{pins[0].body_a}'.*depend on each other"):
            closed_accelerations(bodies, pins, at, loads)
    bodies, cut, state, loads = parallelogram(np.pi / 2.0, 0.0)
    with pytest.raises(ValueError, match="depend on each other"):
        closed_accelerations(bodies, [cut], state, loads)
