import arms
import numpy as np
import pytest

import flexura
from flexura.env import tendon_arm

EI = 1e9 * np.pi * 0.002**4 / 4


def test_a_cantilever_sags_as_in_the_textbook():
    force = 1e-4
    arm = arms.rod(load={"section": 1, "force": [force, 0, 0]})
    found = flexura.Statics(arm).solve()
    assert found.converged and found.stable
    assert found.tip[0, 3] == pytest.approx(force * 0.5**3 / (3 * EI), rel=1e-5)


def test_a_tendon_bends_a_rod_to_an_arc():
    arm = arms.rod(tendons=[{"section": 1, "radius": 0.004, "angle": 0}])
    statics = flexura.Statics(arm)
    tension = 3.0
    found = statics.solve(tensions=[tension])
    bend = tension * 0.004 / EI * 0.5
    expected = 0.5 * np.array([(1 - np.cos(bend)) / bend, 0, np.sin(bend) / bend])
    np.testing.assert_allclose(found.tip[:3, 3], expected, atol=1e-9)
    slopes = statics.slopes()
    h = 1e-4
    moved = statics.solve(tensions=[tension + h]).tip - statics.solve(tensions=[tension - h]).tip
    np.testing.assert_allclose(slopes["tip_by_input"][:3, 0], moved[:3, 3] / (2 * h), rtol=1e-6, atol=1e-10)


def test_many_equilibria_equal_single_ones(random):
    arm = tendon_arm()
    statics = flexura.Statics(arm)
    tensions = random.uniform(0, 3, (6, statics.tendons))
    every = statics.solve_batch(tensions=tensions, threads=2)
    assert every["converged"].all()
    for i in range(6):
        one = statics.solve(tensions=tensions[i])
        np.testing.assert_allclose(every["q"][i], one.q, atol=1e-9)
        np.testing.assert_allclose(every["tip"][i], statics.tip(one), atol=1e-9)


def test_input_of_a_wrong_length_is_refused():
    statics = flexura.Statics(tendon_arm())
    with pytest.raises(ValueError, match="tensions: 1 given: expected 9 values, one per tendon"):
        statics.solve(tensions=[1])
    with pytest.raises(ValueError, match="either tensions or displacements"):
        statics.solve(tensions=np.zeros(9), displacements=np.zeros(9))
    dynamics = flexura.Dynamics(tendon_arm())
    state = dynamics.rest()
    for call in (dynamics.step, dynamics.step_slopes, dynamics.linearize):
        with pytest.raises(ValueError, match="displacements: 3 given: expected 9 values"):
            call(state, displacements=np.zeros(3))
    with pytest.raises(ValueError, match=r"tensions: expected an array of shape \(2, 9\)"):
        statics.solve_batch(tensions=np.zeros((2, 3)))
    with pytest.raises(ValueError, match="material"):
        flexura.Statics(arms.two_sections())


def test_a_rod_vibrates_at_the_textbook_frequency():
    dynamics = flexura.Dynamics(arms.rod())
    linear = dynamics.linearize(dynamics.rest())
    expected = 1.875104**2 * np.sqrt(EI / (1000 * np.pi * 0.002**2)) / 0.5**2 / (2 * np.pi)
    assert linear["frequencies_hz"][0] == pytest.approx(expected, rel=1e-4)
    assert linear["frequencies_hz"][2] == pytest.approx(expected * (4.694091 / 1.875104) ** 2, rel=1e-3)


def test_masses_and_accelerations_agree(random):
    dynamics = flexura.Dynamics(tendon_arm())
    q = random.uniform(-1, 1, dynamics.size)
    mass = dynamics.mass_matrix(q)
    np.testing.assert_allclose(mass, mass.T, rtol=1e-9, atol=1e-18)
    assert np.linalg.eigvalsh(mass).min() > 0
    # At rest, one unit more of a tension adds its generalized force to M a.
    zero, one = np.zeros(9), np.eye(9)[4]
    still = np.zeros(dynamics.size)
    pull = mass @ (dynamics.acceleration(q, still, one) - dynamics.acceleration(q, still, zero))
    linear = dynamics.linearize(dynamics.start(q, still, zero), zero)
    np.testing.assert_allclose(pull, -linear["lengths_by_q"][4], rtol=1e-6, atol=1e-9)


