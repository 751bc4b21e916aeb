"""Driver and coil: both models against closed forms and an integrator, limits, slew rate, delay and eddy currents."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from trackvib_sim.vehicle.coil import build_coil, drive_coils, new_coil_state, settle_coils, usable_current

DT = 1e-4  # s
FEW = settings(max_examples=30)
DEMANDS = st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=20)
MODELS = st.sampled_from(["lag", "current_loop"])
LAGS = st.sampled_from([0.0, 0.002, 0.015, 0.02])  # of the eddy currents, also that of the coil itself, s


@pytest.fixture(scope="module")
def driven(changed):
    """A function that drives coils, from rest at `start` [A], by rows of demands [A] for `hold` steps each.

    Returns their record and reference, current and field after every step, (steps, 2) each.
    """

    def drive(demands, start, hold=1, dt=DT, **items):
        record = build_coil(changed("coil", **items), dt)
        state = new_coil_state(record, 2)
        settle_coils(record, state, start)
        rows = []
        for demand in np.repeat(np.array(demands), hold, axis=0):
            drive_coils(record, np.broadcast_to(demand, 2), state)
            rows.append([part.copy() for part in (state.reference, state.current, state.field)])
        return record, *np.array(rows).transpose(1, 0, 2)

    return drive


@pytest.mark.analytic
@given(
    dt=st.floats(1e-6, 0.1),
    steps=st.integers(1, 50),
    start=st.floats(0.0, 5.0),
    demands=st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0)),
)
def test_lag_is_exact(vehicle, driven, dt, steps, start, demands):
    """As shipped, each coil is where the closed form has it after any number of steps of any length.

    Without eddy currents the field is that of the current to the last bit.
    """
    _, _, currents, field = driven([demands], start, steps, dt)
    target = np.clip(demands, *vehicle.coil.current_limits)
    expected = target + (start - target) * np.exp(-steps * dt / vehicle.coil.time_constant)
    assert_allclose(currents[-1], expected, rtol=1e-13, atol=1e-13)
    assert np.array_equal(field, currents)


@pytest.mark.analytic
@pytest.mark.parametrize(("start", "demand"), [(0.8, 3.0), (3.0, 0.8), (0.0, 5.0), (4.0, 0.0)])
def test_current_loop_follows_the_closed_form(vehicle, driven, start, demand):
    """A large step runs along the coil's own curve at full voltage, then the loop closes with its time constant.

    The driver takes full voltage back at the first step after a continuous one would: at the 1000 A/s that 24 V and the
    6 V across the resistance drive through 30 mH, a tenth of an ampere in a step of 0.1 ms at most, less with less.
    """
    c = vehicle.coil
    held = c.voltage_limits[1 if demand > start else 0] / c.resistance
    lag, loop = c.inductance / c.resistance, c.loop_time_constant
    gain = lag / loop - 1.0
    closing = demand - (held - demand) / gain
    assert min(start, demand) < closing < max(start, demand)
    switch = lag * np.log((held - start) / (held - closing))
    errors = []
    for dt in (1e-4, 1e-5):
        _, _, currents, _ = driven([demand], start, round(0.02 / dt), dt, model="current_loop")
        time = dt * np.arange(1, len(currents) + 1)
        full = held + (start - held) * np.exp(-time / lag)
        expected = np.where(time < switch, full, demand + (closing - demand) * np.exp((switch - time) / loop))
        assert_allclose(currents[time < switch], np.column_stack((full, full))[time < switch], rtol=1e-11)
        errors.append(np.abs(currents[:, 0] - expected).max())
    assert errors[0] < 0.08 and errors[1] < 0.15 * errors[0]


@pytest.mark.analytic
@pytest.mark.parametrize(("start", "demand"), [(1.0, 1.4), (3.0, 2.7)])
def test_current_loop_within_its_voltage_is_exact(vehicle, driven, start, demand):
    """A small step closes with the loop's time constant at any step."""
    for dt in (1e-4, 5e-4):
        _, _, currents, _ = driven([demand], start, 20, dt, model="current_loop")
        time = dt * np.arange(1, 21)
        expected = demand + (start - demand) * np.exp(-time / vehicle.coil.loop_time_constant)
        assert_allclose(currents[:, 0], expected, rtol=1e-12)


@pytest.mark.cross_engine
@pytest.mark.parametrize("eddy", [0.002, 0.015, 0.04])
def test_driver_coil_and_field_are_those_of_an_integrator(vehicle, driven, eddy):
    """Voltage held from step to step, L i' = v - R i and eddy I' = i - I by scipy: the same to its tolerance.

    One of the lags is the coil's own, where both exponentials are one.
    """
    c, demands = vehicle.coil, [3.0, 3.0, 0.5, 4.0, 1.0]
    record, reference, currents, field = driven(demands, 1.0, 25, model="current_loop", eddy_time_constant=eddy)
    state = np.array([1.0, 1.0])
    for k in range(len(reference)):
        wanted = c.resistance * (reference[k, 0] + record.gain * (reference[k, 0] - state[0]))
        volts = np.clip(wanted, *c.voltage_limits)

        def rates(_, y, volts=volts):
            return (volts - c.resistance * y[0]) / c.inductance, (y[0] - y[1]) / eddy

        state = solve_ivp(rates, (0.0, DT), state, rtol=1e-10, atol=1e-12).y[:, -1]
        assert_allclose((currents[k, 0], field[k, 0]), state, rtol=1e-8)
    assert np.abs(currents - field).max() > 0.1


@pytest.mark.property
@FEW
@given(demands=DEMANDS, start=st.floats(0.0, 5.0), model=MODELS, eddy=LAGS, slew=st.sampled_from([0.0, 300.0]))
def test_nothing_leaves_its_limits(vehicle, driven, demands, start, model, eddy, slew):
    """Whatever is demanded, reference, current and field stay within the driver's limits, and so does the voltage.

    By rounding alone they may end a last bit beyond.
    """
    c, items = vehicle.coil, dict(model=model, eddy_time_constant=eddy, slew_rate=slew)
    record, reference, currents, field = driven(demands, start, 7, **items)
    lowest, highest = c.current_limits
    for part in (reference, currents, field):
        assert lowest - 1e-12 <= part.min() and part.max() <= highest + 1e-12
    before = np.vstack(([start, start], currents[:-1]))
    if slew:
        assert np.abs(np.diff(reference, axis=0)).max(initial=0.0) <= slew * DT * (1.0 + 1e-9)
    if model == "current_loop":
        volts = c.resistance * (currents - record.decay * before) / (1.0 - record.decay)
        assert c.voltage_limits[0] - 1e-9 <= volts.min() and volts.max() <= c.voltage_limits[1] + 1e-9
    # never past what it follows
    between = np.sort((before, reference), axis=0)
    assert (between[0] - 1e-12 <= currents).all() and (currents <= between[1] + 1e-12).all()


@pytest.mark.analytic
def test_slew_rate_makes_a_ramp(driven):
    """At 200 A/s a reference takes 11 ms from 0.8 to 3 A, in equal steps, and then stays; downwards likewise."""
    _, reference, _, _ = driven([3.0, 0.8], 0.8, 150, slew_rate=200.0)
    ramp = np.minimum(0.8 + 0.02 * np.arange(1, 151), 3.0)
    assert_allclose(reference[:, 0], np.concatenate((ramp, 3.8 - ramp)), rtol=1e-12)
    assert reference[149, 0] == 3.0


@pytest.mark.property
@FEW
@given(demands=DEMANDS, model=MODELS, delay=st.integers(1, 30))
def test_delay_is_exact_in_steps(driven, demands, model, delay):
    """What a delay of n steps gives is what none gives, n steps later, to the last bit."""
    items = dict(model=model, eddy_time_constant=0.002, slew_rate=500.0)
    prompt = driven(demands, 1.0, 3, **items)[1:]
    late = driven([*demands, *[demands[-1]] * 10], 1.0, 3, delay=delay * DT, **items)[1:]
    for one, other in zip(prompt, late, strict=True):
        assert (other[:delay] == 1.0).all()
        assert np.array_equal(one, other[delay : delay + len(one)])


@pytest.mark.property
def test_delay_must_be_whole_steps(changed):
    """A delay that the steps do not divide is refused with both."""
    with pytest.raises(ValueError, match=r"coil\.delay is 0\.00025 s, must be a whole number of .* steps of 0\.0001 s"):
        build_coil(changed("coil", delay=2.5e-4), DT)
    assert build_coil(changed("coil", delay=3e-4), DT).delay == 3


@pytest.mark.property
def test_usable_current_is_what_nobody_cuts(changed, vehicle):
    """From a dead coil to the end of the fits, as far as the driver's limits let it."""
    assert usable_current(vehicle).tolist() == [0.0, 4.0]
    assert usable_current(changed("coil", current_limits=[1.0, 2.0])).tolist() == [1.0, 2.0]