def test_a_swinging_arm_loses_its_energy():
    dynamics = flexura.Dynamics(tendon_arm())
    statics = flexura.Statics(tendon_arm())
    state = dynamics.rest(statics.solve(tensions=[3, 0, 0, 0, 2, 0, 0, 0, 1]))
    energies = [dynamics.energy(state)["total"]]
    for _ in range(3000):
        assert dynamics.step(state, np.zeros(9), h=0.01).converged
        energies.append(dynamics.energy(state)["total"])
    assert np.diff(energies).max() < 1e-9
    assert state.time == pytest.approx(30)
    least = dynamics.energy(dynamics.rest())["total"]
    assert least < energies[-1] < least + 0.02 * (energies[0] - least)


def test_step_slopes_are_the_derivatives():
    dynamics = flexura.Dynamics(tendon_arm(2), tolerance=1e-11)
    tensions = np.full(6, 1.0)
    state = dynamics.start(np.linspace(-1, 1, dynamics.size), np.zeros(dynamics.size), tensions)
    slopes = dynamics.step_slopes(state, tensions, h=0.01)
    h = 1e-4
    after = []
    for change in (h, -h):
        moved = state.copy()
        dynamics.step(moved, tensions + change * np.eye(6)[2], h=0.01)
        after.append(np.concatenate([moved.q, moved.momentum]))
    expected = (after[0] - after[1]) / (2 * h)
    np.testing.assert_allclose(slopes["by_input"][: len(expected), 2], expected, rtol=1e-5, atol=1e-7)


def test_many_arms_move_as_single_ones(random):
    arm = tendon_arm()
    tensions = random.uniform(0, 3, (5, 9))
    batches = [flexura.DynamicsBatch(arm, 5, threads=threads) for threads in (1, 2)]
    dynamics = flexura.Dynamics(arm)
    states = [dynamics.rest() for _ in range(5)]
    for _ in range(20):
        for batch in batches:
            assert batch.step(tensions=tensions, h=0.01).all()
        for state, pulls in zip(states, tensions):
            dynamics.step(state, pulls, h=0.01)
    expected = [state.q for state in states]
    for batch in batches:
        np.testing.assert_array_equal(batch.q(), expected)
        np.testing.assert_array_equal(batch.tips(), [dynamics.tip(state) for state in states])
        np.testing.assert_array_equal(batch.velocities(), [dynamics.velocity(state) for state in states])
    batches[1].reset([2])
    assert not batches[1].q()[2].any() and batches[1].q()[1].any()
    batches[1].set_state(2, batches[0].state(2))
    np.testing.assert_array_equal(batches[1].q(), expected)


def test_several_steps_equal_steps_one_by_one(random):
    tensions = random.uniform(0, 3, (3, 9))
    one, other = (flexura.DynamicsBatch(tendon_arm(), 3) for _ in range(2))
    one.step(tensions=tensions, h=0.01, steps=5)
    for _ in range(5):
        other.step(tensions=tensions, h=0.01)
    np.testing.assert_array_equal(one.q(), other.q())


def test_states_of_another_arm_are_refused():
    arm, other = tendon_arm(3), tendon_arm(1)
    dynamics, statics = flexura.Dynamics(arm), flexura.Statics(arm)
    state = flexura.Dynamics(other).rest()
    found = flexura.Statics(other).solve(tensions=[1, 0, 0])
    tensions = np.zeros(9)
    for call in (
        lambda: dynamics.step(state, tensions),
        lambda: dynamics.tip(state),
        lambda: dynamics.velocity(state),
        lambda: dynamics.energy(state),
        lambda: dynamics.backbone(state),
        lambda: dynamics.tendon_lengths(state),
        lambda: dynamics.linearize(state, tensions),
        lambda: dynamics.step_slopes(state, tensions),
        lambda: dynamics.rest(found),
        lambda: statics.backbone(found),
        lambda: statics.solve(tensions=tensions, near=found),
        lambda: flexura.DynamicsBatch(arm, 2).set_state(0, state),
    ):
        with pytest.raises(ValueError, match="arm|rod"):
            call()
